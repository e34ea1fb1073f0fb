// SPDX-License-Identifier: GPL-2.0-or-later
#include <limits>

#include <gtest/gtest.h>

#include "machine/certificate/motion_certificate.hh"

namespace mw::machine {
namespace {

/// One axis and its joint; a line of 1 unit at 1 unit/s.
class MotionCertificateTest : public ::testing::Test {
  protected:
    MotionCertificateTest() {
        settings_.coordinates = {{LimitedCoordinate::Type::AXIS, 0, false, {2, UNLIMITED, UNLIMITED}},
                                 {LimitedCoordinate::Type::JOINT, 0, false, {1, UNLIMITED, UNLIMITED}}};
    }
    void send(double start, double end) {
        motion::Line line;
        line.end[0] = end;
        line.terms.mode = mode_;
        line.terms.tolerance = 0.01;
        line.terms.source.line = static_cast<int>(++id_);
        const motion::PathBody body = line;
        geometry::Pose from;
        from[0] = start;
        certificate().on_move({id_, from, body});
    }
    motion::TraceSample sample(double x) {
        motion::TraceSample s;
        s.cycle = ++cycle_;
        s.time_ns = static_cast<std::int64_t>(cycle_) * 1000000;
        s.isEnabled = 1;
        s.path_id = id_;
        s.carte_pos_cmd[0] = s.programmed_pos_cmd[0] = s.joint_pos_cmd[0] = x;
        return s;
    }
    void drive(double from, double to) {
        const int steps = static_cast<int>(std::abs(to - from) * 1000 + 0.5);
        for (int i = 0; i <= steps; ++i) {
            certificate().on_sample(sample(from + (to - from) * i / steps));
        }
    }
    MotionCertificate &certificate() {
        if (!made_.has_value()) {
            made_.emplace(settings_);
        }
        return *made_;
    }
    Certificate result(ProgramEnd end = ProgramEnd::COMPLETE) {
        certificate().finish(end);
        return certificate().result();
    }

    static constexpr double UNLIMITED = std::numeric_limits<double>::infinity();
    CertificateSettings settings_;
    geometry::PathMode mode_ = geometry::PathMode::BLEND;
    motion::CommandId id_ = 0;
    std::uint64_t cycle_ = 0;
    std::optional<MotionCertificate> made_;
};

TEST_F(MotionCertificateTest, TellsRatiosAndSamples) {
    send(0, 1);
    drive(0, 1);
    const Certificate found = result();
    EXPECT_NEAR(found.uses[0].ratio(0), 0.5, 1e-9);
    EXPECT_NEAR(found.uses[1].ratio(0), 1, 1e-9);
    EXPECT_EQ(found.uses[1].largest[0].source.line, 1);
    EXPECT_EQ(found.samples, 1001U);
    EXPECT_EQ(found.lost_samples, 0U);
    EXPECT_TRUE(found.isWithinLimits());
    EXPECT_TRUE(found.isWithinTolerance());
}

TEST_F(MotionCertificateTest, ALowerLimitIsExceededInItsLine) {
    settings_.coordinates[1].limit[0] = 0.9;
    send(0, 0.5);
    send(0.5, 1);
    id_ = 1;
    drive(0, 0.5);
    id_ = 2;
    for (int i = 1; i <= 250; ++i) {
        certificate().on_sample(sample(0.5 + 0.002 * i));
    }
    const Certificate found = result();
    EXPECT_FALSE(found.isWithinLimits());
    EXPECT_NEAR(found.uses[1].ratio(0), 2 / 0.9, 1e-9);
    EXPECT_EQ(found.uses[1].largest[0].source.line, 2);
}

TEST_F(MotionCertificateTest, MotionOutsideOfTheProgramDoesNotCount) {
    send(0, 1);
    drive(0, 1);
    for (int i = 0; i < 200; ++i) {  // a jog at 5 units/s after some time
        motion::TraceSample s = sample(1 + 0.005 * std::max(0, i - 50));
        s.path_id = 0;
        certificate().on_sample(s);
    }
    for (int i = 0; i < 4; ++i) {
        motion::TraceSample s = sample(1.75);
        s.path_id = 0;
        certificate().on_sample(s);
    }
    send(1.75, 2);
    drive(1.75, 2);
    const Certificate found = result();
    EXPECT_NEAR(found.uses[0].ratio(0), 0.5, 1e-9);
    EXPECT_LT(found.deviations.largest.distance(), 1e-12);
}

TEST_F(MotionCertificateTest, MotionAfterTheLastMoveHasEndedCounts) {
    send(0, 1);
    drive(0, 0.8);
    for (int i = 1; i <= 100; ++i) {  // the moving average arrives, at twice the speed
        motion::TraceSample s = sample(0.8 + 0.002 * i);
        s.path_id = 0;
        s.isInMotion = i < 100 ? 1 : 0;
        certificate().on_sample(s);
    }
    const Certificate found = result();
    EXPECT_NEAR(found.uses[1].ratio(0), 2, 1e-9);
    EXPECT_LT(found.deviations.largest.distance(), 1e-12);
}

TEST_F(MotionCertificateTest, ExternalOffsetsAreMotionAndNoDeviation) {
    send(0, 1);
    for (int i = 0; i <= 1000; ++i) {
        motion::TraceSample s = sample(0.001 * i);
        s.carte_pos_cmd[0] += 0.0005 * i;
        certificate().on_sample(s);
    }
    const Certificate found = result();
    EXPECT_NEAR(found.uses[0].ratio(0), 0.75, 1e-9);
    EXPECT_LT(found.deviations.largest.distance(), 1e-12);
}

TEST_F(MotionCertificateTest, AReverseRunIsNoDeviation) {
    send(0, 1);
    drive(0, 0.6);
    for (int i = 600; i >= 200; --i) {
        motion::TraceSample s = sample(0.001 * i);
        s.isRetracing = 1;
        certificate().on_sample(s);
    }
    for (int i = 200; i < 600; ++i) {
        motion::TraceSample s = sample(0.001 * i);
        s.isRetracing = 1;
        certificate().on_sample(s);
    }
    drive(0.6, 1);
    EXPECT_LT(result().deviations.largest.distance(), 1e-12);
}

TEST_F(MotionCertificateTest, LostCyclesAreToldAndNotDifferenced) {
    send(0, 1);
    drive(0, 0.5);
    cycle_ += 100;
    drive(0.6, 1);
    const Certificate found = result();
    EXPECT_EQ(found.lost_samples, 100U);
    EXPECT_NEAR(found.uses[0].ratio(0), 0.5, 1e-9);
}

TEST_F(MotionCertificateTest, OnlyACompleteProgramHasToReachItsEnd) {
    send(0, 1);
    drive(0, 0.5);
    const MotionCertificate stopped = certificate();
    made_ = stopped;
    EXPECT_LT(result(ProgramEnd::STOPPED).deviations.largest.distance(), 1e-12);
    made_ = stopped;
    EXPECT_NEAR(result(ProgramEnd::COMPLETE).deviations.largest.distance(), 0.5, 1e-9);
}

}  // namespace
}  // namespace mw::machine
