// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated spindle by its torques: a frequency inverter that reads its command at intervals and ramps its
// frequency, an asynchronous motor with slip and limits of torque and power, inertia, friction and cutting
// load; an encoder with unevenly placed lines that is read at uneven times. It shares no code and no
// assumptions with the controller that follows it. Torques are expressed as the angular acceleration that
// they cause.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mw::plants {

struct DrivenSpindleTraits {
    double scan_s = 0.008;       ///< the inverter reads its command at this interval
    double ramp = 80;            ///< change of its frequency [rev/s^2]
    double rounding_s = 0.02;    ///< time constant with which the ramp begins and ends
    double slip_s = 0.01;        ///< slip over the acceleration that it causes
    double most_torque = 150;    ///< [rev/s^2]
    double full_power_rps = 25;  ///< the torque falls with 1/speed above
    double friction = 0.3;       ///< per speed [1/s]
    int counts = 4096;           ///< of the encoder per revolution
    double uneven = 0.1;         ///< error of the position of a line, as a fraction of their distance
    double eccentric = 2e-5;     ///< error over one revolution [rev]
    double jitter_s = 10e-6;     ///< error of the time of reading
};

class DrivenSpindle {
  public:
    explicit DrivenSpindle(const DrivenSpindleTraits &traits) noexcept : traits_(traits) {}

    /// Runs for `dt` with the command [rev/s]; `cut` is the torque of the cut [rev/s^2].
    void run(double command, double cut, double dt) noexcept {
        constexpr double STEP_S = 2e-5;
        const int steps = static_cast<int>(std::lround(dt / STEP_S));
        for (int n = 0; n < steps; ++n) {
            step(command, cut, dt / steps);
        }
        read();
    }
    /// The true angle [rev], its speed.
    double angle() const noexcept { return angle_; }
    double speed() const noexcept { return speed_; }
    /// The position that the encoder shows [rev].
    double shown() const noexcept { return static_cast<double>(count_) / traits_.counts; }

  private:
    void step(double command, double cut, double dt) noexcept {
        since_scan_s_ += dt;
        if (since_scan_s_ >= traits_.scan_s) {
            since_scan_s_ -= traits_.scan_s;
            heard_ = command;
        }
        // A ramp that is rounded at both ends; it slows down so as not to overshoot.
        const double left = heard_ - frequency_;
        const double wanted = std::clamp(left / traits_.rounding_s, -traits_.ramp, traits_.ramp);
        frequency_rate_ += (wanted - frequency_rate_) * dt / (0.25 * traits_.rounding_s);
        frequency_ += frequency_rate_ * dt;
        const double most =
            traits_.most_torque * std::min(1.0, traits_.full_power_rps / std::max(std::abs(speed_), 1e-9));
        const double motor = std::clamp((frequency_ - speed_) / traits_.slip_s, -most, most);
        const double against = cut * std::tanh(speed_ / 0.1) + traits_.friction * speed_;
        speed_ += (motor - against) * dt;
        angle_ += speed_ * dt;
    }
    /// A number from 0 to 1 for each line and reading.
    static double noise(std::uint64_t n) noexcept {
        n = (n ^ (n >> 30U)) * 0xbf58476d1ce4e5b9U;
        n = (n ^ (n >> 27U)) * 0x94d049bb133111ebU;
        return static_cast<double>((n ^ (n >> 31U)) >> 11U) * 0x1p-53;
    }
    double place_of(std::int64_t line) const noexcept {
        const std::int64_t on_disc = ((line % traits_.counts) + traits_.counts) % traits_.counts;
        const double turned = static_cast<double>(line) / traits_.counts;
        const double uneven = traits_.uneven * (noise(static_cast<std::uint64_t>(on_disc) + 1) - 0.5);
        return turned + uneven / traits_.counts + traits_.eccentric * std::sin(6.283185307179586 * turned);
    }
    void read() noexcept {
        const double late_s = traits_.jitter_s * (noise(++readings_ << 20U) - 0.5);
        const double seen = angle_ + late_s * speed_;
        while (place_of(count_ + 1) <= seen) {
            ++count_;
        }
        while (place_of(count_) > seen) {
            --count_;
        }
    }

    DrivenSpindleTraits traits_;
    double heard_ = 0, since_scan_s_ = 0, frequency_ = 0, frequency_rate_ = 0;
    double speed_ = 0, angle_ = 0.217;
    std::int64_t count_ = 0;
    std::uint64_t readings_ = 0;
};

}  // namespace mw::plants
