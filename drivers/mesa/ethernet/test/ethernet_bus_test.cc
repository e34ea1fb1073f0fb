// SPDX-License-Identifier: GPL-2.0-or-later
#include <cerrno>
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/identity/idrom.hh"
#include "drivers/mesa/lbp16/memory_transport.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::mesa {
namespace {

using lbp16::MemoryTransport;
using lbp16::Passage;
using lbp16::Space;

constexpr long PERIOD_NS = 1'000'000;

/// A 7I76E in memory, with a bus that reads two registers at 0x1000 and one at 0x3000.
struct Bench {
    MemoryTransport *board = nullptr;
    std::unique_ptr<EthernetBus> bus;
    std::array<std::uint32_t, 3> values{};

    Bench() {
        auto transport = std::make_unique<MemoryTransport>();
        board = transport.get();
        const std::array<std::uint16_t, 8> name{0x4937, 0x3637, 0x2D45, 0x3631};
        board->set_words(Space::BOARD, 0, name);
        board->set_register(COOKIE_ADDRESS, COOKIE);
        board->set_register(IDROM_OFFSET_ADDRESS, 0x400);
        board->set_register(0x400, 3);
        auto opened = EthernetBus::open(std::move(transport), "10.0.0.2");
        EXPECT_TRUE(opened.has_value()) << (opened ? "" : opened.error().str());
        bus = std::move(*opened);
        const std::array<RegisterRange, 2> reads{{{0x1000, 2}, {0x3000, 1}}};
        const auto set = bus->set_lists(reads, 100);
        EXPECT_TRUE(set.has_value());
        board->requests = 0;
        board->written.clear();
    }
    CycleRead read() {
        board->advance(PERIOD_NS);
        return bus->read(values, PERIOD_NS);
    }
    /// Faults of the packets from now on, by number.
    void disturb_requests(std::function<Passage(std::size_t)> passage) {
        board->to_board = [passage = std::move(passage), n = std::size_t{0}](std::size_t) mutable {
            return passage(n++);
        };
    }
    void disturb_answers(std::function<Passage(std::size_t)> passage) {
        board->from_board = [passage = std::move(passage), n = std::size_t{0}](std::size_t) mutable {
            return passage(n++);
        };
    }
    void lose_answers() {
        disturb_answers([](std::size_t) { return Passage{.copies = 0}; });
    }
};

TEST(EthernetBus, KnowsTheCard) {
    Bench bench;
    EXPECT_EQ(bench.bus->reported_name(), "7I76E-16");
    EXPECT_EQ(bench.bus->card_name(), "7i76e");
    EXPECT_EQ(bench.bus->connectors(), (std::vector<std::string>{"on card", "P1", "P2"}));
    EXPECT_EQ(bench.bus->port_width(), 17);
}

TEST(EthernetBus, ABoardThatDoesNotAnswerIsAnErrorWithItsAddress) {
    auto transport = std::make_unique<MemoryTransport>();
    transport->from_board = [](std::size_t) { return Passage{.copies = 0}; };
    const auto opened = EthernetBus::open(std::move(transport), "10.0.0.9");
    ASSERT_FALSE(opened.has_value());
    EXPECT_NE(opened.error().message.find("10.0.0.9"), std::string::npos);
}

TEST(EthernetBus, ACycleIsOneRequestAndOneWrite) {
    Bench bench;
    bench.board->set_register(0x1000, 11);
    bench.board->set_register(0x1004, 12);
    bench.board->set_register(0x3000, 13);
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_EQ(bench.values, (std::array<std::uint32_t, 3>{11, 12, 13}));
    const std::array<RegisterWrite, 4> writes{{{0x2000, 1}, {0x2004, 2}, {0x2100, 3}, {0x0E00, 0x5A000000}}};
    EXPECT_TRUE(bench.bus->write(writes));
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_EQ(bench.board->requests, 3U);
    EXPECT_EQ(bench.board->written, (std::vector<MemoryTransport::Written>{
                                        {0x2000, 1}, {0x2004, 2}, {0x2100, 3}, {0x0E00, 0x5A000000}}));
    EXPECT_FALSE(bench.bus->take_rewrite());
    EXPECT_EQ(bench.bus->errors().total(), 0U);
}

TEST(EthernetBus, ARangeOfOneRegisterCanBeRedirected) {
    Bench bench;
    bench.board->set_register(0x1000, 11);
    bench.board->set_register(0x3000, 13);
    bench.board->set_register(0x4568, 99);
    EXPECT_FALSE(bench.bus->redirect(0, 0x4568)) << "two registers";
    EXPECT_FALSE(bench.bus->redirect(2, 0x4568)) << "no such range";
    EXPECT_TRUE(bench.bus->redirect(1, 0x4568));
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_EQ(bench.values, (std::array<std::uint32_t, 3>{11, 0, 99}));
}

TEST(EthernetBus, ADescriptionOutsideTheRegistersIsAnError) {
    for (const std::uint32_t address : {0x10000U, 0xFFFCU, 0x0401U}) {
        auto transport = std::make_unique<MemoryTransport>();
        transport->set_register(COOKIE_ADDRESS, COOKIE);
        transport->set_register(IDROM_OFFSET_ADDRESS, address);
        const auto opened = EthernetBus::open(std::move(transport), "10.0.0.2");
        ASSERT_FALSE(opened.has_value()) << address;
        EXPECT_NE(opened.error().message.find("outside the registers"), std::string::npos)
            << opened.error().message;
    }
}

TEST(EthernetBus, AnEarlyRequestIsTheRequestOfTheCycle) {
    Bench bench;
    bench.bus->request();
    bench.bus->request();
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_EQ(bench.board->requests, 1U);
}

TEST(EthernetBus, ALostAnswerIsCountedAndAsksForARewrite) {
    Bench bench;
    bench.board->set_register(0x1000, 5);
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    bench.disturb_answers([](std::size_t n) { return Passage{.copies = n == 0 ? 0 : 1}; });
    bench.board->set_register(0x1000, 6);
    EXPECT_EQ(bench.read(), CycleRead::FAILED);
    EXPECT_EQ(bench.values[0], 5U) << "no value of a failed cycle is new";
    EXPECT_TRUE(bench.bus->isFailed());
    EXPECT_TRUE(bench.bus->take_rewrite());
    EXPECT_EQ(bench.bus->counters().no_answer, 1U);
    EXPECT_EQ(bench.bus->last_cycle()->outcome, CycleOutcome::NO_ANSWER);
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_FALSE(bench.bus->isFailed());
}

TEST(EthernetBus, ALateAnswerIsNotTakenForTheNextOne) {
    Bench bench;
    bench.disturb_answers([](std::size_t n) { return Passage{.delay_ns = n == 0 ? 900'000 : 0}; });
    bench.board->set_register(0x1000, 1);
    EXPECT_EQ(bench.read(), CycleRead::FAILED);
    bench.board->set_register(0x1000, 2);
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_EQ(bench.values[0], 2U);
    EXPECT_EQ(bench.bus->counters().stale, 1U);
}

TEST(EthernetBus, ADoubledAnswerIsNoFailure) {
    Bench bench;
    bench.disturb_answers([](std::size_t) { return Passage{.copies = 2}; });
    for (std::uint32_t i = 0; i < 100; ++i) {
        bench.board->set_register(0x1000, i);
        EXPECT_EQ(bench.read(), CycleRead::DONE);
        EXPECT_EQ(bench.values[0], i);
    }
    EXPECT_EQ(bench.bus->errors().total(), 0U);
}

TEST(EthernetBus, ALostWriteIsSeenInTheNextCycle) {
    Bench bench;
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    bench.disturb_requests([](std::size_t n) { return Passage{.copies = n == 0 ? 0 : 1}; });
    const std::array<RegisterWrite, 1> writes{{{0x2000, 7}}};
    EXPECT_TRUE(bench.bus->write(writes));
    EXPECT_EQ(bench.read(), CycleRead::DONE) << "its values are of this cycle";
    EXPECT_TRUE(bench.bus->isFailed());
    EXPECT_EQ(bench.bus->counters().write_lost, 1U);
    EXPECT_TRUE(bench.bus->take_rewrite());
    EXPECT_TRUE(bench.bus->write(writes));
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_FALSE(bench.bus->isFailed());
}

TEST(EthernetBus, ASendThatTheKernelRefusesIsCountedWithItsError) {
    Bench bench;
    bench.disturb_requests([](std::size_t n) { return Passage{.error = n == 0 ? ENETUNREACH : 0}; });
    EXPECT_EQ(bench.read(), CycleRead::FAILED);
    EXPECT_EQ(bench.bus->counters().send_failed, 1U);
    EXPECT_EQ(bench.bus->last_cycle()->error, ENETUNREACH);
    EXPECT_EQ(bench.read(), CycleRead::DONE);
}

TEST(EthernetBus, AWriteLargerThanAPacketIsDividedAndEachPartIsChecked) {
    Bench bench;
    const std::array<RegisterRange, 1> reads{{{0x1000, 1}}};
    ASSERT_TRUE(bench.bus->set_lists(reads, 400).has_value());
    std::vector<RegisterWrite> writes;
    for (std::uint32_t i = 0; i < 400; ++i) {
        writes.push_back({static_cast<std::uint16_t>(0x2000 + 8 * i), i});
    }
    for (std::size_t lost = 0; lost < 3; ++lost) {
        EXPECT_EQ(bench.read(), CycleRead::DONE);
        bench.disturb_requests([lost](std::size_t n) { return Passage{.copies = n == lost ? 0 : 1}; });
        EXPECT_TRUE(bench.bus->write(writes));
        bench.read();
        EXPECT_EQ(bench.bus->counters().write_lost, lost + 1);
        EXPECT_TRUE(bench.bus->write(writes));
    }
    bench.read();
    bench.board->written.clear();
    EXPECT_TRUE(bench.bus->write(writes));
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    ASSERT_EQ(bench.board->written.size(), 400U);
    for (std::uint32_t i = 0; i < 400; ++i) {
        EXPECT_EQ(bench.board->written[i].value, i);
    }
}

TEST(EthernetBus, ListsThatDoNotFitAreRefusedAtTheLoad) {
    Bench bench;
    const std::vector<RegisterRange> many(4, RegisterRange{0x1000, 100});
    EXPECT_FALSE(bench.bus->set_lists(many, 10).has_value());
    const std::array<RegisterRange, 1> one{{{0x1000, 1}}};
    EXPECT_FALSE(bench.bus->set_lists(one, 1000).has_value());
}

TEST(EthernetBus, TooManyFailuresStopAllTrafficUntilAnOperatorResetsThem) {
    Bench bench;
    bench.lose_answers();
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(bench.read(), CycleRead::FAILED);
    }
    EXPECT_EQ(bench.read(), CycleRead::STOPPED);
    bench.disturb_answers([](std::size_t) { return Passage{}; });
    const std::size_t before = bench.board->requests;
    const std::array<RegisterWrite, 1> writes{{{0x2000, 7}}};
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(bench.read(), CycleRead::STOPPED);
        EXPECT_FALSE(bench.bus->write(writes));
    }
    EXPECT_EQ(bench.board->requests, before);
    bench.bus->resume();
    EXPECT_EQ(bench.read(), CycleRead::FAILED) << "the board is compared first";
    EXPECT_TRUE(bench.board->written.empty());
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_TRUE(bench.bus->take_rewrite());
    EXPECT_TRUE(bench.bus->write(writes));
    EXPECT_EQ(bench.read(), CycleRead::DONE);
}

TEST(EthernetBus, AnotherBoardAfterAFaultIsNotWritten) {
    Bench bench;
    bench.bus->stop();
    bench.board->set_register(0x0410, 0x12345678);
    bench.bus->resume();
    EXPECT_EQ(bench.read(), CycleRead::STOPPED);
    EXPECT_EQ(bench.bus->last_cycle()->outcome, CycleOutcome::OTHER_BOARD);
    EXPECT_TRUE(bench.bus->isStopped());
    EXPECT_TRUE(bench.board->written.empty());
}

TEST(EthernetBus, ABoardThatWasSwitchedOffIsServedAgainAfterTheReset) {
    Bench bench;
    const std::array<RegisterWrite, 1> writes{{{0x2000, 7}}};
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_TRUE(bench.bus->write(writes));
    bench.bus->stop();
    const std::array<std::uint16_t, 8> cleared{};
    bench.board->set_words(Space::TIMERS, HostNumbers::ADDRESS, cleared);
    bench.bus->resume();
    bench.read();
    EXPECT_EQ(bench.read(), CycleRead::DONE);
    EXPECT_FALSE(bench.bus->isFailed());
}

TEST(EthernetBus, CyclesDoNotAllocate) {
    Bench bench;
    const std::array<RegisterWrite, 1> writes{{{0x2000, 7}}};
    // The board in memory allocates for each packet that arrives; without packets only the bus runs.
    bench.disturb_requests([](std::size_t) { return Passage{.error = ENOBUFS}; });
    bench.bus->settings.error_limit = 1'000'000;
    const testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        bench.read();
        bench.bus->write(writes);
    }
    EXPECT_EQ(guard.calls(), 0U);
}

/// Packets are lost, late or duplicated. The values of a cycle belong to this cycle, a lost write is detected
/// in the next good cycle, and the counts agree.
TEST(EthernetBus, KeepsItsPromisesOnABadNetwork) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        std::mt19937 rng(seed);
        std::bernoulli_distribution bad(0.05);
        std::uniform_int_distribution<std::int64_t> delay_ns(0, 2'000'000);
        Bench bench;
        bench.bus->settings.error_limit = 1'000'000'000;
        const auto passage = [&](std::size_t) {
            return Passage{.copies = bad(rng) ? 0 : (bad(rng) ? 2 : 1),
                           .delay_ns = bad(rng) ? delay_ns(rng) : 0};
        };
        bool write_lost = false;
        bool writing = false;
        bench.board->to_board = [&](std::size_t n) {
            Passage result = passage(n);
            if (writing) {
                result.delay_ns = 0;
                write_lost = result.copies == 0;
            }
            return result;
        };
        bench.board->from_board = passage;
        std::uint32_t failures = 0;
        for (std::uint32_t i = 1; i <= 30'000; ++i) {
            bench.board->set_register(0x1000, i);
            const CycleRead read = bench.read();
            failures += bench.bus->isFailed() ? 1U : 0U;
            if (read == CycleRead::DONE) {
                ASSERT_EQ(bench.values[0], i) << "seed " << seed;
                ASSERT_EQ(bench.bus->isFailed(), write_lost) << "seed " << seed << " cycle " << i;
            }
            writing = true;
            const std::array<RegisterWrite, 1> writes{{{0x2000, i}}};
            bench.bus->write(writes);
            writing = false;
        }
        EXPECT_EQ(bench.bus->errors().total(), failures);
        EXPECT_GT(failures, 1000U);
        EXPECT_GT(bench.bus->counters().stale, 100U);
    }
}

}  // namespace
}  // namespace mw::mesa
