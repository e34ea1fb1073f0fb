// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/flow/flow.hh"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "interp/scripts/script_view.hh"

namespace mw::interp::detail {
namespace {

/// A line that begins with an O word, well-formed or not.
bool mentionsOWord(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t/nN0123456789.");
    return first != std::string_view::npos && (line[first] == 'o' || line[first] == 'O');
}

}  // namespace

Flow::Flow(Executor &executor, Names &names, Canon &target, const Settings &settings)
    : executor_(executor), names_(names), target_(target), settings_(settings),
      view_(std::make_unique<ScriptView>(*this)), budget_(settings) {}

Flow::~Flow() {
    end_scripts();
}

const std::string &Flow::file() const {
    static const std::string NO_FILE;
    return program_ == nullptr ? NO_FILE : program_->path();
}

Result<> Flow::open(const std::string &path) {
    Result<std::unique_ptr<Program>> loaded = Program::load(path, names_);
    if (!loaded) {
        return std::unexpected(loaded.error());
    }
    close();
    std::unique_ptr<Program> &program = programs_[path];
    program = std::move(*loaded);
    program_ = program.get();
    return {};
}

void Flow::open_text(const std::string &name, std::string text) {
    close();
    std::unique_ptr<Program> &program = programs_[name];
    program = std::make_unique<Program>(name, std::move(text), names_);
    program_ = program.get();
}

void Flow::close() {
    abort();
    programs_.clear();
    program_ = nullptr;
    next_ = after_line_ = 1;
    budget_.restart();
}

FilePlace Flow::place_in_file() const {
    const Program *const main = calls_.empty() ? program_ : calls_.front().program;
    if (main == nullptr) {
        return {};
    }
    const ProgramText &text = main->text();
    return {text.place_of(calls_.empty() ? next_ : calls_.front().line), text.count_bytes()};
}

std::vector<diag::Diagnostic> Flow::syntax_errors(int after, int most) {
    std::vector<diag::Diagnostic> out;
    Program *const main = calls_.empty() ? program_ : calls_.front().program;
    const int last = main == nullptr ? 0 : main->count_lines();
    for (int line = after + 1; line <= last && static_cast<int>(out.size()) < most; ++line) {
        const BlockView view = main->block(line);
        if (view.block->error != NO_ID) {
            const SyntaxError &error = view.arena->errors[view.block->error];
            out.push_back({diag::Severity::ERROR,
                           {error.message, {main->path(), line, static_cast<int>(error.column)}, {}},
                           {},
                           std::string(main->line_text(line))});
        }
        if (view.block->isPercent && line > main->first_content_line()) {
            break;
        }
    }
    return out;
}

std::string_view Flow::subroutine() const {
    for (auto call = calls_.rbegin(); call != calls_.rend(); ++call) {
        if (call->label != NO_ID) {
            return names_.text(call->label);
        }
    }
    return {};
}

std::string Flow::line_text(const std::string &file, int line) const {
    const auto found = programs_.find(file);
    const bool isThere = found != programs_.end() && line >= 1 && line <= found->second->count_lines();
    return isThere ? std::string(found->second->line_text(line)) : std::string();
}

/// Drops calls without running what they would restore.
void Flow::unwind(std::size_t depth) {
    if (calls_.size() > depth) {
        Call &outermost = calls_[depth];
        program_ = outermost.program;
        next_ = outermost.kind == CallKind::TEXT ? outermost.next : outermost.line + 1;
        repeats_ = std::move(outermost.repeats);
        std::vector<Call> dropped(
            std::make_move_iterator(calls_.begin() + static_cast<std::ptrdiff_t>(depth)),
            std::make_move_iterator(calls_.end()));
        calls_.erase(calls_.begin() + static_cast<std::ptrdiff_t>(depth), calls_.end());
        text_levels_ = static_cast<int>(
            std::ranges::count(calls_, CallKind::TEXT, [](const Call &call) { return call.kind; }));
        executor_.drop_calls(static_cast<std::size_t>(call_level()));
        if (std::ranges::none_of(calls_, [](const Call &call) { return call.kind == CallKind::PROFILE; })) {
            executor_.drop_lathe_cycle();
        }
        while (!dropped.empty()) {
            dropped.pop_back();  // the innermost script ends first
        }
    }
    if (depth > 0) {
        return;
    }
    repeats_.clear();
    if (isMdi_) {
        isMdi_ = false;
        program_ = outer_program_;
        next_ = outer_next_;
    }
}

std::string Flow::call_name(const Call &call) const {
    return call.label == NO_ID ? std::string("the block of a script") : names_.text(call.label);
}

void Flow::abort() {
    unwind();
    executor_.canon.truncate(0);
    executor_.abort_block();
    isSyncDue_ = isEndDue_ = false;
}

Step Flow::step() {
    if (script_depth_ == 0) {
        isSyncDue_ = false;
    }
    if (!calls_.empty() && calls_.back().isInScript()) {
        return go_on_with_script();
    }
    if (program_ == nullptr) {
        return Step::FILE_END;
    }
    if (next_ > program_->count_lines()) {
        return end_of_lines();
    }
    return run_line();
}

Step Flow::execute(std::string_view text) {
    if (isMdi_) {
        unwind();
    }
    if (executor_.canon.empty()) {
        mdi_.clear();
    }
    mdi_.push_back(std::make_unique<Program>("MDI", std::string(text), names_));
    isMdi_ = true;
    outer_program_ = program_;
    outer_next_ = next_;
    program_ = mdi_.back().get();
    next_ = 1;
    if (program_->count_lines() == 0) {
        return finish_mdi();
    }
    const Step step = run_line();
    if (step == Step::OK && calls_.empty() && next_ > program_->count_lines()) {
        return finish_mdi();
    }
    return step;
}

Step Flow::finish_mdi() {
    isMdi_ = false;
    program_ = outer_program_;
    next_ = outer_next_;
    return Step::FILE_END;
}

Step Flow::fail_here(std::string message) {
    executor_.begin_block();
    executor_.fault = {};
    executor_.fault.set(std::move(message));
    isContinuable_ = false;
    return fail_block();
}

Step Flow::end_of_lines() {
    if (!calls_.empty() && calls_.back().kind == CallKind::TEXT) {
        end_text();
        return Step::OK;
    }
    if (!calls_.empty()) {
        line_read_ = program_->count_lines();
        return fail_here(
            fmt::format("The file ends in subroutine o<{}> without its end", call_name(calls_.back())));
    }
    if (isMdi_) {
        return finish_mdi();
    }
    line_read_ = program_->count_lines();
    return fail_here("File ended with no percent sign or program end");
}

/// The first % opens a program that begins with it; any other ends it.
Step Flow::percent() {
    if (program_->isPercentDelimited() && line_read_ == program_->first_content_line()) {
        return Step::OK;
    }
    if (!calls_.empty()) {
        return fail_here(
            fmt::format("The file ends in subroutine o<{}> without its end", call_name(calls_.back())));
    }
    if (executor_.state.nurbs_order != 0) {
        return fail_here("The file ends inside of a NURBS: G5.3 ends it");
    }
    executor_.canon.take(Finish{});
    commit();
    return Step::FILE_END;
}

Step Flow::run_line() {
    if (budget_.isBounded() && !budget_.take_statement(calls_.empty() ? next_ : 0)) {
        return fail_budget();
    }
    line_read_ = next_;
    const BlockView view = program_->block(next_);
    ++next_;
    after_line_ = next_;
    const Block &block = *view.block;
    if (block.isPercent) {
        return percent();
    }
    if (block.isDeletable && executor_.world().isBlockDeleteOn()) {
        return Step::OK;
    }
    return run_block(view);
}

Step Flow::run_block(const BlockView &view) {
    const Block &block = *view.block;
    executor_.fault.clear();
    isContinuable_ = block.oword == NO_ID;
    const int sequence = block.isNumbered ? block.sequence : line_read_;
    const bool isText = !calls_.empty() && calls_.back().kind == CallKind::TEXT;
    executor_.block_place = {isText ? calls_.back().reported_line : line_read_, sequence, call_level()};
    executor_.begin_light_block();
    if (scripts_ != nullptr) {
        executor_.keep_state();  // scripts change what they like
    }
    if (block.error != NO_ID) {
        const SyntaxError &error = view.arena->errors[block.error];
        isContinuable_ = isContinuable_ && !mentionsOWord(program_->line_text(line_read_));
        executor_.fault.set(error.message, error.column);
        return fail_block();
    }
    executor_.canon.enter_block(program_, line_read_, sequence, block.isNumbered, call_level());
    const std::string_view text = block.comment_count > 0 ? program_->line_text(line_read_) : "";
    const bool isDone = block.oword != NO_ID ? run_oword(view) : executor_.run(view, text);
    return isDone ? after_block() : fail_block();
}

/// Keeps what the block did, then calls or ends what it asked for.
Step Flow::after_block() {
    bool isDone = true;
    while (isDone) {
        const Outcome outcome = executor_.outcome;
        executor_.outcome = Outcome::OK;
        if (outcome != Outcome::CALL_FANUC && outcome != Outcome::PROFILE) {
            commit();  // those two may still fail
        }
        if (isEndDue_ && script_depth_ == 0) {  // a script has ended the program
            isEndDue_ = false;
            unwind();
            return Step::PROGRAM_END;
        }
        switch (outcome) {
        case Outcome::OK: return Step::OK;
        case Outcome::SYNC: return Step::SYNC;
        case Outcome::PROGRAM_END:
            end_program();
            isEndDue_ = script_depth_ > 0;
            return Step::PROGRAM_END;
        case Outcome::SCRIPT: isDone = run_script_text(); break;
        case Outcome::CALL_FANUC: isDone = call_fanuc(); break;
        case Outcome::RETURN_FANUC: isDone = return_fanuc(); break;
        case Outcome::REMAP: isDone = call_remap(); break;
        case Outcome::PROFILE: isDone = call_profile(); break;
        case Outcome::RESTART: next_ = 1; break;
        }
    }
    return fail_block();
}

void Flow::end_program() {
    const Program *main = calls_.empty() ? program_ : calls_.front().program;
    if (main != nullptr && !isMdi_ && !main->hasClosingPercent()) {
        executor_.canon.take(ProgramComment{"interpreter: percent sign missing from end of file"});
    }
    executor_.canon.take(OnReset{});
    commit();
    unwind(nested_base_);
}

void Flow::commit() {
    executor_.commit();
    executor_.flush(target_);
}

Step Flow::fail_block() {
    executor_.rollback();
    if (executor_.fault.isProgramOver) {
        executor_.canon.take(Finish{});
        commit();
    }
    const Fault &fault = executor_.fault;
    const int line = executor_.fault.line > 0 ? executor_.fault.line : line_read_;
    error_ = {};
    error_.what.message = fault.message;
    error_.what.hint = fault.hint;
    error_.what.place = {file(), line, static_cast<int>(fault.column)};
    if (!fault.block_text.empty()) {
        error_.line_text = fault.block_text;
    } else if (program_ != nullptr && line >= 1 && line <= program_->count_lines()) {
        error_.line_text = std::string(program_->line_text(line));
    }
    for (auto call = calls_.rbegin(); call != calls_.rend(); ++call) {
        error_.called_from.push_back({call->program->path(), call->line, 0});
    }
    next_ = calls_.empty() ? after_line_ : next_;  // a jump that failed half way is none
    unwind(nested_base_);
    return Step::FAILED;
}

}  // namespace mw::interp::detail
