// SPDX-License-Identifier: GPL-2.0-or-later
// Cutting a profile: in one pass along it, or in layers from the start of the cycle down to it.
#pragma once

#include "gcode/interpreter/codes/lathe/lathe_profile.hh"
#include "gcode/interpreter/codes/state.hh"

namespace mw::gcode::detail {

/// A move of a cycle in the profile's frame.
struct ProfileMove {
    bool isRapid = false;
    bool isArc = false;
    Point end;
    Point centre;
    int turn = 1;
    int source = -1;  ///< source of the segment that it follows
};

/// Depth of cut of G71 and G72, and the part of the profile to cut.
struct RoughingPlan {
    enum class Pockets { ALL, SKIP, ONLY };  ///< G71, G71.1, G71.2
    Pockets pockets = Pockets::ALL;
    double increment = 1, retract = 0.5;
    double narrowest = 0;  ///< a shorter layer is cut in both directions, because the tool cannot retract
                           ///< within it
    bool is_visiting_starts = false;  ///< G71.1: a move without length to the start of each segment, as
                                      ///< printed by LinuxCNC
};

/// A cycle whose profile is being read from its subroutine.
struct LatheRequest {
    GCode code{};
    int label = 0;  ///< Q: label of the subroutine
    Pose start;     ///< start of the cycle
    RoughingPlan roughing;
    double distance = 0, end_distance = 0;  ///< D, and E of G70
    int passes = 1;                         ///< P of G70
    GCode motion = G(1);                    ///< motion code of the profile's moves
    Pose position;                          ///< end of the profile so far
    Profile profile;                        ///< x along Z, y along X
};

/// The moves of one finishing pass; the first is a rapid move to the end of the first segment.
std::vector<ProfileMove> finish_moves(const Profile &profile);
/// The moves of G71 and G72; none when there would be more than a million. No layer is deeper than the
/// increment, and rapid moves stay in the area that earlier layers have cleared: the material begins at the
/// profile's first point and at the height of the cycle's start.
std::optional<std::vector<ProfileMove>> rough_moves(const Profile &profile, const RoughingPlan &plan);

}  // namespace mw::gcode::detail
