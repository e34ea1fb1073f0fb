// SPDX-License-Identifier: GPL-2.0-or-later
// Index types that cannot be mixed up: a joint number is not an axis letter.
#pragma once

#include <compare>
#include <cstdint>

namespace mw {

template <class Tag, class Rep = std::int32_t>
struct StrongId {
    Rep value = 0;

    constexpr StrongId() noexcept = default;
    constexpr explicit StrongId(Rep v) noexcept : value(v) {}
    constexpr auto operator<=>(const StrongId &) const noexcept = default;
};

using JointId = StrongId<struct JointTag>;      ///< a motor, 0..MAX_JOINTS-1
using SpindleId = StrongId<struct SpindleTag>;  ///< a spindle, 0..MAX_SPINDLES-1

}  // namespace mw
