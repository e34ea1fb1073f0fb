// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/flow.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/short_text.hh"
#include "gcode/interpreter/flow/script_view.hh"

namespace mw::gcode::detail {
namespace {

/// A line that begins with an O word, valid or not.
bool mentionsOWord(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t/nN0123456789.");
    return first != std::string_view::npos && (line[first] == 'o' || line[first] == 'O');
}

}  // namespace

Flow::Flow(Executor &executor, Names &names, Canon &target, const Settings &settings)
    : executor_(executor), names_(names), scripts_(executor.fault), budget_(settings),
      parts_{levels_, files_, scripts_, executor, names, target, settings},
      view_(std::make_unique<ScriptView>(
          parts_, [this](std::string_view text, int line) { return execute_for_script(text, line); })) {}

Flow::~Flow() {
    unwind();
    executor_.set_script_names(nullptr);
    scripts_.close();
}

Result<> Flow::open(const std::string &path) {
    Result<std::unique_ptr<Program>> loaded = Program::load(path, names_);
    if (!loaded) {
        return std::unexpected(loaded.error());
    }
    close();
    levels_.open(files_.keep(std::move(*loaded)));
    return {};
}

void Flow::open_text(const std::string &name, std::string text) {
    close();
    levels_.open(files_.keep(std::make_unique<Program>(name, std::move(text), names_)));
}

void Flow::close() {
    abort();
    files_.close_files();
    levels_.open(nullptr);
    budget_.restart();
}

void Flow::unwind(std::size_t depth) {
    if (levels_.size() > depth) {
        std::vector<Call> dropped = levels_.unwind(depth);
        executor_.drop_calls(static_cast<std::size_t>(levels_.call_level()));
        if (std::ranges::find(levels_.calls(), CallKind::PROFILE, &Call::kind) == levels_.calls().end()) {
            executor_.lathe.drop();
        }
        while (!dropped.empty()) {
            dropped.pop_back();  // the innermost script ends first
        }
    }
    if (depth == 0) {
        levels_.end_top();
    }
}

void Flow::abort() {
    unwind();
    executor_.abort_block();
    script_calls_.expect_sync(false);
    script_calls_.expect_end(false);
}

// ---------------------------------------------------------------------------------------------- one step

Step Flow::step() {
    if (scripts_.depth() == 0) {
        script_calls_.expect_sync(false);
    }
    if (levels_.isInCall() && levels_.top().isInScript()) {
        line_empty_ = false;
        return script_calls_.go_on(parts_) ? after_block() : fail_block();
    }
    const Place &here = levels_.here();
    if (here.program == nullptr) {
        return Step::FILE_END;
    }
    return here.isAtEnd() ? end_of_lines() : run_line();
}

Step Flow::execute(std::string_view text) {
    if (levels_.isMdi()) {
        unwind();
    }
    if (executor_.canon.empty()) {
        files_.drop_mdi();
    }
    levels_.begin_mdi(files_.keep_mdi(text, names_));
    if (levels_.here().isAtEnd()) {
        return finish_mdi();
    }
    const Step step = run_line();
    if (step == Step::OK && !levels_.isInCall() && levels_.here().isAtEnd()) {
        return finish_mdi();
    }
    return step;
}

Step Flow::finish_mdi() {
    levels_.end_mdi();
    return Step::FILE_END;
}

Step Flow::end_of_lines() {
    if (levels_.isIn(CallKind::TEXT)) {
        levels_.leave();  // returns to the line that called the script
        return Step::OK;
    }
    if (levels_.isMdi() && !levels_.isInCall()) {
        return finish_mdi();
    }
    levels_.here().line = levels_.here().program->count_lines();
    return fail_here(levels_.isInCall() ? fmt::format("The file ends in subroutine o<{}> without its end",
                                                      call_name(levels_.top(), names_))
                                        : "File ended with no percent sign or program end");
}

/// The first % begins a program, the second % ends it. Any other % is an error of its line.
Step Flow::percent() {
    const Place &here = levels_.here();
    if (here.line == here.program->first_content_line()) {
        return Step::OK;
    }
    if (levels_.isInCall()) {
        return fail_here(fmt::format("The file ends in subroutine o<{}> without its end",
                                     call_name(levels_.top(), names_)));
    }
    if (executor_.modes.spline.order != 0) {
        return fail_here("The file ends inside a NURBS: end the NURBS with G5.3");
    }
    executor_.canon.take(Finish{});
    parts_.commit();
    return Step::FILE_END;
}

Step Flow::run_line() {
    Place &here = levels_.here();
    if (budget_.isBounded() && !budget_.take_statement(levels_.isInCall() ? 0 : here.next)) {
        return fail_budget();
    }
    here.line = here.next;
    const BlockView view = here.program->block(here.next);
    ++here.next;
    here.after = here.next;
    const Block &block = *view.block;
    line_empty_ = block.is_percent || (block.deletable && executor_.world().isBlockDeleteOn()) ||
                  (block.word_count == 0 && block.setting_count == 0 && block.oword == NO_ID);
    if (block.is_percent) {
        return percent();
    }
    if (block.deletable && executor_.world().isBlockDeleteOn()) {
        return Step::OK;
    }
    return run_block(view);
}

Step Flow::run_block(const BlockView &view) {
    const Block &block = *view.block;
    const Place &here = levels_.here();
    executor_.fault.clear();
    continuable_ = block.oword == NO_ID;
    const int sequence = block.isNumbered ? block.sequence : here.line;
    const int call_level = levels_.call_level();
    executor_.block_place = {levels_.isIn(CallKind::TEXT) ? levels_.top().reported_line : here.line, sequence,
                             call_level};
    executor_.begin_light_block();
    if (scripts_.isOpen()) {
        executor_.keep_state();  // scripts may change any modes
    }
    if (block.error != NO_ID) {
        const SyntaxError &error = view.arena->errors[view.block->error];
        continuable_ = continuable_ && !mentionsOWord(here.program->line_text(here.line));
        executor_.fault.set(error.message, error.column);
        return fail_block();
    }
    executor_.canon.enter_block(here.program, here.line, sequence, block.isNumbered, call_level);
    const std::string_view text = block.comment_count > 0 ? here.program->line_text(here.line) : "";
    const bool done = block.oword != NO_ID ? run_oword(view) : executor_.run(view, text);
    return done ? after_block() : fail_block();
}

/// Commits the block, then makes or ends the call that it requires.
Step Flow::after_block() {
    bool done = true;
    while (done) {
        const Outcome outcome = executor_.outcome;
        executor_.outcome = Outcome::OK;
        if (outcome != Outcome::CALL_FANUC && outcome != Outcome::PROFILE) {
            parts_.commit();  // both steps may fail
        }
        if (script_calls_.isEndDue() && scripts_.depth() == 0) {  // a script has ended the program
            script_calls_.expect_end(false);
            unwind();
            return Step::PROGRAM_END;
        }
        switch (outcome) {
        case Outcome::OK: return Step::OK;
        case Outcome::SYNC: return Step::SYNC;
        case Outcome::PROGRAM_END:
            end_program();
            script_calls_.expect_end(scripts_.depth() > 0);
            return Step::PROGRAM_END;
        case Outcome::SCRIPT: done = script_calls_.run_text_line(parts_, *view_); break;
        case Outcome::CALL_FANUC: done = call_fanuc(parts_); break;
        case Outcome::RETURN_FANUC: done = return_fanuc(); break;
        case Outcome::REMAP: done = script_calls_.call_remap(parts_); break;
        case Outcome::PROFILE: done = call_profile(parts_); break;
        case Outcome::RESTART: levels_.here().next = 1; break;
        }
    }
    return fail_block();
}

void Flow::end_program() {
    const Program *const main = levels_.main();
    if (main != nullptr && !levels_.isMdi() && !main->hasClosingPercent()) {
        executor_.canon.take(ProgramComment{"interpreter: percent sign missing from end of file"});
    }
    executor_.canon.take(OnReset{});
    parts_.commit();
    unwind(script_calls_.nested_base());
}

// ----------------------------------------------------------------------------------------------- O words

bool Flow::run_oword(const BlockView &view) {
    const OWord &oword = view.arena->owords[view.block->oword];
    const bool is_static = oword.kind == OKind::CALL || oword.kind == OKind::RETURN || oword.label != NO_ID;
    if (!is_static) {
        return executor_.fault.set("Only the label of a call can be computed", oword.column);
    }
    Place &here = levels_.here();
    const int line = here.line;
    switch (oword.kind) {
    case OKind::CALL: return run_call(view, oword);
    case OKind::ENDSUB:
    case OKind::RETURN: return run_return(view, oword);
    case OKind::SUB: return pass_definition(oword, parts_) && check_jumped_over(line, here, executor_.fault);
    case OKind::FANUC:
    case OKind::NONE: return pass_fanuc_label(oword, parts_);
    default: break;
    }
    LoopTurn turn;
    return run_jump(view, oword, here, parts_.jump_values(), turn) && note_turn(turn) &&
           check_jumped_over(line, here, executor_.fault);
}

bool Flow::run_call(const BlockView &view, const OWord &oword) {
    CallRequest request;
    if (!compute_call(view, oword, parts_, request)) {
        return false;
    }
    if (scripts_.hasFunction(ScriptModule::OWORD, names_.text(request.label))) {
        return script_calls_.call_oword(request, parts_);
    }
    return call_sub(request, parts_);
}

bool Flow::run_return(const BlockView &view, const OWord &oword) {
    ReturnValue value;
    return compute_return(view, oword, parts_, value) && script_calls_.leave(value, parts_);
}

bool Flow::return_fanuc() {
    LoopTurn turn;
    return detail::return_fanuc(parts_, turn) && note_turn(turn);
}

bool Flow::note_turn(const LoopTurn &turn) {
    if (turn.first == 0 || !budget_.isBounded()) {
        return true;
    }
    const LoopPass pass{levels_.here().program, levels_.size(), turn.first, turn.last};
    if (budget_.isWatching()) {
        budget_.note_pass(pass);
    }
    // Scripts and changed tool tables have state that is not compared here, so a loop with them is not
    // reported.
    const bool all_seen = turn.conditional && !scripts_.isOpen() && !executor_.tools.hasChanges();
    if (!all_seen || !budget_.isRepeating(pass, executor_.modes, executor_.parameters)) {
        return true;
    }
    executor_.fault.line = turn.first;
    return executor_.fault.set("Endless loop: nothing changes between two passes", 0,
                               "in a check, inputs, HAL pins and probes do not change: a loop that waits for "
                               "one of them must end when #<_task> is 0");
}

// ---------------------------------------------------------------------------------------------- failures

Step Flow::fail_here(std::string message) {
    executor_.begin_block();
    executor_.fault = {};
    executor_.fault.set(std::move(message));
    continuable_ = false;
    return fail_block();
}

/// The endless loop is the outermost loop that has recently restarted.
Step Flow::fail_budget() {
    Place &here = levels_.here();
    here.line = here.next;
    const std::string where = fmt::format("{}:{}", levels_.file(), here.next);
    const std::span<const Call> calls = levels_.calls();
    std::optional<LoopPass> loop;
    for (std::size_t depth = 0; depth <= calls.size() && !loop; ++depth) {
        const bool innermost = depth == calls.size();
        loop = budget_.loop_around(innermost ? here.program : calls[depth].program, depth,
                                   innermost ? here.next : calls[depth].line);
    }
    const std::string taken = budget_.spend();
    if (loop && loop->depth < levels_.size()) {
        unwind(std::max(loop->depth, script_calls_.nested_base()));
    }
    executor_.begin_block();
    executor_.fault = {};
    executor_.fault.set(
        loop ? fmt::format("This loop has run for {} (now at {}); it may be endless", taken, where)
             : fmt::format("The program has run for {} since line {}; check for an endless loop", taken,
                           budget_.furthest_line()));
    executor_.fault.hint = "check the condition that ends the loop; if it is correct, allow more statements "
                           "(millwright check --statements N; 0: no limit)";
    continuable_ = false;
    executor_.fault.line = loop ? loop->first : 0;
    return fail_block();
}

Step Flow::fail_block() {
    executor_.rollback();
    const Fault &fault = executor_.fault;
    if (fault.program_ended) {
        executor_.canon.take(Finish{});
        parts_.commit();
    }
    Place &here = levels_.here();
    const int line = fault.line > 0 ? fault.line : here.line;
    error_ = {};
    error_.what.message = short_text(fault.message);
    error_.what.hint = fault.hint;
    error_.what.place = {levels_.file(), line, static_cast<int>(fault.column)};
    if (!fault.block_text.empty()) {
        error_.line_text = fault.block_text;
    } else if (here.program != nullptr && line >= 1 && line <= here.program->count_lines()) {
        error_.line_text = std::string(here.program->line_text(line));
    }
    error_.called_from = levels_.callers();
    // ignores a jump that failed after a part of its actions
    here.next = levels_.isInCall() ? here.next : here.after;
    unwind(script_calls_.nested_base());
    return Step::FAILED;
}

// ----------------------------------------------------------------------------------------------- scripts

Result<> Flow::load_scripts() {
    Result<> loaded = scripts_.load(parts_.settings, executor_.remaps, executor_, *view_);
    if (loaded && scripts_.isOpen()) {
        executor_.set_script_names(&scripts_);
    }
    return loaded;
}

Result<> Flow::begin_scripts() {
    if (!scripts_.isOpen()) {
        return {};
    }
    Result<> begun = scripts_.begin();
    settle_script(parts_);
    return begun;
}

std::expected<bool, ScriptFault> Flow::execute_for_script(std::string_view text, int line) {
    if (std::optional<std::string> why = script_calls_.refusal(scripts_); why) {
        return std::unexpected(ScriptFault{std::move(*why), line, std::string(text)});
    }
    const std::size_t outer_base = script_calls_.begin_text(text, line, parts_);
    const auto result = run_nested(script_calls_.nested_base());
    script_calls_.end_text(outer_base);
    return result;
}

std::expected<bool, ScriptFault> Flow::run_nested(std::size_t base) {
    while (levels_.size() > base) {
        const int line = levels_.call(base).reported_line;
        switch (step()) {
        case Step::OK: break;
        case Step::SYNC:
            if (executor_.world().isSynchedAtOnce()) {
                break;
            }
            script_calls_.expect_sync(true);
            if (levels_.size() == base + 1 && levels_.here().isAtEnd() && levels_.isIn(CallKind::TEXT)) {
                levels_.leave();
            }
            return false;
        case Step::PROGRAM_END:
        case Step::FILE_END: return false;
        case Step::FAILED: return std::unexpected(ScriptFault{error_.what.message, line, error_.line_text});
        }
        if (script_calls_.isEndDue()) {
            return false;
        }
    }
    return true;
}

}  // namespace mw::gcode::detail
