// SPDX-License-Identifier: GPL-2.0-or-later
#include <vector>

#include <gtest/gtest.h>

#include "drivers/mesa/lbp16/packet.hh"

namespace mw::mesa::lbp16 {
namespace {

std::vector<std::byte> bytes(std::initializer_list<unsigned> values) {
    std::vector<std::byte> result;
    for (const unsigned value : values) {
        result.push_back(static_cast<std::byte>(value));
    }
    return result;
}

std::vector<std::byte> of(const PacketWriter &packet) {
    return {packet.bytes().begin(), packet.bytes().end()};
}

// The words that mesaflash and elbpcom send (shared/hardware.md, part A2).
TEST(Lbp16Packet, ReadsOfKnownProgramsHaveTheirBytes) {
    PacketWriter packet;
    EXPECT_TRUE(packet.read({.incrementing = false, .address = 0x0100}));
    EXPECT_EQ(of(packet), bytes({0x01, 0x42, 0x00, 0x01}));
    packet.clear();
    EXPECT_TRUE(packet.read({.space = Space::BOARD, .unit = Unit::BITS_16, .units = 8}));
    EXPECT_EQ(of(packet), bytes({0x88, 0x5D, 0x00, 0x00}));
    EXPECT_EQ(packet.answer_bytes(), 16U);
    packet.clear();
    // elbpcom 01D914000000: write one word of 16 bit to address 0x14 of space 6.
    EXPECT_TRUE(packet.write({.writes = true,
                              .incrementing = false,
                              .space = Space::CONTROL,
                              .unit = Unit::BITS_16,
                              .address = 0x14},
                             bytes({0, 0})));
    EXPECT_EQ(of(packet), bytes({0x01, 0xD9, 0x14, 0x00, 0x00, 0x00}));
    EXPECT_EQ(packet.answer_bytes(), 0U);
}

TEST(Lbp16Packet, EveryWordIsTheWordOfItsCommand) {
    for (unsigned word = 0; word <= 0xFFFFU; ++word) {
        EXPECT_EQ(command_word(command_of(static_cast<std::uint16_t>(word))), word);
    }
}

TEST(Lbp16Packet, AReaderFindsWhatAWriterWrote) {
    PacketWriter packet;
    EXPECT_TRUE(packet.write_register(0x2000, 0x12345678));
    EXPECT_TRUE(packet.read_registers(0x1000, 3));
    PacketReader reader(packet.bytes());
    const auto written = reader.next();
    ASSERT_TRUE(written.has_value());
    EXPECT_EQ(written->command, (Command{.writes = true, .address = 0x2000}));
    EXPECT_EQ(number_at<std::uint32_t>(written->data), 0x12345678U);
    const auto read = reader.next();
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->command, (Command{.units = 3, .address = 0x1000}));
    EXPECT_TRUE(reader.isAtEnd());
}

TEST(Lbp16Packet, ACutPacketIsAnErrorAndEnds) {
    PacketWriter packet;
    ASSERT_TRUE(packet.write_register(0x2000, 1));
    for (std::size_t size = 1; size < packet.bytes().size(); ++size) {
        PacketReader reader(packet.bytes().first(size));
        EXPECT_EQ(reader.next().error(), size < 4 ? PacketError::CUT_COMMAND : PacketError::CUT_DATA);
        EXPECT_TRUE(reader.isAtEnd());
    }
    const auto no_units = bytes({0x80, 0x42, 0, 0, 1});
    PacketReader reader(no_units);
    EXPECT_EQ(reader.next().error(), PacketError::NO_UNITS);
    EXPECT_TRUE(reader.isAtEnd());
}

TEST(Lbp16Packet, ACommandThatDoesNotFitEndsThePacket) {
    PacketWriter packet(20);
    EXPECT_TRUE(packet.write_register(0x2000, 1));
    EXPECT_TRUE(packet.write_register(0x2004, 2));
    EXPECT_FALSE(packet.write_register(0x2008, 3));
    EXPECT_TRUE(packet.isFull());
    EXPECT_FALSE(packet.read_registers(0x1000, 1)) << "a later command must not overtake one that is missing";
    EXPECT_EQ(packet.bytes().size(), 16U);
    packet.clear();
    EXPECT_FALSE(packet.read_registers(0x1000, 6)) << "its answer is larger than a packet";
    packet.clear();
    EXPECT_FALSE(packet.read_registers(0x1000, 0));
    packet.clear();
    EXPECT_FALSE(packet.read_registers(0x1000, 128));
}

}  // namespace
}  // namespace mw::mesa::lbp16
