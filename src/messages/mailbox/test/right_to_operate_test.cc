// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/right_to_operate.hh"

namespace mw::mailbox {
namespace {

constexpr std::int64_t S = 1000000000;

TEST(RightToOperate, IsOpenToAllUntilOneAsksForItAlone) {
    RightToOperate right;
    EXPECT_TRUE(right.check(1, messages::RunProgram{}).has_value());
    EXPECT_TRUE(right.check(2, messages::RunProgram{}).has_value());
    EXPECT_EQ(right.status(0).holder, 0U);
    ASSERT_TRUE(right.claim(1, 5, 0).has_value());
    EXPECT_TRUE(right.check(1, messages::RunProgram{}).has_value());
    EXPECT_EQ(right.check(2, messages::RunProgram{}).error().message, "client 1 operates the machine alone");
    EXPECT_FALSE(right.claim(2, 5, S).has_value());
    EXPECT_EQ(right.status(2 * S).holder, 1U);
    EXPECT_DOUBLE_EQ(right.status(2 * S).lease_left_s, 3.0);
    EXPECT_FALSE(right.release(2).has_value());
    EXPECT_TRUE(right.release(1).has_value());
    EXPECT_TRUE(right.check(2, messages::RunProgram{}).has_value());
    EXPECT_EQ(right.status(0).handovers, 2U);
}

TEST(RightToOperate, RunsOutWhenItIsNotRenewed) {
    RightToOperate right;
    ASSERT_TRUE(right.claim(1, 2, 0).has_value());
    EXPECT_FALSE(right.step(2 * S - 1));
    ASSERT_TRUE(right.claim(1, 2, 2 * S - 1).has_value());
    EXPECT_FALSE(right.step(3 * S));
    EXPECT_TRUE(right.step(4 * S - 1));
    EXPECT_FALSE(right.step(4 * S)) << "told once";
    EXPECT_TRUE(right.check(2, messages::RunProgram{}).has_value());
}

TEST(RightToOperate, IsHandedOverByItsHolderOnly) {
    RightToOperate right;
    EXPECT_FALSE(right.hand_over(1, 2, 0).has_value());
    ASSERT_TRUE(right.claim(1, 2, 0).has_value());
    EXPECT_FALSE(right.hand_over(3, 2, 0).has_value());
    ASSERT_TRUE(right.hand_over(1, 2, S).has_value());
    EXPECT_FALSE(right.check(1, messages::RunProgram{}).has_value());
    EXPECT_TRUE(right.check(2, messages::RunProgram{}).has_value());
    EXPECT_DOUBLE_EQ(right.status(S).lease_left_s, 2.0);
    right.forget(1);
    EXPECT_EQ(right.status(S).holder, 2U);
    right.forget(2);
    EXPECT_EQ(right.status(S).holder, 0U);
}

TEST(RightToOperate, StopsAndHoldsAreAlwaysAllowedAndNothingElseIs) {
    RightToOperate right;
    ASSERT_TRUE(right.claim(1, 5, 0).has_value());
    for (const messages::Command &stop : std::initializer_list<messages::Command>{
             messages::SetState{messages::State::ESTOP}, messages::SetState{messages::State::OFF},
             messages::AbortAll{}, messages::JogStop{}, messages::PauseProgram{}}) {
        EXPECT_TRUE(right.check(2, stop).has_value()) << messages::to_text(stop);
    }
    EXPECT_FALSE(right.check(2, messages::SetState{messages::State::ON}).has_value());
    EXPECT_FALSE(right.check(2, messages::SetState{messages::State::ESTOP_RESET}).has_value());
    int allowed = 0;
    for (const messages::Declaration *declaration : messages::command_declarations()) {
        allowed += right.check(2, *messages::make_command(declaration->number)).has_value() ? 1 : 0;
    }
    EXPECT_EQ(allowed, 4) << "SetState{ESTOP} and the three above that always stop";
}

}  // namespace
}  // namespace mw::mailbox
