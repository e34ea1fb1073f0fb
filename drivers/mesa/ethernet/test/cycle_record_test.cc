// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the record of the last cycles, and its report.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "drivers/mesa/ethernet/cycle_record_file.hh"
#include "drivers/mesa/ethernet/cycle_report.hh"

namespace mw::mesa {
namespace {

constexpr std::int64_t CYCLE_NS = 1'000'000;

/// A good cycle that begins at `begin_ns`.
CycleTimes good(std::int64_t begin_ns) {
    CycleTimes cycle;
    cycle.begin_ns = begin_ns;
    cycle.sent_ns = begin_ns + 10'000;
    cycle.answered_ns = begin_ns + 90'000;
    cycle.written_ns = begin_ns + 300'000;
    return cycle;
}

std::vector<CycleTimes> good_cycles(std::size_t count) {
    std::vector<CycleTimes> cycles;
    for (std::size_t i = 0; i < count; ++i) {
        cycles.push_back(good(static_cast<std::int64_t>(i + 1) * CYCLE_NS));
        cycles.back().host_packets = static_cast<std::uint16_t>(65'000 + 2 * i);
        cycles.back().board_packets = static_cast<std::uint16_t>(2 * i + 7);
    }
    return cycles;
}

std::string all_causes(const std::vector<CycleTimes> &cycles) {
    std::string text;
    for (const CycleCause &one : causes_of(figures_of(cycles, CYCLE_NS))) {
        EXPECT_NE(one.remedy, "");
        text += one.cause + "\n";
    }
    return text;
}

struct RecordFile : ::testing::Test {
    std::string board = "test-board-" + std::to_string(::getpid());
    Result<CycleRecordFile> file = CycleRecordFile::create(board, "10.0.0.2");
    CycleLog log{file->record()};

    ~RecordFile() override {
        for (const std::string &path : paths()) {
            std::filesystem::remove(path);
        }
    }
    std::vector<std::string> paths() const {
        auto all = find_cycle_records();
        std::erase_if(all, [&](const std::string &path) { return !path.ends_with(board); });
        return all;
    }
    RecordedCycles read() const {
        EXPECT_EQ(paths().size(), 1U);
        const auto cycles = read_cycle_record(paths().at(0));
        EXPECT_TRUE(cycles.has_value()) << cycles.error().str();
        return *cycles;
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            log.next().number = ++number;
        }
    }
    std::uint32_t number = 0;
};

TEST_F(RecordFile, HasTheLastCyclesOfARunningBoard) {
    log.set_period(CYCLE_NS);
    run(25'000);
    const RecordedCycles cycles = read();
    EXPECT_EQ(cycles.board, board);
    EXPECT_EQ(cycles.address, "10.0.0.2");
    EXPECT_EQ(cycles.period_ns, CYCLE_NS);
    EXPECT_EQ(cycles.fault, BoardFault::NONE);
    EXPECT_TRUE(cycles.at_fault.empty());
    ASSERT_GT(cycles.since.size(), 9'900U);
    EXPECT_EQ(cycles.since.back().number, 24'999U) << "the last may be in work";
    EXPECT_EQ(cycles.since.front().number + cycles.since.size() - 1, 24'999U);
}

TEST_F(RecordFile, KeepsTheCyclesBeforeAFault) {
    run(12'000);
    log.keep(BoardFault::WATCHDOG, 77);
    EXPECT_EQ(log.last().number, 12'000U) << "messages still need it";
    run(300);
    log.keep(BoardFault::STOPPED, 99);
    RecordedCycles cycles = read();
    EXPECT_EQ(cycles.fault, BoardFault::WATCHDOG) << "the second one is near: it hides nothing of the first";
    EXPECT_EQ(cycles.fault_ns, 77);
    EXPECT_EQ(cycles.at_fault.size(), CycleRing::SIZE);
    EXPECT_EQ(cycles.at_fault.back().number, 12'000U);
    run(10'000);
    log.keep(BoardFault::STOPPED, 123);
    cycles = read();
    EXPECT_EQ(cycles.fault, BoardFault::STOPPED);
    EXPECT_EQ(cycles.at_fault.back().number, 22'300U);
}

TEST_F(RecordFile, IsReplacedByTheNextLoad) {
    run(5);
    const auto next = CycleRecordFile::create(board, "10.0.0.3");
    ASSERT_TRUE(next.has_value());
    EXPECT_EQ(read().address, "10.0.0.3");
    EXPECT_TRUE(read().since.empty());
}

TEST_F(RecordFile, OfAnotherKindIsAnError) {
    std::ofstream(paths().at(0)) << "text";
    EXPECT_FALSE(read_cycle_record(paths().at(0)).has_value());
    EXPECT_FALSE(read_cycle_record("/dev/shm/there-is-no-such-record").has_value());
}

TEST(CycleReport, OfGoodCyclesHasNoCause) {
    const auto cycles = good_cycles(1000);
    EXPECT_EQ(all_causes(cycles), "") << "counters of packets run over";
    const CycleFigures figures = figures_of(cycles, CYCLE_NS);
    EXPECT_EQ(figures.answer.median_ns, 80'000);
    EXPECT_EQ(figures.gap.max_ns, CYCLE_NS);
    EXPECT_EQ(figures.failures(), 0U);
}

TEST(CycleReport, NamesAThreadThatIsLate) {
    auto cycles = good_cycles(1000);
    for (std::size_t i = 500; i < cycles.size(); ++i) {
        cycles[i].begin_ns += 3 * CYCLE_NS;
        cycles[i].sent_ns += 3 * CYCLE_NS;
        cycles[i].answered_ns += 3 * CYCLE_NS;
    }
    EXPECT_EQ(all_causes(cycles),
              "The thread began 1 cycles more than half a period late, the worst by 3000 us.\n");
}

TEST(CycleReport, TellsWhichWayPacketsWereLost) {
    auto cycles = good_cycles(1000);
    // Loses the request of one cycle, and the answer of another one.
    for (const std::size_t lost : {300U, 600U}) {
        cycles[lost].outcome = CycleOutcome::NO_ANSWER;
        cycles[lost].answered_ns = 0;
        cycles[lost].board_packets = 0;
    }
    for (std::size_t i = 301; i < cycles.size(); ++i) {
        cycles[i].board_packets = static_cast<std::uint16_t>(cycles[i].board_packets - 1);
    }
    cycles[600].board_packets = 0;
    EXPECT_EQ(all_causes(cycles), "1 packets did not reach the board.\n"
                                  "1 replies of the board were lost, or the board was off.\n");
}

TEST(CycleReport, NamesTheKernelAndLateAnswers) {
    auto cycles = good_cycles(1000);
    cycles[100].outcome = CycleOutcome::SEND_FAILED;
    cycles[100].error = ENETUNREACH;
    cycles[200].outcome = CycleOutcome::NO_ANSWER;
    cycles[200].answered_ns = 0;
    cycles[201].stale = 1;
    cycles[300].sent_ns += 600'000;
    cycles[300].answered_ns += 600'000;
    const std::string causes = all_causes(cycles);
    EXPECT_NE(causes.find("Network is unreachable"), std::string::npos) << causes;
    EXPECT_NE(causes.find("The kernel needed up to 610 us"), std::string::npos) << causes;
    EXPECT_NE(causes.find("1 answers came after the deadline."), std::string::npos) << causes;
}

}  // namespace
}  // namespace mw::mesa
