// SPDX-License-Identifier: GPL-2.0-or-later
// How screens turn nine coordinates into a place of their picture.
#pragma once

#include <array>
#include <bitset>
#include <mutex>
#include <string>

#include "base/geometry/pose.hh"

namespace mw::python {

using Vertex = std::array<double, 3>;

/// About what A, B and C turn, and which of them do.
struct RotationCentre {
    Vertex centre{};
    std::bitset<geometry::AXIS_COUNT> turning{0x1ff};
};

/// Position of the tool in the picture. `geometry` is [DISPLAY]GEOMETRY from its last letter to its first,
/// as screens pass it: each letter moves or rotates the result of the letters before it, a minus reverses
/// its direction.
Vertex vertex_of(const std::string &geometry, const geometry::Pose &pose, const RotationCentre &rotation);

/// What a screen has set for all that is drawn. Any thread.
class ViewGeometry {
  public:
    /// `offset`: the rotations are about the origin of the work piece, else about that of the machine.
    void choose(const std::string &coordinates, bool offset);
    void place_origin(const Vertex &origin);
    RotationCentre centre() const;

  private:
    mutable std::mutex mutex_;
    bool offset_ = false;
    Vertex origin_{};
    std::bitset<geometry::AXIS_COUNT> turning_{0x1ff};
};

}  // namespace mw::python
