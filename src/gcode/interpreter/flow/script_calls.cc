// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/script_calls.hh"

#include <fmt/format.h>

namespace mw::gcode::detail {
namespace {

constexpr int MAX_SCRIPT_DEPTH = 40;

/// Arguments of a function: the words of the block that the argspec names.
ScriptArguments arguments_of(const PendingBlock &pending) {
    ScriptArguments out;
    for (const RemapWord &word : pending.remap->words) {
        if (!pending.values.has(word.letter)) {
            continue;
        }
        const double value = pending.values.at(word.letter);
        if (pending.remap->positional) {
            out.positional.push_back(value);
        } else {
            out.words.emplace_back(std::string(1, word.letter), value);
        }
    }
    if (pending.remap->wants_line) {
        out.words.emplace_back("n", pending.line);
    }
    return out;
}

/// Text of the failed block in messages.
std::string call_text(const Remap &remap) {
    return fmt::format("O <{}> call ", remap.target());
}

Stage first_stage(const Remap &remap) {
    if (remap.ngc.empty()) {
        return Stage::FUNCTION;
    }
    return remap.prolog.empty() ? Stage::PROCEDURE : Stage::PROLOG;
}

}  // namespace

void settle_script(const FlowParts &parts) {
    const Outcome outcome = parts.executor.outcome;
    parts.commit();
    parts.executor.begin_block();
    parts.executor.outcome = outcome;
}

/// Calls a script function for the innermost call.
bool ScriptCalls::call_handler(ScriptModule module, const std::string &name, const FlowParts &parts) {
    Levels &levels = parts.levels;
    Executor &executor = parts.executor;
    const std::size_t index = levels.size() - 1;
    if (!parts.scripts.isOpen()) {
        return executor.fault.set(fmt::format("{} needs Python, which is not set up", name));
    }
    if (parts.scripts.depth() >= MAX_SCRIPT_DEPTH) {
        return executor.fault.set(fmt::format("Scripts call each other more than {} deep", MAX_SCRIPT_DEPTH));
    }
    ScriptCall &call = *levels.top().script;
    ScriptArguments arguments;
    if (call.pending) {
        arguments = arguments_of(*call.pending);
    } else {
        arguments.positional = call.arguments;
    }
    call.isDone = false;
    call.line = levels.here().line;
    parts.commit();
    executor.outcome = Outcome::OK;
    executor.canon.enter_block(levels.here().program, call.line, call.line, false, levels.call_level());
    std::unique_ptr<SuspendedScript> rest;
    ScriptOutcome outcome = parts.scripts.call(module, name, arguments, rest);
    levels.call(index).script->waiting = std::move(rest);
    return take_outcome(index, std::move(outcome), parts);
}

/// Ends the step with a synchronisation point if a script requires one.
bool ScriptCalls::take_waiting_point(Executor &executor) const {
    if (!sync_due_ && !executor.awaited.is_tool_change) {
        return false;
    }
    executor.awaited.is_tool_change = false;
    executor.outcome = Outcome::SYNC;
    return true;
}

/// The script of the call at `index` has returned.
bool ScriptCalls::take_outcome(std::size_t index, ScriptOutcome outcome, const FlowParts &parts) {
    Executor &executor = parts.executor;
    executor.outcome = Outcome::OK;
    executor.fault = {};
    settle_script(parts);
    ScriptCall &call = *parts.levels.call(index).script;
    parts.levels.here().line = call.line;
    call.outcome = outcome;
    if (outcome.kind == ScriptOutcome::Kind::FAILED) {
        return executor.fault.set(outcome.message);
    }
    const bool waiting = outcome.kind == ScriptOutcome::Kind::WAITING;
    call.isDone = !waiting;
    if (end_due_ || outcome.kind == ScriptOutcome::Kind::EXIT) {
        end_due_ = true;
        return true;
    }
    if (take_waiting_point(executor)) {
        return true;
    }
    if (waiting) {
        executor.outcome = Outcome::SYNC;
        return true;
    }
    const bool nested = parts.levels.size() - 1 > index;
    return nested || advance(parts);
}

/// The innermost script has finished its stage.
bool ScriptCalls::advance(const FlowParts &parts) {
    const Call &level = parts.levels.top();
    const ScriptOutcome &outcome = level.script->outcome;
    if (level.kind == CallKind::SCRIPT) {
        return leave_call({outcome.value, outcome.kind == ScriptOutcome::Kind::VALUE}, parts);
    }
    if (outcome.kind == ScriptOutcome::Kind::VALUE) {
        return parts.executor.fault.set(
            fmt::format("The Python function of {} returned the number {}: INTERP_OK, nothing or a text (an "
                        "error) is expected",
                        level.script->pending->remap->name, outcome.value));
    }
    if (level.script->stage == Stage::PROLOG) {
        return start_stage(Stage::PROCEDURE, parts);
    }
    return leave_call(parts.executor.returned, parts);
}

bool ScriptCalls::start_stage(Stage stage, const FlowParts &parts) {
    ScriptCall &call = *parts.levels.top().script;
    call.stage = stage;
    const Remap &remap = *call.pending->remap;
    switch (stage) {
    case Stage::PROLOG: return call_handler(ScriptModule::REMAP, remap.prolog, parts);
    case Stage::FUNCTION: return call_handler(ScriptModule::REMAP, remap.function, parts);
    case Stage::EPILOG: return call_handler(ScriptModule::REMAP, remap.epilog, parts);
    case Stage::PROCEDURE: return start_procedure(parts);
    }
    return true;
}

/// Searched only after the prolog has succeeded.
bool ScriptCalls::start_procedure(const FlowParts &parts) {
    Sub sub;
    if (!find_sub(parts.levels.top().label, 0, parts.search(), sub)) {
        return false;
    }
    parts.levels.top().sub_line = sub.line;
    parts.levels.here().program = sub.program;
    parts.levels.here().next = sub.line + 1;
    return true;
}

bool ScriptCalls::call_remap(const FlowParts &parts) {
    Executor &executor = parts.executor;
    PendingBlock pending = executor.remaps.take_interrupted();
    const Remap &remap = *pending.remap;
    const NameId label = parts.names.intern(remap.target());
    if (const std::string missing = missing_words(pending, executor.modes); !missing.empty()) {
        executor.fault.set(fmt::format("user-defined {}: missing: {}", remap.name, missing));
        executor.fault.block_text = call_text(remap);
        return false;
    }
    Call call;
    call.kind = CallKind::REMAP;
    call.label = label;
    call.script = std::make_unique<ScriptCall>();
    call.script->stage = first_stage(remap);
    call.script->pending = std::move(pending);
    if (!enter_call(std::move(call), {}, parts)) {
        return false;
    }
    executor.remaps.begin(remap, executor.saved_modes.depth());
    pass_words(*parts.levels.top().script->pending, parts.settings.argument_count_named, executor.parameters,
               parts.names);
    const Stage first = first_stage(remap);
    if (start_stage(first, parts)) {
        return true;
    }
    const bool at_first = parts.levels.isInCall() && parts.levels.top().script != nullptr &&
                          parts.levels.top().script->stage == first;
    if (executor.fault.block_text.empty() && at_first) {
        executor.fault.block_text = call_text(remap);
    }
    return false;
}

bool ScriptCalls::call_oword(const CallRequest &request, const FlowParts &parts) {
    Executor &executor = parts.executor;
    executor.returned = {};
    executor.commit();
    const std::span<const double> given = request.arguments();
    Call call;
    call.kind = CallKind::SCRIPT;
    call.label = request.label;
    call.script = std::make_unique<ScriptCall>();
    call.script->arguments.assign(given.begin(), given.begin() + request.count);
    if (!enter_call(std::move(call), {}, parts)) {
        return false;
    }
    for (int i = 0; i < ARGUMENT_COUNT; ++i) {
        executor.parameters.set(i + 1, given[static_cast<std::size_t>(i)]);
    }
    executor.parameters.commit();
    return call_handler(ScriptModule::OWORD, parts.names.text(request.label), parts);
}

bool ScriptCalls::leave(const ReturnValue &value, const FlowParts &parts) {
    if (!parts.levels.top().isEpilogDue()) {
        return leave_call(value, parts);
    }
    parts.executor.returned = {value.set ? value.value : 0.0, value.set};
    return start_stage(Stage::EPILOG, parts);
}

bool ScriptCalls::run_text_line(const FlowParts &parts, InterpreterView &view) {
    Executor &executor = parts.executor;
    Levels &levels = parts.levels;
    const std::string text = executor.script_text();
    const int line = levels.here().line;
    if (parts.scripts.limits().confined) {
        return executor.fault.set("Lines that begin with ;py, are not run for a client of role operate.", 1,
                                  "Run the program at the machine, or as a client of role configure.");
    }
    if (!parts.settings.scripts.lines_run) {
        return executor.fault.set("lines that begin with ;py, are not run on this machine", 1,
                                  "[PYTHON]TOPLEVEL of the INI file allows them: it names a Python file");
    }
    const Result<> made =
        parts.scripts.need("a line that begins with ;py,", {levels.file(), line, 1}, parts.settings, view);
    if (!made) {
        return executor.fault.set(made.error().message, 1, made.error().hint);
    }
    const ScriptOutcome outcome = parts.scripts.run_text(text);
    settle_script(parts);
    levels.here().line = line;
    if (outcome.kind == ScriptOutcome::Kind::FAILED) {
        return executor.fault.set(outcome.message, 1);
    }
    take_waiting_point(executor);
    return true;
}

bool ScriptCalls::go_on(const FlowParts &parts) {
    Executor &executor = parts.executor;
    Levels &levels = parts.levels;
    const std::size_t index = levels.size() - 1;
    executor.fault = {};
    executor.begin_block();
    ScriptCall &call = *levels.top().script;
    levels.here().line = call.line;
    executor.block_place = {call.line, call.line, levels.call_level()};
    if (call.isDone) {
        return advance(parts);
    }
    std::unique_ptr<SuspendedScript> script = std::move(call.waiting);
    ScriptOutcome outcome = parts.scripts.resume(*script);
    if (outcome.kind == ScriptOutcome::Kind::WAITING) {
        levels.call(index).script->waiting = std::move(script);
    }
    return take_outcome(index, std::move(outcome), parts);
}

std::optional<std::string> ScriptCalls::refusal(const Scripts &scripts) const {
    if (scripts.isReadingName()) {
        return "the function of a named parameter cannot execute blocks";
    }
    if (scripts.depth() == 0) {
        return "cannot execute: the program has ended";
    }
    if (end_due_) {
        return "the program has ended: a block executed before was M2 or M30";
    }
    if (sync_due_) {
        return "a synchronisation point is due (probe, tool change or input): "
               "'yield INTERP_EXECUTE_FINISH' must come before the next execute()";
    }
    return std::nullopt;
}

std::size_t ScriptCalls::begin_text(std::string_view text, int line, const FlowParts &parts) {
    Levels &levels = parts.levels;
    if (!levels.isTextRunning() && parts.executor.canon.empty()) {
        parts.files.drop_script_texts();
    }
    const std::size_t outer_base = nested_base_;
    nested_base_ = levels.size();
    levels.enter_text(parts.files.keep_script_text(text, parts.names), line);
    return outer_base;
}

}  // namespace mw::gcode::detail
