// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/time_law.hh"

#include <algorithm>
#include <cmath>

// GCC uses wide vectors if the processor has them. Clang, which builds for the sanitizers, does not inline
// the functions that such code calls. Multiplications and additions are not contracted (-ffp-contract=off),
// so results are bit-identical.
#if defined(__x86_64__) && !defined(__clang__)
#define MW_WIDE [[gnu::target_clones("arch=x86-64-v4", "avx2", "default")]]
#else
#define MW_WIDE
#endif

namespace mw::trajectory::profile {

namespace {

// In a cell y = (b, h a, h a'), with a and a' at its two ends. At the fraction x of it
// b(x) = y0 + (2x - x^2) y1 + x^2 y2,  h a(x) = (1 - x) y1 + x y2,  h^2 w = y2 - y1.
constexpr double weight_1(double x) noexcept {
    return 2 * x - x * x;
}
constexpr double weight_2(double x) noexcept {
    return x * x;
}
constexpr std::array<double, PLACES> SIMPSON{1.0 / 6, 4.0 / 6, 1.0 / 6};
/// A step covers at most this fraction of the distance to the nearest row.
constexpr double KEEP = 0.9;
/// Minimum of a pivot, as a fraction of its diagonal element. A smaller pivot is a rounding error next to a
/// row.
constexpr double LEAST_PIVOT = 1e-9;
/// If a full step has a decrement below this value per cell, the steps with this mu end.
constexpr double ENOUGH = 0.05;

/// y of the cells of a block, and the weights that calculate it from three coefficients:
/// y0 = A c0 + (1 - A) c1, y1 = A (c1 - c0), y2 = B (c2 - c1).
struct Local {
    Lanes y0, y1, y2;
};
struct Weights {
    Lanes a, b, real;
};

[[gnu::always_inline]] inline Local local_of(const Weights &m, const double *c) noexcept {
    const Lanes c0 = load(c), c1 = load(c + 1), c2 = load(c + 2);
    return {(c1 + m.a * (c0 - c1)) * m.real, m.a * (c1 - c0) * m.real, m.b * (c2 - c1) * m.real};
}

/// b, h a and h^2 w at a point.
struct State {
    Lanes b, a, w;
};

[[gnu::always_inline]] inline State state_of(const Local &y, double x) noexcept {
    return {y.y0 + weight_1(x) * y.y1 + weight_2(x) * y.y2, (1 - x) * y.y1 + x * y.y2, y.y2 - y.y1};
}

/// Gradient and Hessian in (b, a, w), or in y.
struct Slopes {
    Lanes g0{}, g1{}, g2{}, h00{}, h01{}, h02{}, h11{}, h12{}, h22{};
};

/// Two inverses calculated with one division.
struct Inverses {
    Lanes first, second;
};
[[gnu::always_inline]] inline Inverses inverse_of(const Lanes &x, const Lanes &y) noexcept {
    const Lanes both = 1.0 / (x * y);
    return {both * y, both * x};
}

/// Weight of the barrier of a velocity row. Most motion is at the programmed feed, so the solution must be
/// nearer to this limit than to others.
constexpr double VELOCITY_WEIGHT = 0.1;

/// Adds the barrier -log(1 - b v2).
[[gnu::always_inline]] inline void add_velocity(const State &s, const Lanes &v2, Slopes &d) noexcept {
    const Lanes g = v2 / (1.0 - s.b * v2), weighted = VELOCITY_WEIGHT * g;
    d.g0 += weighted;
    d.h00 += weighted * g;
}

/// Bound of the jerk, 1/sqrt(b) - k sqrt(b), and its slope. `of_root`: those of 1/sqrt(b). Both parts are
/// convex, so the tangent is a safe bound.
struct JerkBound {
    Lanes value, slope;
};

[[gnu::always_inline]] inline JerkBound jerk_bound(const State &s, const JerkBound &of_root,
                                                   const Lanes &k) noexcept {
    const Lanes kb = k * s.b;
    return {of_root.value * (1.0 - kb), of_root.slope * (1.0 + kb)};
}

/// Adds the barriers -log(1 - u^2), with u the acceleration, and -log of the slacks bound + z and bound - z,
/// with z the jerk and the tangent of its bound.
[[gnu::always_inline]] inline void add_row(const State &s, const RowLanes &r, const JerkBound &of_root,
                                           Slopes &d) noexcept {
    const auto [rb, slope] = jerk_bound(s, of_root, r.k);
    const Lanes u = r.a1 * s.a + r.a2 * s.b;
    const Lanes z = r.j1 * s.w + r.j2 * s.a + r.j3 * s.b;
    const auto [t, both] = inverse_of(1.0 - u * u, rb * rb - z * z);
    const Lanes g = 2.0 * u * t;
    const Lanes q = 2.0 * (1.0 + u * u) * t * t;
    const Lanes low = (rb - z) * both, high = (rb + z) * both;
    const Lanes lb = slope + r.j3, ub = slope - r.j3;
    const Lanes low2 = low * low, high2 = high * high;
    const Lanes first = high - low, second = high2 + low2;
    const Lanes cross = lb * low2 - ub * high2;
    d.g0 += g * r.a2 - lb * low - ub * high;
    d.g1 += g * r.a1 + r.j2 * first;
    d.g2 += r.j1 * first;
    d.h00 += q * r.a2 * r.a2 + lb * lb * low2 + ub * ub * high2;
    d.h01 += q * r.a2 * r.a1 + cross * r.j2;
    d.h02 += cross * r.j1;
    d.h11 += q * r.a1 * r.a1 + second * r.j2 * r.j2;
    d.h12 += second * r.j2 * r.j1;
    d.h22 += second * r.j1 * r.j1;
}

/// The products of the two forms of a norm with a state.
struct NormState {
    Lanes qa, qb;      ///< products of the acceleration form, by a and b
    Lanes zw, za, zb;  ///< products of the jerk form, by w, a and b
};

[[gnu::always_inline]] inline NormState norm_of(const NormLanes &n, const State &s) noexcept {
    return {n.aa * s.a + n.ab * s.b, n.ab * s.a + n.bb * s.b, n.jww * s.w + n.jwa * s.a + n.jwb * s.b,
            n.jwa * s.w + n.jaa * s.a + n.jab * s.b, n.jwb * s.w + n.jab * s.a + n.jbb * s.b};
}

/// Bound of the squared jerk, (1 - k b)^2/b, and minus its slope. It is convex, too.
[[gnu::always_inline]] inline JerkBound norm_bound(const State &s, const Lanes &per_b,
                                                   const Lanes &k) noexcept {
    const Lanes left = 1.0 - k * s.b;
    return {per_b * left * left, per_b * per_b - k * k};
}

/// Adds the barriers -log(1 - acceleration^2) and -log(bound - jerk^2), with the tangent of the bound.
[[gnu::always_inline]] inline void add_norm(const State &s, const NormLanes &n, const Lanes &per_b,
                                            Slopes &d) noexcept {
    const NormState m = norm_of(n, s);
    const Lanes t = 1.0 / (1.0 - m.qa * s.a - m.qb * s.b), t4 = 4.0 * t * t;
    const JerkBound bound = norm_bound(s, per_b, n.k);
    const Lanes r = 1.0 / (bound.value - m.zw * s.w - m.za * s.a - m.zb * s.b), r2 = r * r;
    const Lanes eb = 2.0 * m.zb + bound.slope, ea = 2.0 * m.za, ew = 2.0 * m.zw;
    d.g0 += 2.0 * m.qb * t + eb * r;
    d.g1 += 2.0 * m.qa * t + ea * r;
    d.g2 += ew * r;
    d.h00 += 2.0 * (n.bb * t + n.jbb * r) + t4 * m.qb * m.qb + eb * eb * r2;
    d.h01 += 2.0 * (n.ab * t + n.jab * r) + t4 * m.qb * m.qa + eb * ea * r2;
    d.h02 += 2.0 * n.jwb * r + eb * ew * r2;
    d.h11 += 2.0 * (n.aa * t + n.jaa * r) + t4 * m.qa * m.qa + ea * ea * r2;
    d.h12 += 2.0 * n.jwa * r + ea * ew * r2;
    d.h22 += 2.0 * n.jww * r + ew * ew * r2;
}

/// Transforms the derivatives: (b, a, w) = M y with the rows (1, weight_1, weight_2), (0, 1 - x, x), (0, -1,
/// 1).
[[gnu::always_inline]] inline void add_in_local(const Slopes &d, double x, Slopes &y) noexcept {
    const double m1 = weight_1(x), m2 = weight_2(x), n1 = 1 - x, n2 = x;
    const Lanes t1 = m1 * d.h00 + n1 * d.h01 - d.h02, t2 = m2 * d.h00 + n2 * d.h01 + d.h02;
    const Lanes a1 = m1 * d.h01 + n1 * d.h11 - d.h12, a2 = m2 * d.h01 + n2 * d.h11 + d.h12;
    const Lanes w1 = m1 * d.h02 + n1 * d.h12 - d.h22, w2 = m2 * d.h02 + n2 * d.h12 + d.h22;
    y.g0 += d.g0;
    y.g1 += m1 * d.g0 + n1 * d.g1 - d.g2;
    y.g2 += m2 * d.g0 + n2 * d.g1 + d.g2;
    y.h00 += d.h00;
    y.h01 += t1;
    y.h02 += t2;
    y.h11 += m1 * t1 + n1 * a1 - w1;
    y.h12 += m1 * t2 + n1 * a2 - w2;
    y.h22 += m2 * t2 + n2 * a2 + w2;
}

/// Inverse of the maximum step within the slacks 1 - u and 1 + u, and within those of the jerk.
[[gnu::always_inline]] inline Lanes inverse_step(const State &s, const State &ds, const RowLanes &r,
                                                 const JerkBound &of_root) noexcept {
    const JerkBound bound = jerk_bound(s, of_root, r.k);
    const Lanes rb = bound.value, slope = bound.slope * ds.b;
    const Lanes u = r.a1 * s.a + r.a2 * s.b, du = r.a1 * ds.a + r.a2 * ds.b;
    const Lanes z = r.j1 * s.w + r.j2 * s.a + r.j3 * s.b, dz = r.j1 * ds.w + r.j2 * ds.a + r.j3 * ds.b;
    const auto [t, both] = inverse_of(1.0 - u * u, rb * rb - z * z);
    return larger(larger(du * (1.0 + u) * t, -du * (1.0 - u) * t),
                  larger((dz - slope) * (rb + z) * both, (-dz - slope) * (rb - z) * both));
}

/// The slack after a step t is at least s - t g - t^2 q. Its root gives 1/t = (g + sqrt(g^2 + 4 s q))/(2 s).
[[gnu::always_inline]] inline Lanes inverse_root(const Lanes &s, const Lanes &g, const Lanes &q) noexcept {
    return (g + root(g * g + 4.0 * s * q)) / (2.0 * s);
}

[[gnu::always_inline]] inline Lanes inverse_step(const State &s, const State &ds, const NormLanes &n,
                                                 const Lanes &per_b) noexcept {
    const NormState m = norm_of(n, s), d = norm_of(n, ds);
    const Lanes acceleration = inverse_root(1.0 - m.qa * s.a - m.qb * s.b, 2.0 * (m.qa * ds.a + m.qb * ds.b),
                                            d.qa * ds.a + d.qb * ds.b);
    const JerkBound bound = norm_bound(s, per_b, n.k);
    const Lanes jerk = inverse_root(bound.value - m.zw * s.w - m.za * s.a - m.zb * s.b,
                                    2.0 * (m.zw * ds.w + m.za * ds.a + m.zb * ds.b) + bound.slope * ds.b,
                                    d.zw * ds.w + d.za * ds.a + d.zb * ds.b);
    return larger(acceleration, jerk);
}

}  // namespace

void TimeLaw::begin(const Rows &rows, double before, double behind) {
    rows_ = &rows;
    const std::size_t padded = rows.blocks() * LANES;
    h_.assign(padded + 2, behind);
    for (std::size_t k = 0; k < rows.cells(); ++k) {
        h_[k] = rows.length(k);
    }
    alpha_.assign(padded + 2, 0.0);
    alpha_[0] = 1 / (before + h_[0]);
    for (std::size_t k = 1; k < alpha_.size(); ++k) {
        alpha_[k] = 1 / (h_[k - 1] + h_[k]);
    }
    c_.assign(padded + 2, 1.0);
    floors_.assign(padded + 2, 0.0);
}

/// Calculates the gradient and the Hessian by the coefficients of the objective divided by mu plus the
/// barriers of all rows.
MW_WIDE void TimeLaw::assemble(double mu, const Range &range) {
    const auto from = static_cast<long>(range.first_block * LANES),
               to = static_cast<long>(range.last_block * LANES + 2);
    std::fill(gradient_.begin() + from, gradient_.begin() + to, 0.0);
    for (auto &d : diagonal_) {
        std::fill(d.begin() + from, d.begin() + to, 0.0);
    }
    // Positive coefficients keep b positive everywhere, also between the points.
    for (std::size_t i = range.first; i < range.last; ++i) {
        const double per_slack = 1 / (c_[i] - floors_[i]);
        gradient_[i] = weights_[i] / mu - per_slack;
        diagonal_[0][i] = per_slack * per_slack;
    }
    for (std::size_t block = range.first_block; block < range.last_block; ++block) {
        const std::size_t k = block * LANES;
        const Lanes h = load(&h_[k]);
        const Weights m{h * load(&alpha_[k]), h * load(&alpha_[k + 1]), real_lanes(k, cells())};
        Local y = local_of(m, &c_[k]);
        y.y0 += 1.0 - m.real;
        Slopes in_y;
        for (std::size_t p = 0; p < PLACES; ++p) {
            const State s = state_of(y, PLACE_PART[p]);
            const Lanes rb = 1.0 / root(s.b), per_b = rb * rb;
            const Lanes slope = -0.5 * rb * per_b;
            const Lanes weight = (SIMPSON[p] / mu) * h * m.real * time_weight_;
            Slopes d;
            d.g0 = weight * slope;
            const Lanes level = level_ * m.real;
            d.g0 -= level * per_b;
            d.h00 = (0.75 * weight * rb + level) * per_b * per_b;
            add_velocity(s, rows_->velocity_lanes(block, p), d);
            const RowLanes *row = rows_->row_lanes(block, p);
            for (std::size_t i = 0; i < rows_->coordinates(); ++i) {
                add_row(s, row[i], {rb, slope}, d);
            }
            if (rows_->hasNorm()) {
                add_norm(s, rows_->norm_lanes(block, p), per_b, d);
            }
            add_in_local(d, PLACE_PART[p], in_y);
        }
        // y = N c with the rows (A, C, 0), (-A, A, 0), (0, -B, B), C = 1 - A.
        const Slopes &e = in_y;
        const Lanes A = m.a * m.real, B = m.b * m.real, C = m.real - A;
        const Lanes q0 = A * (e.h00 - e.h01), q1 = A * (e.h01 - e.h11), q2 = A * (e.h02 - e.h12);
        const Lanes r0 = C * e.h00 + A * e.h01 - B * e.h02, r1 = C * e.h01 + A * e.h11 - B * e.h12,
                    r2 = C * e.h02 + A * e.h12 - B * e.h22;
        add_to(&gradient_[k], A * (e.g0 - e.g1));
        add_to(&gradient_[k + 1], C * e.g0 + A * e.g1 - B * e.g2);
        add_to(&gradient_[k + 2], B * e.g2);
        add_to(&diagonal_[0][k], A * (q0 - q1));
        add_to(&diagonal_[1][k], C * q0 + A * q1 - B * q2);
        add_to(&diagonal_[2][k], B * q2);
        add_to(&diagonal_[0][k + 1], C * r0 + A * r1 - B * r2);
        add_to(&diagonal_[1][k + 1], B * r2);
        add_to(&diagonal_[0][k + 2], B * B * e.h22);
    }
}

/// Factorises LDL' with half bandwidth 2 on the coefficients [first, last), and calculates the step.
void TimeLaw::factorise(const Range &range) {
    const std::size_t first = range.first, last = range.last;
    std::vector<double> &D = diagonal_[0], &E = diagonal_[1], &F = diagonal_[2];
    for (std::size_t i = first; i < last; ++i) {
        double d = D[i], e = E[i], g = -gradient_[i];
        if (i >= first + 2) {
            const double f = F[i - 2];
            d -= f * f * D[i - 2];
            g -= f * step_[i - 2];
        }
        if (i >= first + 1) {
            const double l = E[i - 1];
            d -= l * l * D[i - 1];
            e -= l * F[i - 1] * D[i - 1];
            g -= l * step_[i - 1];
        }
        d = std::max(d, LEAST_PIVOT * D[i]);
        const double per = 1 / d;
        D[i] = d;
        E[i] = e * per;
        F[i] *= per;
        step_[i] = g;
    }
    decrement_ = 0;
    for (std::size_t i = last; i-- > first;) {
        double x = step_[i] / D[i];
        x -= i + 1 < last ? E[i] * step_[i + 1] : 0.0;
        x -= i + 2 < last ? F[i] * step_[i + 2] : 0.0;
        step_[i] = x;
        decrement_ -= gradient_[i] * x;
    }
}

/// The step to the nearest row, as a fraction of the Newton step.
MW_WIDE double TimeLaw::longest_step(const Range &range) const {
    Lanes worst{};
    for (std::size_t block = range.first_block; block < range.last_block; ++block) {
        const std::size_t k = block * LANES;
        const Lanes h = load(&h_[k]);
        const Weights m{h * load(&alpha_[k]), h * load(&alpha_[k + 1]), real_lanes(k, cells())};
        Local y = local_of(m, &c_[k]);
        y.y0 += 1.0 - m.real;
        const Local dy = local_of(m, &step_[k]);
        for (std::size_t p = 0; p < PLACES; ++p) {
            const State s = state_of(y, PLACE_PART[p]), ds = state_of(dy, PLACE_PART[p]);
            const Lanes rb = 1.0 / root(s.b), per_b = rb * rb;
            const Lanes slope = -0.5 * rb * per_b;
            const Lanes v2 = rows_->velocity_lanes(block, p);
            worst = larger(worst, v2 * ds.b / (1.0 - s.b * v2));
            const RowLanes *row = rows_->row_lanes(block, p);
            for (std::size_t i = 0; i < rows_->coordinates(); ++i) {
                worst = larger(worst, inverse_step(s, ds, row[i], {rb, slope}));
            }
            if (rows_->hasNorm()) {
                worst = larger(worst, inverse_step(s, ds, rows_->norm_lanes(block, p), per_b));
            }
        }
    }
    double most = 1e-300;
    for (std::size_t i = range.first; i < range.last; ++i) {
        most = std::max(most, -step_[i] / (c_[i] - floors_[i]));
    }
    for (std::size_t i = 0; i < LANES; ++i) {
        most = std::max(most, worst[i]);
    }
    return 1 / most;
}

double TimeLaw::newton(double mu, const Range &range) {
    assemble(mu, range);
    factorise(range);
    if (!std::isfinite(decrement_)) {
        return 0;  // the factorisation failed because of rounding: the coefficients do not change
    }
    const double t = std::min(1.0, KEEP * longest_step(range));
    for (std::size_t i = range.first; i < range.last; ++i) {
        c_[i] += t * step_[i];
    }
    return t;
}

int TimeLaw::solve(std::size_t fixed_start, std::size_t fixed_end, const SolveSettings &settings) {
    const std::size_t last = cells() + 2 - fixed_end;
    if (last <= fixed_start) {
        return 0;
    }
    // A coefficient affects the cell of its number and the two cells before it.
    const Range range{fixed_start, last, (std::max<std::size_t>(fixed_start, 2) - 2) / LANES,
                      std::min(rows_->blocks(), (last - 1) / LANES + 1)};
    gradient_.resize(c_.size());
    step_.assign(c_.size(), 0.0);
    for (auto &d : diagonal_) {
        d.resize(c_.size());
    }
    const bool is_time = settings.objective == Objective::TIME;
    level_ =
        Lanes{} + (is_time ? 0.0 : static_cast<double>(rows_->coordinates()) + (rows_->hasNorm() ? 1 : 0));
    time_weight_ = Lanes{} + (is_time ? 1 / settings.cell_s : 0.0);
    weights_.assign(c_.size(), 0.0);
    for (std::size_t i = 0; i < cells() + 2 && !is_time; ++i) {  // the rest is padding
        const double reference = settings.reference != nullptr ? settings.reference[i] : c_[i];
        weights_[i] = 1 / (floors_[i] > 0 ? floors_[i] : reference);
    }
    int steps = 0;
    for (double mu = settings.first_mu;; mu = std::max(mu * settings.factor, settings.last_mu)) {
        for (int i = 0; i < settings.steps_per_mu; ++i) {
            const double t = newton(mu, range);
            ++steps;
            if (t == 0) {
                return steps;
            }
            if (t == 1.0 && decrement_ < ENOUGH * static_cast<double>(cells())) {
                break;
            }
        }
        if (mu <= settings.last_mu) {
            return steps;
        }
    }
}

LawState TimeLaw::state(std::size_t k, double x) const noexcept {
    const double h = h_[k];
    const double rise = h * alpha_[k];
    const double y0 = c_[k + 1] + rise * (c_[k] - c_[k + 1]);
    const double y1 = rise * (c_[k + 1] - c_[k]);
    const double y2 = h * alpha_[k + 1] * (c_[k + 2] - c_[k + 1]);
    return {y0 + weight_1(x) * y1 + weight_2(x) * y2, ((1 - x) * y1 + x * y2) / h, (y2 - y1) / (h * h)};
}

double TimeLaw::time_of(std::size_t cell) const noexcept {
    // Gauss quadrature with four points.
    constexpr std::array<double, 4> X{0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                      0.9305681557970262};
    constexpr std::array<double, 4> W{0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                      0.17392742256872692};
    double sum = 0;
    for (std::size_t i = 0; i < X.size(); ++i) {
        sum += W[i] / std::sqrt(state(cell, X[i]).b);
    }
    return sum * h_[cell];
}

double TimeLaw::time() const noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < cells(); ++k) {
        sum += time_of(k);
    }
    return sum;
}

double TimeLaw::worst_at(std::size_t cell, std::size_t place) const noexcept {
    const LawState s = state(cell, PLACE_PART[place]);
    return std::max(std::sqrt(std::max(0.0, s.b * rows_->velocity(cell, place))),
                    rows_->worst(cell, place, s));
}

double TimeLaw::worst() const noexcept {
    double worst = 0;
    for (std::size_t k = 0; k < cells(); ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            worst = std::max(worst, worst_at(k, p));
        }
    }
    return worst;
}

}  // namespace mw::trajectory::profile
