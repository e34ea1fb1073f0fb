// SPDX-License-Identifier: GPL-2.0-or-later
// Every fault switches the torch off, moves it up and pauses the program. Invalid inputs have no effect.
#include <cmath>
#include <limits>
#include <random>

#include "components/plasma/test/cut.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::plasma::test {
namespace {

TEST(PlasmaSafety, LostArcPausesTheProgram) {
    Cut table;
    table.cut();
    table.volts = 0.0;
    ASSERT_TRUE(table.reaches(State::MAX_HEIGHT));
    EXPECT_FALSE(table.out().torch_on);
    EXPECT_EQ(table.core.take_fault(), Fault::ARC_LOST);
    table.run(20);
    EXPECT_TRUE(table.in.program_is_paused);
    EXPECT_EQ(table.out().z_offset_counts, 0);
}

TEST(PlasmaSafety, ShortGapOfTheArcIsNoLoss) {
    Cut table;
    table.cut();
    table.volts = 0.0;
    table.run(15);
    table.volts = 100.0;
    table.run(100);
    EXPECT_EQ(table.core.state(), State::CUT_BY_VOLTAGE);
    EXPECT_TRUE(table.out().torch_on);
}

TEST(PlasmaSafety, SensorsInTheCutStopItInTheSameCycle) {
    for (bool Inputs::*sensor : {&Inputs::breakaway, &Inputs::float_switch, &Inputs::ohmic_probe}) {
        Cut table;
        table.cut();
        table.has_float = false;
        table.in.ohmic_probe_enable = true;
        table.in.*sensor = true;
        table.cycle();
        EXPECT_FALSE(table.out().torch_on);
        EXPECT_TRUE(table.out().feed_hold);
        EXPECT_TRUE(table.out().program_pause);
    }
}

TEST(PlasmaSafety, ProgramStopTurnsTheTorchOff) {
    Cut table;
    table.cut();
    table.in.program_is_idle = true;
    table.in.program_is_running = false;
    table.cycle();
    EXPECT_FALSE(table.out().torch_on);
    EXPECT_EQ(table.core.state(), State::MAX_HEIGHT);
}

TEST(PlasmaSafety, MachineOffTurnsAllOff) {
    Cut table;
    table.cut();
    table.in.machine_is_on = false;
    table.cycle();
    EXPECT_FALSE(table.out().torch_on);
    EXPECT_EQ(table.core.state(), State::IDLE);
    EXPECT_EQ(table.out().z_offset_counts, 0);
}

TEST(PlasmaSafety, NoMaterialEndsTheProbing) {
    Cut table;
    table.material_mu = -5.0;
    table.start();
    ASSERT_TRUE(table.reaches(State::MAX_HEIGHT));
    EXPECT_EQ(table.core.take_fault(), Fault::NO_MATERIAL);
    EXPECT_EQ(table.out().pierce_count, 0);
}

TEST(PlasmaSafety, HeightsThatMakeNoSenseStartNoTorch) {
    Cut table;
    table.in.pierce_height = 0.0;
    table.start();
    ASSERT_TRUE(table.reaches(State::MAX_HEIGHT));
    EXPECT_EQ(table.core.take_fault(), Fault::HEIGHTS_MISSING);
    EXPECT_EQ(table.out().pierce_count, 0);
}

TEST(PlasmaSafety, SafeHeightStaysBelowTheEndOfZ) {
    Cut table;
    table.in.safe_height = 500.0;
    table.cut();
    table.in.cutting_start = false;
    ASSERT_TRUE(table.reaches(State::IDLE));
    EXPECT_LE(table.torch_mu(), 95.001);  // the limit less max-offset
}

TEST(PlasmaSafety, HeightControlStopsAtTheLowerEnd) {
    Cut table;
    table.cut();
    table.has_float = false;
    table.in.axis_z_min_limit = 3.0;
    table.volts = 190.0;
    ASSERT_TRUE(table.reaches(State::MAX_HEIGHT));
    EXPECT_EQ(table.core.take_fault(), Fault::THC_AT_BOTTOM);
}

TEST(PlasmaSafety, LowVoltageStopsBeforeTheArcIsLost) {
    Cut table;
    table.in.low_cut_volts = 95;
    table.cut();
    table.volts = 94.0;
    table.cycle();
    EXPECT_FALSE(table.out().torch_on);
}

TEST(PlasmaSafety, ProbeTestFailsWithASensorClosed) {
    Cut table;
    table.in.breakaway = true;
    table.in.probe_test = true;
    table.run(50);
    EXPECT_TRUE(table.out().probe_test_error);
    EXPECT_EQ(table.out().z_offset_counts, 0);
}

TEST(PlasmaSafety, WhatIsNoNumberTurnsTheTorchOffAndStandsStill) {
    sdk::for_each_pin(INPUT_PINS, [&](const char *, const auto &row) {
        using Value = typename std::remove_cvref_t<decltype(row)>::Value;
        if constexpr (std::is_same_v<Value, double>) {
            for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
                Cut table;
                table.cut();
                const std::int32_t before = table.out().z_offset_counts;
                for (int i = 0; i < 20; ++i) {
                    table.in.are_numbers = true;
                    row.read(table.in, bad);
                    table.core.step(table.in, PERIOD_S);
                    ASSERT_FALSE(table.out().torch_on) << row.name;
                    ASSERT_EQ(table.out().z_offset_counts, before) << row.name;
                    ASSERT_TRUE(table.out().feed_hold) << row.name;
                }
                table.in.are_numbers = true;
                table.cycle();
                EXPECT_NE(table.core.state(), State::CUT_BY_VOLTAGE) << row.name;
            }
        }
    });
}

TEST(PlasmaSafety, DivisorsOfZeroTurnTheTorchOff) {
    for (const char *name : {"units-per-mm", "resolution", "gcode-scale"}) {
        Cut table;
        table.cut();
        set_input(table.in, name, 0.0);
        table.core.step(table.in, PERIOD_S);
        EXPECT_FALSE(table.out().torch_on) << name;
        EXPECT_TRUE(table.out().feed_hold) << name;
    }
}

TEST(PlasmaSafety, WildInputsNeverComeOutAsNoNumbers) {
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random(seed);
        Cut table;
        table.start();
        const testing::AllocationGuard guard;
        for (int i = 0; i < 600; ++i) {
            const auto chosen = random() % 127;
            unsigned index = 0;
            const double wild[] = {0.0, 1.0, -1.0, 1e300, -1e300, 1e-300, 5.0, 100.0, 2147483647.0, -5.0};
            if (random() % 4 == 0) {
                sdk::for_each_pin(INPUT_PINS, [&](const char *, const auto &row) {
                    using Value = typename std::remove_cvref_t<decltype(row)>::Value;
                    if (index++ == chosen) {
                        const double value = wild[random() % 10];
                        row.read(table.in, std::is_same_v<Value, double>     ? static_cast<Value>(value)
                                           : std::fabs(value) < 2147483648.0 ? static_cast<Value>(value)
                                                                             : Value{});
                    }
                });
            }
            table.cycle();
            sdk::for_each_pin(OUTPUT_PINS, [&](const char *, const auto &row) {
                const auto value = static_cast<double>(row.write(table.out()));
                ASSERT_TRUE(std::isfinite(value)) << row.name << " seed " << seed << " cycle " << i;
            });
        }
    }
}

}  // namespace
}  // namespace mw::plasma::test
