// SPDX-License-Identifier: GPL-2.0-or-later
// The machine's settings for clients: the settings of motion, in the types of the vocabulary.
#pragma once

#include "messages/declarations/status.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"

namespace mw::task {

/// One thread.
class ShownSettings {
  public:
    /// `fixed`: values that are not settings of motion.
    explicit ShownSettings(const messages::SettingsStatus &fixed) : shown_(fixed) {
        shown_.max_velocity = shown_.max_acceleration = most_velocity_;
    }

    /// Notes a setting that is sent to motion.
    void note(const motion::SetParameter &parameter);
    /// The operator limits the path speed; never above the machine's limit.
    void limit_velocity(double velocity);
    /// Bits as in [EMC]DEBUG, for clients that use them.
    void set_debug(std::uint32_t mask) { shown_.debug = mask; }
    const messages::SettingsStatus &shown() const { return shown_; }
    /// All settings as in motion.
    const motion::Settings &settings() const { return settings_; }

  private:
    messages::SettingsStatus shown_;
    motion::Settings settings_;
    double most_velocity_ = 1e99;  ///< [TRAJ]MAX_LINEAR_VELOCITY
};

}  // namespace mw::task
