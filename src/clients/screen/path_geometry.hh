// SPDX-License-Identifier: GPL-2.0-or-later
// Where a pose is drawn: [DISPLAY]GEOMETRY, and the two planes of a foam cutter.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "base/geometry/pose.hh"
#include "base/result.hh"

namespace mw::screen {

using Place = std::array<double, 3>;  ///< X, Y, Z of the picture [machine units]

/// A sequence of translations and turns, done from its last letter to its first: "AXYZ" moves along X, Y and
/// Z, then turns about X by A.
class PathGeometry {
  public:
    static constexpr std::string_view PRESET = "XYZABCUVW";

    /// X, Y and Z as they are.
    PathGeometry() : PathGeometry(*parse(PRESET, "XYZ")) {}
    /// Letters X Y Z and U V W (translations) and A B C (turns about X, Y, Z), each with '-' before it where
    /// it goes the other way; those that are not in `axes` do nothing. '!' and ';' are taken and change
    /// nothing. An error for anything else.
    static Result<PathGeometry> parse(std::string_view text, std::string_view axes);

    Place place(const geometry::Pose &pose) const;
    /// Turns of this pose change the picture: straight moves with them are curves there.
    bool isTurnedBetween(const geometry::Pose &from, const geometry::Pose &to) const;
    /// What is drawn is X, Y, Z of the machine, turned by nothing.
    bool isPlain() const;

  private:
    struct Step {
        int axis = 0;
        double sign = 1;
    };
    explicit PathGeometry(std::vector<Step> steps) : steps_(std::move(steps)) {}
    std::vector<Step> steps_;  ///< in the order in which they are done
};

/// A wire through two planes: X and Y at one height, U and V at another.
struct FoamPlanes {
    double z = 0, w = 0;  ///< heights in the picture [machine units]
};

struct PathLook {
    PathGeometry geometry{};
    std::optional<FoamPlanes> foam{};  ///< of a foam cutter, which has no use for `geometry`
};

}  // namespace mw::screen
