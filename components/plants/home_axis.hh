// SPDX-License-Identifier: GPL-2.0-or-later
// An axis to be homed: a motor that lags behind its command, a slide with play, a home switch on the slide
// that bounces or fails, an encoder on the motor with an index pulse every turn. Deterministic from its seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mw::plants {

class HomeAxis {
  public:
    /// Lengths in the axis's unit; the true place of the slide is counted from a zero of its own.
    struct Build {
        double start = 0;        ///< of the slide
        double switch_at = -20;  ///< the switch is closed at and below this place (above: isClosedAbove)
        bool isClosedAbove = false;
        double play = 0;         ///< between motor and slide
        double lag_s = 0;        ///< of the motor behind its command
        double index_pitch = 0;  ///< 0: no index
        double index_phase = 0;  ///< a pulse is where the motor stands at this place
        bool isResetByIndex = true;
        double bounce_s = 0;  ///< a contact chatters so long after each change
        std::uint32_t seed = 1;
    };
    /// What is broken.
    struct Faults {
        bool isSwitchOpen = false, isSwitchClosed = false, isIndexMissing = false;
    };

    explicit HomeAxis(const Build &build)
        : build_(build), random_(build.seed | 1U), motor_(build.start), slide_(build.start),
          zero_(build.start), wasBeyond_(isBeyond()) {}

    Faults faults;

    /// One period of `dt` [s] with the command in encoder units, where the motor stays if that is no number;
    /// `isIndexWanted`: the pin index-enable is TRUE.
    void step(double command, bool isIndexWanted, double dt) {
        time_ += dt;
        isIndexEnabled_ = isIndexWanted && (isIndexEnabled_ || !wasWanted_);
        wasWanted_ = isIndexWanted;
        const double before = motor_;
        const double gain = build_.lag_s > 0 ? 1.0 - std::exp(-dt / build_.lag_s) : 1.0;
        motor_ += std::isfinite(command) ? gain * (command + zero_ - motor_) : 0.0;
        slide_ = std::clamp(slide_, motor_ - 0.5 * build_.play, motor_ + 0.5 * build_.play);
        if (isIndexEnabled_ && build_.index_pitch > 0 && !faults.isIndexMissing) {
            pass_index(before);
        }
        if (isBeyond() != wasBeyond_) {
            wasBeyond_ = !wasBeyond_;
            changed_ = time_;
        }
    }
    double encoder() const { return motor_ - zero_; }
    bool isIndexEnabled() const { return isIndexEnabled_; }
    bool isSwitchClosed() {
        if (faults.isSwitchOpen || faults.isSwitchClosed) {
            return faults.isSwitchClosed;
        }
        const bool isChattering = time_ - changed_ < build_.bounce_s && changed_ > 0;
        return isChattering && draw() % 2 == 0 ? !wasBeyond_ : wasBeyond_;
    }
    /// Where the slide truly is, and the motor.
    double slide() const { return slide_; }
    double motor() const { return motor_; }

  private:
    bool isBeyond() const {
        return build_.isClosedAbove ? slide_ >= build_.switch_at : slide_ <= build_.switch_at;
    }
    void pass_index(double before) {
        const auto turn = [&](double x) { return std::floor((x - build_.index_phase) / build_.index_pitch); };
        if (turn(before) == turn(motor_)) {
            return;
        }
        isIndexEnabled_ = false;
        if (build_.isResetByIndex) {  // the place of the pulse itself is 0 from here
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
    bool wasBeyond_, wasWanted_ = false, isIndexEnabled_ = false;
};

}  // namespace mw::plants
