// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/test/table.hh"

namespace mw::components::test {
namespace {

const std::vector<Table> VALUES = {
    {"Abs", "abs", "abs.0", {"abs.0"}, "", {{"in=-2.5", "out=2.5 sign=1 is-negative=1 is-positive=0"}}},
    {"AbsS32",
     "abs_s32",
     "abs-s32.0",
     {"abs-s32.0"},
     "",
     {{"in=-3", "out=3 sign=1 is-negative=1 is-positive=0"},
      {"in=0", "out=0 sign=0 is-negative=0 is-positive=0"},
      {"in=-2147483648", "out=2147483647 sign=1"}}},
    {"AbsS64",
     "abs_s64",
     "abs-s64.0",
     {"abs-s64.0"},
     "",
     {{"in=-5000000000", "out=5000000000 is-negative=1"}}},
    {"Div2",
     "div2",
     "div2.0",
     {"div2.0"},
     "deadband=0.5",
     {{"in0=1 in1=2", "out=0.5"}, {"in1=0.3", "out=2"}, {"in1=-0.3", "out=-2"}, {"in1=0", "out=2"}}},
    {"Div2ByZero", "div2", "div2.0", {"div2.0"}, "", {{"in0=-1 in1=0", "out=-1e12"}, {"in0=0", "out=0"}}},
    {"Invert",
     "invert",
     "invert.0",
     {"invert.0"},
     "",
     {{"in=4", "out=0.25"}, {"in=0", "out=1e12"}, {"deadband=0.5 in=-0.1", "out=-2"}}},
    {"Integ",
     "integ",
     "integ.0",
     {"integ.0"},
     "max=0.0035 min=-0.001 gain=2",
     {{"in=1", "out=0.002"},
      {"", "out=0.0035"},
      {"in=-3", "out=-0.001"},
      {"reset=1", "out=0"},
      {"reset=0 in=nan", "out=0"}}},
    {"Minmax",
     "minmax",
     "minmax.0",
     {"minmax.0"},
     "",
     {{"in=3", "min=0 max=3"},
      {"in=-1", "min=-1 max=3"},
      {"in=2 reset=1", "min=2 max=2"},
      {"in=nan reset=0", "min=2"}}},
    {"Modmath",
     "modmath",
     "modmath.0",
     {"modmath.0"},
     "min-num=1 max-num=8",
     {{"actual=1 desired=3", "up=1 down=0 on-target=0"},
      {"desired=8", "up=0 down=1 on-target=0"},
      {"desired=5", "up=1 down=0"},
      {"wrap=0 desired=8", "up=1 down=0"},
      {"actual=8", "up=0 down=0 on-target=1"},
      {"desired=9", "up=0 down=0 on-target=0"}}},
    {"Wcomp",
     "wcomp",
     "wcomp.0",
     {"wcomp.0"},
     "min=1 max=2",
     {{"in=1", "out=0 under=1 over=0"},
      {"in=1.5", "out=1 under=0 over=0"},
      {"in=2", "out=0 under=0 over=1"},
      {"in=nan", "out=0 under=0 over=0"}}},
    {"Blend",
     "blend",
     "blend.0",
     {"blend.0"},
     "in1=10 in2=20",
     {{"select=0.25", "out=17.5"}, {"select=1.5", "out=10"}, {"open=1", "out=5"}}},
    {"Deadzone",
     "deadzone",
     "deadzone.0",
     {"deadzone.0"},
     "center=1",
     {{"in=1.4", "out=1"}, {"in=1.6", "out=1.1"}, {"in=-2", "out=-1.5"}}},
    {"Clarke2", "clarke2", "clarke2.0", {"clarke2.0"}, "", {{"a=1 b=10", "x=1 y=12.1243557"}}},
    {"Clarke3",
     "clarke3",
     "clarke3.0",
     {"clarke3.0"},
     "",
     {{"a=1 b=10 c=4", "x=-4 y=3.4641016 h=7.0710678"}}},
    {"Clarkeinv",
     "clarkeinv",
     "clarkeinv.0",
     {"clarkeinv.0"},
     "x=-4 y=3.4641016 h=7.0710678",
     {{"", "a=1 b=10 c=4"}, {"x=1 y=0 h=0 theta=0.5", "a=-1 b=0.5 c=0.5"}}},
    {"ScaledS32Sums",
     "scaled_s32_sums",
     "scaled-s32-sums.0",
     {"scaled-s32-sums.0"},
     "",
     {{"in0=1 scale0=1.5 in3=2", "out-f=3.5 out-s=3"}, {"in1=2000000000 scale1=4", "out-s=2147483647"}}},
    {"SampleHold",
     "sample_hold",
     "sample-hold.0",
     {"sample-hold.0"},
     "",
     {{"in=2", "out=2"}, {"hold=1 in=3", "out=2"}, {"hold=0", "out=3"}}},
    {"Lincurve",
     "lincurve personality=3",
     "lincurve.0",
     {"lincurve.0"},
     "x-val-00=1 y-val-00=10 x-val-01=2 y-val-01=0 x-val-02=4 y-val-02=5",
     {{"in=0", "out=10"}, {"in=1.5", "out=5 out-io=5"}, {"in=3", "out=2.5"}, {"in=9", "out=5"}}},
    {"WeightedSum",
     "weighted_sum wsum_sizes=2",
     "wsum.0",
     {"process_wsums"},
     "offset=10",
     {{"bit.1.in=1", "sum=12"}, {"bit.1.weight=-7 bit.0.in=1", "sum=4"}, {"hold=1 bit.0.in=0", "sum=4"}}},
    {"BiquadLowpass",
     "biquad",
     "biquad.0",
     {"biquad.0"},
     "type=1 f0=100",
     {{"in=1", "out=1 valid=0"}, {"enable=1", "out=0.0674553 valid=1"}, {"in=0", "out=0.212010"}}},
    {"BiquadRefusesAFrequencyBeyondHalfTheRate",
     "biquad",
     "biquad.0",
     {"biquad.0"},
     "type=2 f0=600 enable=1",
     {{"in=1", "out=1 valid=0"}}},
    {"BiquadSettles", "biquad", "biquad.0", {"biquad.0"}, "type=1 f0=50 enable=1 in=3", {{"", "out=3", 400}}},
    {"FilterKalman",
     "filter_kalman",
     "filter-kalman.0",
     {"filter-kalman.0"},
     "rk=4 qk=0.1",
     {{"zk=5", "xk-out=1.0784314"},
      {"", "xk-out=1.8391956"},
      {"passthrough=1 zk=2", "xk-out=2"},
      {"reset=1", "xk-out=0"},
      {"passthrough=0 reset=0 zk=nan", "xk-out=0"}}},
    {"Joyhandle",
     "joyhandle",
     "joyhandle.0",
     {"joyhandle.0"},
     "deadband=0.1 offset=0.2 scale=3",
     {{"in=0.05", "out=0"},
      {"in=0.2", "out=0.2666667"},
      {"in=-0.5", "out=-0.8666667"},
      {"in=2", "out=3.2"},
      {"inverse=1 power=3 in=0.2", "out=1.0181818"},
      {"in=-0.2", "out=-1.0181818"}}},
    {"Knob2float",
     "knob2float",
     "knob2float.0",
     {"knob2float.0"},
     "scale=0.3",
     {{"counts=10 enable=1", "out=0"},
      {"counts=12", "out=0.6"},
      {"counts=20", "out=1"},
      {"enable=0 counts=0", "out=1"},
      {"enable=1 counts=-1", "out=0.7"}}},
    {"Multiswitch",
     "multiswitch cfg=3",
     "multiswitch.0",
     {"multiswitch.0"},
     "",
     {{"", "bit-00=1"},
      {"up=1", "bit-01=1 bit-00=0"},
      {"up=0", "bit-01=1"},
      {"down=1", "bit-00=1"},
      {"down=0", "bit-00=1"},
      {"down=1", "bit-02=1"},
      {"position=1", "bit-01=1"}}},
    {"Ton",
     "ton",
     "ton.0",
     {"ton.0"},
     "pt=0.003",
     {{"in=1", "q=0 et=0.001"}, {"", "q=0 et=0.003", 2}, {"", "q=1 et=0.003"}, {"in=0", "q=0 et=0"}}},
    {"Tof",
     "tof",
     "tof.0",
     {"tof.0"},
     "pt=0.003",
     {{"in=1", "q=1 et=0"}, {"in=0", "q=1 et=0.003", 3}, {"", "q=0"}}},
    {"Time",
     "time",
     "time.0",
     {"time.0"},
     "",
     {{"start=1", "hours=1 minutes=1 seconds=5", 3665000},
      {"pause=1", "seconds=5", 5000},
      {"start=0", "seconds=5", 10},
      {"pause=0", "seconds=5"},
      {"start=1", "hours=0 minutes=0 seconds=0"}}},
    {"Histobins",
     "histobins",
     "histobins.0",
     {"histobins.0"},
     "nbins=5 reset=1",
     {{"", "nsamples=0"},
      {"reset=0 input=1.5 index=1", "binvalue=1 check=1 nsamples=1"},
      {"input=1.7", "binvalue=2 mean=1.6 variance=0.02"},
      {"input=-3", "nextra=1 input-min=-3 input-max=1.7"},
      {"input=5", "pextra=1"},
      {"index=5", "binvalue=-1"},
      {"nbins=500", "input-error=1"},
      {"nbins=5 pintype=3 input-bit=1 index=1", "input-error=0 binvalue=3"}}},
    {"Threadtest", "threadtest", "threadtest.0", {"threadtest.0.increment"}, "", {{"", "count=3", 3}}},
    {"Supply",
     "supply",
     "supply.0",
     {"supply.0.update"},
     "",
     {{"d=1 value=2.5", "q=1 q-not=0 _q=0 variable=2.5 variable-not=-2.5"}}},
    {"Sphereprobe",
     "sphereprobe",
     "sphereprobe.0",
     {"sphereprobe.0"},
     "cz=10 r=5",
     {{"pz=16", "probe-out=0"},
      {"pz=15", "probe-out=1"},
      {"px=9 pz=10", "probe-out=0"},
      {"pz=9", "probe-out=1"}}},
    {"SimMatrixKb",
     "sim_matrix_kb",
     "sim-matrix-kb.0",
     {"sim-matrix-kb.0"},
     "",
     {{"button.c01.r00=1", "out=193"},
      {"", "out=64"},
      {"button.c00.r01=1 button.c01.r00=0", "out=200"},
      {"", "out=129"},
      {"button.c00.r01=0", "out=136"},
      {"", "out=0"}}},
    {"SimParport",
     "sim_parport names=p",
     "p",
     {"p.read", "p.write", "p.reset"},
     "pin-02-out-invert=1",
     {{"pin-12-in-fake=1", "pin-12-in=1 pin-12-in-not=0 pin-02-out-fake=1"},
      {"pin-02-out=1", "pin-02-out-fake=0"}}},
    {"SimAxisHardware",
     "sim_axis_hardware",
     "sim-axis-hardware.0",
     {"sim-axis-hardware.0.update"},
     "Xmaxsw-upper=11 Xmaxsw-lower=10 x-minsw-upper=-10 x-minsw-lower=-11",
     {{"x-current-pos=1.01", "x-homesw-out=1 x-maxsw-homesw-out=1 homesw-all=0"},
      {"x-current-pos=10.5", "x-maxsw-out=1 x-bothsw-out=1 limitsw-all=1"},
      {"x-current-pos=-10.5", "Xminsw-out=1 limitsw-homesw-all=1"},
      {"y-homing=1", "x-minsw-out=1 x-bothsw-out=0 limitsw-all=0"}}},
};

MW_TABLE_SUITE(ValueTable, VALUES);

TEST(Timedelta, MeasuresThePeriod) {
    Bench bench("loadrt timedelta\naddf timedelta.0 t");
    bench.pass(10);
    EXPECT_EQ(bench.get("timedelta.0.out"), 1e6);
    EXPECT_EQ(bench.get("timedelta.0.jitter"), 0.0);
    EXPECT_EQ(bench.get("timedelta.0.max"), 1e6);
    EXPECT_EQ(bench.get("timedelta.0.avg-err"), 0.0);
}

TEST(Latencybins, CountsPunctualRunsInBinZero) {
    Bench bench("loadrt latencybins\naddf latencybins.0 t\nsetp latencybins.0.nsbinsize 1000");
    bench.pass(11);
    EXPECT_EQ(bench.get("latencybins.0.pbinvalue"), 10.0);
    EXPECT_EQ(bench.get("latencybins.0.nbinvalue"), 0.0);
    bench.set("latencybins.0.index", 1001);
    bench.pass();
    EXPECT_EQ(bench.get("latencybins.0.pbinvalue"), -1.0);
}

TEST(Message, ShowsItsTextAtTheWantedEdgeOnce) {
    Bench bench("loadrt message messages=Oil names=oil\naddf oil t");
    bench.pass(3);
    ::testing::internal::CaptureStderr();
    bench.set("oil.trigger", 1);
    bench.pass(5);
    bench.set("oil.force", 1);
    bench.pass(5);
    const std::string shown = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(shown, "Oil\nOil\n");
}

TEST(Pushmsg, EachRisingEdgeShowsTheTextOfItsPin) {
    Bench bench("loadrt pushmsg emsg=Stuck,Jammed wmsg=Careful\naddf pushmsg t");
    bench.pass(3);
    ::testing::internal::CaptureStderr();
    bench.set("pushmsg.error-01", 1);
    bench.pass(5);
    bench.set("pushmsg.error-02", 1);  // has no text
    bench.set("pushmsg.error-01", 0);
    bench.pass(2);
    bench.set("pushmsg.error-01", 1);
    bench.pass(2);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "Jammed\nJammed\n");
}

TEST(LedDim, LooksAsBrightAsItIsAskedFor) {
    Bench bench("loadrt led_dim\naddf led-dim.0 t");
    const auto at = [&bench](double lightness) {
        bench.set("led-dim.0.in", lightness);
        bench.pass();
        return bench.get("led-dim.0.out");
    };
    EXPECT_EQ(at(0), 0.0);
    EXPECT_NEAR(at(0.08), 0.08 * 100 / 903.3, 1e-12);
    EXPECT_NEAR(at(0.5), 0.184187, 1e-6) << "CIE: L* = 50";
    EXPECT_NEAR(at(1), 1.0, 1e-12);
    EXPECT_EQ(at(7), 1.0);
    EXPECT_EQ(at(-1), 0.0);
}

}  // namespace
}  // namespace mw::components::test
