// SPDX-License-Identifier: GPL-2.0-or-later
// Tests every event in every state. The expectations are rules about a run, not a copy of the table.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "machine/task/run/run_state.hh"

namespace mw::task {
namespace {

using enum RunEvent;

template <class E>
std::vector<E> all() {
    std::vector<E> values;
    for (int i = 0; i < static_cast<int>(E::COUNT); ++i) {
        values.push_back(static_cast<E>(i));
    }
    return values;
}

/// Events that lead to each phase and hold.
RunState in(RunPhase phase, Hold hold) {
    RunState run;
    std::vector<RunEvent> way;
    switch (phase) {
    case RunPhase::COUNT:
    case RunPhase::IDLE: break;
    case RunPhase::CLEANING: way = {CLEAN}; break;
    case RunPhase::STARTING: way = {START}; break;
    case RunPhase::SEARCHING: way = {START, SEARCH}; break;
    case RunPhase::READING: way = {START, BEGUN}; break;
    case RunPhase::SYNCHING: way = {START, BEGUN, SYNC}; break;
    case RunPhase::FINISHING: way = {START, BEGUN, READ}; break;
    }
    // Before a program begins it cannot be released; it is proposed, then read.
    const std::vector<RunEvent> held = hold == Hold::HELD       ? std::vector{PAUSE}
                                       : hold == Hold::STOPPED  ? std::vector{PROGRAM_STOP}
                                       : hold == Hold::STEPPING ? std::vector{PAUSE, STEP}
                                       : hold == Hold::AWAY     ? std::vector{PAUSE, RELEASE}
                                       : hold == Hold::PROPOSED ? std::vector{PAUSE, PROPOSE}
                                                                : std::vector<RunEvent>{};
    way.insert(way.end(), held.begin(), held.end());
    for (const RunEvent event : way) {
        EXPECT_TRUE(run.take(event).has_value());
    }
    EXPECT_EQ(run.phase(), phase);
    EXPECT_EQ(run.hold(), hold);
    return run;
}

std::vector<RunState> all_states() {
    std::vector<RunState> states{in(RunPhase::IDLE, Hold::GOING), in(RunPhase::CLEANING, Hold::GOING)};
    for (const RunPhase phase : {RunPhase::STARTING, RunPhase::SEARCHING, RunPhase::READING,
                                 RunPhase::SYNCHING, RunPhase::FINISHING}) {
        for (const Hold hold : all<Hold>()) {
            const bool started = phase >= RunPhase::READING;
            const bool possible = hold == Hold::AWAY       ? started
                                  : hold == Hold::PROPOSED ? started || phase == RunPhase::SEARCHING
                                                           : true;
            if (possible) {
                states.push_back(in(phase, hold));
            }
        }
    }
    return states;
}

std::string what(const RunState &run, RunEvent event) {
    return "phase " + std::to_string(static_cast<int>(run.phase())) + " hold " +
           std::to_string(static_cast<int>(run.hold())) + " event " + std::to_string(static_cast<int>(event));
}

TEST(RunState, ARefusedEventChangesNothingAndSaysWhy) {
    int refused = 0, taken = 0;
    for (const RunState &state : all_states()) {
        for (const RunEvent event : all<RunEvent>()) {
            RunState run = state;
            const auto outcome = run.take(event);
            ++(outcome.has_value() ? taken : refused);
            if (!outcome.has_value()) {
                EXPECT_EQ(run.phase(), state.phase()) << what(state, event);
                EXPECT_EQ(run.hold(), state.hold()) << what(state, event);
                EXPECT_NE(outcome.error().message, "") << what(state, event);
            }
        }
    }
    EXPECT_EQ(refused + taken, (2 + 4 + 5 + 3 * 6) * 18);
    EXPECT_GT(refused, 50);
    EXPECT_GT(taken, 50);
}

bool may_step(const RunState &run) {
    return run.isRunning() && run.hold() != Hold::AWAY && run.hold() != Hold::PROPOSED;
}

TEST(RunState, WhatEachEventDoesInEveryState) {
    for (const RunState &before : all_states()) {
        for (const RunEvent event : all<RunEvent>()) {
            RunState run = before;
            const bool is_taken = run.take(event).has_value();
            const bool running = before.isRunning(), away = before.hold() == Hold::AWAY;
            const bool stopped = before.hold() == Hold::HELD || before.hold() == Hold::STOPPED;
            const bool stepping = before.hold() == Hold::STEPPING;
            const RunPhase phase = before.phase();
            const std::string where = what(before, event);
            switch (event) {
            case START:
                EXPECT_EQ(is_taken, !running) << where;
                EXPECT_EQ(run.isHeld(), before.isHeld()) << where;
                break;
            case BEGUN:
                EXPECT_EQ(is_taken, phase == RunPhase::STARTING || phase == RunPhase::SEARCHING) << where;
                EXPECT_EQ(run.hold(), before.hold()) << where;
                break;
            case SEARCH: EXPECT_EQ(is_taken, before.phase() == RunPhase::STARTING) << where; break;
            case SYNC: EXPECT_EQ(is_taken, before.phase() == RunPhase::READING) << where; break;
            case SYNCED: EXPECT_EQ(is_taken, before.phase() == RunPhase::SYNCHING) << where; break;
            case READ: EXPECT_EQ(is_taken, before.phase() >= RunPhase::READING) << where; break;
            case END:
                EXPECT_TRUE(is_taken && !run.isRunning() && run.hold() == Hold::GOING) << where;
                EXPECT_EQ(run.phase() == RunPhase::CLEANING, before.phase() == RunPhase::CLEANING) << where;
                break;
            case CLEAN: EXPECT_EQ(is_taken, !running) << where; break;
            case CLEANED:
                EXPECT_TRUE(is_taken && run.phase() != RunPhase::CLEANING) << where;
                EXPECT_EQ(run.isRunning(), running) << where;
                break;
            case PAUSE:
                EXPECT_EQ(is_taken, running) << where;
                EXPECT_EQ(run.isHeld(), running) << where;
                EXPECT_TRUE(!before.isHeld() || run.hold() == before.hold()) << where;
                break;
            case RESUME:
                EXPECT_EQ(is_taken, before.isHeld() && !away) << where;
                EXPECT_EQ(run.isHeld(), away) << where;
                break;
            case STEP:
                EXPECT_EQ(is_taken, may_step(before)) << where;
                EXPECT_EQ(run.hold() == Hold::STEPPING, stopped || stepping) << where;
                EXPECT_EQ(run.hold() == Hold::HELD, is_taken && before.hold() == Hold::GOING) << where;
                break;
            case STEP_MOVE:
                EXPECT_EQ(is_taken, may_step(before)) << where;
                EXPECT_EQ(run.isHeld(), before.isHeld() || (is_taken && !stepping)) << where;
                break;
            case STEP_DONE:
                EXPECT_EQ(is_taken, before.hold() == Hold::STEPPING) << where;
                EXPECT_TRUE(!is_taken || run.hold() == Hold::HELD) << where;
                break;
            case PROGRAM_STOP:
                EXPECT_EQ(is_taken, running) << where;
                EXPECT_TRUE(!is_taken || run.isHeld()) << where;
                EXPECT_TRUE(!before.isHeld() || stopped || run.hold() == before.hold()) << where;
                break;
            case RELEASE:
                EXPECT_EQ(is_taken, before.isHeld() && before.phase() >= RunPhase::READING) << where;
                EXPECT_EQ(run.hold() == Hold::AWAY, is_taken || away) << where;
                break;
            case PROPOSE:
                EXPECT_TRUE(!is_taken || run.hold() == Hold::PROPOSED) << where;
                EXPECT_TRUE(is_taken || !away) << where;
                EXPECT_TRUE(is_taken || !stopped || before.phase() < RunPhase::SEARCHING) << where;
                break;
            case CONFIRM:
                EXPECT_EQ(is_taken, before.hold() == Hold::PROPOSED) << where;
                EXPECT_TRUE(!is_taken || run.hold() == Hold::GOING) << where;
                EXPECT_TRUE(!is_taken || run.phase() >= RunPhase::READING) << where;
                break;
            case COUNT: break;
            }
            const bool hold_changed = event >= PAUSE && event != CONFIRM;
            EXPECT_TRUE(!hold_changed || run.phase() == before.phase()) << where;
        }
    }
}

TEST(RunState, RefusalsSayWhatIsMissing) {
    RunState idle;
    EXPECT_EQ(idle.take(PAUSE).error().message, "no running program to pause");
    EXPECT_EQ(idle.take(RESUME).error().message, "nothing is paused");
    RunState going = in(RunPhase::READING, Hold::GOING);
    EXPECT_EQ(going.take(START).error().message, "a program or MDI line is already running");
    EXPECT_EQ(idle.take(STEP).error().message, "no running program to step");
    EXPECT_EQ(going.take(RESUME).error().message, "nothing is paused");
}

}  // namespace
}  // namespace mw::task
