// SPDX-License-Identifier: GPL-2.0-or-later
// Stops from a moving plan, and plans after feeds were lowered: random programs, random positions, limits at
// every servo sample.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/profile.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/profile_rig.hh"

namespace mw::trajectory::profile {
namespace {

/// The whole curve of a program with its feeds, which can be scaled.
struct Part {
    test::Program program;
    curve::CurveBuilder builder{3.0};
    std::vector<FeedLimit> feeds, scaled;
    Run run;

    explicit Part(const test::Program &made) : program(made) {
        program.tolerance = program.tolerance > 0 ? program.tolerance : 1e-3;
        double end = 0;
        for (std::size_t k = 0; k < program.primitives.size(); ++k) {
            const Primitive &p = program.primitives[k];
            const MoveRequest &r = program.requests[k];
            builder.add(p, program.tolerance);
            end += p.length;
            const double velocity = r.isRapid || !(r.tag.requested_velocity > 0)
                                        ? 1e300
                                        : r.tag.requested_velocity * p.length / feed_length(p).length;
            feeds.push_back({end, velocity, FeedLimit::Along::LENGTH});
            if (builder.programmed_length() - builder.final_s() > 30) {
                builder.extend(false);
            }
        }
        builder.extend(true);
        scaled = feeds;
        run = {&builder.spans(), &scaled, limits_of(program.limits), builder.final_s(), true};
    }

    void scale(double feed, double rapid) {
        scaled = feeds;
        for (FeedLimit &f : scaled) {
            f.velocity *= f.velocity < 1e100 ? feed : 1;
            f.limit_share = f.velocity < 1e100 ? 1 : rapid;
        }
    }
    CurvePoint point(double s) const {
        const std::size_t span = span_at(builder.spans(), s);
        return curve::point_at(builder.spans()[span], s);
    }
    /// Maximum speed along the curve within the speed limits.
    double limit_at(double s) const {
        const CurvePoint p = point(s);
        // At the end of a move, the limit of either move is accepted.
        return 1 / std::min(speed_share(run, p, run.feed_at(s - 1e-9)),
                            speed_share(run, p, run.feed_at(s + 1e-9)));
    }
};

/// Position and speed at a time of the cells.
struct Reading {
    double s = 0, v = 0;
};

std::vector<Reading> readings_of(const std::vector<TimeCell> &cells, double step = T) {
    std::vector<Reading> out;
    double start = 0;
    for (const TimeCell &cell : cells) {
        for (double t = step * static_cast<double>(out.size()) - start; t <= cell.duration;
             t = step * static_cast<double>(out.size()) - start) {
            const auto &c = cell.c;
            out.push_back(
                {cell.s_at(t), c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])))});
        }
        start += cell.duration;
    }
    return out;
}

/// Maximum ratio to the acceleration and jerk limits from differences of the samples, with some samples at
/// standstill at the end. Rounding errors of the differences are subtracted.
struct Worst {
    double acceleration = 0, jerk = 0;
};
Worst worst_of(const Part &part, const std::vector<Reading> &readings, bool ends, double end_s) {
    std::vector<Pose> p;
    for (const Reading &r : readings) {
        p.push_back(part.point(r.s).position);
    }
    for (int i = 0; i < 3 && ends; ++i) {
        p.push_back(part.point(end_s).position);
    }
    Worst worst;
    double size = 1;
    for (const Pose &x : p) {
        for (const double c : x.c) {
            size = std::max(size, std::abs(c));
        }
    }
    const double ulp = 4e-16 * size;
    const auto note = [](double &w, double value, double rounding, double limit) {
        w = std::max(w, (std::abs(value) - rounding) / limit);
    };
    for (std::size_t i = 3; i < p.size(); ++i) {
        const Pose a = (p[i] - p[i - 1] * 2 + p[i - 2]) * (1 / (T * T));
        const Pose j = ((p[i] - p[i - 3]) - (p[i - 1] - p[i - 2]) * 3) * (1 / (T * T * T));
        const double ra = 4 * ulp / (T * T), rj = 8 * ulp / (T * T * T);
        for (std::size_t k = 0; k < geometry::AXIS_COUNT; ++k) {
            note(worst.acceleration, a.c[k], ra, part.run.limits.axes[k].acceleration);
            note(worst.jerk, j.c[k], rj, part.run.limits.axes[k].jerk);
        }
        note(worst.acceleration, geometry::norm_xyz(a), ra, part.run.limits.xyz.acceleration);
        note(worst.jerk, geometry::norm_xyz(j), rj, part.run.limits.xyz.jerk);
    }
    return worst;
}

/// The range of x for a limit of |p + x q|; unlimited without limits.
struct Band {
    double low = -1e300, high = 1e300;
    void meet(double p, double q, double limit) {
        if (std::abs(q) < 1e-12) {
            return;
        }
        const double x = -p / q, half = limit / std::abs(q);
        low = std::max(low, x - half);
        high = std::min(high, x + half);
    }
};

/// Permitted ranges of jerk and acceleration at a position. The norm counts as if it were along the path.
void bands_at(const Part &part, const Reading &at, double a, Band &acceleration, Band &jerk) {
    const CurvePoint p = part.point(at.s);
    const double v = at.v;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        const Bounds &b = part.run.limits.axes[i];
        const double q = p.first.c[i], q2 = p.second.c[i], q3 = p.third.c[i];
        acceleration.meet(q2 * v * v, q, b.acceleration);
        jerk.meet(3 * q2 * v * a + q3 * v * v * v, q, b.jerk);
    }
    const Bounds &b = part.run.limits.xyz;
    const double n = geometry::norm_xyz(p.first);
    const double drift = geometry::norm_xyz(p.second * (3 * v * a) + p.third * (v * v * v));
    acceleration.meet(0, n, b.acceleration + geometry::norm_xyz(p.second) * v * v);
    jerk.meet(0, n, b.jerk + drift);
}

/// True if the XYZ norm is within 1.02 times its limits.
bool keepsNorm(const Part &part, const Reading &at, double a, double j) {
    constexpr double ROOM = 1.02;
    const CurvePoint p = part.point(at.s);
    const double v = at.v;
    const Bounds &b = part.run.limits.xyz;
    return geometry::norm_xyz(p.first * a + p.second * (v * v)) <= ROOM * b.acceleration &&
           geometry::norm_xyz(p.first * j + p.second * (3 * v * a) + p.third * (v * v * v)) <= ROOM * b.jerk;
}

struct Least {
    double time_s = 0;
    bool can_be_driven = true;
};

/// Brakes with the limits at each instant, without looking ahead. If this motion is possible, no stop is much
/// shorter.
Least least_stop(const Part &part, Reading at, double a) {
    constexpr double STEP = 5e-5;
    Least least;
    for (bool releases = false; at.v > 0 && least.time_s < 20; least.time_s += STEP) {
        Band acceleration, jerk;
        bands_at(part, at, a, acceleration, jerk);
        releases = releases || (a < 0 && at.v <= 0.5 * a * a / std::max(jerk.high, 1e-9));
        const double wanted =
            releases ? 0.5 * a * a / at.v : std::max(jerk.low, (acceleration.low - a) / STEP);
        constexpr double ROOM = 1.1;
        least.can_be_driven = least.can_be_driven && jerk.low <= jerk.high && a <= acceleration.high &&
                              wanted <= (jerk.high > 0 ? ROOM : 1 / ROOM) * jerk.high &&
                              keepsNorm(part, at, a, wanted);
        a += STEP * wanted;
        at.v += STEP * a;
        at.s = std::min(at.s + STEP * at.v, part.run.end_s);
        if (releases && a >= 0) {
            break;
        }
    }
    return least;
}

void expect_within(const Part &part, const std::vector<Reading> &readings, bool ends, double end_s,
                   const char *what) {
    const Worst worst = worst_of(part, readings, ends, end_s);
    EXPECT_LE(worst.acceleration, 1 + 1e-6) << what;
    EXPECT_LE(worst.jerk, 1 + 1e-6) << what;
    for (std::size_t i = 1; i < readings.size(); ++i) {
        ASSERT_GE(readings[i].s, readings[i - 1].s - 1e-12) << what << " goes back";
    }
}

/// The speed at s, interpolated between the readings.
double speed_at(const std::vector<Reading> &readings, double s) {
    const auto next = std::lower_bound(readings.begin(), readings.end(), s,
                                       [](const Reading &r, double x) { return r.s < x; });
    if (next == readings.begin() || next == readings.end()) {
        return 0;
    }
    const Reading &a = *(next - 1), &b = *next;
    return b.s > a.s ? a.v + (b.v - a.v) * (s - a.s) / (b.s - a.s) : std::max(a.v, b.v);
}

double duration_of(const std::vector<TimeCell> &cells) {
    double t = 0;
    for (const TimeCell &c : cells) {
        t += c.duration;
    }
    return t;
}

struct Ride {
    Part part;
    Profile profile{{0.5}};
    std::vector<TimeCell> driven;
    std::size_t checked = 0;
    std::vector<Reading> allowed;  ///< the plan when limits were lowered
    double feed = 1, rapid = 1;
    int replans = 0;
    bool is_done = false, is_at_end = false;
    double stopped_s = 0;

    explicit Ride(const test::Program &program) : part(program) { profile.begin(0); }
    std::vector<TimeCell> with_plan(std::size_t cells) const {
        std::vector<TimeCell> out = driven;
        for (std::size_t k = 0; k < cells; ++k) {
            out.push_back(profile.cell(k));
        }
        return out;
    }
    void take(double seconds) {
        constexpr std::size_t BEHIND = 8;
        const std::size_t cells = profile.cells();
        const std::size_t last = profile.isComplete() ? cells : cells - std::min(cells, BEHIND);
        std::size_t k = 0;
        for (double t = 0; k < last && t < seconds; ++k) {
            driven.push_back(profile.cell(k));
            t += profile.cell(k).duration;
        }
        is_at_end = profile.isComplete() && k == cells;
        if (is_at_end) {
            const TimeCell &end = driven.back();
            EXPECT_NEAR(end.s_at(end.duration), profile.end_s(), 1e-12 * std::max(1.0, part.run.end_s));
            stopped_s = profile.end_s();
            EXPECT_LE(stopped_s, part.run.end_s);
        }
        is_done = is_at_end && stopped_s > part.builder.final_s() - 1e-9;
        profile.drop(k);
    }
    /// Time from the start of the cell `fixed` to the end of a stop [s].
    double time_of(const Stop &stop, std::size_t fixed) const {
        double t = duration_of(stop.cells);
        for (std::size_t k = fixed; k < stop.kept; ++k) {
            t += profile.cell(k).duration;
        }
        return t;
    }
    void lower(double feed_part, double rapid_part, std::size_t fixed) {
        ++replans;
        feed = std::max(feed * feed_part, 0.01);
        rapid = std::max(rapid * rapid_part, 0.01);
        part.scale(feed, rapid);
        allowed = readings_of(with_plan(profile.cells()), 0.1 * T);
        profile.replan(part.run, fixed);
    }
    void raise(double feed_part, double rapid_part) {
        feed = std::min(1.0, feed * feed_part);
        rapid = std::min(1.0, rapid * rapid_part);
        part.scale(feed, rapid);
    }
    /// Checks the motion since the last call, with some cells before it.
    void check_driven() {
        constexpr std::size_t BEFORE = 40;
        constexpr double BETWEEN_PLACES = 0.05;
        const auto from = static_cast<long>(checked - std::min(checked, BEFORE));
        expect_within(part, readings_of({driven.begin() + from, driven.end()}), false, 0, "driven");
        for (const Reading &r : readings_of({driven.begin() + static_cast<long>(checked), driven.end()})) {
            const double most = std::max(part.limit_at(r.s), speed_at(allowed, r.s));
            ASSERT_LE(r.v, most * (1 + BETWEEN_PLACES) + 1e-6) << "at s " << r.s;
        }
        checked = driven.size();
    }
};

void check_stop(const Ride &ride, const Stop &stop, const char *what) {
    std::vector<TimeCell> cells = ride.with_plan(stop.kept);
    cells.insert(cells.end(), stop.cells.begin(), stop.cells.end());
    if (cells.size() > 60) {
        cells.erase(cells.begin(), cells.begin() + static_cast<long>(std::max<std::size_t>(
                                                       0, std::min(ride.driven.size(), cells.size() - 60))));
    }
    const auto readings = readings_of(cells);
    expect_within(ride.part, readings, true, stop.end_s, what);
    const TimeCell &last = cells.back();
    EXPECT_NEAR(last.s_at(last.duration), stop.end_s, 1e-12 * std::max(1.0, stop.end_s)) << what;
}

/// Runs a random program. `act` is called before each part of 50 ms.
template <typename Act>
int drive_seeds(int preset, const Act &act) {
    const auto [first, count] = testing::campaign_seeds(preset);
    int driven = 0;
    for (int i = 0; i < count; ++i) {
        const auto seed = static_cast<unsigned>(first + i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Maker maker(seed, true);
        const test::Program program =
            seed % 2 == 0 ? maker.make_curve() : maker.make_long(seed % 4 == 1, 3.0);
        if (program.primitives.empty()) {
            continue;
        }
        Ride ride(program);
        for (int n = 0; n < 8000 && !ride.is_done; ++n) {
            act(ride, maker);
            ride.take(0.05);
            ride.check_driven();
        }
        EXPECT_TRUE(ride.is_done);
        EXPECT_LE(ride.profile.worst_start(), 1 + 1e-6) << "a plan began from one that leaves a limit";
        EXPECT_EQ(ride.profile.rejected(), 0) << "largest row " << ride.profile.worst_rejected();
        ++driven;
    }
    return driven;
}

std::size_t some_cells(const Ride &ride, test::Maker &maker) {
    return static_cast<std::size_t>(maker.whole(0, static_cast<int>(ride.profile.cells() / 4)));
}

TEST(Stop, StopsAnywhereWithinTheLimitsAndSoon) {
    int judged = 0;
    const int driven = drive_seeds(12, [&](Ride &ride, test::Maker &maker) {
        ride.profile.plan(ride.part.run, 0);
        if (!maker.chance(0.3)) {
            return;
        }
        const std::size_t fixed = some_cells(ride, maker);
        const Stop quick = ride.profile.stop(ride.part.run, fixed, StopEffort::QUICK);
        const Stop soonest = ride.profile.stop(ride.part.run, fixed, StopEffort::SOONEST);
        check_stop(ride, quick, "quick");
        check_stop(ride, soonest, "soonest");
        const double time = ride.time_of(soonest, fixed);
        EXPECT_LE(time, ride.time_of(quick, fixed) + 1e-9);
        if (fixed < ride.profile.cells()) {
            const auto &c = ride.profile.cell(fixed).c;
            const Least least = least_stop(ride.part, {c[0], c[1]}, 2 * c[2]);
            judged += least.can_be_driven ? 1 : 0;
            EXPECT_TRUE(!least.can_be_driven || time <= std::max(1.3 * least.time_s, least.time_s + 0.01))
                << time << " s, at least " << least.time_s;
        }
    });
    EXPECT_GE(judged, 12 * driven) << "stops that were compared with the least time";
}

TEST(Stop, ReachesLowerFeedsWithinTheLimits) {
    drive_seeds(5, [](Ride &ride, test::Maker &maker) {
        const std::size_t fixed = some_cells(ride, maker);
        const double change = std::pow(10.0, maker.real(-2, 0)), other = std::pow(10.0, maker.real(-2, 0));
        if (maker.chance(0.2) && ride.replans < 40) {
            ride.lower(change, other, fixed);
        } else {
            if (maker.chance(0.25)) {
                ride.raise(1 / change, 1 / other);
            }
            ride.profile.plan(ride.part.run, fixed);
        }
    });
}

TEST(Stop, EndsNearerAndContinues) {
    drive_seeds(5, [](Ride &ride, test::Maker &maker) {
        const std::size_t fixed = some_cells(ride, maker);
        const double whole = ride.part.builder.final_s();
        if (ride.is_at_end) {
            ride.part.run.end_s = whole;
            ride.profile.begin(ride.stopped_s);
            ride.profile.plan(ride.part.run, 0);
        } else if (ride.part.run.end_s < whole && maker.chance(0.3)) {
            ride.part.run.end_s = whole;
            ride.profile.replan(ride.part.run, fixed);
        } else if (maker.chance(0.3) && ride.profile.cells() > 0 && ride.part.run.end_s == whole) {
            const Stop soonest = ride.profile.stop(ride.part.run, fixed, StopEffort::SOONEST);
            const double way = maker.chance(0.3) ? 0.0 : std::pow(10.0, maker.real(-4, 1));
            ride.part.run.end_s = std::min(whole, soonest.end_s + way);
            ride.profile.replan(ride.part.run, fixed);
        } else {
            ride.profile.plan(ride.part.run, fixed);
        }
    });
}

}  // namespace
}  // namespace mw::trajectory::profile
