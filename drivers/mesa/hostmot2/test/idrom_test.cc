// SPDX-License-Identifier: GPL-2.0-or-later
#include <random>

#include "drivers/mesa/hostmot2/test/board_fixture.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t HEADER = 0x0400;

/// Reads as register_board() does.
Result<Idrom> read_idrom(MemoryBus &bus) {
    return decode_idrom(
        [&](std::uint16_t address, int count) {
            return bus.read_now({.address = address, .count = static_cast<std::uint16_t>(count)});
        },
        {.ports = static_cast<std::uint32_t>(bus.connectors().size()),
         .port_width = static_cast<std::uint32_t>(bus.port_width())});
}

class DescriptionOfFirmware : public ::testing::Test {
  protected:
    DescriptionOfFirmware() {
        bus.registers = image_of(firmware());
        bus.connector_names = {"P1", "P2", "P3"};
        bus.width = 17;
    }
    std::string error() {
        const auto idrom = read_idrom(bus);
        if (idrom) {
            return "";
        }
        const Error &error = idrom.error();
        return error.hint.empty() ? error.message : error.message + "\n" + error.hint;
    }
    std::string error_with(int word, std::uint32_t value) {
        bus.registers = image_of(firmware());
        bus.registers[static_cast<std::uint16_t>(HEADER + 4 * word)] = value;
        return error();
    }
    MemoryBus bus;
};

TEST_F(DescriptionOfFirmware, IsReadWhole) {
    const auto idrom = read_idrom(bus);
    ASSERT_TRUE(idrom.has_value()) << idrom.error().message;
    EXPECT_EQ(*idrom, firmware());
}

TEST_F(DescriptionOfFirmware, IsRefusedWithWhatIsWrong) {
    EXPECT_EQ(error_with(0, 4), "invalid IDROM type 4, expected 2 or 3, aborting load");
    EXPECT_EQ(error_with(9, 24),
              "invalid IDROM PortWidth 24, this board has 17 pins per connector, aborting load");
    EXPECT_EQ(error_with(7, 2),
              "IDROM IOPorts is 2 but llio num_ioport_connectors is 3, driver and firmware are inconsistent, "
              "aborting driver load");
    EXPECT_EQ(
        error_with(8, 99),
        "IDROM IOWidth is 99, but IDROM IOPorts is 3 and IDROM PortWidth is 17 (inconsistent firmware), "
        "aborting driver load");
    EXPECT_EQ(error_with(10, 12345), "IDROM ClockLow is 12345, that's too low, aborting driver load");
    EXPECT_EQ(error_with(11, 0), "IDROM ClockHigh is 0, that's too low, aborting driver load");
    bus.registers[COOKIE_ADDRESS] = 1;
    EXPECT_EQ(error(), "invalid cookie, got 0x00000001, expected 0x55AACAFE\n"
                       "FPGA failed to initialize, or unexpected firmware?");
}

TEST_F(DescriptionOfFirmware, WithAnyWordDamagedIsRefusedOrUsable) {
    std::mt19937 random(5);
    for (int i = 0; i < 3000; ++i) {
        bus.registers = image_of(firmware());
        for (auto n = random() % 4 + 1; n > 0; --n) {
            auto one = bus.registers.begin();
            std::advance(one, static_cast<std::ptrdiff_t>(random() % bus.registers.size()));
            const auto word = static_cast<std::uint32_t>(random());
            one->second = random() % 3 == 0 ? word : one->second ^ (1U << (word % 32U));
        }
        const auto idrom = read_idrom(bus);
        if (!idrom) {
            EXPECT_FALSE(idrom.error().message.empty());
            continue;
        }
        auto board = Board::make(bus, *idrom, {});
        if (!board) {
            continue;
        }
        PinMap pins;
        (*board)->declare(pins);
        for (int cycle = 0; cycle < 3; ++cycle) {
            (*board)->read(PERIOD_NS, 0);
            (*board)->write(PERIOD_NS, 0);
        }
    }
}

}  // namespace
}  // namespace mw::mesa::test
