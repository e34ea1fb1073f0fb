// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/calls.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::gcode::detail {
namespace {

constexpr int MAX_CALL_DEPTH = 500;

bool check_depth(const FlowParts &parts) {
    return parts.levels.call_level() < MAX_CALL_DEPTH ||
           parts.executor.fault.set(
               fmt::format("Subroutine calls are nested more than {} deep", MAX_CALL_DEPTH));
}

bool compute_label(const BlockView &view, const OWord &oword, const FlowParts &parts, NameId &label) {
    label = oword.label;
    if (label != NO_ID) {
        return true;
    }
    int number = 0;
    if (!parts.executor.evaluator().whole(*view.arena, oword.label_expression, number)) {
        return false;
    }
    label = parts.names.intern(fmt::format("{}", number));
    return true;
}

}  // namespace

bool pass_definition(const OWord &oword, const FlowParts &parts) {
    const Levels &levels = parts.levels;
    Fault &fault = parts.executor.fault;
    Place &here = parts.levels.here();
    if (levels.isInCall() && levels.top().sub_line == here.line && levels.top().label == oword.label) {
        return true;
    }
    if (levels.isInCall() && !levels.isIn(CallKind::FANUC) && !levels.isIn(CallKind::TEXT)) {
        return fault.set("Nested subroutine definition", oword.column);
    }
    const Program &program = *here.program;
    const int end = find_after(program, here.line, {OKind::ENDSUB});
    if (end == 0) {
        return fail_unmatched(oword, "endsub", here, parts.jump_values());
    }
    for (int at = program.next_oword(here.line); at != 0 && at < end; at = program.next_oword(at)) {
        const OWord *inner = program.oword_at(at);
        if (inner != nullptr && inner->kind == OKind::SUB) {
            fault.line = at;
            return fault.set("Nested subroutine definition", inner->column);
        }
    }
    here.next = end + 1;
    return true;
}

bool pass_fanuc_label(const OWord &oword, const FlowParts &parts) {
    const Levels &levels = parts.levels;
    const bool in_other = levels.isInCall() && !levels.isIn(CallKind::FANUC) && !levels.isIn(CallKind::TEXT);
    if (oword.kind == OKind::FANUC && in_other) {
        return parts.executor.fault.set(FANUC_TEXT, oword.column,
                                        called_from(levels.top().label, levels, parts.names));
    }
    return true;
}

bool enter_call(Call &&call, const Sub &sub, const FlowParts &parts) {
    if (!check_depth(parts)) {
        return false;
    }
    call.sub_line = sub.line;
    parts.levels.enter(std::move(call));
    parts.executor.push_call();
    if (sub.program != nullptr) {
        parts.levels.here().program = sub.program;
        parts.levels.here().next = sub.line + 1;
    }
    return true;
}

bool compute_call(const BlockView &view, const OWord &oword, const FlowParts &parts, CallRequest &out) {
    out.count = oword.argument_count;
    out.column = oword.column;
    if (out.count > ARGUMENT_COUNT) {
        out.many.resize(out.count);
    }
    const std::span<double> arguments = out.arguments();
    for (std::uint32_t i = 0; i < out.count; ++i) {
        if (!parts.executor.evaluator().value(*view.arena, view.arena->arguments[oword.first_argument + i],
                                              arguments[i])) {
            return false;
        }
    }
    return compute_label(view, oword, parts, out.label);
}

bool call_sub(const CallRequest &request, const FlowParts &parts) {
    Sub sub;
    if (!find_sub(request.label, request.column, parts.search(), sub)) {
        return false;
    }
    Executor &executor = parts.executor;
    executor.returned = {};
    executor.commit();
    Call call;
    call.label = request.label;
    if (!enter_call(std::move(call), sub, parts)) {
        return false;
    }
    if (!request.many.empty()) {
        executor.parameters.keep_aside(request.count);
    }
    executor.parameters.set_arguments(request.arguments());
    if (parts.settings.argument_count_named) {
        executor.parameters.set_named(parts.names.intern("n_args"), false, request.count);
    }
    executor.parameters.commit();
    return true;
}

bool compute_return(const BlockView &view, const OWord &oword, const FlowParts &parts, ReturnValue &out) {
    const Levels &levels = parts.levels;
    Fault &fault = parts.executor.fault;
    if (!levels.isInCall() || levels.isIn(CallKind::TEXT)) {
        return fault.set(fmt::format("'O{}' {}: not in a subroutine", label_text(oword, parts.names),
                                     oword.kind == OKind::ENDSUB ? "endsub" : "return"),
                         oword.column);
    }
    const Call &call = levels.top();
    if (call.kind == CallKind::FANUC) {
        return fault.set(FANUC_END_TEXT, oword.column, called_from(call.label, levels, parts.names));
    }
    if (oword.kind == OKind::ENDSUB && oword.label != call.label) {
        return fault.set(fmt::format("o{} endsub: this is subroutine o<{}>", label_text(oword, parts.names),
                                     parts.names.text(call.label)),
                         oword.column);
    }
    out.set = oword.value != NO_ID;
    return !out.set || parts.executor.evaluator().value(*view.arena, oword.value, out.value);
}

bool leave_call(const ReturnValue &value, const FlowParts &parts) {
    Executor &executor = parts.executor;
    Levels &levels = parts.levels;
    const Call call = levels.leave();
    executor.returned = {value.set ? value.value : 0.0, value.set};
    if (!executor.pop_call(call.kind == CallKind::FANUC)) {
        return false;
    }
    Place &here = levels.here();
    here.line = call.line;
    executor.block_place = {call.line, call.line, levels.call_level()};
    if (call.script != nullptr && call.script->pending) {
        executor.canon.enter_block(here.program, call.line, call.line, false, levels.call_level());
        return executor.resume(*call.script->pending);
    }
    if (call.kind == CallKind::PROFILE) {
        executor.canon.enter_block(here.program, call.line, call.line, false, levels.call_level());
        executor.keep_state();
        return executor.lathe.finish(executor.modes, executor.canon, executor.fault);
    }
    return true;
}

// ------------------------------------------------------------------------------------------ M98 and M99

bool call_fanuc(const FlowParts &parts) {
    Executor &executor = parts.executor;
    const NameId label = parts.names.intern(fmt::format("{}", executor.fanuc_call.label));
    Sub sub;
    if (!find_fanuc_sub(label, parts.search(), sub) || !check_depth(parts)) {
        return false;
    }
    parts.commit();
    if (executor.fanuc_call.count <= 0) {
        return true;
    }
    Call call;
    call.kind = CallKind::FANUC;
    call.label = label;
    call.again = executor.fanuc_call.count - 1;
    return enter_call(std::move(call), sub, parts);
}

bool return_fanuc(const FlowParts &parts, LoopTurn &turn) {
    Levels &levels = parts.levels;
    Fault &fault = parts.executor.fault;
    if (levels.isIn(CallKind::TEXT)) {
        return fault.set("M99 must be in a subroutine, not in a block that a script executes");
    }
    Call &call = levels.top();
    if (call.kind != CallKind::FANUC) {
        return fault.set(OWORD_END_TEXT, 0, called_from(call.label, levels, parts.names));
    }
    if (call.again > 0) {
        --call.again;
        levels.here().next = call.sub_line + 1;
        turn = {call.sub_line, levels.here().line, false};
        return true;
    }
    return leave_call({}, parts);
}

bool call_profile(const FlowParts &parts) {
    Call call;
    Sub sub;
    call.kind = CallKind::PROFILE;
    call.label = parts.names.intern(fmt::format("{}", parts.executor.lathe.request()->label));
    if (!find_sub(call.label, 0, parts.search(), sub) || !check_depth(parts)) {
        return false;
    }
    parts.commit();
    return enter_call(std::move(call), sub, parts);
}

}  // namespace mw::gcode::detail
