// SPDX-License-Identifier: GPL-2.0-or-later
// Direction of motion in the XY plane, and the current circle, for torches, knives and other devices that
// follow the path (pins motion.interp.L).
#pragma once

#include "motion/interface/path_command.hh"
#include "trajectory/path/primitive.hh"

namespace mw::motion {

/// Inputs of a heading. The heading of a line remains valid until they change.
struct HeadingOrigin {
    std::uint64_t path_id = 0;
    std::uint64_t move = 0;  ///< number of the primitive
    MotionType type = MotionType::NONE;
    bool isReverse = false;
    bool operator==(const HeadingOrigin &) const = default;
};

/// All values are 0 without a move.
struct Heading {
    HeadingOrigin origin;
    int g_code = 0;            ///< ten times the code of the move: 0, 10, 20, 30; 380 for probe moves
    double direction_deg = 0;  ///< of the motion in XY, counter-clockwise from X; [0, 360)
    double to_centre_deg = 0;  ///< for an arc, from the tool to its centre; for a line, to its left
    bool isArc = false;
    double radius = 0;               ///< of the arc [machine units]
    std::array<double, 3> centre{};  ///< machine coordinates X Y Z
};

/// `place`: position of the tool on the move in machine coordinates without external offsets. A move without
/// motion in X or Y keeps the directions of `before`. [servo]
Heading heading_of(const trajectory::Primitive &move, MotionType type, const geometry::Pose &place,
                   bool isReverse, const Heading &before) noexcept;

}  // namespace mw::motion
