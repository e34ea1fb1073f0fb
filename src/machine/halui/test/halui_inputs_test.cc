// SPDX-License-Identifier: GPL-2.0-or-later
// Tests halui's wheels, spindles, jogs and MDI buttons, and how they end.
#include <functional>

#include "machine/halui/test/halui_rig.hh"

namespace mw::halui {
namespace {

using HaluiInputs = HaluiRig;

/// Name of a dial, its command, and its current value.
struct DialCase {
    const char *name;
    std::function<messages::Command(double)> command;
    double high;
    std::function<void(messages::MachineStatus &, double)> show;
    double start = 1;
};

TEST_F(HaluiInputs, DialsFollowWheelsAndButtons) {
    using namespace messages;
    const DialCase CASES[] = {{"feed-override", [](double v) { return SetFeedOverride{v}; }, 1.5,
                               [](MachineStatus &s, double v) { s.overrides.feed = v; }},
                              {"rapid-override", [](double v) { return SetRapidOverride{v}; }, 1,
                               [](MachineStatus &s, double v) { s.overrides.rapid = v; }},
                              {"spindle.0.override", [](double v) { return SetSpindleOverride{v, 0}; }, 1.2,
                               [](MachineStatus &s, double v) { s.spindles[0].override_factor = v; }},
                              {"max-velocity", [](double v) { return SetMaxVelocity{v}; }, 100,
                               [](MachineStatus &s, double v) { s.settings.max_velocity = v; }, 100}};
    for (const DialCase &one : CASES) {
        SCOPED_TRACE(one.name);
        const std::string name = std::string(one.name) + '.';
        cycle();
        const auto in_force = [&](double v) {
            one.show(*status, v);
            cycle();
            halui.step();
        };
        in_force(one.start);
        EXPECT_EQ(value(name + "scale"), 0.1);
        EXPECT_TRUE(lamp(name + "count-enable"));
        set_value(name + "scale", "0.125");
        set_value(name + "counts", "-2");
        EXPECT_EQ(cycle(), asked(one.command(one.start - 0.25)));
        in_force(one.start - 0.25);
        EXPECT_EQ(press(name + "increase"), asked(one.command(one.start - 0.125)));
        in_force(one.start - 0.125);
        EXPECT_EQ(press(name + "decrease"), asked(one.command(one.start - 0.25)));
        in_force(one.start - 0.25);
        set(name + "count-enable", false);
        set_value(name + "counts", "5");
        EXPECT_EQ(cycle(), "");
        set(name + "count-enable", true);
        EXPECT_EQ(cycle(), "") << "what was turned meanwhile does not count";
        set_value(name + "counts", "500000");
        EXPECT_EQ(cycle(), asked(one.command(one.high)));
        in_force(one.high);
        set(name + "direct-value", true);
        EXPECT_EQ(cycle(), "");
        set_value(name + "counts", "7");
        EXPECT_EQ(cycle(), asked(one.command(0.875)));
        in_force(0.875);
        set(name + "direct-value", false);
        EXPECT_EQ(cycle(), "");
        if (one.start == 1) {
            EXPECT_EQ(press(name + "reset"), asked(one.command(1)));
        }
        in_force(one.start);
    }
}

TEST_F(HaluiInputs, TwoTurnsInOneCycleOfTaskAddUp) {
    cycle();
    halui.step();
    set_value("feed-override.counts", "-1");
    halui.step();
    set_value("feed-override.counts", "-3");
    EXPECT_EQ(cycle(), asked(messages::SetFeedOverride{0.9}) + ", " + asked(messages::SetFeedOverride{0.7}));
}

TEST_F(HaluiInputs, TheSpindleTurnsAsProgrammedAndStepsFromThere) {
    using messages::SpindleOn;
    cycle();
    EXPECT_EQ(press("spindle.0.start"), asked(SpindleOn{0, 1})) << "no S yet";
    status->codes.settings[2] = 500;
    cycle();
    halui.step();
    EXPECT_EQ(press("spindle.0.forward"), asked(SpindleOn{0, 500}));
    EXPECT_EQ(press("spindle.0.reverse"), asked(SpindleOn{0, -500}));
    EXPECT_EQ(press("spindle.0.increase"), "") << "it is stopped";
    halui.step();
    EXPECT_TRUE(lamp("outcome.is-refused"));
    status->spindles[0].isOn = true;
    status->spindles[0].direction = -1;
    status->spindles[0].speed_cmd_rpm = -60;
    cycle();
    halui.step();
    EXPECT_EQ(press("spindle.0.increase"), asked(SpindleOn{0, -160}));
    EXPECT_EQ(press("spindle.0.decrease"), asked(SpindleOn{0, -1}));
}

TEST_F(HaluiInputs, JogSpeedsArePerMinuteAndAJogLastsAsLongAsItsPin) {
    using namespace messages;
    constexpr int LEASE_MS = 500;
    struct Case {
        std::string pins, group;
        bool isJoint;
        int index;
    };
    for (const Case &one : {Case{"joint.1", "joint", true, 1}, Case{"joint.selected", "joint", true, 0},
                            Case{"axis.z", "axis", false, 2}, Case{"axis.selected", "axis", false, 0}}) {
        SCOPED_TRACE(one.pins);
        cycle();
        set_value(one.group + ".jog-speed", "300");
        set(one.pins + ".plus", true);
        EXPECT_EQ(cycle(), asked(JogContinuous{one.isJoint, one.index, 5, LEASE_MS, false}));
        EXPECT_EQ(cycle(), "");
        now_ns += 100000000;
        cycle();
        halui.step();
        EXPECT_EQ(cycle(), asked(JogContinuous{one.isJoint, one.index, 5, LEASE_MS, true}))
            << "a renewal begins nothing that was stopped";
        set(one.pins + ".minus", true);
        EXPECT_EQ(cycle(), asked(JogStop{one.isJoint, one.index})) << "both";
        set(one.pins + ".plus", false);
        EXPECT_EQ(cycle(), asked(JogContinuous{one.isJoint, one.index, -5, LEASE_MS, false}));
        set(one.pins + ".minus", false);
        EXPECT_EQ(cycle(), asked(JogStop{one.isJoint, one.index}));
        set_value(one.pins + ".increment", "0.25");
        EXPECT_EQ(press(one.pins + ".increment-plus"), asked(JogIncrement{one.isJoint, one.index, 5, 0.25}));
        EXPECT_EQ(press(one.pins + ".increment-minus"),
                  asked(JogIncrement{one.isJoint, one.index, 5, -0.25}));
    }
}

TEST_F(HaluiInputs, AStickJogsBeyondItsDeadbandWithItsPartOfTheSpeed) {
    using namespace messages;
    for (const std::string group : {"joint", "axis"}) {
        const bool isJoint = group == "joint";
        const std::string stick = isJoint ? "joint.0.analog" : "axis.x.analog";
        cycle();
        EXPECT_EQ(value(group + ".jog-deadband"), 0.2);
        set_value(group + ".jog-speed", "600");
        set_value(stick, "0.2");
        EXPECT_EQ(cycle(), "");
        set_value(stick, "0.5");
        EXPECT_EQ(cycle(), asked(JogContinuous{isJoint, 0, 5, 500, false}));
        set_value(stick, "0.75");
        EXPECT_EQ(cycle(), asked(JogContinuous{isJoint, 0, 7.5, 500, true}));
        set_value(stick, "-0.5");
        EXPECT_EQ(cycle(),
                  asked(JogStop{isJoint, 0}) + ", " + asked(JogContinuous{isJoint, 0, -5, 500, false}));
        set_value(stick, "0.1");
        EXPECT_EQ(cycle(), asked(JogStop{isJoint, 0}));
    }
}

TEST_F(HaluiInputs, AHeldJogGoesToTheJointThatIsSelected) {
    using namespace messages;
    cycle();
    set_value("joint.jog-speed", "300");
    set("joint.selected.plus", true);
    cycle();
    set("joint.1.select", true);
    EXPECT_EQ(cycle(), asked(JogStop{true, 0}) + ", " + asked(JogContinuous{true, 1, 5, 500, false}));
    EXPECT_EQ(cycle(), "");
    set("joint.selected.plus", false);
    EXPECT_EQ(cycle(), asked(JogStop{true, 1}));
}

TEST_F(HaluiInputs, AJogThatSomethingElseHasEndedBeginsWithNoSelection) {
    using namespace messages;
    cycle();
    set_value("joint.jog-speed", "300");
    set("joint.selected.plus", true);
    cycle();
    progress = Progress::REFUSED;  // the progress after an abort
    now_ns += 100000000;
    cycle();
    halui.step();
    EXPECT_EQ(cycle(), asked(JogContinuous{true, 0, 5, 500, true}));
    cycle();
    progress = Progress::DONE;
    set("joint.1.select", true);
    EXPECT_EQ(cycle(), asked(JogStop{true, 0}));
    EXPECT_EQ(cycle(), "") << "plus was pressed for joint 0 alone";
    set("joint.selected.plus", false);
    EXPECT_EQ(cycle(), "");
    set("joint.selected.plus", true);
    EXPECT_EQ(cycle(), asked(JogContinuous{true, 1, 5, 500, false}));
}

TEST_F(HaluiInputs, WhatIsOnAtTheStartWasPressedByNobody) {
    set_value("joint.jog-speed", "300");
    set("joint.0.plus", true);
    set("axis.x.increment-plus", true);
    set("mdi-command-00", true);
    set_value("feed-override.counts", "55");
    set("spindle.0.start", true);
    EXPECT_EQ(cycle(), "");
    EXPECT_EQ(cycle(), "");
}

TEST_F(HaluiInputs, AnMdiCommandGoesToItsModeAndBack) {
    using namespace messages;
    status->task.mode = Mode::MANUAL;
    cycle();
    halui.step();
    set("mdi-command-00", true);
    EXPECT_EQ(cycle(), asked(SetMode{Mode::MDI}));
    status->task.mode = Mode::MDI;
    progress = Progress::STARTED;
    EXPECT_EQ(cycle(), asked(Mdi{"G0 X1"}));
    EXPECT_EQ(cycle(), "") << "it runs";
    progress = Progress::DONE;
    desk.tell(last_serial, Progress::DONE, "");
    EXPECT_EQ(cycle(), asked(SetMode{Mode::MANUAL}));
    status->task.mode = Mode::MANUAL;
    set("mdi-command-00", false);
    EXPECT_EQ(cycle(), "");
    halui.step();
    progress = Progress::REFUSED;
    set("mdi-command-01", true);
    EXPECT_EQ(cycle(), asked(SetMode{Mode::MDI}));
    EXPECT_EQ(cycle(), "") << "without its mode the line is not run";
    progress = Progress::DONE;
    status->task.mode = Mode::MDI;
    set("mdi-command-01", false);
    cycle();
    halui.step();
    set("mdi-command-01", true);
    EXPECT_EQ(cycle(), asked(Mdi{"M5"})) << "in MDI mode already";
    EXPECT_EQ(cycle(), "");
}

TEST_F(HaluiInputs, OutcomesArePins) {
    cycle();
    progress = messages::Progress::REFUSED;
    press("machine.on");
    halui.step();
    EXPECT_TRUE(lamp("outcome.is-refused"));
    EXPECT_EQ(value("outcome.refusals"), 1);
    progress = messages::Progress::DONE;
    press("machine.on");
    halui.step();
    EXPECT_FALSE(lamp("outcome.is-refused"));
    EXPECT_EQ(value("outcome.refusals"), 1);
}

}  // namespace
}  // namespace mw::halui
