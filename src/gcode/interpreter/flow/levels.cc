// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/levels.hh"

#include <algorithm>
#include <iterator>

namespace mw::gcode::detail {

bool Call::isEpilogDue() const {
    return script != nullptr && script->stage == Stage::PROCEDURE && !script->pending->remap->epilog.empty();
}

std::string call_name(const Call &call, const Names &names) {
    return call.label == NO_ID ? std::string("the block of a script") : names.text(call.label);
}

const std::string &Levels::file() const {
    static const std::string NO_FILE;
    return here_.program == nullptr ? NO_FILE : here_.program->path();
}

std::string Levels::line_text() const {
    const Program *const program = here_.program;
    const bool present = program != nullptr && here_.line >= 1 && here_.line <= program->count_lines();
    return present ? std::string(program->line_text(here_.line)) : std::string();
}

NameId Levels::subroutine() const {
    for (auto call = calls_.rbegin(); call != calls_.rend(); ++call) {
        if (call->label != NO_ID) {
            return call->label;
        }
    }
    return NO_ID;
}

std::vector<SourcePlace> Levels::callers() const {
    std::vector<SourcePlace> out;
    for (auto call = calls_.rbegin(); call != calls_.rend(); ++call) {
        out.push_back({call->program->path(), call->line, 0});
    }
    return out;
}

void Levels::open(Program *program) {
    here_.program = program;
    here_.next = here_.after = 1;
}

void Levels::enter(Call &&call) {
    call.program = here_.program;
    call.line = here_.line;
    call.next = here_.line + 1;
    call.repeats = std::move(here_.repeats);
    here_.repeats.clear();
    calls_.push_back(std::move(call));
}

void Levels::enter_text(Program *text, int reported_line) {
    const int next = here_.next;
    Call call;
    call.kind = CallKind::TEXT;
    call.reported_line = reported_line > 0 ? reported_line : here_.line;
    enter(std::move(call));
    calls_.back().next = next;
    ++texts_;
    here_.program = text;
    here_.next = 1;
}

Call Levels::leave() {
    Call call = std::move(calls_.back());
    calls_.pop_back();
    texts_ -= call.kind == CallKind::TEXT ? 1 : 0;
    here_.program = call.program;
    here_.next = call.next;
    here_.repeats = std::move(call.repeats);
    return call;
}

std::vector<Call> Levels::unwind(std::size_t depth) {
    std::vector<Call> dropped;
    if (calls_.size() > depth) {
        Call &outermost = calls_[depth];
        here_.program = outermost.program;
        here_.next = outermost.next;
        here_.repeats = std::move(outermost.repeats);
        const auto first = calls_.begin() + static_cast<std::ptrdiff_t>(depth);
        dropped.assign(std::make_move_iterator(first), std::make_move_iterator(calls_.end()));
        calls_.erase(first, calls_.end());
        texts_ = static_cast<int>(std::ranges::count(calls_, CallKind::TEXT, &Call::kind));
    }
    return dropped;
}

void Levels::end_top() {
    here_.repeats.clear();
    end_mdi();
}

void Levels::begin_mdi(Program *line) {
    is_mdi_ = true;
    outer_program_ = here_.program;
    outer_next_ = here_.next;
    here_.program = line;
    here_.next = 1;
}

void Levels::end_mdi() {
    if (!is_mdi_) {
        return;
    }
    is_mdi_ = false;
    here_.program = outer_program_;
    here_.next = outer_next_;
}

}  // namespace mw::gcode::detail
