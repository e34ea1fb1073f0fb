// SPDX-License-Identifier: GPL-2.0-or-later
// O words: conditions and loops. Those of one label are linked in the order of the file, so a jump is a walk
// along that chain.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "interp/flow/flow.hh"

namespace mw::interp::detail {
namespace {

constexpr std::initializer_list<OKind> IF_PARTS = {OKind::ELSEIF, OKind::ELSE, OKind::ENDIF};

bool isOneOf(OKind kind, std::initializer_list<OKind> kinds) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

std::string Flow::label_text(const OWord &oword) const {
    return oword.label == NO_ID ? std::string("?") : names_.text(oword.label);
}

int Flow::find_after(int line, std::initializer_list<OKind> kinds) const {
    for (int at = program_->next_same(line); at != 0; at = program_->next_same(at)) {
        if (isOneOf(program_->oword_at(at)->kind, kinds)) {
            return at;
        }
    }
    return 0;
}

int Flow::find_before(int line, std::initializer_list<OKind> kinds) const {
    for (int at = program_->previous_same(line); at != 0; at = program_->previous_same(at)) {
        if (isOneOf(program_->oword_at(at)->kind, kinds)) {
            return at;
        }
    }
    return 0;
}

bool Flow::fail_bad_oword(int line) {
    const BlockView view = program_->block(line);
    const SyntaxError &error = view.arena->errors[view.block->error];
    executor_.fault.line = line;
    return executor_.fault.set(error.message, error.column);
}

bool Flow::unmatched(const OWord &oword, std::string_view missing) {
    // One that cannot be read is the likely reason.
    const bool isAfter = missing.starts_with("end") || oword.kind == OKind::DO;
    const int bad = isAfter ? program_->find_bad_oword(line_read_, program_->count_lines() + 1)
                            : program_->find_bad_oword(0, line_read_);
    if (bad != 0) {
        return fail_bad_oword(bad);
    }
    return executor_.fault.set(fmt::format("o{}: there is no matching {}", label_text(oword), missing),
                               oword.column);
}

bool Flow::run_oword(const BlockView &view) {
    const OWord &oword = view.arena->owords[view.block->oword];
    const bool isStatic = oword.kind == OKind::CALL || oword.kind == OKind::RETURN || oword.label != NO_ID;
    if (!isStatic) {
        return executor_.fault.set("Only the label of a call can be computed", oword.column);
    }
    const int line = line_read_;
    if (!run_oword_kind(view, oword)) {
        return false;
    }
    // A jump over an O word that cannot be read may have missed its end.
    const bool isJump =
        oword.kind != OKind::CALL && oword.kind != OKind::RETURN && oword.kind != OKind::ENDSUB;
    const int bad = isJump && next_ > line ? program_->find_bad_oword(line, next_) : 0;
    return bad == 0 || fail_bad_oword(bad);
}

bool Flow::run_oword_kind(const BlockView &view, const OWord &oword) {
    switch (oword.kind) {
    case OKind::SUB: return run_sub(oword);
    case OKind::CALL: return run_call(view, oword);
    case OKind::ENDSUB:
    case OKind::RETURN: return run_return(view, oword);
    case OKind::IF:
    case OKind::ELSEIF:
    case OKind::ELSE:
    case OKind::ENDIF: return run_if(view, oword);
    case OKind::FANUC:
    case OKind::NONE: break;  // the label of a Fanuc-style program
    default: return run_loop(view, oword);
    }
    if (!calls_.empty() && calls_.back().kind != CallKind::FANUC && oword.kind == OKind::FANUC) {
        return executor_.fault.set("Fanuc 'O....' subroutine must be called with 'M98'", oword.column,
                                   called_from(calls_.back().label));
    }
    return true;
}

bool Flow::condition(const BlockView &view, const OWord &oword, bool &isTrue) {
    double value = 0;
    if (!executor_.evaluator().value(*view.arena, oword.value, value)) {
        return false;
    }
    isTrue = value != 0.0;
    return true;
}

bool Flow::run_if(const BlockView &view, const OWord &oword) {
    if (oword.kind == OKind::ENDIF) {
        return find_before(line_read_, {OKind::IF}) != 0 || unmatched(oword, "if");
    }
    if (oword.kind != OKind::IF) {  // reached from above: a branch before this one was taken
        const int end = find_after(line_read_, {OKind::ENDIF});
        next_ = end + 1;
        return (end != 0 && find_before(line_read_, {OKind::IF}) != 0) ||
               unmatched(oword, end == 0 ? "endif" : "if");
    }
    bool isTrue = false;
    if (!condition(view, oword, isTrue)) {
        return false;
    }
    int at = line_read_;
    while (!isTrue) {
        at = find_after(at, IF_PARTS);
        if (at == 0) {
            return unmatched(oword, "endif");
        }
        const OWord &part = *program_->oword_at(at);
        if (part.kind != OKind::ELSEIF) {
            break;
        }
        const BlockView part_view = program_->block(at);
        line_read_ = at;
        if (!condition(part_view, part, isTrue)) {
            return false;
        }
    }
    next_ = at + 1;
    return true;
}

bool Flow::run_loop(const BlockView &view, const OWord &oword) {
    switch (oword.kind) {
    case OKind::WHILE: return run_while(view, oword);
    case OKind::DO: return find_after(line_read_, {OKind::WHILE}) != 0 || unmatched(oword, "while");
    case OKind::ENDWHILE: {
        const int begin = find_before(line_read_, {OKind::WHILE});
        next_ = begin;
        return begin == 0 ? unmatched(oword, "while") : note_conditional_pass(begin, line_read_);
    }
    case OKind::REPEAT: return run_repeat(view, oword);
    case OKind::ENDREPEAT: return run_end_repeat(oword);
    default: return run_leave(oword);
    }
}

/// At the top of a while loop, or at the bottom of a do loop.
bool Flow::run_while(const BlockView &view, const OWord &oword) {
    bool isTrue = false;
    if (!condition(view, oword, isTrue)) {
        return false;
    }
    const int opener = find_before(line_read_, {OKind::DO, OKind::WHILE, OKind::ENDWHILE});
    if (opener != 0 && program_->oword_at(opener)->kind == OKind::DO) {
        next_ = isTrue ? opener + 1 : next_;
        return !isTrue || note_conditional_pass(opener, line_read_);
    }
    const int end = find_after(line_read_, {OKind::ENDWHILE});
    if (end == 0) {
        return unmatched(oword, "endwhile");
    }
    next_ = isTrue ? next_ : end + 1;
    return true;
}

bool Flow::run_repeat(const BlockView &view, const OWord &oword) {
    double count = 0;
    if (!executor_.evaluator().value(*view.arena, oword.value, count)) {
        return false;
    }
    const int end = find_after(line_read_, {OKind::ENDREPEAT});
    if (end == 0) {
        return unmatched(oword, "endrepeat");
    }
    constexpr double MOST = 2e9;
    if (!(count < MOST)) {
        return executor_.fault.set("The count of this repeat is too large", oword.column);
    }
    if (count < 0.5) {
        next_ = end + 1;
        return true;
    }
    repeats_.push_back({line_read_, static_cast<int>(std::lround(count))});
    return true;
}

bool Flow::run_end_repeat(const OWord &oword) {
    const int begin = find_before(line_read_, {OKind::REPEAT});
    while (!repeats_.empty() && repeats_.back().line != begin) {
        repeats_.pop_back();  // left by break of an outer loop
    }
    if (begin == 0 || repeats_.empty()) {
        return unmatched(oword, "repeat");
    }
    if (--repeats_.back().left > 0) {
        next_ = begin + 1;
        note_pass(begin, line_read_);
    } else {
        repeats_.pop_back();
    }
    return true;
}

/// break and continue.
bool Flow::run_leave(const OWord &oword) {
    const int opener = find_before(line_read_, {OKind::WHILE, OKind::DO, OKind::REPEAT});
    if (opener == 0) {
        return unmatched(oword, "while, do or repeat");
    }
    const OKind kind = program_->oword_at(opener)->kind;
    const OKind closing =
        kind == OKind::WHILE ? OKind::ENDWHILE : (kind == OKind::DO ? OKind::WHILE : OKind::ENDREPEAT);
    const int end = find_after(line_read_, {closing});
    if (end == 0) {
        return unmatched(oword, "end of the loop");
    }
    if (oword.kind == OKind::CONTINUE) {
        next_ = end;
        return true;
    }
    next_ = end + 1;
    while (kind == OKind::REPEAT && !repeats_.empty()) {
        const bool isThis = repeats_.back().line == opener;
        repeats_.pop_back();
        if (isThis) {
            break;
        }
    }
    return true;
}

}  // namespace mw::interp::detail
