// SPDX-License-Identifier: GPL-2.0-or-later
// Offers and rejections of recovery after a power cut, on a complete mill in virtual time.
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
    /// Runs until the tool executes the move of this line, and a little longer.
    void run_to(const std::string &program, int line, int from_line = 0) {
        ASSERT_EQ(rig->begin(program, from_line), "");
        for (int i = 0; i < 60000 && status().task.motion_line != line; ++i) {
            ASSERT_FALSE(rig->hasEnded()) << rig->outcome();
            if (status().approach.number != 0) {
                ASSERT_EQ(rig->ask(messages::ConfirmApproach{status().approach.number}), "");
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
    const messages::MachineStatus &status() { return rig->status(); }
    const messages::RecoveryStatus &offer() { return rig->status().recovery; }

    static constexpr const char *SQUARE = "G21 G90 F600\nT2 M6\nG43\nS900 M3\nM8\nG0 X0 Y0 Z5\nG1 Z-1\nG1 "
                                          "X20\nG1 Y20\nG1 X0\nG1 Y0\nG0 Z5\nM2\n";
    files::path folder = files::temp_directory_path() / ("mw_recovery_" + std::to_string(::getpid()));
    journal::test::TornDisk disk;
    std::unique_ptr<Rig> rig;
    std::mt19937_64 random{1};
};

TEST_F(RecoveryTest, TheProgramIsOfferedWithItsLineAndGoesOnOnceTheWayIsConfirmed) {
    EXPECT_FALSE(offer().isOffered);
    EXPECT_EQ(rig->recover(), "no program was interrupted ");
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

TEST_F(RecoveryTest, NothingMovesOrTurnsBeforeThatAndTheProposalMayBeDropped) {
    run_to(SQUARE, 9);
    cut_and_come_up();
    const auto posted = rig->machine().client().post(messages::RecoverProgram{});
    cycles(1000);
    EXPECT_EQ(status().approach.to, messages::ApproachTo::PLACE_LOST);
    EXPECT_EQ(status().approach.tool, 2);
    EXPECT_TRUE(status().approach.mustChangeTool && status().approach.isFloodOn);
    EXPECT_EQ(status().approach.speeds_rpm[0], 900);
    EXPECT_TRUE(status().trajectory.isInPosition);
    EXPECT_EQ(status().spindles[0].direction, 0);
    EXPECT_EQ(rig->ask(messages::AbortAll{}), "");
    EXPECT_EQ(rig->machine().client().outcome(*posted).progress, messages::Progress::FAILED);
    EXPECT_TRUE(offer().isOffered) << "the offer stays";
    cut_and_come_up();
    EXPECT_TRUE(offer().isOffered);
    EXPECT_EQ(rig->recover(), "");
    cycles(50);
    cut_and_come_up();
    EXPECT_EQ(offer().line, 9) << "during the approach";
    EXPECT_EQ(rig->ask(messages::ForgetRecovery{}), "");
    EXPECT_FALSE(offer().isOffered);
    cycles(5);
    cut_and_come_up();
    EXPECT_FALSE(offer().isOffered);
}

TEST_F(RecoveryTest, AnEmergencyStopLeavesAnOfferAnAbortAndAnErrorNone) {
    run_to(SQUARE, 9);
    EXPECT_EQ(rig->ask(messages::SetState{messages::State::ESTOP}), "");
    EXPECT_TRUE(offer().isOffered);
    EXPECT_EQ(offer().line, 9);
    EXPECT_EQ(rig->ask(messages::SetState{messages::State::ESTOP_RESET}), "");
    EXPECT_EQ(rig->ask(messages::SetState{messages::State::ON}), "");
    EXPECT_EQ(rig->recover(), "");
    finish();
    run_to(SQUARE, 9);
    EXPECT_EQ(rig->ask(messages::AbortAll{}), "");
    EXPECT_FALSE(offer().isOffered);
    cycles(5);
    cut_and_come_up();
    EXPECT_FALSE(offer().isOffered);
}

/// A program that is left in the middle and whose tool gets another length before the return.
class NewLengthTest : public RecoveryTest {
  protected:
    void leave(const std::string &program, int line) {
        run_to(program, line);
        ASSERT_EQ(rig->ask(messages::PauseProgram{}), "");
        cycles(500);
        ASSERT_EQ(rig->ask(messages::ReleaseAxes{}), "");
        ASSERT_EQ(rig->ask(messages::JogIncrement{false, 2, 20, 7.0}), "");
        cycles(2000);
    }
    void measure(int tool, double z) {
        messages::SetToolEntry entry;
        entry.toolno = entry.pocket = tool;
        entry.offset[geometry::AXIS_Z] = z;
        ASSERT_EQ(rig->ask(entry), "");
    }
    /// Runs until the return path is proposed; false if the program ends instead.
    bool resume() {
        EXPECT_EQ(rig->ask(messages::ResumeProgram{}), "");
        for (int i = 0; i < 1000 && status().approach.number == 0 && !rig->hasEnded(); ++i) {
            rig->cycle(random);
        }
        return status().approach.number != 0;
    }
    double z() { return status().trajectory.position_cmd[geometry::AXIS_Z]; }
};

TEST_F(NewLengthTest, ToolsThatTheProgramMayCallStayWhileItIsLeft) {
    leave(SQUARE, 9);
    messages::AddTool added;
    added.toolno = 41;
    EXPECT_EQ(rig->ask(added), "");
    EXPECT_NE(rig->ask(messages::RemoveTool{41}).find("a paused program may call tool 41"),
              std::string::npos);
    EXPECT_EQ(rig->ask(messages::AbortAll{}), "");
    cycles(500);
    EXPECT_EQ(rig->ask(messages::RemoveTool{41}), "");
}

TEST_F(NewLengthTest, ItGoesOnAtTheBlockUnderWayWithTheNewLength) {
    leave(SQUARE, 9);
    const double old = status().offsets.tool[geometry::AXIS_Z], longer = old + 2.25;
    measure(2, longer);
    ASSERT_TRUE(resume()) << rig->outcome();
    EXPECT_EQ(status().approach.line, 9);
    EXPECT_EQ(status().approach.offsets.tool[geometry::AXIS_Z], longer);
    const geometry::Pose stands = status().trajectory.position_cmd;
    cycles(300);
    EXPECT_EQ(geometry::norm_xyz(status().trajectory.position_cmd - stands), 0)
        << "nothing moves before it is confirmed";
    ASSERT_EQ(rig->ask(messages::ConfirmApproach{status().approach.number}), "");
    constexpr double ROUNDED_MM = 0.03;  // the corner into the last move
    bool isAtBegin = false, isCutting = false;
    for (int i = 0; i < 100000 && status().task.motion_line < 12 && !rig->hasEnded(); ++i) {
        rig->cycle(random);
        const geometry::Pose &at = status().trajectory.position_cmd;
        isAtBegin = isAtBegin || (std::fabs(at[0] - 20) < 1e-6 && std::fabs(at[1]) < 1e-6 &&
                                  std::fabs(z() - (longer - 1)) < 1e-6);
        isCutting = isCutting || status().task.motion_line >= 10;
        ASSERT_GE(z(), longer - 1 - ROUNDED_MM) << "it never goes as deep as with the old length";
        if (status().task.motion_line >= 10) {
            ASSERT_NEAR(z(), longer - 1, ROUNDED_MM);
        }
    }
    EXPECT_TRUE(isAtBegin && isCutting);
    finish();
    EXPECT_EQ(status().offsets.tool[geometry::AXIS_Z], longer);
    EXPECT_FALSE(offer().isOffered);
}

/// The return path belongs to the unfinished block, not to the blocks that were read ahead.
TEST_F(NewLengthTest, APowerCutOnTheWayBackOffersTheBlockUnderWay) {
    leave(SQUARE, 9);
    ASSERT_TRUE(resume()) << rig->outcome();
    ASSERT_EQ(rig->ask(messages::ConfirmApproach{status().approach.number}), "");
    cycles(400);
    ASSERT_FALSE(rig->hasEnded());
    cut_and_come_up();
    ASSERT_TRUE(offer().isOffered);
    EXPECT_EQ(offer().line, 9);
    EXPECT_EQ(rig->recover(), "");
    finish();
}

TEST_F(RecoveryTest, LinesThatAreNotSkippedAreNotSkippedBehindThatEither) {
    for (const bool isSkipping : {false, true}) {
        ASSERT_EQ(rig->ask(messages::SetBlockDelete{isSkipping}), "");
        run_to("G21 G90 F600\nG1 X20 Y1\nG1 X0\n/G1 Y20\nM2\n", 2);
        cut_and_come_up();
        ASSERT_TRUE(offer().isOffered);
        EXPECT_TRUE(status().task.isBlockDelete) << "as after each start";
        EXPECT_EQ(rig->recover(), "");
        EXPECT_EQ(status().task.isBlockDelete, isSkipping);
        finish();
        EXPECT_NEAR(status().trajectory.position_cmd[1], isSkipping ? 1 : 20, 1e-9);
    }
}

TEST_F(NewLengthTest, APowerCutBehindThatGoesOnWithTheNewLengthToo) {
    leave(SQUARE, 9);
    const double longer = status().offsets.tool[geometry::AXIS_Z] + 2.25;
    measure(2, longer);
    ASSERT_TRUE(resume()) << rig->outcome();
    ASSERT_EQ(rig->ask(messages::ConfirmApproach{status().approach.number}), "");
    for (int i = 0; i < 60000 && status().task.motion_line != 10; ++i) {
        rig->cycle(random);
    }
    cycles(400);
    cut_and_come_up();
    ASSERT_TRUE(offer().isOffered) << offer().refusal.str();
    EXPECT_EQ(offer().line, 10);
    EXPECT_EQ(rig->recover(), "");
    finish();
    EXPECT_EQ(status().offsets.tool[geometry::AXIS_Z], longer);
}

TEST_F(NewLengthTest, WhereItCannotBeKnownTheProgramEndsAndSaysWhy) {
    leave("G21 G90 F600\nT2 M6\nG10 L1 P2 Z30\nG43\nG0 X0 Y0 Z5\nG1 X20\nG1 X0\nM2\n", 6);
    measure(2, 31);
    EXPECT_FALSE(resume());
    EXPECT_NE(rig->outcome().find("the program itself sets the data of tool 2"), std::string::npos)
        << rig->outcome();

    ASSERT_EQ(rig->ask(messages::SetMode{messages::Mode::MDI}), "");
    ASSERT_EQ(rig->ask(messages::Mdi{"T2 M6"}), "");
    ASSERT_EQ(rig->ask(messages::Mdi{"G43"}), "");
    ASSERT_EQ(rig->ask(messages::SetMode{messages::Mode::AUTO}), "");
    leave("G21 G90 F600\nG0 X0 Y0 Z5\nG1 X20\nG1 X0\nM2\n", 3);
    measure(2, 29);
    EXPECT_FALSE(resume());
    EXPECT_NE(rig->outcome().find("no G43 of the program has set it"), std::string::npos) << rig->outcome();

    leave(SQUARE, 9);
    measure(2, 28);
    std::ofstream(folder / "p.ngc") << "G0 X1\nM2\n";
    EXPECT_FALSE(resume()) << "it is another program meanwhile";
}

/// A program whose state at that position depends on data that only the machine knew.
struct Doubtful {
    const char *name, *program;
    int line;
    const char *why;
};

class DoubtTest : public RecoveryTest, public ::testing::WithParamInterface<Doubtful> {};

TEST_P(DoubtTest, IsRefusedWithTheReasonAndTheNearestLine) {
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
                 "the state at line 5 depends on an input (M66) in line 3; the nearest possible line before "
                 "it is 3"},
        Doubtful{
            "Probe", "G21 F600\nG0 Z5\nG38.3 Z4.5\nG1 X20\nG1 X0\nM2\n", 5,
            "the state at line 5 depends on a probe in line 3; the nearest possible line before it is 3"},
        Doubtful{"Hal", "G21 F600\nG0 Z5\n#1 = #<_hal[motion.in-position]>\nG1 X20\nG1 X0\nM2\n", 5,
                 "the state at line 5 depends on the HAL value motion.in-position in line 3; the nearest "
                 "possible line before it is 3"},
        Doubtful{"Table", "G21 F600\nG0 Z5\nG10 L0\nG1 X20\nG1 X0\nM2\n", 5,
                 "the state at line 5 depends on the reloaded tool table (G10 L0) in "
                 "line 3; the nearest possible line before it is 3"}),
    [](const auto &one) { return one.param.name; });

TEST_F(RecoveryTest, BeforeTheDoubtItIsOffered) {
    run_to("G21 F600\nG0 Z5\nG1 X20\nG1 X0\nM66 P0 L0\nG1 X1\nM2\n", 3);
    cut_and_come_up();
    EXPECT_TRUE(offer().isOffered);
    EXPECT_EQ(rig->recover(), "");
    finish();
}

TEST_F(RecoveryTest, WhatHasChangedSinceIsNoticed) {
    run_to(SQUARE, 9);
    cut_power();
    disk.write_outside(folder / "p.ngc", "G0 X1\nM2\n");
    ASSERT_EQ(rig->come_up({}), "");
    EXPECT_FALSE(offer().isOffered);
    EXPECT_EQ(offer().refusal.str(), "its file has changed since the program was started");

    run_to(SQUARE, 9);
    cut_power();
    std::ofstream(folder / "tools.tbl") << "T1 P1 D6.0 Z+40.0\nT2 P2 D3.0 Z+34.0\n";
    ASSERT_EQ(rig->come_up({}), "");
    EXPECT_TRUE(offer().isOffered);
    EXPECT_NE(rig->recover().find("the tool table has been changed"), std::string::npos);
}

TEST_F(RecoveryTest, AProgramThatBeganAtALineIsOfferedTheSameWay) {
    run_to(SQUARE, 9, 8);
    cut_and_come_up();
    ASSERT_TRUE(offer().isOffered);
    EXPECT_EQ(offer().line, 9);
    EXPECT_EQ(rig->recover(), "");
    finish();
}

TEST_F(RecoveryTest, TheOffsetsOfTheVeryBlockAreShownAndKept) {
    constexpr const char *PROGRAM = "G21 G90 G55 G43 H2 G1 X20 Z-30 F600\nG1 Y20 F600\nM2\n";
    run_to(PROGRAM, 1);
    finish();
    const messages::OffsetsStatus whole = status().offsets;
    EXPECT_NE(whole.tool[geometry::AXIS_Z], 0);
    ASSERT_EQ(rig->ask(messages::SetMode{messages::Mode::MDI}), "");
    ASSERT_EQ(rig->ask(messages::Mdi{"G54 G49"}), "");
    ASSERT_EQ(rig->ask(messages::Mdi{"G53 G0 X0 Y0"}), "");
    EXPECT_EQ(status().offsets.tool[geometry::AXIS_Z], 0);
    ASSERT_EQ(rig->ask(messages::SetMode{messages::Mode::AUTO}), "");
    run_to(PROGRAM, 1);
    cut_and_come_up();
    ASSERT_EQ(offer().line, 1);
    EXPECT_EQ(rig->recover(), "");
    finish();
    EXPECT_EQ(status().offsets.tool, whole.tool);
    EXPECT_EQ(status().offsets.g5x_index, whole.g5x_index);
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

TEST_F(RecoveryTest, TheMiddleOfAThreadIsRefused) {
    run_to("G21 F600\nS300 M3\nG0 X0 Y0 Z5\nG33 Z-5 K1\nG33 Z-20 K1\nG0 X2\nM2\n", 5);
    cut_and_come_up();
    EXPECT_NE(rig->recover().find(
                  "in the middle of moves that follow the spindle; the nearest possible line before it is 4"),
              std::string::npos);
    EXPECT_FALSE(offer().isOffered);
}

}  // namespace
}  // namespace mw::power_cut
