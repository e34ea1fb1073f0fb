// SPDX-License-Identifier: GPL-2.0-or-later
// The path channel, which the planner reads: moves and synchronized commands in program order. Machine
// coordinates; lengths in machine units, angles in degrees.
#pragma once

#include <cstdint>
#include <variant>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"
#include "motion/interface/command.hh"

namespace mw::motion {

enum class MotionType : std::uint8_t {
    NONE = 0,
    TRAVERSE = 1,
    FEED = 2,
    ARC = 3,
    TOOL_CHANGE = 4,
    PROBING = 5,
    INDEX_ROTARY = 6
};
using geometry::PathMode;

/// Source of a move, shown to the operator and written to the trace.
struct SourceTag {
    std::int32_t line = 0;         ///< the operator's line number
    std::uint32_t file_index = 0;  ///< task's table of files
    std::uint32_t block = 0;       ///< counts executed blocks; single-block mode stops when it changes
};

/// Conditions of a move: from the program, and added by task.
struct MoveTerms : geometry::MoveSettings {
    bool isFeedOverridable = true;
    bool isWaitingForSpindleSpeed = false;  ///< waits before this move for spindle.N.at-speed
    SourceTag source;
};

struct Line {
    geometry::Pose end;
    MoveTerms terms;
};
/// A helix; see gcode::ArcMove for the meaning of the fields.
struct Arc {
    geometry::Pose end, centre, normal;
    double angle_rad = 0;
    bool isInUvw = false;
    MoveTerms terms;
};
struct Probe {
    geometry::Pose end;
    bool isAway = false;   ///< stops when contact is lost
    bool mustTrip = true;  ///< reaching the end without contact is an error
    MoveTerms terms;
};
struct RigidTap {
    geometry::Pose end;
    double pitch_scale = 1.0;
    MoveTerms terms;
};
/// Outputs that change when the path reaches this point (M62, M63, M67).
struct SynchedDigitalOutput {
    int index = 0;
    bool isOn = false;
};
struct SynchedAnalogOutput {
    int index = 0;
    double value = 0;
};
/// The last command for now: the planner plans to the end of the queue. Answered DONE when motion has stopped
/// there.
struct Flush {};

using PathBody = std::variant<Line, Arc, Probe, RigidTap, SynchedDigitalOutput, SynchedAnalogOutput, Flush>;

struct PathCommand {
    CommandId id = 0;
    Epoch epoch = 0;
    PathBody body;
};

}  // namespace mw::motion
