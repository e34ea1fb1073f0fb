// SPDX-License-Identifier: GPL-2.0-or-later
// The pins motion.tooloffset.* of a whole machine: their order with motion, and their values at every stop.
#include <fmt/format.h>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

constexpr const char *PROGRAM =
    "G21 G90 G64 F3000\nG1 X5\nG43.1 Z2\nG1 X10\nG43.1 Y1 Z4\nX15\nG49\nX30\nM2\n";

/// The values of the pins while the machine is between these positions of PROGRAM.
double expected_z(double x) {
    return x <= 5 ? 0 : x <= 10 ? 2 : x <= 15 ? 4 : 0;
}

class ToolOffsetTest : public VirtualMachineTest {
  protected:
    double pin_value(char axis = 'z') const {
        return machine_->hal().values().get(std::string("motion.tooloffset.") + axis)->as_number();
    }
    /// Runs until the commanded position is past `to`.
    void run_to(double to) {
        for (int i = 0; i < 20000 && x() < to; ++i) {
            cycles(1);
        }
        ASSERT_GE(x(), to);
    }
    /// At a stop, the pins, the status and the interpreter agree.
    void expect_everywhere(double z) {
        cycles(1500);
        ASSERT_TRUE(motion().isInPosition);
        EXPECT_EQ(pin_value(), z);
        EXPECT_EQ(machine_->task().status().offsets.tool.z(), z);
    }
};

TEST_F(ToolOffsetTest, APinChangesAfterTheMoveBeforeItAndBeforeTheMoveBehindIt) {
    switch_on();
    start(PROGRAM);
    int changes = 0;
    double last = pin_value();
    for (int i = 0; i < 20000 && progress(run_) == task::Progress::STARTED; ++i) {
        cycles(1);
        const double z = pin_value();
        const bool isAtPlace = x() == 5 || x() == 10 || x() == 15;
        if (z != last) {
            ++changes;
            EXPECT_TRUE(isAtPlace) << x();
            EXPECT_EQ(motion().current_velocity, 0);
        }
        if (!isAtPlace) {
            EXPECT_EQ(z, expected_z(x())) << x();
        }
        EXPECT_EQ(pin_value('y'), z == 4 ? 1 : 0) << "all pins change together";
        last = z;
    }
    EXPECT_EQ(progress(run_), task::Progress::DONE) << messages();
    EXPECT_EQ(changes, 3);
}

TEST_F(ToolOffsetTest, AfterAnAbortEmergencyStopOrOffThePinsAreThoseOfTheExecutedBlock) {
    switch_on();
    const std::vector<std::function<void()>> STOPS = {
        [&] { post(task::AbortAll{}); }, [&] { post(task::SetState{task::State::OFF}); },
        [&] { post(task::SetState{task::State::ESTOP}); }, [&] { set_pin("motion.enable", "FALSE"); }};
    for (const double at : {3.0, 7.0, 12.0, 20.0}) {
        for (std::size_t n = 0; n < STOPS.size(); ++n) {
            SCOPED_TRACE(fmt::format("stop {} at X {}", n, at));
            ASSERT_EQ(mdi("G90 G49 G0 X0"), task::Progress::DONE) << messages();
            start(PROGRAM);
            run_to(at);
            STOPS[n]();
            for (int i = 0; i < 300; ++i) {
                cycles(1);
                ASSERT_EQ(pin_value(), expected_z(at)) << "at X " << x();
            }
            expect_everywhere(expected_z(at));
            set_pin("motion.enable", "TRUE");
            ask(task::SetState{task::State::ESTOP_RESET});
            ask(task::SetState{task::State::ON});
            expect_everywhere(expected_z(at));
            for (const auto mode : {task::Mode::MANUAL, task::Mode::MDI, task::Mode::AUTO}) {
                ask(task::SetMode{mode});
                cycles(20);
                EXPECT_EQ(pin_value(), expected_z(at));
            }
            if (::testing::Test::HasFailure()) {
                return;
            }
        }
    }
}

TEST_F(ToolOffsetTest, AfterAProgramErrorThePinsAreThoseOfTheExecutedBlock) {
    switch_on();
    start("G21 G90 F3000\nG43.1 Z2\nG1 X10\nG43.1 Z4\nG1 X9999\nM2\n");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    expect_everywhere(machine_->task().status().offsets.tool.z());
    EXPECT_NE(pin_value(), 0);
}

TEST_F(ToolOffsetTest, AfterTheEndOfAProgramThePinsStay) {
    switch_on();
    start("G21 G90 F3000 G43.1 Z2\nG1 X1\nM2\n");
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    expect_everywhere(2);
    for (const auto state : {task::State::OFF, task::State::ESTOP, task::State::ESTOP_RESET}) {
        ask(task::SetState{state});
        expect_everywhere(2);
    }
}

/// With LinuxCNC the pins show it before the machine is switched on.
TEST_F(ToolOffsetTest, TheOffsetOfTheStartUpCodeIsOnThePinsBeforeTheFirstProgram) {
    switch_on([](task::Settings &settings) { settings.interpreter.startup_code = "G21 G43.1 Z5"; });
    expect_everywhere(5);
}

TEST_F(ToolOffsetTest, PinsAreInMachineUnits) {
    switch_on();
    ASSERT_EQ(mdi("G20 G43.1 Z1"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(pin_value(), 25.4);
    ASSERT_EQ(mdi("G21"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(pin_value(), 25.4);
}

}  // namespace
}  // namespace mw::machine
