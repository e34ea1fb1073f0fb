// SPDX-License-Identifier: GPL-2.0-or-later
// Points along a path for a picture, in bounded memory.
#pragma once

#include <cstdint>
#include <vector>

#include "base/geometry/pose.hh"

namespace mw::gcode {

struct PathPoint {
    float x, y, z;  ///< [machine units], machine coordinates
    bool isRapid;   ///< the move that ends here is a rapid
};

/// Keeps every n-th point; doubles n when there are too many.
class PathPoints {
  public:
    static constexpr std::size_t MOST = 400000;

    void add(const geometry::Pose &p, bool isRapid) {
        if (until_point_ > 0) {
            --until_point_;
            return;
        }
        until_point_ = stride_ - 1;
        points_.push_back(
            {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]), isRapid});
        if (points_.size() < MOST) {
            return;
        }
        for (std::size_t i = 0; i < MOST / 2; ++i) {
            points_[i] = points_[2 * i];
        }
        points_.resize(MOST / 2);
        stride_ *= 2;
    }
    const std::vector<PathPoint> &all() const { return points_; }

  private:
    std::vector<PathPoint> points_;
    std::uint64_t stride_ = 1, until_point_ = 0;
};

}  // namespace mw::gcode
