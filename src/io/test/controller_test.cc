// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "io/controller.hh"

namespace mw::io {
namespace {

TEST(IoController, ChangesAToolByHandshake_E1_E2) {
    Controller io;
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
    EXPECT_EQ(io.waiting_for(), msgs::WaitFor::TOOL_CHANGED);
    in.tool_changed = true;
    EXPECT_EQ(io.step(in), ToolEvent::CHANGED);
    EXPECT_FALSE(io.outputs.tool_change);
    EXPECT_EQ(io.waiting_for(), msgs::WaitFor::NOTHING);
}

TEST(IoController, AnAnswerLeftFromTheLastChangeDoesNotCount) {
    Controller io;
    Inputs in;
    in.tool_changed = true;
    io.start_change();
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    EXPECT_FALSE(io.outputs.tool_change);
    in.tool_changed = false;
    EXPECT_EQ(io.step(in), ToolEvent::NONE);
    EXPECT_TRUE(io.outputs.tool_change);
}

TEST(IoController, AFaultEndsTheHandshake_E1) {
    Controller io;
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

TEST(IoController, LeavingEstopAsksTheChainOnce_D1) {
    Controller io;
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
