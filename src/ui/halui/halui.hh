// SPDX-License-Identifier: GPL-2.0-or-later
// Operator's commands as HAL pins: machine, e-stop, mode, home and program pins of `halui` (man page halui),
// as ui/halui/pin_tables.hh has them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/limits.hh"
#include "base/result.hh"
#include "client/client.hh"
#include "hal/core/user_pin_set.hh"
#include "ui/halui/pin_tables.hh"

namespace mw::ui {

/// A client of the machine. Input pins act on their rising edge. Not realtime; one thread.
class Halui {
  public:
    /// Makes the component "halui" with pins for `num_joints` joints.
    Result<> create(hal::Hal &hal, int num_joints);
    void destroy();

    /// Becomes a client of the machine: a panel, which another's right to operate does not lock out.
    Result<> join(mailbox::Segment &mailbox);
    /// Turns edges into commands, and states into pins. Once a task cycle, after task's own step.
    void step();

  private:
    /// An input pin that means one command.
    struct Button {
        hal::UserPin<bool> pin;
        msgs::Command command;
        bool wasOn = false;
    };

    /// Those of a table for an instance.
    template <class Table>
    void make_buttons(const Table &table, int number, Result<> &status);

    hal::Hal *hal_ = nullptr;
    std::optional<client::Client> client_;
    int comp_id_ = 0;
    int num_joints_ = 0;
    std::vector<Button> buttons_;
    hal::UserPinSet<pins::LAMPS> lamps_;
    std::array<hal::UserPinSet<pins::JOINT_LAMPS>, MAX_JOINTS> joint_lamps_;
};

}  // namespace mw::ui
