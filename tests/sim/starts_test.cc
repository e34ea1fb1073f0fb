// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine in virtual time: start from line, and leaving a paused program and returning to it. The
// judge knows the programmed path and checks every commanded sample.
#include <cmath>

#include <fmt/format.h>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class StartsTest : public VirtualMachineTest {
  protected:
    void SetUp() override { switch_on(); }

    const messages::ApproachStatus &approach() const { return machine_->task().status().approach; }
    bool wait_for(const std::function<bool()> &what, int limit = 5000) {
        for (int i = 0; i < limit && !what(); ++i) {
            cycles(1);
        }
        return what();
    }
    bool wait_for_proposal() {
        return wait_for([this] { return approach().number != 0; });
    }
    void start_at(const std::string &text, int line) {
        write("p.ngc", text);
        ask(task::SetMode{task::Mode::AUTO});
        ask(task::OpenProgram{(folder_ / "p.ngc").string()});
        samples_.clear();
        run_ = post(task::RunProgram{line});
        ASSERT_TRUE(wait_for_proposal()) << messages();
    }
    bool hasMoved() const {
        for (const motion::TraceSample &s : samples_) {
            for (int axis = 0; axis < 3; ++axis) {
                if (s.carte_pos_cmd[axis] != samples_.front().carte_pos_cmd[axis]) {
                    return true;
                }
            }
        }
        return false;
    }
    double spindle() const { return machine_->hal().values().get("spindle.0.speed-out")->as_float(); }
    bool stands() const { return motion().isInPosition && motion().current_velocity == 0; }
};

TEST_F(StartsTest, AProgramBeginsAtALineOnceTheWayIsConfirmed) {
    start_at("G21 G90 G61 F900\nT1 M6\nG43 H1\nS700 M3 M8\nG0 X10 Y10 Z5\nG1 Z-2\nG1 X30\nG1 Y30\nM2\n", 8);
    cycles(1000);
    EXPECT_FALSE(hasMoved());
    EXPECT_EQ(spindle(), 0);
    EXPECT_EQ(approach().speeds_rpm[0], 700);
    EXPECT_EQ(approach().tool, 1);
    EXPECT_TRUE(approach().isFloodOn && approach().mustChangeTool);
    const geometry::Pose place = approach().moves[approach().num_moves - 1].end;
    post(messages::ConfirmApproach{approach().number});
    ASSERT_EQ(finish(), task::Progress::DONE) << messages();
    double highest = -1e9;
    bool isDown = false;
    for (const motion::TraceSample &s : samples_) {
        const double x = s.carte_pos_cmd.x(), y = s.carte_pos_cmd.y(), z = s.carte_pos_cmd.z();
        highest = std::max(highest, z);
        const bool isOver = std::hypot(x - place.x(), y - place.y()) < 1e-6;
        const bool isChanging = x == 0 && y == 0 && z >= 50 - 1e-9;  // TOOL_CHANGE_POSITION
        if (!isDown && z < highest - 1e-6) {
            ASSERT_TRUE(isOver || isChanging) << "goes down beside the place: " << x << " " << y << " " << z;
        }
        isDown = isDown || (isOver && std::fabs(z - place.z()) < 1e-9);
        if (isDown && z < place.z() + 1e-9) {
            EXPECT_NEAR(x, 30, 1e-9) << "line 8 goes along Y alone";
        }
    }
    EXPECT_TRUE(isDown);
    EXPECT_NEAR(motion().carte_pos_cmd.y(), 30, 1e-9);
}

TEST_F(StartsTest, AnAbortInAnyCycleOfAStartLeavesNothingThatMoves) {
    for (int when = 1; when < 900; when += 47) {
        SCOPED_TRACE(when);
        start_at("G21 G90 F900 S700 M3\nG0 X10 Y10 Z5\nG1 Z-2\nG1 X30\nM2\n", 4);
        post(messages::ConfirmApproach{approach().number});
        cycles(when);
        post(task::AbortAll{});
        ASSERT_TRUE(wait_for([this] { return stands(); }));
        cycles(20);
        samples_.clear();
        cycles(300);
        EXPECT_FALSE(hasMoved());
        EXPECT_NEAR(spindle(), 0, 1e-9);
        EXPECT_EQ(approach().number, 0U);
        ASSERT_EQ(mdi("G90 G0 Z5"), task::Progress::DONE) << messages();
        ASSERT_EQ(mdi("X0 Y0"), task::Progress::DONE) << messages();
    }
}

/// The program is left in the middle of lines and arcs, the tool is jogged away and returns: every sample of
/// the cut lies on the contour.
TEST_F(StartsTest, AProgramThatIsLeftGoesOnAtTheVeryPlace) {
    int left = 0;
    for (int when = 700; when < 9000; when += 611) {
        SCOPED_TRACE(when);
        ASSERT_EQ(mdi("G21 G90 G61 G0 Z5"), task::Progress::DONE) << messages();
        ASSERT_EQ(mdi("G0 X0 Y0"), task::Progress::DONE) << messages();
        start("G21 G90 G61 F900 S700 M3\nG1 Z-1\nG1 X20\nG3 X40 Y20 I0 J20\nG2 X40 Y20 I10 J0\nG1 X0 Y20\nG0 "
              "Z5\nM2\n");
        samples_.clear();
        cycles(when);
        if (progress(run_) != task::Progress::STARTED) {
            break;
        }
        post(task::PauseProgram{});
        ASSERT_TRUE(wait_for([this] { return motion().current_velocity == 0; }));
        const geometry::Pose place = motion().carte_pos_cmd;
        const auto released = post(messages::ReleaseAxes{});
        cycles(20);
        ASSERT_EQ(progress(released), task::Progress::DONE) << reason(released);
        ++left;
        const std::size_t cut = samples_.size();
        ask(task::SpindleOff{});
        const auto up = ask(task::JogIncrement{false, 2, 20, 7});
        ASSERT_EQ(progress(up), task::Progress::DONE) << reason(up);
        ASSERT_TRUE(wait_for([this] { return stands(); }));
        ask(task::JogIncrement{false, 0, 20, -9});
        ASSERT_TRUE(wait_for([this] { return stands(); }));
        ASSERT_GT(motion().carte_pos_cmd.z(), place.z() + 1);
        const auto resumed = ask(task::ResumeProgram{});
        ASSERT_EQ(progress(resumed), task::Progress::DONE) << reason(resumed);
        ASSERT_TRUE(wait_for_proposal());
        cycles(50);
        const auto confirmed = ask(messages::ConfirmApproach{approach().number});
        ASSERT_EQ(progress(confirmed), task::Progress::DONE) << reason(confirmed);
        ASSERT_EQ(finish(), task::Progress::DONE) << messages();
        // After the return, at depth, all samples lie on the contour; the first is exactly at the interrupted
        // position.
        const auto distance = [](double x, double y) {
            const double line = y < 1e-6 ? 0 : std::fabs(y);
            const double first = std::fabs(std::hypot(x - 20, y - 20) - 20);
            const double second = std::fabs(std::hypot(x - 50, y - 20) - 10);
            return std::min({line, first, second, std::fabs(y - 20)});
        };
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const geometry::Pose &at = samples_[i].carte_pos_cmd;
            if (at.z() < -1 + 1e-9) {
                ASSERT_LT(distance(at.x(), at.y()), 1e-5) << at.x() << " " << at.y();
            }
        }
        double nearest = 1e9;
        for (std::size_t i = cut + 500; i < samples_.size(); ++i) {
            const geometry::Pose &at = samples_[i].carte_pos_cmd;
            nearest =
                std::min(nearest, std::hypot(at.x() - place.x(), at.y() - place.y(), at.z() - place.z()));
        }
        EXPECT_LT(nearest, 1e-9);
        EXPECT_NEAR(x(), 0, 1e-9);
    }
    EXPECT_GT(left, 8);
}

}  // namespace
}  // namespace mw::machine
