// SPDX-License-Identifier: GPL-2.0-or-later
// A PID controller with feed-forward, limits and relay auto-tuning, without HAL. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::pid {

constexpr int MAX_CHANNELS = 16;

/// Gains and limits; a limit of 0 means no limit. Errors are in command units, the output is in units of the
/// actuator.
struct Tuning {
    double p = 1.0;
    double i = 0.0;  ///< [1/s]
    double d = 0.0;  ///< [s]
    double ff0 = 0.0;
    double ff1 = 0.0;
    double ff2 = 0.0;
    double ff3 = 0.0;
    double bias = 0.0;
    double deadband = 0.0;
    double max_error = 0.0;
    double max_error_i = 0.0;
    double max_error_d = 0.0;
    double max_command_d = 0.0;
    double max_command_dd = 0.0;
    double max_command_ddd = 0.0;
    double max_output = 0.0;
};

struct Inputs {
    bool isEnabled = false;
    double command = 0.0;
    double feedback = 0.0;
    bool has_command_derivative = false;  ///< otherwise it is estimated
    double command_derivative = 0.0;
    bool has_feedback_derivative = false;
    double feedback_derivative = 0.0;
    bool usesPreviousTarget = true;  ///< compare the feedback with the command of the previous call
    bool isIndexEnabled = false;     ///< a falling edge reports that command and feedback have jumped
};

struct Outputs {
    double error = 0.0;
    double output = 0.0;
    bool saturated = false;
    double saturated_s = 0.0;
    std::int32_t saturated_count = 0;
};

/// Derivatives are computed in every period, enabled or not. They only use samples in the current
/// coordinates, never across an index, and only when there are enough samples. Until then they are 0, so that
/// neither the first period nor an index adds a step to the output.
class Controller {
  public:
    Outputs run(const Inputs &in, const Tuning &tuning, double dt) noexcept;
    /// Clears the integrator and the samples: the next period is like the first one.
    void reset() noexcept;

    // For manual tuning.
    double error_i = 0.0;
    double error_d = 0.0;
    double command_d = 0.0;
    double command_dd = 0.0;
    double command_ddd = 0.0;

  private:
    double target(const Inputs &in) noexcept;
    void derive_command(const Inputs &in, const Tuning &tuning, double dt) noexcept;
    void derive_error(const Inputs &in, const Tuning &tuning, double dt) noexcept;

    bool has_samples_ = false;  ///< the previous command and feedback are known
    bool has_command_d_ = false;
    bool has_command_dd_ = false;
    bool has_jumped_ = false;  ///< the index was found in this period
    bool was_index_enabled_ = false;
    double previous_command_ = 0.0;
    double previous_feedback_ = 0.0;
    double raw_command_d_ = 0.0;  ///< before limiting
    double feedback_d_ = 0.0;
    int limit_state_ = 0;  ///< sign of the limited output of the previous period
    double saturated_s_ = 0.0;
    std::int32_t saturated_count_ = 0;
};

/// Finds gains with a relay instead of the controller (Astrom and Hagglund 1984). The loop enters a limit
/// cycle; its amplitude and period give the ultimate gain, and the gains follow from the rules of Ziegler and
/// Nichols.
class Tuner {
  public:
    struct Settings {
        double effort = 0.5;        ///< output of the relay
        std::uint32_t cycles = 50;  ///< number of half cycles to measure
        std::uint32_t type = 0;     ///< 0: P, I and D; 1: P, I and FF1
        double bias = 0.0;
    };

    /// Starts a new tuning.
    void start() noexcept {
        *this = Tuner{};
        running_ = true;
    }
    bool isRunning() const noexcept { return running_; }
    /// The output for this period. After the last half cycle the gains are in `tuning` and the tuner stops.
    double run(double error, const Settings &settings, Tuning &tuning, double dt) noexcept;

    double ultimate_gain = 0.0;
    double ultimate_period = 0.0;  ///< [s]

  private:
    bool running_ = false;
    bool positive_ = true;
    std::uint32_t half_cycles_ = 0;
    double peak_ = 0.0;
    double peak_sum_ = 0.0;
    double time_ = 0.0;
};

}  // namespace mw::pid
