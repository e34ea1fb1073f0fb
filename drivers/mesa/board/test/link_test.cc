// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cerrno>

#include <gtest/gtest.h>

#include "drivers/mesa/board/board_transport.hh"
#include "drivers/mesa/board/test/host.hh"

namespace mw::mesa::board {
namespace {

FaultPlan faults_of(const std::string &text) {
    const auto plan = parse_faults(text, "f.txt");
    EXPECT_TRUE(plan.has_value()) << plan.error().str();
    return plan.value_or(FaultPlan{});
}

/// Results of a host with cycles of 1 ms: one read in each cycle, with a time limit of 0.8 ms.
struct Cycles {
    int answered = 0, late = 0, extra = 0;
    std::vector<int> lost;  ///< the cycles without an answer in time
};

Cycles run_cycles(Link &link, int count) {
    BoardTransport transport(link);
    Cycles cycles;
    std::array<std::byte, lbp16::MAX_PACKET_BYTES> bytes{};
    for (int i = 0; i < count; ++i) {
        transport.sleep_until(i * MS);
        while (transport.receive(bytes).isDone()) {
            ++cycles.extra;
        }
        lbp16::PacketWriter packet;
        packet.read_registers(0x0100, 1);
        transport.send(packet.bytes());
        const std::int64_t deadline_ns = i * MS + 800 * US;
        auto result = transport.receive(bytes);
        while (!result.isDone() && transport.now_ns() < deadline_ns) {
            transport.wait_until(deadline_ns);
            result = transport.receive(bytes);
        }
        if (result.isDone()) {
            ++cycles.answered;
        } else {
            EXPECT_EQ(result.error, EAGAIN);
            cycles.lost.push_back(i);
        }
    }
    return cycles;
}

Cycles cycles_with(const std::string &faults, int count) {
    Board board(model_of("7i76e"));
    Link link(board, faults_of(faults));
    return run_cycles(link, count);
}

TEST(BoardLink, WithoutFaultsEachRequestIsAnsweredAtOnce) {
    const Cycles cycles = cycles_with("", 1000);
    EXPECT_EQ(cycles.answered, 1000);
    EXPECT_EQ(cycles.extra, 0);
}

TEST(BoardLink, LossHasItsProbabilityAndItsSeed) {
    const Cycles cycles = cycles_with("seed 7\nto_board loss=0.05\nto_host loss=0.05", 20'000);
    EXPECT_NEAR(static_cast<double>(cycles.lost.size()), 20'000 * 0.0975, 200);
    EXPECT_EQ(cycles.lost, cycles_with("seed 7\nto_board loss=0.05\nto_host loss=0.05", 20'000).lost);
    EXPECT_NE(cycles.lost, cycles_with("seed 8\nto_board loss=0.05\nto_host loss=0.05", 20'000).lost);
}

TEST(BoardLink, FaultsBeginAtTheirTime) {
    const Cycles cycles = cycles_with("to_board loss=1 start_ms=5000", 10'000);
    EXPECT_NEAR(cycles.answered, 5000, 1);
}

TEST(BoardLink, DuplicatesArriveTwice) {
    const Cycles cycles = cycles_with("to_host duplicate=0.1", 10'000);
    EXPECT_EQ(cycles.answered, 10'000);
    EXPECT_NEAR(cycles.extra, 1000, 150);
}

TEST(BoardLink, DelaysAndBursts) {
    EXPECT_EQ(cycles_with("to_board delay_us=300\nto_host delay_us=499", 100).answered, 100);
    EXPECT_EQ(cycles_with("to_board delay_us=300\nto_host delay_us=501", 100).answered, 0);
    const Cycles bursts = cycles_with("seed 3\nto_board burst=0.01 burst_packets=5", 10'000);
    EXPECT_GT(bursts.lost.size(), 300U);
    EXPECT_EQ(bursts.lost[1], bursts.lost[0] + 1);
    EXPECT_EQ(bursts.lost[4], bursts.lost[0] + 4);
}

TEST(BoardLink, ReorderedPacketsAreOvertaken) {
    FaultyDirection direction(faults_of("to_board reorder=0.5").to_board, 1);
    std::vector<std::int64_t> times;
    for (int i = 0; i < 100; ++i) {
        times.push_back(direction.pass({std::byte{1}}, i * 100 * US, 0)[0].time_ns);
    }
    EXPECT_FALSE(std::ranges::is_sorted(times));
    FaultyDirection jitter(faults_of("to_board jitter_us=500").to_board, 1);
    times.clear();
    for (int i = 0; i < 100; ++i) {
        times.push_back(jitter.pass({std::byte{1}}, i * 100 * US, 0)[0].time_ns);
    }
    EXPECT_TRUE(std::ranges::is_sorted(times)) << "a delay alone keeps the order";
}

TEST(BoardLink, CutPacketsAreErrorsOfTheBoard) {
    Board board(model_of("7i76e"));
    Link link(board, faults_of("to_board cut=0.5"));
    const Cycles cycles = run_cycles(link, 1000);
    EXPECT_NEAR(cycles.answered, 500, 100);
    EXPECT_GT(board.control(ControlAddress::PARSE_ERRORS), 200);
}

TEST(BoardLink, EventsHappenAtTheirTimes) {
    Board board(model_of("7i76e"));
    Link link(board, faults_of("event link_down at_ms=10 duration_ms=5\n"
                               "event power_off at_ms=30 duration_ms=3\n"
                               "event second_host at_ms=50 duration_ms=10 period_us=500\n"));
    const Cycles cycles = run_cycles(link, 100);
    EXPECT_EQ(cycles.lost, (std::vector<int>{10, 11, 12, 13, 14, 30, 31, 32}));
    EXPECT_EQ(link.counts().executed, 95U + 20U);
    EXPECT_EQ(board.control(ControlAddress::RECEIVED_PACKETS), 67 + 20) << "counted since power-up at 33 ms";
}

TEST(BoardLink, AForcedBiteClearsTheOutputs) {
    Host host;
    host.enable_port0();
    Link link(host.board, faults_of("event watchdog at_ms=3"));
    link.run_until(2 * MS);
    host.time_ns = 2 * MS;
    EXPECT_EQ(host.read(0x1100), 0x03FFU);
    link.run_until(4 * MS);
    host.time_ns = 4 * MS;
    EXPECT_EQ(host.read(0x1100), 0U);
}

TEST(BoardFaults, ErrorsNameFileLineAndColumn) {
    const auto error = [](const std::string &text) {
        const auto plan = parse_faults(text, "f.txt");
        return plan.has_value() ? "" : plan.error().str();
    };
    EXPECT_EQ(error("seed x"), "f.txt:1:1: 'x' is not a seed: a whole number.");
    EXPECT_EQ(error("to_board loss=2"), "f.txt:1:10: loss=2 is not a number from 0 to 1.");
    EXPECT_EQ(error("\nto_moon loss=1"),
              "f.txt:2:1: Unknown line 'to_moon', expected seed, to_board, to_host or event.");
    EXPECT_EQ(error("event fire at_ms=1"),
              "f.txt:1:1: 'fire' is not one of reset, power_off, watchdog, link_down, second_host.");
    EXPECT_EQ(error("event reset at_ms=1 duration_ms=3"), "f.txt:1:21: 'event' has no value 'duration_ms'.");
    EXPECT_EQ(error("event power_off at_ms=1"), "f.txt:1:1: 'event' needs duration_ms=VALUE.");
}

TEST(BoardPhysics, ErrorsNameFileLineAndColumn) {
    const auto error = [](const std::string &text) {
        const auto plan = parse_physics(text, "p.txt", model_of("7i76e").idrom);
        return plan.has_value() ? "" : plan.error().str();
    };
    EXPECT_EQ(error("motor x stepgen=5 steps_per_rev=200"),
              "p.txt:1:9: stepgen=5 is not a whole number from 0 to 4.");
    EXPECT_EQ(error("motor x pwm=0 full_rev_s=1"), "p.txt:1:9: The board has no module 'pwm'.");
    EXPECT_EQ(error("motor x stepgen=0 steps_per_rev=200\nencoder 1 motor=x counts_per_rev=400"),
              "p.txt:2:1: The board has no encoder '1': it has 1.");
    EXPECT_EQ(error("motor x stepgen=0 steps_per_rev=200\nencoder 0 motor=y counts_per_rev=400"),
              "p.txt:2:11: motor=y is not one of x.");
    EXPECT_EQ(error("motor x stepgen=0 steps_per_rev=200\nswitch 51 motor=x below_rev=0"),
              "p.txt:2:1: The board has no pin '51': it has 51.");
    EXPECT_EQ(error("brake z"), "p.txt:1:1: Unknown line 'brake', expected motor, encoder, switch, resolver, "
                                "field, panel or remote.");
}

}  // namespace
}  // namespace mw::mesa::board
