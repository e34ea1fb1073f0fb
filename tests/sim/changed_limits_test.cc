// SPDX-License-Identifier: GPL-2.0-or-later
// Limits that clients and pins change while a joint or axis is jogged.
#include <algorithm>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class ChangedLimits : public VirtualMachineTest {
  protected:
    void begin_jog(bool isJoint) {
        switch_on();
        ask(task::SetMode{task::Mode::MANUAL});
        ask(task::SetTeleop{!isJoint});
        cycles(20);
        const auto id = ask(task::JogContinuous{isJoint, 0, 20});
        ASSERT_EQ(progress(id), task::Progress::DONE) << reason(id);
        cycles(500);
        ASSERT_GT(x(), 5);
    }
    double x() const { return motion().joint[0].pos_cmd; }
};

TEST_F(ChangedLimits, AJogOfAJointEndsAtTheLimitThatAClientHasSet) {
    begin_jog(true);
    const double limit = x() + 5;
    const auto id = ask(task::SetJointMaxLimit{0, limit});
    ASSERT_EQ(progress(id), task::Progress::DONE) << reason(id);
    cycles(2000);
    EXPECT_NEAR(x(), limit, 1e-6) << messages();
    EXPECT_EQ(motion().joint[0].max_limit, limit);
}

TEST_F(ChangedLimits, AJogOfAnAxisEndsAtTheLimitOfItsPin) {
    begin_jog(false);
    const double limit = x() + 5;
    set_pin("ini.x.max_limit", std::to_string(limit));
    cycles(2000);
    EXPECT_NEAR(x(), limit, 1e-5) << messages();
}

TEST_F(ChangedLimits, AJogThatCannotStopBeforeANewLimitComesBackToIt) {
    begin_jog(true);
    const double limit = x() + 0.05;  // it needs 0.13 to brake
    ASSERT_EQ(progress(ask(task::SetJointMaxLimit{0, limit})), task::Progress::DONE);
    double furthest = x();
    for (int i = 0; i < 2000; ++i) {
        cycles(1);
        furthest = std::max(furthest, x());
    }
    EXPECT_LT(furthest, limit + 0.3);
    EXPECT_NEAR(x(), limit, 1e-6) << messages();
}

TEST_F(ChangedLimits, AJogThatIsOutsideOfANewLimitBrakesAndMayOnlyComeBack) {
    begin_jog(true);
    const double limit = x() - 2;
    const auto id = ask(task::SetJointMaxLimit{0, limit});
    ASSERT_EQ(progress(id), task::Progress::DONE) << reason(id);
    const double here = x();
    cycles(2000);
    EXPECT_LT(x(), here + 1) << "the distance to brake from 20 mm/s";
    EXPECT_EQ(progress(ask(task::JogContinuous{true, 0, 20, 100})), task::Progress::REFUSED);
    const auto back = ask(task::JogIncrement{true, 0, 20, -10});
    EXPECT_EQ(progress(back), task::Progress::DONE) << reason(back);
    cycles(2000);
    EXPECT_LT(x(), limit);
}

}  // namespace
}  // namespace mw::machine
