// SPDX-License-Identifier: GPL-2.0-or-later
#include <cerrno>

#include <gtest/gtest.h>

#include "drivers/mesa/spi/spi_cards.hh"
#include "drivers/mesa/spi/spi_codec.hh"
#include "drivers/mesa/spi/spi_registers.hh"
#include "drivers/mesa/spi/spidev.hh"
#include "drivers/mesa/spi/test/simulated_device.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::mesa::test {
namespace {

using spi::Access;
using spi::SpiRegisters;
using Words = std::vector<std::uint32_t>;

DirectRig::Plan plan_of(std::vector<SentTransfer> *log = nullptr) {
    return {.model = "7i90",
            .config = {},
            .physics = STEPPER,
            .card = spi::card_of("MESA7I90"),
            .make = [log](Wire &wire) {
                return std::make_unique<SpiRegisters>(std::make_unique<SimulatedDevice>(wire, log));
            }};
}

// The words are those of LinuxCNC's hm2_spi for the same registers.
TEST(SpiCodec, CommandsAreThoseOfLinuxCnc) {
    EXPECT_EQ(spi::command_word(Access::READ, 0x0100, 4), 0x0100A840U);
    EXPECT_EQ(spi::command_word(Access::READ, 0x0400, 16), 0x0400A900U);
    EXPECT_EQ(spi::command_word(Access::READ, 0x2100, 8), 0x2100A880U);
    EXPECT_EQ(spi::command_word(Access::WRITE, 0x1000, 3), 0x1000B830U);
    EXPECT_EQ(spi::command_word(Access::WRITE, 0x0E00, 1), 0x0E00B810U);
    EXPECT_EQ(spi::transfer_words(0), 0U);
    EXPECT_EQ(spi::transfer_words(127), 128U);
    EXPECT_EQ(spi::transfer_words(128), 130U);
    Words words{0x11223344, 0xFE000000};
    spi::swap_bytes(words);
    EXPECT_EQ(words, (Words{0x44332211, 0xFE}));
}

TEST(SpiRegisters, ACycleIsOneTransferEachWay) {
    std::vector<SentTransfer> log;
    DirectRig rig(plan_of(&log));
    rig.cycle(5);
    log.clear();
    rig.cycle();
    ASSERT_EQ(log.size(), 2U);
    EXPECT_EQ(log[0].direction, spi::Direction::READS);
    EXPECT_EQ(log[0].words[0], 0x0100A810U) << "the cookie first";
    EXPECT_EQ(log[1].direction, spi::Direction::WRITES);
}

TEST(SpiRegisters, AMotorFollowsItsCommand) {
    DirectRig rig(plan_of());
    run_stepper(rig);
}

TEST(SpiRegisters, LongReadsAndWritesAreSplitIntoCommands) {
    board::Board board(*board::load_model("7i90"));
    Wire wire{board};
    std::vector<SentTransfer> log;
    SpiRegisters access(std::make_unique<SimulatedDevice>(wire, &log));
    Words values(200, 1);
    EXPECT_TRUE(access.read(0x0400, values));
    EXPECT_EQ(log[0].words.size(), 202U);
    EXPECT_EQ(log[0].words[128], spi::command_word(Access::READ, 0x0400 + 4 * 127, 73));
    for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(values[i], board.firmware().read(static_cast<std::uint16_t>(0x0400 + 4 * i))) << i;
    }
    Words many(600, 0);
    EXPECT_FALSE(access.read(0x0400, many)) << "longer than the buffer";
    EXPECT_EQ(access.last_error(), EMSGSIZE);
    const RegisterRange range[] = {{.address = 0x0400, .count = 600}};
    ASSERT_TRUE(access.prepare(range, 0).has_value());
    EXPECT_TRUE(access.read(0x0400, many));
}

class SpiWires : public ::testing::TestWithParam<std::uint32_t> {};

// An open wire reads as zeros or as ones; neither is treated as data.
TEST_P(SpiWires, AnOpenWireIsAFailureAndThenStops) {
    DirectRig rig(plan_of());
    rig.cycle(10);
    rig.wire.is_cut = true;
    rig.wire.floating = GetParam();
    rig.cycle();
    EXPECT_EQ(rig.bus->fault(), DirectFault::NO_COOKIE);
    EXPECT_FALSE(rig.bus->isStopped());
    rig.cycle(4);
    EXPECT_TRUE(rig.bus->isStopped());
    rig.wire.is_cut = false;
    rig.cycle(20);
    EXPECT_EQ(rig.simulated.firmware().read(0x0D00), 1U) << "the watchdog has bitten";
    rig.bus->resume();
    rig.cycle(30);
    EXPECT_FALSE(rig.bus->isFailed());
}

INSTANTIATE_TEST_SUITE_P(All, SpiWires, ::testing::Values(0U, 0xFFFFFFFFU));

TEST(SpiRegisters, AnErrorOfTheDeviceIsReported) {
    DirectRig rig(plan_of());
    rig.cycle(10);
    rig.wire.error = EIO;
    rig.cycle();
    EXPECT_EQ(rig.bus->fault(), DirectFault::ACCESS);
    EXPECT_EQ(rig.bus->last_error(), EIO);
}

TEST(SpiCards, AreKnownByTheNameInTheirFirmware) {
    EXPECT_EQ(spi::card_of("MESA7I90").hal_name, "7i90");
    EXPECT_EQ(spi::card_of("MESA7I90").connectors.size(), 3U);
    EXPECT_EQ(spi::card_of("MESA7C80").hal_name, "7c80");
    EXPECT_TRUE(spi::card_of("MESA7C80").connectors.empty());
    EXPECT_EQ(spi::card_of(std::string("\0\0\0\0\0\0\0\0", 8)).hal_name, "spi");
}

TEST(Spidev, ProbesNameDevices) {
    EXPECT_EQ(spi::path_of_probe(1), "/dev/spidev0.0");
    EXPECT_EQ(spi::path_of_probe(16), "/dev/spidev1.2");
    EXPECT_EQ(spi::path_of_probe(3), "");
    const auto device =
        spi::open_spidev("/nonexistent/spidev9.9", {.read_hz = 1'000'000, .write_hz = 1'000'000});
    ASSERT_FALSE(device.has_value());
    EXPECT_EQ(device.error().message,
              "SPI device /nonexistent/spidev9.9: cannot open it: No such file or directory.");
}

/// A bus without answers, to test only the registers.
class EmptyDevice final : public spi::Device {
  public:
    int transfer(std::span<std::uint32_t>, spi::Direction) noexcept override { return 0; }
};

TEST(SpiRegisters, ACycleAllocatesNothing) {
    SpiRegisters access(std::make_unique<EmptyDevice>());
    const RegisterRange ranges[] = {{.address = 0x0100}, {.address = 0x1000, .count = 3}};
    const RegisterWrite writes[] = {{0x1000, 1}, {0x1004, 2}, {0x0E00, 0x5A000000}};
    ASSERT_TRUE(access.prepare(ranges, 3).has_value());
    std::uint32_t values[4] = {};
    const mw::testing::AllocationGuard guard;
    EXPECT_TRUE(access.read_list(ranges, values));
    EXPECT_TRUE(access.write_list(writes));
}

}  // namespace
}  // namespace mw::mesa::test
