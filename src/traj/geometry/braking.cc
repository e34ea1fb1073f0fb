// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/geometry/braking.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "traj/tuning.hh"

namespace mw::traj {

namespace {

constexpr std::size_t INTERVALS = BrakingTuning::INTERVALS;
constexpr std::size_t MOST = std::max<std::size_t>(geom::AXIS_COUNT, MAX_JOINTS);

using PerCoordinate = std::array<double, MOST>;

/// First derivatives by the path, at both ends of every interval of a piece; second ones at the beginning and
/// the end of every interval; and the largest of both within it.
struct Rates {
    std::array<PerCoordinate, INTERVALS + 1> first{};
    std::array<PerCoordinate, INTERVALS> second_before{}, second_after{}, most_first{}, most_second{};

    /// By differences, which change from one interval to the next as they do within one.
    void differentiate(double interval) noexcept {
        for (std::size_t n = 0; n < INTERVALS; ++n) {
            const std::size_t k = std::min(n, INTERVALS - 2);
            const std::size_t m = std::min(n, INTERVALS - 3);
            for (std::size_t i = 0; i < MOST; ++i) {
                const double mean = (first[n + 1][i] - first[n][i]) / interval;
                const double change = first[k + 2][i] - 2 * first[k + 1][i] + first[k][i];
                const double third = first[m + 3][i] - 3 * (first[m + 2][i] - first[m + 1][i]) - first[m][i];
                const double before = second_before[n][i] = mean - 0.5 * change / interval;
                const double after = second_after[n][i] = mean + 0.5 * change / interval;
                // A parabola leaves its chord by an eighth of the second difference.
                most_first[n][i] =
                    std::max(std::abs(first[n][i]), std::abs(first[n + 1][i])) + 0.125 * std::abs(change);
                most_second[n][i] =
                    std::max(std::abs(before), std::abs(after)) + 0.5 * std::abs(third) / interval;
            }
        }
    }
};

/// What braking asks of one coordinate from some interval on to the end of the piece.
struct Demand {
    double shared = 0;   ///< largest first derivative where turning and braking pull the same way
    double turning = 0;  ///< largest second derivative
    double alone = 0;    ///< largest first derivative where they pull against each other
    double acceleration = UNLIMITED;
    bool isRightAngled = false;  ///< turning is across the path, or pulls forward along it

    void add(double first, double second, bool isAgainst) noexcept {
        double &of = isAgainst ? alone : shared;
        of = std::max(of, first * BrakingTuning::MARGIN);
        turning = std::max(turning, second * BrakingTuning::MARGIN);
    }
    /// What is left for braking at the squared speed b.
    double room(double b) const noexcept {
        const double limit = acceleration * (1.0 - LimitTuning::ACCELERATION_MARGIN);
        const double used = std::min(limit, turning * b);
        const double left = isRightAngled ? std::sqrt(limit * limit - used * used) : limit - used;
        return std::min(alone > 0 ? limit / alone : UNLIMITED, shared > 0 ? left / shared : UNLIMITED);
    }
};

/// Of all axes and the norm over X Y Z, or of all joints.
struct Demands {
    std::array<Demand, MOST + 1> of{};
    std::size_t count = 0;

    double room(double b) const noexcept {
        double room = UNLIMITED;
        for (std::size_t i = 0; i < count; ++i) {
            room = std::min(room, of[i].room(b));
        }
        return room;
    }
    void add(const Rates &rates, std::size_t n, std::size_t coordinates) noexcept {
        for (std::size_t i = 0; i < coordinates; ++i) {
            const bool isAgainst = rates.first[n][i] * rates.second_before[n][i] >= 0 &&
                                   rates.first[n + 1][i] * rates.second_after[n][i] >= 0;
            of[i].add(rates.most_first[n][i], rates.most_second[n][i], isAgainst);
        }
    }
    void add_norm(const Rates &rates, std::size_t n, bool isArc) noexcept {
        const auto dot = [](const auto &a, const auto &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
        const auto &q1 = rates.first[n];
        const auto &r1 = rates.first[n + 1];
        const auto &q2 = rates.second_before[n];
        const auto &r2 = rates.second_after[n];
        Demand &norm = of[XYZ_NORM];
        norm.add(std::sqrt(std::max(dot(q1, q1), dot(r1, r1))), std::sqrt(std::max(dot(q2, q2), dot(r2, r2))),
                 false);
        norm.isRightAngled = norm.isRightAngled && (isArc || (dot(q1, q2) >= 0 && dot(r1, r2) >= 0));
    }
};

struct Curve {
    const PathStore &store;
    const Piece &piece;
    const Conditions &conditions;

    double interval() const noexcept { return piece.length / INTERVALS; }
    bool isArc() const noexcept {
        const Primitive &p = store.primitive(piece.primitive);
        return !(piece.blend_d > 0) && p.isArc && p.dradius == 0.0 && p.space == geom::AXIS_X;
    }
    void axis_rates(Rates &rates) const noexcept {
        for (std::size_t n = 0; n <= INTERVALS; ++n) {
            const Pose d = derivative_at(store, piece, interval() * static_cast<double>(n));
            std::copy(d.c.begin(), d.c.end(), rates.first[n].begin());
        }
        rates.differentiate(interval());
    }
    /// By differences of the kinematics, of three places within the piece; false where there is a place
    /// without.
    bool joint_rates(Rates &rates) const noexcept {
        const double h = std::min(JointTuning::STEP, 0.25 * interval());
        for (std::size_t n = 0; n <= INTERVALS; ++n) {
            const double t = n == 0 ? 0.0 : n == INTERVALS ? 2.0 : 1.0;
            const double x = interval() * static_cast<double>(n) - t * h;
            const double weights[3] = {2.0 * t - 3.0, 4.0 - 4.0 * t, 2.0 * t - 1.0};
            for (int k = 0; k < 3; ++k) {
                double at[MAX_JOINTS] = {};
                if (!conditions.workspace.map->joints_at(position_at(store, piece, x + k * h), at)) {
                    return false;
                }
                for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
                    rates.first[n][j] += weights[k] * at[j] / (2.0 * h);
                }
            }
        }
        rates.differentiate(interval());
        return true;
    }
};

Demands axes_at_rest(const PathLimits &limits) noexcept {
    Demands d;
    d.count = LIMITED_COUNT;
    for (std::size_t i = 0; i < LIMITED_COUNT; ++i) {
        d.of[i].acceleration = limits.fitted().acceleration[i];
    }
    d.of[XYZ_NORM].isRightAngled = true;
    return d;
}

Demands joints_at_rest(const JointLimits &joints, double filter_s) noexcept {
    Demands d;
    d.count = static_cast<std::size_t>(joints.count);
    for (std::size_t j = 0; j < d.count; ++j) {
        const double built_up = filter_s > 0 ? joints.jerk[j] * filter_s : UNLIMITED;
        d.of[j].acceleration = std::min(joints.acceleration[j], built_up);
    }
    return d;
}

}  // namespace

Braking braking_on(const PathStore &store, const Piece &piece, const Conditions &conditions,
                   const SpeedLimit &limit) noexcept {
    Braking best{0, limit.a};
    const Curve curve{store, piece, conditions};
    const bool isMapped = conditions.workspace.isMapped();
    const bool isCurved = piece.blend_d > 0 || store.primitive(piece.primitive).isArc;
    Rates axis_rates;
    Rates joint_rates;
    if (!isCurved || piece.isAlong || !(limit.v < 1e100)) {
        return best;
    }
    curve.axis_rates(axis_rates);
    if (isMapped && !curve.joint_rates(joint_rates)) {
        return best;
    }
    Demands axes = axes_at_rest(conditions.limits);
    Demands joints =
        isMapped ? joints_at_rest(conditions.workspace.joints, conditions.limits.filter_s()) : Demands{};
    const double top = limit.v * limit.v;
    const double shared = limit.a.at(top);
    // What a part of the piece is worth is the squared speed that it takes away.
    double worth = BrakingTuning::LEAST_GAIN * shared * piece.length;
    for (std::size_t n = INTERVALS; n-- > 0;) {
        axes.add(axis_rates, n, geom::AXIS_COUNT);
        axes.add_norm(axis_rates, n, curve.isArc());
        joints.add(joint_rates, n, joints.count);
        const double from = curve.interval() * static_cast<double>(n);
        const auto room = [&](double b) { return std::min(axes.room(b), joints.room(b)); };
        const double gain = room(top) * (piece.length - from) + shared * from;
        if (gain >= worth && gain > 0) {
            worth = gain;
            double left[AccelBound::LINES + 1];
            for (int k = 0; k <= AccelBound::LINES; ++k) {
                left[k] = room(LimitTuning::CHORDS[k] * top);
            }
            best = {from, AccelBound::through(left, limit.v)};
        }
    }
    return best;
}

}  // namespace mw::traj
