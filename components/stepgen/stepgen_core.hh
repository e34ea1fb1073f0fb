// SPDX-License-Identifier: GPL-2.0-or-later
// Step pulse generation without HAL: one channel that turns a rate into pulses (fast part) and a position or
// velocity command into a rate (slow part). Both may run in one thread or in two; the fast part only reads
// `rate`.
#pragma once

#include <array>
#include <cstdint>

namespace mw::stepgen {

constexpr int MAX_CHANNELS = 16;
constexpr int MAX_PHASES = 5;
constexpr int MAX_STATES = 10;
constexpr int STEP_AND_DIR = 0;
constexpr int UP_AND_DOWN = 1;
constexpr int FIRST_STATE_TYPE = 2;
constexpr int LAST_STATE_TYPE = 14;
constexpr int USER_TYPE = 15;

/// The outputs of a state-based step type: bit p of states[i] is phase p at count i (modulo length).
struct Pattern {
    int phases = 0;
    int length = 0;
    std::array<std::uint8_t, MAX_STATES> states{};
};

/// Pattern of the step types 2 to 14; the user defines type 15.
const Pattern &pattern_of(int type) noexcept;

/// Minimum times of the waveform [ns]. step_type_uses_* shows which ones a step type has.
struct Timing {
    std::uint32_t steplen = 1;
    std::uint32_t stepspace = 1;  ///< for types 0 and 1
    std::uint32_t dirsetup = 1;   ///< for type 0
    std::uint32_t dirhold = 1;    ///< for type 0
    std::uint32_t dirdelay = 1;   ///< for types 1 and above

    /// Rounds all up to whole pulse periods; steplen is at least one.
    void round_up_to(std::int64_t period_ns) noexcept;
};

/// Position in steps as a binary fraction with 28 fractional bits. Rates are truncated to it; recorded step
/// sequences depend on that resolution to the exact period.
using Phase = std::int64_t;
constexpr int PHASE_BITS = 28;
constexpr Phase ONE_STEP = Phase{1} << PHASE_BITS;
constexpr Phase HALF_STEP = ONE_STEP / 2;

/// The fast part. [realtime]
struct PulseChannel {
    int type = STEP_AND_DIR;
    Pattern pattern{};
    Timing timing{};
    bool isEnabled = false;  ///< the fast part sets this in every period; without it no step starts
    Phase rate = 0;          ///< steps per pulse period

    // Outputs.
    bool step = false;  ///< type 0: step; type 1: a pulse in the direction of `isReverse`
    bool isReverse = false;
    std::uint8_t phases = 0;  ///< state types
    std::int32_t counts = 0;

    /// Half a step ahead, so that a step is halfway between two whole positions.
    Phase phase = HALF_STEP;
    std::int64_t high_left_ns = 0;
    std::int64_t space_left_ns = 0;
    std::int64_t reverse_left_ns = 0;
    std::int64_t setup_left_ns = 0;

    void run(std::int64_t period_ns) noexcept;
    /// Position without the half step ahead [steps].
    double position() const noexcept;

  private:
    void run_timers(std::int64_t period_ns) noexcept;
    bool turn_if_needed() noexcept;
    void emit_step(int direction) noexcept;
};

/// The inputs of the slow part in one call. Lengths are in machine units.
struct Command {
    bool isEnabled = false;
    bool is_velocity = false;  ///< control type v instead of p
    double position = 0.0;
    double velocity = 0.0;   ///< [units/s]
    double scale = 1.0;      ///< [steps/unit]
    double max_vel = 0.0;    ///< [units/s], 0: no limit
    double max_accel = 0.0;  ///< [units/s^2], 0: no limit
};

/// The slow part: follows a command within velocity and acceleration. [realtime]
struct RateControl {
    double last_position = 0.0;  ///< command of the previous call [units]
    double frequency = 0.0;      ///< [steps/s]

    /// Sets `channel.rate` for the time until the next call. `pulse_period_ns` is that of the fast part.
    void run(const Command &command, PulseChannel &channel, std::int64_t pulse_period_ns,
             std::int64_t period_ns) noexcept;
};

/// Highest step rate that the timing allows [steps/s].
double highest_frequency(const PulseChannel &channel) noexcept;

}  // namespace mw::stepgen
