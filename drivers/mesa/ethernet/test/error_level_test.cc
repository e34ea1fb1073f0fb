// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "drivers/mesa/ethernet/error_level.hh"

namespace mw::mesa {
namespace {

TEST(ErrorLevel, FiveFailuresInSuccessionAreAFault) {
    ErrorLevel errors;
    const EthernetSettings settings;
    for (int i = 0; i < 4; ++i) {
        EXPECT_FALSE(errors.count(true, settings));
    }
    EXPECT_EQ(errors.level(), 8);
    EXPECT_TRUE(errors.count(true, settings));
    EXPECT_TRUE(errors.isExceeded());
    EXPECT_EQ(errors.total(), 5U);
    EXPECT_FALSE(errors.count(true, settings)) << "the limit is reached once";
}

TEST(ErrorLevel, GoodCyclesLowerTheLevelAndTheFaultStays) {
    ErrorLevel errors;
    const EthernetSettings settings;
    errors.count(true, settings);
    errors.count(false, settings);
    EXPECT_EQ(errors.level(), 1);
    errors.count(false, settings);
    errors.count(false, settings);
    EXPECT_EQ(errors.level(), 0);
    for (int i = 0; i < 5; ++i) {
        errors.count(true, settings);
    }
    for (int i = 0; i < 20; ++i) {
        errors.count(false, settings);
    }
    EXPECT_TRUE(errors.isExceeded());
    errors.reset();
    EXPECT_FALSE(errors.isExceeded());
    EXPECT_EQ(errors.total(), 6U);
}

TEST(ReadTimeout, IsPercentOfThePeriodOrNanoseconds) {
    EXPECT_EQ(read_timeout_ns(80, 1'000'000), 800'000);
    EXPECT_EQ(read_timeout_ns(0, 1'000'000), 800'000);
    EXPECT_EQ(read_timeout_ns(-5, 1'000'000), 800'000);
    EXPECT_EQ(read_timeout_ns(50, 1'000'000), 500'000);
    EXPECT_EQ(read_timeout_ns(1, 1'000'000), 100'000) << "never less than 100 us by percent";
    EXPECT_EQ(read_timeout_ns(250'000, 1'000'000), 250'000);
}

}  // namespace
}  // namespace mw::mesa
