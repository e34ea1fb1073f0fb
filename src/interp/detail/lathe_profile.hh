// SPDX-License-Identifier: GPL-2.0-or-later
// The contour that the lathe cycles G70 to G72 follow: lines and arcs in a frame of its own, where the cut
// runs towards larger x and the material lies below the tool, towards smaller y. Pure geometry; lengths in
// program units.
#pragma once

#include <optional>
#include <vector>

#include "interp/detail/state.hh"

namespace mw::interp::detail {

/// A line, or an arc of less than half a turn's change in its direction along x.
struct ProfileSegment {
    Point start, end;
    bool isArc = false;
    Point centre;
    int turn = 1;            ///< +1 counterclockwise
    double fillet = 0;       ///< of the corner at the end: radius of the word A or C
    bool isChamfer = false;  ///< the corner is cut by a line between the fillet's ends
};

using Profile = std::vector<ProfileSegment>;

/// A move of a cycle in the profile's frame.
struct ProfileMove {
    bool isRapid = false;
    bool isArc = false;
    Point end;
    Point centre;
    int turn = 1;
};

/// How deep G71 and G72 cut, and what of the profile.
struct RoughingPlan {
    enum class Pockets { ALL, SKIP, ONLY };  ///< G71, G71.1, G71.2
    Pockets pockets = Pockets::ALL;
    double increment = 1, retract = 0.5;
    bool isVisitingStarts = false;  ///< G71.1: a move without length to where each segment begins, as in the
                                    ///< field's outputs
};

/// A cycle whose profile is being read from its subroutine.
struct LatheRequest {
    int code = 0;   ///< ten times the G code
    int label = 0;  ///< Q: the subroutine
    Pose start;     ///< where the cycle begins
    RoughingPlan roughing;
    double distance = 0, end_distance = 0;  ///< D, and E of G70
    int passes = 1;                         ///< P of G70
    int motion = 0;                         ///< the G code in force in the profile
    Pose position;                          ///< its end so far
    Profile profile;                        ///< x along Z, y along X
};

/// Puts fillets and chamfers into the corners. False where one does not fit.
bool round_corners(Profile &profile);
/// No segment after the first goes backwards.
bool isMonotonic(const Profile &profile);
/// The profile moved upwards by `distance` (downwards when negative): arcs around convex corners, cut off in
/// concave ones. The first segment keeps its start and leads to where the moved profile begins. False when
/// nothing is left.
bool offset_profile(Profile &profile, double distance);
/// The moves of one finishing pass, beginning with a rapid move to the end of the first segment.
std::vector<ProfileMove> finish_moves(const Profile &profile);
/// The moves of G71 and G72; none when there would be more than a million.
std::optional<std::vector<ProfileMove>> rough_moves(const Profile &profile, const RoughingPlan &plan);

}  // namespace mw::interp::detail
