// SPDX-License-Identifier: GPL-2.0-or-later
// Safety of the steps with the ordinary controller and simulated boards (A7): the button released at any
// instant, a program that hangs, a lost board, a lost operator.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "programs/commission/commissioner.hh"
#include "programs/setup/new_machine.hh"

namespace mw::programs {
namespace {

using commissioning::Act;
using commissioning::Ask;
using commissioning::Guide;

struct Scene {
    const char *step;
    const char *drives, *board;
    bool (*isWanted)(const commissioning::Step &);
};

bool isDirection(const commissioning::Step &step) {
    return step.name == "direction";
}
bool isHome(const commissioning::Step &step) {
    return step.name == "home";
}
bool isTravel(const commissioning::Step &step) {
    return step.name == "travel";
}
bool isTune(const commissioning::Step &step) {
    return step.name == "tune";
}

constexpr Scene SCENES[] = {
    {"direction", "stepper", "7i76e", isDirection}, {"direction", "servo", "7i97", isDirection},
    {"home", "stepper", "7i76e", isHome},           {"home", "servo", "7i97", isHome},
    {"travel", "stepper", "7i76e", isTravel},       {"tune", "servo", "7i97", isTune}};

class SafetyTest : public ::testing::TestWithParam<Scene> {
  protected:
    SafetyTest() {
        const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = std::filesystem::temp_directory_path() / ("mw-safety-" + std::to_string(::getpid()) + "-" +
                                                            std::to_string(std::hash<std::string>()(name)));
        std::filesystem::remove_all(folder_);
        const setup::Answers answers{{"kind", "lathe"},           {"drives", GetParam().drives},
                                     {"board", GetParam().board}, {"switches", "home"},
                                     {"board.simulated", "yes"},  {"pin.estop", "-1"}};
        const setup::Planned planned = setup::plan_of(answers);
        EXPECT_TRUE(planned.faults.empty());
        const auto made = make_machine(folder_.string(), planned.plan, answers);
        EXPECT_TRUE(made.has_value()) << (made.has_value() ? "" : made.error().str());
        auto opened = Commissioner::open({.folder = folder_.string(),
                                          .clock_virtual = true,
                                          .known = {},
                                          .isWanted = GetParam().isWanted,
                                          .prepare = {},
                                          .on_start = {},
                                          .wrap = {}});
        EXPECT_TRUE(opened.has_value()) << (opened.has_value() ? "" : opened.error().str());
        commissioner_ = std::move(*opened);
    }
    ~SafetyTest() override {
        commissioner_.reset();
        std::filesystem::remove_all(folder_);
    }

    Guide &guide() { return commissioner_->guide(); }
    hal::Instance &hal() { return commissioner_->machine().hal(); }
    double value(const char *pin) { return hal().values().get(pin)->as_number(); }
    double position() { return value("joint.0.pos-fb"); }
    bool isEnabled() { return value("joint.0.amp-enable-out") != 0; }

    void act(Act::Type type) { static_cast<void>(guide().act(guide().prompt_number(), {type, 0, ""})); }
    void cycle(int times = 1) {
        for (int i = 0; i < times && !guide().isOver(); ++i) {
            ASSERT_TRUE(commissioner_->cycle().has_value());
        }
    }
    void hold_for(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            act(Act::Type::HOLD);
            cycle();
        }
    }
    /// Confirms until a motion is offered.
    void reach_motion() {
        for (int i = 0; i < 20000 && guide().prompt().ask != Ask::HOLD; ++i) {
            if (guide().prompt().ask == Ask::CONFIRM) {
                act(Act::Type::CONFIRM);
            }
            cycle();
        }
        ASSERT_EQ(guide().prompt().ask, Ask::HOLD);
        ASSERT_TRUE(isEnabled());
    }
    /// Task cycles in a time.
    static int cycles(double seconds) { return static_cast<int>(seconds * 1000); }
    /// Nothing moves for a second.
    void expect_standstill(const std::string &when) {
        const double before = position();
        cycle(cycles(1));
        EXPECT_NEAR(position(), before, 0.05) << when;
    }

    std::filesystem::path folder_;
    std::unique_ptr<Commissioner> commissioner_;
};

TEST_P(SafetyTest, TheButtonMayBeReleasedAtAnyInstant) {
    reach_motion();
    for (int held = 1; held < 120 && guide().prompt().ask == Ask::HOLD; held += held < 20 ? 1 : 17) {
        hold_for(held);
        if (held % 2 == 0) {
            act(Act::Type::RELEASE);
        }
        // The button counts as released after 0.25 s, then the axis brakes.
        cycle(cycles(0.75));
        expect_standstill("held for " + std::to_string(held));
        EXPECT_EQ(value("joint.0.homing"), 0) << held;
    }
}

TEST_P(SafetyTest, AProgramThatHangsHasItsMachineSwitchedOff) {
    reach_motion();
    hold_for(cycles(0.3));
    const double before = position();
    // The machine remains on, but the program of the steps has ended.
    for (int i = 0; i < cycles(0.6); ++i) {
        commissioner_->machine().cycle();
    }
    EXPECT_FALSE(isEnabled());
    const double stopped = position();
    constexpr double FASTEST_MM_S = 40;
    EXPECT_LT(std::abs(stopped - before), FASTEST_MM_S * 0.4);
    for (int i = 0; i < cycles(1); ++i) {
        commissioner_->machine().cycle();
    }
    EXPECT_NEAR(position(), stopped, 0.05);
    // The board is connected again: nothing switches on or moves by itself, and the step has a fault.
    for (int i = 0; i < cycles(2) && !guide().isOver(); ++i) {
        act(Act::Type::HOLD);
        cycle();
        EXPECT_FALSE(isEnabled());
    }
    EXPECT_TRUE(guide().isFaulted());
    EXPECT_FALSE(guide().isReady());
}

TEST_P(SafetyTest, ALostBoardIsAFault) {
    reach_motion();
    hold_for(cycles(0.3));
    ASSERT_TRUE(hal().signals().unlink("estop-chain.in1").has_value());
    ASSERT_TRUE(hal().values().set("estop-chain.in1", hal::Value::of_bit(false)).has_value());
    hold_for(cycles(0.5));
    ASSERT_TRUE(guide().isFaulted());
    // The session reacts to a fault in this way.
    commissioner_->stop();
    EXPECT_FALSE(isEnabled());
    EXPECT_EQ(guide().findings()[guide().current()]->fault, commissioning::Fault::STOPPED);
    EXPECT_FALSE(guide().isReady());
}

TEST_P(SafetyTest, TheEndOfTheOperatorSwitchesOff) {
    reach_motion();
    hold_for(cycles(0.3));
    commissioner_->stop();
    EXPECT_FALSE(isEnabled());
    EXPECT_EQ(value("motion.motion-enabled"), 0);
}

INSTANTIATE_TEST_SUITE_P(Steps, SafetyTest, ::testing::ValuesIn(SCENES), [](const auto &scene) {
    return std::string(scene.param.step) + "_" + scene.param.drives;
});

}  // namespace
}  // namespace mw::programs
