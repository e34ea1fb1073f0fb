// SPDX-License-Identifier: GPL-2.0-or-later
// Locking indexers in programs and jogs. The judge uses only the pins unlock and is-unlocked and the motor
// commands. An indexer moves only while its lock is open, other motors only while it is shut, and nothing
// exceeds its limits.
#include <array>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "motion/interface/texts.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace indexers_test {
namespace {

using testing::MotionRig;

constexpr int B = 3;
constexpr int AXIS_B = geometry::AXIS_B;

/// A lock with a delay.
struct Lock {
    int delay = 40;  ///< [cycles]
    bool isOpen = false, isJammed = false;
    int count = 0;

    void step(bool isAsked) {
        count = isAsked == isOpen ? 0 : count + 1;
        if (count >= delay && !isJammed) {
            isOpen = isAsked;
            count = 0;
        }
    }
};

struct IndexerRig {
    MotionRig rig{"XYZB"};
    Lock lock;
    testing::LimitChecker judge{std::vector<testing::AxisLimit>(4, {100, 1000, 1e300}), MotionRig::T};
    std::array<double, 4> last{};
    std::string breaches;
    int moved_cycles = 0, unlocks = 0;
    bool wasAsked = false, isCounted = false;

    IndexerRig() {
        rig.set(Parameter::AXIS_LOCKING_INDEXER_JOINT, AXIS_B, B);
        rig.set(Parameter::JOINT_LOCKING_INDEXER, B, 1);
        rig.before_step = [this](MotionRig &r) {
            lock.step(r.out->joint[B].isUnlockWanted);
            r.in.joint[B].isUnlocked = lock.isOpen;
        };
        step(2);
    }
    void step(int count = 1) {
        for (int n = 0; n < count; ++n) {
            rig.step();
            look();
        }
    }
    void look() {
        std::array<double, 4> now{};
        for (std::size_t j = 0; j < 4; ++j) {
            now[j] = rig.out->joint[j].motor_pos_cmd;
        }
        const bool isOn = rig.status().isEnabled && isCounted;
        if (!isOn || rig.status().isHoming) {
            judge.restart();
        } else {
            judge.sample(now.data());
            const bool isMoved = now[B] != last[B];
            const bool areOthers = now[0] != last[0] || now[1] != last[1] || now[2] != last[2];
            const bool isAsked = rig.out->joint[B].isUnlockWanted;
            moved_cycles += isMoved ? 1 : 0;
            if (isMoved && !(lock.isOpen && wasAsked)) {
                breaches += "the indexer moves and is not unlocked\n";
            }
            if (areOthers && (lock.isOpen || isAsked)) {
                breaches += "another joint moves while the indexer is unlocked\n";
            }
            unlocks += isAsked && !wasAsked ? 1 : 0;
        }
        wasAsked = rig.out->joint[B].isUnlockWanted;
        last = now;
        isCounted = rig.status().isEnabled;
    }
    bool run_until(const std::function<bool()> &isDone, double longest_s = 60) {
        for (double t = 0; t < longest_s && !isDone(); t += MotionRig::T) {
            step();
        }
        return isDone();
    }
    void ready(Mode mode) {
        rig.send(Enable{});
        step(2);
        rig.send(Home{-1});
        step(2);
        ASSERT_TRUE(run_until([&] { return rig.status().isAllHomed && !rig.status().isHoming; }));
        rig.send(SetMode{mode});
        step(200);
        unlocks = moved_cycles = 0;
    }
    double b() const { return rig.out->joint[B].motor_pos_cmd; }
    bool isAsked() const { return rig.out->joint[B].isUnlockWanted; }
    bool isMoving() const { return rig.status().joint[B].vel_cmd != 0; }
    static geometry::Pose at(double x, double angle) { return {{x, 0, 0, 0, angle, 0, 0, 0, 0}}; }
    CommandId rapid(double x, double angle) { return rig.line(at(x, angle), 0); }
    void check() const {
        EXPECT_TRUE(breaches.empty()) << breaches.substr(0, 500);
        EXPECT_TRUE(judge.isWithin()) << judge.report();
    }
};

TEST(Indexers, AG0UnlocksMovesAndLocksBeforeOtherMotion) {
    for (const double jerk : {0.0, 20000.0}) {
        IndexerRig r;
        r.rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, jerk > 0 ? 1 : 0);
        for (int j = 0; j < 4; ++j) {
            r.rig.set(Parameter::JOINT_MAX_JERK, j, jerk > 0 ? jerk : NO_JERK_LIMIT);
        }
        r.rig.set(Parameter::TRAJ_MAX_JERK, 0, jerk > 0 ? jerk : NO_JERK_LIMIT);
        r.ready(Mode::COORD);
        r.rapid(10, 0);
        const CommandId index = r.rapid(10, 30);
        r.rig.line(IndexerRig::at(20, 30), 40);
        r.rig.line(IndexerRig::at(25, 30), 40);
        const CommandId back = r.rapid(25, 0);
        const CommandId end = r.rig.send_path(Flush{});
        ASSERT_TRUE(r.run_until([&] { return r.rig.isDone(index); }));
        EXPECT_FALSE(r.lock.isOpen) << "done when it has locked";
        EXPECT_EQ(r.b(), 30);
        ASSERT_TRUE(r.run_until([&] { return r.rig.isDone(end); })) << r.rig.faults.size();
        EXPECT_TRUE(r.rig.isDone(back));
        EXPECT_EQ(r.b(), 0);
        EXPECT_EQ(r.rig.out->joint[0].motor_pos_cmd, 25);
        EXPECT_EQ(r.unlocks, 2);
        EXPECT_GT(r.moved_cycles, 600);
        EXPECT_FALSE(r.isAsked());
        r.step(10);
        EXPECT_TRUE(r.rig.status().isInPosition);
        EXPECT_TRUE(r.rig.faults.empty());
        r.check();
    }
}

TEST(Indexers, TheStatusShowsIndexing) {
    IndexerRig r;
    r.ready(Mode::COORD);
    r.rapid(0, 90);
    ASSERT_TRUE(r.run_until([&] { return r.isMoving(); }));
    EXPECT_EQ(r.rig.status().motion_type, MotionType::INDEX_ROTARY);
    EXPECT_FALSE(r.rig.status().isInPosition);
}

TEST(Indexers, EveryOtherMoveOfAnIndexerIsRejected) {
    const std::function<CommandId(IndexerRig &)> moves[] = {
        [](IndexerRig &r) { return r.rapid(5, 30); },
        [](IndexerRig &r) { return r.rig.line(IndexerRig::at(0, 30), 20); },
        [](IndexerRig &r) { return r.rig.line(IndexerRig::at(5, 30), 20); },
        [](IndexerRig &r) {
            Probe probe;
            probe.end = IndexerRig::at(0, 30);
            probe.terms.feed = 20;
            return r.rig.send_path(probe);
        },
        [](IndexerRig &r) {
            Arc arc;
            arc.end = IndexerRig::at(10, 30);
            arc.centre = IndexerRig::at(5, 0);
            arc.normal = {{0, 0, 1, 0, 0, 0, 0, 0, 0}};
            arc.angle_rad = -3.14159265358979;
            arc.terms.feed = 20;
            return r.rig.send_path(arc);
        },
    };
    for (const auto &move : moves) {
        IndexerRig r;
        r.ready(Mode::COORD);
        const CommandId id = move(r);
        r.step(200);
        EXPECT_EQ(r.rig.refusal(id), Reason::INDEXER_ALONE);
        EXPECT_EQ(r.moved_cycles, 0);
        EXPECT_EQ(r.unlocks, 0);
        EXPECT_NE(reason_text(*r.rig.answer_to(id)).find("G0"), std::string::npos);
        r.check();
    }
}

TEST(Indexers, JogsUnlockMoveAndLock) {
    for (const bool isJoint : {true, false}) {
        IndexerRig r;
        r.ready(isJoint ? Mode::FREE : Mode::TELEOP);
        const JogTarget target{isJoint, isJoint ? B : AXIS_B};
        r.rig.send(JogIncremental{target, 50, 20});
        ASSERT_TRUE(r.run_until([&] { return r.isMoving(); }));
        r.rig.send(JogIncremental{target, 50, 5});
        ASSERT_TRUE(r.run_until([&] { return !r.isAsked() && !r.lock.isOpen; }));
        EXPECT_EQ(r.b(), 25);
        EXPECT_EQ(r.unlocks, 1) << "increments add up";
        r.rig.send(JogContinuous{target, -50});
        r.step(500);
        EXPECT_LT(r.b(), 15);
        r.rig.send(JogStop{target});
        ASSERT_TRUE(r.run_until([&] { return !r.isAsked() && !r.lock.isOpen; }));
        EXPECT_EQ(r.unlocks, 2);
        r.rig.send(JogAbsolute{target, 50, 3});
        r.step(20);
        r.rig.send(JogStop{target});
        ASSERT_TRUE(r.run_until([&] { return !r.isAsked() && !r.lock.isOpen; }, 1));
        EXPECT_NE(r.b(), 3) << "stopped before it was unlocked";
        r.check();
        EXPECT_TRUE(r.rig.faults.empty());
    }
}

TEST(Indexers, NothingElseIsJoggedMeanwhile) {
    for (const bool isJoint : {true, false}) {
        IndexerRig r;
        r.ready(isJoint ? Mode::FREE : Mode::TELEOP);
        const JogTarget own{isJoint, isJoint ? B : AXIS_B};
        const JogTarget other{isJoint, 0};
        r.rig.send(JogContinuous{other, 5});
        const CommandId beside = r.rig.send(JogContinuous{own, 5});
        r.step(100);
        EXPECT_EQ(r.rig.refusal(beside), Reason::INDEXER_ALONE);
        r.rig.send(JogStop{other});
        r.step(100);
        r.rig.send(JogContinuous{own, 20});
        const CommandId at_once = r.rig.send(JogContinuous{other, 5});
        r.step(100);
        const CommandId later = r.rig.send(JogContinuous{other, 5});
        r.rig.send(JogStop{own});
        r.step(30);
        const CommandId locking = r.rig.send(JogContinuous{other, 5});
        r.step(200);
        const CommandId free = r.rig.send(JogContinuous{other, 5});
        r.step(100);
        EXPECT_EQ(r.rig.refusal(at_once), Reason::INDEXER_ALONE);
        EXPECT_EQ(r.rig.refusal(later), Reason::INDEXER_ALONE);
        EXPECT_EQ(r.rig.refusal(locking), Reason::INDEXER_ALONE);
        EXPECT_TRUE(r.rig.isDone(free));
        if (!isJoint) {
            r.rig.send(JogStop{other});
            r.step(100);
            const CommandId vector = r.rig.send(SetTeleopVector{{{5, 0, 0, 0, 5, 0, 0, 0, 0}}});
            const CommandId alone = r.rig.send(SetTeleopVector{{{0, 0, 0, 0, 5, 0, 0, 0, 0}}});
            r.step(100);
            EXPECT_EQ(r.rig.refusal(vector), Reason::INDEXER_ALONE);
            EXPECT_TRUE(r.rig.isDone(alone));
        }
        r.check();
    }
}

TEST(Indexers, NoModeChangeAndNoHomingWhileUnlocked) {
    IndexerRig r;
    r.ready(Mode::FREE);
    r.rig.send(JogContinuous{{true, B}, 20});
    r.step(100);
    r.rig.send(JogStop{{true, B}});
    ASSERT_TRUE(r.run_until([&] { return !r.isMoving() && !r.isAsked(); }));
    ASSERT_TRUE(r.lock.isOpen);
    const CommandId mode = r.rig.send(SetMode{Mode::TELEOP});
    r.rig.send(Home{0});
    r.step();
    EXPECT_EQ(r.rig.refusal(mode), Reason::MOVING);
    r.step(300);
    EXPECT_TRUE(r.rig.status().isAllHomed);
    r.check();
}

/// State of the lock when an event occurs.
enum class When { UNLOCKING, UNLOCKED, MOVING, LOCKING };
struct Event {
    const char *name;
    std::function<void(IndexerRig &)> happens;
    bool isOff;     ///< the machine goes off
    bool isAtOnce;  ///< in the same cycle
};
const Event EVENTS[] = {
    {"abort", [](IndexerRig &r) { r.rig.send(Abort{++r.rig.epoch}); }, false, false},
    {"off", [](IndexerRig &r) { r.rig.send(Disable{}); }, true, true},
    {"enable input", [](IndexerRig &r) { r.rig.in.isEnableOn = false; }, true, true},
    {"amp fault", [](IndexerRig &r) { r.rig.in.joint[0].isAmpFaulted = true; }, true, true},
    {"misc error", [](IndexerRig &r) { r.rig.in.misc_errors = 1; }, true, false},
    {"limit switch", [](IndexerRig &r) { r.rig.in.joint[1].isPosLimitClosed = true; }, true, false},
    {"task dead", [](IndexerRig &r) { r.rig.channels->isTaskDead.store(1); }, true, false},
};

bool isIn(const IndexerRig &r, When when) {
    switch (when) {
    case When::UNLOCKING: return r.isAsked() && !r.lock.isOpen;
    case When::UNLOCKED: return r.isAsked() && r.lock.isOpen;
    case When::MOVING: return r.isMoving() && r.b() > 5;
    case When::LOCKING: return !r.isAsked() && r.lock.isOpen;
    }
    return false;
}

void begin(IndexerRig &r, Mode mode) {
    if (mode == Mode::COORD) {
        r.rapid(0, 30);
        r.rapid(10, 30);
    } else {
        r.rig.send(JogIncremental{{mode == Mode::FREE, mode == Mode::FREE ? B : AXIS_B}, 100, 30});
    }
}

TEST(Indexers, EveryStopInEveryStateEndsLockedAndTheMachineContinues) {
    for (const Mode mode : {Mode::FREE, Mode::TELEOP, Mode::COORD}) {
        for (const When when : {When::UNLOCKING, When::UNLOCKED, When::MOVING, When::LOCKING}) {
            for (const Event &event : EVENTS) {
                SCOPED_TRACE(std::string(event.name) + " in state " + std::to_string(static_cast<int>(when)) +
                             " of mode " + std::to_string(static_cast<int>(mode)));
                IndexerRig r;
                r.ready(mode);
                begin(r, mode);
                ASSERT_TRUE(r.run_until([&] { return isIn(r, when); }, 5));
                event.happens(r);
                r.step();
                EXPECT_EQ(event.isAtOnce, !r.rig.status().isEnabled && event.isOff);
                EXPECT_FALSE(event.isAtOnce && r.isAsked()) << "off: nothing holds it open";
                const double here = r.b();
                r.step(400);
                EXPECT_EQ(r.rig.status().isEnabled, !event.isOff);
                EXPECT_FALSE(r.isAsked());
                EXPECT_FALSE(r.lock.isOpen);
                EXPECT_NEAR(r.b(), here, 6) << "it stopped";
                const double place = r.b();
                r.step(300);
                EXPECT_EQ(r.b(), place) << "and stays";
                // And everything works afterwards.
                r.rig.in.isEnableOn = true;
                r.rig.in.misc_errors = 0;
                r.rig.in.joint[0].isAmpFaulted = r.rig.in.joint[1].isPosLimitClosed = false;
                r.rig.channels->isTaskDead.store(0);
                r.rig.send(Abort{++r.rig.epoch});
                r.rig.send(Enable{});
                r.step(20);
                const CommandId to_mode = r.rig.send(SetMode{Mode::TELEOP});
                r.step(20);
                ASSERT_TRUE(r.rig.isDone(to_mode));
                const CommandId jog = r.rig.send(JogAbsolute{{false, AXIS_B}, 100, 40});
                ASSERT_TRUE(r.run_until([&] { return r.b() == 40 && !r.isAsked() && !r.lock.isOpen; }, 5))
                    << static_cast<int>(r.rig.refusal(jog));
                r.check();
            }
        }
    }
}

TEST(Indexers, AMissingUnlockIsAFaultWithoutMotion) {
    for (const Mode mode : {Mode::FREE, Mode::TELEOP, Mode::COORD}) {
        IndexerRig r;
        r.ready(mode);
        r.lock.isJammed = true;
        begin(r, mode);
        r.step(29000);
        EXPECT_TRUE(r.rig.faults.empty()) << "it has 30 s";
        r.step(2000);
        ASSERT_EQ(r.rig.faults.size(), 1u);
        EXPECT_EQ(r.rig.faults[0].kind, FaultKind::INDEXER_NOT_UNLOCKED);
        EXPECT_EQ(r.rig.faults[0].index, B);
        EXPECT_NE(fault_text(r.rig.faults[0]).find("unlock_joints_mask"), std::string::npos);
        EXPECT_FALSE(r.isAsked());
        EXPECT_EQ(r.moved_cycles, 0);
        EXPECT_EQ(r.rig.out->joint[0].motor_pos_cmd, 0);
        r.check();
    }
}

TEST(Indexers, AMissingLockIsAFaultAndStopsTheProgram) {
    IndexerRig r;
    r.ready(Mode::COORD);
    const CommandId index = r.rapid(0, 30);
    const CommandId next = r.rapid(10, 30);
    ASSERT_TRUE(r.run_until([&] { return r.isMoving(); }));
    r.lock.isJammed = true;
    r.step(32000);
    ASSERT_EQ(r.rig.faults.size(), 1u);
    EXPECT_EQ(r.rig.faults[0].kind, FaultKind::INDEXER_NOT_LOCKED);
    EXPECT_FALSE(r.rig.isDone(index));
    EXPECT_FALSE(r.rig.isDone(next));
    EXPECT_EQ(r.rig.out->joint[0].motor_pos_cmd, 0);
    r.rig.send(Abort{++r.rig.epoch});
    r.step(20);
    const CommandId refused = r.rapid(10, 30);
    r.step(100);
    EXPECT_EQ(r.rig.refusal(refused), Reason::INDEXER_OPEN);
    r.rig.send(Abort{++r.rig.epoch});
    r.step(20);
    r.lock.isJammed = false;  // the operator has freed it
    r.step(100);
    const CommandId again = r.rapid(10, 30);
    ASSERT_TRUE(r.run_until([&] { return r.rig.isDone(again); }));
    r.check();
}

TEST(Indexers, ALockThatClosesDuringTheMoveSwitchesOffInTheSameCycle) {
    for (const Mode mode : {Mode::FREE, Mode::TELEOP, Mode::COORD}) {
        IndexerRig r;
        r.ready(mode);
        begin(r, mode);
        ASSERT_TRUE(r.run_until([&] { return r.isMoving() && r.b() > 5; }));
        r.lock.isOpen = false;
        r.lock.isJammed = true;
        r.step();
        EXPECT_FALSE(r.rig.status().isEnabled);
        EXPECT_FALSE(r.isAsked());
        ASSERT_FALSE(r.rig.faults.empty());
        EXPECT_EQ(r.rig.faults[0].kind, FaultKind::INDEXER_LOCKED_IN_MOVE);
    }
}

TEST(Indexers, HoldsAndOverridesKeepItUnlockedDuringTheMove) {
    IndexerRig r;
    r.ready(Mode::COORD);
    const CommandId index = r.rapid(0, 90);
    ASSERT_TRUE(r.run_until([&] { return r.isMoving() && r.b() > 20; }));
    r.rig.send(Pause{});
    r.step(1000);
    EXPECT_FALSE(r.isMoving());
    EXPECT_TRUE(r.isAsked()) << "half way: it is still to move";
    r.rig.send(Resume{});
    ASSERT_TRUE(r.run_until([&] { return r.rig.isDone(index); }));
    EXPECT_EQ(r.b(), 90);
    EXPECT_EQ(r.unlocks, 1);
    r.check();
}

TEST(Indexers, SwitchingOnWaitsForAnOpenLock) {
    IndexerRig r;
    r.ready(Mode::COORD);
    r.rig.send(Disable{});
    r.step(10);
    r.lock.isOpen = true;
    r.lock.delay = 400;
    r.rig.send(Enable{});
    r.step(5);
    const CommandId move = r.rapid(10, 0);
    r.step(100);
    EXPECT_EQ(r.rig.out->joint[0].motor_pos_cmd, 0);
    ASSERT_TRUE(r.run_until([&] { return r.rig.isDone(move); }));
    r.check();
}

}  // namespace
}  // namespace indexers_test
}  // namespace mw::motion
