// SPDX-License-Identifier: GPL-2.0-or-later
// The journal of a running program, and continuing an interrupted one (docs/integrator/journal.md).
#include <cmath>

#include <fmt/format.h>

#include "machine/task/program_resume.hh"
#include "machine/task/task_apart.hh"

namespace mw::task {

/// A program will start; the interpreter has been synched and has read none of it.
void Task::ProgramResume::prepare_journal() {
    if (!task.recovery_.isOn() || !task.run_.isProgram()) {
        return;
    }
    StartRecord record;
    record.confined = task.senders_.isRunConfined();
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

void Task::ProgramResume::begin_journal(std::uint32_t first_block) {
    const std::string dropped = task.recovery_.begin(first_block);
    if (!dropped.empty()) {
        task.post(MessageKind::OPERATOR_TEXT, dropped);
    }
}

/// Once a cycle.
void Task::ProgramResume::show_journal() {
    while (const auto trouble = task.recovery_.take_trouble()) {
        task.post(MessageKind::OPERATOR_ERROR, *trouble);
    }
    task.recovery_.show(task.status_.recovery);
}

/// Once a cycle, after the status: clients that survive a crash have seen at least the state in the journal.
void Task::ProgramResume::note_place() {
    const bool active =
        task.run_.isProgram() && task.run_.phase() >= RunPhase::READING && task.run_.hold() != Hold::PROPOSED;
    if (active && task.recovery_.isOn()) {
        const motion::SourceTag source = task.sequencer_.place().source;
        const geometry::Pose place = motion::programmed_position(task.motion_.status());
        task.recovery_.step(task.now_ns_, {source.block, source.line, place, task.io_.outputs.tool_number},
                            task.reader_.canon().marks(), task.parts_.tools);
    }
}

/// After each step of the interpreter.
void Task::ProgramResume::note_doubt() {
    const std::string doubt = task.recovery_.isOn() && task.run_.isProgram() ? task.reader_.take_doubt() : "";
    if (!doubt.empty()) {
        task.recovery_.note_doubt(task.reader_.canon().blocks(), task.reader_.main_line(), doubt);
    }
}

/// Checks before the calculation.
Result<> Task::ProgramResume::check_recovery() const {
    const auto offer = task.recovery_.offer();
    if (!offer.has_value()) {
        return std::unexpected(offer.error());
    }
    if ((*offer)->progress->tools != sum_of_tools(task.parts_.tools)) {
        return fail("the tool table has been changed since the program was interrupted", {},
                    fmt::format("run it from line {}, or the nearest possible: that uses the tools "
                                "as they are now",
                                (*offer)->progress->line));
    }
    return {};
}

Result<> Task::ProgramResume::open_recovery() {
    auto opened = check_recovery();
    opened = opened.has_value() ? task.check_can_run() : opened;
    if (!opened.has_value()) {
        return opened;
    }
    const std::string &program = (*task.recovery_.offer())->start.program;
    opened = Meanwhile{task}.beside([&] { return task.senders_.check_file(program); });
    opened = opened.has_value() ? task.reader_.open(program) : opened;
    if (opened.has_value()) {
        task.status_.task.program.assign(program);
        task.senders_.note_opened();
    }
    return opened;
}

/// The program is open, the axes are stopped.
void Task::ProgramResume::begin_recovery() {
    task.run_.change(RunEvent::SEARCH);
    task.synch_interpreter();
    const auto offer = task.recovery_.offer();
    if (!offer.has_value()) {
        give_up(offer.error().str());
        return;
    }
    auto record = StartRecord::unpack((*offer)->start.state);
    if (record.has_value() && record->confined) {
        task.senders_.limit_run();
    }
    begin_block_search(record.has_value() ? Result<StartRecord>(std::move(*record))
                                          : fail("its state was written by another version"),
                       (*offer)->progress->calls);
}

void Task::ProgramResume::begin_block_search(Result<StartRecord> record, std::optional<std::uint64_t> calls) {
    const auto block = static_cast<std::uint32_t>((*task.recovery_.offer())->progress->block);
    const Result<> begun = record.has_value()
                               ? task.reader_.begin_recovery(std::move(*record), {block, calls})
                               : std::unexpected(record.error());
    if (!begun.has_value()) {
        task.recovery_.refuse(begun.error().str());
        give_up(begun.error().str());
    }
}

Result<Progress> Task::ProgramResume::calculate_again() {
    const auto refused = [](const Error &why) {
        return fail("the tool table has changed after moves were read ahead: " + why.str(), {},
                    "abort, and run from the line");
    };
    const motion::SourceTag source = task.sequencer_.place().source;
    const std::string program = task.status_.task.program.str();
    const Result<> called =
        task.run_.isProgram()
            ? task.recovery_.call_back({source.block, source.line, task.left_->position, task.left_->tool},
                                       task.reader_.canon().marks())
            : fail("it is a line of MDI");
    if (!called.has_value()) {
        return refused(called.error());
    }
    task.reader_.queue().clear();
    task.reader_.return_to_executed();
    const Result<> opened = task.reader_.open(program);
    if (Meanwhile{task}.end()) {
        return fail(OVERTAKEN);
    }
    if (!opened.has_value()) {
        task.recovery_.refuse(opened.error().str());
        return refused(opened.error());
    }
    if (task.motion_.status().mode != motion::Mode::COORD) {
        task.motion_.send(motion::SetMode{motion::Mode::COORD});
    }
    task.run_.recalculate();
    task.reader_.canon().reset();
    task.sequencer_.forget_place();
    task.reader_.begin_codes();
    return Progress::DONE;
}

/// The calculated program is the one that ran: calculates it again with the current tools.
void Task::ProgramResume::begin_with_tools_now() {
    const FoundModes found = task.reader_.search()->found();
    auto record = with_tools_now(task.reader_.recorded(), found, task.parts_.tools);
    task.reader_.cancel_search();
    task.run_.continue_with_current_tools();
    const Result<> opened = task.reader_.open((*task.recovery_.offer())->start.program);
    if (Meanwhile{task}.end()) {
        return;
    }
    if (!opened.has_value()) {
        record = std::unexpected(opened.error());
    }
    begin_block_search(std::move(record), std::nullopt);
}

/// An offset that the program has not taken from the table does not change.
bool Task::ProgramResume::isOldOffsetKept() const {
    const FoundModes found = task.reader_.search()->found();
    const int index = found.tool > 0 ? task.parts_.tools.index_of_tool(found.tool) : -1;
    const geometry::Pose before = task.status_.offsets.tool;
    const bool same = found.tool_offset.has_value() && found.tool_offset->offset == before;
    return index >= 0 && same && before != geometry::Pose{} &&
           task.parts_.tools.entry(index).offset != before;
}

void Task::ProgramResume::propose_recovery() {
    if (task.run_.kind() == RunKind::WITH_CURRENT_TOOLS && isOldOffsetKept()) {
        give_up("the active tool offset is not from the current table: no G43 of the program has set it");
        return;
    }
    ApproachPlan plan;
    plan.to = ApproachTo::PLACE_LOST;
    plan.line = (*task.recovery_.offer())->progress->line;
    plan.modes = task.reader_.search()->found();
    plan.tool_now = task.io_.outputs.tool_number;
    task.run_.change(RunEvent::PROPOSE);
    propose(std::move(plan));
}

}  // namespace mw::task
