// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the commands emc_* with a task that accepts them.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "clients/tcl/commands.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::tcl {
namespace {

using messages::Progress;

class TclTest : public ::testing::Test {
  protected:
    TclTest() {
        status->task.state = messages::State::ON;
        status->trajectory.num_joints = 3;
        status->trajectory.num_spindles = 2;
        status->settings.linear_units = 1;
        status->settings.angular_units = 1;
        constexpr std::size_t UNITS = 5;
        status->codes.g[UNITS] = 210;
        desk.take(now_ns);
        desk.publish(*status);
        diagnostics::Sink sink([](const diagnostics::Diagnostic &) {});
        shell.emplace(
            client::Viewer(memory.segment()), [this] { return client::Client::join(memory.segment()); },
            ini::IniFile::parse("[KINS]\nJOINTS = 3\n[A]\nB = c d\nB = e\nN = 2.5\nF = yes\n", "/m/m.ini",
                                sink));
        task = std::jthread([this](const std::stop_token &stop) {
            while (!stop.stop_requested()) {
                cycle();
                std::this_thread::yield();
            }
        });
    }
    /// Runs a cycle of task, in a separate thread, because a command sleeps until it is taken.
    void cycle() {
        const std::scoped_lock lock(mutex);
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            asked += (asked.empty() ? "" : ", ") + messages::to_text(delivery.command);
            status->last_command = delivery.serial;
            desk.tell(delivery.serial, progress, progress == Progress::DONE ? "" : "it cannot");
        }
        ++status->cycle;
        status->time_ns = now_ns;
        desk.publish(*status);
    }
    /// Changes the shown status of the machine.
    void show(const std::function<void(messages::MachineStatus &)> &change) {
        const std::scoped_lock lock(mutex);
        change(*status);
        desk.publish(*status);
    }
    /// The result of a command; "error: TEXT" for an error of the program.
    std::string say(const std::string &name, const Words &words = {}) {
        {
            const std::scoped_lock lock(mutex);
            asked.clear();
        }
        for (const auto &table : {questions(), orders(), settings()}) {
            for (const CommandRow &row : table) {
                if (row.name == name) {
                    EXPECT_TRUE(shell->look().has_value());
                    const auto result = row.handler(*shell, words);
                    return result.has_value() ? *result : "error: " + result.error().str();
                }
            }
        }
        return "no such command";
    }
    std::string was_asked() {
        const std::scoped_lock lock(mutex);
        return asked;
    }

    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::mutex mutex;
    std::int64_t now_ns = 0;
    std::string asked;
    Progress progress = Progress::DONE;
    std::optional<Shell> shell;
    std::jthread task;  ///< last member, so that it ends first
};

TEST_F(TclTest, TellsTheMachine) {
    show([](messages::MachineStatus &s) {
        s.task.mode = messages::Mode::MDI;
        s.spindles[1].direction = -1;
        s.spindles[0].isBrakeOn = true;
        s.overrides.feed = 0.5;
        s.joints[1].isHomed = true;
        s.joints[2].isOnPosHardLimit = true;
        s.settings.joints[2].kind = messages::JointKind::ANGULAR;
        s.tool.in_spindle = 7;
        s.trajectory.position_cmd[0] = 50.8;
        s.offsets.g5x[0] = 25.4;
    });
    EXPECT_EQ(say("emc_estop"), "off");
    EXPECT_EQ(say("emc_machine"), "on");
    EXPECT_EQ(say("emc_mode"), "mdi");
    EXPECT_EQ(say("emc_spindle"), "off");
    EXPECT_EQ(say("emc_spindle", {"1"}), "reverse");
    EXPECT_EQ(say("emc_brake"), "on");
    EXPECT_EQ(say("emc_feed_override"), "50");
    EXPECT_EQ(say("emc_joint_homed", {"0"}), "not");
    EXPECT_EQ(say("emc_joint_homed", {"1"}), "homed");
    EXPECT_EQ(say("emc_joint_limit", {"2"}), "maxhard");
    EXPECT_EQ(say("emc_joint_limit", {"15"}), "ok") << "screens read all joints";
    EXPECT_EQ(say("emc_joint_type", {"2"}), "angular");
    EXPECT_EQ(say("emc_tool"), "7");
    EXPECT_EQ(say("emc_program"), "none");
    EXPECT_EQ(say("emc_program_status"), "idle");
    EXPECT_EQ(say("emc_error"), "ok");
    EXPECT_EQ(say("emc_abs_cmd_pos", {"X"}), "50.8");
    EXPECT_EQ(say("emc_rel_cmd_pos", {"X"}), "25.4");
    EXPECT_EQ(say("emc_display_linear_units"), "(mm)");
    EXPECT_EQ(say("emc_linear_unit_conversion", {"inch"}), "");
    EXPECT_EQ(say("emc_abs_cmd_pos", {"X"}), "2.0");
    EXPECT_EQ(say("emc_rel_cmd_pos", {"X"}), "1.0");
    EXPECT_EQ(say("emc_pos_offset", {"X"}), "1.0");
    EXPECT_EQ(say("emc_display_linear_units"), "inch");
    EXPECT_EQ(say("emc_abs_cmd_pos", {"0"}), "error: '0' is not one of X Y Z A B C U V W");
}

TEST_F(TclTest, WithAutoLengthsAreInTheUnitsOfTheProgram) {
    show([](messages::MachineStatus &s) {
        s.codes.g[5] = 200;
        s.trajectory.position_fb[1] = 25.4;
    });
    EXPECT_EQ(say("emc_abs_act_pos", {"Y"}), "1.0");
    EXPECT_EQ(say("emc_rel_act_pos", {"Y"}), "1.0");
    EXPECT_EQ(say("emc_display_linear_units"), "(inch)");
    EXPECT_EQ(say("emc_program_linear_units"), "inch");
    EXPECT_EQ(say("emc_user_linear_units"), "mm");
}

TEST_F(TclTest, AsksTheMachine) {
    const auto asks = [this](const std::string &name, const Words &words) {
        EXPECT_EQ(say(name, words), "") << name;
        return was_asked();
    };
    EXPECT_EQ(asks("emc_estop", {"off"}),
              messages::to_text(messages::SetState{messages::State::ESTOP_RESET}));
    EXPECT_EQ(asks("emc_mode", {"auto"}), messages::to_text(messages::SetMode{messages::Mode::AUTO}));
    EXPECT_EQ(asks("emc_mdi", {"G0", "X1"}), messages::to_text(messages::Mdi{"G0 X1"}));
    EXPECT_EQ(asks("emc_home", {"-1"}), messages::to_text(messages::HomeJoint{-1}));
    EXPECT_EQ(asks("emc_jog_incr", {"0", "1", "-600", "0.5"}),
              messages::to_text(messages::JogIncrement{true, 0, 10, -0.5}));
    EXPECT_EQ(asks("emc_rapid_override", {"25"}), messages::to_text(messages::SetRapidOverride{0.25}));
    EXPECT_EQ(asks("emc_teleop_enable", {"1"}), messages::to_text(messages::SetTeleop{true}));
    EXPECT_EQ(asks("emc_spindle", {"forward", "1"}), messages::to_text(messages::SpindleOn{1, 500}));
    EXPECT_EQ(asks("emc_abort", {}), messages::to_text(messages::AbortAll{}));
    EXPECT_NE(asks("emc_jog", {"0", "0", "600"}).find("JogContinuous"), std::string::npos);
    EXPECT_TRUE(shell->isJogging());
    EXPECT_NE(asks("emc_jog_stop", {"0", "0"}).find("JogStop"), std::string::npos);
    EXPECT_FALSE(shell->isJogging());
    EXPECT_TRUE(say("emc_mode", {"sideways"}).starts_with("error: "));
    EXPECT_EQ(was_asked(), "");
}

TEST_F(TclTest, ARefusalIsAnAnswerAndATimeoutToo) {
    progress = Progress::REFUSED;
    EXPECT_EQ(say("emc_mdi", {"G0", "X1"}), "it cannot");
    progress = Progress::STARTED;
    EXPECT_EQ(say("emc_set_timeout", {"0.02"}), "");
    EXPECT_EQ(say("emc_mdi", {"G0", "X1"}), "") << "received is enough";
    EXPECT_EQ(say("emc_wait", {"done"}), "timeout");
    EXPECT_EQ(say("emc_set_wait", {"done"}), "");
    EXPECT_EQ(say("emc_mdi", {"G0", "X1"}), "timeout");
    EXPECT_EQ(say("emc_set_wait"), "done");
}

TEST_F(TclTest, StatusStaysWhereItIsUntilItIsUpdated) {
    EXPECT_EQ(say("emc_update", {"none"}), "");
    show([](messages::MachineStatus &s) { s.tool.in_spindle = 3; });
    EXPECT_EQ(say("emc_tool"), "0");
    EXPECT_EQ(say("emc_update"), "");
    EXPECT_EQ(say("emc_tool"), "3");
}

TEST_F(TclTest, TellsTheIniFile) {
    EXPECT_EQ(say("emc_ini", {"B", "A"}), "c d");
    EXPECT_EQ(say("emc_ini", {"X", "A"}), "");
    EXPECT_EQ(say("emc_ini", {"X", "A", "preset"}), "preset");
    EXPECT_EQ(say("emc_ini_real", {"N", "A"}), "2.5");
    EXPECT_EQ(say("emc_ini_int", {"JOINTS", "KINS"}), "3");
    EXPECT_EQ(say("emc_ini_bool", {"F", "A"}), "1");
    EXPECT_TRUE(say("emc_ini_int", {"N", "A"}).starts_with("error: "));
    EXPECT_TRUE(say("emc_ini_real", {"X", "A"}).starts_with("error: "));
    EXPECT_EQ(say("emc_ini_variables", {"KINS"}), "{JOINTS {3}}");
    EXPECT_EQ(say("emc_ini_sections"), "{KINS} {A}");
    EXPECT_EQ(say("emc_ini_filename"), "/m/m.ini");
    EXPECT_EQ(say("int", {"2.7"}), "2");
    EXPECT_EQ(say("round", {"-2.7"}), "-3");
}

}  // namespace
}  // namespace mw::tcl
