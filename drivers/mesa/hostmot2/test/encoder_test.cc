// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <random>

#include "drivers/mesa/hostmot2/test/board_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t COUNT = 0x3000, CONTROL = 0x3100, STAMP = 0x3300;
constexpr std::uint32_t LATCH = 1U << 4U, ONCE = 1U << 6U;

/// Simulates a counter of the board with an index every `per_rev` counts.
struct Counter {
    std::int64_t count = 0;
    std::int64_t per_rev = 4000;
    std::uint32_t control = 0;
    std::uint16_t latch = 0, edge = 0;
    int arms = 0, events = 0;
    std::int64_t last_index = 0;

    void write(std::uint32_t value) {
        arms += (value & LATCH) != 0 ? 1 : 0;
        control = value & 0x7FF8U;
    }
    /// Moves, and stamps the last edge at the end of the time `ticks`.
    void move(std::int64_t counts, std::uint16_t now) {
        const std::int64_t step = counts < 0 ? -1 : 1;
        for (std::int64_t i = 0; i != counts; i += step) {
            count += step;
            edge = now;
            if (count % per_rev == 0 && (control & LATCH) != 0) {
                control &= ~LATCH;
                latch = static_cast<std::uint16_t>(count);
                last_index = count;
                ++events;
            }
        }
    }
    std::uint32_t count_word() const {
        return (static_cast<std::uint32_t>(edge) << 16U) | static_cast<std::uint16_t>(count);
    }
    std::uint32_t control_word() const { return (static_cast<std::uint32_t>(latch) << 16U) | control; }
};

class EncoderOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        load(firmware());
        bus.on_write = [this](RegisterWrite write) {
            if (write.address == CONTROL) {
                counter.write(write.value);
            }
        };
        pass(0);
        pass(0);
        counter.arms = 0;
    }
    void pass(std::int64_t counts) {
        now = static_cast<std::uint16_t>(now + 2000);  // 1 ms at 2 MHz
        counter.move(counts, now);
        bus.registers[COUNT] = counter.count_word();
        bus.registers[CONTROL] = counter.control_word();
        bus.registers[STAMP] = now;
        cycle();
    }

    const std::string name = "encoder.00.";
    Counter counter;
    std::uint16_t now = 0;
};

TEST_F(EncoderOfBoard, CountsExactlyOverManyWrapsAndLostCycles) {
    std::mt19937 random(3);
    for (int i = 0; i < 20'000; ++i) {
        const bool lost = i % 3 != 0 && random() % 3 == 0;
        const int most = lost ? 5000 : 10'000;
        bus.next_read = lost ? CycleRead::FAILED : CycleRead::DONE;
        pass(std::uniform_int_distribution<int>(-most, most + most / 2)(random));
        if (!lost) {
            ASSERT_EQ(static_cast<std::int64_t>(pins.get(name + "rawcounts")),
                      static_cast<std::int32_t>(counter.count))
                << i;
            ASSERT_NEAR(pins.get(name + "position"), static_cast<double>(counter.count), 1e-6);
        }
    }
}

TEST_F(EncoderOfBoard, VelocityComesFromTheTimeOfTheEdges) {
    pins.set(name + "scale", 100);
    for (int i = 0; i < 10; ++i) {
        pass(7);
    }
    EXPECT_NEAR(pins.get(name + "velocity"), 70.0, 0.1);
    EXPECT_NEAR(pins.get(name + "velocity-rpm"), 4200.0, 6.0);
    pass(0);
    EXPECT_LE(pins.get(name + "velocity"), 10.0) << "less than a count in the time since the last one";
    for (int i = 0; i < 510; ++i) {
        pass(0);
    }
    EXPECT_EQ(pins.get(name + "velocity"), 0.0);
}

TEST_F(EncoderOfBoard, IndexSetsTheZeroExactlyAndFallsOnce) {
    pass(1234);
    pins.set(name + "index-enable", 1);
    pass(1000);
    EXPECT_EQ(pins.get(name + "index-enable"), 1.0);
    pass(3000);
    EXPECT_EQ(pins.get(name + "index-enable"), 0.0);
    EXPECT_EQ(pins.get(name + "count"), static_cast<double>(counter.count - 4000));
    EXPECT_EQ(pins.get(name + "rawlatch"), 4000.0);
    EXPECT_EQ(counter.arms, 1);
    for (int i = 0; i < 10; ++i) {
        pass(4000);
    }
    EXPECT_EQ(pins.get(name + "count"), static_cast<double>(counter.count - 4000));
}

TEST_F(EncoderOfBoard, NoArmIsLostOrDoubledWhenPacketsAreLost) {
    std::mt19937 random(11);
    int arms = 0, done = 0;
    for (int i = 0; i < 200'000 && arms < 3000; ++i) {
        if (pins.get(name + "index-enable") == 0.0 && random() % 3 == 0) {
            pins.set(name + "index-enable", 1);
            ++arms;
            counter.events = 0;
        }
        bus.next_read = random() % 5 == 0 ? CycleRead::FAILED : CycleRead::DONE;
        bus.next_write_lost = random() % 5 == 0;
        const bool was_wanted = pins.get(name + "index-enable") != 0.0;
        pass(std::uniform_int_distribution<int>(-300, 900)(random));
        ASSERT_LE(counter.events, 1) << "one event for each request, cycle " << i;
        if (was_wanted && pins.get(name + "index-enable") == 0.0) {
            ASSERT_EQ(counter.events, 1) << "no event without an index, cycle " << i;
            ASSERT_EQ(static_cast<std::int64_t>(pins.get(name + "rawlatch")),
                      static_cast<std::int32_t>(counter.last_index))
                << i;
            ++done;
        }
    }
    EXPECT_GE(done, 2999);
    EXPECT_GE(arms, 3000);
}

TEST_F(EncoderOfBoard, ARequestThatIsWithdrawnLeavesNoLatch) {
    pins.set(name + "index-enable", 1);
    pass(10);
    pass(10);
    EXPECT_NE(counter.control & LATCH, 0U);
    pins.set(name + "index-enable", 0);
    pass(10);
    EXPECT_EQ(counter.control & (LATCH | ONCE), 0U);
    pass(5000);
    EXPECT_EQ(pins.get(name + "count"), static_cast<double>(counter.count));
}

TEST_F(EncoderOfBoard, ResetKeepsTheCountAtZero) {
    pass(500);
    pins.set(name + "reset", 1);
    pass(100);
    EXPECT_EQ(pins.get(name + "count"), 0.0);
    EXPECT_EQ(pins.get(name + "rawcounts"), 600.0);
    pins.set(name + "reset", 0);
    pass(25);
    EXPECT_EQ(pins.get(name + "count"), 25.0);
}

TEST_F(EncoderOfBoard, SettingsAreRestoredWhenTheBoardLosesThem) {
    pins.set(name + "filter", 0);
    pins.set(name + "counter-mode", 1);
    pass(0);
    pass(0);
    EXPECT_EQ(counter.control, 1U << 10U);
    counter.control = 0;
    pass(0);
    EXPECT_EQ(counter.control, 1U << 10U);
}

TEST_F(EncoderOfBoard, FrequenciesAreDividers) {
    EXPECT_EQ(bus.registers[0x3200], CLOCK_LOW / 2'000'000 - 2);
    EXPECT_EQ(bus.registers[0x3400], CLOCK_LOW / 25'000'000 - 2);
    pins.set("encoder.hires-timestamp", 1);
    pins.set("encoder.sample-frequency", 1'000'000);
    pass(0);
    EXPECT_EQ(bus.registers[0x3200], CLOCK_LOW / 10'000'000 - 2);
    EXPECT_EQ(bus.registers[0x3400], CLOCK_LOW / 1'000'000 - 2);
}

}  // namespace
}  // namespace mw::mesa::test
