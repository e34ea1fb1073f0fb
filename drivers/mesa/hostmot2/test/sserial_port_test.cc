// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the state of a smart serial port with a simulated processor, in virtual time.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/mesa/hostmot2/modules/sserial_port.hh"

namespace mw::mesa::test {
namespace {

class PortOfSmartSerial : public ::testing::Test {
  protected:
    static constexpr std::int64_t PERIOD_NS = 1'000'000, WRITE_NS = 100'000;

    /// A read in which the last command is complete, or still active.
    void read() {
        now_ns += PERIOD_NS - WRITE_NS;
        SserialReading reading;
        reading.command = done_ns > now_ns ? command : 0;
        const bool is_exchange = (command & 0x1000U) != 0;
        reading.failed = is_exchange && !started ? command & 0xFFU : failed;
        reading.now_ns = now_ns;
        fresh = port.read(pins, reading);
    }
    void write(bool writing = true) {
        now_ns += WRITE_NS;
        const SserialCommand sent = port.write(pins, {now_ns, 1e-3, writing});
        outputs = port.take_outputs();
        if (sent.isDue && !next_lost) {
            command = sent.command;
            done_ns = now_ns + exchange_ns;
            started = (command & 0xF00U) == 0x900U || (started && command != 0x8FFU);
            sent_commands.push_back(command);
        }
        next_lost = next_lost && !sent.isDue;
        const SserialEvents event = port.take_event();
        if (event.type != SserialEvents::Type::NONE) {
            events.push_back(event);
        }
    }
    void cycle(int count = 1) {
        for (int i = 0; i < count; ++i) {
            read();
            write();
        }
    }
    void start() {
        cycle(30);
        ASSERT_EQ(pins.port_state, 3U);
        sent_commands.clear();
    }

    SserialPortPins pins;
    SserialPortControl port{0b11};
    std::int64_t now_ns = 0, done_ns = 0, exchange_ns = 150'000;
    std::uint32_t command = 0, failed = 0, fresh = 0;
    bool started = false, next_lost = false;
    SserialOutputs outputs = SserialOutputs::KEPT;
    std::vector<std::uint32_t> sent_commands;
    std::vector<SserialEvents> events;
};

TEST_F(PortOfSmartSerial, StartsTheCardsAndExchangesInEachCycle) {
    cycle(5);
    EXPECT_EQ(sent_commands, std::vector<std::uint32_t>{0x8FF})
        << "the pins of the port become outputs before a start";
    cycle(25);
    ASSERT_GE(sent_commands.size(), 10U);
    EXPECT_EQ(sent_commands[1], 0x903U);
    EXPECT_EQ(sent_commands[2], 0x1003U);
    EXPECT_EQ(fresh, 0b11U);
    EXPECT_EQ(pins.fault_count, 0U);
    EXPECT_TRUE(events.empty());
    const std::size_t before = sent_commands.size();
    cycle(100);
    EXPECT_EQ(sent_commands.size(), before + 100);
}

TEST_F(PortOfSmartSerial, AFaultNowAndThenIsCountedAndForgotten) {
    start();
    failed = 1;
    cycle();
    EXPECT_EQ(pins.fault_count, 10U);
    EXPECT_EQ(fresh, 0b10U) << "the other card has new data";
    failed = 0;
    cycle(5);
    EXPECT_EQ(pins.fault_count, 5U);
    for (int i = 0; i < 500; ++i) {
        failed = i % 12 == 0 ? 1U : 0U;
        cycle();
    }
    EXPECT_EQ(pins.port_state, 3U) << "one fault in 12 exchanges never stops the port";
    EXPECT_TRUE(events.empty());
}

TEST_F(PortOfSmartSerial, RecoversFromManyFaultsWithinASecond) {
    start();
    failed = 2;
    cycle(20);
    EXPECT_TRUE(pins.fault);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].type, SserialEvents::Type::FAULT);
    EXPECT_EQ(events[0].channels, 2U);
    failed = 0;
    int cycles = 0;
    while (pins.fault && cycles < 1000) {
        cycle();
        ++cycles;
    }
    EXPECT_LT(cycles, 200);
    EXPECT_EQ(pins.port_state, 3U);
    EXPECT_EQ(pins.fault_count, 0U);
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(events[1].type, SserialEvents::Type::RECOVERED);
    EXPECT_NE(std::ranges::find(sent_commands, 0x8FFU), sent_commands.end());
}

TEST_F(PortOfSmartSerial, ACardThatStaysAwayGivesOneMessage) {
    start();
    failed = 1;
    cycle(20'000);
    EXPECT_EQ(events.size(), 1U);
    EXPECT_TRUE(pins.fault);
    failed = 0;
    cycle(400);
    EXPECT_FALSE(pins.fault) << "it comes back";
    EXPECT_EQ(events.size(), 2U);
}

TEST_F(PortOfSmartSerial, ALostStartIsRepeatedWithoutAFault) {
    next_lost = true;
    cycle(100);
    EXPECT_EQ(pins.port_state, 3U);
    EXPECT_TRUE(started);
    EXPECT_EQ(pins.fault_count, 0U);
    EXPECT_TRUE(events.empty());
}

TEST_F(PortOfSmartSerial, AThreadThatWasLateIsNoFault) {
    start();
    exchange_ns = 200'000;
    // A late write, and a read soon after it.
    read();
    write();
    now_ns -= PERIOD_NS - WRITE_NS - 50'000;
    read();
    write();
    cycle(3);
    EXPECT_EQ(pins.fault_count, 0U);
    EXPECT_TRUE(events.empty());
}

TEST_F(PortOfSmartSerial, AWritePacketThatArrivedLateIsNoFault) {
    start();
    for (int i = 0; i < 100; ++i) {
        exchange_ns = i % 10 == 0 ? 950'000 : 150'000;
        cycle();
    }
    EXPECT_EQ(pins.fault_count, 0U);
    EXPECT_TRUE(events.empty());
}

TEST_F(PortOfSmartSerial, AnExchangeLongerThanThePeriodIsReportedWithItsTime) {
    start();
    exchange_ns = 1'200'000;
    cycle(10);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].type, SserialEvents::Type::LATE);
    EXPECT_LE(events[0].shortest_ns, exchange_ns);
    EXPECT_GE(events[0].longest_ns, exchange_ns);
    EXPECT_GT(pins.fault_count, 0U);
    const auto exchanges = std::ranges::count(sent_commands, 0x1003U);
    EXPECT_LE(exchanges, 6) << "no exchange is requested while one is in work";
}

TEST_F(PortOfSmartSerial, AProcessorThatHangsIsStoppedAndStartedAgain) {
    start();
    exchange_ns = 1'000'000'000'000;
    cycle(50);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].type, SserialEvents::Type::FAULT);
    EXPECT_EQ(events[0].channels, 0U);
    exchange_ns = 150'000;
    cycle(800);
    EXPECT_EQ(pins.port_state, 3U);
    EXPECT_EQ(events.size(), 2U);
}

TEST_F(PortOfSmartSerial, RunStopsItAndReleasesHeldOutputs) {
    start();
    pins.run = false;
    write();
    EXPECT_EQ(outputs, SserialOutputs::RELEASED);
    EXPECT_EQ(sent_commands.back(), 0x8FFU);
    EXPECT_EQ(pins.port_state, 0U);
    const std::size_t before = sent_commands.size();
    cycle(50);
    EXPECT_EQ(sent_commands.size(), before);
    pins.run = true;
    cycle(30);
    EXPECT_EQ(pins.port_state, 3U);
}

TEST_F(PortOfSmartSerial, AfterAGapWithoutWritesTheCardsAreStartedAgain) {
    start();
    for (int i = 0; i < 100; ++i) {
        read();
        write(false);
    }
    EXPECT_TRUE(sent_commands.empty());
    cycle(40);
    EXPECT_EQ(pins.port_state, 3U);
    EXPECT_EQ(sent_commands[0], 0x8FFU);
    EXPECT_EQ(sent_commands[1], 0x903U);
    EXPECT_TRUE(events.empty());
}

TEST_F(PortOfSmartSerial, WithoutAnIncrementNothingStops) {
    pins.fault_inc = 0;
    start();
    failed = 1;
    cycle(1000);
    EXPECT_EQ(pins.port_state, 3U);
}

}  // namespace
}  // namespace mw::mesa::test
