// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "components/test/bench.hh"
#include "testing/allocation_guard.hh"

namespace mw::components::test {
namespace {

TEST(EveryComponent, RunsWithoutTheHeap_B3) {
    std::string commands;
    for (const char *plain : {"and2",
                              "or2",
                              "xor2",
                              "not",
                              "flipflop",
                              "select8",
                              "estop_latch",
                              "charge_pump",
                              "sum2",
                              "mult2",
                              "scale",
                              "offset",
                              "constant",
                              "abs",
                              "hypot",
                              "ddt",
                              "comp",
                              "near",
                              "mux2",
                              "mux4",
                              "limit1",
                              "limit2",
                              "limit3",
                              "lowpass",
                              "ilowpass",
                              "edge",
                              "oneshot",
                              "timedelay",
                              "encoder",
                              "counter",
                              "encoder_ratio",
                              "pid",
                              "siggen",
                              "sim_encoder",
                              "sim_home_switch",
                              "sim_spindle",
                              "conv_float_s32",
                              "conv_s64_u64",
                              "conv_u32_bit"}) {
        commands += "loadrt " + std::string(plain) + "\n";
    }
    commands +=
        "loadrt logic personality=0x1f02\nloadrt stepgen step_type=0,2,1 ctrl_type=p,v,p\n"
        "loadrt mux_generic config=fs4,ub2\nloadrt sampler cfg=bfsu depth=5\nloadrt streamer cfg=bfsu "
        "depth=5\n"
        "setp stepgen.0.enable 1\nsetp stepgen.0.position-cmd 100\nsetp pid.0.enable 1\nsetp pid.1.enable 1\n"
        "setp pid.1.tune-mode 1\nsetp pid.1.tune-start 1\n";
    Bench bench(commands);
    for (const hal::FunctInfo &function : bench.hal().functs()) {
        ASSERT_TRUE(bench.hal().add_function(function.name, "t").has_value()) << function.name;
    }
    bench.pass();
    {
        const testing::AllocationGuard guard;
        bench.pass(100);
        EXPECT_EQ(guard.calls(), 0U);
    }
    EXPECT_EQ(bench.get("t.threadbeat"), 101.0);
    EXPECT_GT(bench.get("sampler.0.overruns"), 0.0) << "a full queue is no reason to stop";
}

}  // namespace
}  // namespace mw::components::test
