// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes and scripts. A script's call is a level of call like a subroutine's. What a script has
// executed runs nested above it; a waiting point (probe, tool change, yield) ends the step, and the next step
// goes on with what is on top: nested blocks first, then the suspended script.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"
#include "interp/flow/flow.hh"
#include "interp/scripts/script_view.hh"

namespace mw::interp::detail {
namespace {

constexpr int MAX_SCRIPT_DEPTH = 40;

/// What a function gets: words of the block that the argspec names.
ScriptArguments arguments_of(const Remap &remap, const PendingBlock &pending) {
    ScriptArguments out;
    for (const RemapWord &word : remap.words) {
        if (!pending.values.has(word.letter)) {
            continue;
        }
        const double value = pending.values.at(word.letter);
        if (remap.isPositional) {
            out.positional.push_back(value);
        } else {
            out.words.emplace_back(std::string(1, word.letter), value);
        }
    }
    if (remap.wantsLine) {
        out.words.emplace_back("n", pending.line);
    }
    return out;
}

}  // namespace

// ------------------------------------------------------------------------------------------- the host

Result<> Flow::need_scripts(const std::string &what, const SourcePlace &place) {
    if (scripts_ != nullptr) {
        return {};
    }
    Result<std::unique_ptr<ScriptHost>> made =
        settings_.make_script_host ? settings_.make_script_host() : open_script_host(script_library());
    if (!made) {
        Error error = made.error();
        error.message = fmt::format("{} needs Python: {}", what, error.message);
        error.place = place;
        return std::unexpected(std::move(error));
    }
    ++script_depth_;
    Result<> loaded = (*made)->load(settings_.scripts, *view_);
    --script_depth_;
    if (!loaded) {
        if (loaded.error().place.file.empty()) {
            loaded.error().place = place;
        }
        return loaded;
    }
    scripts_ = std::move(*made);
    return {};
}

Result<> Flow::check_remap(const Remap &remap) {
    const auto bad = [&remap](std::string why, std::string hint) {
        return fail(fmt::format("REMAP of {}: {}", remap.name, why), remap.place, std::move(hint));
    };
    for (const std::string *name : {&remap.function, &remap.prolog, &remap.epilog}) {
        if (!name->empty() && !scripts_->hasFunction(ScriptModule::REMAP, *name)) {
            return bad(fmt::format("'{}' is not a Python function of the module remap", *name),
                       "define it in remap.py, and import remap in the file that [PYTHON]TOPLEVEL names");
        }
    }
    return {};
}

Result<> Flow::load_scripts() {
    const ScriptSettings &wanted = settings_.scripts;
    warnings_ = executor_.remaps.refused();
    if (!wanted.top_level.empty()) {
        if (Result<> made = need_scripts("[PYTHON]TOPLEVEL", wanted.place); !made) {
            return made;
        }
    }
    for (const Remap &remap : executor_.remaps.all()) {
        if (remap.needsScripts() && wanted.top_level.empty()) {
            return fail(fmt::format("REMAP of {} names a Python function, but [PYTHON]TOPLEVEL is missing",
                                    remap.name),
                        remap.place, "TOPLEVEL names the script that imports the module remap");
        }
        if (Result<> checked = check_remap(remap); !checked) {
            return checked;
        }
    }
    if (scripts_ != nullptr) {
        for (std::string &name : scripts_->named_parameters()) {
            if (executor_.isBuiltInName(name)) {
                warnings_.push_back(fmt::format("Python redefines the named parameter #<{}>", name));
            }
            script_names_.push_back(std::move(name));
        }
        executor_.set_script_names(this);
    }
    return {};
}

Result<> Flow::begin_scripts() {
    if (scripts_ == nullptr) {
        return {};
    }
    ++script_depth_;
    Result<> begun = scripts_->begin();
    --script_depth_;
    settle_after_script();
    return begun;
}

void Flow::end_scripts() {
    unwind();
    executor_.set_script_names(nullptr);
    scripts_.reset();
}

bool Flow::hasName(std::string_view name) const {
    return std::ranges::find(script_names_, name) != script_names_.end();
}

std::optional<double> Flow::value_of(std::string_view name) {
    const bool wasReading = isReadingName_;
    isReadingName_ = true;
    const Result<double> value = scripts_->named_parameter(std::string(name));
    isReadingName_ = wasReading;
    if (!value) {
        executor_.fault.set(value.error().message);
        return std::nullopt;
    }
    return *value;
}

// ------------------------------------------------------------------------------------- calls of scripts

/// Keeps what a script did; a later failure takes back no more than what comes after it.
void Flow::settle_after_script() {
    const Outcome outcome = executor_.outcome;
    commit();
    executor_.begin_block();
    executor_.outcome = outcome;
}

/// Calls a function for the call on top.
bool Flow::call_handler(ScriptModule module, const std::string &name) {
    const std::size_t index = calls_.size() - 1;
    Call &call = calls_[index];
    if (scripts_ == nullptr) {
        return executor_.fault.set(fmt::format("{} needs Python, which is not set up", name));
    }
    if (script_depth_ >= MAX_SCRIPT_DEPTH) {
        return executor_.fault.set(
            fmt::format("Scripts call each other more than {} deep", MAX_SCRIPT_DEPTH));
    }
    ScriptArguments arguments;
    if (call.remap != nullptr) {
        arguments = arguments_of(*call.remap, *call.pending);
    } else {
        arguments.positional = call.arguments;
    }
    call.isScriptDone = false;
    call.script_line = line_read_;
    script_error_.clear();
    commit();
    executor_.outcome = Outcome::OK;
    executor_.canon.enter_block(program_, line_read_, line_read_, false, call_level());
    std::unique_ptr<SuspendedScript> rest;
    ++script_depth_;
    ScriptOutcome outcome = scripts_->call(module, name, arguments, rest);
    --script_depth_;
    calls_[index].script = std::move(rest);
    return take_outcome(index, std::move(outcome));
}

/// The script of the call at `index` has come back.
bool Flow::take_outcome(std::size_t index, ScriptOutcome outcome) {
    executor_.outcome = Outcome::OK;
    executor_.fault = {};
    settle_after_script();
    line_read_ = calls_[index].script_line;
    calls_[index].outcome = outcome;
    if (outcome.kind == ScriptOutcome::Kind::FAILED) {
        return executor_.fault.set(outcome.message);
    }
    const bool isWaiting = outcome.kind == ScriptOutcome::Kind::WAITING;
    calls_[index].isScriptDone = !isWaiting;
    if (isEndDue_ || outcome.kind == ScriptOutcome::Kind::EXIT) {
        isEndDue_ = true;
        return true;
    }
    const bool isNested = calls_.size() - 1 > index;
    if (isWaiting || isSyncDue_ || executor_.awaited.isToolChange) {
        executor_.awaited.isToolChange = false;
        executor_.outcome = Outcome::SYNC;
        return true;
    }
    return isNested || advance_call();
}

/// The script on top has done its part.
bool Flow::advance_call() {
    Call &call = calls_.back();
    const ScriptOutcome outcome = call.outcome;
    if (call.kind == CallKind::SCRIPT) {
        return pop_call(outcome.value, outcome.kind == ScriptOutcome::Kind::VALUE);
    }
    if (outcome.kind == ScriptOutcome::Kind::VALUE) {
        return executor_.fault.set(
            fmt::format("The Python function of {} returned the number {}: INTERP_OK, nothing or a text (an "
                        "error) is expected",
                        call.remap->name, outcome.value));
    }
    if (call.stage == Stage::PROLOG) {
        return start_stage(Stage::PROCEDURE);
    }
    return pop_call(executor_.returned.value, executor_.returned.isSet);
}

bool Flow::start_stage(Stage stage) {
    Call &call = calls_.back();
    call.stage = stage;
    const Remap &remap = *call.remap;
    switch (stage) {
    case Stage::PROLOG: return call_handler(ScriptModule::REMAP, remap.prolog);
    case Stage::FUNCTION: return call_handler(ScriptModule::REMAP, remap.function);
    case Stage::EPILOG: return call_handler(ScriptModule::REMAP, remap.epilog);
    case Stage::PROCEDURE: return start_procedure();
    case Stage::NONE: break;
    }
    return true;
}

/// Looked up not before the prolog has said yes.
bool Flow::start_procedure() {
    Sub sub;
    if (!find_sub(calls_.back().label, 0, sub)) {
        return false;
    }
    Call &call = calls_.back();
    call.procedure = sub.program;
    call.sub_line = sub.line;
    program_ = call.procedure;
    next_ = call.sub_line + 1;
    return true;
}

/// The block has come to a remapped code: its prolog, subroutine and epilog, or its function, run before the
/// rest.
bool Flow::call_remap() {
    PendingBlock pending = executor_.remaps.take_interrupted();
    const Remap &remap = *pending.remap;
    const NameId label = names_.intern(remap.target());
    if (const std::string missing = missing_words(pending, executor_.state); !missing.empty()) {
        executor_.fault.set(fmt::format("user-defined {}: missing: {}", remap.name, missing));
        executor_.fault.block_text = fmt::format("O <{}> call ", remap.target());
        return false;
    }
    Call call;
    call.kind = CallKind::REMAP;
    call.label = label;
    call.remap = &remap;
    call.pending = std::move(pending);
    if (!enter(std::move(call), {})) {
        return false;
    }
    executor_.remaps.begin(remap, executor_.saved_modes.depth());
    pass_words(*calls_.back().pending, settings_.isArgumentCountNamed, executor_.parameters, names_);
    const Stage first = !remap.prolog.empty() && !remap.ngc.empty() ? Stage::PROLOG
                        : remap.ngc.empty()                         ? Stage::FUNCTION
                                                                    : Stage::PROCEDURE;
    if (start_stage(first)) {
        return true;
    }
    if (executor_.fault.block_text.empty() && !calls_.empty() && calls_.back().stage == first) {
        executor_.fault.block_text = fmt::format("O <{}> call ", remap.target());
    }
    return false;
}

bool Flow::run_script_oword(NameId label, const double *arguments, std::uint32_t count) {
    executor_.returned = {};
    executor_.commit();
    Call call;
    call.kind = CallKind::SCRIPT;
    call.label = label;
    call.stage = Stage::FUNCTION;
    call.arguments.assign(arguments, arguments + count);
    if (!enter(std::move(call), {})) {
        return false;
    }
    for (int i = 0; i < ARGUMENT_COUNT; ++i) {
        executor_.parameters.set(i + 1, arguments[i]);
    }
    executor_.parameters.commit();
    return call_handler(ScriptModule::OWORD, names_.text(label));
}

/// A line that begins with ;py,
bool Flow::run_script_text() {
    const std::string text = executor_.script_text();
    const int line = line_read_;
    if (Result<> made = need_scripts("a line that begins with ;py,", {file(), line, 1}); !made) {
        return executor_.fault.set(made.error().message, 1, made.error().hint);
    }
    ++script_depth_;
    const ScriptOutcome outcome = scripts_->run_text(text);
    --script_depth_;
    settle_after_script();
    line_read_ = line;
    if (outcome.kind == ScriptOutcome::Kind::FAILED) {
        return executor_.fault.set(outcome.message, 1);
    }
    if (isSyncDue_ || executor_.awaited.isToolChange) {
        executor_.awaited.isToolChange = false;
        executor_.outcome = Outcome::SYNC;
    }
    return true;
}

/// The call on top is a script's: it goes on after a waiting point, or what it had executed is over.
Step Flow::go_on_with_script() {
    const std::size_t index = calls_.size() - 1;
    executor_.fault = {};
    executor_.begin_block();
    line_read_ = calls_[index].script_line;
    executor_.block_place = {line_read_, line_read_, call_level()};
    bool isDone = true;
    if (calls_[index].isScriptDone) {
        isDone = advance_call();
    } else {
        std::unique_ptr<SuspendedScript> script = std::move(calls_[index].script);
        ++script_depth_;
        ScriptOutcome outcome = script->resume();
        --script_depth_;
        if (outcome.kind == ScriptOutcome::Kind::WAITING) {
            calls_[index].script = std::move(script);
        }
        isDone = take_outcome(index, std::move(outcome));
    }
    return isDone ? after_block() : fail_block();
}

// --------------------------------------------------------------------------------- what scripts execute

/// The text of a script is done: back to where the script was called.
void Flow::end_text() {
    Call call = std::move(calls_.back());
    calls_.pop_back();
    --text_levels_;
    program_ = call.program;
    next_ = call.next;
    repeats_ = std::move(call.repeats);
}

std::expected<bool, ScriptFault> Flow::execute_for_script(std::string_view text, int line) {
    const auto refuse = [&](std::string why) {
        return std::unexpected(ScriptFault{std::move(why), line, std::string(text)});
    };
    if (isReadingName_) {
        return refuse("the function of a named parameter cannot execute blocks");
    }
    if (script_depth_ == 0) {
        return refuse("nothing can be executed now: the program was ended");
    }
    if (isEndDue_) {
        return refuse("the program has ended: a block executed before was M2 or M30");
    }
    if (isSyncDue_) {
        return refuse("a waiting point is due (probe, tool change or input): "
                      "'yield INTERP_EXECUTE_FINISH' must come before the next execute()");
    }
    if (text_levels_ == 0 && executor_.canon.empty()) {
        texts_.clear();
    }
    texts_.push_back(std::make_unique<Program>("script", std::string(text), names_));
    const std::size_t base = calls_.size();
    Call call;
    call.kind = CallKind::TEXT;
    call.program = program_;
    call.line = line_read_;
    call.next = next_;
    call.reported_line = line > 0 ? line : line_read_;
    call.repeats = std::move(repeats_);
    repeats_.clear();
    calls_.push_back(std::move(call));
    ++text_levels_;
    program_ = texts_.back().get();
    next_ = 1;
    const std::size_t outer_base = nested_base_;
    nested_base_ = base;
    const auto result = run_nested(base);
    nested_base_ = outer_base;
    return result;
}

std::expected<bool, ScriptFault> Flow::run_nested(std::size_t base) {
    while (calls_.size() > base) {
        const int line = calls_[base].reported_line;
        switch (step()) {
        case Step::OK: break;
        case Step::SYNC:
            if (executor_.world().isSynchedAtOnce()) {
                break;
            }
            isSyncDue_ = true;
            if (calls_.size() == base + 1 && isAtFileEnd() && calls_.back().kind == CallKind::TEXT) {
                end_text();
            }
            return false;
        case Step::PROGRAM_END:
        case Step::FILE_END: return false;
        case Step::FAILED: return std::unexpected(ScriptFault{error_.what.message, line, error_.line_text});
        }
        if (isEndDue_) {
            return false;
        }
    }
    return true;
}

}  // namespace mw::interp::detail
