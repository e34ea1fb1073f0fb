// SPDX-License-Identifier: GPL-2.0-or-later
// Controls besides a screen on a whole machine in virtual time: buttons and lamps (halui), settings as pins
// (ini.*), and manual tool change (hal_manualtoolchange).
#include <fmt/format.h>

#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class PanelTest : public VirtualMachineTest {
  protected:
    void SetUp() override {
        SimMachine sim;
        sim.hasSpindle = true;
        sim.write(folder_);
        replace("sim.ini", "[HAL]\n", "[HAL]\nHALUI = halui\n");
        replace("sim.hal", "net changed iocontrol.0.tool-change => iocontrol.0.tool-changed\n",
                "loadusr -W hal_manualtoolchange\n"
                "net change iocontrol.0.tool-change => hal_manualtoolchange.change\n"
                "net changed hal_manualtoolchange.changed => iocontrol.0.tool-changed\n"
                "net number iocontrol.0.tool-prep-number => hal_manualtoolchange.number\n");
        switch_on_config((folder_ / "sim.ini").string());
        ASSERT_NE(machine_, nullptr);
        messages();
    }
    void replace(const std::string &file, const std::string &from, const std::string &to) {
        std::string text = read(file);
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        write(file, text.replace(at, from.size(), to));
    }
    void press(const std::string &button) {
        set_pin("halui." + button, "1");
        cycles(5);
        set_pin("halui." + button, "0");
        cycles(5);
    }
    bool lamp(const std::string &name) const { return pin("halui." + name); }
    const messages::TaskStatus &task() const { return machine_->task().status().task; }
};

TEST_F(PanelTest, ButtonsOfTheMachineSwitchItAndLampsTell) {
    EXPECT_TRUE(lamp("machine.is-on"));
    press("machine.off");
    EXPECT_FALSE(lamp("machine.is-on"));
    EXPECT_FALSE(lamp("estop.is-activated"));
    EXPECT_FALSE(motion().isEnabled);
    press("machine.on");
    cycles(20);
    EXPECT_TRUE(lamp("machine.is-on"));
    press("estop.activate");
    EXPECT_TRUE(lamp("estop.is-activated"));
    EXPECT_FALSE(lamp("machine.is-on"));
    press("machine.on");
    EXPECT_FALSE(lamp("machine.is-on")) << "out of an e-stop only by its reset";
    press("estop.reset");
    EXPECT_FALSE(lamp("estop.is-activated"));
    EXPECT_FALSE(lamp("machine.is-on")) << "a reset energises nothing";
}

TEST_F(PanelTest, ButtonsOfTheModesSetThem) {
    for (const std::string mode : {"auto", "mdi", "manual", "auto", "manual"}) {
        press("mode." + mode);
        for (const std::string other : {"auto", "mdi", "manual"}) {
            EXPECT_EQ(lamp("mode.is-" + other), other == mode) << mode << ' ' << other;
        }
    }
    press("mode.joint");
    EXPECT_TRUE(lamp("mode.is-joint"));
    EXPECT_FALSE(lamp("mode.is-teleop"));
    press("mode.teleop");
    EXPECT_TRUE(lamp("mode.is-teleop"));
    EXPECT_FALSE(lamp("mode.is-joint"));
}

TEST_F(PanelTest, AButtonThatIsHeldDownActsOnce) {
    set_pin("halui.mode.auto", "1");
    cycles(5);
    ASSERT_EQ(task().mode, task::Mode::AUTO);
    ask(task::SetMode{task::Mode::MANUAL});
    cycles(20);
    EXPECT_EQ(task().mode, task::Mode::MANUAL);
    set_pin("halui.mode.auto", "0");
    cycles(5);
    EXPECT_EQ(task().mode, task::Mode::MANUAL) << "nothing happens on release";
}

TEST_F(PanelTest, ButtonsOfJointsHomeAndUnhomeThem) {
    press("mode.manual");
    for (const int joint : {0, 1, 2}) {
        const std::string prefix = fmt::format("joint.{}.", joint);
        EXPECT_TRUE(lamp(prefix + "is-homed"));
        press("mode.joint");
        press(prefix + "unhome");
        for (const int other : {0, 1, 2}) {
            EXPECT_EQ(lamp(fmt::format("joint.{}.is-homed", other)), other != joint) << joint << ' ' << other;
        }
        press(prefix + "home");
        cycles(100);
        EXPECT_TRUE(lamp(prefix + "is-homed"));
    }
    for (const int joint : {0, 1, 2}) {
        press("mode.joint");
        press(fmt::format("joint.{}.unhome", joint));
    }
    press("home-all");
    cycles(200);
    EXPECT_TRUE(lamp("joint.0.is-homed") && lamp("joint.1.is-homed") && lamp("joint.2.is-homed"));
}

TEST_F(PanelTest, ButtonsOfTheProgramRunHoldAndEndIt) {
    write("p.ngc", "G21 G90 G1 X50 F600\nX0\nM2\n");
    ask(task::OpenProgram{(folder_ / "p.ngc").string()});
    press("mode.auto");
    EXPECT_TRUE(lamp("program.is-idle"));
    press("program.run");
    cycles(500);
    EXPECT_TRUE(lamp("program.is-running"));
    EXPECT_FALSE(lamp("program.is-idle"));
    const double moving = x();
    EXPECT_GT(moving, 1);
    press("program.pause");
    cycles(200);
    EXPECT_TRUE(lamp("program.is-paused"));
    EXPECT_FALSE(lamp("program.is-running"));
    const double held = x();
    cycles(500);
    EXPECT_EQ(x(), held) << "a pause lasts until resume";
    press("program.resume");
    cycles(200);
    EXPECT_GT(x(), held);
    EXPECT_TRUE(lamp("program.is-running"));
    press("program.stop");
    cycles(300);
    EXPECT_TRUE(lamp("program.is-idle"));
    const double stopped = x();
    cycles(300);
    EXPECT_EQ(x(), stopped);
    press("program.step");
    cycles(20);
    EXPECT_FALSE(lamp("program.is-idle"));
    press("abort");
    cycles(300);
    EXPECT_TRUE(lamp("program.is-idle"));
}

TEST_F(PanelTest, SwitchesOfTheProgramAndCoolant) {
    const std::vector<std::pair<std::string, const bool *>> switches = {
        {"program.optional-stop", &task().isOptionalStop}, {"program.block-delete", &task().isBlockDelete}};
    for (const auto &[name, state] : switches) {
        press(name + ".on");
        EXPECT_TRUE(*state) << name;
        press(name + ".off");
        EXPECT_FALSE(*state) << name;
    }
    for (const std::string coolant : {"flood", "mist"}) {
        press(coolant + ".on");
        EXPECT_TRUE(pin("iocontrol.0.coolant-" + coolant));
        press(coolant + ".off");
        EXPECT_FALSE(pin("iocontrol.0.coolant-" + coolant));
    }
}

TEST_F(PanelTest, ButtonsActWhoeverHasTheRightToOperate) {
    auto other = client::Client::join(machine_->mailbox());
    ASSERT_TRUE(other.has_value());
    ASSERT_TRUE(other->post(messages::ClaimOperation{60}).has_value());
    cycles(5);
    const auto refused = ask(task::SetMode{task::Mode::MDI});
    EXPECT_EQ(progress(refused), task::Progress::REFUSED);
    press("mode.mdi");
    EXPECT_EQ(task().mode, task::Mode::MDI);
    press("estop.activate");
    EXPECT_TRUE(lamp("estop.is-activated"));
}

TEST_F(PanelTest, ThePlannersPinsHoldWhatTheFileSaysAndActAtRestBeforeAnyProgramHasRun) {
    EXPECT_EQ(machine_->hal().values().get("ini.traj-planner-type")->as_number(), 0);
    EXPECT_EQ(machine_->hal().values().get("ini.traj-scurve-peak-scale")->as_number(), 1);
    set_pin("ini.traj-planner-type", "1");
    cycles(20);
    EXPECT_EQ(machine_->task().planner_mode().type(), 1) << messages();
    set_pin("ini.traj-planner-type", "7");
    cycles(20);
    EXPECT_EQ(machine_->task().planner_mode().type(), 1);
    EXPECT_NE(messages().find("ini.traj-planner-type is 7"), std::string::npos);
    set_pin("ini.traj-scurve-peak-scale", "0.5");
    cycles(20);
    EXPECT_EQ(machine_->task().planner_mode().corner_scale(), 0.5);
}

TEST_F(PanelTest, AToolIsChangedByHandAndTheProgramWaitsForIt) {
    start("G21 T1 M6\nG0 X1\nM2\n");
    bool hasAsked = false;
    for (int i = 0; i < 400 && !hasAsked; ++i) {
        cycles(1);
        hasAsked = pin("hal_manualtoolchange.change");
    }
    ASSERT_TRUE(hasAsked);
    EXPECT_EQ(machine_->hal().values().get("hal_manualtoolchange.number")->as_number(), 1);
    cycles(50);
    EXPECT_EQ(x(), 0) << "moves while a person has hands in the machine";
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_EQ(x(), 1);
    EXPECT_FALSE(pin("hal_manualtoolchange.changed")) << "ready for the next one";
}

}  // namespace
}  // namespace mw::machine
