// SPDX-License-Identifier: GPL-2.0-or-later
// Tests operators' commands that motion executes by itself; they end with its answer.
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

TEST_F(TaskTest, AJogEndsWithWhatMotionAnswers) {
    ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    EXPECT_EQ(ask(JogContinuous{true, 1, -5}), Progress::DONE);
    EXPECT_EQ(motion.last_jog.lease_s, 0) << "none is the default";
    EXPECT_EQ(ask(JogContinuous{true, 1, -5, 250}), Progress::DONE);
    EXPECT_EQ(motion.last_jog.lease_s, 0.25);
    EXPECT_FALSE(motion.last_jog.isRenewal);
    motion.jog_refusal = motion::Reason::ON_HARD_LIMIT;
    messages();
    EXPECT_EQ(ask(JogContinuous{true, 1, -5, 250}), Progress::REFUSED);
    EXPECT_NE(reason(request).find("limit switch"), std::string::npos) << reason(request);
    EXPECT_NE(messages().find("limit switch"), std::string::npos);
}

template <class Order>
const Order &last_order(const test::FakeMotion &motion) {
    static const Order none{};
    const auto *order = std::get_if<Order>(&motion.last);
    EXPECT_NE(order, nullptr);
    return order != nullptr ? *order : none;
}

TEST_F(TaskTest, WhatMotionCarriesOutByItselfReachesIt) {
    EXPECT_EQ(ask(DisableJoint{2}), Progress::DONE);
    EXPECT_EQ(last_order<motion::SetAmplifier>(motion).joint, 2);
    EXPECT_FALSE(last_order<motion::SetAmplifier>(motion).isOn);
    EXPECT_EQ(ask(EnableJoint{2}), Progress::DONE);
    EXPECT_TRUE(last_order<motion::SetAmplifier>(motion).isOn);
    EXPECT_EQ(ask(DeactivateJoint{1}), Progress::DONE);
    EXPECT_EQ(last_order<motion::SetJointActive>(motion).joint, 1);
    EXPECT_FALSE(last_order<motion::SetJointActive>(motion).isActive);
    EXPECT_EQ(ask(ActivateJoint{1}), Progress::DONE);
    EXPECT_TRUE(last_order<motion::SetJointActive>(motion).isActive);
    EXPECT_EQ(ask(ClearProbe{}), Progress::DONE);
    last_order<motion::ClearProbeFlag>(motion);
    EXPECT_EQ(ask(EnableFeedHold{false}), Progress::DONE);
    EXPECT_EQ(last_order<motion::SetSwitch>(motion).what, motion::Switch::FEED_HOLD);
    EXPECT_FALSE(last_order<motion::SetSwitch>(motion).isEnabled);
    EXPECT_EQ(ask(SetSpindleOverride{0.7, 0}), Progress::DONE);
    EXPECT_EQ(last_order<motion::SetScale>(motion).what, motion::Scale::SPINDLE);
    EXPECT_EQ(last_order<motion::SetScale>(motion).factor, 0.7);
}

TEST_F(TaskTest, AProgramGoesBackAndForwardByCommandWhileItRuns) {
    EXPECT_EQ(ask(ReverseProgram{}), Progress::REFUSED);
    EXPECT_EQ(reason(request), "no program is running");
    open("G21 F600\nG1 X7\nM2\n");
    motion.isHolding = true;
    const auto run = post(RunProgram{});
    cycles(10);
    EXPECT_EQ(ask(ReverseProgram{}), Progress::DONE) << reason(request);
    EXPECT_TRUE(last_order<motion::SetReverse>(motion).isReverse);
    EXPECT_EQ(ask(ForwardProgram{}), Progress::DONE) << reason(request);
    EXPECT_FALSE(last_order<motion::SetReverse>(motion).isReverse);
    motion.isHolding = false;
    cycles(20);
    EXPECT_EQ(progress(run), Progress::DONE);
}

TEST_F(TaskTest, ARefusedRenewalIsToldToItsClientAlone) {
    ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    motion.jog_refusal = motion::Reason::NO_JOG_TO_RENEW;
    messages();
    EXPECT_EQ(ask(JogContinuous{true, 0, 5, 100, true}), Progress::REFUSED);
    EXPECT_TRUE(motion.last_jog.isRenewal);
    EXPECT_NE(reason(request).find("renew"), std::string::npos) << reason(request);
    ASSERT_EQ(ask(SetState{State::ESTOP}), Progress::DONE);
    cycles(5);
    messages();
    motion.log.clear();
    EXPECT_EQ(ask(JogContinuous{true, 0, 5, 100, true}), Progress::REFUSED);
    EXPECT_NE(reason(request), "");
    EXPECT_EQ(messages(), "");
    EXPECT_EQ(ask(JogContinuous{true, 0, 5, 100}), Progress::REFUSED);
    EXPECT_NE(messages(), "") << "the start of a jog is reported to all";
    EXPECT_EQ(joined(), "");
}

TEST_F(TaskTest, AJogWhoseLeaseHasEndedFailsNoProgram) {
    open("G21 F600\nG1 X7\nM2\n");
    motion.isHolding = true;
    const auto run = post(RunProgram{});
    cycles(10);
    motion::Fault fault;
    fault.kind = motion::FaultKind::JOG_LEASE_ENDED;
    fault.index = 0;
    fault.value = 0.25;
    channels->servo_faults.push(fault);
    cycles(2);
    EXPECT_NE(messages().find("was not renewed within 250 ms"), std::string::npos);
    EXPECT_EQ(progress(run), Progress::STARTED);
    motion.isHolding = false;
    cycles(20);
    EXPECT_EQ(progress(run), Progress::DONE);
}

TEST_F(TaskTest, ALeaseIsNoShorterThanAClientCanRenewIt) {
    ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    motion.log.clear();
    EXPECT_EQ(ask(JogContinuous{true, 0, 5, 19}), Progress::REFUSED);
    EXPECT_NE(reason(request).find("from 20 to 10000 ms"), std::string::npos) << reason(request);
    EXPECT_FALSE(client.post(JogContinuous{true, 0, 5, 10001}).has_value());
    EXPECT_FALSE(client.post(JogContinuous{true, 0, 5, -1}).has_value());
    EXPECT_EQ(joined(), "");
    EXPECT_EQ(ask(JogContinuous{true, 0, 5, 20}), Progress::DONE);
    EXPECT_EQ(ask(JogContinuous{true, 0, 5, 10000}), Progress::DONE);
}

}  // namespace
}  // namespace mw::task
