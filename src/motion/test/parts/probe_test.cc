// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "motion/servo/probe/probe.hh"

namespace mw::motion {
namespace {

geometry::Pose at(double x) {
    geometry::Pose p;
    p[0] = x;
    return p;
}

ProbeInputs probing(bool isClosed, bool isAway = false, trajectory::Sequence move = 5) {
    ProbeInputs in;
    in.isClosed = isClosed;
    in.probing_move = move;
    in.isAway = isAway;
    return in;
}

TEST(ProbePart, AProbingMoveEndsWhereItTripsAndOnlyOnce) {
    TouchProbe probe;
    EXPECT_EQ(step(probe, probing(false), at(1)), ProbeEvent::NONE);
    EXPECT_EQ(step(probe, probing(true), at(2)), ProbeEvent::FOUND);
    EXPECT_EQ(step(probe, probing(true), at(3)), ProbeEvent::NONE);
    EXPECT_EQ(probe.position[0], 2);
    EXPECT_EQ(probe.trips, 1U);
}

TEST(ProbePart, AMoveAwayEndsWhereContactIsLost) {
    TouchProbe probe;
    EXPECT_EQ(step(probe, probing(true, true), at(1)), ProbeEvent::NONE);
    EXPECT_EQ(step(probe, probing(false, true), at(2)), ProbeEvent::FOUND);
}

TEST(ProbePart, EachProbingMoveBeginsAnew) {
    TouchProbe probe;
    step(probe, probing(true), at(1));
    EXPECT_EQ(step(probe, probing(true, false, 6), at(4)), ProbeEvent::FOUND);
    EXPECT_EQ(probe.trips, 2U);
    take(probe, ClearProbeFlag{});
    EXPECT_FALSE(probe.isTripped);
}

TEST(ProbePart, TouchedInAnotherMoveIsTold) {
    TouchProbe probe;
    ProbeInputs in;
    in.isClosed = true;
    EXPECT_EQ(step(probe, in, at(0)), ProbeEvent::NONE) << "nothing moves";
    in.isMoving = true;
    EXPECT_EQ(step(probe, in, at(0)), ProbeEvent::TOUCHED);
    probe.wasClosed = true;
    EXPECT_EQ(step(probe, in, at(0)), ProbeEvent::NONE) << "it is the edge that counts";
}

TEST(ProbePart, BrakingBehindAContactIsNoTouch) {
    TouchProbe probe;
    step(probe, probing(true), at(1));
    ProbeInputs in;
    in.isClosed = in.isMoving = in.isDropping = true;
    EXPECT_EQ(step(probe, in, at(2)), ProbeEvent::NONE);
}

/// An earlier trip excuses no contact that comes while nothing brakes, and no braking one that follows no
/// trip.
TEST(ProbePart, ATripOrAStopAloneExcusesNoContact) {
    TouchProbe probe;
    ProbeInputs in;
    in.isClosed = in.isMoving = in.isDropping = true;
    EXPECT_EQ(step(probe, in, at(2)), ProbeEvent::TOUCHED) << "nothing has been probed";
    step(probe, probing(true), at(1));
    in.isDropping = false;
    EXPECT_EQ(step(probe, in, at(2)), ProbeEvent::TOUCHED) << "its stop is over";
}

}  // namespace
}  // namespace mw::motion
