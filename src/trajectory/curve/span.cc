// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/curve/span.hh"

#include <bit>

namespace mw::trajectory::curve {

void Span::find_moving() noexcept {
    moving = 0;
    for (std::size_t k = 1; k < c.size(); ++k) {
        for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
            moving |= c[k].c[i] != 0 ? 1U << i : 0U;
        }
    }
}

Pose position_at(const Span &span, double s) noexcept {
    const double u = (s - span.start_s) / span.length;
    Pose q = span.c[DEGREE];
    for (std::size_t k = DEGREE; k-- > 0;) {
        for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
            q.c[i] = q.c[i] * u + span.c[k].c[i];
        }
    }
    return q;
}

CurvePoint point_at(const Span &span, double s) noexcept {
    const double per = 1.0 / span.length;
    const double u = (s - span.start_s) * per;
    const double per2 = per * per, per3 = per2 * per;
    CurvePoint p;
    p.position = span.c[0];
    for (std::uint32_t left = span.moving; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        const auto c = [&](std::size_t k) { return span.c[k].c[i]; };
        p.position.c[i] = c(0) + u * (c(1) + u * (c(2) + u * (c(3) + u * (c(4) + u * c(5)))));
        p.first.c[i] = per * (c(1) + u * (2 * c(2) + u * (3 * c(3) + u * (4 * c(4) + u * 5 * c(5)))));
        p.second.c[i] = per2 * (2 * c(2) + u * (6 * c(3) + u * (12 * c(4) + u * 20 * c(5))));
        p.third.c[i] = per3 * (6 * c(3) + u * (24 * c(4) + u * 60 * c(5)));
    }
    return p;
}

}  // namespace mw::trajectory::curve
