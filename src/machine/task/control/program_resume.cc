// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/program_resume.hh"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "machine/task/control/run_journal.hh"

namespace mw::task {
namespace {

/// The maximum Z position, above everything on the table.
double safe_height(const RunParts &parts) {
    constexpr unsigned Z_BIT = 1U << geometry::AXIS_Z;
    constexpr double NO_LIMIT = 1e9;
    const double highest = parts.port.motion().axis[geometry::AXIS_Z].max_limit;
    const bool known = (parts.settings.axis_mask & Z_BIT) != 0 && std::fabs(highest) < NO_LIMIT;
    return known ? highest : -NO_LIMIT;
}

/// Tool change position when the machine comes from `at`. As for M6: first the quill, then G30, then
/// TOOL_CHANGE_POSITION, which the canon adds.
geometry::Pose find_change_place(geometry::Pose at, ApproachPlan &plan, const RunParts &parts) {
    constexpr int G30 = 5181;
    const gcode::BeforeToolChange &wanted = parts.settings.interpreter.tool_change;
    plan.change_moves.clear();
    if (wanted.quill_raised) {
        at[geometry::AXIS_Z] = 0;
        plan.change_moves.push_back(at);
    }
    if (wanted.at_g30) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const bool present = (parts.settings.axis_mask >> axis & 1U) != 0;
            at[axis] = present ? parts.reader.interpreter().parameter(G30 + axis) : at[axis];
        }
        plan.change_moves.push_back(at);
    }
    const auto place = tool_change_moves(parts.settings.tool_change_place, at);
    return place.empty() ? at : place.back();
}

/// Fills in the data that do not depend on the reason of the approach: current tool and position, feed,
/// moves.
void complete(ApproachPlan &plan, const RunParts &parts) {
    constexpr double MM_PER_INCH = 25.4;
    const double units_per_mm = parts.settings.machine_units == gcode::LengthUnits::MM ? 1 : 1 / MM_PER_INCH;
    plan.tool_now = parts.io.outputs.tool_number;
    plan.feed = plan.modes.feed > 0 ? plan.modes.feed : DEFAULT_APPROACH_FEED_MM_S * units_per_mm;
    plan.from = motion::programmed_position(parts.port.motion());
    const double safe_z = safe_height(parts);
    geometry::Pose at = plan.from;
    at[geometry::AXIS_Z] = std::max(safe_z, at[geometry::AXIS_Z]);
    plan.find_way(safe_z, find_change_place(at, plan, parts));
}

}  // namespace

Result<Progress> ProgramResume::recover(mailbox::Serial command) {
    const auto opened = open_recovery();
    if (parts_.calls.end()) {
        return fail(OVERTAKEN);
    }
    return opened.has_value() ? runs_.begin(RunKind::RECOVERY, command, parts_.senders.sender())
                              : std::unexpected(opened.error());
}

/// --- checks before the calculation
Result<> ProgramResume::check_recovery() const {
    const auto offer = parts_.recovery.offer();
    if (!offer.has_value()) {
        return std::unexpected(offer.error());
    }
    if ((*offer)->progress->tools != sum_of_tools(parts_.tools)) {
        return fail(
            "the tool table has been changed since the program was interrupted", {},
            fmt::format("run it from line {}, or the nearest possible line: this uses the current tools",
                        (*offer)->progress->line));
    }
    return runs_.check_can_run();
}

Result<> ProgramResume::open_recovery() {
    auto opened = check_recovery();
    if (!opened.has_value()) {
        return opened;
    }
    const std::string &program = (*parts_.recovery.offer())->start.program;
    opened = parts_.calls.beside([&] { return parts_.senders.check_file(program); });
    opened = opened.has_value() ? parts_.reader.open(program) : opened;
    if (opened.has_value()) {
        parts_.run.set_program(program);
        parts_.senders.note_opened();
    }
    return opened;
}

Result<Progress> ProgramResume::resume() {
    if (!parts_.run.isHeld()) {
        return Progress::DONE;
    }
    if (parts_.run.hold() == Hold::PROPOSED) {
        return confirm(0);
    }
    return isReturnNeeded() ? come_back() : runs_.resume();
}

Result<Progress> ProgramResume::step_program(mailbox::Serial command) {
    if (!parts_.run.isRunning()) {
        const auto started = runs_.run_program(command, 0);
        return started.has_value() ? runs_.step_first() : started;
    }
    if (isReturnNeeded()) {
        return fail("spindle, coolant or tool were changed after the program was paused", {},
                    "resume restores them");
    }
    return runs_.step_once();
}

Result<Progress> ProgramResume::release(mailbox::Serial command) {
    const Hold hold = parts_.run.hold();
    const bool away = hold == Hold::AWAY;
    if (away && parts_.port.motion().mode != motion::Mode::COORD) {
        return Progress::DONE;
    }
    if (parts_.run.phase() < RunPhase::READING) {
        return fail("the program has not begun");
    }
    if (!away && hold != Hold::PROPOSED) {
        const auto taken = paused_.take_path_back();
        if (!taken.has_value()) {
            return std::unexpected(taken.error());
        }
    }
    // The axes are released, but motion rejected the mode because it had not stopped; requests it again.
    const auto released = away ? Result<>{} : parts_.run.take(RunEvent::RELEASE);
    if (!released.has_value()) {
        return std::unexpected(released.error());
    }
    approach_.forget();
    return modes_.release_axes(command);
}

/// Resumes a program that needs preparation: a return path, and outputs to be switched on again.
Result<Progress> ProgramResume::come_back() {
    const motion::Status &motion = parts_.port.motion();
    const bool away = parts_.run.hold() == Hold::AWAY;
    if (away && !motion.isInPosition) {
        return fail("the machine is moving");
    }
    if (paused_.areToolsChanged()) {
        return calculate_again();
    }
    const auto taken = away ? Result<>{} : paused_.take_path_back();
    const auto proposed = taken.has_value() ? parts_.run.take(RunEvent::PROPOSE) : taken;
    if (!proposed.has_value()) {
        return std::unexpected(proposed.error());
    }
    if (motion.mode != motion::Mode::COORD) {
        parts_.port.send(motion::SetMode{motion::Mode::COORD});
    }
    propose(paused_.plan_back());
    return Progress::DONE;
}

Result<Progress> ProgramResume::calculate_again() {
    const auto refused = [](const Error &why) {
        return fail("the tool table has changed after moves were read ahead: " + why.str(), {},
                    "abort, and run from the line");
    };
    const Result<> called = parts_.run.isProgram()
                                ? parts_.recovery.call_back(paused_.place(), parts_.reader.canon().marks())
                                : fail("it is an MDI line");
    if (!called.has_value()) {
        return refused(called.error());
    }
    parts_.reader.queue().clear();
    parts_.reader.return_to_executed();
    const Result<> opened = parts_.reader.open(parts_.run.program().str());
    if (parts_.calls.end()) {
        return fail(OVERTAKEN);
    }
    if (!opened.has_value()) {
        parts_.recovery.refuse(opened.error().str());
        return refused(opened.error());
    }
    if (parts_.port.motion().mode != motion::Mode::COORD) {
        parts_.port.send(motion::SetMode{motion::Mode::COORD});
    }
    parts_.run.recalculate();
    parts_.begin_blocks();
    return Progress::DONE;
}

bool ProgramResume::step() {
    const ProgramRun &run = parts_.run;
    if (run.phase() == RunPhase::STARTING && run.isSearched()) {
        // After an abort motion may still brake; a run begins at standstill.
        if (!parts_.port.motion().isInPosition) {
            return true;
        }
        begin_search();
    }
    if (run.phase() != RunPhase::SEARCHING) {
        return false;
    }
    if (parts_.reader.search() != nullptr && !approach_.isOpen()) {
        const BlockSearch::Outcome outcome = parts_.reader.step_search(parts_.settings.blocks_per_cycle);
        if (parts_.calls.end()) {
            return true;
        }
        if (outcome == BlockSearch::Outcome::FOUND) {
            take_found();
        } else if (outcome == BlockSearch::Outcome::REFUSED) {
            const std::string &refusal = parts_.reader.search()->refusal();
            if (run.isRecovery()) {
                parts_.recovery.refuse(refusal);
            }
            give_up(refusal);
        }
    }
    return true;
}

/// The program is open, the axes are stopped.
void ProgramResume::begin_search() {
    parts_.run.change(RunEvent::SEARCH);
    parts_.synch_interpreter();
    if (!parts_.run.isRecovery()) {
        prepare_journal(parts_);
        const auto begun = parts_.reader.begin_search(parts_.run.from_line());
        if (!begun.has_value()) {
            give_up(begun.error().str());
        }
        return;
    }
    const auto offer = parts_.recovery.offer();
    if (!offer.has_value()) {
        give_up(offer.error().str());
        return;
    }
    auto record = StartRecord::unpack((*offer)->start.state);
    if (record.has_value() && record->confined) {
        parts_.senders.limit_run();
    }
    begin_block_search(record.has_value() ? Result<StartRecord>(std::move(*record))
                                          : fail("its state was written by another version"),
                       (*offer)->progress->calls);
}

void ProgramResume::begin_block_search(Result<StartRecord> record, std::optional<std::uint64_t> calls) {
    const auto block = static_cast<std::uint32_t>((*parts_.recovery.offer())->progress->block);
    const Result<> begun = record.has_value()
                               ? parts_.reader.begin_recovery(std::move(*record), {block, calls})
                               : std::unexpected(record.error());
    if (!begun.has_value()) {
        parts_.recovery.refuse(begun.error().str());
        give_up(begun.error().str());
    }
}

void ProgramResume::begin_with_tools_now() {
    const FoundModes found = parts_.reader.search()->found();
    auto record = with_tools_now(parts_.reader.recorded(), found, parts_.tools);
    parts_.reader.cancel_search();
    parts_.run.continue_with_current_tools();
    const Result<> opened = parts_.reader.open((*parts_.recovery.offer())->start.program);
    if (parts_.calls.end()) {
        return;
    }
    if (!opened.has_value()) {
        record = std::unexpected(opened.error());
    }
    begin_block_search(std::move(record), std::nullopt);
}

/// `reason` is a copy, because the search that owns it ends here.
void ProgramResume::give_up(std::string reason) {
    approach_.forget();
    if (parts_.reader.search() != nullptr) {
        parts_.reader.cancel_search();
    }
    parts_.port.post_error(reason);
    parts_.run.set_error({diagnostics::Severity::ERROR, {reason}});
    if (parts_.run.isHeld()) {
        parts_.port.send(motion::Resume{});  // nothing is paused now
    }
    end_.finish(Progress::FAILED, reason);
}

void ProgramResume::take_found() {
    const RunKind kind = parts_.run.kind();
    if (kind == RunKind::RECALCULATION) {
        begin_with_tools_now();
    } else if (kind == RunKind::WITH_CURRENT_TOOLS && isOldOffsetKept()) {
        give_up("the active tool offset is not from the current table: no G43 of the program has set it");
    } else {
        propose_found();
    }
}

/// True if an offset that the program has not read from the table remains unchanged.
bool ProgramResume::isOldOffsetKept() const {
    const FoundModes found = parts_.reader.search()->found();
    const int index = found.tool > 0 ? parts_.tools.index_of_tool(found.tool) : -1;
    const geometry::Pose before = parts_.actions.offsets().tool;
    const bool same = found.tool_offset.has_value() && found.tool_offset->offset == before;
    return index >= 0 && same && before != geometry::Pose{} && parts_.tools.entry(index).offset != before;
}

void ProgramResume::propose_found() {
    const bool recovery = parts_.run.isRecovery();
    ApproachPlan plan;
    plan.to = recovery ? ApproachTo::PLACE_LOST : ApproachTo::LINE;
    plan.line = recovery ? (*parts_.recovery.offer())->progress->line : parts_.run.from_line();
    plan.modes = parts_.reader.search()->found();
    complete(plan, parts_);
    if (recovery || plan.isNeeded()) {
        parts_.run.change(RunEvent::PROPOSE);
        propose(std::move(plan));
    } else {
        parts_.run.change(RunEvent::BEGUN);
        go_on(plan);
    }
}

void ProgramResume::propose(ApproachPlan plan) {
    complete(plan, parts_);
    const std::string way = approach_text(plan);
    parts_.port.post(MessageKind::OPERATOR_TEXT,
                     fmt::format("to continue at line {}: {}; resume confirms it, abort drops it", plan.line,
                                 way.empty() ? "nothing has to be changed" : way));
    approach_.propose(std::move(plan), parts_.port.now_ns());
    parts_.sequencer.set_stepping(false);  // a step that was requested in the meantime ends here
}

Result<Progress> ProgramResume::confirm(std::uint64_t number) {
    auto allowed = approach_.check(number, parts_.port.now_ns());
    if (allowed.has_value() && !parts_.port.motion().isInPosition) {
        allowed = fail("the machine is moving");
    }
    if (allowed.has_value() && parts_.port.motion().mode != motion::Mode::COORD) {
        allowed = fail("motion is not in coordinated mode");
    }
    allowed = allowed.has_value() ? parts_.run.take(RunEvent::CONFIRM) : allowed;
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const ApproachPlan plan = approach_.plan();
    approach_.forget();
    go_on(plan);
    parts_.port.send(motion::Resume{});
    return Progress::DONE;
}

/// The calls of the approach come first, then the calls of the program from the line on.
void ProgramResume::go_on(const ApproachPlan &plan) {
    auto last = gcode::Step::OK;
    if (parts_.reader.search() != nullptr) {
        last = parts_.run.isRecovery() ? parts_.reader.search()->last_step() : last;
        accept_search();
    }
    parts_.reader.canon().insert_first(plan.calls(), motion::programmed_position(parts_.port.motion()),
                                       plan.line, parts_.reader.executed());
    runs_.take_step(last);
}

void ProgramResume::accept_search() {
    ProgramReader &reader = parts_.reader;
    const bool recovery = parts_.run.isRecovery();
    if (recovery) {
        const StartRecord &record = reader.recorded();
        if (parts_.run.kind() == RunKind::RECOVERY) {  // as before the interruption
            parts_.world.set_block_delete(record.isBlockDelete);
            parts_.world.set_optional_stop(record.isOptionalStop);
        }
        parts_.recovery.begin_again(record, reader.search()->sum().value(), sum_of_tools(parts_.tools));
    }
    reader.accept_search();
    reader.note_codes();
    if (!recovery) {
        begin_journal(parts_, reader.canon().blocks() + 1);
    }
}

}  // namespace mw::task
