// SPDX-License-Identifier: GPL-2.0-or-later
// halui's pins in HAL, what they ask of task and show of it, and their manual page.
#include <map>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "mailbox/desk.hh"
#include "msgs/catalogue.hh"
#include "rtapi/virtual_scheduler.hh"
#include "testing/pin_page.hh"
#include "ui/halui/halui.hh"

namespace mw::ui {
namespace {

using testing::PinText;

constexpr int JOINTS = 2;

class HaluiTest : public ::testing::Test {
  protected:
    HaluiTest() {
        hal::HalOptions options;
        options.scheduler = &clock;
        auto made = hal::LocalHost::create(options);
        EXPECT_TRUE(made.has_value());
        host = std::move(*made);
        EXPECT_TRUE(halui.create(hal(), JOINTS).has_value());
        EXPECT_TRUE(halui.join(memory.segment()).has_value());
    }
    ~HaluiTest() override { halui.destroy(); }
    hal::Hal &hal() { return host->hal(); }
    void set(const std::string &name, bool isOn) {
        EXPECT_TRUE(hal().set("halui." + name, isOn ? "1" : "0").has_value()) << name;
    }
    bool lamp(const std::string &name) { return hal().get("halui." + name)->as_bit(); }
    /// A cycle of task; what it was asked for, as text.
    std::string cycle() {
        std::string all;
        halui.step();
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            all += (all.empty() ? "" : ", ") + msgs::to_text(delivery.command);
            EXPECT_TRUE(delivery.isPanel) << "it is wired to the machine";
            desk.tell(delivery.serial, msgs::Progress::DONE, "");
        }
        desk.publish(*status);
        return all;
    }
    std::string asked(const msgs::Command &command) { return msgs::to_text(command); }

    rtapi::VirtualScheduler clock;
    std::unique_ptr<hal::LocalHost> host;
    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::Desk desk{memory.segment()};
    std::unique_ptr<msgs::MachineStatus> status = std::make_unique<msgs::MachineStatus>();
    std::int64_t now_ns = 0;
    Halui halui;
};

std::vector<PinText> rows() {
    return testing::pin_texts([](auto &&show) { pins::for_each(show); });
}

TEST_F(HaluiTest, EachButtonGivesItsCommandOnceOnItsRisingEdge_J4) {
    using namespace msgs;
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
                                                    {"joint.0.home", HomeJoint{0}},
                                                    {"joint.1.home", HomeJoint{1}},
                                                    {"joint.0.unhome", UnhomeJoint{0}},
                                                    {"joint.1.unhome", UnhomeJoint{1}}};
    EXPECT_EQ(cycle(), "") << "nothing is pressed at the start";
    for (const auto &[name, command] : BUTTONS) {
        set(name, true);
        EXPECT_EQ(cycle(), asked(command)) << name;
        EXPECT_EQ(cycle(), "") << name << " is held down";
        set(name, false);
        EXPECT_EQ(cycle(), "") << name << " is let go";
    }
    std::size_t inputs = 0;
    for (const hal::PinInfo &pin : hal().pins("halui.*")) {
        inputs += pin.dir == hal::Dir::IN ? 1 : 0;
    }
    EXPECT_EQ(inputs, BUTTONS.size());
}

TEST_F(HaluiTest, ButtonsThatTaskHasNoRoomForAreTriedAgain_J4) {
    cycle();
    for (int i = 0; i < 20; ++i) {  // more presses than the place of a client has room for
        set("program.step", true);
        halui.step();
        if (i < 19) {
            set("program.step", false);
            halui.step();
        }
    }
    EXPECT_EQ(desk.take(now_ns += 1000000).size(), mailbox::MAX_POSTED);
    EXPECT_EQ(cycle(), asked(msgs::StepProgram{})) << "the one that is still pressed";
}

TEST_F(HaluiTest, LampsShowTheStatusOfTheLastCycle_J4) {
    using namespace msgs;
    const auto lit = [this] {
        cycle();
        halui.step();
        std::string all;
        for (const hal::PinInfo &pin : hal().pins("halui.*")) {
            all += pin.dir == hal::Dir::OUT && pin.value.as_bit() ? pin.name.substr(6) + ' ' : "";
        }
        return all;
    };
    EXPECT_EQ(lit(), "estop.is-activated mode.is-joint mode.is-manual program.is-idle ");
    status->task.state = State::ON;
    status->task.mode = Mode::AUTO;
    status->task.interp_state = InterpState::READING;
    status->trajectory.mode = MotionMode::COORD;
    EXPECT_EQ(lit(), "machine.is-on mode.is-auto program.is-running ");
    status->task.interp_state = InterpState::PAUSED;
    status->joints[1].isHomed = true;
    EXPECT_EQ(lit(), "joint.1.is-homed machine.is-on mode.is-auto program.is-paused ");
    status->task.interp_state = InterpState::WAITING;
    status->task.mode = Mode::MDI;
    status->trajectory.mode = MotionMode::TELEOP;
    EXPECT_EQ(lit(), "joint.1.is-homed machine.is-on mode.is-mdi mode.is-teleop program.is-running ");
}

TEST_F(HaluiTest, EveryRowIsAPinAndEveryPinIsARow_J4) {
    std::map<std::string, PinText> wanted;
    for (const PinText &row : rows()) {
        EXPECT_FALSE(row.doc.empty()) << row.name;
        for (int joint = 0; joint < JOINTS; ++joint) {
            wanted[testing::replaced(row.name, "joint.N", "joint." + std::to_string(joint))] = row;
        }
    }
    std::size_t found = 0;
    for (const hal::PinInfo &pin : hal().pins("*")) {
        if (pin.owner != "halui") {
            continue;
        }
        ++found;
        const auto row = wanted.find(pin.name);
        ASSERT_NE(row, wanted.end()) << pin.name;
        EXPECT_EQ(pin.type, hal::Type::BIT) << pin.name;
        EXPECT_EQ(pin.dir, row->second.dir) << pin.name;
    }
    EXPECT_EQ(found, wanted.size());
}

TEST_F(HaluiTest, TheManualPageHasEachRowAndNoOther_J4) {
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
}  // namespace mw::ui
