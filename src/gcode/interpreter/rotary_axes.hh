// SPDX-License-Identifier: GPL-2.0-or-later
// INI settings of axes A, B and C that rotate without limit or have a locking indexer.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry/pose.hh"

namespace mw::gcode {

struct RotaryAxes {
    static constexpr int FIRST = geometry::AXIS_A, LAST = geometry::AXIS_C;

    std::uint32_t wrapped = 0;                          ///< bit per axis from A on ([AXIS_l]WRAPPED_ROTARY)
    std::array<std::int8_t, 3> indexer = {-1, -1, -1};  ///< joint that unlocks the axis, -1: none

    bool isWrapped(int axis) const {
        return axis >= FIRST && axis <= LAST && (wrapped >> (axis - FIRST) & 1U) != 0;
    }
    bool isIndexer(int axis) const { return axis >= FIRST && axis <= LAST && indexer_joint(axis) >= 0; }
    int indexer_joint(int axis) const { return indexer[static_cast<std::size_t>(axis - FIRST)]; }
    bool hasAny() const { return wrapped != 0 || hasIndexer(); }
    bool hasIndexer() const { return indexer[0] >= 0 || indexer[1] >= 0 || indexer[2] >= 0; }

    bool operator==(const RotaryAxes &) const = default;
};

}  // namespace mw::gcode
