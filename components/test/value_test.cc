// SPDX-License-Identifier: GPL-2.0-or-later
// Arithmetic, selection, conversion, filters and limits.
#include <cmath>

#include <gtest/gtest.h>

#include "components/conv/conv_core.hh"
#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

TEST(Arithmetic, ComputesWhatItsNameSays) {
    Bench bench(
        "loadrt sum2\nloadrt mult2\nloadrt scale\nloadrt offset\nloadrt constant\nloadrt abs\nloadrt hypot\n"
        "addf sum2.0 t\naddf mult2.0 t\naddf scale.0 t\naddf offset.0.update-output t\n"
        "addf offset.0.update-feedback t\naddf constant.0 t\naddf abs.0 t\naddf hypot.0 t\n"
        "setp sum2.0.in0 2\nsetp sum2.0.in1 3\nsetp sum2.0.gain1 -2\nsetp sum2.0.offset 0.5\n"
        "setp mult2.0.in0 3\nsetp mult2.0.in1 -4\n"
        "setp scale.0.in 2\nsetp scale.0.gain 10\nsetp scale.0.offset -1\n"
        "setp offset.0.offset 5\nsetp offset.0.in 1\nsetp offset.0.fb-in 7\n"
        "setp constant.0.value 42\nsetp abs.0.in -2.5\n"
        "setp hypot.0.in0 1\nsetp hypot.0.in1 2\nsetp hypot.0.in2 2");
    bench.pass();
    EXPECT_DOUBLE_EQ(bench.get("sum2.0.out"), -3.5);
    EXPECT_DOUBLE_EQ(bench.get("mult2.0.out"), -12.0);
    EXPECT_DOUBLE_EQ(bench.get("scale.0.out"), 19.0);
    EXPECT_DOUBLE_EQ(bench.get("offset.0.out"), 6.0);
    EXPECT_DOUBLE_EQ(bench.get("offset.0.fb-out"), 2.0);
    EXPECT_DOUBLE_EQ(bench.get("constant.0.out"), 42.0);
    EXPECT_DOUBLE_EQ(bench.get("abs.0.out"), 2.5);
    EXPECT_EQ(bench.get("abs.0.sign"), 1.0);
    EXPECT_DOUBLE_EQ(bench.get("hypot.0.out"), 3.0);
}

TEST(Ddt, IsTheChangePerSecond) {
    Bench bench("loadrt ddt\naddf ddt.0 t");
    EXPECT_DOUBLE_EQ(bench.after("ddt.0.in", 0.25, "ddt.0.out"), 250.0);
    EXPECT_DOUBLE_EQ(bench.after("ddt.0.in", 0.25, "ddt.0.out"), 0.0);
    EXPECT_DOUBLE_EQ(bench.after("ddt.0.in", 0.0, "ddt.0.out"), -250.0);
}

TEST(Comp, SwitchesWithHysteresis) {
    Bench bench("loadrt comp\naddf comp.0 t\nsetp comp.0.hyst 1");
    EXPECT_EQ(bench.after("comp.0.in1", 0.4, "comp.0.out"), 0.0);
    EXPECT_EQ(bench.get("comp.0.equal"), 1.0);
    EXPECT_EQ(bench.after("comp.0.in1", 0.6, "comp.0.out"), 1.0);
    EXPECT_EQ(bench.after("comp.0.in1", -0.4, "comp.0.out"), 1.0) << "within the band";
    EXPECT_EQ(bench.after("comp.0.in1", -0.6, "comp.0.out"), 0.0);
}

TEST(Near, ByDifferenceOrByFactor) {
    Bench bench("loadrt near\naddf near.0 t\nsetp near.0.in1 100\nsetp near.0.scale 1.1");
    EXPECT_EQ(bench.after("near.0.in2", 109, "near.0.out"), 1.0);
    EXPECT_EQ(bench.after("near.0.in2", 112, "near.0.out"), 0.0);
    EXPECT_EQ(bench.after("near.0.in2", 91, "near.0.out"), 1.0);
    EXPECT_EQ(bench.after("near.0.in2", 90, "near.0.out"), 0.0);
    EXPECT_EQ(bench.after("near.0.difference", 15, "near.0.out"), 1.0);
    bench.set("near.0.in1", -100);
    EXPECT_EQ(bench.after("near.0.in2", -109, "near.0.out"), 1.0) << "factors of negative numbers";
}

TEST(Mux, PicksByBits) {
    Bench bench(
        "loadrt mux2\nloadrt mux4\naddf mux2.0 t\naddf mux4.0 t\nsetp mux2.0.in0 10\nsetp mux2.0.in1 11\n"
        "setp mux4.0.in0 20\nsetp mux4.0.in1 21\nsetp mux4.0.in2 22\nsetp mux4.0.in3 23");
    EXPECT_EQ(bench.after("mux2.0.sel", 0, "mux2.0.out"), 10.0);
    EXPECT_EQ(bench.after("mux2.0.sel", 1, "mux2.0.out"), 11.0);
    for (int i = 0; i < 4; ++i) {
        bench.set("mux4.0.sel0", i & 1);
        EXPECT_EQ(bench.after("mux4.0.sel1", i >> 1, "mux4.0.out"), 20.0 + i);
    }
}

TEST(MuxGeneric, WaitsForAStableSelectionAndConverts) {
    Bench bench(
        "loadrt mux_generic config=ff5,fs2\naddf mux-gen.00 t\naddf mux-gen.01 t\n"
        "setp mux-gen.00.in-float-01 1.5\nsetp mux-gen.00.in-float-04 4.5\nsetp mux-gen.00.debounce-us 2000\n"
        "setp mux-gen.01.in-float-00 1e10");
    bench.pass();
    EXPECT_EQ(bench.get("mux-gen.01.out-s32"), 2147483647.0) << "the nearest value";
    bench.set("mux-gen.00.sel-int", 1);
    bench.pass(2);
    EXPECT_EQ(bench.get("mux-gen.00.out-float"), 0.0) << "not yet stable for 2 ms";
    bench.pass();
    EXPECT_EQ(bench.get("mux-gen.00.out-float"), 1.5);
    bench.set("mux-gen.00.sel-int", 9);
    bench.pass(4);
    EXPECT_EQ(bench.get("mux-gen.00.out-float"), 4.5) << "above the last is the last";
    bench.set("mux-gen.00.suppress-no-input", 1);
    bench.set("mux-gen.00.sel-int", 0);
    bench.pass(4);
    EXPECT_EQ(bench.get("mux-gen.00.out-float"), 4.5);
}

TEST(MuxGeneric, RefusesAnUnreadableConfig) {
    Bench bench("");
    bench.run("loadrt mux_generic config=fx3");
    EXPECT_NE(bench.output.errors.find("'fx3'"), std::string::npos) << bench.output.errors;
}

TEST(Conv, ClampsOrWrapsWhatDoesNotFit) {
    Bench bench("loadrt conv_float_s32\nloadrt conv_s32_u32\nloadrt conv_u64_s64\naddf conv-float-s32.0 t\n"
                "addf conv-s32-u32.0 t\naddf conv-u64-s64.0 t");
    EXPECT_EQ(bench.after("conv-float-s32.0.in", -7.9, "conv-float-s32.0.out"), -7.0);
    EXPECT_EQ(bench.get("conv-float-s32.0.out-of-range"), 0.0);
    EXPECT_EQ(bench.after("conv-float-s32.0.in", 2147483648.0, "conv-float-s32.0.out"), -2147483648.0);
    EXPECT_EQ(bench.get("conv-float-s32.0.out-of-range"), 1.0);
    EXPECT_EQ(bench.after("conv-float-s32.0.clamp", 1, "conv-float-s32.0.out"), 2147483647.0);
    EXPECT_EQ(bench.after("conv-s32-u32.0.in", -1, "conv-s32-u32.0.out"), 4294967295.0);
    EXPECT_EQ(bench.after("conv-s32-u32.0.clamp", 1, "conv-s32-u32.0.out"), 0.0);
    EXPECT_EQ(bench.after("conv-u64-s64.0.in", 5, "conv-u64-s64.0.out"), 5.0);
}

TEST(ConvCore, KnowsTheEdgesOfEveryType) {
    using conv::convert;
    EXPECT_EQ(convert<std::int64_t>(9.3e18, true).value, INT64_MAX);
    EXPECT_TRUE(convert<std::int64_t>(9.3e18, true).out_of_range);
    EXPECT_EQ(convert<std::uint64_t>(-1.5, true).value, 0U);
    EXPECT_FALSE(convert<std::uint64_t>(-0.5, true).out_of_range) << "cut to zero first";
    EXPECT_EQ(convert<std::int32_t>(std::nan(""), true).value, 0);
    EXPECT_TRUE(convert<std::int32_t>(std::nan(""), true).out_of_range);
    EXPECT_EQ(convert<std::int32_t>(std::int64_t{-3000000000}, true).value, INT32_MIN);
    EXPECT_EQ(convert<std::uint32_t>(std::int64_t{-1}, false).value, UINT32_MAX);
    EXPECT_FALSE(convert<std::int64_t>(std::int32_t{-5}, true).out_of_range);
    EXPECT_TRUE(convert<bool>(std::uint32_t{2}, true).value);
    EXPECT_TRUE(convert<bool>(std::uint32_t{2}, true).out_of_range);
    EXPECT_FALSE(convert<bool>(1e-11, true).value);
}

TEST(Lowpass, GoesThePartGainOfTheWay) {
    Bench bench("loadrt lowpass\naddf lowpass.0 t\nsetp lowpass.0.gain 0.25\nsetp lowpass.0.in 16");
    bench.pass();
    EXPECT_DOUBLE_EQ(bench.get("lowpass.0.out"), 4.0);
    bench.pass();
    EXPECT_DOUBLE_EQ(bench.get("lowpass.0.out"), 7.0);
    EXPECT_DOUBLE_EQ(bench.after("lowpass.0.load", 1, "lowpass.0.out"), 16.0);
}

TEST(Ilowpass, ReachesTheScaledInput) {
    Bench bench("loadrt ilowpass\naddf ilowpass.0 t\nsetp ilowpass.0.in -3");
    bench.pass();
    EXPECT_EQ(bench.get("ilowpass.0.out"), -1536.0);
    bench.pass(100);
    EXPECT_EQ(bench.get("ilowpass.0.out"), -3072.0);
}

TEST(Ilowpass, RunsOverTheEndOf32BitsAsCountersDo) {
    Bench bench("loadrt ilowpass\naddf ilowpass.0 t\nsetp ilowpass.0.in 3000000");
    bench.pass(200);
    // 3,000,000 * 1024 = 3,072,000,000, which is 1,222,967,296 below 2^32.
    EXPECT_EQ(bench.get("ilowpass.0.out"), -1222967296.0);
    bench.set("ilowpass.0.in", 3000001);
    bench.pass(200);
    EXPECT_EQ(bench.get("ilowpass.0.out"), -1222967296.0 + 1024.0) << "a detent stays a detent";
}

TEST(Ilowpass, TakesAnInputThatRunsOverItsEndAsOneStep) {
    Bench bench("loadrt ilowpass\naddf ilowpass.0 t\nsetp ilowpass.0.scale 1\nsetp ilowpass.0.in 2147483647");
    bench.pass(200);
    EXPECT_EQ(bench.get("ilowpass.0.out"), 2147483647.0);
    EXPECT_EQ(bench.after("ilowpass.0.in", -2147483647, "ilowpass.0.out"), -2147483648.0)
        << "half of two counts further";
}

TEST(Limit1And2, HoldValueAndRate) {
    Bench bench("loadrt limit1\nloadrt limit2\naddf limit1.0 t\naddf limit2.0 t\nsetp limit1.0.max 5\n"
                "setp limit2.0.maxv 100\nsetp limit2.0.min -1");
    EXPECT_DOUBLE_EQ(bench.after("limit1.0.in", 7, "limit1.0.out"), 5.0);
    EXPECT_DOUBLE_EQ(bench.after("limit2.0.in", 7, "limit2.0.out"), 0.1) << "100 a second in 1 ms";
    EXPECT_DOUBLE_EQ(bench.after("limit2.0.load", 1, "limit2.0.out"), 7.0);
    EXPECT_DOUBLE_EQ(bench.after("limit2.0.in", -7, "limit2.0.out"), -1.0);
}

TEST(Limit3, ReachesAJumpWithinVelocityAndAccelerationWithoutOvershoot) {
    constexpr double MAX_V = 20.0;
    constexpr double MAX_A = 300.0;
    Bench bench("loadrt limit3\naddf limit3.0 t\nsetp limit3.0.maxv 20\nsetp limit3.0.maxa 300\n"
                "setp limit3.0.in 3.21");
    double last = 0.0;
    double last_v = 0.0;
    for (int i = 0; i < 1000; ++i) {
        bench.pass();
        const double now = bench.get("limit3.0.out");
        const double v = (now - last) / 1e-3;
        // Differences of doubles near 3 over 1 ms and again: about 1e-12 and 1e-9.
        ASSERT_LE(std::fabs(v), MAX_V + 1e-9);
        ASSERT_LE(std::fabs(v - last_v) / 1e-3, MAX_A + 1e-6);
        ASSERT_LE(now, 3.21 + 1e-12);
        last = now;
        last_v = v;
    }
    EXPECT_NEAR(last, 3.21, 1e-12);
    EXPECT_NEAR(last_v, 0.0, 1e-9);
}

TEST(Limit3, FollowsAMovingInputWithoutLag) {
    Bench bench("loadrt limit3\naddf limit3.0 t\nsetp limit3.0.maxv 20\nsetp limit3.0.maxa 300");
    double input = 0.0;
    for (int i = 0; i < 500; ++i) {
        input = 0.005 * i;
        bench.after("limit3.0.in", input, "limit3.0.out");
    }
    EXPECT_NEAR(bench.get("limit3.0.out"), input, 1e-9);
    bench.set("limit3.0.enable", 0);
    bench.pass(1000);
    EXPECT_NEAR(bench.get("limit3.0.out"), 0.0, 1e-9) << "back to zero when disabled";
}

}  // namespace
}  // namespace mw::components::test
