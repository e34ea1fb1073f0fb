// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/detail/program.hh"

#include <algorithm>
#include <cstring>

#include "base/atomic_file.hh"
#include "interp/detail/parser.hh"

namespace mw::interp::detail {

Result<std::unique_ptr<Program>> Program::load(const std::string &path, Names &names) {
    Result<std::string> text = read_file(path);
    if (!text) {
        return std::unexpected(text.error());
    }
    return std::make_unique<Program>(path, std::move(*text), names);
}

Program::Program(std::string path, std::string text, Names &names)
    : path_(std::move(path)), text_(std::move(text)), names_(names) {
    split();
    scan_owords();
    link_owords();
    for (int line = 1; line <= count_lines(); ++line) {
        const std::string_view content = line_text(line);
        const std::size_t first = content.find_first_not_of(" \t\r");
        if (first != std::string_view::npos) {
            isPercentDelimited_ = content[first] == '%';
            first_content_line_ = line;
            break;
        }
    }
}

void Program::split() {
    std::size_t begin = 0;
    while (begin < text_.size()) {
        lines_.push_back(begin);
        const void *newline = std::memchr(text_.data() + begin, '\n', text_.size() - begin);
        begin = newline == nullptr
                    ? text_.size()
                    : static_cast<std::size_t>(static_cast<const char *>(newline) - text_.data()) + 1;
    }
}

std::string_view Program::line_text(int line) const {
    const std::size_t index = static_cast<std::size_t>(line - 1);
    const std::size_t begin = lines_[index];
    std::size_t end = index + 1 < lines_.size() ? lines_[index + 1] : text_.size();
    while (end > begin && (text_[end - 1] == '\n' || text_[end - 1] == '\r')) {
        --end;
    }
    return {text_.data() + begin, end - begin};
}

bool Program::hasClosingPercent() const {
    for (int line = count_lines(); isPercentDelimited_ && line > first_content_line_; --line) {
        const std::string_view content = line_text(line);
        const std::size_t first = content.find_first_not_of(" \t\r");
        if (first != std::string_view::npos && content[first] == '%') {
            return true;
        }
    }
    return !isPercentDelimited_;
}

/// After blanks, a slash and an N word.
bool Program::beginsWithO(std::string_view line) {
    std::size_t i = line.find_first_not_of(" \t/");
    if (i != std::string_view::npos && (line[i] == 'n' || line[i] == 'N')) {
        i = line.find_first_not_of(" \t0123456789.", i + 1);
    }
    return i != std::string_view::npos && (line[i] == 'o' || line[i] == 'O');
}

void Program::scan_owords() {
    Parser parser(arena_, names_);
    for (int line = 1; line <= count_lines(); ++line) {
        const std::string_view content = line_text(line);
        if (!beginsWithO(content)) {
            continue;
        }
        OLine oline;
        oline.line = line;
        oline.block = parser.parse_line(content, static_cast<std::uint32_t>(line));
        olines_.push_back(oline);
    }
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
    const bool hasLoops = !olines_.empty();
    cached_.assign(hasLoops ? lines_.size() + 1 : 0, NO_ID);
}

const Program::OLine *Program::find_oline(int line) const {
    const auto found = std::lower_bound(olines_.begin(), olines_.end(), line,
                                        [](const OLine &oline, int wanted) { return oline.line < wanted; });
    return found != olines_.end() && found->line == line ? &*found : nullptr;
}

BlockView Program::block(int line) {
    if (cached_.empty()) {
        scratch_.clear();
        scratch_block_ =
            Parser(scratch_, names_).parse_line(line_text(line), static_cast<std::uint32_t>(line));
        return {&scratch_block_, &scratch_};
    }
    std::uint32_t &index = cached_[static_cast<std::size_t>(line)];
    if (index == NO_ID) {
        index = static_cast<std::uint32_t>(blocks_.size());
        const OLine *oline = find_oline(line);
        blocks_.push_back(std::make_unique<Block>(
            oline != nullptr
                ? oline->block
                : Parser(arena_, names_).parse_line(line_text(line), static_cast<std::uint32_t>(line))));
    }
    return {blocks_[index].get(), &arena_};
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

}  // namespace mw::interp::detail
