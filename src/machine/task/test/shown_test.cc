// SPDX-License-Identifier: GPL-2.0-or-later
// The status of a running program.
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

/// Modal codes are those of the current move, independent of the number of blocks read ahead.
TEST_F(TaskTest, ShowsTheModesOfTheMoveUnderWay) {
    open("G21 G61\nG1 X1 F100\nG64 P0.5 Q0.1\nG91 G1 X1 F200\nM2\n");
    motion.isHolding = true;
    post(RunProgram{});
    cycles(20);
    const auto shown = [this] {
        EXPECT_TRUE(client.read_status().has_value());
        return client.status();
    };
    EXPECT_EQ(shown().codes.g[11], 610) << "G64 is read, but not yet active";
    EXPECT_EQ(shown().codes.g[6], 900);
    EXPECT_EQ(shown().codes.settings[1], 100);
    EXPECT_EQ(shown().codes.g[0], 2);
    motion.isHolding = false;
    cycles(20);
    EXPECT_EQ(shown().task.interp_state, InterpState::IDLE);
    EXPECT_EQ(shown().codes.g[11], 640);
    EXPECT_EQ(shown().codes.settings[3], 0.5);
    EXPECT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G0 X0"}), Progress::DONE);
    EXPECT_EQ(shown().codes.g[0], 0) << "a line of MDI has no number";
}

TEST_F(TaskTest, AnOutputIsSetWhenItsBlockIsOver) {
    ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    ASSERT_EQ(ask(Mdi{"M64 P1"}), Progress::DONE);
    const auto *set = std::get_if<motion::SetDigitalOutput>(&motion.last);
    ASSERT_NE(set, nullptr);
    EXPECT_TRUE(set->isOn);
}

TEST_F(TaskTest, ClientsGetTheToolTableAgainAfterEachChange) {
    const auto read = [this] {
        auto table = client.read_tools();
        EXPECT_TRUE(table.has_value());
        return table.value_or(std::nullopt);
    };
    const auto table = read();
    ASSERT_TRUE(table.has_value());
    EXPECT_EQ(table->version, 1U);
    ASSERT_EQ(table->tools.size(), 2U);
    EXPECT_EQ(table->tools[1].toolno, 5);
    EXPECT_EQ(table->tools[1].pocketno, 3);
    cycles(3);
    EXPECT_FALSE(read().has_value());
    tools.version_now = 2;
    cycle();
    EXPECT_TRUE(read().has_value());
    EXPECT_EQ(task.status().tool.table_version, 2U);
}

class StartTolerance : public TaskTest {
  protected:
    StartTolerance() : TaskTest(with_tolerance()) { EXPECT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE); }
    static Settings with_tolerance() {
        Settings settings;
        settings.interpreter.start_tolerance_mm = 0.0254;
        return settings;
    }
    double shown() {
        EXPECT_TRUE(client.read_status().has_value());
        return client.status().codes.settings[3];
    }
};

TEST_F(StartTolerance, HoldsUntilAProgramSaysG64) {
    EXPECT_EQ(shown(), 0.0254);
    EXPECT_EQ(ask(Mdi{"G1 X1 F100"}), Progress::DONE);
    EXPECT_EQ(motion.tolerance, 0.0254);
    EXPECT_EQ(ask(Mdi{"G20"}), Progress::DONE);
    EXPECT_DOUBLE_EQ(shown(), 0.001) << "in the units of the program";
    EXPECT_EQ(ask(Mdi{"G64"}), Progress::DONE);
    EXPECT_EQ(shown(), 0);
    EXPECT_EQ(ask(Mdi{"G1 X0 F4"}), Progress::DONE);
    EXPECT_EQ(motion.tolerance, 0);
}

TEST_F(StartTolerance, CyclesGoBackToTheSameLengthAfterAChangeOfUnits) {
    EXPECT_EQ(ask(Mdi{"G21 G64 P0.5"}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G20"}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G81 X0 Y0 Z-0.1 R0.1 F4"}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G80"}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G1 X0.1"}), Progress::DONE);
    EXPECT_NEAR(motion.tolerance, 0.5, 1e-12) << "mm, as it was given";
}

}  // namespace
}  // namespace mw::task
