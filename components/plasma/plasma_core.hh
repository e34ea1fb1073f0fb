// SPDX-License-Identifier: GPL-2.0-or-later
// The plasma controller without HAL: one call of step() a servo period. It finds the material, starts the
// arc, pierces, cuts while it holds the height by the arc voltage, retracts, and goes back when something is
// wrong. Z (and X, Y for consumables and recovery) moves by offset counts that motion adds to its own position.
//
// The states and their numbers are those of plasmac (state-out). Files: arc.cc (voltage, arc ok),
// height_control.cc (the cut and its height), probing.cc, cutting.cc (from the zero height to the end),
// idle.cc (what starts what), stops.cc (what ends a cut early), side_actions.cc (pulse, tests, scribe),
// sideways.cc (X and Y).
#pragma once

#include <algorithm>
#include <array>

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
    CUT_BY_VOLTAGE = 11,  // modes 0 and 1
    CUT_BY_SWITCHES = 12,  // mode 2
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

/// Why the way back to the safe place was taken (stop-type-out).
enum class Stop : std::int32_t { NONE = 0, WAIT = 1, CUT_ENDED = 2, PAUSED = 3 };

/// What to tell the operator.
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

/// Counts down; the residue of the last period counts, as in the time of the parts it waits for.
struct Countdown {
    double left_s = 0.0;
    /// True when the time is over; else one period of it goes by.
    bool runOut(double period_s) noexcept {
        if (left_s <= 0.0) {
            return true;
        }
        left_s -= period_s;
        return false;
    }
};

/// Within the 32 bits of the pins of counts.
inline std::int32_t to_counts(double counts) noexcept {
    constexpr double MOST_COUNTS = 2.0e9;
    return static_cast<std::int32_t>(std::clamp(counts, -MOST_COUNTS, MOST_COUNTS));
}

class Core {
  public:
    /// One servo period of `period_s` [s]. [servo]
    void step(const Inputs &in, double period_s) noexcept;
    const Outputs &out() const noexcept { return out_; }
    State state() const noexcept { return state_; }
    /// What went wrong since the last call. [servo]
    Fault take_fault() noexcept {
        const Fault fault = fault_;
        fault_ = Fault::NONE;
        return fault;
    }

  private:
    // arc.cc
    void measure_voltage() noexcept;
    void watch_arc() noexcept;
    bool isVoltageGood() noexcept;
    bool isArcIgnored() const noexcept;
    // height_control.cc
    void set_thc_pins() noexcept;
    void cut_by_voltage() noexcept;
    void cut_by_switches() noexcept;
    void wait_for_target() noexcept;
    bool isOverridden() noexcept;
    void watch_locks() noexcept;
    void watch_void() noexcept;
    void hold_voltage() noexcept;
    void move_height(std::int32_t counts, double direction) noexcept;
    bool isThcWanted() const noexcept;
    bool isAtSpeed(double share) const noexcept;
    void show_feed_rates() noexcept;
    // probing.cc
    void watch_sensors() noexcept;
    void inhibit_jog(State state) noexcept;
    void probe_height() noexcept;
    void probe_down() noexcept;
    void probe_up() noexcept;
    void start_probing() noexcept;
    // cutting.cc
    void zero_height() noexcept;
    void pierce_height() noexcept;
    void start_torch() noexcept;
    void wait_for_arc() noexcept;
    void spot() noexcept;
    void start_cut() noexcept;
    void pierce() noexcept;
    void puddle_jump() noexcept;
    void cut_height() noexcept;
    void pause_at_end() noexcept;
    void safe_height() noexcept;
    void max_height() noexcept;
    void end_cut() noexcept;
    void end_job() noexcept;
    // idle.cc
    void idle() noexcept;
    bool startOfCut() noexcept;
    bool startWhilePaused() noexcept;
    bool startOfSideAction() noexcept;
    bool isNearLastCut() const noexcept;
    // stops.cc
    void watch_stops() noexcept;
    bool isStopped() noexcept;
    bool isTorchAllowed() noexcept;
    Fault sensor_fault() const noexcept;
    void stop(Stop type) noexcept;
    void end_by_operator() noexcept;
    void fail(Fault fault) noexcept;
    void halt(Fault fault) noexcept;
    void machine_off() noexcept;
    void run_requests() noexcept;
    // side_actions.cc
    void torch_pulse() noexcept;
    void ohmic_test() noexcept;
    void probe_test() noexcept;
    void scribe() noexcept;
    void paused_motion() noexcept;
    // sideways.cc
    void consumables_out() noexcept;
    void consumables_back() noexcept;
    void recovery_out() noexcept;
    void recovery_back() noexcept;
    void follow_laser() noexcept;
    void leave_laser() noexcept;
    bool moveStraight(std::int32_t x, std::int32_t y) noexcept;
    bool moveSideways(double x, double y, double step) noexcept;
    // plasma_core.cc
    void run_state() noexcept;
    void count_times() noexcept;
    void finish() noexcept;
    bool areUsable() const noexcept;
    double steps_exactly(double rate_mu_min) const noexcept {
        return std::max(0.0, rate_mu_min) * period_s_ / (60.0 * out_.offset_scale);
    }
    std::int32_t steps_of(double rate_mu_min) const noexcept;
    std::int32_t counts_of(double mu) const noexcept;
    std::int32_t height_counts(double height_mu) const noexcept;
    void add_z(double counts) noexcept;
    bool moveZ(std::int32_t target, std::int32_t step) noexcept;
    void torch_off() noexcept { out_.torch_on = false; }
    void arc_off() noexcept {
        torch_off();
        out_.arc_ok_out = false;
    }
    bool isManualCut() const noexcept { return in_.program_is_idle; }
    bool isCutWanted() const noexcept { return isSpotting_ ? in_.spotting_start : in_.cutting_start; }

    Inputs in_;
    Outputs out_;
    double period_s_ = 0.0;
    State state_ = State::IDLE;
    State before_ = State::IDLE;   // when this cycle began
    State started_ = State::IDLE;  // after what stops a cut
    Stop stop_ = Stop::NONE;
    Fault fault_ = Fault::NONE;
    Fault pending_ = Fault::NONE;  // takes effect with the next cycle
    bool isAlarmed_ = false;       // a sensor ended the cut
    bool wasIdle_ = true, wasRunning_ = false;
    // arc
    double filtered_ = 0.0, last_voltage_ = 0.0;
    std::int32_t ok_count_ = 0, bad_count_ = 0;
    bool isArcBad_ = false;  // the voltage was lost in this cut
    Countdown lost_;
    // the voltage to hold
    static constexpr int MOST_SAMPLES = 1000;
    std::array<double, MOST_SAMPLES> samples_{};
    int next_sample_ = 0, sample_count_ = 0;
    double sum_ = 0.0;
    std::int32_t target_count_ = 0;
    bool hasTarget_ = false;
    double last_error_ = 0.0, override_ = 0.0;
    double void_voltage_ = 0.0, target_sum_ = 0.0;
    std::int32_t steep_count_ = 0, flat_count_ = 0;
    bool isVoidWatched_ = false;
    // heights
    double zero_mu_ = 0.0;          // Z at the material
    std::int32_t zero_counts_ = 0;  // offset counts there
    std::int32_t thc_shift_ = 0;    // how far the height control moved the torch from the cut height
    std::int32_t probe_target_ = 0;
    bool isZeroed_ = false, hasProbed_ = false, isTorchWait_ = false;
    bool isProbeTest_ = false, isSpotting_ = false, isConsumableWait_ = false, isAtTarget_ = false;
    bool isOhmic_ = false, wasOhmic_ = false;
    std::int32_t ohmic_attempts_ = 0, sense_count_ = 0;
    double last_cut_x_ = 0.0, last_cut_y_ = 0.0;
    Countdown timer_, spot_;
    std::int32_t starts_ = 0;
    int scribe_phase_ = 0;
    bool wasTorchOn_ = false, isFoundByContact_ = false, isEarly_ = false, isStopAfterReturn_ = false, isEndedNow_ = false, isOverrideNew_ = false, isRetry_ = false, isTorchTaken_ = false, isBeside_ = false, isProbeWaiting_ = false, isUnderWay_ = false, isPulseNew_ = false, wasWithin_ = false, hasZero_ = false;
    double step_x_ = 0.0, step_y_ = 0.0;
};

}  // namespace mw::plasma
