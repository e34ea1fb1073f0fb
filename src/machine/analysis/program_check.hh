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
#include "gcode/analysis/preview.hh"
#include "machine/analysis/path_points.hh"
#include "machine/analysis/time_estimate.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

struct CheckResult {
    std::uint64_t blocks = 0, moves = 0;
    double cutting_length = 0, rapid_length = 0;       ///< [machine units]
    std::array<double, MAX_AXES> lowest{}, highest{};  ///< reached, machine coordinates
    bool hasMoves = false;
    bool isCancelled = false;         ///< `progress` has ended it
    std::optional<TimeFigures> time;  ///< of a whole program without errors
};

struct CheckOptions {
    std::function<bool(const gcode::PreviewProgress &)> progress;  ///< false ends the check; may be empty
    /// How many statements a loop may take, 0 for any number; as gcode::PreviewOptions has it when not set.
    std::optional<std::int64_t> statements;
    /// Nothing of the shop's own is run: no Python. Told where the program's way may depend on what only the
    /// running machine knows (scripts, HAL values, inputs, probes); errors behind may be none. Empty: scripts
    /// run, HAL values are errors.
    std::function<void(const SourcePlace &, std::string_view what)> unknown;
    std::function<bool()> wantsTime;  ///< false once: the time is not reckoned on; empty: it is to the end
    bool isBlockDeleteOn = true;
    PathPoints *points = nullptr;  ///< gets the path of the controlled point
};

/// Runs the interpreter over the whole program. Errors (syntax, limits, endless loops) go to `sink` with
/// their places; at most `MAX_CHECK_ERRORS` of them. Tool table and parameter file are read and never
/// written. When `progress` answers false the check ends with what it has.
CheckResult check_program(const MachineConfig &machine, const std::string &program, gcode::ToolSource &tools,
                          gcode::ParameterSource &parameters, diagnostics::Sink &sink,
                          const CheckOptions &options = {});

inline constexpr int MAX_CHECK_ERRORS = 20;

/// The machine as a program finds it, homed and without a tool; `machine` must outlive it.
gcode::PreviewMachine preview_stand(const MachineConfig &machine);

/// Where the machine stands when its joints are homed; where joints are not axes, a place within the limits.
geometry::Pose home_position(const MachineConfig &machine);

}  // namespace mw::machine
