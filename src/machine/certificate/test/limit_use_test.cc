// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "machine/certificate/limit_use.hh"

namespace mw::machine {
namespace {

LimitUse::Sample use_sample(double x, double y, double joint, int line) {
    LimitUse::Sample s;
    s.axes[0] = x;
    s.axes[1] = y;
    s.joints[2] = joint;
    s.time_ns = line * 1000000;
    s.source.line = line;
    return s;
}

class LimitUseTest : public ::testing::Test {
  protected:
    void measure(const LimitUse::Sample &s) {
        use_.remember(s);
        use_.measure(s);
    }
    static constexpr double NONE = std::numeric_limits<double>::infinity();
    static constexpr double PERIOD_S = 0.001;
    LimitUse use_{{{LimitedCoordinate::Type::AXIS, 0, false, {10, 1000, NONE}},
                   {LimitedCoordinate::Type::JOINT, 2, false, {5, 2000, 1e6}},
                   {LimitedCoordinate::Type::XYZ_NORM, 0, false, {4, NONE, NONE}}},
                  PERIOD_S};
};

TEST_F(LimitUseTest, RatiosAreDifferencesOverLimits) {
    measure(use_sample(0, 0, 0, 1));
    measure(use_sample(0, 0, 0, 2));
    measure(use_sample(0.003, 0.004, 0.001, 3));  // from standstill to 3 and 4 units/s, and to 1
    measure(use_sample(0.006, 0.008, 0.002, 4));
    const auto &uses = use_.uses();
    EXPECT_NEAR(uses[0].ratio(0), 0.3, 1e-9);
    EXPECT_NEAR(uses[0].ratio(1), 3, 1e-9);
    EXPECT_EQ(uses[0].ratio(2), 0);
    EXPECT_FALSE(uses[0].hasLimit(2));
    EXPECT_EQ(uses[0].largest[1].source.line, 3);
    EXPECT_NEAR(uses[1].ratio(0), 0.2, 1e-9);
    EXPECT_NEAR(uses[1].ratio(1), 0.5, 1e-9);
    EXPECT_NEAR(uses[1].largest[2].value, 1e6, 1e-3);
    EXPECT_EQ(uses[1].largest[2].source.line, 4);  // +1000 and then -1000 units/s^2
    EXPECT_NEAR(uses[2].ratio(0), 1.25, 1e-9);
    EXPECT_NEAR(uses[2].largest[1].value, 5000, 1e-5);
}

TEST_F(LimitUseTest, RememberedSamplesAreNotMeasured) {
    use_.remember(use_sample(0, 0, 0, 1));
    use_.remember(use_sample(1, 0, 0, 2));
    use_.remember(use_sample(1, 0, 0, 3));
    use_.remember(use_sample(1, 0, 0, 4));
    measure(use_sample(1, 0, 0, 5));
    EXPECT_EQ(use_.uses()[0].largest[0].value, 0);
}

TEST_F(LimitUseTest, NothingIsMeasuredAcrossARestart) {
    measure(use_sample(0, 0, 0, 1));
    measure(use_sample(0, 0, 0, 2));
    use_.restart();
    measure(use_sample(50, 0, 7, 3));
    measure(use_sample(50.001, 0, 7, 4));
    EXPECT_NEAR(use_.uses()[0].largest[0].value, 1, 1e-9);
    EXPECT_EQ(use_.uses()[0].largest[1].value, 0);
}

}  // namespace
}  // namespace mw::machine
