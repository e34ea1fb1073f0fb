// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs with a lease, checked by samples of the trace alone: a renewed jog keeps its speed, any other stops
// within the lease and a servo cycle, and a stopped jog does not continue. MW_CAMPAIGN_SEEDS and
// MW_CAMPAIGN_FIRST select the seeds.
#include <array>
#include <map>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace lease_test {
namespace {

using testing::MotionRig;

constexpr double T = MotionRig::T;
constexpr double S_TO_NS = 1e9;
/// Effect of position rounding on speeds [unit/s].
constexpr double SPEED_ROUNDING = 1e-6;

/// Facts that the test knows of a jog: its requests and answers, not its execution.
class JogJudge {
  public:
    JogJudge(double acceleration, double jerk)
        : acceleration_(acceleration), settling_s_((jerk > 0 ? 4.0 * acceleration / jerk : 0.0) + 3.0 * T),
          isJerkLimited_(jerk > 0) {}

    void take(double velocity, double lease_s, std::int64_t now_ns) {
        const bool isOther = state_ != State::HELD || velocity != velocity_;
        const bool wasSettled = isSettled();
        state_ = State::HELD;
        velocity_ = velocity;
        end_ns_ = now_ns + static_cast<std::int64_t>(std::llround(lease_s * S_TO_NS));
        if (isOther) {
            change(wasSettled);
        }
    }
    void scale(double factor) {
        const bool wasSettled = isSettled();
        const bool isOther = factor != scale_;
        scale_ = factor;
        if (isOther && state_ == State::HELD) {
            change(wasSettled);
        }
    }
    void stop() {
        if (state_ == State::HELD) {
            end();
        }
    }
    void switch_off() {
        if (state_ != State::STANDING) {
            state_ = State::OFF;
        }
    }
    bool isHeld() const { return state_ == State::HELD; }
    bool isStanding() const { return state_ == State::STANDING; }
    int ended_leases = 0, cruising_cycles = 0;

    void sample(double position, std::int64_t now_ns) {
        const double v = (position - position_) / T;
        position_ = position;
        const bool isOver = state_ == State::HELD && now_ns >= end_ns_;
        if (isOver) {
            ++ended_leases;
            end();
        }
        switch (state_) {
        case State::HELD: judge_held(v); break;
        case State::BRAKING: judge_braking(v); break;
        case State::OFF: state_ = State::STANDING; break;
        case State::STANDING: EXPECT_NEAR(v, 0, SPEED_ROUNDING) << "it moves without a jog"; break;
        }
        speed_ = std::abs(v);
        ++cycles_;
    }

  private:
    enum class State { STANDING, HELD, BRAKING, OFF };

    double wanted() const { return std::abs(velocity_) * scale_; }
    void change(bool wasSettled) {
        speed_at_change_ = speed_;
        // With jerk limits an earlier change may be incomplete.
        floor_ = std::min({wasSettled ? speed_ : floor_, speed_, wanted()});
        // A sample has the average speed of its cycle; at its end a change has progressed by half a cycle.
        ahead_ = wasSettled ? 0.0 : 0.5 * acceleration_ * T;
        cycles_ = 0;
    }
    void end() {
        wasCruising_ = isSettled();
        state_ = State::BRAKING;
        change(wasCruising_);
    }
    bool isSettled() const {
        const double change_s = std::abs(speed_at_change_ - wanted()) / acceleration_;
        return static_cast<double>(cycles_) * T > change_s + settling_s_;
    }
    void judge_held(double v) {
        EXPECT_GE(v * velocity_, -SPEED_ROUNDING) << "backwards";
        const double speed = std::abs(v);
        EXPECT_GE(speed, floor_ - SPEED_ROUNDING) << "it dips";
        if (!isJerkLimited_) {
            const double from = std::abs(speed_ - wanted()) + (cycles_ == 0 ? ahead_ : 0.0);
            EXPECT_LE(std::abs(speed - wanted()), from + SPEED_ROUNDING)
                << "away from what is asked for: " << speed << " after " << speed_ << ", asked for "
                << wanted() << " " << cycles_ << " cycles ago, acceleration " << acceleration_;
        }
        if (isSettled()) {
            EXPECT_NEAR(speed, wanted(), SPEED_ROUNDING);
            ++cruising_cycles;
        }
    }
    /// One cycle of delay, then slower at each sample, and stopped when the limits permit.
    void judge_braking(double v) {
        const double speed = std::abs(v);
        const bool mustSlow = cycles_ >= 1 && (wasCruising_ || !isJerkLimited_);
        const bool isSlowing = speed < speed_ || speed <= SPEED_ROUNDING;
        EXPECT_TRUE(isSlowing || !mustSlow) << speed << " after " << speed_;
        if (speed <= SPEED_ROUNDING && speed_ <= SPEED_ROUNDING && cycles_ > 1) {
            state_ = State::STANDING;
            return;
        }
        const double longest_s = std::max(speed_at_change_, wanted()) / acceleration_ + settling_s_ + T;
        EXPECT_LE(static_cast<double>(cycles_) * T, longest_s) << "it still moves at " << speed;
    }

    double acceleration_, settling_s_;
    bool isJerkLimited_;
    State state_ = State::STANDING;
    double velocity_ = 0, scale_ = 1, position_ = 0, speed_ = 0, speed_at_change_ = 0, floor_ = 0, ahead_ = 0;
    std::int64_t end_ns_ = 0;
    int cycles_ = 0;
    bool wasCruising_ = false;
};

struct Counts {
    int begun = 0, renewed = 0, lapsed = 0, stopped = 0, cruising = 0, refused_renewals = 0,
        refused_others = 0;
};

/// Two clients each hold a key, lose their connection at random, and do not notice stops.
class LeaseRun {
  public:
    LeaseRun(Mode mode, double jerk, unsigned seed)
        : mode_(mode), random_(seed), acceleration_(std::pow(10.0, real(2, 3.5))),
          judges_{JogJudge(acceleration_, jerk), JogJudge(acceleration_, jerk)},
          rig_("XYZ", HIGHEST_SPEED, acceleration_) {
        for (int i = 0; i < AXES && jerk > 0; ++i) {
            rig_.set(Parameter::JOINT_MAX_JERK, i, jerk);
            rig_.set(Parameter::AXIS_MAX_JERK, i, jerk);
        }
        rig_.set(Parameter::TRAJ_PLANNER_TYPE, 0, jerk > 0 ? 1 : 0);
        rig_.ready(mode);
        rig_.channels->isTracing.store(1);
        EXPECT_EQ(rig_.status().mode, mode);
    }

    Counts run() {
        for (int n = 0; n < 6000 && !::testing::Test::HasFailure(); ++n) {
            cycle_ = n;
            for (int i = 0; i < 2; ++i) {
                act(i);
            }
            disturb();
            rig_.step();
            take_answers();
            judge();
        }
        count();
        return counts_;
    }

  private:
    static constexpr int AXES = 3;
    static constexpr double HIGHEST_SPEED = 100;

    struct Client {
        bool isHolding = false;
        double velocity = 0, lease_s = 0;
        int next_renewal = 0;
    };
    struct Sent {
        enum class What { JOG, ABORT, STOP, SCALE, MODE, ENABLE } what = What::JOG;
        int client = 0;
        double value = 0, lease_s = 0;
        bool isRenewal = false;
    };

    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    bool chance(double p) { return real(0, 1) < p; }
    JogTarget target(int client) const { return {mode_ == Mode::FREE, client}; }
    void send(const CommandBody &body, const Sent &sent) { sent_[rig_.send(body)] = sent; }

    void jog(int i, bool isRenewal) {
        Client &c = clients_[static_cast<std::size_t>(i)];
        send(JogContinuous{target(i), c.velocity, c.lease_s, isRenewal},
             {Sent::What::JOG, i, c.velocity, c.lease_s, isRenewal});
        c.next_renewal = cycle_ + whole(1, static_cast<int>(c.lease_s / T + 1e-9));
    }
    void act(int i) {
        Client &c = clients_[static_cast<std::size_t>(i)];
        JogJudge &judge = judges_[static_cast<std::size_t>(i)];
        const bool isFree = !c.isHolding && judge.isStanding() && chance(0.01);
        if (isFree) {
            const double sign = positions_[static_cast<std::size_t>(i)] > 0 ? -1 : 1;
            c = {true, sign * real(1, 0.9 * HIGHEST_SPEED), lease(), 0};
            jog(i, false);
        } else if (c.isHolding && chance(0.003)) {
            c.isHolding = false;
        } else if (c.isHolding && cycle_ >= c.next_renewal) {
            c.velocity *= chance(0.1) ? real(0.3, 1) : 1.0;
            // Without the mark the same command starts a jog that was stopped; a client that does not check
            // its jogs needs the mark.
            jog(i, !judge.isHeld() || chance(0.5));
        }
    }
    double lease() { return chance(0.3) ? real(0.02, 0.4) : 1e-3 * whole(20, 400); }

    void disturb() {
        if (chance(0.001)) {
            ++rig_.epoch;
            send(Abort{rig_.epoch}, {Sent::What::ABORT});
        }
        if (chance(0.001)) {
            const int i = whole(0, 1);
            send(JogStop{target(i)}, {Sent::What::STOP, i});
        }
        if (chance(0.001)) {
            const double factor = real(0.2, 1);
            send(SetScale{Scale::FEED, 0, factor}, {Sent::What::SCALE, 0, factor});
        }
        if (chance(0.002)) {
            const Mode other = mode_ == Mode::FREE ? Mode::TELEOP : Mode::FREE;
            send(SetMode{other}, {Sent::What::MODE});
            send(SetMode{mode_}, {Sent::What::MODE});
        }
        rig_.in.isEnableOn = !chance(0.0005);
        if (!rig_.in.isEnableOn) {
            judges_[0].switch_off();
            judges_[1].switch_off();
            ++counts_.stopped;
        } else if (!rig_.status().isEnabled) {
            send(Enable{}, {Sent::What::ENABLE});
        }
    }

    void take_answers() {
        for (; seen_ < rig_.answers.size(); ++seen_) {
            const auto found = sent_.find(rig_.answers[seen_].id);
            if (found != sent_.end()) {
                take(found->second, rig_.answers[seen_]);
            }
        }
    }
    void take(const Sent &sent, const Answer &answer) {
        const auto i = static_cast<std::size_t>(sent.client);
        if (answer.kind != AnswerKind::DONE) {
            (sent.isRenewal ? counts_.refused_renewals : counts_.refused_others) += 1;
            const bool isExpected =
                sent.what != Sent::What::JOG || !judges_[i].isHeld() || !rig_.in.isEnableOn;
            EXPECT_TRUE(isExpected) << "reason " << static_cast<int>(answer.reason);
            clients_[i].isHolding = clients_[i].isHolding && (sent.isRenewal || sent.what != Sent::What::JOG);
            return;
        }
        switch (sent.what) {
        case Sent::What::JOG:
            EXPECT_TRUE(!sent.isRenewal || judges_[i].isHeld() || !rig_.in.isEnableOn)
                << "a renewal has begun a jog";
            ++(judges_[i].isHeld() ? counts_.renewed : counts_.begun);
            if (rig_.in.isEnableOn) {
                judges_[i].take(sent.value, sent.lease_s, rig_.in.time_ns);
            }
            break;
        case Sent::What::ABORT:
            judges_[0].stop();
            judges_[1].stop();
            ++counts_.stopped;
            break;
        case Sent::What::STOP:
            judges_[i].stop();
            ++counts_.stopped;
            break;
        case Sent::What::SCALE:
            judges_[0].scale(sent.value);
            judges_[1].scale(sent.value);
            break;
        case Sent::What::MODE:
        case Sent::What::ENABLE: break;
        }
    }

    void judge() {
        TraceSample sample;
        while (rig_.channels->trace.pop(sample)) {
            for (std::size_t i = 0; i < 2; ++i) {
                SCOPED_TRACE("jog " + std::to_string(i) + " cycle " + std::to_string(cycle_));
                positions_[i] =
                    mode_ == Mode::FREE ? sample.joint_pos_cmd[i] : sample.carte_pos_cmd[static_cast<int>(i)];
                judges_[i].sample(positions_[i], sample.time_ns);
            }
        }
    }
    /// Each lease that has ended was reported once, with its joint or axis.
    void count() {
        std::array<int, 2> told{};
        for (const Fault &fault : rig_.faults) {
            if (fault.kind == FaultKind::JOG_LEASE_ENDED) {
                ASSERT_TRUE(fault.index == 0 || fault.index == 1);
                ++told[static_cast<std::size_t>(fault.index)];
                EXPECT_EQ(fault.detail, mode_ == Mode::FREE ? 1 : 0);
                EXPECT_GE(fault.value, 0.0199);
            } else {
                EXPECT_EQ(fault.kind, FaultKind::ENABLE_LOST);
            }
        }
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(told[i], judges_[i].ended_leases) << "jog " << i;
            counts_.lapsed += judges_[i].ended_leases;
            counts_.cruising += judges_[i].cruising_cycles;
        }
    }

    Mode mode_;
    std::mt19937 random_;
    double acceleration_;
    std::array<JogJudge, 2> judges_;
    MotionRig rig_;
    std::array<Client, 2> clients_{};
    std::array<double, 2> positions_{};
    std::map<CommandId, Sent> sent_;
    std::size_t seen_ = 0;
    int cycle_ = 0;
    Counts counts_;
};

void run_all(Mode mode, double jerk) {
    const auto [first, count] = testing::campaign_seeds(20);
    Counts all;
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE("seed " + std::to_string(first + i));
        const Counts one = LeaseRun(mode, jerk, static_cast<unsigned>(first + i)).run();
        all.begun += one.begun;
        all.renewed += one.renewed;
        all.lapsed += one.lapsed;
        all.stopped += one.stopped;
        all.cruising += one.cruising;
        all.refused_renewals += one.refused_renewals;
        all.refused_others += one.refused_others;
    }
    // The number of jogs is sufficient, and each run has seen every type of end.
    EXPECT_GT(all.begun, 5 * count);
    EXPECT_GT(all.renewed, 20 * count);
    EXPECT_GT(all.lapsed, 2 * count);
    EXPECT_GT(all.stopped, 2 * count);
    EXPECT_GT(all.cruising, 100 * count);
    EXPECT_GT(all.refused_renewals, count) << "of jogs that were stopped";
    std::printf(
        "%d begun, %d renewed, %d lapsed, %d stopped, %d cycles at speed; rejected: %d renewals of jogs that "
        "were stopped, %d others (mode changes while moving, jogs while off)\n",
        all.begun, all.renewed, all.lapsed, all.stopped, all.cruising, all.refused_renewals,
        all.refused_others);
}

TEST(JogLease, WorksInFreeMode) {
    run_all(Mode::FREE, 0);
}

TEST(JogLease, WorksInFreeModeWithJerkLimits) {
    run_all(Mode::FREE, 2e4);
}

TEST(JogLease, WorksInTeleopMode) {
    run_all(Mode::TELEOP, 0);
}

TEST(JogLease, WorksInTeleopModeWithJerkLimits) {
    run_all(Mode::TELEOP, 2e4);
}

}  // namespace
}  // namespace lease_test
}  // namespace mw::motion
