// SPDX-License-Identifier: GPL-2.0-or-later
// States, stops and faults of the plasma controller, and what all its parts share: inputs and outputs, moves
// by counts, the ends of a cut.
#pragma once

#include <algorithm>
#include <cstdint>

#include "components/plasma/plasma_io.hh"

namespace mw::plasma {

enum class State : std::int32_t {
    IDLE = 0,
    PROBE_HEIGHT = 1,
    PROBE_DOWN = 2,
    PROBE_UP = 3,
    ZERO_HEIGHT = 4,
    PIERCE_HEIGHT = 5,
    TORCH_ON = 6,
    ARC_OK = 7,
    PIERCE_DELAY = 8,
    PUDDLE_JUMP = 9,
    CUT_HEIGHT = 10,
    CUT_BY_VOLTAGE = 11,   // in modes 0 and 1
    CUT_BY_SWITCHES = 12,  // in mode 2
    PAUSE_AT_END = 13,
    SAFE_HEIGHT = 14,
    MAX_HEIGHT = 15,
    END_CUT = 16,
    END_JOB = 17,
    TORCH_PULSE = 18,
    PAUSED_MOTION = 19,
    OHMIC_TEST = 20,
    PROBE_TEST = 21,
    SCRIBING = 22,
    CONSUMABLES_OUT = 23,
    CONSUMABLES_BACK = 24,
    RECOVERY_OUT = 25,
    RECOVERY_BACK = 26,
};

/// The reason for the return to the safe position (stop-type-out).
enum class Stop : std::int32_t { NONE = 0, WAIT = 1, CUT_ENDED = 2, PAUSED = 3 };

/// Faults that are reported to the operator.
enum class Fault {
    NONE,
    NO_ARC,
    ARC_LOST,
    BREAKAWAY,
    FLOAT_SWITCH,
    OHMIC_PROBE,
    NO_MATERIAL,
    HEIGHTS_MISSING,
    TOO_HIGH,
    THC_AT_BOTTOM,
    THC_AT_TOP,
    VOLTAGE_LOW,
    NOT_A_NUMBER,
    SENSOR_BEFORE_TEST,
};

/// Counts down. The remainder of the last period counts too, as in the counters of LinuxCNC that this
/// replaces.
struct Countdown {
    double left_s = 0.0;
    /// True when the time is over; otherwise one period passes.
    bool runOut(double period_s) noexcept {
        if (left_s <= 0.0) {
            return true;
        }
        left_s -= period_s;
        return false;
    }
};

/// Clamped to the 32 bits of the count pins.
inline std::int32_t to_counts(double counts) noexcept {
    constexpr double MOST_COUNTS = 2.0e9;
    return static_cast<std::int32_t>(std::clamp(counts, -MOST_COUNTS, MOST_COUNTS));
}

class Shared {
  protected:
    double steps_exactly(double rate_mu_min) const noexcept {
        return std::max(0.0, rate_mu_min) * period_s_ / (60.0 * out_.offset_scale);
    }
    std::int32_t steps_of(double rate_mu_min) const noexcept;
    std::int32_t counts_of(double mu) const noexcept;
    std::int32_t height_counts(double height_mu) const noexcept;
    void add_z(double counts) noexcept;
    bool moveZ(std::int32_t target, std::int32_t step) noexcept;
    bool moveSideways(double x, double y, double step) noexcept;
    bool isArcIgnored() const noexcept { return in_.ignore_arc_ok_0 || in_.ignore_arc_ok_1; }
    bool isManualCut() const noexcept { return in_.program_is_idle; }
    bool isCutWanted() const noexcept { return spotting_ ? in_.spotting_start : in_.cutting_start; }
    Fault sensor_fault() const noexcept;
    void torch_off() noexcept { out_.torch_on = false; }
    void arc_off() noexcept {
        torch_off();
        out_.arc_ok_out = false;
    }
    void stop(Stop type) noexcept;
    void fail(Fault fault) noexcept;

    Inputs in_;
    Outputs out_;
    double period_s_ = 0.0;
    State state_ = State::IDLE;
    Stop stop_ = Stop::NONE;
    Fault fault_ = Fault::NONE;
    Fault pending_ = Fault::NONE;  // takes effect in the next cycle
    Countdown timer_;
    bool was_idle_ = true;
    bool arc_bad_ = false;  // the voltage was lost during this cut
    bool is_probe_test_ = false, spotting_ = false;
    bool was_ohmic_ = false;
    bool probed_ = false, has_zero_ = false;
    double zero_mu_ = 0.0;          // Z position of the surface of the material
    std::int32_t zero_counts_ = 0;  // offset counts at that height
    std::int32_t thc_shift_ = 0;    // distance that the height control moved the torch from the cut height
};

}  // namespace mw::plasma
