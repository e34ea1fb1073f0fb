// SPDX-License-Identifier: GPL-2.0-or-later
// Index types that cannot be mixed up.
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

}  // namespace mw
