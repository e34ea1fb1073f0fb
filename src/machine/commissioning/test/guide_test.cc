// SPDX-License-Identifier: GPL-2.0-or-later
// Safety of the steps (A7): nothing moves or is switched on without the operator, and everything stops when
// the operator leaves. `tests/commissioning` judges the findings of the steps.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "machine/commissioning/guide.hh"

namespace mw::commissioning {
namespace {

/// A machine that executes each request at once.
class FakeBench final : public Bench {
  public:
    double now_s() const override { return time_s; }
    bool isOn() const override { return on; }
    bool isEstopReleased() const override { return !estop_pressed; }
    bool isProbeOn() const override { return false; }
    JointReading joint(int joint) const override {
        const auto i = static_cast<std::size_t>(joint);
        return {.command = position[i],
                .feedback = position[i],
                .isHomeSwitchOn = false,
                .isMoving = left[i] != 0,
                .isHoming = false,
                .isHomed = false,
                .isDriveFaulted = false,
                .isFollowingErrorTripped = false};
    }
    std::uint64_t late_cycles() const override { return late; }
    std::string last_error() const override { return error; }
    void switch_on(const std::vector<int> &joints) override {
        on = !is_slow_to_switch;
        enabled = joints;
    }
    double worst_latency_s() const override { return 0; }
    void switch_off() override {
        ++offs;
        on = false;
        left = {};
    }
    void move_to(int joint, double to, double to_speed) override {
        ++moves;
        left[static_cast<std::size_t>(joint)] = stuck ? 0 : to - position[static_cast<std::size_t>(joint)];
        speed = to_speed;
        fastest = std::max(fastest, to_speed);
    }
    void stop(int joint) override {
        left[static_cast<std::size_t>(joint)] = unstoppable ? left[static_cast<std::size_t>(joint)] : 0;
    }
    void home(int) override {}
    void unhome(int) override {}
    void run_spindle(double speed_rpm) override { spindle = speed_rpm; }
    void stop_spindle() override { spindle = 0; }
    std::optional<double> value(std::string_view) const override { return 0; }
    void set_value(std::string_view, double) override {}

    void cycle() {
        constexpr double CYCLE_S = 0.001;
        time_s += CYCLE_S;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const double part = std::clamp(left[i], -speed * CYCLE_S, speed * CYCLE_S);
            left[i] -= part;
            left[i] = std::abs(left[i]) < 1e-12 ? 0 : left[i];
            position[i] += part;
        }
    }

    double time_s = 10, speed = 0, fastest = 0, spindle = 0;
    bool on = false, estop_pressed = false, stuck = false, unstoppable = false;
    bool is_slow_to_switch = false;
    int moves = 0, offs = 0;
    std::uint64_t late = 0;
    std::string error;
    std::array<double, 3> position{}, left{};
    std::vector<int> enabled;
};

setup::Answers answers() {
    return {{"kind", "mill"}, {"drives", "stepper"}, {"board", "7i76e"}, {"pin.estop", "-1"}};
}

class GuideTest : public ::testing::Test {
  protected:
    GuideTest() : guide_(answers()) { guide_.attach(&bench_); }

    void cycle(int times = 1) {
        for (int i = 0; i < times; ++i) {
            bench_.cycle();
            guide_.cycle();
            if (guide_.isRestartWanted()) {
                ++restarts_;
                guide_.attach(nullptr);
                guide_.attach(&bench_);
            }
        }
    }
    /// Confirms prompts until a prompt requires the button of the first motion.
    bool reach_motion() {
        for (int i = 0; i < 30000 && guide_.prompt().ask != Ask::HOLD; ++i) {
            if (guide_.prompt().ask == Ask::CONFIRM) {
                EXPECT_TRUE(guide_.act(guide_.prompt_number(), {Act::Type::CONFIRM, 0, ""}));
            }
            cycle();
        }
        return guide_.prompt().ask == Ask::HOLD;
    }
    bool hold() { return guide_.act(guide_.prompt_number(), {Act::Type::HOLD, 0, ""}); }
    void hold_for(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            hold();
            cycle();
        }
    }

    FakeBench bench_;
    Guide guide_;
    int restarts_ = 0;
};

TEST_F(GuideTest, NothingIsEnabledWithoutConfirmation) {
    cycle(60000);
    EXPECT_TRUE(bench_.enabled.empty());
    EXPECT_EQ(bench_.moves, 0);
}

TEST_F(GuideTest, OneDriveIsEnabledAloneAndMovesOnlyWhileTheButtonIsHeld) {
    ASSERT_TRUE(reach_motion());
    EXPECT_EQ(bench_.enabled, std::vector<int>{0});
    cycle(2000);
    EXPECT_EQ(bench_.moves, 0) << "moves without the button";
    hold_for(300);
    EXPECT_GT(bench_.position[0], 0.1);
    // The button is not renewed, so it counts as released.
    cycle(300);
    const double stopped = bench_.position[0];
    cycle(2000);
    EXPECT_EQ(bench_.position[0], stopped);
    EXPECT_EQ(bench_.position[1], 0);
}

TEST_F(GuideTest, TheFirstMotionIsSlowAndShort) {
    ASSERT_TRUE(reach_motion());
    hold_for(10000);
    EXPECT_LE(bench_.fastest, 3.0);
    EXPECT_NEAR(bench_.position[0], 3.0, 1e-6);
    EXPECT_EQ(guide_.prompt().ask, Ask::CHOICE);
}

TEST_F(GuideTest, StopEndsTheMotionAndSwitchesOff) {
    ASSERT_TRUE(reach_motion());
    hold_for(200);
    guide_.stop();
    EXPECT_FALSE(bench_.on);
    EXPECT_EQ(bench_.left[0], 0);
    EXPECT_FALSE(guide_.isReady());
}

TEST_F(GuideTest, AnAnswerToAnOlderPromptIsRejected) {
    ASSERT_TRUE(reach_motion());
    EXPECT_FALSE(guide_.act(guide_.prompt_number() - 1, {Act::Type::HOLD, 0, ""}));
    EXPECT_FALSE(guide_.act(guide_.prompt_number(), {Act::Type::NUMBER, 1, ""}));
    hold_for(10000);
    EXPECT_FALSE(guide_.act(guide_.prompt_number(), {Act::Type::CHOICE, 0, "sideways"}));
}

TEST_F(GuideTest, AMachineThatGoesOffIsAFault) {
    ASSERT_TRUE(reach_motion());
    hold_for(100);
    bench_.on = false;
    bench_.error = "joint 0 following error";
    hold_for(10);
    ASSERT_TRUE(guide_.isFaulted());
    const auto &finding = guide_.findings()[guide_.current()];
    EXPECT_EQ(finding->fault, Fault::STOPPED);
    EXPECT_EQ(finding->detail, "joint 0 following error");
    EXPECT_FALSE(guide_.isReady());
    guide_.repeat();
    EXPECT_FALSE(guide_.isFaulted());
}

TEST_F(GuideTest, AMotionEndsEarlyOnlyWhereThePromptOffersIt) {
    ASSERT_TRUE(reach_motion());
    hold_for(50);
    EXPECT_FALSE(guide_.act(guide_.prompt_number(), {Act::Type::CONFIRM, 0, ""}));
    cycle(1000);
    EXPECT_EQ(guide_.prompt().ask, Ask::HOLD);
}

TEST_F(GuideTest, ARequestThatMovesNothingSwitchesOff) {
    ASSERT_TRUE(reach_motion());
    bench_.stuck = true;
    hold_for(1000);
    ASSERT_TRUE(guide_.isFaulted());
    EXPECT_FALSE(bench_.on);
    EXPECT_EQ(guide_.findings()[guide_.current()]->fault, Fault::STOPPED);
    EXPECT_EQ(guide_.findings()[guide_.current()]->detail, "The axis did not start to move.");
    EXPECT_EQ(bench_.moves, 1);
}

TEST_F(GuideTest, AnAxisThatDoesNotStopIsSwitchedOff) {
    ASSERT_TRUE(reach_motion());
    bench_.unstoppable = true;
    hold_for(100);
    EXPECT_NE(bench_.left[0], 0);
    // Released.
    cycle(1500);
    EXPECT_FALSE(bench_.on);
    EXPECT_EQ(guide_.findings()[guide_.current()]->detail, "The axis does not stop.");
}

TEST_F(GuideTest, ALateSwitchingOnIsTakenBack) {
    bench_.is_slow_to_switch = true;
    for (int i = 0; i < 30000 && !guide_.isFaulted(); ++i) {
        if (guide_.prompt().ask == Ask::CONFIRM) {
            static_cast<void>(guide_.act(guide_.prompt_number(), {Act::Type::CONFIRM, 0, ""}));
        }
        cycle();
    }
    ASSERT_TRUE(guide_.isFaulted());
    EXPECT_GT(bench_.offs, 0);
    EXPECT_EQ(guide_.findings()[guide_.current()]->fault, Fault::STOPPED);
}

TEST_F(GuideTest, AButtonThatStaysPressedDoesNotStartTheNextMotion) {
    ASSERT_TRUE(reach_motion());
    const int pressed_for = guide_.prompt_number();
    for (int i = 0; i < 10000; ++i) {
        static_cast<void>(guide_.act(pressed_for, {Act::Type::HOLD, 0, ""}));
        cycle();
    }
    ASSERT_EQ(guide_.prompt().ask, Ask::CHOICE);
    ASSERT_TRUE(guide_.act(guide_.prompt_number(), {Act::Type::CHOICE, 0, "positive"}));
    ASSERT_TRUE(reach_motion());
    const int moves = bench_.moves;
    for (int i = 0; i < 2000; ++i) {
        EXPECT_FALSE(guide_.act(pressed_for, {Act::Type::HOLD, 0, ""}));
        cycle();
    }
    EXPECT_EQ(bench_.moves, moves);
}

TEST_F(GuideTest, AMotorThatDoesNotMoveIsNamed) {
    ASSERT_TRUE(reach_motion());
    hold_for(10000);
    ASSERT_TRUE(guide_.act(guide_.prompt_number(), {Act::Type::CHOICE, 0, "not at all"}));
    cycle(10);
    ASSERT_TRUE(guide_.isFaulted());
    EXPECT_EQ(fault_name(guide_.findings()[guide_.current()]->fault), "motor not connected");
    EXPECT_FALSE(bench_.on);
}

TEST_F(GuideTest, AReversedDirectionIsCorrectedAndCanBeTakenBack) {
    ASSERT_TRUE(reach_motion());
    hold_for(10000);
    ASSERT_TRUE(guide_.act(guide_.prompt_number(), {Act::Type::CHOICE, 0, "negative"}));
    cycle(2000);
    EXPECT_EQ(restarts_, 1);
    EXPECT_EQ(guide_.answers().at("x.way_per_turn"), "-5");
    // The step checks again with the corrected direction.
    ASSERT_TRUE(reach_motion());
    hold_for(10000);
    ASSERT_TRUE(guide_.act(guide_.prompt_number(), {Act::Type::CHOICE, 0, "positive"}));
    cycle(3000);
    const std::size_t step = guide_.current();
    ASSERT_EQ(guide_.steps()[step].name, "scale");
    guide_.stop();
    guide_.undo(step - 1);
    EXPECT_TRUE(guide_.isRestartWanted());
    EXPECT_EQ(guide_.answers().at("x.way_per_turn"), "5");
    EXPECT_EQ(guide_.current(), step - 1);
}

TEST_F(GuideTest, ALateThreadIsNamed) {
    cycle(100);
    bench_.late = 3;
    cycle(6000);
    ASSERT_TRUE(guide_.isFaulted());
    EXPECT_EQ(fault_name(guide_.findings()[0]->fault), "late thread");
}

}  // namespace
}  // namespace mw::commissioning
