// SPDX-License-Identifier: GPL-2.0-or-later
// The power side of a drive: it takes a while to switch on, none to switch off, and a fault takes its power
// away and stays until it is reset while the drive is off. Realtime-safe.
#pragma once

namespace mw::plants {

class Amplifier {
  public:
    explicit Amplifier(double rise_s = 0) noexcept : rise_s_(rise_s) {}

    void set_rise(double rise_s) noexcept { rise_s_ = rise_s; }
    /// `dt` seconds with this enable; true when the motor has power.
    bool run(bool isEnabled, double dt) noexcept {
        on_s_ = isEnabled ? on_s_ + dt : 0.0;
        isEnabled_ = isEnabled;
        return isPowered();
    }
    bool isPowered() const noexcept { return isEnabled_ && !isFaulted_ && on_s_ > rise_s_; }

    void trip() noexcept { isFaulted_ = true; }
    bool isFaulted() const noexcept { return isFaulted_; }
    /// False, and nothing is reset, while it is enabled.
    bool reset() noexcept {
        isFaulted_ = isFaulted_ && isEnabled_;
        return !isFaulted_;
    }

  private:
    double rise_s_;
    double on_s_ = 0;
    bool isEnabled_ = false, isFaulted_ = false;
};

}  // namespace mw::plants
