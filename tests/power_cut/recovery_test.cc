// SPDX-License-Identifier: GPL-2.0-or-later
// What is offered after a power cut and what is refused, on a whole mill in virtual time.
#include <unistd.h>

#include <fstream>

#include <gtest/gtest.h>

#include "power_cut/rig.hh"

namespace mw::power_cut {
namespace {

namespace files = std::filesystem;

class RecoveryTest : public ::testing::Test {
  protected:
    RecoveryTest() {
        files::remove_all(folder);
        rig = std::make_unique<Rig>(folder, disk);
        rig->most_late_ms = 0;
        EXPECT_EQ(rig->come_up({}), "");
    }
    ~RecoveryTest() override {
        rig.reset();
        files::remove_all(folder);
    }
    /// Runs until the move of this line is under the tool, and a little on.
    void run_to(const std::string &program, int line, int from_line = 0) {
        ASSERT_EQ(rig->begin(program, from_line), "");
        for (int i = 0; i < 60000 && status().task.motion_line != line; ++i) {
            ASSERT_FALSE(rig->hasEnded()) << rig->outcome();
            if (status().approach.number != 0) {
                ASSERT_EQ(rig->ask(msgs::ConfirmApproach{status().approach.number}), "");
            }
            rig->cycle(random);
        }
        ASSERT_EQ(status().task.motion_line, line);
        cycles(300);
    }
    void cycles(int count) {
        for (int i = 0; i < count; ++i) {
            rig->cycle(random);
        }
    }
    void cut_power() {
        disk.isDead = true;
        rig->die();
        disk.cut_power(random);
    }
    void cut_and_come_up() {
        cut_power();
        ASSERT_EQ(rig->come_up({}), "");
    }
    void finish() {
        for (int i = 0; i < 200000 && !rig->hasEnded(); ++i) {
            rig->cycle(random);
        }
        EXPECT_TRUE(rig->recording.isDone) << rig->outcome();
    }
    const msgs::MachineStatus &status() { return rig->status(); }
    const msgs::RecoveryStatus &offer() { return rig->status().recovery; }

    static constexpr const char *SQUARE = "G21 G90 F600\nT2 M6\nG43\nS900 M3\nM8\nG0 X0 Y0 Z5\nG1 Z-1\nG1 "
                                          "X20\nG1 Y20\nG1 X0\nG1 Y0\nG0 Z5\nM2\n";
    files::path folder = files::temp_directory_path() / ("mw_recovery_" + std::to_string(::getpid()));
    journal::test::TornDisk disk;
    std::unique_ptr<Rig> rig;
    std::mt19937_64 random{1};
};

TEST_F(RecoveryTest, TheProgramIsOfferedWithItsLineAndGoesOnOnceTheWayIsConfirmed_D3) {
    EXPECT_FALSE(offer().isOffered);
    EXPECT_EQ(rig->recover(), "no program was cut short ");
    run_to(SQUARE, 9);
    cut_and_come_up();
    ASSERT_TRUE(offer().isOffered);
    EXPECT_EQ(offer().line, 9);
    EXPECT_EQ(offer().program.str(), (folder / "p.ngc").string());
    EXPECT_EQ(rig->recover(), "");
    finish();
    EXPECT_FALSE(offer().isOffered);
    EXPECT_TRUE(rig->machine().task().status().tool.in_spindle == 2);
    cut_and_come_up();
    EXPECT_FALSE(offer().isOffered) << "it has ended";
}

TEST_F(RecoveryTest, NothingMovesOrTurnsBeforeThatAndTheProposalMayBeDropped_D3) {
    run_to(SQUARE, 9);
    cut_and_come_up();
    const auto posted = rig->machine().client().post(msgs::RecoverProgram{});
    cycles(1000);
    EXPECT_EQ(status().approach.to, msgs::ApproachTo::PLACE_LOST);
    EXPECT_EQ(status().approach.tool, 2);
    EXPECT_TRUE(status().approach.mustChangeTool && status().approach.isFloodOn);
    EXPECT_EQ(status().approach.speeds_rpm[0], 900);
    EXPECT_TRUE(status().trajectory.isInPosition);
    EXPECT_EQ(status().spindles[0].direction, 0);
    EXPECT_EQ(rig->ask(msgs::AbortAll{}), "");
    EXPECT_EQ(rig->machine().client().outcome(*posted).progress, msgs::Progress::FAILED);
    EXPECT_TRUE(offer().isOffered) << "the offer stays";
    cut_and_come_up();
    EXPECT_TRUE(offer().isOffered);
    EXPECT_EQ(rig->recover(), "");
    cycles(50);
    cut_and_come_up();
    EXPECT_EQ(offer().line, 9) << "on the way there";
    EXPECT_EQ(rig->ask(msgs::ForgetRecovery{}), "");
    EXPECT_FALSE(offer().isOffered);
    cycles(5);
    cut_and_come_up();
    EXPECT_FALSE(offer().isOffered);
}

TEST_F(RecoveryTest, AnEmergencyStopLeavesAnOfferAnAbortAndAnErrorNone_D1) {
    run_to(SQUARE, 9);
    EXPECT_EQ(rig->ask(msgs::SetState{msgs::State::ESTOP}), "");
    EXPECT_TRUE(offer().isOffered);
    EXPECT_EQ(offer().line, 9);
    EXPECT_EQ(rig->ask(msgs::SetState{msgs::State::ESTOP_RESET}), "");
    EXPECT_EQ(rig->ask(msgs::SetState{msgs::State::ON}), "");
    EXPECT_EQ(rig->recover(), "");
    finish();
    run_to(SQUARE, 9);
    EXPECT_EQ(rig->ask(msgs::AbortAll{}), "");
    EXPECT_FALSE(offer().isOffered);
    cycles(5);
    cut_and_come_up();
    EXPECT_FALSE(offer().isOffered);
}

/// A program whose state at the place depends on what only the machine knew.
struct Doubtful {
    const char *name, *program;
    int line;
    const char *why;
};

class DoubtTest : public RecoveryTest, public ::testing::WithParamInterface<Doubtful> {};

TEST_P(DoubtTest, IsRefusedWithTheReasonAndTheNearestLine_C5) {
    run_to(GetParam().program, GetParam().line);
    cut_and_come_up();
    EXPECT_FALSE(offer().isOffered);
    EXPECT_EQ(offer().refusal.str(), GetParam().why);
    EXPECT_EQ(rig->recover(), std::string(GetParam().why) + " ");
}

INSTANTIATE_TEST_SUITE_P(
    All, DoubtTest,
    ::testing::Values(
        Doubtful{"Input", "G21 F600\nG0 Z5\nM66 P0 L0\nG1 X20\nG1 X0\nM2\n", 5,
                 "what holds at line 5 depends on an input (M66) in line 3; the nearest line "
                 "before it that can is 3"},
        Doubtful{"Probe", "G21 F600\nG0 Z5\nG38.3 Z4.5\nG1 X20\nG1 X0\nM2\n", 5,
                 "what holds at line 5 depends on a probe in line 3; the nearest line before it "
                 "that can is 3"},
        Doubtful{"Hal", "G21 F600\nG0 Z5\n#1 = #<_hal[motion.in-position]>\nG1 X20\nG1 X0\nM2\n", 5,
                 "what holds at line 5 depends on the HAL value motion.in-position in line 3; the "
                 "nearest line before it that can is 3"},
        Doubtful{"Table", "G21 F600\nG0 Z5\nG10 L0\nG1 X20\nG1 X0\nM2\n", 5,
                 "what holds at line 5 depends on a tool table that is read again (G10 L0) in "
                 "line 3; the nearest line before it that can is 3"}),
    [](const auto &one) { return one.param.name; });

TEST_F(RecoveryTest, BeforeTheDoubtItIsOffered_D3) {
    run_to("G21 F600\nG0 Z5\nG1 X20\nG1 X0\nM66 P0 L0\nG1 X1\nM2\n", 3);
    cut_and_come_up();
    EXPECT_TRUE(offer().isOffered);
    EXPECT_EQ(rig->recover(), "");
    finish();
}

TEST_F(RecoveryTest, WhatHasChangedSinceIsNoticed_C5) {
    run_to(SQUARE, 9);
    cut_power();
    disk.write_outside(folder / "p.ngc", "G0 X1\nM2\n");
    ASSERT_EQ(rig->come_up({}), "");
    EXPECT_FALSE(offer().isOffered);
    EXPECT_EQ(offer().refusal.str(), "its file has been changed since");

    run_to(SQUARE, 9);
    cut_power();
    std::ofstream(folder / "tools.tbl") << "T1 P1 D6.0 Z+40.0\nT2 P2 D3.0 Z+34.0\n";
    ASSERT_EQ(rig->come_up({}), "");
    EXPECT_TRUE(offer().isOffered);
    EXPECT_NE(rig->recover().find("the tool table has been changed"), std::string::npos);
}

TEST_F(RecoveryTest, AProgramThatBeganAtALineIsOfferedTheSameWay_D3) {
    run_to(SQUARE, 9, 8);
    cut_and_come_up();
    ASSERT_TRUE(offer().isOffered);
    EXPECT_EQ(offer().line, 9);
    EXPECT_EQ(rig->recover(), "");
    finish();
}

TEST_F(RecoveryTest, ARefusedStartAtALineKeepsAnOlderOffer) {
    run_to(SQUARE, 9);
    cut_and_come_up();
    ASSERT_EQ(rig->begin("G21 F600\nG0 Z5\nG1 X2\nM2\n", 77), "");
    cycles(100);
    EXPECT_TRUE(rig->hasEnded());
    EXPECT_EQ(offer().line, 9);
    EXPECT_NE(offer().program.str(), "");
}

TEST_F(RecoveryTest, TheMiddleOfAThreadIsRefused_C5) {
    run_to("G21 F600\nS300 M3\nG0 X0 Y0 Z5\nG33 Z-5 K1\nG33 Z-20 K1\nG0 X2\nM2\n", 5);
    cut_and_come_up();
    EXPECT_NE(
        rig->recover().find("in the middle of moves that follow the spindle; the nearest line before it "
                            "that can is 4"),
        std::string::npos);
    EXPECT_FALSE(offer().isOffered);
}

}  // namespace
}  // namespace mw::power_cut
