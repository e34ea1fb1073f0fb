// SPDX-License-Identifier: GPL-2.0-or-later
// Random programs of lines and arcs in up to nine coordinates and of smooth curves divided into chords. They
// have random limits, and run with random holds, overrides, late plans and drops.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/deviation.hh"
#include "trajectory/test/path_rig.hh"

namespace mw::trajectory::test {

struct Program {
    std::vector<Primitive> primitives;
    std::vector<MoveRequest> requests;
    Limits limits;
    double tolerance = 0;
    geometry::PathMode join = geometry::PathMode::BLEND;
    bool isBoxed = false;  ///< the soft limits are the box of the path
};

class Maker {
  public:
    Maker(unsigned seed, bool isJerkLimited)
        : random_(seed), isJerkLimited_(isJerkLimited), isBoxed_(seed / 4 % 2 == 0),
          isMixed_(seed % 8 == 4 || seed % 8 == 6) {}
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    bool chance(double p) { return real(0, 1) < p; }

    Program make() {
        Program p = frame();
        const double size = std::pow(10.0, real(-2, 1.3));
        const int axes = whole(1, 9);
        Pose at;
        wander(p, whole(3, size < 0.3 ? 300 : 60), size, axes, at);
        return p;
    }

    /// A program of at least 50 blocks with a motion of about `seconds` or more.
    Program make_long(bool isCurve, double seconds) {
        Program p = frame();
        double slowest = 1e9;
        double gentlest = 1e9;
        for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
            slowest = std::min(slowest, p.limits.velocity[i]);
            p.limits.acceleration[i] = std::max(p.limits.acceleration[i], 100.0);
            gentlest = std::min(gentlest, p.limits.acceleration[i]);
        }
        if (isCurve) {
            p.join = geometry::PathMode::BLEND;
            p.tolerance = std::pow(10.0, real(-2.5, -1));
            curve(p, whole(100, 600));
        } else {
            double size = std::min(std::pow(10.0, real(-2, 1.3)), 0.1 * slowest);
            size = chance(0.8) ? std::min(size, 0.01 * gentlest) : size;
            const int axes = whole(1, 9);
            Pose at;
            while (p.primitives.size() < 50) {
                wander(p, whole(50, 90), size, axes, at);
            }
        }
        if (isMixed_) {
            mix(p);
        }
        double expected = 0;
        for (std::size_t i = 0; i < p.primitives.size(); ++i) {
            MoveRequest &r = p.requests[i];
            r.isRapid = r.isRapid && chance(0.2);
            r.tag.requested_velocity = r.isRapid ? 0.0 : std::max(r.tag.requested_velocity, 0.1);
            expected += r.isRapid ? 0.0 : p.primitives[i].length / r.tag.requested_velocity;
        }
        for (MoveRequest &r : p.requests) {
            r.tag.requested_velocity *= expected / seconds;
        }
        return p;
    }

    /// Chords of a smooth curve with rounded coordinates, as short as those of CAM systems.
    Program make_curve() {
        Program p = frame();
        p.tolerance = std::pow(10.0, real(-2.5, -1));
        p.join = geometry::PathMode::BLEND;
        for (double &a : p.limits.acceleration) {
            a = std::max(a, 200.0);
        }
        curve(p, whole(100, 600));
        return p;
    }

  private:
    /// Changes path mode and tolerance within the program. No tolerance exceeds that of the program.
    void mix(Program &p) {
        p.join = geometry::PathMode::BLEND;
        p.tolerance = std::pow(10.0, real(-2.5, 0));
        geometry::PathMode join = p.join;
        double tolerance = p.tolerance;
        for (MoveRequest &r : p.requests) {
            if (chance(0.1)) {
                join = chance(0.6)   ? geometry::PathMode::BLEND
                       : chance(0.5) ? geometry::PathMode::EXACT_PATH
                                     : geometry::PathMode::EXACT_STOP;
                tolerance = p.tolerance * std::pow(10.0, real(-1, 0));
            }
            r.join = join;
            r.tolerance = tolerance;
        }
    }
    void wander(Program &p, int count, double size, int axes, Pose &at) {
        for (int n = 0; n < count; ++n) {
            const Primitive q = chance(0.3) && axes >= 2 ? arc(at, size, axes) : line(at, size, axes);
            if (!(q.length > 1e-9)) {
                continue;
            }
            MoveRequest r;
            r.join = p.join;
            r.tolerance = p.tolerance;
            r.isRapid = chance(0.15);
            r.tag.requested_velocity = r.isRapid ? 0.0 : std::pow(10.0, real(0, 2.3));
            r.tag.block = static_cast<std::uint32_t>(n);
            p.primitives.push_back(q);
            p.requests.push_back(r);
            at = q.end;
        }
    }
    void curve(Program &p, int count) {
        const int axes = whole(2, 5);
        const double spacing = std::pow(10.0, real(-1.7, 0));
        const double grid = chance(0.7) ? 1e-4 : 1e-9;
        std::array<double, 5> size{};
        std::array<double, 5> turns{};
        std::array<double, 5> phase{};
        for (std::size_t i = 0; i < 5; ++i) {
            size[i] = std::pow(10.0, real(-0.5, 1));
            turns[i] = std::pow(10.0, real(-1, 0.5)) / size[i];
            phase[i] = real(0, 6);
        }
        const double feed = std::pow(10.0, real(0.5, 2.5));
        Pose at;
        for (int n = 1; n <= count; ++n) {
            Pose to;
            to[0] = chance(0.9) ? spacing * n : at[0];
            for (int i = 1; i < axes; ++i) {
                const auto k = static_cast<std::size_t>(i);
                const double y = size[k] * (std::sin(turns[k] * spacing * n + phase[k]) - std::sin(phase[k]));
                to[i] = std::round(y / grid) * grid;
            }
            push(p, make_line(at, to), feed, n);
            at = to;
        }
    }
    /// A program without moves, with random limits, tolerance and path mode.
    Program frame() {
        Program p;
        for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
            p.limits.velocity[i] = std::pow(10.0, real(0.7, 2.7));
            p.limits.acceleration[i] = std::pow(10.0, real(1.5, 4.0));
        }
        p.limits.velocity[XYZ_NORM] = chance(0.5) ? UNLIMITED : std::pow(10.0, real(1, 2.5));
        p.limits.acceleration[XYZ_NORM] = chance(0.5) ? UNLIMITED : std::pow(10.0, real(2, 4));
        p.limits.isJerkLimited = isJerkLimited_;
        p.isBoxed = isBoxed_;
        p.limits.jerk.fill(UNLIMITED);
        for (std::size_t i = 0; i < geometry::AXIS_COUNT && isJerkLimited_; ++i) {
            p.limits.jerk[i] =
                chance(0.2) ? UNLIMITED : p.limits.acceleration[i] * std::pow(10.0, real(0.9, 2.5));
        }
        p.limits.jerk[XYZ_NORM] = isJerkLimited_ && chance(0.5) ? std::pow(10.0, real(3, 6)) : UNLIMITED;
        p.tolerance = chance(0.2) ? 0.0 : std::pow(10.0, real(-3, 0));
        p.join = chance(0.15)   ? geometry::PathMode::EXACT_STOP
                 : chance(0.15) ? geometry::PathMode::EXACT_PATH
                                : geometry::PathMode::BLEND;
        return p;
    }
    static void push(Program &p, const Primitive &q, double feed, int n) {
        if (!(q.length > 1e-9)) {
            return;
        }
        MoveRequest r;
        r.join = p.join;
        r.tolerance = p.tolerance;
        r.tag.requested_velocity = feed;
        r.tag.block = static_cast<std::uint32_t>(n);
        p.primitives.push_back(q);
        p.requests.push_back(r);
    }
    Primitive line(const Pose &from, double size, int axes) {
        Pose to = from;
        for (int i = 0; i < axes; ++i) {
            if (chance(0.7)) {
                to[i] += size * real(-1, 1) * (chance(0.1) ? 10 : 1);
            }
        }
        return make_line(from, to);
    }
    Primitive arc(const Pose &from, double size, int axes) {
        ArcShape shape;
        shape.isInUvw = axes == 9 && chance(0.3);
        const int space = shape.isInUvw ? geometry::AXIS_U : geometry::AXIS_X;
        const int n = whole(0, 2);
        const int i = space + (n + 1) % 3;
        const int j = space + (n + 2) % 3;
        shape.normal[space + n] = chance(0.5) ? 1 : -1;
        shape.angle_rad = real(0.01, chance(0.2) ? 20 : 6) * (chance(0.5) ? 1 : -1);
        const double radius = size * real(0.05, 2);
        const double phase = real(0, 6.28);
        shape.centre = from;
        shape.centre[i] -= radius * std::cos(phase);
        shape.centre[j] -= radius * std::sin(phase);
        Pose to = from;
        const double swept = phase + shape.angle_rad * shape.normal[space + n];
        const double last = radius * (1 + (chance(0.3) ? real(-1, 1) * 1e-3 : 0.0));
        to[i] = shape.centre[i] + last * std::cos(swept);
        to[j] = shape.centre[j] + last * std::sin(swept);
        for (int k = 3; k < axes; ++k) {
            if (chance(0.3) && (k < space || k > space + 2)) {
                to[k] += size * real(-1, 1);
            }
        }
        if (chance(0.3)) {
            to[space + n] += size * real(-1, 1);
        }
        Primitive p;
        const ArcFault fault = make_arc(from, to, shape, p);
        return fault == ArcFault::NONE ? p : Primitive{};
    }
    std::mt19937 random_;
    bool isJerkLimited_;
    bool isBoxed_;
    bool isMixed_;
};

/// Checks the samples against points of the programmed path with the discrete Frechet distance, in order.
inline bool isInOrder(const std::vector<Pose> &samples, const Program &program, double tolerance) {
    std::vector<Pose> path;
    for (const Primitive &q : program.primitives) {
        const int n = 2 + static_cast<int>(q.length / (0.25 * tolerance));
        for (int i = path.empty() ? 0 : 1; i <= n; ++i) {
            path.push_back(position_at(q, q.length * i / n));
        }
    }
    return testing::isWithinInOrder(samples, path, tolerance);
}

/// Checks the trajectory, interpolated between samples, against the program, in order and in both directions.
/// It adds the distance of the points and the deviation of a curve from the chord of a servo cycle to
/// `allowed`.
inline bool isWithinProgram(const std::vector<Pose> &samples, const Program &program, double allowed) {
    constexpr double SHARE = 0.2, MOST_POINTS = 300000;
    double bulge = 0, length = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        length += testing::pose_distance(samples[i], samples[i - 1]);
        bulge = i < 2 ? 0
                      : std::max(bulge, testing::pose_distance(samples[i] - samples[i - 1],
                                                               samples[i - 1] - samples[i - 2]));
    }
    const double cut = std::max(SHARE * allowed, length / MOST_POINTS);
    const double near = allowed + 0.5 * cut + 0.25 * bulge + 1e-9;
    const std::vector<Pose> fine = testing::refined(samples, cut);
    std::vector<Pose> path;
    for (const Primitive &q : program.primitives) {
        const int n = 2 + static_cast<int>(q.length / cut);
        for (int i = path.empty() ? 0 : 1; i <= n; ++i) {
            path.push_back(position_at(q, q.length * i / n));
        }
    }
    return testing::isWithinInOrder(fine, path, near);
}

/// Extends the box by the programmed path.
inline void room_of(const Program &program, Pose &low, Pose &high) {
    for (const Primitive &q : program.primitives) {
        Pose from;
        Pose to;
        extent(q, from, to);
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            low[i] = std::min(low[i], from[i]);
            high[i] = std::max(high[i], to[i]);
        }
    }
}

/// Maximum distance of samples outside the soft limits, for programs of lines. With arcs, rounded joints may
/// exceed the limits by a part of the tolerance; the result is then 0.
inline double worst_excursion(const std::vector<Pose> &samples, const Program &program) {
    const auto isArc = [](const Primitive &p) { return p.isArc; };
    if (!program.isBoxed || std::ranges::any_of(program.primitives, isArc)) {
        return 0;
    }
    Pose low;
    Pose high;
    room_of(program, low, high);
    double worst = 0;
    for (const Pose &p : samples) {
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            worst = std::max({worst, low[i] - p[i], p[i] - high[i]});
        }
    }
    return worst;
}

/// Maximum deviation of the path from the programmed path; 0: any.
inline double allowed_deviation(const Program &program) {
    if (program.join != geometry::PathMode::BLEND) {
        return 1e-6;
    }
    if (program.tolerance > 0) {
        return program.tolerance;
    }
    double allowed = 0;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double nominal = 1e-4 * program.limits.velocity[static_cast<std::size_t>(i)];
        allowed = geometry::isAngular(i) ? allowed : std::max(allowed, nominal);
    }
    for (const Primitive &p : program.primitives) {
        allowed = std::max(allowed, p.isArc ? 1e-3 * p.radius : 0.1 * p.length);
    }
    return allowed;
}

struct Outcome {
    Rig rig{Pose{}};
    bool isFinished = false;
};

/// Runs the program with random holds, overrides and late plans.
inline void drive(Maker &maker, const Program &program, Outcome &out, bool isDropped) {
    Rig &rig = out.rig;
    rig.planner.set_limits(program.limits);
    if (program.isBoxed) {
        Pose low;
        Pose high;
        room_of(program, low, high);
        rig.planner.set_room(low, high);
    }
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    Scales scales;
    rig.planner.set_scales(scales);
    std::size_t fed = 0;
    bool isHeld = false;
    const int drop_at = isDropped ? maker.whole(50, 2000) : -1;
    for (int n = 0; n < 2000000; ++n) {
        const int batch = maker.chance(0.02) ? maker.whole(1, 30) : 0;
        for (int i = 0; i < batch && fed < program.primitives.size(); ++i, ++fed) {
            rig.planner.add(program.primitives[fed], program.requests[fed]);
        }
        if (fed == program.primitives.size() || maker.chance(0.001)) {
            rig.planner.release_end();
        }
        if (maker.chance(0.003)) {
            scales.feed = maker.chance(0.1) ? 0.0 : maker.real(0.05, 1.5);
            scales.rapid = maker.real(0.1, 1.0);
            rig.planner.set_scales(scales);
        }
        if (maker.chance(isHeld ? 0.02 : 0.001)) {
            isHeld = !isHeld;
            rig.executor.hold(isHeld);
        }
        rig.isPlannerAlive = !maker.chance(0.01);
        if (n == drop_at) {
            rig.executor.drop();
        }
        rig.step();
        if (isDropped && n > drop_at && rig.executor.isAtRest()) {
            out.isFinished = true;
            return;
        }
        if (fed == program.primitives.size() && scales.feed == 0.0) {
            scales.feed = 1.0;
            rig.planner.set_scales(scales);
        }
        const bool isOver = fed == program.primitives.size() && rig.executor.isAtRest() &&
                            rig.executor.snapshot().done_move >= rig.planner.last_move();
        if (isOver) {
            out.isFinished = true;
            return;
        }
    }
}

}  // namespace mw::trajectory::test
