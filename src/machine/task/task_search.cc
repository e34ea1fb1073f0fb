// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "machine/task/program_resume.hh"
#include "machine/task/task_apart.hh"

namespace mw::task {

void Task::ProgramResume::begin() {
    task.run_.change(RunEvent::SEARCH);
    task.synch_interpreter();
    prepare_journal();
    const auto begun = task.reader_.begin_search(task.run_.from_line());
    if (!begun.has_value()) {
        give_up(begun.error().str());
    }
}

void Task::ProgramResume::step() {
    if (task.reader_.search() == nullptr || task.approach_.isOpen()) {
        return;
    }
    const BlockSearch::Outcome outcome = task.reader_.step_search(task.settings_.blocks_per_cycle);
    if (Meanwhile{task}.end()) {
        return;
    }
    switch (outcome) {
    case BlockSearch::Outcome::GOING: break;
    case BlockSearch::Outcome::FOUND:
        task.run_.kind() == RunKind::RECALCULATION ? begin_with_tools_now()
        : task.run_.isRecovery()                   ? propose_recovery()
                                                   : propose_line();
        break;
    case BlockSearch::Outcome::REFUSED:
        if (task.run_.isRecovery()) {
            task.recovery_.refuse(task.reader_.search()->refusal());
        }
        give_up(task.reader_.search()->refusal());
        break;
    }
}

/// `reason` is a copy: the search that owns it ends here.
void Task::ProgramResume::give_up(std::string reason) {
    drop();
    task.post(MessageKind::OPERATOR_ERROR, reason);
    task.run_.set_error({diagnostics::Severity::ERROR, {reason}});
    if (task.run_.isHeld()) {
        task.motion_.send(motion::Resume{});  // nothing is paused any more
    }
    task.finish_run(Progress::FAILED, reason);
}

void Task::ProgramResume::drop() {
    task.approach_.forget();
    if (task.reader_.search() != nullptr) {
        task.reader_.cancel_search();
    }
}

/// The maximum Z position, above everything on the table.
double Task::ProgramResume::safe_height() const {
    constexpr unsigned Z_BIT = 1U << geometry::AXIS_Z;
    constexpr double NO_LIMIT = 1e9;
    const double highest = task.motion_.status().axis[geometry::AXIS_Z].max_limit;
    const bool known = (task.settings_.axis_mask & Z_BIT) != 0 && std::fabs(highest) < NO_LIMIT;
    return known ? highest : -NO_LIMIT;
}

void Task::ProgramResume::complete(ApproachPlan &plan) const {
    constexpr double MM_PER_INCH = 25.4;
    const double units_per_mm = task.settings_.machine_units == gcode::LengthUnits::MM ? 1 : 1 / MM_PER_INCH;
    plan.feed = plan.modes.feed > 0 ? plan.modes.feed : DEFAULT_APPROACH_FEED_MM_S * units_per_mm;
    plan.from = motion::programmed_position(task.motion_.status());
    geometry::Pose at = plan.from;
    at[geometry::AXIS_Z] = std::max(safe_height(), at[geometry::AXIS_Z]);
    plan.find_way(safe_height(), find_change_place(at, plan));
}

/// As M6: the quill, G30, then TOOL_CHANGE_POSITION, which the canon adds.
geometry::Pose Task::ProgramResume::find_change_place(geometry::Pose at, ApproachPlan &plan) const {
    constexpr int G30 = 5181;
    const gcode::BeforeToolChange &wanted = task.settings_.interpreter.tool_change;
    plan.change_moves.clear();
    if (wanted.quill_raised) {
        at[geometry::AXIS_Z] = 0;
        plan.change_moves.push_back(at);
    }
    if (wanted.at_g30) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const bool present = (task.settings_.axis_mask >> axis & 1U) != 0;
            at[axis] = present ? task.reader_.interpreter().parameter(G30 + axis) : at[axis];
        }
        plan.change_moves.push_back(at);
    }
    const auto place = tool_change_moves(task.settings_.tool_change_place, at);
    return place.empty() ? at : place.back();
}

void Task::ProgramResume::propose_line() {
    ApproachPlan plan;
    plan.to = ApproachTo::LINE;
    plan.line = task.run_.from_line();
    plan.modes = task.reader_.search()->found();
    plan.tool_now = task.io_.outputs.tool_number;
    complete(plan);
    if (!plan.isNeeded()) {
        task.run_.change(RunEvent::BEGUN);
        go_on(plan);
        return;
    }
    task.run_.change(RunEvent::PROPOSE);
    propose(std::move(plan));
}

void Task::ProgramResume::propose(ApproachPlan plan) {
    complete(plan);
    const std::string way = approach_text(plan);
    task.post(MessageKind::OPERATOR_TEXT,
              fmt::format("to continue at line {}: {}; resume confirms it, abort drops it", plan.line,
                          way.empty() ? "nothing has to be changed" : way));
    task.approach_.propose(std::move(plan), task.now_ns_);
}

/// Restores block delete and optional stop as they were before the interruption.
void Task::ProgramResume::restore_switches(const StartRecord &record) {
    if (task.run_.kind() == RunKind::RECOVERY) {
        task.world_.set_block_delete(record.isBlockDelete);
        task.world_.set_optional_stop(record.isOptionalStop);
    }
}

/// The calls of the approach come first, then those of the program from the line on.
void Task::ProgramResume::go_on(const ApproachPlan &plan) {
    auto last = gcode::Step::OK;
    if (task.reader_.search() != nullptr) {
        const bool is_recovery = task.run_.isRecovery();
        last = is_recovery ? task.reader_.search()->last_step() : last;
        if (is_recovery) {
            restore_switches(task.reader_.recorded());
            task.recovery_.begin_again(task.reader_.recorded(), task.reader_.search()->sum().value(),
                                       sum_of_tools(task.parts_.tools));
        }
        task.reader_.accept_search();
        task.reader_.note_codes();
        if (!is_recovery) {
            begin_journal(task.reader_.canon().blocks() + 1);
        }
    }
    task.reader_.canon().insert_first(plan.calls(), motion::programmed_position(task.motion_.status()),
                                      plan.line, task.reader_.executed());
    task.on_step_result(last);
}

Result<Progress> Task::ProgramResume::confirm(std::uint64_t number) {
    auto allowed = task.approach_.check(number, task.now_ns_);
    if (allowed.has_value() && !task.motion_.status().isInPosition) {
        allowed = fail("the machine is moving");
    }
    if (allowed.has_value() && task.motion_.status().mode != motion::Mode::COORD) {
        allowed = fail("motion is not in coordinated mode");
    }
    allowed = allowed.has_value() ? task.run_.take(RunEvent::CONFIRM) : allowed;
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const ApproachPlan plan = task.approach_.plan();
    task.approach_.forget();
    go_on(plan);
    task.motion_.send(motion::Resume{});
    return Progress::DONE;
}

}  // namespace mw::task
