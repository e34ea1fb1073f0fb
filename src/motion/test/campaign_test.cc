// SPDX-License-Identifier: GPL-2.0-or-later
// Random programs through path channel, planner, controller and kinematics to the motors of a nine-joint
// machine, with random pauses, overrides, aborts and delays of the planner. Checks the limits at every servo
// sample, that nothing of an old epoch moves, that every command is answered once, and that the end is exact.
// MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST select the seeds.
#include <cstdlib>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

/// Cycles after which overrides no longer change, so that slow programs end.
constexpr int CALM_AFTER = 50000;

class Campaign {
  public:
    Campaign(unsigned seed, bool isJerkLimited) : random_(seed), rig_("XYZABCUVW") {
        for (int j = 0; j < geometry::AXIS_COUNT; ++j) {
            const double v = std::pow(10.0, real(0.7, 2.5));
            const double a = std::pow(10.0, real(1.7, 4.0));
            rig_.set(Parameter::JOINT_MAX_VELOCITY, j, v);
            rig_.set(Parameter::JOINT_MAX_ACCELERATION, j, a);
            rig_.set(Parameter::JOINT_MIN_LIMIT, j, -1e6);
            rig_.set(Parameter::JOINT_MAX_LIMIT, j, 1e6);
            const double jerk = isJerkLimited ? a * std::pow(10.0, real(1, 2.5)) : 1e300;
            limits_.push_back({v, a, jerk});
            if (isJerkLimited) {
                rig_.set(Parameter::JOINT_MAX_JERK, j, jerk);
            }
        }
        rig_.set(Parameter::TRAJ_PLANNER_TYPE, 0, isJerkLimited ? 1 : 0);
        rig_.set(Parameter::MAX_FEED_SCALE, 0, 1.5);
        rig_.ready();
    }

    void run() {
        testing::LimitChecker checker(limits_, MotionRig::T);
        const int programs = whole(1, 3);
        for (int n = 0; n < programs; ++n) {
            drive(checker, n + 1 == programs);
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        std::map<CommandId, int> count;
        for (const Answer &a : rig_.answers) {
            ++count[a.id];
        }
        for (CommandId id = 1; id < rig_.next_id; ++id) {
            EXPECT_EQ(count[id], 1) << "answers to command " << id;
        }
        EXPECT_TRUE(rig_.faults.empty());
    }

  private:
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    bool chance(double p) { return real(0, 1) < p; }

    void sample(testing::LimitChecker &checker) {
        rig_.isPlannerAlive = !chance(0.01);
        rig_.step();
        double p[geometry::AXIS_COUNT];
        for (std::size_t j = 0; j < geometry::AXIS_COUNT; ++j) {
            p[j] = rig_.out->joint[j].motor_pos_cmd;
        }
        checker.sample(p);
    }

    PathBody next_move(geometry::Pose &at, double size, int axes, const MoveTerms &terms) {
        geometry::Pose to = at;
        if (chance(0.3)) {
            Arc arc;
            const double radius = size * real(0.1, 2);
            const double phase = real(0, 6.28);
            arc.angle_rad = real(0.1, 7) * (chance(0.5) ? 1 : -1);
            arc.normal[2] = 1;
            arc.centre = at;
            arc.centre[0] -= radius * std::cos(phase);
            arc.centre[1] -= radius * std::sin(phase);
            to[0] = arc.centre[0] + radius * std::cos(phase + arc.angle_rad);
            to[1] = arc.centre[1] + radius * std::sin(phase + arc.angle_rad);
            to[2] += chance(0.5) ? size * real(-1, 1) : 0;
            arc.end = to;
            arc.terms = terms;
            at = to;
            return arc;
        }
        for (int i = 0; i < axes; ++i) {
            to[i] += chance(0.7) ? size * real(-1, 1) : 0;
        }
        at = to;
        return Line{to, terms};
    }

    void drive(testing::LimitChecker &checker, bool isLast) {
        geometry::Pose at = rig_.status().carte_pos_cmd;
        const double size = std::pow(10.0, real(-1.5, 1.2));
        const int axes = whole(1, 9);
        const int count = whole(5, 80);
        MoveTerms terms;
        terms.mode = static_cast<PathMode>(whole(0, 2));
        terms.tolerance = chance(0.2) ? 0 : std::pow(10.0, real(-3, 0));
        const int abort_after = !isLast || chance(0.3) ? whole(10, 3000) : -1;
        int sent = 0;
        CommandId flush = 0;
        bool isPaused = false;
        for (int n = 0; n < 5000000; ++n) {
            while (sent < count && chance(0.2)) {
                if (chance(0.05)) {
                    terms.mode = static_cast<PathMode>(whole(0, 2));
                    terms.tolerance = chance(0.2) ? 0 : std::pow(10.0, real(-3, 0));
                }
                terms.feed = chance(0.2) ? 0 : std::pow(10.0, real(0.3, 2.2));
                terms.isRapid = terms.feed == 0;
                terms.source.block = static_cast<std::uint32_t>(sent);
                rig_.send_path(next_move(at, size, axes, terms));
                ++sent;
            }
            if (sent == count && flush == 0) {
                flush = rig_.send_path(Flush{});
            }
            if (chance(isPaused ? 0.02 : 0.002)) {
                isPaused = !isPaused;
                rig_.send(isPaused ? CommandBody(Pause{}) : CommandBody(Resume{}));
            }
            if (n == CALM_AFTER) {
                rig_.send(SetScale{Scale::FEED, 0, 1.5});
            }
            if (n < CALM_AFTER && chance(0.003)) {
                rig_.send(SetScale{Scale::FEED, 0, real(0.05, 1.5)});
                rig_.send(SetScale{Scale::RAPID, 0, real(0.1, 1)});
            }
            sample(checker);
            if (n == abort_after) {
                abort(checker);
                return;
            }
            if (flush != 0 && rig_.isDone(flush)) {
                sample(checker);
                expect_at(at);
                return;
            }
        }
        FAIL() << "the program does not end";
    }

    /// The stop takes no longer than the limits permit, and afterwards nothing of the old epoch moves.
    void abort(testing::LimitChecker &checker) {
        rig_.send(Abort{rig_.epoch + 1});
        geometry::Pose far = rig_.status().carte_pos_cmd;
        far[0] += 1000;
        for (int i = 0; i < 5; ++i) {
            rig_.send_path(Line{far, {}});
        }
        for (int n = 0; n < 20000 && (n < 20 || !rig_.status().isInPosition); ++n) {
            sample(checker);
        }
        EXPECT_TRUE(rig_.status().isInPosition);
        const geometry::Pose stood = rig_.status().carte_pos_cmd;
        for (int n = 0; n < 100; ++n) {
            sample(checker);
        }
        EXPECT_EQ(rig_.status().carte_pos_cmd, stood);
        ++rig_.epoch;
    }

    void expect_at(const geometry::Pose &at) {
        for (int j = 0; j < geometry::AXIS_COUNT; ++j) {
            EXPECT_EQ(rig_.out->joint[static_cast<std::size_t>(j)].motor_pos_cmd, at[j]) << "joint " << j;
        }
    }

    std::mt19937 random_;
    MotionRig rig_;
    std::vector<testing::AxisLimit> limits_;
};

void run_all(bool isJerkLimited) {
    const auto [first, count] = testing::campaign_seeds(isJerkLimited ? 16 : 40);
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        const auto seed = static_cast<unsigned>(first + i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        Campaign(seed, isJerkLimited).run();
    }
}

TEST(MotionCampaign, RandomProgramsWithAbortsKeepTheLimits) {
    run_all(false);
}

TEST(MotionCampaign, RandomProgramsWithAbortsKeepJerkLimits) {
    run_all(true);
}

TEST(MotionCampaign, TheSameProgramTwiceGivesTheSameBits) {
    std::vector<double> runs[2];
    for (std::vector<double> &run : runs) {
        MotionRig rig;
        rig.ready();
        std::mt19937 random(7);
        std::uniform_real_distribution<double> unit(-5, 5);
        for (int i = 0; i < 50; ++i) {
            geometry::Pose p;
            p[0] = unit(random);
            p[1] = unit(random);
            rig.line(p, 60, PathMode::BLEND, 0.05);
        }
        const CommandId flush = rig.send_path(Flush{});
        rig.run_until([&] {
            run.push_back(rig.out->joint[0].motor_pos_cmd);
            run.push_back(rig.out->joint[1].motor_pos_cmd);
            return rig.isDone(flush);
        });
    }
    EXPECT_GT(runs[0].size(), 1000U);
    EXPECT_EQ(runs[0], runs[1]);
}

}  // namespace
}  // namespace mw::motion
