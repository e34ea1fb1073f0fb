// SPDX-License-Identifier: GPL-2.0-or-later
// Tests stops while the interpreter waits for a file or a script.
#include <semaphore>
#include <thread>

#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

/// The test controls the duration of #<_hal[slow]>.
class LongCallTest : public TaskTest {
  protected:
    LongCallTest() {
        parameters.on_hal_value = [this] {
            inside.release();
            may_end.acquire();
            return 5.0;
        };
    }
    /// Runs cycles until a cycle is in the call.
    void enter() {
        stepping = std::thread([this] {
            while (!left) {
                cycle();
            }
        });
        inside.acquire();
        ASSERT_TRUE(task.long_call().take());
    }
    void leave() {
        left = true;
        task.long_call().give_back();
        may_end.release();
        stepping.join();
    }
    void cycle_apart() {
        now_ns += 1000000;
        motion.step();
        task.step_apart(now_ns);
    }

    std::binary_semaphore inside{0}, may_end{0};
    std::thread stepping;
    std::atomic<bool> left = false;
};

constexpr const char *PROGRAM = "G21 F600\nG1 X1\nG10 L2 P1 X[#<_hal[slow]>]\nG1 X2\nM2\n";

TEST_F(LongCallTest, AnAbortIsCarriedOutAndLeavesNoTraceOfTheCall) {
    open(PROGRAM);
    const client::Serial run = post(RunProgram{});
    enter();
    const client::Serial abort = post(AbortAll{});
    cycle_apart();
    EXPECT_EQ(progress(abort), Progress::DONE);
    EXPECT_EQ(task.status().task.interp_state, InterpState::IDLE) << "the run is over";
    EXPECT_EQ(progress(post(SetBlockDelete{false})), Progress::STARTED) << "the interpreter is still busy";
    leave();
    cycles(5);
    EXPECT_EQ(progress(run), Progress::FAILED);
    EXPECT_EQ(reason(run), "aborted");
    EXPECT_EQ(task.status().task.interp_state, InterpState::IDLE);
    EXPECT_EQ(task.status().offsets.g5x.x(), 0);
    EXPECT_EQ(joined().find("line 2"), std::string::npos) << joined();
}

TEST_F(LongCallTest, WhatWasReadBeforeItIsCarriedOutMeanwhile) {
    open("G21 F600\nG1 X1\nG1 X2\n#1=#<_hal[slow]>\nG1 X3\nM2\n");
    const client::Serial run = post(RunProgram{});
    enter();
    for (int i = 0; i < 5; ++i) {
        cycle_apart();
    }
    EXPECT_NE(joined().find("line 2"), std::string::npos) << joined();
    EXPECT_EQ(joined().find("line 3"), std::string::npos) << joined();
    leave();
    cycles(50);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
    EXPECT_NE(joined().find("line 3"), std::string::npos) << joined();
}

TEST_F(LongCallTest, WithoutAStopTheProgramGoesOn) {
    open(PROGRAM);
    const client::Serial run = post(RunProgram{});
    enter();
    cycle_apart();
    leave();
    cycles(50);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
    EXPECT_EQ(task.status().offsets.g5x.x(), 5);
}

TEST_F(LongCallTest, AnEmergencyStopSwitchesOffAtOnce) {
    ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    const client::Serial line = post(Mdi{"G10 L2 P1 X[#<_hal[slow]>]"});
    enter();
    const client::Serial stop = post(SetState{State::ESTOP});
    cycle_apart();
    cycle_apart();
    cycle_apart();
    EXPECT_EQ(progress(stop), Progress::DONE);
    EXPECT_EQ(task.status().task.state, State::ESTOP);
    EXPECT_FALSE(io.outputs.user_enable_out);
    leave();
    cycles(5);
    EXPECT_EQ(progress(line), Progress::FAILED);
    EXPECT_EQ(task.status().offsets.g5x.x(), 0);
    EXPECT_EQ(ask(SetState{State::ESTOP_RESET}), Progress::DONE);
}

TEST_F(LongCallTest, TheChainStopsToo) {
    open(PROGRAM);
    const client::Serial run = post(RunProgram{});
    enter();
    io.isChainClosed = false;
    cycle_apart();
    cycle_apart();
    EXPECT_EQ(task.status().task.state, State::ESTOP);
    leave();
    cycles(5);
    EXPECT_EQ(reason(run), "the e-stop chain opened");
}

TEST_F(LongCallTest, OtherCommandsWaitAndOverridesDoNot) {
    open(PROGRAM);
    const client::Serial run = post(RunProgram{});
    enter();
    const client::Serial mode = post(SetBlockDelete{false});
    const client::Serial feed = post(SetFeedOverride{0.5});
    cycle_apart();
    cycle_apart();
    EXPECT_EQ(progress(mode), Progress::STARTED);
    EXPECT_EQ(progress(feed), Progress::DONE);
    leave();
    cycles(50);
    EXPECT_EQ(progress(mode), Progress::DONE);
    EXPECT_EQ(progress(run), Progress::DONE);
}

TEST_F(LongCallTest, TheOperatorIsToldAfterASecond) {
    open(PROGRAM);
    static_cast<void>(post(RunProgram{}));
    enter();
    cycle_apart();
    EXPECT_EQ(messages(), "");
    now_ns += 1000000000;
    cycle_apart();
    cycle_apart();
    EXPECT_NE(messages().find("the interpreter has been busy for 1 s"), std::string::npos);
    EXPECT_EQ(messages(), "");
    leave();
}

}  // namespace
}  // namespace mw::task
