// SPDX-License-Identifier: GPL-2.0-or-later
// The plasma controller without HAL: one call of step() per servo period. It finds the material, starts the
// arc, pierces, cuts while it controls the height by the arc voltage, retracts, and moves back to a safe
// position after a fault. Z (and X, Y for consumables and recovery) moves by offset counts that motion adds
// to its own position.
// The states and their numbers are those of plasmac (state-out). Each part uses only parts above it.
#pragma once

#include <array>

#include "components/plasma/plasma_shared.hh"

namespace mw::plasma {

/// The arc; see arc.cc.
class Arc : protected Shared {
  protected:
    void measure_voltage() noexcept;
    void watch_arc() noexcept;

    double last_voltage_ = 0.0;
    bool has_target_ = false;  // the height control has a target voltage
    std::int32_t ok_count_ = 0;

  private:
    bool isVoltageGood() noexcept;

    double filtered_ = 0.0;
    std::int32_t bad_count_ = 0;
    bool was_within_ = false;
    Countdown lost_;
};

/// The cut and its height; see height_control.cc.
class HeightControl : protected Arc {
  protected:
    void set_thc_pins() noexcept;
    void start_cut() noexcept;
    void cut_by_voltage() noexcept;
    void cut_by_switches() noexcept;

  private:
    void wait_for_target() noexcept;
    bool isOverridden() noexcept;
    void watch_locks() noexcept;
    void watch_void() noexcept;
    void hold_voltage() noexcept;
    void move_height(std::int32_t counts, double direction) noexcept;
    bool isThcWanted() const noexcept;
    bool isAtSpeed(double share) const noexcept;
    void show_feed_rates() noexcept;

    static constexpr int MOST_SAMPLES = 1000;
    std::array<double, MOST_SAMPLES> samples_{};  // steady voltages; the newest is before next_sample_
    int next_sample_ = 0, sample_count_ = 0;
    double sum_ = 0.0;
    std::int32_t target_count_ = 0;
    double target_sum_ = 0.0;
    double last_error_ = 0.0, override_ = 0.0;
    bool override_new_ = false;
    double void_voltage_ = 0.0;
    std::int32_t steep_count_ = 0, flat_count_ = 0;
    bool void_watched_ = false;
};

/// X and Y offsets from the path; see sideways.cc.
class Sideways : protected HeightControl {
  protected:
    void consumables_out() noexcept;
    void consumables_back() noexcept;
    void recovery_out() noexcept;
    void recovery_back() noexcept;
    void leave_laser() noexcept;

  private:
    void follow_laser() noexcept;
    bool moveStraight(std::int32_t x, std::int32_t y) noexcept;

    bool active_ = false, is_at_target_ = false;
    double step_x_ = 0.0, step_y_ = 0.0;
};

/// Finding the material; see probing.cc.
class Probing : protected Sideways {
  protected:
    void watch_sensors() noexcept;
    void inhibit_jog(State state) noexcept;
    void start_probing() noexcept;
    void probe_height() noexcept;
    void probe_down() noexcept;
    void probe_up() noexcept;
    void zero_height() noexcept;

    bool probe_waiting_ = false;
    double last_cut_x_ = 0.0, last_cut_y_ = 0.0;

  private:
    bool zeroed_ = false, ohmic_ = false;
    bool found_by_contact_ = false, early_ = false, is_retry_ = false, is_beside_ = false;
    std::int32_t ohmic_attempts_ = 0, sense_count_ = 0;
    std::int32_t probe_target_ = 0;
};

/// From the zero height to the end of a cut; see cutting.cc.
class Cutting : protected Probing {
  protected:
    void pierce_height() noexcept;
    void start_torch() noexcept;
    void wait_for_arc() noexcept;
    void pierce() noexcept;
    void puddle_jump() noexcept;
    void cut_height() noexcept;
    void pause_at_end() noexcept;
    void safe_height() noexcept;
    void max_height() noexcept;
    void end_cut() noexcept;
    void end_job() noexcept;

    bool is_consumable_wait_ = false;

  private:
    void spot() noexcept;

    Countdown spot_;
    std::int32_t starts_ = 0;
};

/// Actions other than a cut; see side_actions.cc.
class SideActions : protected Cutting {
  protected:
    void torch_pulse() noexcept;
    void ohmic_test() noexcept;
    void probe_test() noexcept;
    void scribe() noexcept;
    void paused_motion() noexcept;

    int scribe_phase_ = 0;

  private:
    bool pulse_new_ = false;
};

/// Conditions that stop a cut early; see stops.cc.
class Stops : protected SideActions {
  protected:
    void watch_stops() noexcept;
    void halt(Fault fault) noexcept;
    void machine_off() noexcept;
    void run_requests() noexcept;

    bool alarmed_ = false;        // a sensor ended the cut
    bool ended_now_ = false;      // ended by the operator in this cycle
    State before_ = State::IDLE;  // state at the start of this cycle

  private:
    bool isStopped() noexcept;
    bool isTorchAllowed() noexcept;
    void end_by_operator() noexcept;

    bool is_stop_after_return_ = false, torch_taken_ = false;
};

/// Decides which action starts; see idle.cc.
class Idle : protected Stops {
  protected:
    void idle() noexcept;

  private:
    bool startOfCut() noexcept;
    bool startWhilePaused() noexcept;
    bool startOfSideAction() noexcept;
    bool isNearLastCut() const noexcept;
};

class Core : protected Idle {
  public:
    /// Runs one servo period of `period_s` [s]. [servo]
    void step(const Inputs &in, double period_s) noexcept;
    const Outputs &out() const noexcept { return out_; }
    State state() const noexcept { return state_; }
    /// The fault since the last call. [servo]
    Fault take_fault() noexcept {
        const Fault fault = fault_;
        fault_ = Fault::NONE;
        return fault;
    }

  private:
    void run_state() noexcept;
    void count_times() noexcept;
    void finish() noexcept;
    bool areUsable() const noexcept;

    State started_ = State::IDLE;  // state after the stop conditions were checked
    bool was_torch_on_ = false;
};

}  // namespace mw::plasma
