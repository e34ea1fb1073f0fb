// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/detail/flow.hh"

#include <fmt/format.h>

namespace mw::interp::detail {

Flow::Flow(Executor &executor, Names &names, Canon &target, const Settings &settings)
    : executor_(executor), names_(names), target_(target), settings_(settings) {}

const std::string &Flow::file() const {
    static const std::string NO_FILE;
    return program_ == nullptr ? NO_FILE : program_->path();
}

Result<> Flow::open(const std::string &path) {
    close();
    Result<std::unique_ptr<Program>> loaded = Program::load(path, names_);
    if (!loaded) {
        return std::unexpected(loaded.error());
    }
    program_ = loaded->get();
    programs_[path] = std::move(*loaded);
    return {};
}

void Flow::close() {
    abort();
    programs_.clear();
    program_ = nullptr;
    next_ = 1;
    isFirstPercentSeen_ = false;
}

void Flow::abort() {
    while (!calls_.empty()) {
        program_ = calls_.back().program;
        executor_.parameters.pop_call();
        calls_.pop_back();
    }
    executor_.canon.truncate(0);
}

Step Flow::step() {
    if (program_ == nullptr) {
        return Step::FILE_END;
    }
    if (next_ > program_->count_lines()) {
        return end_of_file();
    }
    return run_line();
}

Step Flow::execute(std::string_view text) {
    if (executor_.canon.empty()) {
        mdi_.clear();
    }
    mdi_.push_back(std::make_unique<Program>("MDI", std::string(text), names_));
    Program *const outer = program_;
    const int outer_next = next_;
    program_ = mdi_.back().get();
    next_ = 1;
    const Step step = program_->count_lines() == 0 ? Step::OK : run_line();
    if (calls_.empty()) {
        program_ = outer;
        next_ = outer_next;
    }
    return step;
}

Step Flow::end_of_file() {
    executor_.fault = {};
    executor_.fault.set("File ended with no percent sign or program end");
    return fail_block(nullptr);
}

Step Flow::run_line() {
    if (settings_.statement_budget > 0 && ++statements_ > settings_.statement_budget) {
        executor_.fault = {};
        executor_.fault.set("The program has run for too many statements; is there a loop without end?");
        return fail_block(nullptr);
    }
    line_read_ = next_;
    const BlockView view = program_->block(next_);
    ++next_;
    const Block &block = *view.block;
    if (block.isPercent) {
        if (!isFirstPercentSeen_ && program_->isPercentDelimited()) {
            isFirstPercentSeen_ = true;
            return Step::OK;
        }
        executor_.canon.finish();
        commit();
        return Step::FILE_END;
    }
    if (block.isDeletable && executor_.world().isBlockDeleteOn()) {
        return Step::OK;
    }
    return run_block(view);
}

Step Flow::run_block(const BlockView &view) {
    const Block &block = *view.block;
    executor_.fault = {};
    executor_.set_place(line_read_, call_level(), 0);
    if (block.error != NO_ID) {
        const SyntaxError &error = view.arena->errors[block.error];
        executor_.fault.set(error.message, error.column);
        return fail_block(&view);
    }
    const State before = executor_.state;
    const std::size_t queued = executor_.canon.size();
    executor_.canon.enter_block(program_, line_read_, block.isNumbered ? block.sequence : line_read_,
                                block.isNumbered, call_level());
    const bool isDone =
        block.oword != NO_ID ? run_oword(view) : executor_.run(view, program_->line_text(line_read_));
    if (!isDone) {
        executor_.state = before;
        executor_.canon.truncate(queued);
        executor_.parameters.rollback();
        return fail_block(&view);
    }
    commit();
    switch (executor_.outcome) {
    case Outcome::OK: break;
    case Outcome::SYNC: return Step::SYNC;
    case Outcome::PROGRAM_END: return Step::PROGRAM_END;
    }
    return Step::OK;
}

void Flow::commit() {
    executor_.parameters.commit();
    executor_.canon.flush(target_);
}

Step Flow::fail_block(const BlockView *) {
    const Fault &fault = executor_.fault;
    error_ = {};
    error_.what.message = fault.message;
    error_.what.hint = fault.hint;
    error_.what.place = {file(), line_read_, static_cast<int>(fault.column)};
    if (program_ != nullptr && line_read_ >= 1 && line_read_ <= program_->count_lines()) {
        error_.line_text = std::string(program_->line_text(line_read_));
    }
    error_.called_from.clear();
    for (auto call = calls_.rbegin(); call != calls_.rend(); ++call) {
        error_.called_from.push_back({call->program->path(), call->line, 0});
    }
    return Step::FAILED;
}

bool Flow::run_oword(const BlockView &) {
    return executor_.fault.set("O words are not supported yet");
}

}  // namespace mw::interp::detail
