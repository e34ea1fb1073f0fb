// SPDX-License-Identifier: GPL-2.0-or-later
// Position of a pose in the picture: [DISPLAY]GEOMETRY, and the two planes of a foam cutter.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "base/geometry/pose.hh"
#include "base/result.hh"

namespace mw::screen {

using Place = std::array<double, 3>;  ///< X, Y, Z of the picture [machine units]

/// A sequence of translations and rotations, executed from its last letter to its first: "AXYZ" moves along
/// X, Y and Z, then rotates about X by A.
class PathGeometry {
  public:
    static constexpr std::string_view PRESET = "XYZABCUVW";

    /// X, Y and Z unchanged.
    PathGeometry() : PathGeometry(*parse(PRESET, "XYZ")) {}
    /// Letters X Y Z and U V W (translations) and A B C (rotations about X, Y, Z), each with '-' before it if
    /// reversed. Letters that are not in `axes` have no effect; '!' and ';' are ignored. An error for other
    /// characters.
    static Result<PathGeometry> parse(std::string_view text, std::string_view axes);

    Place place(const geometry::Pose &pose) const;
    /// True if rotations of this pose change the picture, so that straight moves with them are curves.
    bool isTurnedBetween(const geometry::Pose &from, const geometry::Pose &to) const;
    /// True if the picture shows X, Y, Z of the machine without rotation.
    bool isPlain() const;

  private:
    struct Step {
        int axis = 0;
        double sign = 1;
    };
    explicit PathGeometry(std::vector<Step> steps) : steps_(std::move(steps)) {}
    std::vector<Step> steps_;  ///< in the order of execution
};

/// A wire through two planes: X and Y at one height, U and V at another.
struct FoamPlanes {
    double z = 0, w = 0;  ///< heights in the picture [machine units]
};

struct PathLook {
    PathGeometry geometry{};
    std::optional<FoamPlanes> foam{};  ///< for a foam cutter, which does not use `geometry`
};

}  // namespace mw::screen
