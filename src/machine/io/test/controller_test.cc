// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "machine/io/discrete_io.hh"

namespace mw::io {
namespace {

TEST(IoController, ChangesAToolByHandshake) {
    DiscreteIo io;
    Inputs in;
    io.start_prepare(3, 5, 2);
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    EXPECT_TRUE(io.outputs.tool_prepare);
    EXPECT_EQ(io.outputs.tool_prep_number, 3);
    EXPECT_EQ(io.outputs.tool_prep_pocket, 5);
    in.tool_prepared = true;
    EXPECT_EQ(io.step(in), ToolEvent::PREPARED);
    EXPECT_FALSE(io.outputs.tool_prepare);

    in.tool_prepared = false;
    io.start_change();
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    EXPECT_TRUE(io.outputs.tool_change);
    EXPECT_EQ(io.waiting_for(), messages::WaitFor::TOOL_CHANGED);
    in.tool_changed = true;
    EXPECT_EQ(io.step(in), ToolEvent::CHANGED);
    EXPECT_FALSE(io.outputs.tool_change);
    EXPECT_EQ(io.waiting_for(), messages::WaitFor::NOTHING);
}

TEST(IoController, AnAnswerLeftFromTheLastChangeDoesNotCount) {
    DiscreteIo io;
    Inputs in;
    in.tool_changed = true;
    io.start_change();
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    EXPECT_FALSE(io.outputs.tool_change);
    in.tool_changed = false;
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    EXPECT_TRUE(io.outputs.tool_change);
}

TEST(IoController, AFaultEndsTheHandshake) {
    DiscreteIo io;
    Inputs in;
    io.start_change();
    io.step(in);
    in.toolchanger_fault = true;
    in.toolchanger_reason = 7;
    EXPECT_EQ(io.step(in), ToolEvent::FAULT);
    EXPECT_EQ(io.fault_reason(), 7);
    EXPECT_FALSE(io.outputs.tool_change);
    in.toolchanger_fault = false;
    io.step(in);
    EXPECT_TRUE(io.outputs.emc_abort);
    io.step(in);
    EXPECT_FALSE(io.outputs.emc_abort);
}

TEST(IoController, LubricationFollowsTheEmergencyStop) {
    DiscreteIo io;
    Inputs in;
    io.leave_estop();
    io.step(in);
    EXPECT_FALSE(io.outputs.lube) << "the chain is open";
    in.emc_enable_in = true;
    io.step(in);
    EXPECT_TRUE(io.outputs.lube);
    io.set_lube(false);
    io.step(in);
    EXPECT_FALSE(io.outputs.lube) << "nothing switches it on again by itself";
    io.set_lube(true);
    io.enter_estop();
    io.step(in);
    EXPECT_FALSE(io.outputs.lube);
    in.lube_level = false;
    io.step(in);
    EXPECT_FALSE(io.hasOil());
}

TEST(IoController, AnAbortIsHeldUntilTheChangerHasTakenIt) {
    DiscreteIo io({true, false});
    Inputs in;
    io.start_change();
    io.step(in);
    ASSERT_TRUE(io.outputs.tool_change);
    io.abort(8);
    EXPECT_FALSE(io.outputs.tool_change) << "at once";
    for (int i = 0; i < 5; ++i) {
        io.step(in);
        EXPECT_TRUE(io.outputs.emc_abort);
        EXPECT_EQ(io.outputs.emc_reason, 8);
        EXPECT_EQ(io.waiting_for(), messages::WaitFor::TOOL_ABORT_TAKEN);
    }
    in.emc_abort_ack = true;
    io.step(in);
    EXPECT_FALSE(io.outputs.emc_abort);
    EXPECT_EQ(io.action(), ToolAction::IDLE);
}

TEST(IoController, StartChangeComesBeforeToolChange) {
    DiscreteIo io({true, true});
    Inputs in;
    io.start_change();
    io.step(in);
    EXPECT_TRUE(io.outputs.start_change);
    EXPECT_FALSE(io.outputs.tool_change);
    EXPECT_EQ(io.waiting_for(), messages::WaitFor::TOOL_START_CHANGE);
    in.start_change_ack = true;
    io.step(in);
    io.step(in);
    EXPECT_FALSE(io.outputs.start_change);
    EXPECT_TRUE(io.outputs.tool_change);
}

TEST(IoController, AFaultIsAcknowledgedAndStaysUntilItIsCleared) {
    DiscreteIo io({true, false});
    Inputs in;
    in.toolchanger_fault = true;
    in.toolchanger_reason = -3;
    io.step(in);
    EXPECT_TRUE(io.outputs.toolchanger_fault_ack);
    in.toolchanger_fault = false;
    io.step(in);
    EXPECT_FALSE(io.outputs.toolchanger_fault_ack);
    EXPECT_TRUE(io.outputs.toolchanger_faulted) << "the next change must not begin";
    io.start_change();
    EXPECT_EQ(io.step(in), ToolEvent::FAULT);
    EXPECT_FALSE(io.outputs.tool_change);
    EXPECT_EQ(io.fault_reason(), -3);
    in.emc_abort_ack = true;
    in.toolchanger_clear_fault = true;
    io.step(in);
    io.step(in);
    EXPECT_FALSE(io.outputs.toolchanger_faulted);
    io.start_change();
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    EXPECT_TRUE(io.outputs.tool_change);
}

TEST(IoController, AReasonAboveZeroLetsTheProgramGoOnInVersionTwoOnly) {
    for (const bool is_version2 : {false, true}) {
        DiscreteIo io({is_version2, false});
        Inputs in;
        io.start_change();
        io.step(in);
        in.toolchanger_fault = true;
        in.toolchanger_reason = 4;
        EXPECT_EQ(io.step(in), is_version2 ? ToolEvent::FAULT_TOLD : ToolEvent::FAULT);
        EXPECT_EQ(io.outputs.emc_reason, REASON_CHANGER_FAULT);
    }
}

TEST(IoController, AnAnswerAfterTheAbortIsTold) {
    DiscreteIo io;
    Inputs in;
    io.start_change();
    io.step(in);
    io.abort(8);
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    in.tool_changed = true;
    EXPECT_EQ(io.step(in), ToolEvent::CHANGED_LATE);
    EXPECT_EQ(io.step(in), ToolEvent::NONE) << "once";
}

TEST(IoController, ANewToolOffsetIsAwaitedUntilItsPinsShowIt) {
    DiscreteIo io;
    Inputs in;
    io.step(in);
    EXPECT_TRUE(io.isToolOffsetShown());
    const geometry::Pose offset{{0, 0, 5}};
    io.set_tool_offset(offset);
    EXPECT_EQ(io.outputs.tool_offset.c, offset.c);
    EXPECT_FALSE(io.isToolOffsetShown());
    in.tool_offset_shown = false;
    io.step(in);
    EXPECT_FALSE(io.isToolOffsetShown());
    in.tool_offset_shown = true;
    io.step(in);
    EXPECT_TRUE(io.isToolOffsetShown());
    io.set_tool_offset(offset);
    EXPECT_TRUE(io.isToolOffsetShown()) << "nothing new";
    io.set_tool_offset({{0, 0, std::nan("")}});
    EXPECT_EQ(io.outputs.tool_offset.c, offset.c) << "no number";
}

TEST(IoController, LeavingEstopAsksTheChainOnce) {
    DiscreteIo io;
    Inputs in;
    io.leave_estop();
    io.step(in);
    EXPECT_TRUE(io.outputs.user_enable_out);
    EXPECT_TRUE(io.outputs.user_request_enable);
    EXPECT_FALSE(io.isChainClosed());
    in.emc_enable_in = true;
    io.step(in);
    EXPECT_FALSE(io.outputs.user_request_enable);
    EXPECT_TRUE(io.isChainClosed());
    io.enter_estop();
    EXPECT_FALSE(io.outputs.user_enable_out);
}

}  // namespace
}  // namespace mw::io
