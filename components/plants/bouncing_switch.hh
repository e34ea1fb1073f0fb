// SPDX-License-Identifier: GPL-2.0-or-later
// A mechanical switch on an axis: it closes on one side of a place, opens a hysteresis back, and its contact
// bounces for a while after each. Realtime-safe.
#pragma once

#include <algorithm>

#include "components/plants/random.hh"

namespace mw::plants {

struct SwitchSettings {
    double at = 0;          ///< closed at and beyond this position
    bool isAbove = true;    ///< beyond: above; else below
    double width = 0;       ///< it opens again so far beyond; 0: it stays closed
    double hysteresis = 0;  ///< it opens so far before the place at which it closes
    double bounce_s = 0;    ///< contact is uncertain so long after a change
};

class BouncingSwitch {
  public:
    explicit BouncingSwitch(const SwitchSettings &settings = {}, std::uint64_t seed = 1) noexcept
        : settings_(settings), random_(seed) {}

    void set(const SwitchSettings &settings) noexcept { settings_ = settings; }
    /// The contact after `dt` seconds at `position`.
    bool run(double position, double dt) noexcept {
        const double beyond = (settings_.isAbove ? 1.0 : -1.0) * (position - settings_.at);
        const double slack = isPressed_ ? settings_.hysteresis : 0.0;
        const bool isWithin = settings_.width <= 0.0 || beyond <= settings_.width + slack;
        const bool isPressed = beyond >= -slack && isWithin;
        unsettled_s_ = isPressed != isPressed_ ? settings_.bounce_s : std::max(0.0, unsettled_s_ - dt);
        isPressed_ = isPressed;
        return unsettled_s_ > 0.0 ? random_.chance(0.5) : isPressed_;
    }
    /// The lever, whatever the contact says.
    bool isPressed() const noexcept { return isPressed_; }

  private:
    SwitchSettings settings_;
    Random random_;
    bool isPressed_ = false;
    double unsettled_s_ = 0;
};

}  // namespace mw::plants
