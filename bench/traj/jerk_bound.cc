// SPDX-License-Identifier: GPL-2.0-or-later
// Nodes p_i are placed along the path, approximately at equal time intervals. The unknown b_i = (du/dt)^2 is
// the squared
// speed at node i, in nodes per period. Then
// a_i = (p_{i+1} - 2 p_i + p_{i-1}) b_i + (p_{i+1} - p_{i-1}) (b_{i+1} - b_{i-1})/8,
// j_{i+1/2} = sqrt(b_{i+1/2}) (a_{i+1} - a_i):
// at b = 1 these are the values that a checker of samples calculates. An interior-point method minimizes the
// sum of 1/sqrt(b),
// first with fixed p, then with p free across the path within P. After each pass the nodes are redistributed
// at equal intervals of the resulting time.
#include "traj/jerk_bound.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "traj/banded.hh"
#include "traj/laying.hh"

namespace mw::bench {

namespace {

constexpr std::size_t STENCIL = 4;  ///< number of nodes on which a jerk depends
constexpr int STEPS = 15;
constexpr double LEAST_MU = 4e-5, TIE = 10.0, TIES = 0.02, STIFF = 1e-7;

/// A product that stays within the range of double; its logarithm is the sum of the logarithms of its
/// factors.
class Slacks {
  public:
    /// Returns false if x is outside.
    bool take(double x) {
        product_ *= x;
        if (product_ < 1e-200 || product_ > 1e200) {
            logs_ += std::log(product_);
            product_ = 1;
        }
        return x > 0;
    }
    double log() const { return logs_ + std::log(product_); }

  private:
    double logs_ = 0, product_ = 1;
};

/// The interior-point method.
class Pass : protected Laying {
  public:
    using Laying::Laying;

    Trajectory run(bool isFree) {
        lay_slowly();
        Trajectory best;
        for (int round = 0; round < (isFree ? 6 : 3); ++round) {
            tie_ = round < 1 ? 0.0 : TIES;
            sides_ = round < 3 ? 0 : axes_ - 1;
            if (!solve(round < 1 ? 0.3 : 0.1, round < 2 ? 400.0 : 4.0)) {
                break;
            }
            const Trajectory t = sampled();
            best = t.time_s < best.time_s ? t : best;
            if (round >= 3 && !(t.time_s < 1.2 * best.time_s)) {
                break;
            }
            lay(even(FINE_PERIOD), round >= 3);
        }
        return best;
    }

  private:
    /// Objective with barriers; infinite outside.
    double merit(const Nodes &n, double mu, double trust) const {
        double sum = 0;
        Slacks slacks;
        Row last{};
        for (std::size_t i = 1; i + 1 < n.b.size(); ++i) {
            const double b = n.b[i];
            if (!slacks.take(b) || !slacks.take(trust - b)) {
                return 1e300;
            }
            sum += (isPad(i) ? TIE : tie_) * square(b - n.b[i < PAD ? i + 1 : i - 1]);
            sum += isPad(i) ? 0.0 : 1.0 / std::sqrt(b);
            const double root = std::sqrt(0.5 * (b + n.b[i - 1]));
            double way = 0;
            for (std::size_t k = 0; k < axes_; ++k) {
                const double step = n.q[i][k] - n.q[i - 1][k];
                const double a = acceleration(n, i, k);
                const double v = step * v_scale_[k] * root;
                const double x = a * a_scale_[k];
                const double j = i > 1 ? (a - last[k]) * root * j_scale_[k] : 0.0;
                last[k] = a;
                way += square(step);
                if (!slacks.take(1.0 - v * v) || !slacks.take(1.0 - x * x) || !slacks.take(1.0 - j * j)) {
                    return 1e300;
                }
            }
            if (feed_[i] > 0 && !slacks.take(1.0 - std::sqrt(way) * root * feed_[i])) {
                return 1e300;
            }
            const auto [lengths, angles] = off(n, i);
            if (sides_ > 0 && !isExact_[i] &&
                (!slacks.take(tube_[i] - lengths) || !slacks.take(tube_[i] - angles))) {
                return 1e300;
            }
        }
        return sum - mu * slacks.log();
    }

    /// A linear function of the unknowns of a few consecutive nodes.
    struct Slope {
        std::size_t first = 0, nodes = 0;
        std::array<double, STENCIL> by_b{}, by_q{};
        std::size_t axis = 0;
    };

    /// Adds gradient and curvature of a function with a known slope. slope.by_q contains derivatives along
    /// slope.axis.
    void add(const Slope &slope, double gradient, double curvature) {
        std::array<double, STENCIL * MOST_AXES> row;
        const std::size_t width = 1 + sides_;
        for (std::size_t r = 0; r < slope.nodes; ++r) {
            row[r * width] = slope.by_b[r];
            for (std::size_t c = 0; c < sides_; ++c) {
                row[r * width + 1 + c] = slope.by_q[r] * side_[slope.first + r][c][slope.axis];
            }
        }
        add_row(slope.first * width, slope.nodes * width, row.data(), gradient, curvature);
    }

    void add_row(std::size_t at, std::size_t count, const double *row, double gradient, double curvature) {
        for (std::size_t r = 0; r < count; ++r) {
            gradient_[at + r] += gradient * row[r];
            for (std::size_t c = 0; c <= r; ++c) {
                hessian_.at(at + r, r - c) += curvature * row[r] * row[c];
            }
        }
    }

    /// Adds -mu log(1 - x^2) for x with this slope.
    void add_barrier(const Slope &slope, double x, double mu) {
        const double up = 1.0 / (1.0 - x);
        const double down = 1.0 / (1.0 + x);
        add(slope, mu * (up - down), mu * (up * up + down * down));
    }

    void add_place(std::size_t i, double mu, double trust) {
        const std::size_t at = i * (1 + sides_);
        const double b = n_.b[i];
        const double room = trust - b;
        gradient_[at] += mu / room - mu / b;
        hessian_.at(at, 0) += mu / (b * b) + mu / (room * room);
        const double tie = isPad(i) ? TIE : tie_;
        const std::size_t low = i < PAD ? i : i - 1;
        add({low, 2, {-1, 1}, {}, 0}, 2.0 * tie * (n_.b[low + 1] - n_.b[low]), 2.0 * tie);
        if (!isPad(i)) {
            gradient_[at] -= 0.5 / (b * std::sqrt(b));
            hessian_.at(at, 0) += 0.75 / (b * b * std::sqrt(b));
        }
        for (std::size_t c = 1; c <= sides_; ++c) {
            hessian_.at(at + c, 0) += STIFF;
        }
    }

    /// The barrier of the tube.
    void add_tube(std::size_t i, double mu) {
        const auto outside = off(n_, i);
        const double p2 = square(TUBE * program_.tolerance);
        for (const bool isAngular : {false, true}) {
            const double room = tube_[i] - outside[isAngular ? 1 : 0];
            std::array<double, MOST_AXES> row{};
            for (std::size_t k = 0; k < axes_; ++k) {
                if (geometry::isAngular(axis_[k]) != isAngular) {
                    continue;
                }
                Slope slope{i, 1, {}, {1}, k};
                add(slope, 0, mu * 2.0 / (p2 * room));
                for (std::size_t c = 0; c < sides_; ++c) {
                    row[1 + c] += 2.0 * (n_.q[i][k] - programmed_[i][k]) / p2 * side_[i][c][k];
                }
            }
            add_row(i * (1 + sides_), 1 + sides_, row.data(), mu / room, mu / square(room));
        }
    }

    Slope slope_of_acceleration(std::size_t i, std::size_t k) const {
        const double half = 0.125 * (n_.q[i + 1][k] - n_.q[i - 1][k]);
        const double change = 0.125 * (n_.b[i + 1] - n_.b[i - 1]);
        const double b = n_.b[i];
        Slope slope{i - 1, 3, {}, {}, k};
        slope.by_b = {-half, n_.q[i + 1][k] - 2.0 * n_.q[i][k] + n_.q[i - 1][k], half, 0};
        slope.by_q = {b - change, -2.0 * b, b + change, 0};
        return slope;
    }

    static Slope scaled(Slope slope, double factor) {
        for (std::size_t r = 0; r < STENCIL; ++r) {
            slope.by_b[r] *= factor;
            slope.by_q[r] *= factor;
        }
        return slope;
    }

    void add_limits(std::size_t i, std::size_t k, double mu) {
        const double root = std::sqrt(0.5 * (n_.b[i] + n_.b[i - 1]));
        const double step = n_.q[i][k] - n_.q[i - 1][k];
        const double by_root = 0.25 / root;
        add_barrier(scaled({i - 1, 2, {step * by_root, step * by_root}, {-root, root}, k}, v_scale_[k]),
                    step * v_scale_[k] * root, mu);
        const Slope now = slope_of_acceleration(i, k);
        const double a = acceleration(n_, i, k);
        add_barrier(scaled(now, a_scale_[k]), a * a_scale_[k], mu);
        if (i < 2) {
            return;
        }
        const Slope before = slope_of_acceleration(i - 1, k);
        const double change = a - acceleration(n_, i - 1, k);
        Slope slope{i - 2, 4, {}, {}, k};
        for (std::size_t r = 0; r < STENCIL; ++r) {
            slope.by_b[r] = root * ((r > 0 ? now.by_b[r - 1] : 0.0) - before.by_b[r]);
            slope.by_q[r] = root * ((r > 0 ? now.by_q[r - 1] : 0.0) - before.by_q[r]);
        }
        slope.by_b[1] += change * by_root;
        slope.by_b[2] += change * by_root;
        add_barrier(scaled(slope, j_scale_[k]), change * root * j_scale_[k], mu);
    }

    void add_feed(std::size_t i, double mu) {
        double way = 0;
        for (std::size_t k = 0; k < axes_; ++k) {
            way += square(n_.q[i][k] - n_.q[i - 1][k]);
        }
        way = std::sqrt(way);
        const double root = std::sqrt(0.5 * (n_.b[i] + n_.b[i - 1]));
        const double room = 1.0 - way * root * feed_[i];
        // A move across the path does not change the distance to first order.
        const double by_b = way * feed_[i] * 0.25 / root;
        add({i - 1, 2, {by_b, by_b}, {}, 0}, mu / room, mu / square(room));
    }

    /// One step of Newton's method (the Gauss-Newton part, damped if necessary). False if it gives no
    /// improvement.
    bool advance(double mu, double trust) {
        const std::size_t width = 1 + sides_;
        gradient_.assign(count() * width, 0.0);
        hessian_.reset(count() * width, STENCIL * width - 1);
        for (std::size_t i = 1; i + 1 < count(); ++i) {
            add_place(i, mu, trust);
            for (std::size_t k = 0; k < axes_; ++k) {
                add_limits(i, k, mu);
            }
            if (feed_[i] > 0) {
                add_feed(i, mu);
            }
            if (sides_ > 0 && !isExact_[i]) {
                add_tube(i, mu);
            }
        }
        for (const std::size_t i : {std::size_t{0}, count() - 1}) {
            for (std::size_t c = 0; c < width; ++c) {
                hessian_.at(i * width + c, 0) += 1.0;
            }
        }
        for (int attempt = 0; attempt < 6; ++attempt) {
            std::vector<double> step = gradient_;
            Banded factors = hessian_;
            for (std::size_t i = 0; i < step.size(); ++i) {
                factors.at(i, 0) *= 1.0 + damping_;
            }
            factors.factor(1e-12);
            factors.solve(step);
            const double size = search(step, mu, trust);
            if (size > 0.9) {
                damping_ = damping_ > 1e-6 ? 0.1 * damping_ : 0.0;
            } else if (size < 0.2 && sides_ > 0) {
                damping_ = std::max(1e-4, 10.0 * damping_);
            }
            if (size > 0 || sides_ == 0) {
                return gain_ > 1e-3 * mu * static_cast<double>(count());
            }
        }
        return false;
    }

    /// Line search along the step; returns the accepted part of it, 0: no improvement.
    double search(const std::vector<double> &step, double mu, double trust) {
        const std::size_t width = 1 + sides_;
        double gain = 0;
        for (std::size_t i = 0; i < step.size(); ++i) {
            gain += gradient_[i] * step[i];
        }
        const double before = merit(n_, mu, trust);
        gain_ = 0;
        Nodes next = n_;
        for (double size = 1.0; size > 1e-3; size *= 0.5) {
            for (std::size_t i = 0; i < count(); ++i) {
                next.b[i] = n_.b[i] - size * step[i * width];
                for (std::size_t k = 0; k < axes_; ++k) {
                    next.q[i][k] = n_.q[i][k];
                    for (std::size_t c = 0; c < sides_; ++c) {
                        next.q[i][k] -= size * step[i * width + 1 + c] * side_[i][c][k];
                    }
                }
            }
            if (merit(next, mu, trust) < before - 0.01 * size * gain) {
                std::swap(n_, next);
                gain_ = size * gain;
                return size;
            }
        }
        return 0;
    }

    /// False if no speed is feasible at the nodes.
    bool solve(double mu, double trust) {
        // Starts from a feasible point: reduces the speed until every slack is positive.
        double slower = 1;
        while (merit(n_, mu, trust) > 1e299 && slower < 50) {
            slower *= 1.02;
            n_.b.assign(count(), 1.0 / slower);
        }
        for (; mu > LEAST_MU && slower < 50; mu *= 0.25) {
            for (int i = 0; i < STEPS && advance(mu, trust); ++i) {
            }
        }
        return slower < 50;
    }

    std::vector<double> gradient_;
    Banded hessian_;
    double damping_ = 0, gain_ = 0;
    double tie_ = 0;  ///< weight of the difference of b between neighbours, which stabilizes the ends
};

}  // namespace

Trajectory time_optimal(const std::vector<Stretch> &stretches, const Program &program, bool isFree) {
    const Track track(stretches);
    return Pass(track, program).run(isFree);
}

Trajectory best_known_trajectory(const Program &program) {
    const Path path = cut_path(program);
    const bool isBlend = program.moves[0].control == geometry::PathMode::BLEND;
    Trajectory best;
    for (const double width : {15.0, 60.0, 200.0}) {
        const Trajectory t = time_optimal(smooth_stretches(path, program.tolerance, width), program, isBlend);
        best = t.time_s < best.time_s ? t : best;
        if (!isBlend) {
            break;
        }
    }
    return best;
}

}  // namespace mw::bench
