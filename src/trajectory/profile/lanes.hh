// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of doubles that are calculated together. All processors use the same operations in the same order,
// so the results are bit-identical.
#pragma once

#include <cmath>
#include <cstddef>

namespace mw::trajectory::profile {

/// Number of cells that are calculated together.
inline constexpr std::size_t LANES = 4;
using Lanes = double __attribute__((vector_size(LANES * sizeof(double)), aligned(LANES * sizeof(double))));

[[gnu::always_inline]] inline Lanes load(const double *p) noexcept {
    Lanes v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}

[[gnu::always_inline]] inline void add_to(double *p, const Lanes &v) noexcept {
    const Lanes sum = load(p) + v;
    __builtin_memcpy(p, &sum, sizeof sum);
}

[[gnu::always_inline]] inline Lanes root(const Lanes &v) noexcept {
    Lanes r;
    for (std::size_t i = 0; i < LANES; ++i) {
        r[i] = std::sqrt(v[i]);
    }
    return r;
}

[[gnu::always_inline]] inline Lanes larger(const Lanes &x, const Lanes &y) noexcept {
    return x > y ? x : y;
}

/// 1 for existing elements, 0 for the padding of the last vector.
[[gnu::always_inline]] inline Lanes real_lanes(std::size_t first, std::size_t count) noexcept {
    Lanes real{};
    for (std::size_t i = 0; i < LANES; ++i) {
        real[i] = first + i < count ? 1.0 : 0.0;
    }
    return real;
}

}  // namespace mw::trajectory::profile
