// SPDX-License-Identifier: GPL-2.0-or-later
// Stops in the middle of a plan and plans after lower feeds: random programs, random places, limits at every
// servo sample.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/profile.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/profile_rig.hh"

namespace mw::trajectory::profile {
namespace {

/// The whole curve of a program and its feeds.
struct Part {
    test::Program program;
    curve::CurveBuilder builder{3.0};
    std::vector<FeedLimit> feeds;
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
        run = {&builder.spans(), &feeds, limits_of(program.limits), builder.final_s(), true};
    }

    CurvePoint point(double s) const {
        const std::size_t span = span_at(builder.spans(), s);
        return curve::point_at(builder.spans()[span], s);
    }
};

/// Place and speed at a time of cells.
struct Reading {
    double s = 0, v = 0;
};

std::vector<Reading> readings_of(const std::vector<TimeCell> &cells) {
    std::vector<Reading> out;
    double start = 0;
    for (const TimeCell &cell : cells) {
        for (double t = T * static_cast<double>(out.size()) - start; t <= cell.duration;
             t = T * static_cast<double>(out.size()) - start) {
            const auto &c = cell.c;
            out.push_back(
                {cell.s_at(t), c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])))});
        }
        start += cell.duration;
    }
    return out;
}

/// Worst ratio to the limits of acceleration and jerk by differences of the samples, a few of them at rest at
/// the end. What rounding makes of the differences does not count.
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

struct Ride {
    Part part;
    Profile profile{{2e-3, 0.5}};
    std::vector<TimeCell> driven;
    bool is_done = false;
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
        is_done = profile.isComplete() && k == cells;
        profile.drop(k);
    }
};

void expect_within(const Part &part, const std::vector<Reading> &readings, bool ends, double end_s,
                   const char *what) {
    const Worst worst = worst_of(part, readings, ends, end_s);
    EXPECT_LE(worst.acceleration, 1 + 1e-6) << what;
    EXPECT_LE(worst.jerk, 1 + 1e-6) << what;
    for (std::size_t i = 1; i < readings.size(); ++i) {
        ASSERT_GE(readings[i].s, readings[i - 1].s - 1e-12) << what << " goes back";
    }
}

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

TEST(Stop, RandomProgramsStopAnywhere) {
    const auto [first, count] = testing::campaign_seeds(12);
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
        for (int n = 0; n < 4000 && !ride.is_done; ++n) {
            ride.profile.plan(ride.part.run, 0);
            if (maker.chance(0.3)) {
                const auto fixed =
                    static_cast<std::size_t>(maker.whole(0, static_cast<int>(ride.profile.cells() / 4)));
                const Stop quick = ride.profile.stop(ride.part.run, fixed, StopEffort::QUICK);
                const Stop soon = ride.profile.stop(ride.part.run, fixed, StopEffort::SOONEST);
                check_stop(ride, quick, "quick");
                check_stop(ride, soon, "soonest");
            }
            ride.take(0.05);
        }
        ASSERT_TRUE(ride.is_done);
        EXPECT_LE(ride.profile.worst_start(), 1 + 1e-3);
    }
}

}  // namespace
}  // namespace mw::trajectory::profile
