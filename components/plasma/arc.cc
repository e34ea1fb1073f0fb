// SPDX-License-Identifier: GPL-2.0-or-later
// The arc: its voltage, whether it burns, and for how long it may be missing.
#include <cmath>

#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

/// Modes 0 and 1 measure the arc. The sign of the input does not matter, so a divider may have either
/// polarity.
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

/// Mode 0: the voltage must be within the limits for the requested number of readings, without large steps
/// between them. Once it is good, one reading outside makes it bad; while the height control works, the
/// requested number of readings does.
bool Arc::isVoltageGood() noexcept {
    const double volts = out_.arc_voltage_out;
    const bool within = volts >= in_.arc_ok_low && volts <= in_.arc_ok_high;
    if (!out_.arc_ok_out) {
        const bool steady = std::fabs(volts - last_voltage_) <= in_.ok_sample_threshold;
        if (!within) {
            ok_count_ = 0;
        } else if (ok_count_ < in_.ok_sample_counts) {
            ok_count_ = !was_within_ ? 1 : steady ? ok_count_ + 1 : 0;
        }
        was_within_ = within;
        if (!within || ok_count_ < in_.ok_sample_counts) {
            return false;
        }
        bad_count_ = 0;
        return true;
    }
    if (within) {
        bad_count_ = 0;
        return true;
    }
    bad_count_ += 1;
    return has_target_ && bad_count_ < in_.ok_sample_counts;
}

/// Sets arc-ok-out. An arc that was good may be missing for arc-lost-delay.
void Arc::watch_arc() noexcept {
    if (!out_.torch_on) {
        out_.arc_ok_out = false;
        arc_bad_ = false;
        was_within_ = false;
        return;
    }
    const bool good = in_.mode == 0 ? isVoltageGood() : in_.arc_ok_in;
    if (good) {
        if (!out_.arc_ok_out) {
            out_.arc_ok_out = true;
            lost_.left_s = in_.arc_lost_delay;
        }
        if (in_.mode != 0) {
            lost_.left_s = in_.arc_lost_delay;
            arc_bad_ = false;
        }
        return;
    }
    if (!isManualCut() && (in_.mode != 0 || out_.arc_ok_out)) {
        arc_bad_ = true;
    }
    const bool allowed = isArcIgnored() || in_.mesh_enable || isManualCut();
    if (!out_.arc_ok_out || (allowed && state_ != State::PAUSE_AT_END)) {
        return;
    }
    if (lost_.runOut(period_s_)) {
        out_.arc_ok_out = false;
        const bool is_cut = state_ >= State::PIERCE_DELAY && state_ <= State::CUT_BY_SWITCHES;
        if (is_cut) {
            pending_ = Fault::ARC_LOST;
        }
    }
}

}  // namespace mw::plasma
