// SPDX-License-Identifier: GPL-2.0-or-later
// The power stage of a drive: it switches on after a delay and off at once. A fault removes the power and
// remains until it is reset while the drive is off. Realtime-safe.
#pragma once

namespace mw::plants {

class Amplifier {
  public:
    explicit Amplifier(double rise_s = 0) noexcept : rise_s_(rise_s) {}

    void set_rise(double rise_s) noexcept { rise_s_ = rise_s; }
    /// Runs for `dt` seconds with this enable input. True when the motor has power.
    bool run(bool enabled, double dt) noexcept {
        on_s_ = enabled ? on_s_ + dt : 0.0;
        enabled_ = enabled;
        return isPowered();
    }
    bool isPowered() const noexcept { return enabled_ && !faulted_ && on_s_ > rise_s_; }

    void trip() noexcept { faulted_ = true; }
    bool isFaulted() const noexcept { return faulted_; }
    /// False, without a reset, while it is enabled.
    bool reset() noexcept {
        faulted_ = faulted_ && enabled_;
        return !faulted_;
    }

  private:
    double rise_s_;
    double on_s_ = 0;
    bool enabled_ = false, faulted_ = false;
};

}  // namespace mw::plants
