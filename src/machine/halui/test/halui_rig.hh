// SPDX-License-Identifier: GPL-2.0-or-later
// halui with HAL and a task that receives its commands.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "machine/halui/halui.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/command_server.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::halui {

inline constexpr int JOINTS = 2;
inline constexpr unsigned AXES = 0b101;  // X and Z

class HaluiRig : public ::testing::Test {
  protected:
    HaluiRig() {
        hal::InstanceOptions options;
        options.scheduler = &clock;
        auto made = hal::LocalHost::create(options);
        EXPECT_TRUE(made.has_value());
        host = std::move(*made);
        HaluiSettings settings;
        settings.num_joints = JOINTS;
        settings.axis_mask = AXES;
        settings.max_feed_override = 1.5;
        settings.spindle_override = {0.5, 1.2};
        settings.max_velocity = 100;
        settings.mdi_commands = {"G0 X1", "M5"};
        EXPECT_TRUE(halui.create(hal(), settings).has_value());
        EXPECT_TRUE(halui.join(memory.segment()).has_value());
    }
    ~HaluiRig() override { halui.destroy(); }
    hal::Instance &hal() { return host->hal(); }
    void set(const std::string &name, bool on) {
        EXPECT_TRUE(hal().values().set("halui." + name, on ? "1" : "0").has_value()) << name;
    }
    void set_value(const std::string &name, const std::string &value) {
        EXPECT_TRUE(hal().values().set("halui." + name, value).has_value()) << name;
    }
    bool lamp(const std::string &name) { return hal().values().get("halui." + name)->as_bit(); }
    double value(const std::string &name) { return hal().values().get("halui." + name)->as_number(); }
    /// Presses and releases a button; returns its command.
    std::string press(const std::string &name) {
        set(name, true);
        const std::string all = cycle();
        set(name, false);
        EXPECT_EQ(cycle(), "") << name << " is released";
        return all;
    }
    /// Runs a cycle of task; returns the commands as text.
    std::string cycle() {
        std::string all;
        halui.step();
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            all += (all.empty() ? "" : ", ") + messages::to_text(delivery.command);
            EXPECT_TRUE(delivery.isPanel) << "it is wired to the machine";
            desk.tell(delivery.serial, progress, "");
            last_serial = delivery.serial;
        }
        status->time_ns = now_ns;
        ++status->cycle;
        desk.publish(*status);
        return all;
    }
    std::string asked(const messages::Command &command) { return messages::to_text(command); }

    runtime::VirtualScheduler clock;
    std::unique_ptr<hal::LocalHost> host;
    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 0;
    messages::Progress progress = messages::Progress::DONE;
    mailbox::Serial last_serial = 0;
    Halui halui;
};

}  // namespace mw::halui
