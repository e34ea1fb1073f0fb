// SPDX-License-Identifier: GPL-2.0-or-later
// halui's pins in HAL, the commands they send, the states they show, and their manual page.
#include <map>

#include <gtest/gtest.h>

#include "machine/halui/test/halui_rig.hh"
#include "tests/support/pin_page.hh"

namespace mw::halui {
namespace {

using HaluiTest = HaluiRig;
using testing::PinText;

std::vector<PinText> rows() {
    return testing::pin_texts([](auto &&show) { pins::for_each(show); });
}

TEST_F(HaluiTest, EachButtonGivesItsCommandOnceOnItsRisingEdge) {
    using namespace messages;
    const std::map<std::string, Command> BUTTONS = {{"machine.on", SetState{State::ON}},
                                                    {"machine.off", SetState{State::OFF}},
                                                    {"estop.activate", SetState{State::ESTOP}},
                                                    {"estop.reset", SetState{State::ESTOP_RESET}},
                                                    {"mode.auto", SetMode{Mode::AUTO}},
                                                    {"mode.manual", SetMode{Mode::MANUAL}},
                                                    {"mode.mdi", SetMode{Mode::MDI}},
                                                    {"mode.joint", SetTeleop{false}},
                                                    {"mode.teleop", SetTeleop{true}},
                                                    {"home-all", HomeJoint{-1}},
                                                    {"abort", AbortAll{}},
                                                    {"program.run", RunProgram{}},
                                                    {"program.step", StepProgram{}},
                                                    {"program.pause", PauseProgram{}},
                                                    {"program.resume", ResumeProgram{}},
                                                    {"program.stop", AbortAll{}},
                                                    {"program.optional-stop.on", SetOptionalStop{true}},
                                                    {"program.optional-stop.off", SetOptionalStop{false}},
                                                    {"program.block-delete.on", SetBlockDelete{true}},
                                                    {"program.block-delete.off", SetBlockDelete{false}},
                                                    {"flood.on", FloodOn{}},
                                                    {"flood.off", FloodOff{}},
                                                    {"mist.on", MistOn{}},
                                                    {"mist.off", MistOff{}},
                                                    {"lube.on", LubeOn{}},
                                                    {"lube.off", LubeOff{}},
                                                    {"spindle.0.stop", SpindleOff{0}},
                                                    {"spindle.0.brake-on", EngageBrake{0}},
                                                    {"spindle.0.brake-off", ReleaseBrake{0}},
                                                    {"joint.selected.home", HomeJoint{0}},
                                                    {"joint.selected.unhome", UnhomeJoint{0}},
                                                    {"joint.0.home", HomeJoint{0}},
                                                    {"joint.1.home", HomeJoint{1}},
                                                    {"joint.0.unhome", UnhomeJoint{0}},
                                                    {"joint.1.unhome", UnhomeJoint{1}}};
    EXPECT_EQ(cycle(), "") << "nothing is pressed at the start";
    for (const auto &[name, command] : BUTTONS) {
        set(name, true);
        EXPECT_EQ(cycle(), asked(command)) << name;
        EXPECT_EQ(cycle(), "") << name << " is pressed";
        set(name, false);
        EXPECT_EQ(cycle(), "") << name << " is released";
    }
}

TEST_F(HaluiTest, ButtonsThatTaskHasNoRoomForAreTriedAgain) {
    cycle();
    for (int i = 0; i < 20; ++i) {  // more presses than fit into the slot of a client
        set("program.step", true);
        halui.step();
        if (i < 19) {
            set("program.step", false);
            halui.step();
        }
    }
    EXPECT_EQ(desk.take(now_ns += 1000000).size(), mailbox::MAX_POSTED);
    EXPECT_EQ(cycle(), asked(messages::StepProgram{})) << "the one that is still pressed";
}

TEST_F(HaluiTest, LampsShowTheStatusOfTheLastCycle) {
    using namespace messages;
    const auto lit = [this] {
        cycle();
        halui.step();
        std::string all;
        for (const hal::PinInfo &pin : hal().pins().list("halui.*")) {
            all += pin.dir == hal::Dir::OUT && pin.type == hal::Type::BIT && pin.value.as_bit()
                       ? pin.name.substr(6) + ' '
                       : "";
        }
        return all;
    };
    EXPECT_EQ(lit(), "axis.x.is-selected estop.is-activated joint.0.is-selected mode.is-joint mode.is-manual "
                     "program.block-delete.is-on program.is-idle program.optional-stop.is-on ");
    status->task.state = State::ON;
    status->task.mode = Mode::AUTO;
    status->task.interp_state = InterpState::READING;
    status->task.isOptionalStop = status->task.isBlockDelete = false;
    status->trajectory.mode = MotionMode::COORD;
    const std::string selected = "axis.x.is-selected joint.0.is-selected ";
    EXPECT_EQ(lit(), selected + "machine.is-on mode.is-auto program.is-running ");
    status->task.interp_state = InterpState::PAUSED;
    status->joints[1].isHomed = true;
    EXPECT_EQ(lit(), selected + "joint.1.is-homed machine.is-on mode.is-auto program.is-paused ");
    status->task.interp_state = InterpState::WAITING;
    status->task.mode = Mode::MDI;
    status->trajectory.mode = MotionMode::TELEOP;
    EXPECT_EQ(lit(),
              selected + "joint.1.is-homed machine.is-on mode.is-mdi mode.is-teleop program.is-running ");
    status->io.coolant = {true, true};
    status->io.lube.isOn = true;
    status->spindles[0].isOn = status->spindles[0].isBrakeOn = true;
    status->spindles[0].direction = -1;
    EXPECT_EQ(lit(),
              "axis.x.is-selected flood.is-on joint.0.is-selected joint.1.is-homed lube.is-on machine.is-on "
              "mist.is-on mode.is-mdi mode.is-teleop program.is-running spindle.0.brake-is-on "
              "spindle.0.is-on spindle.0.runs-backward ");
    status->spindles[0].direction = 1;
    EXPECT_NE(lit().find("spindle.0.runs-forward"), std::string::npos);
}

TEST_F(HaluiTest, TheLampsOfAJointAreItsOwnAndThoseOfTheSelectedOne) {
    using Lamp = bool messages::JointStatus::*;
    const std::map<std::string, Lamp> LAMPS = {
        {"is-homed", &messages::JointStatus::isHomed},
        {"has-fault", &messages::JointStatus::isFaulted},
        {"override-limits", &messages::JointStatus::isOverridingLimits},
        {"on-hard-min-limit", &messages::JointStatus::isOnNegHardLimit},
        {"on-hard-max-limit", &messages::JointStatus::isOnPosHardLimit},
        {"on-soft-min-limit", &messages::JointStatus::isOnNegSoftLimit},
        {"on-soft-max-limit", &messages::JointStatus::isOnPosSoftLimit}};
    cycle();
    for (const auto &[name, member] : LAMPS) {
        status->joints[1].*member = true;
        cycle();
        halui.step();
        EXPECT_TRUE(lamp("joint.1." + name));
        EXPECT_FALSE(lamp("joint.0." + name));
        EXPECT_FALSE(lamp("joint.selected." + name)) << "joint 0 is selected";
        EXPECT_EQ(press("joint.1.select"), "") << "choosing sends no command";
        halui.step();
        EXPECT_TRUE(lamp("joint.selected." + name));
        press("joint.0.select");
        status->joints[1].*member = false;
    }
}

TEST_F(HaluiTest, NumbersAreShown) {
    status->tool.in_spindle = 7;
    status->settings.max_velocity = 100;
    status->overrides.feed = 0.75;
    status->overrides.rapid = 0.5;
    status->spindles[0].override_factor = 1.1;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        status->offsets.tool[axis] = axis + 1;
        status->trajectory.position_cmd[axis] = 100 + axis;
        status->trajectory.position_fb[axis] = 200 + axis;
    }
    status->offsets.g5x[0] = 10;
    status->offsets.g92[0] = 1;
    status->offsets.g5x[2] = 20;
    messages::ToolTable table{1, {{}}};
    table.tools[0].diameter = 6.5;
    ASSERT_TRUE(desk.publish_tools(table));
    cycle();
    cycle();
    halui.step();
    EXPECT_EQ(value("tool.number"), 7);
    EXPECT_EQ(value("tool.diameter"), 6.5);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        EXPECT_EQ(value(std::string("tool.length_offset.") + geometry::AXIS_LETTERS_LOWER[axis]), axis + 1);
    }
    EXPECT_EQ(value("feed-override.value"), 0.75);
    EXPECT_EQ(value("rapid-override.value"), 0.5);
    EXPECT_EQ(value("spindle.0.override.value"), 1.1);
    EXPECT_EQ(value("max-velocity.value"), 100);
    EXPECT_EQ(value("machine.units-per-mm"), 1);
    EXPECT_EQ(value("axis.x.pos-commanded"), 100);
    EXPECT_EQ(value("axis.z.pos-feedback"), 202);
    EXPECT_EQ(value("axis.x.pos-relative"), 100 - 1 - 10 - 1);
    EXPECT_EQ(value("axis.z.pos-relative"), 102 - 3 - 20);
    status->offsets = {};
    status->offsets.rotation_xy_deg = 90;
    cycle();
    halui.step();
    EXPECT_NEAR(value("axis.x.pos-relative"), 101, 1e-9) << "what was Y";
}

TEST_F(HaluiTest, OneOfTheAxesAndJointsIsSelected) {
    cycle();
    press("axis.z.select");
    halui.step();
    EXPECT_EQ(value("axis.selected"), 2);
    EXPECT_TRUE(lamp("axis.z.is-selected"));
    EXPECT_FALSE(lamp("axis.x.is-selected"));
    press("axis.y.select");
    halui.step();
    EXPECT_EQ(value("axis.selected"), 2) << "the machine has no Y";
    press("joint.1.select");
    halui.step();
    EXPECT_EQ(value("joint.selected"), 1);
    EXPECT_EQ(press("joint.selected.home"), asked(messages::HomeJoint{1}));
}

TEST_F(HaluiTest, EveryRowIsAPinAndEveryPinIsARow) {
    std::map<std::string, PinText> wanted;
    for (const PinText &row : rows()) {
        EXPECT_FALSE(row.doc.empty()) << row.name;
        for (int i = 0; i < 9; ++i) {
            const std::string number = std::to_string(i);
            const bool is_lamp = row.dir == hal::Dir::OUT;
            const bool is_joint = row.name.find("joint.N") != std::string::npos && i < JOINTS;
            const bool is_axis =
                row.name.find("axis.L") != std::string::npos && (!is_lamp || i == 0 || i == 2);
            const bool is_mdi = row.name.find("-NN") != std::string::npos && i < 2;
            const bool is_spindle = row.name.find("spindle.N") != std::string::npos && i == 0;
            const bool is_one = row.name.find_first_of("NL") == std::string::npos;
            if (is_joint || is_axis || is_mdi || is_spindle || is_one) {
                std::string name = testing::replaced(row.name, "NN", "0" + number);
                name = testing::replaced(name, ".N", '.' + number);
                wanted[testing::replaced(name, ".L", std::string(".") + geometry::AXIS_LETTERS_LOWER[i])] =
                    row;
            }
        }
    }
    std::size_t found = 0;
    for (const hal::PinInfo &pin : hal().pins().list("*")) {
        if (pin.owner != "halui") {
            continue;
        }
        ++found;
        const auto row = wanted.find(pin.name);
        ASSERT_NE(row, wanted.end()) << pin.name;
        EXPECT_EQ(pin.type, row->second.type) << pin.name;
        EXPECT_EQ(pin.dir, row->second.dir) << pin.name;
    }
    EXPECT_EQ(found, wanted.size());
}

TEST_F(HaluiTest, TheManualPageHasEachRowAndNoOther) {
    std::vector<std::string> wanted;
    std::string section;
    for (const PinText &row : rows()) {
        wanted.push_back(testing::page_line(row));
        section += wanted.back() + '\n';
    }
    EXPECT_EQ(testing::page_pins(MW_SOURCE_DIR "/docs/man/halui.1.scd"), wanted)
        << "below '# PINS' the page is to have:\n"
        << section;
}

}  // namespace
}  // namespace mw::halui
