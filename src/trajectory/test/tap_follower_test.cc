// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of a tap with a simulated spindle that has inertia and an encoder, checked with the true angle of the
// rotor.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "components/plants/spindle_plant.hh"
#include "trajectory/follow/tap_follower.hh"

namespace mw::trajectory {
namespace {

constexpr double T = 1e-3;
constexpr double PITCH = 1.25, DEPTH = 20;

struct Tapping {
    plants::SpindlePlant plant;
    SpindleTrack track;
    TapFollower tap;
    double rps, ramp;
    double phase = NAN;   ///< phase of the helix by the true angle of the rotor [rev]
    double farthest = 0;  ///< maximum distance from the helix while the tool follows [rev]
    double deepest = 0;   ///< maximum x
    double highest_v = 0, highest_a = 0, highest_j = 0;

    Tapping(double speed, double drive_ramp, int counts = 4096)
        : plant([&] {
              plants::SpindleTraits traits;
              traits.ramp = drive_ramp;
              traits.first_turns = 0.3;
              traits.counts_per_turn = counts;
              return traits;
          }()),
          rps(speed), ramp(drive_ramp) {
        for (int i = 0; i < 3000; ++i) {
            turn(rps);
        }
    }
    void turn(double command) {
        plant.run(command, 0, T);
        track.take(plant.shown_turns(), T);
    }
    SpindleReading reading(double known_ramp) const {
        const SpindleBraking braking{0, known_ramp};
        return {track.turns(), track.turns_per_s(), track.turns_per_s2(), {braking, braking}, track.step()};
    }
    /// Runs the tap to its end. `on_cycle` may stop it.
    template <class OnCycle>
    bool run(double known_ramp, const TapTerms &terms, OnCycle on_cycle) {
        tap.begin(terms, reading(known_ramp), T);
        track.set_rate(tap.rate());
        double last_x = 0, last_v = 0, last_a = 0;
        bool wasFollowing = false;
        for (int i = 0; i < 20000 && !tap.isOver(); ++i) {
            on_cycle(*this);
            tap.step(reading(known_ramp), T);
            const double v = (tap.x() - last_x) / T;
            highest_v = std::max(highest_v, std::abs(v));
            const double a = (v - last_v) / T;
            highest_a = std::max(highest_a, std::abs(a));
            highest_j = std::max(highest_j, std::abs(a - last_a) / T);
            last_x = tap.x();
            last_v = v;
            last_a = a;
            deepest = std::max(deepest, tap.x());
            const TapPhase p = tap.phase();
            turn(tap.spindle_factor() * rps);
            const bool isFollowing =
                p == TapPhase::IN || p == TapPhase::TURNING || p == TapPhase::BACK || p == TapPhase::LEAVING;
            // The phase is measured a few cycles after the tool has reached the helix.
            if (isFollowing && wasFollowing && tap.x() > 4 && std::isnan(phase)) {
                phase = std::copysign(1.0, rps) * plant.turns() - tap.x() / PITCH;
            }
            wasFollowing = isFollowing;
            if (isFollowing && !std::isnan(phase)) {
                farthest = std::max(
                    farthest, std::abs(std::copysign(1.0, rps) * plant.turns() - tap.x() / PITCH - phase));
            }
        }
        return tap.isOver();
    }
    bool run(double known_ramp, const TapTerms &terms) {
        return run(known_ramp, terms, [](Tapping &) {});
    }
};

constexpr double NO_JERK_LIMIT = 1e300;

TapTerms terms(double jerk = NO_JERK_LIMIT) {
    TapTerms t;
    t.depth = DEPTH;
    t.per_turn = PITCH;
    t.low = -10;
    t.high = DEPTH + 10;
    t.velocity = 100;
    t.acceleration = 1000;
    t.jerk = jerk;
    return t;
}

TEST(TapFollower, FollowsTheAngleThroughBothReversalsAndEndsAtItsStart) {
    for (const double rpm : {1000.0, -1000.0, 300.0, 1500.0}) {
        for (const double jerk : {NO_JERK_LIMIT, 20000.0}) {
            SCOPED_TRACE(jerk);
            Tapping tapping(rpm / 60, 1000.0 / 60 / 0.5);
            ASSERT_TRUE(tapping.run(tapping.ramp, terms(jerk))) << rpm;
            EXPECT_LE(tapping.highest_j, jerk * (1 + 1e-6));
            std::printf("tap %5.0f rpm, jerk %7.1g: %.5f turns off the helix, bottom %.4f turns off\n", rpm,
                        jerk, tapping.farthest, (tapping.deepest - DEPTH) / PITCH);
            EXPECT_EQ(tapping.tap.x(), 0);
            EXPECT_EQ(tapping.tap.spindle_factor(), 1);
            EXPECT_FALSE(tapping.tap.isLost());
            EXPECT_LE(tapping.farthest, 0.02) << rpm;
            EXPECT_NEAR(tapping.deepest, DEPTH, 0.2 * PITCH) << rpm;
            EXPECT_LE(tapping.highest_v, 100);
            EXPECT_LE(tapping.highest_a, 1000 * (1 + 1e-9));
        }
    }
}

TEST(TapFollower, FollowsTheAngleWithAnyEncoder) {
    for (const double jerk : {NO_JERK_LIMIT, 20000.0}) {
        for (const int counts : {20, 60, 200, 1000, 4096, 10000}) {
            for (const double rpm : {200.0, 600.0, 1200.0}) {
                Tapping tapping(rpm / 60, 1000.0 / 60 / 0.5, counts);
                ASSERT_TRUE(tapping.run(tapping.ramp, terms(jerk)));
                const double bottom = (tapping.deepest - DEPTH) / PITCH;
                std::printf(
                    "%5d counts, %4.0f rpm, jerk %7.1g: %.5f rev off the helix (%.2f steps), bottom %.4f\n",
                    counts, rpm, jerk, tapping.farthest, tapping.farthest * counts, bottom);
                EXPECT_FALSE(tapping.tap.isLost());
                EXPECT_LE(tapping.farthest, 2.5 / counts + (jerk < NO_JERK_LIMIT ? 0.006 : 0.0015));
                EXPECT_LE(std::abs(bottom), 3.0 / counts + 0.03);
                EXPECT_LE(tapping.highest_a, 1000 * (1 + 1e-9));
            }
        }
    }
}

/// A reversal would include the backlash of the drive, so the tool must not reverse at the start.
TEST(TapFollower, TheReturnToTheStartEndsWithoutAReversal) {
    for (int n = 0; n < 60; ++n) {
        SCOPED_TRACE(n);
        TapTerms t = terms();
        t.acceleration = 400 + 31.7 * n;
        t.per_turn = 0.15 + 0.02 * n;
        t.depth = 6 + 0.1 * n;
        Tapping tapping(500.0 / 60, 150);
        double before = 0, beyond = 0;
        bool wasHome = false;
        ASSERT_TRUE(tapping.run(150, t, [&](Tapping &now) {
            const double x = now.tap.x();
            wasHome = wasHome || (now.tap.phase() == TapPhase::HOME && x > before);
            beyond = wasHome ? std::max(beyond, x) : beyond;
            before = x;
        }));
        EXPECT_TRUE(wasHome);
        EXPECT_LT(beyond, 1e-9);
        EXPECT_EQ(tapping.tap.x(), 0);
        EXPECT_LE(tapping.highest_a, t.acceleration * (1 + 1e-9));
    }
}

TEST(TapFollower, ReversesAtTheBottomIfTheOverrunIsNotKnown) {
    Tapping tapping(1000.0 / 60, 1000.0 / 60 / 0.5);
    ASSERT_TRUE(tapping.run(0, terms()));
    EXPECT_NEAR(tapping.deepest, DEPTH + PITCH * 16.667 * 16.667 / (2 * tapping.ramp), 0.1 * PITCH);
    EXPECT_LE(tapping.farthest, 0.02);
    EXPECT_EQ(tapping.tap.x(), 0);
}

TEST(TapFollower, AStopFollowsTheSpindleToStandstill) {
    for (int at = 0; at < 4000; at += 97) {
        Tapping tapping(1000.0 / 60, 1000.0 / 60 / 0.5);
        int cycle = 0;
        ASSERT_TRUE(tapping.run(tapping.ramp, terms(), [&](Tapping &t) {
            if (cycle++ == at) {
                t.tap.stop(t.reading(t.ramp));
            }
        })) << at;
        const bool isStopped = cycle > at;
        EXPECT_EQ(tapping.tap.spindle_factor(), isStopped ? 0.0 : 1.0) << at;
        EXPECT_LE(tapping.highest_a, 1000 * (1 + 1e-9)) << at;
        EXPECT_FALSE(tapping.tap.isLost());
        if (!std::isnan(tapping.phase) && isStopped && tapping.tap.x() > 1) {
            EXPECT_NEAR(tapping.plant.turns() - tapping.tap.x() / PITCH, tapping.phase, 0.03)
                << "the tap is in its thread, stopped at " << at;
        }
    }
}

TEST(TapFollower, AMissingReversalIsDetectedWithinTheRangeOfTheLine) {
    Tapping tapping(10, 30);
    tapping.tap.begin(terms(), tapping.reading(30), T);
    double last_x = 0, last_v = 0;
    for (int i = 0; i < 20000 && !tapping.tap.isOver(); ++i) {
        tapping.tap.step(tapping.reading(30), T);
        const double v = (tapping.tap.x() - last_x) / T;
        EXPECT_LE(std::abs(v - last_v) / T, 1000 * (1 + 1e-9));
        last_x = tapping.tap.x();
        last_v = v;
        tapping.turn(10);  // the spindle rotates without a command
    }
    EXPECT_TRUE(tapping.tap.isOver());
    EXPECT_TRUE(tapping.tap.isLost());
    EXPECT_EQ(tapping.tap.spindle_factor(), 0);
    EXPECT_LE(tapping.tap.x(), terms().high + 1e-9);
}

TEST(TapFollower, AJumpOfTheEncoderIsNotFollowed) {
    Tapping tapping(10, 30);
    int cycle = 0;
    ASSERT_TRUE(tapping.run(30, terms(), [&](Tapping &t) {
        if (cycle++ == 800) {
            t.plant.lose_counts(-3 * 4096);
        }
    }));
    EXPECT_TRUE(tapping.tap.isLost());
    EXPECT_EQ(tapping.tap.spindle_factor(), 0);
    EXPECT_LE(tapping.highest_a, 1000 * (1 + 1e-9));
}

}  // namespace
}  // namespace mw::trajectory
