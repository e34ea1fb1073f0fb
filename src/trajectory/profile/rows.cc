// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/rows.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

/// Fraction by which a plan at the velocity limits may exceed the squared speed limit.
constexpr double ROUNDING = 1e-5;

}  // namespace

void Rows::begin(std::size_t coordinates, bool has_norm) {
    has_norm_ = has_norm;
    norms_.clear();
    coordinates_ = coordinates;
    cells_ = 0;
    lengths_.clear();
    velocity_.clear();
    machine_v2_.clear();
    rows_.clear();
}

void Rows::add_cell(double h) {
    if (cells_ % LANES == 0) {
        velocity_.resize(velocity_.size() + PLACES, VelocityLanes{});
        norms_.resize(norms_.size() + (has_norm_ ? PLACES : 0), NormLanes{});
        rows_.resize(rows_.size() + PLACES * coordinates_, RowLanes{});
    }
    lengths_.push_back(h);
    machine_v2_.resize(lengths_.size() * PLACES);
    ++cells_;
}

void Rows::set_velocity(std::size_t place, double v2, double machine_v2) noexcept {
    const std::size_t cell = cells_ - 1;
    velocity_[cell / LANES * PLACES + place].v2[cell % LANES] = v2;
    machine_v2_[cell * PLACES + place] = machine_v2;
}

void Rows::relax(std::size_t cell, std::size_t place, double factor) noexcept {
    const std::size_t i = cell % LANES;
    const std::size_t at = cell / LANES * PLACES + place;
    const double f = 1 / factor, f2 = f * f;
    for (std::size_t k = 0; k < coordinates_; ++k) {
        RowLanes &r = rows_[at * coordinates_ + k];
        for (Lanes *x : {&r.a1, &r.a2, &r.j1, &r.j2, &r.j3}) {
            (*x)[i] *= f;
        }
    }
    if (has_norm_) {
        NormLanes &n = norms_[at];
        for (Lanes *x : {&n.aa, &n.ab, &n.bb, &n.jww, &n.jwa, &n.jwb, &n.jaa, &n.jab, &n.jbb}) {
            (*x)[i] *= f2;
        }
    }
}

void Rows::allow(std::size_t cell, std::size_t place, double b) noexcept {
    Lanes &v2 = velocity_[cell / LANES * PLACES + place].v2;
    const double lane = v2[cell % LANES];
    const double machine = (1 - ROUNDING) * machine_v2_[cell * PLACES + place];
    v2[cell % LANES] = b > 0 ? std::min(lane, std::max(1 / b, machine)) : lane;
}

double Rows::velocity(std::size_t cell, std::size_t place) const noexcept {
    return velocity_[cell / LANES * PLACES + place].v2[cell % LANES];
}

double Rows::worst(std::size_t cell, std::size_t place, const LawState &s) const noexcept {
    double worst = 0;
    for (std::size_t i = 0; i < coordinates_; ++i) {
        const Row r = get(cell, place, i);
        worst = std::max({worst, std::abs(r.a1 * s.a + r.a2 * s.b),
                          std::abs(r.j1 * s.w + r.j2 * s.a + r.j3 * s.b) * std::sqrt(s.b) + r.k * s.b});
    }
    if (has_norm_) {
        const NormRow n = get_norm(cell, place);
        const double q = n.aa * s.a * s.a + 2 * n.ab * s.a * s.b + n.bb * s.b * s.b;
        const double z = n.jww * s.w * s.w + n.jaa * s.a * s.a + n.jbb * s.b * s.b +
                         2 * (n.jwa * s.w * s.a + n.jwb * s.w * s.b + n.jab * s.a * s.b);
        worst = std::max({worst, std::sqrt(std::max(q, 0.0)), std::sqrt(std::max(z * s.b, 0.0)) + n.k * s.b});
    }
    return worst;
}

// The unknowns of the solver in a cell are b, h a and h^2 w, so the rows are scaled by 1, 1/h and 1/h^2.
void Rows::set(std::size_t place, std::size_t coordinate, const Row &row) noexcept {
    const std::size_t cell = cells_ - 1;
    const std::size_t lane = cell % LANES;
    const double per_h = 1 / lengths_[cell];
    RowLanes &r = rows_[(cell / LANES * PLACES + place) * coordinates_ + coordinate];
    r.a1[lane] = row.a1 * per_h;
    r.a2[lane] = row.a2;
    r.j1[lane] = row.j1 * per_h * per_h;
    r.j2[lane] = row.j2 * per_h;
    r.j3[lane] = row.j3;
    r.k[lane] = row.k;
}

void Rows::set_norm(std::size_t place, const NormRow &row) noexcept {
    const std::size_t cell = cells_ - 1;
    const std::size_t i = cell % LANES;
    const double p1 = 1 / lengths_[cell], p2 = p1 * p1;
    NormLanes &n = norms_[cell / LANES * PLACES + place];
    n.aa[i] = row.aa * p2;
    n.ab[i] = row.ab * p1;
    n.bb[i] = row.bb;
    n.jww[i] = row.jww * p2 * p2;
    n.jwa[i] = row.jwa * p2 * p1;
    n.jwb[i] = row.jwb * p2;
    n.jaa[i] = row.jaa * p2;
    n.jab[i] = row.jab * p1;
    n.jbb[i] = row.jbb;
    n.k[i] = row.k;
}

NormRow Rows::get_norm(std::size_t cell, std::size_t place) const noexcept {
    const std::size_t i = cell % LANES;
    const double h = lengths_[cell], h2 = h * h;
    const NormLanes &n = norms_[cell / LANES * PLACES + place];
    return {n.aa[i] * h2,  n.ab[i] * h,   n.bb[i],      n.jww[i] * h2 * h2, n.jwa[i] * h2 * h,
            n.jwb[i] * h2, n.jaa[i] * h2, n.jab[i] * h, n.jbb[i],           n.k[i]};
}

Row Rows::get(std::size_t cell, std::size_t place, std::size_t coordinate) const noexcept {
    const std::size_t lane = cell % LANES;
    const double h = lengths_[cell];
    const RowLanes &r = rows_[(cell / LANES * PLACES + place) * coordinates_ + coordinate];
    return {r.a1[lane] * h, r.a2[lane], r.j1[lane] * h * h, r.j2[lane] * h, r.j3[lane], r.k[lane]};
}

}  // namespace mw::trajectory::profile
