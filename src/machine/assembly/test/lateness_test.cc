// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "machine/assembly/lateness.hh"

namespace mw::machine {
namespace {

constexpr std::int64_t S = 1000000000;

std::string why(std::int64_t gap_ns, std::int64_t ran_ns, std::int64_t waited_ns) {
    return why_late({S, 5 * S, 7 * S}, {S + gap_ns, 5 * S + ran_ns, 7 * S + waited_ns}).value_or("");
}

TEST(Lateness, NamesTheCause) {
    EXPECT_EQ(why(S / 10, 0, S / 10), "");
    EXPECT_NE(why(S, S / 10, S * 8 / 10).find("did not run for 1.00 s: other programs"), std::string::npos);
    EXPECT_NE(why(S, S * 9 / 10, 0).find("it was calculating"), std::string::npos);
    EXPECT_NE(why(S, 0, 0).find("it was stopped"), std::string::npos);
}

TEST(Lateness, TheFirstCycleIsNeverLate) {
    Lateness lateness;
    EXPECT_FALSE(lateness.step(5 * S).has_value());
    EXPECT_TRUE(lateness.step(6 * S).has_value());
    EXPECT_FALSE(lateness.step(6 * S + 1).has_value());
}

}  // namespace
}  // namespace mw::machine
