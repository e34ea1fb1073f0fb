// SPDX-License-Identifier: GPL-2.0-or-later
// The path of the tool on a screen: points in space with the colour of the move to the point.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace mw::python {

using Colour = std::array<std::uint8_t, 4>;

struct LoggedPoint {
    float x = 0, y = 0, z = 0;
    Colour colour{};
    float a = 0, b = 0, c = 0;  ///< foam cutters: position of the other end of the wire
    Colour other_colour{};
};
static_assert(sizeof(LoggedPoint) == 32, "screens read points as rows of 32 bytes");

/// One thread at a time.
class LoggedPath {
  public:
    static constexpr std::size_t MAX_POINTS = 100000;

    /// Adds a sample. If the path continues straight on in the same colour, the last point is moved.
    void add(const LoggedPoint &sample);
    void clear() { points_.clear(); }
    const std::vector<LoggedPoint> &points() const { return points_; }

  private:
    bool isStraightOn(const LoggedPoint &sample) const;
    std::vector<LoggedPoint> points_;
};

}  // namespace mw::python
