// SPDX-License-Identifier: GPL-2.0-or-later
// The journal of a program that runs, and going on with one that was cut short (docs/task/journal.md).
#include <cmath>

#include <fmt/format.h>

#include "task/task_start.hh"

namespace mw::task {

/// A program is to begin; the interpreter has been synched and nothing of it is read.
void Task::Start::prepare_journal() {
    if (!task.recovery_.isOn() || !task.run_.isProgram()) {
        return;
    }
    StartRecord record;
    record.machine = task.world_.snapshot();
    record.isBlockDelete = task.world_.isBlockDeleteOn();
    record.isOptionalStop = task.world_.isOptionalStopOn();
    for (int i = 0; i < task.parts_.tools.count(); ++i) {
        record.tools.push_back(task.parts_.tools.entry(i));
    }
    record.add_spindles(task.sequencer_.spindles().starts());
    const motion::Status &motion = task.motion_.status();
    record.digital_out = motion.digital_out;
    record.analog_out.assign(motion.analog_out.begin(), motion.analog_out.end());
    const auto kept = task.reader_.keep_start(record);
    task.reader_.begin_marks();
    task.recovery_.prepare(task.status_.task.program.str(), record,
                           kept.has_value() ? "" : kept.error().message);
}

void Task::Start::begin_journal(std::uint32_t first_block) {
    const std::string dropped = task.recovery_.begin(first_block);
    if (!dropped.empty()) {
        task.post(MessageKind::OPERATOR_TEXT, dropped);
    }
}

/// Once a cycle.
void Task::Start::show_journal() {
    while (const auto trouble = task.recovery_.take_trouble()) {
        task.post(MessageKind::OPERATOR_ERROR, *trouble);
    }
    task.recovery_.show(task.status_.recovery);
}

/// Once a cycle, after the status: no client that outlives a crash has seen less than the journal says.
void Task::Start::note_place() {
    const bool isUnderWay =
        task.run_.isProgram() && task.run_.phase() >= RunPhase::READING && task.run_.hold() != Hold::PROPOSED;
    if (isUnderWay && task.recovery_.isOn()) {
        const motion::SourceTag source = task.sequencer_.under_way();
        const geom::Pose place = motion::programmed_position(task.motion_.status());
        task.recovery_.step(task.now_ns_, {source.block, source.line, place, task.io_.outputs.tool_number},
                            task.reader_.canon().marks(), task.parts_.tools);
    }
}

/// After each step of the interpreter.
void Task::Start::note_doubt() {
    const std::string doubt = task.recovery_.isOn() && task.run_.isProgram() ? task.reader_.take_doubt() : "";
    if (!doubt.empty()) {
        task.recovery_.note_doubt(task.reader_.canon().blocks(), task.reader_.main_line(), doubt);
    }
}

/// What is asked before anything is calculated.
Result<> Task::Start::check_recovery() const {
    const auto offer = task.recovery_.offer();
    if (!offer.has_value()) {
        return std::unexpected(offer.error());
    }
    if ((*offer)->progress->tools != sum_of_tools(task.parts_.tools)) {
        return fail("the tool table has been changed since the program was cut short", {},
                    fmt::format("run it from line {}, or the nearest that can: that reckons with the tools "
                                "as they are now",
                                (*offer)->progress->line));
    }
    return {};
}

Result<> Task::Start::open_recovery() {
    auto opened = check_recovery();
    opened = opened.has_value() ? task.check_can_run() : opened;
    if (!opened.has_value()) {
        return opened;
    }
    const std::string &program = (*task.recovery_.offer())->start.program;
    opened = task.reader_.interpreter().open(program);
    if (opened.has_value()) {
        task.status_.task.program.assign(program);
    }
    return opened;
}

/// The program is open, the axes are at rest.
void Task::Start::begin_recovery() {
    task.run_.change(RunEvent::SEARCH);
    task.synch_interpreter();
    const auto offer = task.recovery_.offer();
    if (!offer.has_value()) {
        give_up(offer.error().str());
        return;
    }
    auto record = StartRecord::unpack((*offer)->start.state);
    const auto begun = record.has_value()
                           ? task.reader_.begin_recovery(
                                 std::move(*record), {static_cast<std::uint32_t>((*offer)->progress->block),
                                                      (*offer)->progress->calls})
                           : fail("its state was written by another version");
    if (!begun.has_value()) {
        task.recovery_.refuse(begun.error().str());
        give_up(begun.error().str());
    }
}

void Task::Start::propose_recovery() {
    ApproachPlan plan;
    plan.to = ApproachTo::PLACE_LOST;
    plan.line = (*task.recovery_.offer())->progress->line;
    plan.modes = task.reader_.search().found();
    plan.tool_now = task.io_.outputs.tool_number;
    task.run_.change(RunEvent::PROPOSE);
    propose(std::move(plan));
}

}  // namespace mw::task
