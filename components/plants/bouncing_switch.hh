// SPDX-License-Identifier: GPL-2.0-or-later
// A mechanical switch on an axis: it closes on one side of a position, opens when the axis has moved back by
// the hysteresis, and its contact bounces for a time after each change. Realtime-safe.
#pragma once

#include <algorithm>

#include "components/plants/random.hh"

namespace mw::plants {

struct SwitchSettings {
    double at = 0;          ///< closed at this position and past it
    bool above = true;      ///< past means above; otherwise below
    double width = 0;       ///< it opens again at this distance; 0: it remains closed
    double hysteresis = 0;  ///< it opens at this distance before its closing position
    double bounce_s = 0;    ///< time after a change during which the contact is uncertain
};

class BouncingSwitch {
  public:
    explicit BouncingSwitch(const SwitchSettings &settings = {}, std::uint64_t seed = 1) noexcept
        : settings_(settings), random_(seed) {}

    void set(const SwitchSettings &settings) noexcept { settings_ = settings; }
    /// The contact after `dt` seconds at `position`.
    bool run(double position, double dt) noexcept {
        const double beyond = (settings_.above ? 1.0 : -1.0) * (position - settings_.at);
        const double slack = pressed_ ? settings_.hysteresis : 0.0;
        const bool within = settings_.width <= 0.0 || beyond <= settings_.width + slack;
        const bool pressed = beyond >= -slack && within;
        unsettled_s_ = pressed != pressed_ ? settings_.bounce_s : std::max(0.0, unsettled_s_ - dt);
        pressed_ = pressed;
        return unsettled_s_ > 0.0 ? random_.chance(0.5) : pressed_;
    }
    /// The state of the lever, independent of the contact.
    bool isPressed() const noexcept { return pressed_; }

  private:
    SwitchSettings settings_;
    Random random_;
    bool pressed_ = false;
    double unsettled_s_ = 0;
};

}  // namespace mw::plants
