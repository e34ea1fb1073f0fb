// SPDX-License-Identifier: GPL-2.0-or-later
#include <random>

#include "drivers/mesa/hostmot2/modules/inputs.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

class InputsOfBoard : public BoardTest {
  protected:
    void load_inputs(Gtag gtag, std::uint32_t highest_input) {
        bus.registers[CONTROL] = highest_input;
        load(with_module(module_of(gtag, 1, CONTROL), {0x01}));
        cycle();
    }
    static constexpr std::uint16_t CONTROL = 0x8000, FILTER = 0x8100, FILTERED = 0x8200, RAW = 0x8300,
                                   WHEELS = 0x8400;
};

TEST_F(InputsOfBoard, HaveAsManyPinsAsTheModuleScans) {
    load_inputs(Gtag::IN_MUX, 15);
    EXPECT_EQ(pins.get("inmux.00.scan_width"), 16.0);
    for (const char *name :
         {"input-15", "input-15-not", "raw-input-15", "raw-input-15-not", "input-15-slow"}) {
        EXPECT_TRUE(pins.pins.contains(std::string("inmux.00.") + name)) << name;
    }
    EXPECT_FALSE(pins.pins.contains("inmux.00.input-16"));
}

TEST_F(InputsOfBoard, ShowFilteredAndRawLevels) {
    load_inputs(Gtag::IN_M, 7);
    bus.registers[FILTERED] = 0x81;
    bus.registers[RAW] = 0x42;
    cycle();
    for (unsigned i = 0; i < 8; ++i) {
        const bool filtered = ((0x81U >> i) & 1U) != 0, raw = ((0x42U >> i) & 1U) != 0;
        const std::string n = "0" + std::to_string(i);
        EXPECT_EQ(pins.get("inm.00.input-" + n), filtered) << i;
        EXPECT_EQ(pins.get("inm.00.input-" + n + "-not"), !filtered) << i;
        EXPECT_EQ(pins.get("inm.00.raw-input-" + n), raw) << i;
        EXPECT_EQ(pins.get("inm.00.raw-input-" + n + "-not"), !raw) << i;
    }
    bus.registers[FILTERED] = 0;
    bus.next_read = CycleRead::FAILED;
    cycle();
    EXPECT_EQ(pins.get("inm.00.input-00"), 1.0) << "a failed read keeps the values";
    cycle();
    EXPECT_EQ(pins.get("inm.00.input-00"), 0.0);
}

/// The words that LinuxCNC's driver writes with the same parameters and a clock of 100 MHz.
TEST_F(InputsOfBoard, HaveTheRegistersOfLinuxCnc) {
    load_inputs(Gtag::IN_MUX, 31);
    EXPECT_EQ(bus.registers[CONTROL], 0x7D0509A0U);
    pins.set("inmux.00.input-03-slow", 1);
    pins.set("inmux.00.enc1_4xmode", 1);
    pins.set("inmux.00.fast_scans", 100);
    pins.set("inmux.00.slow_scans", 5000);
    cycle();
    EXPECT_EQ(bus.registers[FILTER], 8U);
    EXPECT_EQ(bus.registers[WHEELS], 0x100U);
    EXPECT_EQ(bus.registers[CONTROL], 0xFFFF09A0U);
    EXPECT_EQ(pins.get("inmux.00.fast_scans"), 63.0) << "limited";
    EXPECT_EQ(pins.get("inmux.00.slow_scans"), 1023.0);
}

TEST(InputsControl, LimitsTheScanRateToWhatTheDivisorMakes) {
    for (const std::uint32_t width : {1U, 7U, 8U, 16U, 32U}) {
        for (std::uint32_t rate = 1; rate < 100'000'000; rate = rate * 3 / 2 + 1) {
            InputsPins pins;
            pins.scan_width = width;
            pins.scan_rate = rate;
            const std::uint32_t divisor = (inputs_control(pins, CLOCK_LOW) >> 6U) & 0x3FFU;
            const double made = CLOCK_LOW / 4.0 / (divisor + 1) / width;
            const double lowest = CLOCK_LOW / 4.0 / 1024 / width, highest = CLOCK_LOW / 4.0 / width;
            EXPECT_GE(made * 1.001, std::min(std::max<double>(rate, lowest), highest))
                << rate << ' ' << width;
            EXPECT_LE(made, std::max<double>(rate, lowest) * 2 + 1) << rate << ' ' << width;
        }
    }
}

TEST(InputsWheels, CountOverEveryWrap) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> change(-127, 127);
    InputsState state;
    InputsPins pins;
    std::array<int, HAND_WHEELS> position{12, -5, 200, 0};
    const auto word = [&] {
        std::uint32_t all = 0;
        for (unsigned i = 0; i < HAND_WHEELS; ++i) {
            all |= (static_cast<std::uint32_t>(position[i]) & 0xFFU) << (8 * i);
        }
        return all;
    };
    inputs_count(state, pins, word());
    const auto start = position;
    for (int step = 0; step < 10'000; ++step) {
        for (int &p : position) {
            p += change(random);
        }
        inputs_count(state, pins, word());
        for (std::size_t i = 0; i < HAND_WHEELS; ++i) {
            ASSERT_EQ(pins.count[i], position[i] - start[i]) << step;
        }
    }
    pins.reset[2] = true;
    inputs_count(state, pins, word());
    EXPECT_EQ(pins.count[2], 0);
}

TEST_F(InputsOfBoard, CannotBeLoadedWithoutAnAnswer) {
    bus.read_rejected = true;
    const auto made = Board::make(bus, with_module(module_of(Gtag::IN_M, 1, CONTROL)), *parse_config(""));
    EXPECT_FALSE(made.has_value());
}

}  // namespace
}  // namespace mw::mesa::test
