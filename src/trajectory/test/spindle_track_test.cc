// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "components/plants/spindle_plant.hh"
#include "trajectory/follow/spindle_track.hh"

namespace mw::trajectory {
namespace {

constexpr double T = 1e-3;
constexpr int ENCODERS[] = {20, 60, 200, 1000, 4096, 10000};

plants::SpindlePlant spindle_of(int counts) {
    plants::SpindleTraits traits;
    traits.ramp = 33;
    traits.counts_per_turn = counts;
    return plants::SpindlePlant(traits);
}

struct Observed : testing::Test {
    SpindleTrack track;
    void run(plants::SpindlePlant &spindle, double rps, double seconds) {
        for (int i = 0; i < seconds / T; ++i) {
            spindle.run(rps, 0, T);
            track.take(spindle.shown_turns(), T);
        }
    }
};

TEST_F(Observed, TheStepOfTheEncoderIsKnownSoonAfterTheStart) {
    for (const int counts : ENCODERS) {
        for (const double rps : {1.5, 16.0, 50.0}) {
            SCOPED_TRACE(::testing::Message() << counts << " counts, " << rps << " rev/s");
            track = {};
            plants::SpindlePlant spindle = spindle_of(counts);
            run(spindle, rps, 0.5 + rps / 33);
            EXPECT_NEAR(track.step() * counts, 1, 0.05);
            run(spindle, -rps, 2 * rps / 33);
            EXPECT_NEAR(track.step() * counts, 1, 0.5) << "while it changes its speed";
        }
    }
}

/// One reading is wrong, by a fraction of a step or by much more.
TEST_F(Observed, AWrongReadingHardlyChangesTheStep) {
    for (const int counts : ENCODERS) {
        for (const double error : {2e-6, 3e-5, 0.01, 0.2, 3.0}) {
            SCOPED_TRACE(::testing::Message() << counts << " counts, wrong by " << error);
            track = {};
            plants::SpindlePlant spindle = spindle_of(counts);
            run(spindle, 16.13, 1);
            track.take(spindle.shown_turns() + error, T);
            run(spindle, 16.13, 0.02);
            EXPECT_NEAR(track.step() * counts, 1, 0.1) << "no longer than its effect on the counts";
            run(spindle, 16.13, 1);
            EXPECT_NEAR(track.step() * counts, 1, 0.05);
        }
    }
}

TEST_F(Observed, AWrongFirstReadingIsForgotten) {
    for (const int counts : ENCODERS) {
        track = {};
        plants::SpindlePlant spindle = spindle_of(counts);
        track.take(0.0, T);
        track.take(0.2 / counts, T);
        run(spindle, 16.13, 3);
        EXPECT_NEAR(track.step() * counts, 1, 0.05) << counts;
    }
}

}  // namespace
}  // namespace mw::trajectory
