// SPDX-License-Identifier: GPL-2.0-or-later
// The behaviour of components in the period in which something changes: the first period, an enable, an
// index, an edge. The values are those of LinuxCNC 2.9 unless a test states otherwise.
#include <cmath>

#include "components/test/bench.hh"
#include "components/test/table.hh"

namespace mw::components::test {
namespace {

/// A pid with command and feedback set in every period; the gains give each term its own size.
class PidBench {
  public:
    explicit PidBench(const std::string &setup)
        : bench_("loadrt pid num_chan=1 debug=1\naddf pid.0.do-pid-calcs t\n" + setup) {}

    void step(double command, double feedback) {
        bench_.set("pid.0.command", command);
        bench_.set("pid.0.feedback", feedback);
        bench_.pass();
    }
    void set(const std::string &pin, double value) { bench_.set("pid.0." + pin, value); }
    double get(const std::string &pin) { return bench_.get("pid.0." + pin); }

  private:
    Bench bench_;
};

TEST(Pid, AnIndexDoesNotChangeTheOutputWhenCommandAndFeedbackJumpTogether) {
    PidBench pid("setp pid.0.Pgain 10\nsetp pid.0.Igain 1\nsetp pid.0.FF1 0.001\nsetp pid.0.FF2 0.00001\n"
                 "setp pid.0.Dgain 0.001\nsetp pid.0.enable 1\nsetp pid.0.index-enable 1");
    for (int i = 0; i < 10; ++i) {
        pid.step(100.0 + 0.1 * i, 99.95 + 0.1 * i);
    }
    const double integral = pid.get("errorI");
    pid.set("index-enable", 0);
    pid.step(0.4, 0.3);
    EXPECT_NEAR(pid.get("error"), 0.1, 1e-9);
    EXPECT_NEAR(pid.get("commandD"), 100.0, 1e-6) << "the speed before the jump";
    EXPECT_NEAR(pid.get("commandDD"), 0.0, 1e-3);
    EXPECT_NEAR(pid.get("errorD"), 0.0, 1e-6);
    EXPECT_NEAR(pid.get("errorI") - integral, 0.1 * 1e-3, 1e-9);
    EXPECT_NEAR(pid.get("output"), 10 * 0.1 + pid.get("errorI") + 0.001 * 100.0, 1e-6);
    pid.step(0.5, 0.4);
    EXPECT_NEAR(pid.get("error"), 0.0, 1e-9) << "the previous target is one of the new coordinates";
    EXPECT_NEAR(pid.get("output"), pid.get("errorI") + 0.1, 1e-6);
}

TEST(Pid, AnIndexKeepsOnlyEstimatedDerivatives) {
    PidBench pid("newsig v float\nnet v pid.0.feedback-deriv\nsets v 90\nsetp pid.0.Dgain 1\n"
                 "setp pid.0.Pgain 0\nsetp pid.0.enable 1\nsetp pid.0.index-enable 1");
    for (int i = 0; i < 5; ++i) {
        pid.step(100.0 + 0.1 * i, 99.95 + 0.1 * i);
    }
    EXPECT_NEAR(pid.get("errorD"), 10.0, 1e-6);
    pid.set("index-enable", 0);
    pid.step(0.4, 0.3);
    EXPECT_NEAR(pid.get("errorD"), 10.0, 1e-6) << "command as estimated before, feedback as linked";
}

TEST(Pid, EnablingWhileTheCommandMovesAddsNoStep) {
    for (const double previous_target : {0.0, 1.0}) {
        PidBench pid("setp pid.0.Pgain 1\nsetp pid.0.FF1 0.01\nsetp pid.0.FF2 0.001\nsetp pid.0.FF3 0.001");
        pid.set("error-previous-target", previous_target);
        for (int i = 0; i < 8; ++i) {
            pid.set("enable", i >= 4);
            pid.step(1.0 + 0.1 * i, 0.5 + 0.1 * i);
            const double error = i == 0 || previous_target == 0.0 ? 0.5 : 0.4;
            EXPECT_NEAR(pid.get("error"), error, 1e-9);
            EXPECT_NEAR(pid.get("output"), i < 4 ? 0.0 : error + 1.0, 1e-3) << "period " << i;
            EXPECT_EQ(pid.get("errorI") != 0.0, i >= 4);
        }
        pid.set("enable", 0);
        pid.step(1.8, 1.3);
        EXPECT_NEAR(pid.get("commandD"), 100.0, 1e-6) << "continues while disabled";
        EXPECT_EQ(pid.get("errorI"), 0.0);
    }
}

// LinuxCNC takes the command of the period before the first one as 0.
TEST(Pid, TheFirstPeriodHasNoDerivativeAndNoPreviousTarget) {
    PidBench pid(
        "setp pid.0.Pgain 1\nsetp pid.0.Dgain 1\nsetp pid.0.FF1 1\nsetp pid.0.FF2 1\nsetp pid.0.FF3 1\n"
        "setp pid.0.enable 1");
    pid.step(100.0, 99.0);
    EXPECT_NEAR(pid.get("output"), 1.0, 1e-9);
    pid.step(100.1, 99.1);
    EXPECT_NEAR(pid.get("commandD"), 100.0, 1e-6);
    EXPECT_EQ(pid.get("commandDD"), 0.0) << "needs three samples";
    pid.step(100.2, 99.2);
    EXPECT_EQ(pid.get("commandDDD"), 0.0) << "needs four samples";
    EXPECT_NEAR(pid.get("commandDD"), 0.0, 1e-4);
}

TEST(Pid, AValueThatIsNoNumberLeavesNothingBehind) {
    PidBench pid("newsig f float\nnet f pid.0.feedback-deriv\nsetp pid.0.Pgain 1\nsetp pid.0.Dgain 1\n"
                 "setp pid.0.FF1 1\nsetp pid.0.FF2 1\nsetp pid.0.enable 1");
    for (int i = 0; i < 5; ++i) {
        pid.step(i, i);
    }
    pid.step(std::nan(""), 5.0);
    EXPECT_EQ(pid.get("output"), 0.0);
    pid.step(50.0, 49.0);
    EXPECT_NEAR(pid.get("output"), 1.0, 1e-9) << "as in a first period";
}

TEST(Pid, MaxerrorLimitsTheErrorBeforeDeadband) {
    PidBench pid(
        "setp pid.0.Pgain 1\nsetp pid.0.deadband 0.05\nsetp pid.0.maxerror 0.5\nsetp pid.0.enable 1");
    pid.step(2.0, 0.0);
    EXPECT_NEAR(pid.get("output"), 0.45, 1e-12);
}

TEST(Encoder, AnIndexThatIsTrueInTheFirstPeriodIsNotPassed) {
    for (const char *load : {"encoder", "counter"}) {
        const std::string name = load;
        Bench bench("loadrt " + name + " num_chan=1\nsetp " + name + ".0.phase-Z 1\nsetp " + name +
                    ".0.index-enable 1\naddf " + name + ".update-counters t\naddf " + name +
                    ".capture-position t");
        bench.pass(3);
        EXPECT_EQ(bench.get(name + ".0.index-enable"), 1.0);
        bench.set(name + ".0.phase-Z", 0);
        bench.pass();
        bench.set(name + ".0.phase-Z", 1);
        bench.pass();
        EXPECT_EQ(bench.get(name + ".0.index-enable"), 0.0);
    }
}

TEST(Carousel, HasTheSensorsOfItsEncoding) {
    struct Case {
        const char *load;
        int pins;
    };
    for (const Case &one : {Case{"encoding=single pockets=12", 12},
                            {"encoding=index pockets=8", 2},
                            {"encoding=edge pockets=8", 4},
                            {"encoding=counts pockets=8", 4},
                            {"encoding=gray pockets=20 num_sense=5", 5}}) {
        Bench bench("loadrt carousel " + std::string(one.load));
        EXPECT_TRUE(bench.hal().values().get("carousel.0.sense-" + std::to_string(one.pins - 1)).has_value())
            << one.load;
        EXPECT_FALSE(bench.hal().values().get("carousel.0.sense-" + std::to_string(one.pins)).has_value())
            << one.load;
    }
    Bench bench("");
    bench.run("loadrt carousel encoding=single pockets=33");
    EXPECT_NE(bench.output.errors.find("at most 32"), std::string::npos);
}

TEST(Pid, InnerValuesArePins) {
    Bench bench(
        "loadrt pid num_chan=1 debug=1\nnet i pid.0.errorI\nnet d <= pid.0.errorD\nnet c pid.0.commandD\n"
        "net cc pid.0.commandDD\nnet ccc pid.0.commandDDD");
    EXPECT_EQ(bench.output.errors, "");
}

TEST(Stepgen, NoStepBeginsAfterEnableFalls) {
    for (const char *type : {"0", "1", "2", "9"}) {
        Bench bench(
            "loadrt stepgen step_type=" + std::string(type) +
            " ctrl_type=v\nsetp stepgen.0.velocity-cmd 100\nsetp stepgen.0.enable 1\n"
            "addf stepgen.make-pulses t\naddf stepgen.update-freq t\naddf stepgen.capture-position t");
        bench.pass(100);
        EXPECT_GT(bench.get("stepgen.0.counts"), 5.0);
        bench.run("delf stepgen.update-freq t");  // a servo thread that is late
        bench.set("stepgen.0.enable", 0);
        const double counts = bench.get("stepgen.0.counts");
        const double position = bench.get("stepgen.0.position-fb");
        bench.pass(100);
        EXPECT_EQ(bench.get("stepgen.0.counts"), counts);
        EXPECT_EQ(bench.get("stepgen.0.position-fb"), position);
        bench.set("stepgen.0.enable", 1);
        bench.run("addf stepgen.update-freq t");
        bench.pass(100);
        EXPECT_GT(bench.get("stepgen.0.counts"), counts + 5.0);
    }
}

TEST(Stepgen, AStepThatHasBegunKeepsItsLength) {
    Bench bench("loadrt stepgen step_type=0 ctrl_type=v\nsetp stepgen.0.velocity-cmd 50\n"
                "setp stepgen.0.steplen 5000000\nsetp stepgen.0.enable 1\naddf stepgen.make-pulses t\n"
                "addf stepgen.update-freq t");
    for (int i = 0; i < 100 && bench.get("stepgen.0.step") == 0.0; ++i) {
        bench.pass();
    }
    bench.set("stepgen.0.enable", 0);
    int high = 1;
    while (bench.get("stepgen.0.step") != 0.0 && high < 50) {
        bench.pass();
        ++high;
    }
    EXPECT_EQ(high, 6) << "five periods high, the sixth is low";
}

TEST(Bldc, TheSignOfValueDoesNotReverseTheAlignment) {
    struct Case {
        double value, rev, initvalue, phase;
    };
    for (const Case &c : {Case{0.5, 0, 0.2, 0.1}, Case{-0.5, 0, 0.2, 0.1}, Case{0.5, 1, 0.2, 0.9},
                          Case{-0.5, 1, 0.2, 0.9}, Case{0.5, 0, -0.2, 0.9}, Case{-0.5, 1, -0.2, 0.1}}) {
        Bench bench("loadrt bldc cfg=qi\naddf bldc.0 t", 100000000);
        bench.set("bldc.0.value", c.value);
        bench.set("bldc.0.rev", c.rev);
        bench.set("bldc.0.initvalue", c.initvalue);
        bench.pass();
        bench.set("bldc.0.init", 1);
        bench.pass();
        EXPECT_NEAR(bench.get("bldc.0.phase-angle"), c.phase, 1e-6) << c.value << c.rev << c.initvalue;
        EXPECT_NEAR(bench.get("bldc.0.out"), 0.2, 1e-6);
    }
}

struct MandatoryCase {
    const char *load;
    const char *parameter;
};

TEST(Loadrt, AMissingMandatoryParameterIsAnErrorThatNamesIt) {
    for (const MandatoryCase &one : {MandatoryCase{"bldc", "cfg="},
                                     {"carousel", "pockets="},
                                     {"debounce", "cfg="},
                                     {"debounce cfg=", "cfg="},
                                     {"debounce cfg=0", "cfg="},
                                     {"lcd", "fmt_strings="},
                                     {"logic", "personality"},
                                     {"matrix_kb", "config="},
                                     {"message", "messages="},
                                     {"mux_generic", "config="},
                                     {"demux_generic", "config="},
                                     {"enum", "enums="},
                                     {"pwmgen", "output_type="},
                                     {"sampler", "cfg="},
                                     {"stepgen", "step_type="},
                                     {"streamer", "cfg="},
                                     {"watchdog", "num_inputs="},
                                     {"weighted_sum", "wsum_sizes="}}) {
        Bench bench("");
        const std::size_t pins = bench.hal().pins().list().size();
        bench.run("loadrt " + std::string(one.load));
        EXPECT_NE(bench.output.errors.find(one.parameter), std::string::npos)
            << one.load << ": " << bench.output.errors;
        EXPECT_EQ(bench.hal().pins().list().size(), pins) << one.load;
    }
}

const std::vector<Table> TRANSITIONS = {
    {"UpdownFirstPeriod",
     "updown",
     "updown.0",
     {"updown.0"},
     "countup=1",
     {{"", "count=0"}, {"countdown=1", "count=-1"}, {"countup=0", "count=-1"}, {"countup=1", "count=0"}}},
    {"CompWithoutHysteresis",
     "comp",
     "comp.0",
     {"comp.0"},
     "",
     {{"", "out=0 equal=1"},
      {"in1=1", "out=1 equal=0"},
      {"in0=1", "equal=1"},
      {"in0=2", "out=0 equal=0"},
      {"in1=2", "out=0 equal=1"}}},
    {"CompAtTheEdgeOfItsBand",
     "comp",
     "comp.0",
     {"comp.0"},
     "hyst=2",
     {{"in1=1", "out=0 equal=1"},
      {"in1=1.1", "out=1 equal=0"},
      {"in1=-1", "out=1 equal=1"},
      {"in1=-1.1", "out=0 equal=0"}}},
    {"TimedelayCountsOn",
     "timedelay",
     "timedelay.0",
     {"timedelay.0"},
     "on-delay=0.0035 in=1",
     {{"", "out=0 elapsed=0.001"},
      {"", "out=0 elapsed=0.003", 2},
      {"", "out=1 elapsed=0.004"},
      {"", "elapsed=0.004"}}},
    {"Mux16KeepsItsOutputWhileItDebounces",
     "mux16",
     "mux16.0",
     {"mux16.0"},
     "debounce-time=0.002 in01=1 in02=2 sel0=1",
     {{"", "out-f=0"},
      {"", "out-f=0"},
      {"", "out-f=1"},
      {"in01=1.5", "out-f=1.5"},
      {"sel0=0 sel1=1 in01=7", "out-f=1.5"},
      {"", "out-f=2", 2}}},
    {"Mux16KeepsItsOutputWithoutSelection",
     "mux16",
     "mux16.0",
     {"mux16.0"},
     "suppress-no-input=1 in00=5 in01=1 sel0=1",
     {{"", "out-f=1"}, {"sel0=0 in01=3", "out-f=1"}, {"sel0=1", "out-f=3"}}},
    {"ConvNegativeToBit",
     "conv_s32_bit",
     "conv-s32-bit.0",
     {"conv-s32-bit.0"},
     "in=-3",
     {{"", "out=1 out-of-range=1"}, {"clamp=1", "out=0 out-of-range=1"}, {"in=3", "out=1"}}},
    {"ConvNegativeFloatWraps",
     "conv_float_u32",
     "conv-float-u32.0",
     {"conv-float-u32.0"},
     "in=-2",
     {{"", "out=4294967294 out-of-range=1"}, {"clamp=1", "out=0"}}},
    {"CounterReset",
     "counter",
     "counter.0",
     {"counter.update-counters", "counter.capture-position"},
     "",
     {{"", "rawcounts=0"},
      {"phase-A=1", "rawcounts=1 counts=1"},
      {"reset=1", "rawcounts=0 counts=0"},
      {"reset=0 phase-A=0", "rawcounts=0"},
      {"phase-A=1", "rawcounts=1 counts=1"}}},
    {"PulseTimer",
     "tp",
     "tp.0",
     {"tp.0"},
     "pt=0.0035 in=1",
     {{"", "q=1 et=0.001"},
      {"", "q=1 et=0.002"},
      {"in=0", "q=1 et=0.003"},
      {"in=1", "q=1 et=0.004"},
      {"", "q=0 et=0.004"},
      {"", "q=0 et=0"},
      {"in=0", "q=0 et=0"},
      {"in=1", "q=1 et=0.001"},
      {"in=0", "q=1 et=0.004", 3},
      {"", "q=0 et=0.004"},
      {"in=1", "q=1 et=0.001"}}},
    {"PulseTimerWithoutWidth",
     "tp",
     "tp.0",
     {"tp.0"},
     "in=1",
     {{"", "q=0 et=0"}, {"in=0", "q=0"}, {"in=1 pt=-1", "q=0 et=0"}}},
};

MW_TABLE_SUITE(TransitionTables, TRANSITIONS);

}  // namespace
}  // namespace mw::components::test
