// SPDX-License-Identifier: GPL-2.0-or-later
// The contour that the lathe cycles G70 to G72 follow: lines and arcs in a frame of its own, where the cut
// runs towards larger x and the material lies below the tool, towards smaller y. Pure geometry; lengths in
// program units.
#pragma once

#include <optional>
#include <vector>

#include "gcode/interpreter/codes/plane_geometry.hh"

namespace mw::gcode::detail {

/// A line, or an arc that does not turn back along x.
struct ProfileSegment {
    Point start, end;
    bool isArc = false;
    Point centre;
    int turn = 1;            ///< +1 counterclockwise
    double fillet = 0;       ///< of the corner at the end: radius of the word A or C
    bool isChamfer = false;  ///< the corner is cut by a line between the fillet's ends
    int source = 0;          ///< pieces of one arc have the same
};

/// The first segment is the way from the cycle's start to the first point of the contour.
using Profile = std::vector<ProfileSegment>;

/// From (Z, X) to the frame of a cut, and back.
struct CutFrame {
    bool isFacing = false;    ///< the cut runs along X
    bool isSideClear = true;  ///< the start tells on which side of the profile the material is
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
/// The cut runs to where the profile ends. The material lies on that side of the cycle's start where the
/// profile begins; when both are at one height, where all of the profile lies.
CutFrame frame_of(const Profile &profile, bool isFacing);

double radius_of(const ProfileSegment &arc);
/// The direction of travel at `at`, which lies on the segment.
Point direction(const ProfileSegment &segment, Point at);
/// How far an arc turns from `from` to `to`, 0 to a full turn [rad].
double sweep(const ProfileSegment &arc, Point from, Point to);
/// Crossings of the whole lines or circles that two segments lie on.
Crossings crossings(const ProfileSegment &a, const ProfileSegment &b);
/// The segment moved to its left by `by`. None when an arc vanishes.
std::optional<ProfileSegment> moved(const ProfileSegment &segment, double by);
/// Arcs cut at their highest or lowest point: every piece only rises or only falls.
Profile split_arcs(const Profile &profile);
bool isDescending(const ProfileSegment &segment);
/// The highest that a segment comes.
double top_of(const ProfileSegment &segment);

/// Puts fillets and chamfers into the corners. False where one does not fit.
bool round_corners(Profile &profile);
/// No segment after the first goes back by more than `tolerance`, as arcs of rounded numbers do that touch a
/// shoulder.
bool isMonotonic(const Profile &profile, double tolerance);
/// Segments below `length` go; their neighbours meet in the middle.
void drop_short(Profile &profile, double length);
/// Arcs that go back, by no more than isMonotonic() has allowed, begin or end with a straight line across.
void straighten(Profile &profile);

}  // namespace mw::gcode::detail
