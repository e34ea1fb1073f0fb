// SPDX-License-Identifier: GPL-2.0-or-later
// Arithmetic properties of the canonical devices, with seeded random numbers.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "hal/sdk/device_values.hh"

namespace mw::sdk {
namespace {

constexpr double INF = std::numeric_limits<double>::infinity();
constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
constexpr unsigned SEED = 20361128;
constexpr int ROUNDS = 20000;

TEST(DeviceValues, OutputIsTheInverseOfInputWithinTheRange) {
    std::mt19937_64 random(SEED);
    std::uniform_real_distribution<double> values(-5, 5), scales(0.1, 1.5);
    for (int i = 0; i < ROUNDS; ++i) {
        const double value = values(random), scale = scales(random), offset = values(random) / 5;
        const double volts = scaled_output(value, {scale, offset, -10, 10}, {});
        EXPECT_NEAR(scaled_input(volts, 1 / scale, offset / scale), value, 1e-12)
            << "seed " << SEED << " round " << i;
    }
}

TEST(DeviceValues, CodeIsWithinHalfABitOfTheVoltage) {
    std::mt19937_64 random(SEED);
    std::uniform_real_distribution<double> volts(-10, 10);
    const ConverterRange out{.bit_weight = 20.0 / 4096, .hw_offset = -10},
        in{.bit_weight = 20.0 / 4096, .hw_offset = 10};
    for (int i = 0; i < ROUNDS; ++i) {
        const double wanted = volts(random);
        // Half a bit plus rounding errors.
        EXPECT_NEAR(converter_reading(converter_code(wanted, out), in), wanted, out.bit_weight / 2 + 1e-12);
    }
    EXPECT_EQ(converter_code(1e300, {.bit_weight = 1e-3}), 2147483647);
    EXPECT_EQ(converter_code(-1e300, {.bit_weight = 1e-3}), -2147483647);
    EXPECT_EQ(converter_code(5, {.bit_weight = 0}), 5) << "a weight of 0 counts as 1";
    EXPECT_EQ(converter_code(NOT_A_NUMBER, {}), 0);
}

TEST(DeviceValues, OutputNeverLeavesTheLimits) {
    std::mt19937_64 random(SEED);
    std::uniform_real_distribution<double> any(-100, 100);
    for (int i = 0; i < ROUNDS; ++i) {
        const OutputScaling scaling{any(random), any(random), any(random) / 5, any(random) / 5};
        const double volts = scaled_output(any(random), scaling, {});
        if (scaling.low_limit > scaling.high_limit || scaling.low_limit > 10 || scaling.high_limit < -10) {
            EXPECT_EQ(volts, 0.0) << "limits that exclude each other";
        } else {
            EXPECT_GE(volts, std::max(scaling.low_limit, -10.0));
            EXPECT_LE(volts, std::min(scaling.high_limit, 10.0));
        }
    }
}

TEST(DeviceValues, OutputOfFiguresThatAreNotFiniteIsZero) {
    const OutputScaling plain{1, 2, -10, 10};
    for (const double bad : {INF, -INF, NOT_A_NUMBER}) {
        EXPECT_EQ(scaled_output(bad, plain, {}), 0.0);
        EXPECT_EQ(scaled_output(1, {bad, 2, -10, 10}, {}), 0.0);
        EXPECT_EQ(scaled_output(1, {1, bad, -10, 10}, {}), 0.0);
    }
    EXPECT_EQ(scaled_output(1, {1, 2, NOT_A_NUMBER, 10}, {}), 0.0);
    EXPECT_EQ(scaled_output(1, {1, 2, -10, NOT_A_NUMBER}, {}), 0.0);
    EXPECT_EQ(scaled_output(1, {1, 2, -INF, INF}, {}), 3.0) << "limits may be infinite";
    EXPECT_EQ(scaled_output(1e308, {1e308, 0, -10, 10}, {}), 0.0) << "the product is infinite";
    EXPECT_EQ(scaled_output(1, {0, 2, -10, 10}, {}), 3.0) << "a scale of 0 counts as 1";
    EXPECT_EQ(scaled_input(3, 0, 1), 2.0) << "a scale of 0 counts as 1";
}

class EncoderCountTest : public ::testing::TestWithParam<int> {
  protected:
    std::uint32_t at(std::int64_t shaft) const {
        const auto value = static_cast<std::uint32_t>(static_cast<std::uint64_t>(shaft));
        return GetParam() == 32 ? value : value & ((1U << GetParam()) - 1U);
    }
};

TEST_P(EncoderCountTest, FollowsAnyPathThroughOverflows) {
    std::mt19937_64 random(SEED);
    const std::int64_t most = (std::int64_t{1} << (GetParam() - 1)) - 1;
    std::uniform_int_distribution<std::int64_t> steps(-most, most), starts(-1000000, 1000000);
    EncoderCount encoder(GetParam());
    std::int64_t shaft = starts(random), zero = shaft, before = shaft;
    const std::int64_t start = shaft;
    EXPECT_EQ(encoder.read({at(shaft)}, {}).count, 0) << "the counter starts anywhere";
    for (int i = 0; i < ROUNDS; ++i) {
        shaft += steps(random);
        const std::int64_t back = std::abs(steps(random));
        EncoderReading reading{at(shaft), random() % 4 == 0, at(shaft - back)};
        const EncoderCount::Request request{random() % 8 == 0, random() % 2 == 0};
        const EncoderCount::Result result = encoder.read(reading, request);
        const bool taken = reading.index_latched && request.isIndexEnabled;
        zero = request.isReset ? shaft : (taken ? shaft - back : zero);
        ASSERT_EQ(result.index_taken, taken) << "seed " << SEED << " round " << i;
        ASSERT_EQ(result.count, shaft - zero) << "seed " << SEED << " round " << i;
        ASSERT_EQ(result.change, shaft - before) << "reset and index are no movement";
        ASSERT_EQ(result.raw, shaft - start);
        before = shaft;
    }
}

INSTANTIATE_TEST_SUITE_P(CounterBits, EncoderCountTest, ::testing::Values(8, 16, 24, 32));

TEST(DeviceValues, ShownCountWraps) {
    EXPECT_EQ(shown_count(2147483648), -2147483647 - 1);
    EXPECT_EQ(shown_count(-2147483649), 2147483647);
}

}  // namespace
}  // namespace mw::sdk
