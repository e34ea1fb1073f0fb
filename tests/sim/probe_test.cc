// SPDX-License-Identifier: GPL-2.0-or-later
// Probing on a whole machine in virtual time: results, errors, the file of (probeopen) (I1, C7).
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class ProbeTest : public VirtualMachineTest {
  protected:
    void SetUp() override { switch_on(); }
    /// Runs the program; the probe touches a wall at X = `wall` from below.
    task::Progress probe(const std::string &text, double wall) {
        start(text);
        return follow(wall);
    }
    task::Progress follow(double wall) {
        for (int i = 0; i < 200000; ++i) {
            cycles(1);
            set_pin("motion.probe-input", x() >= wall ? "TRUE" : "FALSE");
            if (i > 3 && progress(run_) != task::Progress::STARTED) {
                break;
            }
        }
        return progress(run_);
    }
    long count_lines(const std::string &name) const {
        const std::string text = read(name);
        return std::count(text.begin(), text.end(), '\n');
    }
    std::string in_folder(const std::string &name) const { return (folder_ / name).string(); }
};

TEST_F(ProbeTest, EachProbeThatTripsWritesALineOfNineCoordinates) {
    const std::string file = in_folder("points.txt");
    EXPECT_EQ(probe("G21 G90\nG10 L2 P1 X5 Y1\nG0 X0 Y2\n(PROBEOPEN " + file +
                        ")\nG38.3 X20 F600\nG0 X0 Y3\nG38.2 X20\nG0 X0\nG38.3 X-5\n(probeclose)\n"
                        "G38.3 X20\nG0 X0\nM2\n",
                    12.5),
              task::Progress::DONE)
        << messages();
    std::istringstream lines(read("points.txt"));
    std::string line;
    for (const double y : {2.0, 3.0}) {
        ASSERT_TRUE(std::getline(lines, line));
        std::istringstream numbers(line);
        std::vector<double> values;
        for (double value = 0; numbers >> value;) {
            values.push_back(value);
        }
        ASSERT_EQ(values.size(), 9U) << line;
        EXPECT_NEAR(values[0], 7.5, 0.03) << "in program coordinates, where it tripped";
        EXPECT_DOUBLE_EQ(values[1], y);
    }
    EXPECT_FALSE(std::getline(lines, line))
        << "a miss and a probe after (probeclose) write nothing: " << line;
}

TEST_F(ProbeTest, AnAbortAndTheEndOfTheProgramKeepWhatWasWritten) {
    const std::string file = in_folder("points.txt");
    EXPECT_EQ(probe("G21 G90\n(probeopen " + file + ")\nG38.3 X20 F600\nG0 X0\nM2\n", 3),
              task::Progress::DONE);
    EXPECT_EQ(count_lines("points.txt"), 1);
    EXPECT_EQ(
        probe("G21 G90\n(probeopen " + file + ")\nG38.3 X20 F600\nG0 X0\nG38.3 X20\nG0 X0\nG1 X[1/0]\nM2\n",
              3),
        task::Progress::FAILED);
    EXPECT_EQ(count_lines("points.txt"), 2);
}

TEST_F(ProbeTest, AFileThatCannotBeWrittenIsToldBeforeTheProbe) {
    EXPECT_EQ(
        probe("G21 G90\n(probeopen " + in_folder("no/such/folder/p.txt") + ")\nG38.3 X20 F600\nG0 X0\nM2\n",
              3),
        task::Progress::FAILED);
    EXPECT_NE(messages().find("no/such/folder"), std::string::npos);
    EXPECT_LT(x(), 1.0) << "nothing was probed";
}

TEST_F(ProbeTest, AFullDiskStopsTheProgram) {
    // For the process, this limit and a full disk look the same.
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit none{0, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const std::string points = in_folder("points.txt");
    start("G21 G90\n(probeopen " + points + ")\nG38.3 X20 F600\nG0 X0\nG38.3 X20 F600\nG0 X-5\nM2\n");
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &none), 0);
    const auto progress = follow(3);
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(progress, task::Progress::FAILED);
    const std::string all = messages();
    EXPECT_NE(all.find("cannot write " + points), std::string::npos) << all;
}

TEST_F(ProbeTest, ResultsAreInProgramUnitsAndToolOffsetsCount) {
    EXPECT_EQ(
        probe(
            "G20 G90\nG43.1 X0.1\nG0 X0 Y1\nG38.2 X0.6 F20\n(debug,%.3f#5061 %.3f#5062 %d#5070)\nG0 X0\nM2\n",
            7.62),
        task::Progress::DONE)
        << messages();
    EXPECT_NE(messages().find("0.20"), std::string::npos);
}

TEST_F(ProbeTest, AProbeInItsTargetStateAtTheStartHasTripped) {
    // G38.3 with a closed probe and G38.5 with an open one: no error, and the program continues.
    for (const auto &[code, probe] : {std::pair{"G38.3", "TRUE"}, std::pair{"G38.5", "FALSE"}}) {
        set_pin("motion.probe-input", probe);
        cycles(5);
        start(std::string("G21 G90\nG0 X1\n") + code + " X5 F600\n(debug,#5070 at %.2f#5061)\nG1 X3\nM2\n");
        EXPECT_EQ(finish(), task::Progress::DONE) << code;
        const std::string all = messages();
        EXPECT_NE(all.find("1.000000 at 1.00"), std::string::npos) << code << ": " << all;
        EXPECT_NEAR(x(), 3, 1e-6) << code;
    }
}

TEST_F(ProbeTest, AProbeThatMustTripNamesTheStateThatItIsInAtTheStart) {
    const struct {
        const char *code, *probe, *text;
    } cases[] = {{"G38.2", "TRUE", "the probe is already tripped before G38.2"},
                 {"G38.4", "FALSE", "the probe is already open before G38.4"}};
    for (const auto &one : cases) {
        set_pin("motion.probe-input", one.probe);
        cycles(5);
        start(std::string("G21 G90\n") + one.code + " X5 F600\nG0 X3\nM2\n");
        EXPECT_EQ(finish(), task::Progress::FAILED) << one.code;
        const std::string all = messages() + reason(run_);
        EXPECT_NE(all.find(one.text), std::string::npos) << all;
        EXPECT_NEAR(x(), 0, 1e-6) << one.code;
    }
}

TEST_F(ProbeTest, AMissEndsTheProgramOnlyWhereItMust) {
    EXPECT_EQ(probe("G21 G90\nG38.3 X2 F600\n(debug,hit %d#5070 at %.1f#5061)\nG0 X0\nM2\n", 50),
              task::Progress::DONE);
    std::string all = messages();
    EXPECT_NE(all.find("hit 0 at 2.0"), std::string::npos) << all;
    EXPECT_EQ(probe("G21 G90\nG38.2 X2 F600\nG0 X9\nM2\n", 50), task::Progress::FAILED);
    all = messages();
    EXPECT_NE(all.find("p.ngc:2"), std::string::npos) << all;
    EXPECT_LT(x(), 2.1);
}

}  // namespace
}  // namespace mw::machine
