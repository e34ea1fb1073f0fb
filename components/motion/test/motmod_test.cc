// SPDX-License-Identifier: GPL-2.0-or-later
// The motion controller as a loaded module, under the virtual clock, with its motors looped back through HAL.
#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "motion/interface/channels.hh"
#include "motion/interface/parameters.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::motion {
namespace {

struct Machine {
    runtime::VirtualScheduler clock;
    std::unique_ptr<hal::LocalHost> host;
    Channels *channels = nullptr;
    CommandId next_id = 1;

    Machine() {
        hal::InstanceOptions options;
        options.scheduler = &clock;
        auto made = hal::LocalHost::create(options, {MW_MODULE_FOLDER, MW_TEST_MODULE_FOLDER});
        if (made.has_value()) {
            host = std::move(*made);
        }
    }
    std::string load(const std::string &name, const std::vector<std::string> &args = {}) {
        const auto status = host->load_realtime(name, args);
        return status.has_value() ? "ok" : status.error().str();
    }
    void start(const std::string &kinematics = "trivkins") {
        ASSERT_EQ(load("tpmod"), "ok");
        ASSERT_EQ(load("homemod"), "ok");
        ASSERT_EQ(load(kinematics), "ok");
        ASSERT_EQ(load("motmod", {"servo_period_nsec=1000000", "num_joints=3"}), "ok");
        hal::Instance &hal = host->hal();
        for (const std::string n : {"0", "1", "2"}) {
            ASSERT_TRUE(hal.signals().net("pos" + n,
                                          {"joint." + n + ".motor-pos-cmd", "joint." + n + ".motor-pos-fb"}));
        }
        ASSERT_TRUE(hal.threads().add_function("motion-command-handler", "servo-thread"));
        ASSERT_TRUE(hal.threads().add_function("motion-controller", "servo-thread"));
        ASSERT_TRUE(hal.threads().start());
        const auto block = hal.memory().shared_block(Channels::SHMEM_KEY, sizeof(Channels));
        ASSERT_TRUE(block.has_value());
        channels = static_cast<Channels *>(*block);
        ASSERT_EQ(channels->magic, Channels::MAGIC);
        ASSERT_EQ(channels->layout_bytes, sizeof(Channels));
    }
    void send(const CommandBody &body) { channels->immediate.push({next_id++, 1, body}); }
    void run(double seconds) { clock.run_until(clock.now_ns() + static_cast<std::int64_t>(seconds * 1e9)); }
    double value(const std::string &pin) { return host->hal().values().get(pin)->as_number(); }
    void ready() {
        send(Abort{1});
        for (std::int16_t j = 0; j < 3; ++j) {
            send(SetParameter{static_cast<std::uint16_t>(Parameter::JOINT_MAX_VELOCITY), j, 100});
            send(SetParameter{static_cast<std::uint16_t>(Parameter::JOINT_MAX_ACCELERATION), j, 1000});
            send(SetParameter{static_cast<std::uint16_t>(Parameter::JOINT_HOME_SEQUENCE), j, 0});
        }
        send(Enable{});
        send(Home{-1});
        run(0.1);
        send(SetMode{Mode::COORD});
        run(0.05);
    }
};

TEST(Motmod, APinThatSeldomChangesIsSeenInTheCycleAfterItWasLinked) {
    Machine m;
    ASSERT_NO_FATAL_FAILURE(m.start());
    m.ready();
    hal::Instance &hal = m.host->hal();
    ASSERT_EQ(m.value("joint.1.homed"), 1);
    ASSERT_EQ(m.value("joint.1.amp-enable-out"), 1);
    // A signal with a reader keeps its value when a writer is linked.
    ASSERT_TRUE(hal.signals().net("homed", {"joint.0.home-sw-in"}));
    ASSERT_TRUE(hal.signals().net("amp", {"joint.1.jog-enable"}));
    ASSERT_TRUE(hal.signals().net("homed", {"joint.1.homed"}));
    ASSERT_TRUE(hal.signals().net("amp", {"joint.1.amp-enable-out"}));
    ASSERT_EQ(m.value("joint.0.home-sw-in"), 0);
    m.run(0.001);
    EXPECT_EQ(m.value("joint.0.home-sw-in"), 1);
    EXPECT_EQ(m.value("joint.1.jog-enable"), 1);
}

TEST(Motmod, ALineFromThePathChannelReachesTheMotorPins) {
    Machine m;
    ASSERT_NO_FATAL_FAILURE(m.start());
    m.ready();
    EXPECT_EQ(m.value("motion.is-all-homed"), 1);
    EXPECT_EQ(m.value("motion.coord-mode"), 1);
    EXPECT_EQ(m.value("joint.0.amp-enable-out"), 1);
    Line line;
    line.end[0] = 10;
    line.end[1] = -3;
    line.terms.feed = 50;
    m.channels->path.push({m.next_id++, 1, line});
    m.channels->path.push({m.next_id++, 1, Flush{}});
    m.run(0.1);
    EXPECT_EQ(m.value("motion.in-position"), 0);
    EXPECT_GT(m.value("motion.current-vel"), 10);
    m.run(1);
    EXPECT_EQ(m.value("joint.0.motor-pos-cmd"), 10.0);
    EXPECT_EQ(m.value("joint.1.motor-pos-cmd"), -3.0);
    EXPECT_EQ(m.value("motion.in-position"), 1);
}

/// All of these pins, and no others.
TEST(Motmod, InputsAndOutputsOfProgramsAreThoseOfTheirPins) {
    Machine m;
    ASSERT_NO_FATAL_FAILURE(m.start());
    m.ready();
    auto seen = std::make_unique<PublishedStatus::Copy>();
    hal::Instance &hal = m.host->hal();
    for (std::uint16_t n = 0; n < 4; ++n) {
        const std::string number = "-0" + std::to_string(n);
        ASSERT_TRUE(hal.values().set("motion.digital-in" + number, "TRUE"));
        ASSERT_TRUE(hal.values().set("motion.analog-in" + number, std::to_string(n + 1.5)));
        m.send(SetDigitalOutput{n, true});
        m.send(SetAnalogOutput{n, 0.25 * (n + 1)});
        m.run(0.002);
        ASSERT_TRUE(m.channels->status.read(*seen));
        EXPECT_EQ(seen->value.digital_in, 1U << n);
        for (std::size_t i = 0; i < 4; ++i) {
            const std::string other = "-0" + std::to_string(i);
            EXPECT_EQ(seen->value.analog_in[i], i == n ? n + 1.5 : 0.0) << i;
            EXPECT_EQ(m.value("motion.digital-out" + other), i == n ? 1 : 0) << i;
            EXPECT_EQ(m.value("motion.analog-out" + other), i == n ? 0.25 * (n + 1) : 0.0) << i;
        }
        ASSERT_TRUE(hal.values().set("motion.digital-in" + number, "FALSE"));
        ASSERT_TRUE(hal.values().set("motion.analog-in" + number, "0"));
        m.send(SetDigitalOutput{n, false});
        m.send(SetAnalogOutput{n, 0});
    }
}

TEST(Motmod, EstopChainDropsTheAmplifiersInTheSameServoCycle) {
    Machine m;
    ASSERT_NO_FATAL_FAILURE(m.start());
    m.ready();
    ASSERT_EQ(m.value("joint.2.amp-enable-out"), 1);
    ASSERT_TRUE(m.host->hal().values().set("motion.emc-enable-in", "FALSE"));
    m.run(0.001);
    EXPECT_EQ(m.value("joint.2.amp-enable-out"), 0);
    EXPECT_EQ(m.value("motion.motion-enabled"), 0);
}

TEST(Motmod, KinematicsOfOthersMoveTheJoints) {
    Machine m;
    ASSERT_NO_FATAL_FAILURE(m.start("skewkins"));
    m.send(Abort{1});
    m.send(Enable{});
    m.send(SetMode{Mode::COORD});
    m.run(0.05);
    EXPECT_EQ(m.value("motion.coord-mode"), 0) << "not before homing";
    m.ready();
    EXPECT_EQ(m.value("motion.coord-mode"), 1);
    Line line;
    line.end[0] = 10;
    line.end[1] = 20;
    line.terms.feed = 50;
    m.channels->path.push({m.next_id++, 1, line});
    m.channels->path.push({m.next_id++, 1, Flush{}});
    m.run(2);
    EXPECT_EQ(m.value("joint.0.motor-pos-cmd"), 12.0);
    EXPECT_EQ(m.value("joint.1.motor-pos-cmd"), 20.0);
    EXPECT_EQ(m.value("axis.x.pos-cmd"), 10.0);
}

TEST(Motmod, WithoutKinematicsItSaysWhatToLoad) {
    Machine m;
    EXPECT_NE(m.load("motmod").find("loadrt trivkins"), std::string::npos);
    EXPECT_TRUE(m.host->hal().components().list().empty());
}

TEST(Motmod, RefusesCountsOutOfRange) {
    Machine m;
    ASSERT_EQ(m.load("trivkins"), "ok");
    EXPECT_NE(m.load("motmod", {"num_joints=17"}).find("num_joints=17 is out of range"), std::string::npos);
    EXPECT_NE(m.load("motmod", {"num_spindles=9"}).find("num_spindles"), std::string::npos);
    EXPECT_NE(m.load("motmod", {"num_joints=4", "num_extrajoints=4"}).find("num_extrajoints"),
              std::string::npos);
    EXPECT_NE(
        m.load("motmod", {"num_joints=12", "num_extrajoints=1"}).find("leaves 11 joints to the kinematics"),
        std::string::npos)
        << "trivkins moves nine, or those of coordinates=";
    ASSERT_EQ(m.load("motmod", {"num_joints=2", "num_dio=7"}), "ok");
    EXPECT_EQ(m.host->hal().pins().list("joint.*.motor-pos-cmd").size(), 2U);
    EXPECT_EQ(m.host->hal().pins().list("axis.*.pos-cmd").size(), 9U);
    EXPECT_EQ(m.host->hal().pins().list("motion.digital-in-*").size(), 7U);
}

TEST(Motmod, KinematicsThatLackAFunctionAreRefusedByItsName) {
    for (const std::string name : {"Forward", "Inverse", "Type"}) {
        Machine m;
        ASSERT_EQ(m.load("tpmod"), "ok");
        ASSERT_EQ(m.load("homemod"), "ok");
        ASSERT_EQ(m.load("without" + name), "ok");
        const std::string answer = m.load("motmod", {"num_joints=3"});
        EXPECT_NE(answer.find("exports kinematics" + name + ":"), std::string::npos) << answer;
    }
}

TEST(Motmod, TrivkinsRefusesLettersThatAreNoAxes) {
    Machine m;
    EXPECT_NE(m.load("trivkins", {"coordinates=XQ"}).find("XYZABCUVW"), std::string::npos);
    EXPECT_NE(m.load("trivkins", {"kinstype=z"}).find("kinstype"), std::string::npos);
    EXPECT_EQ(m.load("trivkins", {"coordinates=xyyz", "kinstype=BOTH"}), "ok");
}

TEST(Motmod, ModelsOfOtherMachinesLoad) {
    {
        Machine m;
        ASSERT_EQ(m.load("corexykins"), "ok");
        EXPECT_EQ(m.load("motmod", {"num_joints=3"}), "ok");
    }
    Machine m;
    EXPECT_NE(m.load("tablekins", {"tilt_y=near"}).find("expected a number"), std::string::npos);
    ASSERT_EQ(m.load("tablekins", {"tilt_y=12.5", "tilt_z=-40"}), "ok");
    EXPECT_EQ(m.load("motmod", {"num_joints=5"}), "ok");
}

TEST(Motmod, CanBeUnloadedAndLoadedAgain) {
    Machine m;
    ASSERT_NO_FATAL_FAILURE(m.start());
    m.ready();
    ASSERT_TRUE(m.host->hal().threads().stop());
    ASSERT_TRUE(m.host->unload_realtime("motmod"));
    ASSERT_EQ(m.load("motmod", {"num_joints=3"}), "ok");
}

}  // namespace
}  // namespace mw::motion
