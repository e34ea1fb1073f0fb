// SPDX-License-Identifier: GPL-2.0-or-later
// The settings of motion. They are sent at the start, changed by clients and pins, and shown to clients.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "machine/task/control/machine_port.hh"
#include "machine/task/control/settings.hh"
#include "motion/interface/settings.hh"

namespace mw::task {

using ScrewTables = std::vector<std::vector<motion::LoadCompensation>>;

/// All calls come from one thread.
class MotionSettings {
  public:
    MotionSettings(MachinePort &port, const Settings &settings)
        : port_(port), num_joints_(settings.num_joints), watchdog_s_(settings.watchdog_s),
          shown_(settings.shown) {
        shown_.max_velocity = shown_.max_acceleration = most_velocity_;
    }

    /// Sends the settings of the machine and tables of screw errors.
    void configure(const std::vector<motion::SetParameter> &parameters, const ScrewTables &tables);
    /// Called when motion has rejected a command: stores the first rejected setting.
    void note_refusal(const MotionLink::Refusal &refusal);
    /// True when all settings have been answered; an error if a setting or table was rejected.
    Result<bool> isConfigured() const;

    /// Changes one setting; the caller has checked that it may change now.
    void change(const motion::SetParameter &parameter) {
        note(parameter);
        port_.send(parameter);
    }
    /// For a client's command: changes these settings of a joint together, or none of them.
    Result<Progress> change_joint(mailbox::Serial command, const std::vector<motion::SetParameter> &changes,
                                  bool homing);
    /// The operator's limit of the path speed; it never exceeds the machine's limit.
    void limit_velocity(double velocity) { shown_.max_velocity = std::min(velocity, most_velocity_); }
    /// Bits as in [EMC]DEBUG, for clients that use them.
    void set_debug(std::uint32_t mask) { shown_.debug = mask; }
    /// All settings that motion uses.
    const motion::Settings &current() const { return current_; }
    const messages::SettingsStatus &shown() const { return shown_; }

  private:
    void note(const motion::SetParameter &parameter);

    MachinePort &port_;
    int num_joints_;
    double watchdog_s_;
    motion::Settings current_;
    messages::SettingsStatus shown_;
    double most_velocity_ = 1e99;  ///< [TRAJ]MAX_LINEAR_VELOCITY
    motion::CommandId last_ = 0;   ///< last command of configure()
    std::string refused_;          ///< reason why the first setting was rejected
};

}  // namespace mw::task
