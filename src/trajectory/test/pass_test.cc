// SPDX-License-Identifier: GPL-2.0-or-later
// Passes of threads: the motion is within its limits, and the helix is checked with the true angle of the
// rotor.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "components/plants/spindle_plant.hh"
#include "trajectory/follow/pass_follower.hh"
#include "trajectory/plan/pass_builder.hh"
#include "trajectory/test/part_rig.hh"

namespace mw::trajectory::test {
namespace {

constexpr double T = 1e-3;

TEST(SpeedChange, ReachesTheSpeedWithZeroAccelerationWithinTheLimits) {
    std::mt19937_64 random(7);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int n = 0; n < 20000; ++n) {
        const double A = real(1, 1000), J = real(1, 50000);
        MotionState state{real(-5, 5), real(-50, 50), real(-A, A)};
        const double to_v = n % 3 == 0 ? 0.0 : real(-50, 50);
        const SpeedChange change = speed_change(state, to_v, A, J);
        const double start = state.x;
        double duration = 0;
        for (const SpeedChange::Part &part : change.parts) {
            ASSERT_GE(part.duration, 0);
            ASSERT_LE(std::abs(part.jerk), J);
            state = state.after(part.jerk, part.duration);
            ASSERT_LE(std::abs(state.a), A * (1 + 1e-9));
            duration += part.duration;
        }
        ASSERT_NEAR(state.v, to_v, 1e-9 * (1 + std::abs(to_v))) << n;
        ASSERT_NEAR(state.a, 0, 1e-9 * A) << n;
        ASSERT_NEAR(state.x - start, change.distance, 1e-9) << n;
        ASSERT_NEAR(duration, change.duration, 1e-12) << n;
    }
}

/// A pass of lines, with a simulated spindle that has inertia and an encoder.
struct Threading {
    std::unique_ptr<PathStore> store = std::make_unique<PathStore>();
    Conditions conditions{T};
    std::vector<curve::Span> spans;

    Pass pass;
    plants::SpindlePlant plant;
    SpindleTrack track;
    PassFollower follower;
    double rps;

    struct Seen {
        Pose v, a, j;
        double x_end = 0;
        double farthest = 0;  ///< maximum distance from the helix within the pass [rev]
        double phase = NAN;   ///< phase of the helix by the true angle of the rotor [rev]
        int cycles = 0;
        bool is_over = false;
    } seen;

    Threading(double speed, double jerk, double counts = 4096)
        : plant([&] {
              plants::SpindleTraits traits;
              traits.ramp = 33;
              traits.first_turns = 0.3;
              traits.counts_per_turn = static_cast<int>(counts);
              return traits;
          }()),
          rps(speed) {
        Limits limits;
        limits.velocity.fill(100);
        limits.acceleration.fill(1000);
        limits.jerk.fill(jerk);
        limits.isJerkLimited = jerk < UNLIMITED;
        conditions.limits.set(limits);
        conditions.scales.spindle_rps[0] = speed;
        for (int i = 0; i < 3000; ++i) {
            turn(rps);
        }
    }
    void turn(double command) {
        plant.run(command, 0, T);
        track.take(plant.shown_turns(), T);
    }
    /// `lead`: distance along the path per revolution [unit].
    void make(const std::vector<Pose> &corners, double lead) {
        plan::PassBuilder builder(3);
        builder.begin(0);
        double s = 0;
        for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
            s += builder.add({make_line(corners[i], corners[i + 1]), lead, lead * std::abs(rps)}, conditions);
        }
        builder.finish(conditions.limits.wanted());
        std::vector<plan::LimitedLeg> limited;
        builder.move_parts(spans, limited);
        pass.first = 1;
        pass.end_s = s;
        pass.direction = rps < 0 ? -1.0 : 1.0;
        MotionLimits all{0, UNLIMITED, UNLIMITED};
        std::vector<PassLeg> legs;
        for (const plan::LimitedLeg &leg : limited) {
            legs.push_back(leg.leg);
            all.acceleration = std::min(all.acceleration, leg.acceleration);
            all.jerk = std::min(all.jerk, leg.jerk);
        }
        plan::limit_leg_ends(legs, all);
        pass.acceleration = all.acceleration;
        pass.jerk = all.jerk;
        for (std::size_t n = 0; n < legs.size(); ++n) {
            store->leg(n + 1) = legs[n];
        }
        pass.last = legs.size();
    }
    Pose at(double s) const {
        for (const curve::Span &span : spans) {
            if (s <= span.end_s()) {
                return position_at(span, s);
            }
        }
        return position_at(spans.back(), s);
    }
    SpindleReading reading() const {
        return {track.turns(), track.turns_per_s(), track.turns_per_s2(), {}, track.step()};
    }
    /// Runs the pass. It is checked between the two values of s.
    template <class OnCycle>
    void run(double lead, double from, double to, OnCycle on_cycle) {
        follower.begin(*store, pass, reading(), T);
        track.set_rate(follower.rate());
        Pose last = at(0), last_v{}, last_a{};
        for (int n = 0; n < 30000 && !seen.is_over; ++n) {
            on_cycle(n);
            seen.is_over = !follower.step(*store, reading(), T);
            turn(rps);
            const Pose now = at(follower.s());
            const Pose v = (now - last) * (1 / T), a = (v - last_v) * (1 / T), j = (a - last_a) * (1 / T);
            for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
                seen.v[i] = std::max(seen.v[i], std::abs(v[i]));
                seen.a[i] = std::max(seen.a[i], std::abs(a[i]));
                seen.j[i] = std::max(seen.j[i], std::abs(j[i]));
            }
            last = now;
            last_v = v;
            last_a = a;
            seen.x_end = follower.s();
            ++seen.cycles;
            if (follower.s() > from && follower.s() < to) {
                const double phase = pass.direction * plant.turns() - follower.s() / lead;
                seen.phase = std::isnan(seen.phase) ? phase : seen.phase;
                seen.farthest = std::max(seen.farthest, std::abs(phase - seen.phase));
            }
        }
    }
    void run(double lead, double from, double to) {
        run(lead, from, to, [](int) {});
    }
    void expect_limits(double v, double a, double j) const {
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            EXPECT_LE(seen.v[i], v * (1 + 1e-9)) << i;
            EXPECT_LE(seen.a[i], a * (1 + 1e-6)) << i;
            EXPECT_LE(seen.j[i], j * (1 + 1e-5)) << i;
        }
    }
};

constexpr double LEAD = 1.5;

TEST(Pass, FollowsTheHelixWithinTheLimitsAndEndsAtItsEnd) {
    for (const double jerk : {UNLIMITED, 20000.0, 2000.0}) {
        for (const double rps : {5.0, -10.0, 30.0}) {
            Threading t(rps, jerk);
            t.make({test::at(0), test::at(0, 0, -60)}, LEAD);
            t.run(LEAD, 12, 40);
            EXPECT_TRUE(t.seen.is_over);
            EXPECT_EQ(t.seen.x_end, 60);
            t.expect_limits(100, 1000, jerk);
            EXPECT_LT(t.seen.farthest, 1e-3) << jerk << " " << rps;
            std::printf("jerk %7.1g, %3.0f rev/s: phase %.5f, off %.6f turns\n", jerk, rps, t.seen.phase,
                        t.seen.farthest);
        }
    }
}

/// Passes at different speeds and angles cut the same thread.
TEST(Pass, EveryPassHasTheSameAngle) {
    for (const double jerk : {UNLIMITED, 20000.0}) {
        double low = INFINITY, high = -INFINITY;
        for (const double rps : {2.0, 5.0, 10.0, 20.0, 30.0}) {
            for (int n = 0; n < 3; ++n) {
                Threading t(rps, jerk);
                for (int i = 0; i < 17 * n; ++i) {
                    t.turn(rps);
                }
                t.make({test::at(0), test::at(0, 0, -60)}, LEAD);
                t.run(LEAD, 15, 40);
                const double angle = t.seen.phase - std::round(t.seen.phase);
                low = std::min(low, angle);
                high = std::max(high, angle);
            }
        }
        std::printf("jerk %7.1g: angles from %.5f to %.5f turns\n", jerk, low, high);
        EXPECT_LT(high - low, 5e-4);
    }
}

TEST(Pass, ACornerIsPassedAtSpindleSpeedAfterTheEndOfTheFirstLine) {
    for (const double jerk : {UNLIMITED, 20000.0}) {
        for (const double rps : {5.0, 15.0}) {
            Threading t(rps, jerk);
            t.make({test::at(0), test::at(0, 0, -40), test::at(5, 0, -45)}, LEAD);
            const PassLeg &corner = t.store->leg(2);
            EXPECT_GE(corner.start_s + 0.5 * corner.length, 40);
            t.run(LEAD, 15, corner.start_s);
            EXPECT_TRUE(t.seen.is_over);
            t.expect_limits(100, 1000, jerk);
            EXPECT_LT(t.seen.farthest, 3e-4);
            EXPECT_GE(corner.v_most, LEAD * rps);
            const Pose end = t.at(t.seen.x_end);
            EXPECT_LT(geometry::norm(end - test::at(5, 0, -45)), 1e-9);
        }
    }
}

TEST(Pass, AStopAtAnyMomentKeepsTheLimits) {
    for (const double jerk : {UNLIMITED, 20000.0}) {
        int at_cycle = 0;
        for (bool is_over = false; !is_over && at_cycle < 20000; at_cycle += 37) {
            Threading t(20, jerk);
            t.make({test::at(0), test::at(0, 0, -40), test::at(5, 0, -45)}, LEAD);
            int cycles = 0;
            t.run(LEAD, 15, 30, [&](int n) {
                if (n == at_cycle) {
                    t.follower.stop();
                }
                cycles = n;
            });
            EXPECT_TRUE(t.seen.is_over);
            t.expect_limits(100, 1000, jerk);
            is_over = cycles < at_cycle;
        }
        EXPECT_LT(at_cycle, 20000);
    }
}

TEST(Pass, IsAsExactAsTheEncoderStep) {
    for (const double jerk : {UNLIMITED, 20000.0}) {
        for (const int counts : {20, 60, 200, 1000, 4096, 10000}) {
            double low = INFINITY, high = -INFINITY, off = 0, highest_a = 0;
            for (const double rps : {3.1, 9.7, 21.3}) {
                for (int n = 0; n < 3; ++n) {
                    Threading t(rps, jerk, counts);
                    for (int i = 0; i < 17 * n; ++i) {
                        t.turn(rps);
                    }
                    t.make({test::at(0), test::at(0, 0, -100)}, LEAD);
                    double last = 0, last_v = 0;
                    t.run(LEAD, 30, 80, [&](int) {
                        const double s = t.follower.s(), v = (s - last) / T;
                        if (s > 30 && s < 80) {
                            highest_a = std::max(highest_a, std::abs(v - last_v) / T);
                        }
                        last = s;
                        last_v = v;
                    });
                    EXPECT_TRUE(t.seen.is_over);
                    t.expect_limits(100, 1000, jerk);
                    const double angle = t.seen.phase - std::round(t.seen.phase);
                    low = std::min(low, angle);
                    high = std::max(high, angle);
                    off = std::max(off, t.seen.farthest);
                }
            }
            std::printf(
                "%5d counts, jerk %7.1g: start angles differ by %.5f rev (%.2f steps), in a pass by %.5f "
                "(%.2f), acceleration %.0f\n",
                counts, jerk, high - low, (high - low) * counts, off, off * counts, highest_a);
            EXPECT_LE(high - low, 0.15 / counts + 1e-4);
            EXPECT_LE(off, 0.25 / counts + 1e-4);
            EXPECT_LE(highest_a, 250);
        }
    }
}

TEST(Pass, ARoughEncoderDoesNotShakeTheMachine) {
    for (const double jerk : {UNLIMITED, 20000.0}) {
        Threading t(9.7, jerk, 200);
        t.make({test::at(0), test::at(0, 0, -60)}, LEAD);
        double highest_a = 0, last = 0, last_v = 0;
        t.run(LEAD, 20, 50, [&](int) {
            const double s = t.follower.s(), v = (s - last) / T;
            if (s > 20 && s < 50) {
                highest_a = std::max(highest_a, std::abs(v - last_v) / T);
            }
            last = s;
            last_v = v;
        });
        std::printf("200 counts, jerk %7.1g: off %.5f turns, acceleration %.1f\n", jerk, t.seen.farthest,
                    highest_a);
        EXPECT_LT(t.seen.farthest, 2.0 / 200);
        EXPECT_LT(highest_a, 300);
    }
}

}  // namespace
}  // namespace mw::trajectory::test
