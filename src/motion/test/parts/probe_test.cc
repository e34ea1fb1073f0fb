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

Status status_of(const TouchProbe &probe) {
    Status status;
    probe.fill(false, status);
    return status;
}

ProbeInputs probing(bool isClosed, bool isAway = false, trajectory::Sequence move = 5) {
    ProbeInputs in;
    in.isClosed = isClosed;
    in.probing_move = move;
    in.isAway = isAway;
    return in;
}

TEST(ProbePart, AProbingMoveEndsOnceWhenItTrips) {
    TouchProbe probe;
    EXPECT_EQ(probe.step(probing(false), at(1)), ProbeEvent::NONE);
    EXPECT_EQ(probe.step(probing(true), at(2)), ProbeEvent::FOUND);
    EXPECT_EQ(probe.step(probing(true), at(3)), ProbeEvent::NONE);
    EXPECT_EQ(status_of(probe).probed_pos[0], 2);
    EXPECT_EQ(probe.trips(), 1U);
}

TEST(ProbePart, AMoveAwayEndsWhereContactIsLost) {
    TouchProbe probe;
    EXPECT_EQ(probe.step(probing(true, true), at(1)), ProbeEvent::NONE);
    EXPECT_EQ(probe.step(probing(false, true), at(2)), ProbeEvent::FOUND);
}

TEST(ProbePart, EachProbingMoveStartsWithoutAContact) {
    TouchProbe probe;
    probe.step(probing(true), at(1));
    EXPECT_EQ(probe.step(probing(true, false, 6), at(4)), ProbeEvent::FOUND);
    EXPECT_EQ(probe.trips(), 2U);
    probe.take(ClearProbeFlag{});
    EXPECT_FALSE(status_of(probe).isProbeTripped);
}

TEST(ProbePart, AContactInAnotherMoveIsReported) {
    TouchProbe probe;
    ProbeInputs in;
    in.isClosed = true;
    EXPECT_EQ(probe.step(in, at(0)), ProbeEvent::NONE) << "nothing moves";
    in.isMoving = true;
    EXPECT_EQ(probe.step(in, at(0)), ProbeEvent::TOUCHED);
    probe.end_cycle(true);
    EXPECT_EQ(probe.step(in, at(0)), ProbeEvent::NONE) << "it is the edge that counts";
}

TEST(ProbePart, BrakingAfterAContactIsNoNewContact) {
    TouchProbe probe;
    probe.step(probing(true), at(1));
    ProbeInputs in;
    in.isClosed = in.isMoving = in.isDropping = true;
    EXPECT_EQ(probe.step(in, at(2)), ProbeEvent::NONE);
}

/// An earlier trip does not excuse contact while nothing brakes; braking does not excuse contact without a
/// trip.
TEST(ProbePart, ATripOrAStopAloneDoesNotExcuseAContact) {
    TouchProbe probe;
    ProbeInputs in;
    in.isClosed = in.isMoving = in.isDropping = true;
    EXPECT_EQ(probe.step(in, at(2)), ProbeEvent::TOUCHED) << "nothing has been probed";
    probe.step(probing(true), at(1));
    in.isDropping = false;
    EXPECT_EQ(probe.step(in, at(2)), ProbeEvent::TOUCHED) << "its stop is over";
}

}  // namespace
}  // namespace mw::motion
