// SPDX-License-Identifier: GPL-2.0-or-later
// An axis to be homed: a motor with a lag, a slide with play, a home switch on the slide that bounces or
// fails, and an encoder on the motor with an index pulse every revolution. Deterministic from its seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mw::plants {

class HomeAxis {
  public:
    /// Lengths in the units of the axis; the true position of the slide has its own zero.
    struct Build {
        double start = 0;  ///< start position of the slide
        double switch_at =
            -20;  ///< the switch is closed at and below this position (at and above it with closed_above)
        bool closed_above = false;
        double play = 0;         ///< play between motor and slide
        double lag_s = 0;        ///< lag of the motor behind its command
        double index_pitch = 0;  ///< 0: no index
        double index_phase = 0;  ///< the pulse comes when the motor is at this position
        bool is_reset_by_index = true;
        double bounce_s = 0;  ///< bounce time of a contact after each change
        std::uint32_t seed = 1;
    };
    /// Faults of the hardware.
    struct Faults {
        bool switch_open = false, isSwitchClosed = false, index_missing = false;
    };

    explicit HomeAxis(const Build &build)
        : build_(build), random_(build.seed | 1U), motor_(build.start), slide_(build.start),
          zero_(build.start), was_exceeded_(isBeyond()) {}

    Faults faults;

    /// One period of `dt` [s] with the command in encoder units; a command that is not a number is ignored
    /// and the motor does not move. `index_wanted`: the pin index-enable is TRUE.
    void step(double command, bool index_wanted, double dt) {
        time_ += dt;
        index_enabled_ = index_wanted && (index_enabled_ || !was_wanted_);
        was_wanted_ = index_wanted;
        const double before = motor_;
        const double gain = build_.lag_s > 0 ? 1.0 - std::exp(-dt / build_.lag_s) : 1.0;
        motor_ += std::isfinite(command) ? gain * (command + zero_ - motor_) : 0.0;
        slide_ = std::clamp(slide_, motor_ - 0.5 * build_.play, motor_ + 0.5 * build_.play);
        if (index_enabled_ && build_.index_pitch > 0 && !faults.index_missing) {
            pass_index(before);
        }
        if (isBeyond() != was_exceeded_) {
            was_exceeded_ = !was_exceeded_;
            changed_ = time_;
        }
    }
    double encoder() const { return motor_ - zero_; }
    bool isIndexEnabled() const { return index_enabled_; }
    bool isSwitchClosed() {
        if (faults.switch_open || faults.isSwitchClosed) {
            return faults.isSwitchClosed;
        }
        const bool chattering = time_ - changed_ < build_.bounce_s && changed_ > 0;
        return chattering && draw() % 2 == 0 ? !was_exceeded_ : was_exceeded_;
    }
    /// The true position of the slide, and of the motor.
    double slide() const { return slide_; }
    double motor() const { return motor_; }

  private:
    bool isBeyond() const {
        return build_.closed_above ? slide_ >= build_.switch_at : slide_ <= build_.switch_at;
    }
    void pass_index(double before) {
        const auto turn = [&](double x) { return std::floor((x - build_.index_phase) / build_.index_pitch); };
        if (turn(before) == turn(motor_)) {
            return;
        }
        index_enabled_ = false;
        if (build_.is_reset_by_index) {  // from here on, the position of the pulse is 0
            zero_ = build_.index_phase + build_.index_pitch * std::max(turn(before), turn(motor_));
        }
    }
    std::uint32_t draw() {
        random_ ^= random_ << 13;
        random_ ^= random_ >> 17;
        random_ ^= random_ << 5;
        return random_ >> 3;
    }

    Build build_;
    std::uint32_t random_;
    double motor_, slide_, zero_;
    double time_ = 0, changed_ = 0;
    bool was_exceeded_, was_wanted_ = false, index_enabled_ = false;
};

}  // namespace mw::plants
