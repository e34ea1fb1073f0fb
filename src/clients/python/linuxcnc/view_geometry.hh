// SPDX-License-Identifier: GPL-2.0-or-later
// Converts nine coordinates to a position in the picture of a screen.
#pragma once

#include <array>
#include <bitset>
#include <mutex>
#include <string>

#include "base/geometry/pose.hh"

namespace mw::python {

using Vertex = std::array<double, 3>;

/// The centre of the rotations by A, B and C, and which of them are active.
struct RotationCentre {
    Vertex centre{};
    std::bitset<geometry::AXIS_COUNT> turning{0x1ff};
};

/// Position of the tool in the picture. `geometry` is [DISPLAY]GEOMETRY from its last letter to its first,
/// as screens pass it: each letter moves or rotates the result of the letters before it, a minus reverses
/// its direction.
Vertex vertex_of(const std::string &geometry, const geometry::Pose &pose, const RotationCentre &rotation);

/// Settings of a screen for everything that it draws. Any thread.
class ViewGeometry {
  public:
    /// `offset`: the rotations are about the origin of the workpiece, else about that of the machine.
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
