// SPDX-License-Identifier: GPL-2.0-or-later
// Smart serial cards of the simulated board driven through HAL pins: field outputs and inputs, faults of the
// exchange, lost packets.
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/test/rig.hh"

namespace mw::mesa::test {
namespace {

constexpr const char *CARDS = "remote 0 card=7i76\nremote 1 card=7i84\n";

class MesaSmartSerial : public ::testing::Test {
  protected:
    void load(const std::string &modes = "00xxxxxx", const std::string &faults = "") {
        rig = std::make_unique<Rig>(
            RigPlan{.config = "num_stepgens=1 sserial_port_0=" + modes, .physics = CARDS, .faults = faults});
        // Single lost packets do not stop the bus and do not cause a bite of the watchdog.
        rig->bus->settings.error_limit = 1'000'000;
        rig->pins.set("watchdog.timeout_ns", 50'000'000);
        cycle(40);
    }
    void cycle(int count) {
        for (int i = 0; i < count; ++i) {
            rig->cycle();
            char text[512];
            while (const std::size_t length = rig->driver->take_message(text)) {
                messages.emplace_back(text, length);
            }
        }
    }
    board::Remote &remote(unsigned channel) {
        return *rig->simulated.firmware().smart_serial()->remote(0, channel);
    }
    void set(const std::string &pin, double value) { rig->pins.set(pin, value); }
    double get(const std::string &pin) { return rig->pins.get(pin); }
    /// Another master stops the cards; the next exchanges fail, as without a cable.
    void disturb() { rig->simulated.firmware().write(0x5A00, 0x8FF); }

    std::unique_ptr<Rig> rig;
    std::vector<std::string> messages;
};

TEST_F(MesaSmartSerial, RunsAfterTheStart) {
    load();
    EXPECT_EQ(get("sserial.port-0.port_state"), 3);
    EXPECT_EQ(get("sserial.port-0.fault-count"), 0);
    EXPECT_EQ(get("sserial.port-0.fault"), 0);
    EXPECT_TRUE(messages.empty());
    EXPECT_TRUE(rig->driver->warnings().empty());
}

TEST(MesaSmartSerialOptions, CardsAreNamedByTheirSerialNumber) {
    // The simulated cards have the numbers 1 and 2.
    Rig rig({.config = "sserial_port_0=00xxxxxx", .physics = CARDS, .is_named_by_serial_number = true});
    rig.pins.set("/hm2_7i76.0001.output-03", 1);
    EXPECT_TRUE(rig.pins.pins.contains("/hm2_7i84.0002.input-00"));
    EXPECT_FALSE(rig.pins.pins.contains("7i76.0.0.output-03"));
    for (int i = 0; i < 40; ++i) {
        rig.cycle();
    }
    EXPECT_EQ(rig.simulated.firmware().smart_serial()->remote(0, 0)->value("Output"), 8U);
}

TEST(MesaSmartSerialOptions, CardsOfAnotherBaudRateAreNotFound) {
    for (const auto &[baudrate, isFound] : {std::pair{-1, true}, {2'500'000, true}, {115'200, false}}) {
        Rig rig({.config = "sserial_port_0=00xxxxxx", .physics = CARDS, .sserial_baudrate = baudrate});
        EXPECT_EQ(rig.pins.pins.contains("7i76.0.0.output-03"), isFound) << baudrate;
        EXPECT_EQ(rig.pins.pins.contains("7i84.0.1.output-03"), isFound) << baudrate;
    }
}

TEST_F(MesaSmartSerial, OutputsReachTheField) {
    load();
    set("7i76.0.0.output-03", 1);
    set("7i76.0.0.output-15-invert", 1);
    set("7i76.0.0.spinout", 50);
    set("7i76.0.0.spinena", 1);
    set("7i84.0.1.output-07", 1);
    cycle(3);
    EXPECT_EQ(remote(0).value("Output"), 0x8008U);
    EXPECT_EQ(remote(0).value("SpinOut"), 0x7FFFU);
    EXPECT_EQ(remote(0).value("SpinEna"), 1U);
    EXPECT_EQ(remote(0).value("SpinDir"), 0U);
    EXPECT_EQ(remote(1).value("Output"), 0x80U);
}

TEST_F(MesaSmartSerial, InputsComeFromTheField) {
    load();
    remote(0).set_value("Input", 0x80000001);
    remote(1).set_value("Input", 0x2);
    cycle(3);
    EXPECT_EQ(get("7i76.0.0.input-00"), 1);
    EXPECT_EQ(get("7i76.0.0.input-00-not"), 0);
    EXPECT_EQ(get("7i76.0.0.input-31"), 1);
    EXPECT_EQ(get("7i76.0.0.input-01"), 0);
    EXPECT_EQ(get("7i84.0.1.input-01"), 1);
}

TEST_F(MesaSmartSerial, AModeHasItsAnalogueInputsAndEncoders) {
    load("20xxxxxx");
    EXPECT_NEAR(get("7i76.0.0.analogin1-scalemax"), 36.3, 1e-5);
    remote(0).set_value("AnalogIn1", 0x800);
    for (int i = 1; i <= 100; ++i) {
        remote(0).set_value("Enc1", static_cast<std::uint32_t>(5 * i) & 0xFFU);
        cycle(1);
    }
    cycle(2);
    EXPECT_NEAR(get("7i76.0.0.analogin1"), 36.3 * 0x800 / 0xFFF, 1e-4);
    EXPECT_EQ(get("7i76.0.0.enc1.count"), 500);
    EXPECT_EQ(get("7i76.0.0.enc0.count"), 0);
}

TEST_F(MesaSmartSerial, AChannelThatIsNotUsedIsGpio) {
    load("0xxxxxxx");
    EXPECT_FALSE(rig->pins.pins.contains("7i84.0.1.output-00"));
    EXPECT_TRUE(rig->pins.pins.contains("gpio.012.out"));
    EXPECT_FALSE(rig->pins.pins.contains("gpio.010.out"));
    EXPECT_TRUE(rig->pins.aliases.contains("sserial.00.tx0.invert_output"));
}

TEST_F(MesaSmartSerial, AModeThatTheCardDoesNotHaveIsAWarning) {
    load("7xxxxxxx");
    ASSERT_EQ(rig->driver->warnings().size(), 1U);
    EXPECT_NE(rig->driver->warnings()[0].find("has no mode 7"), std::string::npos);
}

TEST_F(MesaSmartSerial, ItRecoversByItselfAndOutputsStayOffUntilTheyAreSwitchedAgain) {
    load();
    set("7i76.0.0.output-03", 1);
    set("7i76.0.0.spinena", 1);
    remote(0).set_value("Input", 1);
    cycle(5);
    disturb();
    int cycles = 0;
    while (get("sserial.port-0.fault") == 0 && cycles++ < 100) {
        cycle(1);
    }
    EXPECT_LE(cycles, 25);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_NE(messages[0].find("Smart serial card 7i76.0.0 failed: no answer"), std::string::npos)
        << messages[0];
    cycles = 0;
    while (get("sserial.port-0.fault") != 0 && cycles++ < 1000) {
        cycle(1);
    }
    EXPECT_LT(cycles, 1000) << "within a second";
    remote(0).set_value("Input", 2);
    cycle(20);
    EXPECT_EQ(get("sserial.port-0.port_state"), 3);
    EXPECT_EQ(get("7i76.0.0.input-01"), 1) << "inputs are served";
    EXPECT_EQ(remote(0).value("Output"), 0U);
    EXPECT_EQ(remote(0).value("SpinEna"), 0U);
    ASSERT_EQ(messages.size(), 2U);
    EXPECT_NE(messages[1].find("runs again after"), std::string::npos);
    set("7i76.0.0.output-03", 0);
    cycle(2);
    set("7i76.0.0.output-03", 1);
    cycle(3);
    EXPECT_EQ(remote(0).value("Output"), 8U);
    EXPECT_EQ(remote(0).value("SpinEna"), 0U);
    set("sserial.port-0.run", 0);
    cycle(3);
    set("sserial.port-0.run", 1);
    cycle(30);
    EXPECT_EQ(remote(0).value("SpinEna"), 1U) << "the operator has stopped and started the port";
}

class MesaSmartSerialLoss : public MesaSmartSerial, public ::testing::WithParamInterface<const char *> {};

TEST_P(MesaSmartSerialLoss, LostPacketsNeverStopIt) {
    for (const char *seed : {"seed 1\n", "seed 2\n", "seed 3\n"}) {
        messages.clear();
        load("00xxxxxx", std::string(seed) + GetParam());
        unsigned wrong = 0;
        for (unsigned i = 0; i < 2000; ++i) {
            const std::uint32_t value = i & 0xFFFFU;
            for (unsigned bit = 0; bit < 16; ++bit) {
                set("7i76.0.0.output-" + std::string(bit < 10 ? "0" : "") + std::to_string(bit),
                    ((value >> bit) & 1U) != 0 ? 1 : 0);
            }
            cycle(10);
            wrong += remote(0).value("Output") != value ? 1U : 0U;
        }
        EXPECT_LE(wrong, 2U) << GetParam();
        EXPECT_EQ(get("sserial.port-0.fault"), 0);
        EXPECT_TRUE(messages.empty()) << messages.front();
        EXPECT_GT(rig->bus->errors().total(), 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, MesaSmartSerialLoss,
                         ::testing::Values("to_board loss=0.01\nto_host loss=0.01",
                                           "to_board loss=0.05\nto_host loss=0.05",
                                           "to_board burst=0.001 burst_packets=4"));

// Random faults of the exchange, lost packets, bites of the watchdog and stops by the operator.
TEST_F(MesaSmartSerial, AfterAnyFaultItRunsWithinASecondAndNoOutputReturnsByItself) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        messages.clear();
        load("00xxxxxx", "seed " + std::to_string(seed) + "\nto_board loss=0.01\nto_host loss=0.01");
        std::mt19937 random(seed);
        const auto happens = [&](double chance) { return std::bernoulli_distribution(chance)(random); };
        set("7i76.0.0.output-03", 1);
        cycle(5);
        bool held = false;
        int faulty = 0, bursts = 0;
        for (int i = 0; i < 20'000; ++i) {
            if (happens(0.001)) {
                disturb();
            }
            if (happens(0.0002)) {
                rig->wait(100'000'000);
            }
            if (get("watchdog.has_bit") != 0 && happens(0.01)) {
                set("watchdog.has_bit", 0);
            }
            const bool toggled = happens(0.0005);
            if (toggled) {
                set("sserial.port-0.run", 0);
                cycle(3);
                set("sserial.port-0.run", 1);
                held = false;
            }
            const bool was_faulty = get("sserial.port-0.fault") != 0;
            cycle(1);
            const bool is_faulty = get("sserial.port-0.fault") != 0;
            bursts += is_faulty && !was_faulty ? 1 : 0;
            held = held || is_faulty;
            const bool bitten = get("watchdog.has_bit") != 0;
            faulty = is_faulty && !bitten ? faulty + 1 : 0;
            ASSERT_LT(faulty, 1000) << "seed " << seed << " cycle " << i;
            if (held && get("sserial.port-0.port_state") == 3) {
                ASSERT_EQ(remote(0).value("Output"), 0U) << "seed " << seed << " cycle " << i;
            }
        }
        EXPECT_GT(bursts, 3) << seed;
        EXPECT_LE(messages.size(), static_cast<std::size_t>(2 * bursts) + 2U) << seed;
    }
}

TEST_F(MesaSmartSerial, AfterABiteOfTheWatchdogItRunsWithoutAFault) {
    load();
    set("7i76.0.0.output-03", 1);
    cycle(5);
    rig->wait(500'000'000);
    cycle(50);
    ASSERT_EQ(get("watchdog.has_bit"), 1);
    set("watchdog.has_bit", 0);
    cycle(60);
    EXPECT_EQ(get("sserial.port-0.port_state"), 3);
    EXPECT_EQ(get("sserial.port-0.fault"), 0);
    EXPECT_EQ(remote(0).value("Output"), 8U);
    EXPECT_TRUE(messages.empty());
}

}  // namespace
}  // namespace mw::mesa::test
