// SPDX-License-Identifier: GPL-2.0-or-later
// The cutting cycle from probing to the safe height, and the other actions.
#include "components/plasma/test/cut.hh"

namespace mw::plasma::test {
namespace {

TEST(PlasmaPins, AreThoseOfThePeer) {
    int inputs = 0, outputs = 0;
    sdk::for_each_pin(INPUT_PINS, [&](const char *, const auto &) { ++inputs; });
    sdk::for_each_pin(OUTPUT_PINS, [&](const char *, const auto &) { ++outputs; });
    EXPECT_EQ(inputs, 127);  // as counted in LinuxCNC's `halcmd show pin plasmac`, without plasmac.time
    EXPECT_EQ(outputs, 49);
    const Table fresh;
    EXPECT_EQ(fresh.in.resolution, 100);
    EXPECT_EQ(fresh.in.max_offset, 5);
    EXPECT_EQ(fresh.in.zero_window, 0.1);
    EXPECT_TRUE(fresh.in.multi_tool);
}

TEST(PlasmaCycle, ProbesPiercesCutsAndRetracts) {
    Cut table;
    table.start();
    for (const State state : {State::PROBE_HEIGHT, State::PROBE_DOWN, State::PROBE_UP, State::ZERO_HEIGHT,
                              State::PIERCE_HEIGHT, State::TORCH_ON}) {
        ASSERT_TRUE(table.reaches(state)) << static_cast<int>(state);
        EXPECT_FALSE(table.out().torch_on);
        EXPECT_TRUE(table.out().feed_hold);
    }
    ASSERT_TRUE(table.reaches(State::ARC_OK));
    EXPECT_TRUE(table.out().torch_on);
    ASSERT_TRUE(table.reaches(State::PIERCE_DELAY));
    // The sensor opened at 2 mm; its travel is 1 mm.
    EXPECT_NEAR(table.torch_mu(), 6.0, 0.02);
    EXPECT_TRUE(table.out().feed_hold);
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    EXPECT_NEAR(table.torch_mu(), 4.5, 0.02);
    EXPECT_FALSE(table.out().feed_hold);
    table.in.cutting_start = false;
    table.cycle();
    EXPECT_FALSE(table.out().torch_on);
    ASSERT_TRUE(table.reaches(State::IDLE));
    EXPECT_NEAR(table.torch_mu(), 18.0, 0.02);
    EXPECT_EQ(table.out().stop_type_out, 2);
}

TEST(PlasmaCycle, NeverMovesZFasterThanAsked) {
    Cut table;
    table.start();
    const std::int32_t most = 1000000;  // 10 mm a period in counts
    std::int32_t before = 0;
    for (int i = 0; i < 400; ++i) {
        table.cycle();
        ASSERT_LE(std::abs(table.out().z_offset_counts - before), most) << "cycle " << i;
        before = table.out().z_offset_counts;
    }
}

TEST(PlasmaCycle, TriesTheArcAsOftenAsAllowed) {
    Cut table;
    table.volts = 10.0;
    table.start();
    ASSERT_TRUE(table.reaches(State::MAX_HEIGHT));
    EXPECT_EQ(table.out().pierce_count, 3);
    EXPECT_FALSE(table.out().torch_on);
    EXPECT_TRUE(table.in.program_is_paused);
    EXPECT_EQ(table.core.take_fault(), Fault::NO_ARC);
}

TEST(PlasmaCycle, DryRunGoesTheWholeWayWithoutTheTorch) {
    Cut table;
    table.in.torch_enable = false;
    table.start();
    for (int i = 0; i < 400; ++i) {
        table.cycle();
        ASSERT_FALSE(table.out().torch_on);
    }
    EXPECT_EQ(table.core.state(), State::CUT_BY_VOLTAGE);
}

TEST(PlasmaCycle, MeshGoesOnWithoutAnArc) {
    Cut table;
    table.in.mesh_enable = true;
    table.start();
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    table.volts = 0.0;
    table.run(200);
    EXPECT_EQ(table.core.state(), State::CUT_BY_VOLTAGE);
    EXPECT_TRUE(table.out().torch_on);
    EXPECT_FALSE(table.out().thc_active);
}

TEST(PlasmaCycle, PuddleJumpBeginsThePathAboveTheCutHeight) {
    Cut table;
    table.in.puddle_jump_height = 150.0;
    table.in.puddle_jump_delay = 0.05;
    table.start();
    ASSERT_TRUE(table.reaches(State::PUDDLE_JUMP));
    table.run(5);
    EXPECT_FALSE(table.out().feed_hold);
    EXPECT_NEAR(table.torch_mu(), 3.0 + 4.5, 0.02);
    EXPECT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
}

TEST(PlasmaCycle, PauseAtEndKeepsTheTorchOn) {
    Cut table;
    table.in.pause_at_end = 0.1;
    table.cut();
    table.in.cutting_start = false;
    table.run(50);
    EXPECT_EQ(table.core.state(), State::PAUSE_AT_END);
    EXPECT_TRUE(table.out().torch_on);
    EXPECT_TRUE(table.out().feed_hold);
    EXPECT_TRUE(table.reaches(State::SAFE_HEIGHT));
    EXPECT_FALSE(table.out().torch_on);
}

TEST(PlasmaCycle, PausedCutStartsAgainAfterResume) {
    Cut table;
    table.cut();
    table.pause();
    table.cycle();
    EXPECT_FALSE(table.out().torch_on);
    EXPECT_TRUE(table.out().feed_hold);
    ASSERT_TRUE(table.reaches(State::IDLE));
    EXPECT_EQ(table.out().z_offset_counts, 0);
    table.resume();
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    EXPECT_EQ(table.out().pierce_count, 2);
}

TEST(PlasmaCycle, NearTheLastCutNoProbing) {
    Cut table;
    table.in.skip_ihs_distance = 10.0;
    table.cut();
    table.in.cutting_start = false;
    ASSERT_TRUE(table.reaches(State::IDLE));
    table.in.axis_x_position = 3.0;
    table.in.cutting_start = true;
    table.cycle();
    EXPECT_EQ(table.core.state(), State::PIERCE_HEIGHT);
}

TEST(PlasmaCycle, OhmicProbeIsTheZeroWithItsOffset) {
    Cut table;
    table.in.ohmic_probe_enable = true;
    table.in.ohmic_probe_offset = 0.3;
    table.start();
    ASSERT_TRUE(table.reaches(State::PROBE_DOWN));
    EXPECT_TRUE(table.out().ohmic_enable);
    table.run(5);
    table.in.ohmic_probe = true;
    ASSERT_TRUE(table.reaches(State::PROBE_UP));
    const double touched = table.torch_mu();
    table.in.ohmic_probe = false;
    ASSERT_TRUE(table.reaches(State::PIERCE_HEIGHT));
    EXPECT_FALSE(table.out().ohmic_enable);
    EXPECT_NEAR(table.torch_mu(), touched + 0.3, 0.02);
}

TEST(PlasmaCycle, WithoutContactTheFloatSwitchCountsInTheEnd) {
    Cut table;
    table.in.ohmic_probe_enable = true;
    table.in.ohmic_max_attempts = 2;
    table.start();
    int attempts = 0;
    for (State before = State::IDLE; table.core.state() != State::PROBE_UP && attempts < 10;
         before = table.core.state()) {
        table.cycle();
        attempts += before == State::PROBE_DOWN && table.core.state() == State::PROBE_HEIGHT ? 1 : 0;
    }
    EXPECT_EQ(attempts, 2);
}

TEST(PlasmaCycle, SpotEndsAfterItsTime) {
    Cut table;
    table.in.spotting_threshold = 50.0;
    table.in.spotting_time = 20.0;
    table.start();
    table.in.cutting_start = false;
    table.in.spotting_start = true;
    ASSERT_TRUE(table.reaches(State::ARC_OK));
    int on = 0;
    while (table.out().torch_on && on < 100) {
        table.cycle();
        ++on;
    }
    EXPECT_NEAR(on, 21, 1);
    EXPECT_EQ(table.core.state(), State::SAFE_HEIGHT);
}

TEST(PlasmaCycle, ScribeGoesDownThenOnThenMoves) {
    Cut table;
    table.in.scribe_arm_delay = 0.02;
    table.in.scribe_on_delay = 0.03;
    table.start();
    table.in.cutting_start = false;
    table.in.scribe_start = true;
    ASSERT_TRUE(table.reaches(State::SCRIBING));
    table.run(10);
    EXPECT_TRUE(table.out().scribe_arm);
    EXPECT_FALSE(table.out().scribe_on);
    EXPECT_TRUE(table.out().feed_hold);
    table.run(20);
    EXPECT_TRUE(table.out().scribe_on);
    table.run(30);
    EXPECT_FALSE(table.out().feed_hold);
    table.in.scribe_start = false;
    table.cycle();
    EXPECT_FALSE(table.out().scribe_on || table.out().scribe_arm || table.out().torch_on);
}

TEST(PlasmaCycle, TorchPulseLastsItsTime) {
    Cut table;
    table.in.torch_pulse_time = 0.05;
    table.in.torch_pulse_start = true;
    table.run(5);
    table.in.torch_pulse_start = false;
    EXPECT_TRUE(table.out().torch_on);
    table.run(60);
    EXPECT_FALSE(table.out().torch_on);
    EXPECT_EQ(table.core.state(), State::IDLE);
}

TEST(PlasmaCycle, ManualCutEndsAtTheTop) {
    Cut table;
    table.in.offsets_active = true;
    table.in.cutting_start = true;
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    table.in.cutting_start = false;
    ASSERT_TRUE(table.reaches(State::END_JOB));
    EXPECT_EQ(table.out().z_offset_counts, 0);
    table.in.offsets_active = false;
    EXPECT_TRUE(table.reaches(State::IDLE));
}

TEST(PlasmaCycle, ConsumablesAreChangedElsewhereWhilePaused) {
    Cut table;
    table.cut();
    table.pause();
    ASSERT_TRUE(table.reaches(State::IDLE));
    table.in.x_offset = 500000;
    table.in.y_offset = -300000;
    table.in.consumable_change = true;
    table.run(30);
    EXPECT_TRUE(table.out().consumable_changing);
    EXPECT_EQ(table.out().x_offset_counts, 500000);
    EXPECT_EQ(table.out().y_offset_counts, -300000);
    table.in.consumable_change = false;
    table.run(30);
    EXPECT_FALSE(table.out().consumable_changing);
    EXPECT_EQ(table.out().x_offset_counts, 0);
    table.resume();
    EXPECT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
}

TEST(PlasmaCycle, RecoveryStartsBesideThePathAndReturnsToIt) {
    Cut table;
    table.cut();
    table.pause();
    ASSERT_TRUE(table.reaches(State::IDLE));
    table.in.cut_recovery = true;
    table.in.x_offset = 20000;
    table.run(30);
    EXPECT_TRUE(table.out().cut_recovering);
    EXPECT_EQ(table.out().x_offset_counts, 20000);
    table.resume();
    ASSERT_TRUE(table.reaches(State::RECOVERY_BACK));
    EXPECT_TRUE(table.out().torch_on);
    EXPECT_TRUE(table.out().feed_hold);
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    EXPECT_EQ(table.out().x_offset_counts, 0);
    EXPECT_FALSE(table.out().cut_recovering);
}

TEST(PlasmaCycle, PausedMotionFollowsTheKey) {
    Cut table;
    table.cut();
    table.pause();
    ASSERT_TRUE(table.reaches(State::IDLE));
    table.in.paused_motion_speed = -0.5;
    table.run(10);
    EXPECT_EQ(table.out().adaptive_feed, -0.5);
    EXPECT_FALSE(table.out().feed_hold);
    EXPECT_FALSE(table.out().torch_on);
    table.in.paused_motion_speed = 0.0;
    table.run(10);
    EXPECT_TRUE(table.in.program_is_paused);
    EXPECT_TRUE(table.out().feed_hold);
    EXPECT_EQ(table.out().adaptive_feed, 1.0);
    EXPECT_EQ(table.core.state(), State::IDLE);
}

}  // namespace
}  // namespace mw::plasma::test
