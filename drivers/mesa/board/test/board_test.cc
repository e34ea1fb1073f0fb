// SPDX-License-Identifier: GPL-2.0-or-later
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/board/test/host.hh"

namespace mw::mesa::board {
namespace {

using lbp16::Space;
using lbp16::Unit;

TEST(Board, ReportsTheIdromOfItsModel) {
    for (const BuiltInModel &one : built_in_models()) {
        Host host{std::string(one.name)};
        const auto idrom =
            decode_idrom([&](std::uint16_t address, int count) -> Result<std::vector<std::uint32_t>> {
                lbp16::PacketWriter packet;
                EXPECT_TRUE(packet.read_registers(address, count));
                const auto reply = host.board.execute(packet.bytes(), 0);
                std::vector<std::uint32_t> words;
                for (std::size_t i = 0; i < reply->bytes.size(); i += 4) {
                    words.push_back(lbp16::number_at<std::uint32_t>(std::span(reply->bytes).subspan(i)));
                }
                return words;
            });
        ASSERT_TRUE(idrom.has_value()) << idrom.error().str();
        EXPECT_EQ(*idrom, model_of(std::string(one.name)).idrom);
    }
}

TEST(Board, ReadsOfOnePacketAreJoinedInTheirOrder) {
    Host host;
    lbp16::PacketWriter packet;
    ASSERT_TRUE(packet.read({.incrementing = false, .units = 2, .address = 0x0100}));
    ASSERT_TRUE(packet.read({.space = Space::BOARD, .unit = Unit::BITS_16, .units = 8}));
    ASSERT_TRUE(packet.write_register(0x1000, 5));
    const auto reply = host.board.execute(packet.bytes(), 0);
    ASSERT_TRUE(reply.has_value());
    ASSERT_EQ(reply->bytes.size(), 24U);
    const auto at = [&](std::size_t i) {
        return lbp16::number_at<std::uint32_t>(std::span(reply->bytes).subspan(i));
    };
    EXPECT_EQ(at(0), COOKIE);
    EXPECT_EQ(at(4), COOKIE) << "the address does not move";
    EXPECT_EQ(at(8), 0x36374937U) << "7I76";
    EXPECT_EQ(at(12), 0x36312D45U) << "E-16";
}

TEST(Board, TheStoredPointerContinuesWhereTheLastCommandEnded) {
    Host host;
    lbp16::PacketWriter packet;
    ASSERT_TRUE(packet.read({.units = 1, .address = 0x0104}));
    ASSERT_TRUE(packet.read({.addressed = false, .units = 1}));
    const auto reply = host.board.execute(packet.bytes(), 0);
    ASSERT_EQ(reply->bytes.size(), 8U);
    EXPECT_EQ(std::string(reinterpret_cast<const char *>(reply->bytes.data()), 8), "HOSTMOT2");
}

TEST(Board, InformationAreasHaveTheValuesOfRealBoards) {
    Host host;
    const std::pair<std::uint16_t, std::uint16_t> known[] = {
        {0x8104, 0x0010}, {0x8102, 0x0008}, {0x8E02, 0x0007}, {0x8F04, 0x8215},
        {0x8202, 0x0004}, {0, 0},           {0x8202, 0x0004}, {0x0202, 0x0004}};
    for (unsigned space = 0; space < 8; ++space) {
        lbp16::PacketWriter packet;
        ASSERT_TRUE(packet.read(
            {.information = true, .space = static_cast<Space>(space), .unit = Unit::BITS_16, .units = 8}));
        const auto reply = host.board.execute(packet.bytes(), 0);
        ASSERT_EQ(reply->bytes.size(), 16U);
        const auto word = [&](std::size_t i) { return word_at(reply->bytes, 2 * i); };
        EXPECT_EQ(word(0), space == 5 ? 0 : 0x5A00 + space);
        EXPECT_EQ(word(1), known[space].first);
        EXPECT_EQ(word(2), known[space].second);
    }
}

TEST(Board, ErrorsStopThePacketAndAreCounted) {
    Host host;
    lbp16::PacketWriter packet;
    ASSERT_TRUE(packet.write_register(0x1000, 5));
    ASSERT_TRUE(packet.read({.unit = Unit::BITS_16, .address = 0x0100}));  // registers have 32 bits
    ASSERT_TRUE(packet.write_register(0x1000, 7));
    EXPECT_FALSE(host.board.execute(packet.bytes(), 0).has_value());
    EXPECT_EQ(host.board.control(ControlAddress::MEMORY_ERRORS), 1);
    host.write(0x1100, 0x1FFFF);
    EXPECT_EQ(host.read(0x1000) & 7U, 5U) << "what came before the error was done, what came after was not";
    const auto broken = std::to_array<std::byte>({std::byte{1}, std::byte{0xC2}, std::byte{0}});
    EXPECT_FALSE(host.board.execute(broken, 0).has_value());
    EXPECT_EQ(host.board.control(ControlAddress::PARSE_ERRORS), 1);
    host.write16(Space::BOARD, 0, 1);
    EXPECT_EQ(host.board.control(ControlAddress::WRITE_ERRORS), 1);
    EXPECT_EQ(host.read16(Space::CONTROL, 0), 7) << "parse, memory and write";
}

TEST(Board, TheEepromNeedsAKeyForEachWrite) {
    Host host;
    EXPECT_EQ(host.read16(Space::EEPROM, 0x20), 0x0179);
    host.write16(Space::EEPROM, 0x20, 0x017A);
    EXPECT_EQ(host.read16(Space::EEPROM, 0x20), 0x0179);
    host.write16(Space::CONTROL, 0x1A, 0x5A02);
    host.write16(Space::EEPROM, 0x20, 0x017A);
    host.write16(Space::EEPROM, 0x20, 0x017B);
    EXPECT_EQ(host.read16(Space::EEPROM, 0x20), 0x017A);
    EXPECT_EQ(host.board.control(ControlAddress::WRITE_ERRORS), 2);
}

TEST(Board, FlashIsErasedAndWrittenWithTheKey) {
    Host host;
    const auto write = [&](std::uint16_t address, std::uint32_t value, bool has_key) {
        if (has_key) {
            host.write16(Space::CONTROL, 0x1A, 0x5A03);
        }
        lbp16::PacketWriter packet;
        EXPECT_TRUE(
            packet.write({.writes = true, .incrementing = false, .space = Space::FLASH, .address = address},
                         lbp16::bytes_of_number(value)));
        host.board.execute(packet.bytes(), 0);
    };
    const auto data_at = [&](std::uint32_t address) {
        write(0, address, false);
        lbp16::PacketWriter packet;
        EXPECT_TRUE(packet.read({.incrementing = false, .space = Space::FLASH, .address = 4}));
        return lbp16::number_at<std::uint32_t>(host.board.execute(packet.bytes(), 0)->bytes);
    };
    write(0, 0x10000, false);
    write(4, 0x12345678, false);
    EXPECT_EQ(data_at(0x10000), 0xFFFFFFFFU) << "no key";
    write(0, 0x10000, false);
    write(4, 0x12345678, true);
    EXPECT_EQ(data_at(0x10000), 0x12345678U);
    write(0, 0x10000, false);
    write(0xC, 0, true);
    EXPECT_EQ(data_at(0x10000), 0xFFFFFFFFU);
}

TEST(Board, TimerWordsKeepTheNumbersOfTheHostAndAResetClearsThem) {
    Host host;
    host.time_ns = 70'000'000;
    host.write16(Space::TIMERS, 0x14, 0x1234);
    EXPECT_EQ(host.read16(Space::TIMERS, 0x14), 0x1234);
    EXPECT_EQ(host.read16(Space::TIMERS, 0), 70'000 & 0xFFFF);
    host.write(0x0200, 0x80000000);
    host.write16(Space::CONTROL, 0x1C, 1);
    EXPECT_EQ(host.read16(Space::TIMERS, 0x14), 0);
    EXPECT_EQ(host.read(0x0200), 0U);
}

TEST(Board, WithoutPowerItDoesNotAnswer) {
    Host host;
    host.board.restart(10 * MS, 5 * MS);
    host.time_ns = 14 * MS;
    lbp16::PacketWriter packet;
    ASSERT_TRUE(packet.read_registers(0x0100, 1));
    EXPECT_FALSE(host.board.execute(packet.bytes(), host.time_ns).has_value());
    host.time_ns = 15 * MS;
    EXPECT_EQ(host.read(0x0100), COOKIE);
}

TEST(Board, TheLogHasEachCommand) {
    Host host;
    std::vector<std::string> lines;
    host.board.set_log([&](const ExecutedCommand &one) { lines.push_back(log_line(one)); });
    host.time_ns = 1500;
    host.write(0x2000, 0x1234);
    host.read(0x0100);
    EXPECT_EQ(lines,
              (std::vector<std::string>{"1500 W0 0x2000 1x32 00001234", "1500 R0 0x0100 1x32 55AACAFE"}));
}

// Random packets: no crash, each error is counted, and the board still answers.
TEST(Board, RandomPacketsAreCountedErrorsAtMost) {
    Host host("7i76e", "motor x stepgen=0 steps_per_rev=200\nencoder 0 motor=x counts_per_rev=4000\n"
                       "motor y stepgen=1 steps_per_rev=200\n");
    std::mt19937 random(16);
    unsigned packets = 0;
    for (int i = 0; i < 100'000; ++i) {
        std::vector<std::byte> packet(random() % 64);
        for (std::byte &one : packet) {
            one = static_cast<std::byte>(random() & 0xFFU);
        }
        if (packet.size() >= 2 && random() % 2 == 0) {
            packet[1] &= std::byte{0xC3};  // the space of the registers
        }
        host.time_ns += static_cast<std::int64_t>(random() % 20'000);
        const unsigned before = host.board.control(ControlAddress::RECEIVED_PACKETS);
        const auto reply = host.board.execute(packet, host.time_ns);
        EXPECT_TRUE(!reply.has_value() || reply->bytes.size() <= lbp16::MAX_PACKET_BYTES);
        packets += before != host.board.control(ControlAddress::RECEIVED_PACKETS) ? 1 : 0;
    }
    EXPECT_GT(packets, 90'000U);
    EXPECT_GT(host.board.control(ControlAddress::PARSE_ERRORS), 0);
    host.time_ns += S;
    EXPECT_EQ(host.read(0x0100), COOKIE);
}

}  // namespace
}  // namespace mw::mesa::board
