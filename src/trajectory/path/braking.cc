// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/braking.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

constexpr std::size_t INTERVALS = Braking::PARTS;
constexpr std::size_t MOST = std::max<std::size_t>(geometry::AXIS_COUNT, MAX_JOINTS);

/// One interval of a piece as one coordinate sees it: first and second derivatives by the path at both ends,
/// and the largest of both within.
struct Interval {
    double first, first_after, second, second_after;
    double most_first, most_second;

    /// Braking relieves what turning takes, all along it.
    bool isAgainst() const noexcept { return first * second >= 0 && first_after * second_after >= 0; }
};

/// A coordinate that moves on a piece.
struct Coordinate {
    std::size_t number;  ///< axis or joint
    std::array<Interval, INTERVALS> on;

    /// From its derivatives at the ends of the intervals.
    void take(std::size_t n, const std::array<double, INTERVALS + 1> &first, double interval) noexcept {
        number = n;
        for (std::size_t k = 0; k < INTERVALS; ++k) {
            // Differences change from one interval to the next as they do within one.
            const double *const q = &first[std::min(k, INTERVALS - 3)];
            const double *const r = &first[std::min(k, INTERVALS - 2)];
            const double mean = (first[k + 1] - first[k]) / interval;
            const double change = r[2] - 2 * r[1] + r[0];
            const double third = q[3] - 3 * (q[2] - q[1]) - q[0];
            Interval &to = on[k];
            to.first = first[k];
            to.first_after = first[k + 1];
            to.second = mean - 0.5 * change / interval;
            to.second_after = mean + 0.5 * change / interval;
            // A parabola leaves its chord by an eighth of the second difference.
            to.most_first = std::max(std::abs(to.first), std::abs(to.first_after)) + 0.125 * std::abs(change);
            to.most_second =
                std::max(std::abs(to.second), std::abs(to.second_after)) + 0.5 * std::abs(third) / interval;
        }
    }
};
/// Those that move; what is behind them has no value.
struct Coordinates {
    std::array<Coordinate, MOST> items;
    std::size_t count = 0;

    std::size_t size() const noexcept { return count; }
    const Coordinate &operator[](std::size_t i) const noexcept { return items[i]; }
    const Coordinate *begin() const noexcept { return items.data(); }
    const Coordinate *end() const noexcept { return items.data() + count; }
};

/// What braking asks of one coordinate on an interval.
struct Demand {
    double shared = 0;   ///< largest first derivative where turning and braking pull the same way
    double turning = 0;  ///< largest second derivative
    double alone = 0;    ///< largest first derivative where they pull against each other
    double acceleration = UNLIMITED;
    bool isRightAngled = false;  ///< turning is across the path, or pulls forward along it
    double forward = UNLIMITED;  ///< by at least so much of a unit of b, of a vector [unit/s^2]

    void add(double first, double second, bool isAgainst) noexcept {
        double &of = isAgainst ? alone : shared;
        of = std::max(of, first * BrakingTuning::MARGIN);
        turning = std::max(turning, second * BrakingTuning::MARGIN);
    }
    /// Deceleration that is available at the squared speed b.
    double room(double b) const noexcept {
        const double limit = acceleration * (1.0 - LimitTuning::ACCELERATION_MARGIN);
        const double used = std::min(limit, turning * b);
        // |centripetal b - shared braking| <= limit: a forward pull is braked first. Motion continues with
        // this value where it is slower and has no such pull: not more than at standstill.
        const double pull = std::min(forward * b, used);
        const double across = std::sqrt(std::max(0.0, pull * pull + limit * limit - used * used));
        const double left = isRightAngled ? std::min(limit, pull + across) : limit - used;
        return std::min(alone > 0 ? limit / alone : UNLIMITED, shared > 0 ? left / shared : UNLIMITED);
    }
};

/// Products over X Y Z at one end of an interval.
struct Norm {
    double first2 = 0, both = 0, second2 = 0;
    void add(double first, double second) noexcept {
        first2 += first * first;
        both += first * second;
        second2 += second * second;
    }
};

/// Of all that moves, and of the norm over X Y Z.
struct Demands {
    std::array<Demand, MOST> of{};
    Demand norm;

    double room(double b, std::size_t count) const noexcept {
        double room = norm.room(b);
        for (std::size_t i = 0; i < count; ++i) {
            room = std::min(room, of[i].room(b));
        }
        return room;
    }
    void add(const Coordinates &coordinates, std::size_t interval) noexcept {
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            const Interval &at = coordinates[i].on[interval];
            of[i].add(at.most_first, at.most_second, at.isAgainst());
        }
    }
    /// Of a circle, or a helix, in X Y Z: the same everywhere.
    void take_circle(const Primitive &arc) noexcept {
        const double askew = askew_of(arc);
        norm.acceleration *= 1.0 - askew;
        norm.shared = std::hypot(arc.radius * arc.omega, geometry::norm_xyz(arc.lin)) * (1.0 + askew);
        norm.turning = arc.radius * arc.omega * arc.omega * (1.0 + askew);
        norm.forward = 0;
    }
    void add_norm(const Coordinates &axes, std::size_t interval) noexcept {
        Norm before, after;
        for (const Coordinate &axis : axes) {
            if (axis.number < 3) {
                const Interval &at = axis.on[interval];
                before.add(at.first, at.second);
                after.add(at.first_after, at.second_after);
            }
        }
        norm.add(std::sqrt(std::max(before.first2, after.first2)),
                 std::sqrt(std::max(before.second2, after.second2)), false);
        norm.isRightAngled = norm.isRightAngled && before.both >= 0 && after.both >= 0;
        const double both = std::max(0.0, std::min(before.both, after.both));
        norm.forward = std::min(norm.forward, norm.shared > 0 ? both / norm.shared : 0.0);
    }
};

struct Curve {
    const PathStore &store;
    const Piece &piece;
    const Conditions &conditions;

    double interval() const noexcept { return piece.length / INTERVALS; }
    bool isArc() const noexcept {
        const Primitive &p = store.primitive(piece.primitive);
        return !(piece.blend_d > 0) && p.isArc && p.space == geometry::AXIS_X && isNearlyCircle(p);
    }
    void take_axes(Coordinates &axes) const noexcept {
        Pose at[INTERVALS + 1];
        for (std::size_t n = 0; n <= INTERVALS; ++n) {
            at[n] = derivative_at(store, piece, interval() * static_cast<double>(n));
        }
        for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
            std::array<double, INTERVALS + 1> first{};
            for (std::size_t n = 0; n <= INTERVALS; ++n) {
                first[n] = at[n].c[i];
            }
            keep(axes, i, first);
        }
    }
    /// By differences of the kinematics, of three places within the piece; false where there is a place
    /// without.
    bool take_joints(Coordinates &joints) const noexcept {
        std::array<std::array<double, INTERVALS + 1>, MAX_JOINTS> first{};
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
                    first[j][n] += weights[k] * at[j] / (2.0 * h);
                }
            }
        }
        for (std::size_t j = 0; j < static_cast<std::size_t>(conditions.workspace.joints.count); ++j) {
            keep(joints, j, first[j]);
        }
        return true;
    }
    void keep(Coordinates &to, std::size_t number,
              const std::array<double, INTERVALS + 1> &first) const noexcept {
        if (std::ranges::any_of(first, [](double d) { return d != 0; })) {
            to.items[to.count++].take(number, first, interval());
        }
    }
};

/// With what axes may do; the norm has no limit where none is asked for.
Demands demands_of(const Coordinates &axes, const PathLimits &limits) noexcept {
    Demands d;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        d.of[i].acceleration = limits.wanted().acceleration[axes[i].number];
    }
    d.norm.acceleration = limits.wanted().acceleration[XYZ_NORM];
    d.norm.isRightAngled = true;
    return d;
}

Demands demands_of(const Coordinates &joints, const JointLimits &limits) noexcept {
    Demands d;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::size_t j = joints[i].number;
        d.of[i].acceleration = limits.acceleration[j];
    }
    return d;
}

/// There is next to nothing to be gained on a piece that is over at once, or where turning at the highest
/// speed leaves enough.
bool isWorthALook(const PathStore &store, const Piece &piece, bool isMapped,
                  const SpeedLimit &limit) noexcept {
    // Lines are curves for joints that are not axes.
    const Primitive &p = store.primitive(piece.primitive);
    const bool isCurved = isMapped || piece.blend_d > 0 || p.isArc;
    const bool isSweeping =
        !(piece.blend_d > 0) && p.isArc && std::abs(p.omega) * piece.length > BrakingTuning::SWEEP;
    return isCurved && limit.v < 1e100 && piece.length > BrakingTuning::SHORT_S * limit.v &&
           (isSweeping || limit.a.at(limit.v * limit.v) < BrakingTuning::ENOUGH * limit.a.at(0));
}

bool areAlike(const Braking::Part &low, const Braking::Part &high) noexcept {
    for (std::size_t k = 0; k < low.size(); ++k) {
        if (high[k] > static_cast<float>(BrakingTuning::LIKE) * low[k]) {
            return false;
        }
    }
    return true;
}

/// Neighbours that allow nearly the same allow what all of them do.
void join_like(std::array<Braking::Part, Braking::PARTS> &parts) noexcept {
    for (std::size_t from = 0, next = 0; from < parts.size(); from = next) {
        Braking::Part low = parts[from];
        Braking::Part high = low;
        for (next = from + 1; next < parts.size(); ++next) {
            Braking::Part lower = low;
            Braking::Part higher = high;
            for (std::size_t k = 0; k < low.size(); ++k) {
                lower[k] = std::min(low[k], parts[next][k]);
                higher[k] = std::max(high[k], parts[next][k]);
            }
            if (!areAlike(lower, higher)) {
                break;
            }
            low = lower;
            high = higher;
        }
        std::fill(parts.begin() + static_cast<std::ptrdiff_t>(from),
                  parts.begin() + static_cast<std::ptrdiff_t>(next), low);
    }
}

}  // namespace

float lesser_float(double x) noexcept {
    constexpr double ROUNDING = 1e-7;
    return static_cast<float>(std::min(x, 1e30) * (1.0 - ROUNDING));
}

Braking braking_on(const PathStore &store, const Piece &piece, const Conditions &conditions,
                   const SpeedLimit &limit) noexcept {
    if (!isWorthALook(store, piece, conditions.workspace.isMapped(), limit)) {
        return {};
    }
    const Curve curve{store, piece, conditions};
    const Workspace &workspace = conditions.workspace;
    Coordinates axes;
    Coordinates joints;
    curve.take_axes(axes);
    if (workspace.isMapped() && !curve.take_joints(joints)) {
        return {};
    }
    Braking out{limit.v * limit.v, {}};
    bool isGain = false;
    for (std::size_t n = 0; n < INTERVALS; ++n) {
        Demands by_axes = demands_of(axes, conditions.limits);
        Demands by_joints = demands_of(joints, workspace.joints);
        by_axes.add(axes, n);
        if (curve.isArc()) {
            by_axes.take_circle(store.primitive(piece.primitive));
        } else {
            by_axes.add_norm(axes, n);
        }
        by_joints.add(joints, n);
        for (std::size_t k = 0; k < out.nodes().size(); ++k) {
            const double b = out.nodes()[k] * out.top;
            const double room = std::min(by_axes.room(b, axes.size()), by_joints.room(b, joints.size()));
            out.parts[n][k] = lesser_float(room);
            isGain = isGain || room > BrakingTuning::LEAST_GAIN * limit.a.at(b);
        }
    }
    if (!isGain) {
        return {};
    }
    join_like(out.parts);
    return out;
}

}  // namespace mw::trajectory
