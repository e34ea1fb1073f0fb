// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include "drivers/mesa/hostmot2/modules/period_meter.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t MODE = 0xB700, PERIOD = 0xB800, WIDTH = 0xB900, LIMIT = 0xBA00;

class PeriodMeterOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        // The mode register reads the written value, and the level and validity of the input.
        bus.on_read_register = [&](std::uint16_t address) -> std::optional<std::uint32_t> {
            return address == MODE ? std::optional((bus.registers[MODE] & ~6U) | status) : std::nullopt;
        };
        load(with_module(module_of(Gtag::PERIOD_METER, 1, MODE), {1}));
        cycle();
    }
    const std::string name = "periodm.00.";
    std::uint32_t status = 0;
};

TEST_F(PeriodMeterOfBoard, MeasuresTheMeanOfItsAverages) {
    for (const int averages : {1, 2, 100, 4096}) {
        pins.set(name + "averages", averages);
        pins.set(name + "duty_cycle_scale", 100);
        cycle();
        status = 2;
        bus.registers[PERIOD] = static_cast<std::uint32_t>(averages * 25'000 - 1);
        bus.registers[WIDTH] = static_cast<std::uint32_t>(averages * 5'000 - 1);
        cycle();
        EXPECT_NEAR(pins.get(name + "period_us"), 250.0, 1e-9) << averages;
        EXPECT_NEAR(pins.get(name + "width_us"), 50.0, 1e-9);
        EXPECT_NEAR(pins.get(name + "frequency"), 4000.0, 1e-6);
        EXPECT_NEAR(pins.get(name + "duty_cycle"), 20.0, 1e-9);
        EXPECT_EQ(pins.get(name + "valid"), 1.0);
    }
}

TEST_F(PeriodMeterOfBoard, ShowsZeroWithoutASignal) {
    bus.registers[PERIOD] = 1000;
    pins.set(name + "duty_cycle_offset", 3);
    status = 4;
    cycle();
    EXPECT_EQ(pins.get(name + "valid"), 0.0);
    EXPECT_EQ(pins.get(name + "frequency"), 0.0);
    EXPECT_EQ(pins.get(name + "duty_cycle"), 3.0);
    EXPECT_EQ(pins.get(name + "input_status"), 1.0);
    status = 0;
    bus.next_read = CycleRead::FAILED;
    cycle();
    EXPECT_EQ(pins.get(name + "input_status"), 1.0) << "a failed read keeps the values";
}

TEST_F(PeriodMeterOfBoard, SetsFilterPolarityAndLimit) {
    EXPECT_EQ(bus.registers[MODE], 10U << 16U) << "0.1 us";
    EXPECT_EQ(bus.registers[LIMIT], CLOCK_LOW) << "1 Hz";
    pins.set(name + "invert", 1);
    pins.set(name + "averages", 9999);
    pins.set(name + "filtertc_us", 1e9);
    pins.set(name + "minimum_frequency", 0);
    cycle();
    EXPECT_EQ(bus.registers[MODE], 1U | (4095U << 4U) | (0xFFFFU << 16U));
    EXPECT_EQ(bus.registers[LIMIT], 0xFFFFFFFFU);
    pins.set(name + "averages", 10);
    pins.set(name + "minimum_frequency", 1000);
    bus.next_write_lost = true;
    cycle(2);
    EXPECT_EQ(bus.registers[LIMIT], 10U * CLOCK_LOW / 1000U) << "again after a lost packet";
}

}  // namespace
}  // namespace mw::mesa::test
