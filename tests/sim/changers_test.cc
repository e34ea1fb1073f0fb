// SPDX-License-Identifier: GPL-2.0-or-later
// Tool changes with a whole machine as configured in its INI file, acknowledged faults, and lubrication. The
// judge uses only pins.
#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class ChangerTest : public VirtualMachineTest {
  protected:
    /// A mill with these lines in [EMCIO]; the test is its changer.
    void begin(const std::string &emcio, const std::string &tools = "T1 P1 Z0\nT2 P2 Z3\nT3 P3 Z4\n") {
        SimMachine file;
        file.axis_range = 200;
        file.write(folder_);
        std::string hal = read("sim.hal"), ini = read("sim.ini");
        for (const char *line : {"net prepared iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n",
                                 "net changed iocontrol.0.tool-change => iocontrol.0.tool-changed\n"}) {
            hal.erase(hal.find(line), std::string(line).size());
        }
        const std::string chain = "net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n";
        hal.replace(hal.find(chain), chain.size(), "net chain => iocontrol.0.emc-enable-in\nsets chain 1\n");
        const std::string key = "TOOL_TABLE = sim.tbl\n";
        ini.insert(ini.find(key) + key.size(), emcio);
        write("sim.hal", hal);
        write("sim.ini", ini);
        write("sim.tbl", tools);
        switch_on_config(folder_ / "sim.ini");
    }
    bool pin(const std::string &name) const { return VirtualMachineTest::pin("iocontrol.0." + name); }
    int number(const std::string &name) const {
        return static_cast<int>(machine_->hal().values().get("iocontrol.0." + name)->as_s32());
    }
    void set(const std::string &name, bool isOn) { set_pin("iocontrol.0." + name, isOn ? "1" : "0"); }
    geometry::Pose place() const { return motion().carte_pos_cmd; }
    /// Answers like a changer until the pin `request` is on, which it does not answer; false if the pin never
    /// is.
    bool run_until(const std::string &request) {
        for (int i = 0; i < 20000 && !pin(request); ++i) {
            if (progress(run_) != task::Progress::STARTED) {
                return false;
            }
            set("tool-prepared", pin("tool-prepare"));
            cycles(1);
        }
        return pin(request);
    }
    /// The machine is stopped there from the change request until after the answer.
    void expect_change_at(double x, double y, double z) {
        ASSERT_TRUE(run_until("tool-change")) << messages();
        const geometry::Pose there = place();
        EXPECT_NEAR(there[0], x, 1e-6);
        EXPECT_NEAR(there[1], y, 1e-6);
        EXPECT_NEAR(there[2], z, 1e-6);
        EXPECT_EQ(motion().current_velocity, 0);
        const std::size_t first = samples_.size();
        cycles(300);
        for (std::size_t i = first; i < samples_.size(); ++i) {
            ASSERT_EQ(geometry::norm_xyz(samples_[i].carte_pos_cmd - there), 0)
                << "moves with the changer's arm in";
        }
        set("tool-changed", true);
        cycles(5);
        EXPECT_FALSE(pin("tool-change"));
        set("tool-changed", false);
    }
    static constexpr const char *TO_G30 = "G21 G90 F2000\nG0 X50 Y40 Z-30\nG30.1\nG0 X5 Y6 Z-20\n";
};

TEST_F(ChangerTest, WithoutSettingsTheMachineStaysWhereItIsAndTheSpindleStops) {
    begin("");
    start(std::string(TO_G30) + "S500 M3\nT2 M6\nG1 X7\nM2\n");
    ASSERT_TRUE(run_until("tool-change"));
    EXPECT_FALSE(VirtualMachineTest::pin("spindle.0.on"));
    expect_change_at(5, 6, -20);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_EQ(number("tool-number"), 2);
}

TEST_F(ChangerTest, TOOL_CHANGE_AT_G30IsWhereToolsAreChanged) {
    begin("TOOL_CHANGE_AT_G30 = 1\n");
    start(std::string(TO_G30) + "T2 M6\nG1 X7\nM2\n");
    expect_change_at(50, 40, -30);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_NEAR(place()[0], 7, 1e-9);
    EXPECT_NEAR(place()[1], 40, 1e-9) << "the next move begins there";
    // A line of MDI in inches, in another coordinate system and with a tool offset: the position is in
    // machine coordinates.
    ASSERT_EQ(mdi("G10 L2 P2 X9 Y8 Z7"), task::Progress::DONE);
    ASSERT_EQ(mdi("G55 G43 H3 G20"), task::Progress::DONE);
    ask(task::SetMode{task::Mode::MDI});
    run_ = post(task::Mdi{"T3 M6"});
    expect_change_at(50, 40, -30);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_EQ(number("tool-number"), 3);
}

TEST_F(ChangerTest, TOOL_CHANGE_QUILL_UPTakesZToMachineZero) {
    begin("TOOL_CHANGE_QUILL_UP = 1\n");
    start("G21 G90 F2000\nG10 L2 P1 Z-15\nG43 H3\nG0 X5 Y6 Z-20\nT2 M6\nG1 Z-21\nM2\n");
    expect_change_at(5, 6, 0);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
}

TEST_F(ChangerTest, WithBothTheQuillIsUpBeforeItGoesToG30) {
    begin("TOOL_CHANGE_QUILL_UP = 1\nTOOL_CHANGE_AT_G30 = 1\n");
    start(std::string(TO_G30) + "T2 M6\nM2\n");
    ASSERT_TRUE(run_until("tool-prepare"));
    cycles(2);
    for (int i = 0; i < 20000 && !(place()[0] == 5 && motion().current_velocity == 0 && i > 0); ++i) {
        cycles(1);
    }
    const std::size_t first = samples_.size();
    expect_change_at(50, 40, -30);
    constexpr double ROUNDED_MM = 0.06;  // the corner of two rapids
    bool isAtTop = false;
    for (std::size_t i = first; i < samples_.size(); ++i) {
        const geometry::Pose &at = samples_[i].carte_pos_cmd;
        isAtTop = isAtTop || std::fabs(at[2]) < ROUNDED_MM;
        const bool isOnItsWay = std::fabs(at[0] - 5) > ROUNDED_MM;
        ASSERT_TRUE(isAtTop || !isOnItsWay) << "X moves with the tool down, at Z" << at[2];
    }
    EXPECT_TRUE(isAtTop);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
}

TEST_F(ChangerTest, TOOL_CHANGE_WITH_SPINDLE_ONLeavesItTurning) {
    begin("TOOL_CHANGE_WITH_SPINDLE_ON = 1\n");
    start("G21 G90 F2000\nS500 M3\nG4 P0.1\nT2 M6\nG4 P0.1\nM2\n");
    ASSERT_TRUE(run_until("tool-change"));
    for (int i = 0; i < 100; ++i) {
        cycles(1);
        ASSERT_TRUE(VirtualMachineTest::pin("spindle.0.on"));
    }
    set("tool-changed", true);
    cycles(20);
    EXPECT_TRUE(VirtualMachineTest::pin("spindle.0.on")) << "and the program continues";
    set("tool-changed", false);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    cycles(5);
    EXPECT_FALSE(VirtualMachineTest::pin("spindle.0.on")) << "M2";
}

TEST_F(ChangerTest, AFaultIsAcknowledgedEndsTheProgramAndTheNextChangeWaitsForItsEnd) {
    begin("EMCIO = iov2\n");
    set("emc-abort-ack", true);
    start("G21 G90 F2000\nT2 M6\nG1 X7\nM2\n");
    ASSERT_TRUE(run_until("tool-change"));
    EXPECT_FALSE(pin("toolchanger-fault-ack"));
    set_pin("iocontrol.0.toolchanger-reason", "-7");
    set("emc-abort-ack", false);
    set("toolchanger-fault", true);
    cycles(5);
    EXPECT_TRUE(pin("toolchanger-fault-ack") && pin("toolchanger-faulted"));
    EXPECT_FALSE(pin("tool-change"));
    EXPECT_EQ(progress(run_), task::Progress::FAILED);
    EXPECT_NE(messages().find("toolchanger-reason -7"), std::string::npos);
    EXPECT_TRUE(pin("emc-abort")) << "held until it is answered";
    EXPECT_EQ(number("emc-reason"), 101);
    set("emc-abort-ack", true);
    cycles(5);
    EXPECT_FALSE(pin("emc-abort"));
    set("toolchanger-fault", false);
    cycles(5);
    EXPECT_FALSE(pin("toolchanger-fault-ack")) << "falls with the fault";
    EXPECT_TRUE(pin("toolchanger-faulted")) << "stays";
    EXPECT_EQ(number("tool-number"), 0) << "nothing was changed";
    start("T2 M6\nM2\n");
    EXPECT_FALSE(run_until("tool-change")) << "the next M6 does not begin";
    EXPECT_EQ(progress(run_), task::Progress::FAILED);
    set("toolchanger-clear-fault", true);
    cycles(5);
    EXPECT_FALSE(pin("toolchanger-faulted"));
    set("toolchanger-clear-fault", false);
    start("T2 M6\nM2\n");
    ASSERT_TRUE(run_until("tool-change")) << messages();
    set("tool-changed", true);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_EQ(number("tool-number"), 2);
}

TEST_F(ChangerTest, AReasonAboveZeroIsToldAndTheProgramFindsItInItsParameters) {
    begin("EMCIO = iov2\n");
    set("emc-abort-ack", true);
    start("G21 G90 F2000\nT2 M6\nG0 X[#5600 * 10 + #5601]\nM2\n");
    ASSERT_TRUE(run_until("tool-change"));
    set_pin("iocontrol.0.toolchanger-reason", "4");
    set("toolchanger-fault", true);
    cycles(3);
    EXPECT_TRUE(pin("toolchanger-fault-ack"));
    set("toolchanger-fault", false);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_NEAR(place()[0], 14, 1e-9) << "#5600 is 1, #5601 the reason";
    EXPECT_EQ(number("tool-number"), 0);
}

TEST_F(ChangerTest, LubricationFollowsTheEmergencyStopAndItsCommands) {
    begin("");
    EXPECT_TRUE(pin("lube")) << "on since the emergency stop was reset";
    const auto state = [this] { return machine_->task().status().io.lube; };
    EXPECT_TRUE(state().isOn && state().hasOil);
    ask(messages::LubeOff{});
    EXPECT_FALSE(pin("lube") || state().isOn);
    ask(messages::LubeOn{});
    EXPECT_TRUE(pin("lube"));
    ask(messages::SetState{messages::State::OFF});
    EXPECT_TRUE(pin("lube")) << "off is no emergency stop";
    ask(messages::SetState{messages::State::ESTOP});
    EXPECT_FALSE(pin("lube"));
    ask(messages::SetState{messages::State::ESTOP_RESET});
    cycles(20);
    EXPECT_TRUE(pin("lube"));
    EXPECT_EQ(messages().find("oil"), std::string::npos);
    set("lube_level", false);
    cycles(20);
    EXPECT_FALSE(state().hasOil);
    const std::string told = messages();
    EXPECT_NE(told.find("iocontrol.0.lube_level is FALSE"), std::string::npos);
    EXPECT_EQ(told.find("oil"), told.rfind("oil")) << "once";
    set("lube_level", true);
    cycles(3);
    EXPECT_TRUE(state().hasOil);
    *static_cast<volatile bool *>(*machine_->hal().values().address_of("chain", hal::Type::BIT)) = false;
    cycles(5);
    EXPECT_FALSE(pin("lube")) << "the chain";
}

/// Tool positions in the table of a random changer.
TEST_F(ChangerTest, AStartAtALineOfARandomChangerSetsTheToolInTheSpindleToo) {
    begin("RANDOM_TOOLCHANGER = 1\n", "T1 P0 Z1.5\nT2 P11 Z2.5\n");
    write("p.ngc", "G10 L1 P1 Z4\nG10 L1 P2 Z5\nG43\nM61 Q1\nG0 X1\nM2\n");
    ask(task::SetMode{task::Mode::AUTO});
    ask(task::OpenProgram{(folder_ / "p.ngc").string()});
    run_ = post(task::RunProgram{5});
    for (int i = 0; i < 3000 && progress(run_) == task::Progress::STARTED; ++i) {
        const auto number = machine_->task().status().approach.number;
        if (number != 0) {
            ask(messages::ConfirmApproach{number});
        }
        cycles(1);
    }
    EXPECT_EQ(progress(run_), task::Progress::DONE) << reason(run_);
    EXPECT_NE(read("sim.tbl").find("T1 P0 Z4"), std::string::npos) << read("sim.tbl");
    EXPECT_NE(read("sim.tbl").find("T2 P11 Z5"), std::string::npos) << read("sim.tbl");
    EXPECT_EQ(machine_->task().status().offsets.tool[2], 4);
    // After M61 sets another tool, the position of the first one is unknown.
    write("p.ngc", "G10 L1 P2 Z6\nM61 Q2\nG0 X2\nM2\n");
    ask(task::OpenProgram{(folder_ / "p.ngc").string()});
    run_ = post(task::RunProgram{3});
    EXPECT_EQ(finish(), task::Progress::FAILED);
    EXPECT_NE(reason(run_).find("(M61) in line 2; the nearest possible line before it is 2"),
              std::string::npos)
        << reason(run_);
    EXPECT_NE(read("sim.tbl").find("T2 P11 Z5"), std::string::npos) << read("sim.tbl");
}

}  // namespace
}  // namespace mw::machine
