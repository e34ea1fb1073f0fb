// SPDX-License-Identifier: GPL-2.0-or-later
// Interprets a program without moving anything and checks every move against the soft limits.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "gcode/analysis/path_points.hh"
#include "gcode/analysis/preview.hh"
#include "gcode/analysis/time_estimate.hh"

namespace mw::gcode {

/// The machine for which a program is checked.
struct CheckedMachine {
    PreviewMachine start;  ///< homed and without a tool
    TimedMachine limits;
    /// INI key of a soft limit: "[AXIS_X]MAX_LIMIT".
    std::function<std::string(int axis, bool is_low)> limit_key;
    bool is_start_known = true;  ///< false: without trivial kinematics the pose before the start is unknown
};

/// Sources of values for a program; both are only read.
struct ProgramSources {
    ToolSource &tools;
    ParameterSource &parameters;
};

struct CheckResult {
    std::uint64_t blocks = 0, moves = 0;
    double cutting_length = 0, rapid_length = 0;       ///< [machine units]
    std::array<double, MAX_AXES> lowest{}, highest{};  ///< extreme positions, machine coordinates
    bool has_moves = false;
    bool cancelled = false;           ///< `progress` has cancelled the check
    std::optional<TimeFigures> time;  ///< only for a whole program without errors
};

struct CheckOptions {
    std::function<bool(const PreviewProgress &)> progress;  ///< false ends the check; may be empty
    /// Number of statements that a loop may execute, 0: no limit; default as in PreviewOptions.
    std::optional<std::int64_t> statements;
    /// If set, Python and user programs are not run. It is called when the program may depend on values known
    /// only to the running machine (scripts, HAL values, inputs, probes); later errors are then uncertain.
    /// Empty: scripts run, and HAL values are errors.
    std::function<void(const SourcePlace &, std::string_view what)> unknown;
    std::function<bool()> wantsTime;  ///< when it returns false, the time is not calculated further; empty:
                                      ///< calculated to the end
    bool block_delete_on = true;
    PathPoints *points = nullptr;  ///< receives the path of the controlled point
};

/// Interprets the whole program. Errors (syntax, limits, endless loops) go to `sink` with their positions, at
/// most `MAX_CHECK_ERRORS`. Tool table and parameter file are only read. When `progress` returns false the
/// check ends with the results so far.
CheckResult check_program(const CheckedMachine &machine, const std::string &program,
                          const ProgramSources &sources, diagnostics::Sink &sink,
                          const CheckOptions &options = {});

inline constexpr int MAX_CHECK_ERRORS = 20;

}  // namespace mw::gcode
