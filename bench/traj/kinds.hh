// SPDX-License-Identifier: GPL-2.0-or-later
// Programs for comparing trajectory planners: twelve types of machining as plain moves. Independent of
// src/trajectory, so that bounds and other planners can be measured with the same programs. See README.md.
#pragma once

#include <string>
#include <vector>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"

namespace mw::bench {

using geometry::Pose;

/// One programmed move: a line, or an arc about `centre` in the plane of `normal` (a helix if the end is
/// outside that plane).
struct Move {
    Pose end;
    bool isArc = false;
    Pose centre, normal;
    double angle_rad = 0;  ///< signed about `normal`
    double feed = 0;       ///< along X Y Z, or A B C if only these move [mm/s, deg/s]; 0: rapid
    geometry::PathMode control = geometry::PathMode::BLEND;
};

struct Program {
    std::string name;
    Pose start;
    std::vector<Move> moves;
    double tolerance = 0.02;  ///< G64 P [mm; degrees over A B C]
    /// Limits of each axis [mm or degrees per s, s^2, s^3].
    Pose max_velocity, max_acceleration, max_jerk;
};

/// All types, always with the same moves.
std::vector<Program> all_kinds();

/// Dense blocks for measuring the planning rate: 0.01 mm apart at F20000 along a smooth curve in nine
/// coordinates.
Program dense_nine_axes(int blocks);

/// The programmed path as points at most `step` apart, including the start. Arcs are calculated
/// independently.
std::vector<Pose> sample_path(const Program &program, double step);

/// Position at `part` in [0, 1] of a move that starts at `from`.
Pose position_on(const Pose &from, const Move &move, double part);

}  // namespace mw::bench
