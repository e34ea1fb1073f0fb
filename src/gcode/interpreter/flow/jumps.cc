// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/jumps.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mw::gcode::detail {
namespace {

constexpr std::initializer_list<OKind> IF_PARTS = {OKind::ELSEIF, OKind::ELSE, OKind::ENDIF};

bool isOneOf(OKind kind, std::initializer_list<OKind> kinds) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

/// Reports that `line` has an invalid O word.
bool fail_bad_oword(Program &program, int line, Fault &fault) {
    const BlockView view = program.block(line);
    const SyntaxError &error = view.arena->errors[view.block->error];
    fault.line = line;
    return fault.set(error.message, error.column);
}

bool condition(const BlockView &view, const OWord &oword, const JumpValues &values, bool &is_true) {
    double value = 0;
    if (!values.evaluator.value(*view.arena, oword.value, value)) {
        return false;
    }
    is_true = value != 0.0;
    return true;
}

bool run_if(const BlockView &view, const OWord &oword, Place &here, const JumpValues &values) {
    Program &program = *here.program;
    if (oword.kind == OKind::ENDIF) {
        return find_before(program, here.line, {OKind::IF}) != 0 || fail_unmatched(oword, "if", here, values);
    }
    if (oword.kind != OKind::IF) {  // the program reached this line after an executed branch
        const int end = find_after(program, here.line, {OKind::ENDIF});
        here.next = end + 1;
        return (end != 0 && find_before(program, here.line, {OKind::IF}) != 0) ||
               fail_unmatched(oword, end == 0 ? "endif" : "if", here, values);
    }
    bool is_true = false;
    if (!condition(view, oword, values, is_true)) {
        return false;
    }
    int at = here.line;
    while (!is_true) {
        at = find_after(program, at, IF_PARTS);
        if (at == 0) {
            return fail_unmatched(oword, "endif", here, values);
        }
        const OWord &part = *program.oword_at(at);
        if (part.kind != OKind::ELSEIF) {
            break;
        }
        const BlockView part_view = program.block(at);
        here.line = at;
        if (!condition(part_view, part, values, is_true)) {
            return false;
        }
    }
    here.next = at + 1;
    return true;
}

/// Runs the start of a while loop, or the end of a do loop.
bool run_while(const BlockView &view, const OWord &oword, Place &here, const JumpValues &values,
               LoopTurn &turn) {
    bool is_true = false;
    if (!condition(view, oword, values, is_true)) {
        return false;
    }
    const Program &program = *here.program;
    const int opener = find_before(program, here.line, {OKind::DO, OKind::WHILE, OKind::ENDWHILE});
    if (opener != 0 && program.oword_at(opener)->kind == OKind::DO) {
        if (is_true) {
            here.next = opener + 1;
            turn = {opener, here.line, true};
        }
        return true;
    }
    const int end = find_after(program, here.line, {OKind::ENDWHILE});
    if (end == 0) {
        return fail_unmatched(oword, "endwhile", here, values);
    }
    here.next = is_true ? here.next : end + 1;
    return true;
}

bool run_end_while(const OWord &oword, Place &here, const JumpValues &values, LoopTurn &turn) {
    const int begin = find_before(*here.program, here.line, {OKind::WHILE});
    here.next = begin;
    turn = {begin, here.line, true};
    return begin != 0 || fail_unmatched(oword, "while", here, values);
}

bool run_repeat(const BlockView &view, const OWord &oword, Place &here, const JumpValues &values) {
    double count = 0;
    if (!values.evaluator.value(*view.arena, oword.value, count)) {
        return false;
    }
    const int end = find_after(*here.program, here.line, {OKind::ENDREPEAT});
    if (end == 0) {
        return fail_unmatched(oword, "endrepeat", here, values);
    }
    constexpr double MOST = 2e9;
    if (!(count < MOST)) {
        return values.fault.set("The count of this repeat is too large", oword.column);
    }
    if (count < 0.5) {
        here.next = end + 1;
        return true;
    }
    const auto stale = std::ranges::find(here.repeats, here.line, &Repeat::line);
    here.repeats.erase(stale, here.repeats.end());  // ended by break or continue of an outer loop
    here.repeats.push_back({here.line, static_cast<int>(std::lround(count))});
    return true;
}

bool run_end_repeat(const OWord &oword, Place &here, const JumpValues &values, LoopTurn &turn) {
    const int begin = find_before(*here.program, here.line, {OKind::REPEAT});
    std::vector<Repeat> &repeats = here.repeats;
    while (!repeats.empty() && repeats.back().line != begin) {
        repeats.pop_back();  // ended by break of an outer loop
    }
    if (begin == 0 || repeats.empty()) {
        return fail_unmatched(oword, "repeat", here, values);
    }
    if (--repeats.back().left > 0) {
        here.next = begin + 1;
        turn = {begin, here.line, false};
    } else {
        repeats.pop_back();
    }
    return true;
}

/// Runs break and continue of a loop with a condition.
bool run_leave(const OWord &oword, Place &here, const JumpValues &values) {
    const Program &program = *here.program;
    const int opener = find_before(program, here.line, {OKind::WHILE, OKind::DO});
    if (opener == 0) {
        return fail_unmatched(oword, "while or do", here, values);
    }
    const OKind kind = program.oword_at(opener)->kind;
    const int end = find_after(program, here.line, {kind == OKind::WHILE ? OKind::ENDWHILE : OKind::WHILE});
    if (end == 0) {
        return fail_unmatched(oword, "end of the loop", here, values);
    }
    here.next = oword.kind == OKind::CONTINUE ? end : end + 1;
    return true;
}

}  // namespace

std::string_view label_text(const OWord &oword, const Names &names) {
    return oword.label == NO_ID ? std::string_view("?") : names.text(oword.label);
}

int find_after(const Program &program, int line, std::initializer_list<OKind> kinds) {
    for (int at = program.next_same(line); at != 0; at = program.next_same(at)) {
        if (isOneOf(program.oword_at(at)->kind, kinds)) {
            return at;
        }
    }
    return 0;
}

int find_before(const Program &program, int line, std::initializer_list<OKind> kinds) {
    for (int at = program.previous_same(line); at != 0; at = program.previous_same(at)) {
        if (isOneOf(program.oword_at(at)->kind, kinds)) {
            return at;
        }
    }
    return 0;
}

bool fail_unmatched(const OWord &oword, std::string_view missing, const Place &here,
                    const JumpValues &values) {
    // An invalid O word is the probable reason.
    Program &program = *here.program;
    const bool after = missing.starts_with("end") || oword.kind == OKind::DO;
    const int bad = after ? program.find_bad_oword(here.line, program.count_lines() + 1)
                          : program.find_bad_oword(0, here.line);
    if (bad != 0) {
        return fail_bad_oword(program, bad, values.fault);
    }
    return values.fault.set(
        fmt::format("o{}: there is no matching {}", label_text(oword, values.names), missing), oword.column);
}

bool check_jumped_over(int from, const Place &here, Fault &fault) {
    const int bad = here.next > from ? here.program->find_bad_oword(from, here.next) : 0;
    return bad == 0 || fail_bad_oword(*here.program, bad, fault);
}

bool run_jump(const BlockView &view, const OWord &oword, Place &here, const JumpValues &values,
              LoopTurn &turn) {
    switch (oword.kind) {
    case OKind::IF:
    case OKind::ELSEIF:
    case OKind::ELSE:
    case OKind::ENDIF: return run_if(view, oword, here, values);
    case OKind::WHILE: return run_while(view, oword, here, values, turn);
    case OKind::ENDWHILE: return run_end_while(oword, here, values, turn);
    case OKind::DO:
        return find_after(*here.program, here.line, {OKind::WHILE}) != 0 ||
               fail_unmatched(oword, "while", here, values);
    case OKind::REPEAT: return run_repeat(view, oword, here, values);
    case OKind::ENDREPEAT: return run_end_repeat(oword, here, values, turn);
    case OKind::BREAK:
    case OKind::CONTINUE: return run_leave(oword, here, values);
    case OKind::NONE:
    case OKind::SUB:
    case OKind::ENDSUB:
    case OKind::CALL:
    case OKind::RETURN:
    case OKind::FANUC: break;  // calls, and labels of subroutines
    }
    return true;
}

}  // namespace mw::gcode::detail
