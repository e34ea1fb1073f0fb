// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/admission.hh"

#include <array>

namespace mw::task {
namespace {

constexpr auto SITUATIONS = static_cast<std::size_t>(Situation::COUNT);
constexpr auto CLASSES = static_cast<std::size_t>(CommandClass::COUNT);
using Cell = const char *;
using Row = std::array<Cell, SITUATIONS>;

constexpr Cell TAKEN = nullptr;
constexpr Cell ESTOP = "the machine is in emergency stop", OFF = "the machine is not on";
constexpr Cell RUNS = "a program or MDI line is already running",
               NOT_WHILE = "not possible while a program or MDI line is running";
constexpr Cell NEEDS_AUTO = "running a program needs auto mode",
               NEEDS_MDI = "Must be in MDI mode to issue MDI command",
               NEEDS_MANUAL = "this needs manual mode",
               HELD_AXES = "release the axes of the paused program first";
constexpr Cell NO_PAUSE = "no running program to pause", NO_RESUME = "nothing is paused",
               NO_STEP = "single step needs a program", NO_TURN = "no program is running";
constexpr Cell NO_WAY = "no approach is proposed", CONFIRM = "the proposed approach waits for confirmation",
               IS_AWAY = "the axes of the program are released: resume the program first";
constexpr Cell NOT_HELD = "the axes can only be released while a program is paused",
               NOT_LINES = "the axes of an MDI line cannot be released: abort the line";
constexpr Cell ON = "only possible while the machine is off";

constexpr Row all(Cell cell) {
    Row row{};
    row.fill(cell);
    return row;
}

/// Columns: ESTOP, OFF, MANUAL, AUTO_IDLE, AUTO_RUNNING, AUTO_HELD, AUTO_PROPOSED, AUTO_AWAY, MDI_IDLE,
/// MDI_RUNNING, MDI_HELD.
constexpr std::array<Row, CLASSES> TABLE{{
    /* ANY_TIME */ all(TAKEN),
    /* MODE */
    {TAKEN, TAKEN, TAKEN, TAKEN, NOT_WHILE, NOT_WHILE, NOT_WHILE, NOT_WHILE, TAKEN, NOT_WHILE, NOT_WHILE},
    /* PROGRAM_FILE */
    {TAKEN, TAKEN, TAKEN, TAKEN, NOT_WHILE, NOT_WHILE, NOT_WHILE, NOT_WHILE, TAKEN, NOT_WHILE, NOT_WHILE},
    /* RUN */
    {ESTOP, OFF, NEEDS_AUTO, TAKEN, RUNS, RUNS, RUNS, RUNS, NEEDS_AUTO, NEEDS_AUTO, NEEDS_AUTO},
    /* STEP */
    {ESTOP, OFF, NEEDS_AUTO, TAKEN, TAKEN, TAKEN, CONFIRM, IS_AWAY, NEEDS_AUTO, NO_STEP, TAKEN},
    /* PAUSE */
    {NO_PAUSE, NO_PAUSE, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN},
    /* RESUME */
    {NO_RESUME, NO_RESUME, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN},
    /* TURN */
    {NO_TURN, NO_TURN, NO_TURN, NO_TURN, TAKEN, TAKEN, CONFIRM, IS_AWAY, NO_TURN, TAKEN, TAKEN},
    /* MDI */
    {ESTOP, OFF, NEEDS_MDI, NEEDS_MDI, NEEDS_MDI, NEEDS_MDI, NEEDS_MDI, IS_AWAY, TAKEN, TAKEN, TAKEN},
    /* JOG */
    {ESTOP, OFF, TAKEN, NEEDS_MANUAL, NEEDS_MANUAL, HELD_AXES, HELD_AXES, TAKEN, NEEDS_MANUAL, NEEDS_MANUAL,
     NEEDS_MANUAL},
    /* TELEOP */
    {TAKEN, TAKEN, TAKEN, TAKEN, NEEDS_MANUAL, HELD_AXES, HELD_AXES, TAKEN, TAKEN, NEEDS_MANUAL,
     NEEDS_MANUAL},
    /* JOINTS */
    {ESTOP, OFF, TAKEN, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL,
     NEEDS_MANUAL, NEEDS_MANUAL},
    /* UNHOME */
    {TAKEN, TAKEN, TAKEN, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL, NEEDS_MANUAL,
     NEEDS_MANUAL, NEEDS_MANUAL},
    /* ENERGISE */
    {ESTOP, OFF, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN},
    /* TOOL_TABLE */
    {TAKEN, TAKEN, TAKEN, TAKEN, NOT_WHILE, NOT_WHILE, NOT_WHILE, TAKEN, TAKEN, NOT_WHILE, NOT_WHILE},
    /* SCREW_TABLE */ {TAKEN, TAKEN, ON, ON, ON, ON, ON, ON, ON, ON, ON},
    /* CONFIRM */
    {NO_WAY, NO_WAY, NO_WAY, NO_WAY, NO_WAY, NO_WAY, TAKEN, NO_WAY, NO_WAY, NO_WAY, NO_WAY},
    /* RELEASE */
    {ESTOP, OFF, NOT_HELD, NOT_HELD, NOT_HELD, TAKEN, TAKEN, TAKEN, NOT_HELD, NOT_LINES, NOT_LINES},
    /* OF_THE_MAILBOX */ all("only connected clients can have the right to operate"),
}};

Situation of_run(const RunState &run, Situation idle, Situation running, Situation held) {
    return !run.isRunning() ? idle : run.isHeld() ? held : running;
}

}  // namespace

CommandClass class_of(const Command &command, Mode mode) {
    const auto *spindle = std::get_if<SpindleOn>(&command);
    const auto *wanted = std::get_if<SetMode>(&command);
    if ((spindle != nullptr && spindle->speed_rpm == 0) || (wanted != nullptr && wanted->mode == mode)) {
        return CommandClass::ANY_TIME;
    }
    return std::visit([]<class T>(const T &) { return class_of<T>(); }, command);
}

Situation situation_of(State state, Mode mode, const RunState &run) {
    if (state != State::ON) {
        return state == State::ESTOP ? Situation::ESTOP : Situation::OFF;
    }
    switch (mode) {
    case Mode::MANUAL: return Situation::MANUAL;
    case Mode::MDI: return of_run(run, Situation::MDI_IDLE, Situation::MDI_RUNNING, Situation::MDI_HELD);
    case Mode::AUTO: break;
    }
    switch (run.hold()) {
    case Hold::PROPOSED: return Situation::AUTO_PROPOSED;
    case Hold::AWAY: return Situation::AUTO_AWAY;
    case Hold::GOING:
    case Hold::STEPPING:
    case Hold::HELD:
    case Hold::STOPPED:
    case Hold::COUNT: break;
    }
    return of_run(run, Situation::AUTO_IDLE, Situation::AUTO_RUNNING, Situation::AUTO_HELD);
}

const char *refusal_of(CommandClass what, Situation situation) {
    return TABLE[static_cast<std::size_t>(what)][static_cast<std::size_t>(situation)];
}

Result<> admit(CommandClass what, Situation situation) {
    const char *const refusal = refusal_of(what, situation);
    return refusal == nullptr ? Result<>{} : fail(refusal);
}

}  // namespace mw::task
