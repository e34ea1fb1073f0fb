// SPDX-License-Identifier: GPL-2.0-or-later
// Subroutines: O- sub and call, M98 and M99, and those of remapped codes.
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "interp/flow/flow.hh"

namespace mw::interp::detail {
namespace {

constexpr int MAX_CALL_DEPTH = 500;

// Scripts compare these texts, dots and all.
constexpr char FANUC_TEXT[] = "Fanuc 'O....' subroutine must be called with 'M98'";
constexpr char FANUC_END_TEXT[] = "Fanuc 'O....' subroutine definition must end with 'M99'";
constexpr char OWORD_TEXT[] = "'O.... sub' subroutine must be called with 'O.... call'";
constexpr char OWORD_END_TEXT[] =
    "'O.... endsub' or 'O.... return' must follow 'O.... sub' subroutine definition";

}  // namespace

/// A definition met from above is passed over; one inside of a subroutine that runs is none.
bool Flow::run_sub(const OWord &oword) {
    if (!calls_.empty() && calls_.back().sub_line == line_read_ && calls_.back().label == oword.label) {
        return true;
    }
    const bool isInSub =
        !calls_.empty() && calls_.back().kind != CallKind::FANUC && calls_.back().kind != CallKind::TEXT;
    if (isInSub) {
        return executor_.fault.set("Nested subroutine definition", oword.column);
    }
    const int end = find_after(line_read_, {OKind::ENDSUB});
    if (end == 0) {
        return unmatched(oword, "endsub");
    }
    for (int at = program_->next_oword(line_read_); at != 0 && at < end; at = program_->next_oword(at)) {
        const OWord *inner = program_->oword_at(at);
        if (inner != nullptr && inner->kind == OKind::SUB) {
            executor_.fault.line = at;
            return executor_.fault.set("Nested subroutine definition", inner->column);
        }
    }
    next_ = end + 1;
    return true;
}

bool Flow::label_of(const BlockView &view, const OWord &oword, NameId &label) {
    label = oword.label;
    if (label != NO_ID) {
        return true;
    }
    int number = 0;
    if (!executor_.evaluator().whole(*view.arena, oword.label_expression, number)) {
        return false;
    }
    label = names_.intern(fmt::format("{}", number));
    return true;
}

/// In this file, in the files that called it, then in a file of its own.
bool Flow::find_sub(NameId label, std::uint32_t column, Sub &sub) {
    const auto look_in = [&](Program *program) {
        sub = {program, program == nullptr ? 0 : program->find_sub(label)};
        return sub.line != 0;
    };
    bool isFound = look_in(program_);
    for (auto call = calls_.rbegin(); call != calls_.rend() && !isFound; ++call) {
        isFound = look_in(call->program);
    }
    isFound = isFound || look_in(load_sub_file(label));
    if (isFound) {
        return true;
    }
    if (Sub fanuc; find_fanuc(label, fanuc)) {
        executor_.fault.line = fanuc.program == program_ ? fanuc.line : 0;
        return executor_.fault.set(FANUC_TEXT, 0, called_from(label));
    }
    note_search();
    return executor_.fault.set(
        fmt::format(
            "There is no subroutine o<{0}>: neither in this file nor as {0}.ngc in the subroutine path",
            names_.text(label)),
        column);
}

/// Which subroutine an error is about, and where it was called.
std::string Flow::called_from(NameId label) const {
    const int line = calls_.empty() ? line_read_ : calls_.back().line;
    return fmt::format("subroutine O{}, called in line {}", names_.text(label), line);
}

/// The main program has been searched to its end: when that is a closing percent sign, it ends there.
void Flow::note_search() {
    const Program *const main = calls_.empty() ? program_ : calls_.front().program;
    executor_.fault.isProgramOver = !isMdi_ && main->isPercentDelimited() && main->hasClosingPercent();
}

bool Flow::find_fanuc(NameId label, Sub &sub) {
    sub = {program_, program_->find_fanuc(label)};
    for (auto call = calls_.rbegin(); call != calls_.rend() && sub.line == 0; ++call) {
        sub = {call->program, call->program->find_fanuc(label)};
    }
    if (sub.line == 0) {
        if (Program *const file = load_sub_file(label); file != nullptr) {
            sub = {file, file->find_fanuc(label)};
        }
    }
    return sub.line != 0;
}

/// name.ngc in the first folder of the path that has it; null when none has.
Program *Flow::load_sub_file(NameId label) {
    const std::string name = names_.text(label) + ".ngc";
    std::vector<std::string> folders = settings_.subroutine_path;
    if (!isMdi_ || !calls_.empty()) {
        const Program *const main = calls_.empty() ? program_ : calls_.front().program;
        folders.insert(folders.begin(), std::filesystem::path(main->path()).parent_path().string());
    }
    for (const std::string &folder : folders) {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        if (const auto known = programs_.find(path.string()); known != programs_.end()) {
            return known->second.get();
        }
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored)) {
            continue;
        }
        if (Result<std::unique_ptr<Program>> loaded = Program::load(path.string(), names_)) {
            Program *const program = loaded->get();
            programs_[path.string()] = std::move(*loaded);
            return program;
        }
    }
    return nullptr;
}

bool Flow::check_depth() {
    return call_level() < MAX_CALL_DEPTH ||
           executor_.fault.set(fmt::format("Subroutine calls are nested more than {} deep", MAX_CALL_DEPTH));
}

bool Flow::enter(Call &&call, const Sub &sub) {
    if (!check_depth()) {
        return false;
    }
    call.program = program_;
    call.line = line_read_;
    call.sub_line = sub.line;
    call.repeats = std::move(repeats_);
    repeats_.clear();
    calls_.push_back(std::move(call));
    executor_.push_call();
    if (sub.program != nullptr) {
        program_ = sub.program;
        next_ = sub.line;
    }
    return true;
}

bool Flow::run_call(const BlockView &view, const OWord &oword) {
    NameId label = NO_ID;
    Sub sub;
    const std::uint32_t count = oword.argument_count;
    double few[ARGUMENT_COUNT] = {};
    std::vector<double> many(count > ARGUMENT_COUNT ? count : 0);
    double *const arguments = many.empty() ? few : many.data();
    for (std::uint32_t i = 0; i < count; ++i) {
        if (!executor_.evaluator().value(*view.arena, view.arena->arguments[oword.first_argument + i],
                                         arguments[i])) {
            return false;
        }
    }
    if (!label_of(view, oword, label)) {
        return false;
    }
    if (scripts_ != nullptr && scripts_->hasFunction(ScriptModule::OWORD, names_.text(label))) {
        return run_script_oword(label, arguments, count);
    }
    if (!find_sub(label, oword.column, sub)) {
        return false;
    }
    executor_.returned = {};
    executor_.commit();
    Call call;
    call.label = label;
    if (!enter(std::move(call), sub)) {
        return false;
    }
    if (!many.empty()) {
        executor_.parameters.keep_aside(count);
    }
    executor_.parameters.set_arguments({arguments, std::max<std::size_t>(ARGUMENT_COUNT, count)});
    if (settings_.isArgumentCountNamed) {
        executor_.parameters.set_named(names_.intern("n_args"), false, count);
    }
    executor_.parameters.commit();
    next_ = sub.line + 1;
    return true;
}

/// Back to the caller: the line after the call, or the rest of the block with the remapped code.
bool Flow::leave(double value, bool hasValue) {
    if (calls_.back().stage == Stage::PROCEDURE && !calls_.back().remap->epilog.empty()) {
        executor_.returned = {hasValue ? value : 0.0, hasValue};
        return start_stage(Stage::EPILOG);
    }
    return pop_call(value, hasValue);
}

bool Flow::pop_call(double value, bool hasValue) {
    Call call = std::move(calls_.back());
    calls_.pop_back();
    program_ = call.program;
    next_ = call.line + 1;
    repeats_ = std::move(call.repeats);
    executor_.returned = {hasValue ? value : 0.0, hasValue};
    if (!executor_.pop_call(call.kind == CallKind::FANUC)) {
        return false;
    }
    line_read_ = call.line;
    executor_.block_place = {call.line, call.line, call_level()};
    if (call.pending) {
        executor_.canon.enter_block(program_, call.line, call.line, false, call_level());
        return executor_.resume(*call.pending);
    }
    if (call.kind == CallKind::PROFILE) {
        executor_.canon.enter_block(program_, call.line, call.line, false, call_level());
        executor_.keep_state();
        return executor_.finish_lathe_cycle();
    }
    return true;
}

bool Flow::run_return(const BlockView &view, const OWord &oword) {
    if (calls_.empty() || calls_.back().kind == CallKind::TEXT) {
        return executor_.fault.set(fmt::format("'O{}' {}: not in a subroutine", label_text(oword),
                                               oword.kind == OKind::ENDSUB ? "endsub" : "return"),
                                   oword.column);
    }
    const Call &call = calls_.back();
    if (call.kind == CallKind::FANUC) {
        return executor_.fault.set(FANUC_END_TEXT, oword.column, called_from(call.label));
    }
    if (oword.kind == OKind::ENDSUB && oword.label != call.label) {
        return executor_.fault.set(
            fmt::format("o{} endsub: this is subroutine o<{}>", label_text(oword), names_.text(call.label)),
            oword.column);
    }
    double value = 0.0;
    const bool hasValue = oword.value != NO_ID;
    if (hasValue && !executor_.evaluator().value(*view.arena, oword.value, value)) {
        return false;
    }
    return leave(value, hasValue);
}

// ------------------------------------------------------------------------------------- M98, M99, remaps

bool Flow::call_fanuc() {
    const NameId label = names_.intern(fmt::format("{}", executor_.fanuc_label));
    Sub sub;
    if (!find_fanuc(label, sub)) {
        if (const int other = program_->find_sub(label); other != 0) {
            executor_.fault.line = other;
            return executor_.fault.set(OWORD_TEXT, 0, called_from(label));
        }
        note_search();
        return executor_.fault.set(
            fmt::format("There is no subroutine O{} for this M98", names_.text(label)));
    }
    if (!check_depth()) {
        return false;
    }
    commit();
    if (executor_.fanuc_count <= 0) {
        return true;
    }
    Call call;
    call.kind = CallKind::FANUC;
    call.label = label;
    call.again = executor_.fanuc_count - 1;
    if (!enter(std::move(call), sub)) {
        return false;
    }
    calls_.back().sub_line = sub.line;
    next_ = sub.line + 1;
    return true;
}

bool Flow::return_fanuc() {
    if (calls_.back().kind == CallKind::TEXT) {
        return executor_.fault.set("M99 must stand in a subroutine, not in a block that a script executes");
    }
    if (calls_.back().kind != CallKind::FANUC) {
        return executor_.fault.set(OWORD_END_TEXT, 0, called_from(calls_.back().label));
    }
    if (calls_.back().again > 0) {
        --calls_.back().again;
        next_ = calls_.back().sub_line + 1;
        note_pass(calls_.back().sub_line, line_read_);
        return true;
    }
    return leave(0.0, false);
}

/// G70 to G72 read their profile from a subroutine, then cut it.
bool Flow::call_profile() {
    Call call;
    Sub sub;
    call.kind = CallKind::PROFILE;
    call.label = names_.intern(fmt::format("{}", executor_.lathe_request()->label));
    if (!find_sub(call.label, 0, sub) || !check_depth()) {
        return false;
    }
    commit();
    if (!enter(std::move(call), sub)) {
        return false;
    }
    next_ = sub.line + 1;
    return true;
}

}  // namespace mw::interp::detail
