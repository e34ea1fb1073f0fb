// SPDX-License-Identifier: GPL-2.0-or-later
// Boards in HAL: names, types and directions of pins, functions, and boards that are rejected.
#include <map>

#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"

namespace mw::mesa::test {
namespace {

using hal::Dir;
using hal::Type;

class BoardInHal : public ::testing::Test {
  protected:
    void load(const std::string &config = "") {
        ASSERT_EQ(machine.load("hostmot2"), "ok");
        ASSERT_EQ(machine.load("threads2"), "ok");
        ASSERT_EQ(machine.load("hm2_memory", {"config=" + config}), "ok") << machine.messages.all();
        ASSERT_TRUE(machine.hal().threads().add_function("hm2_7i76e.0.read", "fast"));
        ASSERT_TRUE(machine.hal().threads().add_function("hm2_7i76e.0.write", "fast"));
        ASSERT_TRUE(machine.hal().threads().start());
        run();
    }
    void run(int steps = 4) {
        for (int i = 0; i < steps; ++i) {
            machine.clock.step();
        }
    }
    void set(const std::string &name, const std::string &value) {
        ASSERT_EQ(hal::text_of(machine.hal().values().set("hm2_7i76e.0." + name, value)), "ok") << name;
    }
    double get(const std::string &name) { return machine.value("hm2_7i76e.0." + name).as_number(); }

    hal::TestMachine machine;
};

TEST_F(BoardInHal, HasThePinsOfItsModules) {
    load();
    std::map<std::string, std::pair<Type, Dir>> found;
    for (const hal::PinInfo &pin : machine.hal().pins().list("hm2_7i76e.0.*")) {
        found[pin.name.substr(12)] = {pin.type, pin.dir};
    }
    for (const hal::ParamInfo &param : machine.hal().params().list("hm2_7i76e.0.*")) {
        found[param.name.substr(12)] = {param.type, param.dir};
    }
    const std::map<std::string, std::pair<Type, Dir>> expected{
        {"gpio.017.in", {Type::BIT, Dir::OUT}},
        {"gpio.017.in_not", {Type::BIT, Dir::OUT}},
        {"gpio.017.out", {Type::BIT, Dir::IN}},
        {"gpio.017.is_output", {Type::BIT, Dir::RW}},
        {"stepgen.00.step.invert_output", {Type::BIT, Dir::RW}},
        {"stepgen.04.position-cmd", {Type::FLOAT, Dir::IN}},
        {"stepgen.04.counts", {Type::S32, Dir::OUT}},
        {"stepgen.04.steplen", {Type::U32, Dir::RW}},
        {"stepgen.timer-number", {Type::S32, Dir::IN}},
        {"encoder.00.index-enable", {Type::BIT, Dir::IO}},
        {"encoder.00.scale", {Type::FLOAT, Dir::RW}},
        {"encoder.sample-frequency", {Type::U32, Dir::IN}},
        {"pwmgen.01.value", {Type::FLOAT, Dir::IN}},
        {"pwmgen.01.output-type", {Type::S32, Dir::RW}},
        {"pwmgen.pwm_frequency", {Type::U32, Dir::RW}},
        {"watchdog.has_bit", {Type::BIT, Dir::IO}},
        {"watchdog.timeout_ns", {Type::U32, Dir::RW}},
        {"led.CR04", {Type::BIT, Dir::IN}},
        {"dpll.04.timer-us", {Type::FLOAT, Dir::IN}},
        {"dpll.phase-error-us", {Type::FLOAT, Dir::OUT}},
    };
    for (const auto &[name, kind] : expected) {
        ASSERT_TRUE(found.contains(name)) << name;
        EXPECT_EQ(found[name], kind) << name;
    }
    EXPECT_FALSE(found.contains("gpio.000.out"));
    EXPECT_FALSE(found.contains("led.CR05"));
}

TEST_F(BoardInHal, HasDefaultsAndFollowsItsPins) {
    load();
    EXPECT_EQ(get("watchdog.timeout_ns"), 5e6);
    EXPECT_EQ(get("stepgen.00.maxaccel"), 1.0);
    EXPECT_EQ(get("encoder.00.filter"), 1.0);
    EXPECT_EQ(get("watchdog.has_bit"), 0.0);
    set("stepgen.00.control-type", "1");
    set("stepgen.00.maxaccel", "0");
    set("stepgen.00.steplen", "1000");
    set("stepgen.00.stepspace", "1000");
    set("stepgen.00.velocity-cmd", "5");
    set("stepgen.00.enable", "1");
    run();
    EXPECT_EQ(get("stepgen.00.velocity-fb"), 5.0);
}

TEST_F(BoardInHal, ReleasesPinsByItsConfiguration) {
    load("num_stepgens=0");
    EXPECT_TRUE(machine.hal().values().get("hm2_7i76e.0.gpio.000.out").has_value());
    EXPECT_FALSE(machine.hal().values().get("hm2_7i76e.0.stepgen.00.enable").has_value());
}

TEST_F(BoardInHal, OtherComponentsUseItsSerialInterfaces) {
    ASSERT_EQ(machine.load("hostmot2"), "ok");
    ASSERT_EQ(machine.load("threads2"), "ok");
    ASSERT_EQ(machine.load("hm2_memory", {"uarts=1"}), "ok") << machine.messages.all();
    EXPECT_NE(machine.load("uart_user", {"name=hm2_7i76e.0.uart.1"}), "ok") << "there is one UART";
    ASSERT_EQ(machine.load("uart_user", {"name=hm2_7i76e.0.uart.0"}), "ok") << machine.messages.all();
    for (const char *function : {"hm2_7i76e.0.read", "uart-user", "hm2_7i76e.0.write"}) {
        ASSERT_TRUE(machine.hal().threads().add_function(function, "fast"));
    }
    ASSERT_TRUE(machine.hal().threads().start());
    run();
    EXPECT_EQ(machine.value("uart-user.sent").as_number(), 3.0);
    EXPECT_EQ(machine.value("uart-user.received").as_number(), 0.0);
}

TEST_F(BoardInHal, IsRefusedWithAWrongConfiguration) {
    ASSERT_EQ(machine.load("hostmot2"), "ok");
    EXPECT_NE(machine.load("hm2_memory", {"config=num_encoders=3"}), "ok");
    EXPECT_NE(
        machine.messages.all().find("hm2/hm2_7i76e.0: config: num_encoders=3, but this firmware has 1."),
        std::string::npos)
        << machine.messages.all();
    EXPECT_TRUE(machine.hal().pins().list("hm2_7i76e.*").empty());
}

TEST_F(BoardInHal, EveryTestBoardIsRefused) {
    const char *const texts[] = {"invalid cookie, got 0x00000000, expected 0x55AACAFE",
                                 "invalid config name, got '\?\?\?\?\?\?\?\?', expected 'HOSTMOT2'",
                                 "invalid IDROM type 0, expected 2 or 3",
                                 "invalid IDROM type 4660, expected 2 or 3",
                                 "invalid IDROM PortWidth 0, this board has 24 pins",
                                 "invalid IDROM PortWidth 29, this board has 24 pins",
                                 "IDROM IOPorts is 0 but llio num_ioport_connectors is 1",
                                 "IDROM IOWidth is 99, but IDROM IOPorts is 1 and IDROM PortWidth is 24",
                                 "IDROM IOPorts is 2 but llio num_ioport_connectors is 1",
                                 "IDROM ClockLow is 12345, that's too low",
                                 "IDROM ClockHigh is 0, that's too low",
                                 "pin 0 primary tag is 0 (end-of-list sentinel), expected 144 pins!",
                                 "hm2_set_pin_source: invalid pin number 0",
                                 "invalid IDROM PortWidth 24, this board has 5 pins",
                                 "IDROM IOPorts is 0 but llio num_ioport_connectors is 1"};
    ASSERT_EQ(machine.load("hostmot2"), "ok");
    int pattern = 0;
    for (const char *text : texts) {
        machine.messages.lines.clear();
        EXPECT_NE(machine.load("hm2_test", {"test_pattern=" + std::to_string(pattern)}), "ok") << pattern;
        const std::string all = machine.messages.all();
        // LinuxCNC's test hm2-idrom expects the reason between these two errors.
        const std::size_t begin = all.find("hm2_test: loading HostMot2 test driver with test pattern ");
        const std::size_t reason = all.find(std::string("hm2/hm2_test.0: ") + text);
        const std::size_t end = all.find("hm2_test.0: hm2_test fails HM2 registration");
        ASSERT_NE(end, std::string::npos) << pattern << '\n' << all;
        EXPECT_TRUE(begin < reason && reason < end) << pattern << '\n' << all;
        ++pattern;
    }
}

}  // namespace
}  // namespace mw::mesa::test
