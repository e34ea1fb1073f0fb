// SPDX-License-Identifier: GPL-2.0-or-later
// The contour of the lathe cycles G70 to G72: lines and arcs in a separate frame, in which the cut runs
// towards larger x and the material is below the tool, towards smaller y. Pure geometry; lengths in program
// units.
#pragma once

#include <optional>
#include <vector>

#include "gcode/interpreter/codes/plane_geometry.hh"

namespace mw::gcode::detail {

/// A line, or an arc that is monotonic along x.
struct ProfileSegment {
    Point start, end;
    bool isArc = false;
    Point centre;
    int turn = 1;             ///< +1 counterclockwise
    double fillet = 0;        ///< corner at the end: radius of the word A or C
    bool is_chamfer = false;  ///< the corner is cut by a line between the fillet's ends
    int source = 0;           ///< equal for all segments of one arc
};

/// The first segment leads from the cycle's start to the first point of the contour.
using Profile = std::vector<ProfileSegment>;

/// From (Z, X) to the frame of a cut, and back.
struct CutFrame {
    bool isFacing = false;   ///< the cut runs along X
    bool side_clear = true;  ///< the side of the material is determined by the start of the cycle
    double along = 1, across = 1;

    Point to(Point p) const {
        return isFacing ? Point{p.y * along, p.x * across} : Point{p.x * along, p.y * across};
    }
    Point from(Point p) const {
        const double z = isFacing ? p.y * across : p.x * along, x = isFacing ? p.x * along : p.y * across;
        return {z + 0.0, x + 0.0};  // 0, not -0
    }
    int turn(int one) const { return (along * across > 0.0) != isFacing ? one : -one; }
};

Profile in_frame(const Profile &profile, const CutFrame &frame);
/// The cut runs towards the end of the profile. The material is on the side of the cycle's start where the
/// profile begins; if both have the same height, on the side of the whole profile.
CutFrame frame_of(const Profile &profile, bool isFacing);

double radius_of(const ProfileSegment &arc);
/// Direction of travel at `at`, a point of the segment.
Point direction(const ProfileSegment &segment, Point at);
/// Angle of an arc from `from` to `to`, 0 to a full circle [rad].
double sweep(const ProfileSegment &arc, Point from, Point to);
/// Crossings of the infinite lines or full circles of two segments.
Crossings crossings(const ProfileSegment &a, const ProfileSegment &b);
/// The segment offset to its left by `by`. Empty if an arc vanishes.
std::optional<ProfileSegment> moved(const ProfileSegment &segment, double by);
/// Splits arcs at their highest or lowest point: each piece is monotonic in height.
Profile split_arcs(const Profile &profile);
bool isDescending(const ProfileSegment &segment);
/// Maximum height of a segment.
double top_of(const ProfileSegment &segment);

/// Inserts fillets and chamfers. False if one of them does not fit.
bool round_corners(Profile &profile);
/// True if no segment after the first goes back by more than `tolerance`, as arcs with rounded numbers at a
/// shoulder do.
bool isMonotonic(const Profile &profile, double tolerance);
/// Removes segments shorter than `length`; their neighbours meet in the middle.
void drop_short(Profile &profile, double length);
/// Replaces the part of an arc that goes back (by no more than isMonotonic() permits) by a straight line
/// across.
void straighten(Profile &profile);

}  // namespace mw::gcode::detail
