// SPDX-License-Identifier: GPL-2.0-or-later
// The machine's settings as clients are shown them: what motion is told, in the words of the vocabulary.
#pragma once

#include "messages/declarations/status.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"

namespace mw::task {

/// One thread.
class ShownSettings {
  public:
    /// `fixed`: what does not come as a setting of motion.
    explicit ShownSettings(const messages::SettingsStatus &fixed) : shown_(fixed) {
        shown_.max_velocity = shown_.max_acceleration = most_velocity_;
    }

    /// A setting that motion is told.
    void note(const motion::SetParameter &parameter);
    /// The operator limits the speed of the path; never above the machine's own.
    void limit_velocity(double velocity);
    /// Bits as of [EMC]DEBUG, for clients that go by them.
    void set_debug(std::uint32_t mask) { shown_.debug = mask; }
    const messages::SettingsStatus &shown() const { return shown_; }
    /// All settings as motion has them.
    const motion::Settings &settings() const { return settings_; }

  private:
    messages::SettingsStatus shown_;
    motion::Settings settings_;
    double most_velocity_ = 1e99;  ///< [TRAJ]MAX_LINEAR_VELOCITY
};

}  // namespace mw::task
