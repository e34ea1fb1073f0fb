// SPDX-License-Identifier: GPL-2.0-or-later
// Random joints and gantries are homed on simulated axes, intact and broken ones. The judge knows the true
// positions of the slides and the fault, but not how homing works.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "motion/test/homing_rig.hh"
#include "tests/support/campaign_seeds.hh"
#include "tests/support/limit_checker.hh"

namespace mw::motion {
namespace {

using ::mw::testing::HomingRig;
using ::mw::testing::MotionRig;

enum class Manner { SWITCH, SWITCH_AND_INDEX, INDEX_ONLY, IMMEDIATE, ABSOLUTE, ABSOLUTE_STAYING };
enum class Broken { NOTHING, SWITCH_OPEN, SWITCH_CLOSED, INDEX, LIMIT, ABORT, OFF };

/// One machine and its expected outcome.
struct Plan {
    std::mt19937_64 random;
    Manner manner{};
    Broken broken{};
    bool isGantry = false, isReset = true, isSameWay = false;
    double velocity = 0, acceleration = 0, search = 0, latch = 0, home = 0, offset = 0, scale = 1, skew = 0;
    double bounce_s = 0, play = 0, lag_s = 0, pitch = 0;
    int broken_joint = 0, broken_after = 0;
    std::vector<plants::HomeAxis::Build> axes;

    double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random); }
    bool isOneIn(int n) { return std::uniform_int_distribution<>(1, n)(random) == 1; }
    int count() const { return isGantry ? 2 : 1; }
    bool hasSwitch() const { return manner == Manner::SWITCH || manner == Manner::SWITCH_AND_INDEX; }
    bool hasIndex() const { return manner == Manner::INDEX_ONLY || manner == Manner::SWITCH_AND_INDEX; }
    bool isMoving() const { return hasSwitch() || hasIndex(); }

    explicit Plan(std::uint64_t seed) : random(seed) {
        isGantry = isOneIn(3);
        manner = static_cast<Manner>(std::uniform_int_distribution<>(0, isOneIn(3) ? 5 : 2)(random));
        velocity = between(10, 100);
        acceleration = between(100, 2000);
        const double way = isOneIn(2) ? 1.0 : -1.0;
        search = hasSwitch() ? way * between(2, std::min(velocity, 40.0)) : 0.0;
        latch = isMoving() ? (isOneIn(2) ? 1.0 : -1.0) * between(0.5, 5) : 0.0;
        isSameWay = (search > 0) == (latch > 0);
        home = between(-20, 20);
        offset = between(-20, 20);
        scale = isOneIn(3) ? between(0.3, 1.2) : 1.0;
        lag_s = isOneIn(3) ? between(0.001, 0.005) : 0.0;
        bounce_s = hasSwitch() && isOneIn(3) ? between(0.001, 0.008) : 0.0;
        play = manner == Manner::SWITCH && !isGantry && isOneIn(3) ? between(0.01, 0.1) : 0.0;
        pitch = between(2, 10);
        isReset = isOneIn(2);
        skew = between(2, 6);
        const double start = between(-50, 50);
        const double to_switch = way * between(-5, 60);  // below 0: starts on the switch
        const double part = between(0.25, 0.75);
        for (int j = 0; j < count(); ++j) {
            plants::HomeAxis::Build b;
            b.start = start;
            b.switch_at = start + to_switch + (j == 1 ? between(-0.4, 0.4) * skew : 0.0);
            b.closed_above = way > 0;
            b.play = play;
            b.lag_s = lag_s;
            b.index_pitch = hasIndex() ? pitch : 0.0;
            b.index_phase = (hasSwitch() ? b.switch_at : start) + part * pitch;
            b.is_reset_by_index = isReset;
            b.bounce_s = bounce_s;
            b.seed = static_cast<std::uint32_t>(random());
            axes.push_back(b);
        }
        choose_fault();
    }
    void choose_fault() {
        if (!isOneIn(3)) {
            return;
        }
        broken_joint = isGantry && isOneIn(2) ? 1 : 0;
        broken_after = std::uniform_int_distribution<>(0, 3000)(random);
        const int kind = std::uniform_int_distribution<>(1, 6)(random);
        broken = static_cast<Broken>(kind);
        const bool isSwitch = broken == Broken::SWITCH_OPEN || broken == Broken::SWITCH_CLOSED;
        if ((isSwitch && !hasSwitch()) || (broken == Broken::INDEX && !hasIndex())) {
            broken = Broken::ABORT;
        }
    }
    /// True position of the slide when joint j reports 0.
    double true_zero(int j) const {
        const plants::HomeAxis::Build &b = axes[static_cast<std::size_t>(j)];
        if (!isMoving()) {
            return b.start - offset;
        }
        const double from = hasSwitch() ? b.switch_at : b.start;
        if (!hasIndex()) {
            return from - offset;
        }
        const double ahead = b.index_phase - from;
        return from + (latch > 0 ? ahead : ahead - pitch) - offset;
    }
    double tolerance() const {
        const double speed = std::abs(latch) * std::max(1.0, scale);
        // The switch is seen in the next cycle; with bounce, in the cycle after the contact has settled.
        // Backlash is compensated when the joint reversed just before.
        const double seen_after_s = MotionRig::T + (bounce_s > 0 ? bounce_s + MotionRig::T : 0.0);
        return speed * seen_after_s + (isSameWay ? 0.0 : play) + 1e-9;
    }
};

struct Judge {
    Plan plan;
    HomingRig m;
    double widest = 0;
    int homed_at = -1;  ///< cycle
    std::string complaint;

    explicit Judge(std::uint64_t seed) : plan(seed), m(plan.isGantry ? "XX" : "X") {
        m.set_up(plan.axes);
        for (int j = 0; j < plan.count(); ++j) {
            m.set(Parameter::JOINT_MAX_VELOCITY, plan.velocity, j);
            m.set(Parameter::JOINT_MAX_ACCELERATION, plan.acceleration, j);
            m.set(Parameter::JOINT_MIN_LIMIT, -100, j);
            m.set(Parameter::JOINT_MAX_LIMIT, 100, j);
            m.set(Parameter::JOINT_BACKLASH, plan.play, j);
            m.set(Parameter::JOINT_HOME, plan.home, j);
            // The sides of a gantry are square at the positions of their switches.
            m.set(Parameter::JOINT_HOME_OFFSET, plan.offset, j);
            m.set(Parameter::JOINT_HOME_USE_INDEX, plan.hasIndex(), j);
            m.set(Parameter::JOINT_HOME_INDEX_NO_ENCODER_RESET, plan.isReset ? 0 : 1, j);
            const int mode = plan.manner == Manner::ABSOLUTE           ? 1
                             : plan.manner == Manner::ABSOLUTE_STAYING ? 2
                                                                       : 0;
            m.set(Parameter::JOINT_HOME_ABSOLUTE_ENCODER, mode, j);
            m.set(Parameter::JOINT_HOME_SEQUENCE, plan.isGantry ? -1 : 0, j);
            m.set(Parameter::JOINT_HOME_MAX_SKEW, plan.skew, j);
            m.set_switch(j, plan.search, plan.latch);
        }
        m.rig.set(Parameter::MAX_FEED_SCALE, 0, 1.2);
        m.rig.send(SetScale{Scale::FEED, 0, plan.scale});
        m.rig.send(Enable{});
        m.rig.step(3);
    }
    void breaks() {
        plants::HomeAxis::Faults &faults = m.axes[static_cast<std::size_t>(plan.broken_joint)].faults;
        switch (plan.broken) {
        case Broken::NOTHING: break;
        case Broken::SWITCH_OPEN: faults.switch_open = true; break;
        case Broken::SWITCH_CLOSED: faults.isSwitchClosed = true; break;
        case Broken::INDEX: faults.index_missing = true; break;
        case Broken::LIMIT:
            m.rig.in.joint[static_cast<std::size_t>(plan.broken_joint)].isNegLimitClosed = true;
            break;
        case Broken::ABORT: m.rig.send(Abort{2}); break;
        case Broken::OFF: m.rig.send(Disable{}); break;
        }
    }
    /// Returns true if homed. A violated rule is in `complaint`.
    bool run() {
        const double share = plan.play > 0 ? 1.5 : 1.0;  // backlash is compensated additionally
        const mw::testing::AxisLimit most{share * plan.velocity, share * plan.acceleration};
        std::vector<mw::testing::LimitChecker> checkers(static_cast<std::size_t>(plan.count()),
                                                        mw::testing::LimitChecker({most}, MotionRig::T));
        std::vector<bool> wasWanted(2, false);
        // A fault from the start is set before homing begins; other faults follow at their time.
        m.rig.send(Home{-1});
        int n = 0;
        int rest = 600;
        constexpr int LONGEST = 3000000;  // twice the range at the slowest latch velocity
        for (; n < LONGEST && rest > 0; ++n) {
            if (n == plan.broken_after) {
                breaks();
            }
            m.rig.step();
            homed_at = homed_at < 0 && m.isHomed(0) && m.isHomed(plan.count() - 1) ? n : homed_at;
            rest -= n > 5 && !m.rig.status().isHoming ? 1 : 0;
            for (int j = 0; j < plan.count(); ++j) {
                const auto i = static_cast<std::size_t>(j);
                const bool isWanted = m.rig.out->joint[i].isIndexEnabled;
                if (wasWanted[i] && !isWanted) {
                    checkers[i].restart();  // the encoder was reset
                }
                wasWanted[i] = isWanted;
                if (m.rig.status().isEnabled) {
                    checkers[i].sample(&m.rig.out->joint[i].motor_pos_cmd);
                }
            }
            if (plan.isGantry) {
                widest = std::max(widest, std::abs((m.axes[0].slide() - plan.axes[0].start) -
                                                   (m.axes[1].slide() - plan.axes[1].start)));
            }
        }
        for (const auto &checker : checkers) {
            complaint += checker.report();
        }
        if (rest > 0) {
            complaint += "does not end\n";
        }
        if (plan.isGantry && widest > plan.skew + 1e-9) {
            complaint += "skew " + std::to_string(widest) + " of " + std::to_string(plan.skew) + "\n";
        }
        judge_end(n > plan.broken_after && plan.broken != Broken::NOTHING);
        return m.isHomed(0) && m.isHomed(plan.count() - 1);
    }
    void judge_end(bool isBroken) {
        // During the search for the edge, a broken contact cannot be distinguished from a good one.
        const bool isSwitchBroken =
            plan.broken == Broken::SWITCH_OPEN || plan.broken == Broken::SWITCH_CLOSED;
        const bool hasLied = isSwitchBroken && homed_at > plan.broken_after;
        for (int j = 0; j < plan.count() && !hasLied; ++j) {
            const double error = m.zero(j) - plan.true_zero(j);
            if (m.isHomed(j) && std::abs(error) > plan.tolerance()) {
                complaint += "joint " + std::to_string(j) + " is off by " + std::to_string(error) + " of " +
                             std::to_string(plan.tolerance()) + "\n";
            }
            const double end = plan.manner == Manner::ABSOLUTE_STAYING ? plan.offset : plan.home;
            if (m.isHomed(j) && !isBroken && std::abs(m.pos_cmd(j) - end) > 1e-9) {
                complaint += "is not at HOME\n";
            }
        }
        const bool isHomed = m.isHomed(0) && m.isHomed(plan.count() - 1);
        const bool isSilent = plan.broken == Broken::ABORT || plan.broken == Broken::OFF;
        bool isTold = false;
        for (const Fault &f : m.rig.faults) {
            isTold = isTold || (f.kind == FaultKind::HOMING_FAILED && f.index >= 0 && f.index < plan.count());
        }
        if (!isHomed && !isBroken) {
            complaint += "did not home: " + m.fault() + "\n";
        }
        if (!isHomed && isBroken && !isSilent && !isTold) {
            complaint += "failed without a word: " + m.fault() + "\n";
        }
        if (isHomed && isTold) {
            complaint += "homed, and said that it has not: " + m.fault() + "\n";
        }
    }
};

TEST(HomingJudge, RandomJointsAreHomedToTheirTrueZeroOrReportAReason) {
    const auto range = mw::testing::campaign_seeds(150);
    std::map<std::string, int> counts;
    int sound = 0, broken = 0, homed_sound = 0, homed_broken = 0, gantries = 0;
    for (int seed = range.first; seed < range.first + range.count; ++seed) {
        Judge judge(static_cast<std::uint64_t>(seed));
        const bool isHomed = judge.run();
        EXPECT_EQ(judge.complaint, "")
            << "seed " << seed << " manner " << static_cast<int>(judge.plan.manner) << " broken "
            << static_cast<int>(judge.plan.broken) << " gantry " << judge.plan.isGantry;
        const bool isSound = judge.plan.broken == Broken::NOTHING;
        (isSound ? sound : broken) += 1;
        (isSound ? homed_sound : homed_broken) += isHomed ? 1 : 0;
        gantries += judge.plan.isGantry ? 1 : 0;
        if (!isHomed) {
            ++counts[judge.m.fault().empty() ? "aborted or off" : judge.m.fault()];
        }
    }
    std::printf("%d sound: %d homed; %d with a fault: %d homed before it mattered; %d gantries\n", sound,
                homed_sound, broken, homed_broken, gantries);
    for (const auto &[text, count] : counts) {
        std::printf("%5d %s\n", count, text.c_str());
    }
    EXPECT_EQ(homed_sound, sound);
    EXPECT_GT(broken - homed_broken, broken / 4);
}

}  // namespace
}  // namespace mw::motion
