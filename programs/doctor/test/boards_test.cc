// SPDX-License-Identifier: GPL-2.0-or-later
// The reports about the cycles of a board.
#include <gtest/gtest.h>

#include "programs/doctor/boards.hh"
#include "programs/doctor/examine.hh"

namespace mw::doctor {
namespace {

constexpr std::int64_t S = 1'000'000'000, MS = 1'000'000;

std::vector<mesa::CycleTimes> good_cycles(int count) {
    std::vector<mesa::CycleTimes> cycles(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < cycles.size(); ++i) {
        cycles[i].begin_ns = static_cast<std::int64_t>(i + 1) * MS;
        cycles[i].sent_ns = cycles[i].begin_ns + 10'000;
        cycles[i].answered_ns = cycles[i].begin_ns + 90'000;
    }
    return cycles;
}

std::string findings(const mesa::RecordedCycles &cycles) {
    diagnostics::Sink sink;
    judge_board(cycles, 100 * S, sink);
    std::string text;
    for (const diagnostics::Diagnostic &finding : sink.all()) {
        text += finding_line(finding) + '\n';
    }
    return text;
}

TEST(Boards, AGoodOneIsANoteWithItsTimes) {
    mesa::RecordedCycles cycles;
    cycles.board = "hm2_7i92.0";
    cycles.address = "10.0.0.2";
    cycles.period_ns = MS;
    cycles.since = good_cycles(500);
    EXPECT_EQ(findings(cycles),
              "system: note: hm2_7i92.0 at 10.0.0.2: 500 cycles of 1000 us, 0 failed; answers after 80 us, "
              "99.9 percent within 80 us, the slowest 80 us\n");
}

TEST(Boards, AFaultIsNamedWithItsCauseAndWhatToChange) {
    mesa::RecordedCycles cycles;
    cycles.board = "hm2_7i92.0";
    cycles.address = "10.0.0.2";
    cycles.period_ns = MS;
    cycles.fault = mesa::BoardFault::WATCHDOG;
    cycles.fault_ns = 88 * S;
    cycles.at_fault = good_cycles(500);
    cycles.at_fault.back().begin_ns += 20 * MS;
    const std::string text = findings(cycles);
    EXPECT_NE(text.find("its watchdog has tripped, 12 s ago"), std::string::npos) << text;
    EXPECT_NE(text.find("The thread began 1 cycles more than half a period late, the worst by 20000 us."),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("latency-test"), std::string::npos) << text;
}

TEST(Boards, ABoardThatWasNeverReadIsNotTold) {
    EXPECT_EQ(findings({}), "");
}

}  // namespace
}  // namespace mw::doctor
