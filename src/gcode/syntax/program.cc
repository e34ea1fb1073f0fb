// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/program.hh"

#include <algorithm>

#include <fmt/format.h>

#include "gcode/syntax/parser.hh"

namespace mw::gcode::detail {

Result<std::unique_ptr<Program>> Program::load(const std::string &path, Names &names) {
    Result<ProgramText> text = ProgramText::open(path);
    if (!text) {
        return std::unexpected(text.error());
    }
    std::unique_ptr<Program> program(new Program(path, std::move(*text), names));
    if (Result<> prepared = program->prepare(); !prepared) {
        return std::unexpected(prepared.error());
    }
    return program;
}

Program::Program(std::string path, std::string text, Names &names)
    : Program(std::move(path), ProgramText(std::move(text)), names) {
    (void)prepare();  // text in memory can always be read
}

Program::Program(std::string path, ProgramText text, Names &names)
    : path_(std::move(path)), text_(std::move(text)), names_(names) {}

/// One pass over the text finds its lines, its O words and its percent signs.
Result<> Program::prepare() {
    Result<bool> scanned = text_.scan(
        [this](int line, std::string_view content) { return look_at(line, content) || text_.isHeld(); });
    if (scanned && !*scanned) {  // O words: lines will be read in any order
        if (Result<> held = text_.hold(); !held) {
            return held;
        }
        first_content_line_ = closing_percent_line_ = 0;
        percent_delimited_ = false;
        olines_.clear();
        arena_.clear();
        scanned = text_.scan([this](int line, std::string_view content) {
            look_at(line, content);
            return true;
        });
    }
    if (!scanned) {
        return std::unexpected(scanned.error());
    }
    link_owords();
    return {};
}

/// @return false when the line has an O word
bool Program::look_at(int line, std::string_view content) {
    std::size_t first = 0;
    while (first < content.size() && Lexer::isBlank(content[first])) {
        ++first;
    }
    if (first == content.size()) {
        return true;
    }
    const bool is_percent = isPercentLine(content);
    const bool started = first_content_line_ != 0;
    if (!started) {
        first_content_line_ = line;
        percent_delimited_ = is_percent;
    }
    const bool closing = is_percent && started && percent_delimited_;
    closing_percent_line_ = closing && closing_percent_line_ == 0 ? line : closing_percent_line_;
    if (closing_percent_line_ != 0) {
        return true;  // the rest does not count
    }
    const char c = Lexer::lower(content[first]);
    const bool may_begin_with_o = c == 'o' || c == 'n' || c == '/';
    if (!may_begin_with_o || !beginsWithO(content)) {
        return true;
    }
    OLine oline;
    oline.line = line;
    oline.block = Parser(arena_, names_).parse_line(content, static_cast<std::uint32_t>(line));
    olines_.push_back(oline);
    return false;
}

bool Program::hasClosingPercent() const {
    return !percent_delimited_ || closing_percent_line_ != 0;
}

/// After blanks, a slash and an N word.
bool Program::beginsWithO(std::string_view line) {
    std::size_t i = line.find_first_not_of(" \t/");
    if (i != std::string_view::npos && (line[i] == 'n' || line[i] == 'N')) {
        i = line.find_first_not_of(" \t0123456789.", i + 1);
    }
    return i != std::string_view::npos && (line[i] == 'o' || line[i] == 'O');
}

void Program::link_owords() {
    std::unordered_map<NameId, std::size_t> last;
    for (std::size_t i = 0; i < olines_.size(); ++i) {
        OLine &oline = olines_[i];
        if (oline.block.oword == NO_ID) {
            continue;
        }
        const OWord &oword = arena_.owords[oline.block.oword];
        if (oword.label == NO_ID || oword.kind == OKind::CALL || oword.kind == OKind::RETURN) {
            continue;
        }
        if (const auto found = last.find(oword.label); found != last.end()) {
            olines_[found->second].next = oline.line;
            oline.previous = olines_[found->second].line;
        }
        last[oword.label] = i;
        if (oword.kind == OKind::SUB) {
            subs_.try_emplace(oword.label, oline.line);
        } else if (oword.kind == OKind::FANUC) {
            fanuc_.try_emplace(oword.label, oline.line);
        }
    }
    check_labels();
    for (const OLine &oline : olines_) {
        if (oline.block.error != NO_ID) {
            bad_olines_.push_back(oline.line);
        }
    }
    mark_kept();
}

int Program::find_bad_oword(int after, int before) const {
    const auto found = std::ranges::upper_bound(bad_olines_, after);
    return found != bad_olines_.end() && *found < before ? *found : 0;
}

/// A label that is used again inside its own part would end the wrong part: such a line gets an error, and so
/// do the second definition of a subroutine, and break and continue of a repeat.
void Program::check_labels() {
    std::unordered_map<NameId, const OLine *> open, subs;
    for (OLine &oline : olines_) {
        if (oline.block.oword == NO_ID) {
            continue;
        }
        const OWord &oword = arena_.owords[oline.block.oword];
        if (oword.label == NO_ID) {
            continue;
        }
        auto &found = oword.kind == OKind::SUB ? subs : open;
        const auto earlier = found.find(oword.label);
        const bool is_open = earlier != found.end();
        const bool is_end_of_do = oword.kind == OKind::WHILE && is_open &&
                                  arena_.owords[earlier->second->block.oword].kind == OKind::DO;
        switch (oword.kind) {
        case OKind::IF:
        case OKind::DO:
        case OKind::REPEAT:
        case OKind::SUB:
        case OKind::WHILE:
            if (is_end_of_do) {
                found.erase(earlier);
            } else if (is_open) {
                oline.block.error = static_cast<std::uint32_t>(arena_.errors.size());
                const char *const what = oword.kind == OKind::SUB ? "this subroutine is defined already"
                                                                  : "this label is still in use";
                arena_.errors.push_back(
                    {fmt::format("o{}: {} (line {})", names_.text(oword.label), what, earlier->second->line),
                     oword.column});
            } else {
                found[oword.label] = &oline;
            }
            break;
        case OKind::BREAK:
        case OKind::CONTINUE:
            if (is_open && arena_.owords[earlier->second->block.oword].kind == OKind::REPEAT) {
                oline.block.error = static_cast<std::uint32_t>(arena_.errors.size());
                arena_.errors.push_back(
                    {fmt::format("o{}: {} is for while and do loops, line {} is a repeat",
                                 names_.text(oword.label), oword.kind == OKind::BREAK ? "break" : "continue",
                                 earlier->second->line),
                     oword.column});
            }
            break;
        case OKind::ENDIF:
        case OKind::ENDWHILE:
        case OKind::ENDREPEAT: open.erase(oword.label); break;
        default: break;
        }
    }
}

/// Lines that may run more than once are kept parsed: those of loops and subroutines. A Fanuc-style
/// subroutine may end at any M99.
void Program::mark_kept() {
    cached_.assign(olines_.empty() ? 0 : static_cast<std::size_t>(count_lines()) + 1, NOT_KEPT);
    int kept_to = 0;
    for (const OLine &oline : olines_) {
        int last = oline.line;
        if (oline.block.oword != NO_ID) {
            switch (arena_.owords[oline.block.oword].kind) {
            case OKind::FANUC: last = count_lines(); break;
            case OKind::NONE:
            case OKind::CALL:
            case OKind::RETURN:
            case OKind::IF:
            case OKind::ELSEIF:
            case OKind::ELSE:
            case OKind::ENDIF:
            case OKind::ENDSUB:
            case OKind::ENDWHILE:
            case OKind::ENDREPEAT: break;
            default: last = std::max(last, oline.next); break;
            }
        }
        const int first = std::max(oline.line, kept_to + 1);
        kept_to = std::max(kept_to, last);
        for (int line = first; line <= kept_to; ++line) {
            cached_[static_cast<std::size_t>(line)] = NO_ID;
        }
    }
}

const Program::OLine *Program::find_oline(int line) const {
    const auto found = std::lower_bound(olines_.begin(), olines_.end(), line,
                                        [](const OLine &oline, int wanted) { return oline.line < wanted; });
    return found != olines_.end() && found->line == line ? &*found : nullptr;
}

Block Program::parse(int line, Arena &arena) {
    Block block = Parser(arena, names_).parse_line(line_text(line), static_cast<std::uint32_t>(line));
    if (block.is_percent && !percent_delimited_) {
        block.is_percent = false;
        block.error = static_cast<std::uint32_t>(arena.errors.size());
        arena.errors.push_back(
            {"Bad character '%' used: % ends a program only when the first line of the file is %", 1});
    }
    return block;
}

BlockView Program::block(int line) {
    if (cached_.empty() || cached_[static_cast<std::size_t>(line)] == NOT_KEPT) {
        scratch_.clear();
        scratch_block_ = parse(line, scratch_);
        if (!text_.isHeld() && !text_.failure().empty()) {
            scratch_block_.error = static_cast<std::uint32_t>(scratch_.errors.size());
            scratch_.errors.push_back({text_.failure(), 0});
        }
        return {&scratch_block_, &scratch_};
    }
    std::uint32_t &index = cached_[static_cast<std::size_t>(line)];
    if (index == NO_ID) {
        index = static_cast<std::uint32_t>(blocks_.size());
        const OLine *oline = find_oline(line);
        blocks_.push_back(oline != nullptr ? oline->block : parse(line, arena_));
    }
    return {&blocks_[index], &arena_};
}

const OWord *Program::oword_at(int line) const {
    const OLine *oline = find_oline(line);
    return oline != nullptr && oline->block.oword != NO_ID ? &arena_.owords[oline->block.oword] : nullptr;
}

int Program::next_same(int line) const {
    const OLine *oline = find_oline(line);
    return oline == nullptr ? 0 : oline->next;
}

int Program::previous_same(int line) const {
    const OLine *oline = find_oline(line);
    return oline == nullptr ? 0 : oline->previous;
}

int Program::next_oword(int line) const {
    const auto found = std::upper_bound(olines_.begin(), olines_.end(), line,
                                        [](int wanted, const OLine &oline) { return wanted < oline.line; });
    return found == olines_.end() ? 0 : found->line;
}

int Program::find_sub(NameId label) const {
    const auto found = subs_.find(label);
    return found == subs_.end() ? 0 : found->second;
}

int Program::find_fanuc(NameId label) const {
    const auto found = fanuc_.find(label);
    return found == fanuc_.end() ? 0 : found->second;
}

std::vector<diagnostics::Diagnostic> Program::syntax_errors(int after, int most) {
    std::vector<diagnostics::Diagnostic> out;
    const int last = count_lines();
    for (int line = after + 1; line <= last && static_cast<int>(out.size()) < most; ++line) {
        const BlockView view = block(line);
        if (view.block->error != NO_ID) {
            const SyntaxError &error = view.arena->errors[view.block->error];
            out.push_back({diagnostics::Severity::ERROR,
                           {error.message, {path(), line, static_cast<int>(error.column)}, {}},
                           {},
                           std::string(line_text(line))});
        }
        if (view.block->is_percent && line > first_content_line()) {
            break;
        }
    }
    return out;
}

}  // namespace mw::gcode::detail
