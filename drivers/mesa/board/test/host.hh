// SPDX-License-Identifier: GPL-2.0-or-later
// A host for tests that reads and writes registers of a board in the same process.
#pragma once

#include <gtest/gtest.h>

#include "drivers/mesa/board/board.hh"

namespace mw::mesa::board {

inline Model model_of(const std::string &name) {
    const auto model = load_model(name);
    EXPECT_TRUE(model.has_value()) << model.error().str();
    return *model;
}

inline PhysicsPlan physics_of(const Model &model, const std::string &text) {
    const auto plan = parse_physics(text, "physics.txt", model.idrom);
    EXPECT_TRUE(plan.has_value()) << plan.error().str();
    return *plan;
}

constexpr std::int64_t US = 1000, MS = 1'000'000, S = 1'000'000'000;

/// A board with the time that the test sets.
struct Host {
    Board board;
    std::int64_t time_ns = 0;

    explicit Host(const std::string &name = "7i76e", const std::string &physics = "")
        : board(model_of(name), physics_of(model_of(name), physics)) {}

    std::uint32_t read(std::uint16_t address) {
        lbp16::PacketWriter packet;
        EXPECT_TRUE(packet.read_registers(address, 1));
        const auto reply = board.execute(packet.bytes(), time_ns);
        EXPECT_TRUE(reply.has_value());
        return reply.has_value() ? lbp16::number_at<std::uint32_t>(reply->bytes) : 0;
    }
    void write(std::uint16_t address, std::uint32_t value) {
        lbp16::PacketWriter packet;
        EXPECT_TRUE(packet.write_register(address, value));
        EXPECT_FALSE(board.execute(packet.bytes(), time_ns).has_value()) << "a write has no reply";
    }
    std::uint16_t read16(lbp16::Space space, std::uint16_t address) {
        lbp16::PacketWriter packet;
        EXPECT_TRUE(packet.read({.space = space, .unit = lbp16::Unit::BITS_16, .address = address}));
        const auto reply = board.execute(packet.bytes(), time_ns);
        return reply.has_value() ? lbp16::number_at<std::uint16_t>(reply->bytes) : 0xDEAD;
    }
    void write16(lbp16::Space space, std::uint16_t address, std::uint16_t value) {
        lbp16::PacketWriter packet;
        EXPECT_TRUE(
            packet.write({.writes = true, .space = space, .unit = lbp16::Unit::BITS_16, .address = address},
                         lbp16::bytes_of_number(value)));
        board.execute(packet.bytes(), time_ns);
    }
    /// Assigns the pins of port 0 to their modules and makes them outputs.
    void enable_port0() {
        write(0x1200, 0x1FFFF);
        write(0x1100, 0x03FF);
    }
};

}  // namespace mw::mesa::board
