// SPDX-License-Identifier: GPL-2.0-or-later
// Common functions of all parts of the plasma controller: moves by counts, and the ends of a cut.
#include "components/plasma/plasma_shared.hh"

#include <cmath>

namespace mw::plasma {

/// Counts per cycle at this rate; 0 for a negative rate.
std::int32_t Shared::steps_of(double rate_mu_min) const noexcept {
    return to_counts(steps_exactly(rate_mu_min));
}

void Shared::add_z(double counts) noexcept {
    out_.z_offset_counts = to_counts(out_.z_offset_counts + counts);
}

std::int32_t Shared::counts_of(double mu) const noexcept {
    return to_counts(mu / out_.offset_scale);
}

/// Offset counts for this height above the material.
std::int32_t Shared::height_counts(double height_mu) const noexcept {
    return to_counts(zero_counts_ + thc_shift_ + height_mu / out_.offset_scale);
}

/// Moves Z one step towards `target`. True when it was already there.
bool Shared::moveZ(std::int32_t target, std::int32_t step) noexcept {
    const std::int64_t left = std::int64_t{target} - out_.z_offset_counts;
    if (left == 0) {
        return true;
    }
    if (left > step) {
        out_.z_offset_counts += step;
    } else if (left < -std::int64_t{step}) {
        out_.z_offset_counts -= step;
    } else {
        out_.z_offset_counts = target;
    }
    return false;
}

/// Moves the offsets one step towards (x, y), along a line. True when they were already there.
bool Shared::moveSideways(double x, double y, double step) noexcept {
    const double dx = x - out_.x_offset_counts;
    const double dy = y - out_.y_offset_counts;
    const double way = std::hypot(dx, dy);
    if (way == 0.0) {
        return true;
    }
    if (way <= step) {
        out_.x_offset_counts = to_counts(x);
        out_.y_offset_counts = to_counts(y);
    } else {
        out_.x_offset_counts += static_cast<std::int32_t>(dx * step / way);
        out_.y_offset_counts += static_cast<std::int32_t>(dy * step / way);
    }
    return false;
}

Fault Shared::sensor_fault() const noexcept {
    return in_.breakaway      ? Fault::BREAKAWAY
           : in_.float_switch ? Fault::FLOAT_SWITCH
           : in_.ohmic_probe_enable && (state_ == State::IDLE ? was_ohmic_ : in_.ohmic_probe)
               ? Fault::OHMIC_PROBE
               : Fault::NONE;
}

/// Switches the torch off and moves up. Pauses the program, or stops the manual cut, if that has not happened
/// yet.
void Shared::fail(Fault fault) noexcept {
    fault_ = fault;
    pending_ = Fault::NONE;
    if (isManualCut()) {
        out_.cutting_stop = true;
        stop(Stop::NONE);
        return;
    }
    out_.program_pause = !in_.program_is_paused;
    if (fault != Fault::NO_ARC) {
        stop(Stop::PAUSED);
    }
}

void Shared::stop(Stop type) noexcept {
    arc_off();
    out_.z_offset_enable = true;
    out_.program_resume = false;
    arc_bad_ = false;
    out_.cornerlock_is_locked = false;
    out_.voidlock_is_locked = false;
    out_.ohmic_enable = false;
    out_.feed_hold = true;
    probed_ = false;
    stop_ = type;
    state_ = State::MAX_HEIGHT;
}

}  // namespace mw::plasma
