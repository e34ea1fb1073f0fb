// SPDX-License-Identifier: GPL-2.0-or-later
// The arc: its voltage, whether it burns, and for how long it may be missing.
#include <cmath>

#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

/// Mode 0 and 1 measure the arc; the sign of the input does not matter (either polarity of a divider).
void Arc::measure_voltage() noexcept {
    constexpr double TWO_PI = 6.283185307179586;
    last_voltage_ = out_.arc_voltage_out;
    const double share =
        in_.lowpass_frequency > 0.0 ? 1.0 - std::exp(-TWO_PI * in_.lowpass_frequency * period_s_) : 1.0;
    filtered_ += (in_.arc_voltage_in - filtered_) * share;
    if (in_.lowpass_frequency <= 0.0) {
        filtered_ = in_.arc_voltage_in;
    }
    double volts = (std::fabs(filtered_) - in_.arc_voltage_offset) * in_.arc_voltage_scale;
    if (in_.lowpass_frequency > 0.0) {
        volts = std::round(volts * 1000.0) / 1000.0;
    }
    out_.arc_voltage_out = std::fabs(volts) < in_.zero_window ? 0.0 : volts;
}

/// Mode 0: between the limits for as many readings as asked for, steps between two of them not too large.
/// Once good, one reading outside is bad, or as many as asked for while the height control works.
bool Arc::isVoltageGood() noexcept {
    const double volts = out_.arc_voltage_out;
    const bool isWithin = volts >= in_.arc_ok_low && volts <= in_.arc_ok_high;
    if (!out_.arc_ok_out) {
        const bool isSteady = std::fabs(volts - last_voltage_) <= in_.ok_sample_threshold;
        if (!isWithin) {
            ok_count_ = 0;
        } else if (ok_count_ < in_.ok_sample_counts) {
            ok_count_ = !wasWithin_ ? 1 : isSteady ? ok_count_ + 1 : 0;
        }
        wasWithin_ = isWithin;
        if (!isWithin || ok_count_ < in_.ok_sample_counts) {
            return false;
        }
        bad_count_ = 0;
        return true;
    }
    if (isWithin) {
        bad_count_ = 0;
        return true;
    }
    bad_count_ += 1;
    return hasTarget_ && bad_count_ < in_.ok_sample_counts;
}

/// Sets arc-ok-out; an arc that was good may be missing for arc-lost-delay.
void Arc::watch_arc() noexcept {
    if (!out_.torch_on) {
        out_.arc_ok_out = false;
        isArcBad_ = false;
        wasWithin_ = false;
        return;
    }
    const bool isGood = in_.mode == 0 ? isVoltageGood() : in_.arc_ok_in;
    if (isGood) {
        if (!out_.arc_ok_out) {
            out_.arc_ok_out = true;
            lost_.left_s = in_.arc_lost_delay;
        }
        if (in_.mode != 0) {
            lost_.left_s = in_.arc_lost_delay;
            isArcBad_ = false;
        }
        return;
    }
    if (!isManualCut() && (in_.mode != 0 || out_.arc_ok_out)) {
        isArcBad_ = true;
    }
    const bool isAllowed = isArcIgnored() || in_.mesh_enable || isManualCut();
    if (!out_.arc_ok_out || (isAllowed && state_ != State::PAUSE_AT_END)) {
        return;
    }
    if (lost_.runOut(period_s_)) {
        out_.arc_ok_out = false;
        const bool isCut = state_ >= State::PIERCE_DELAY && state_ <= State::CUT_BY_SWITCHES;
        if (isCut) {
            pending_ = Fault::ARC_LOST;
        }
    }
}

}  // namespace mw::plasma
