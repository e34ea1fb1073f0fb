// SPDX-License-Identifier: GPL-2.0-or-later
#include <cerrno>

#include <gtest/gtest.h>

#include "drivers/mesa/epp/epp_registers.hh"
#include "drivers/mesa/epp/test/simulated_port.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::mesa::test {
namespace {

using epp::EppRegisters;
using epp::Width;

DirectRig::Plan plan_of(const std::string &model, Width width) {
    const bool is7i43 = model == "7i43";
    return {.model = model,
            .config = {},
            .physics = STEPPER,
            .card = {.hal_name = model,
                     .connectors = is7i43 ? std::vector<std::string>{"P4", "P3"}
                                          : std::vector<std::string>{"P1", "P2", "P3"},
                     .port_width = 24,
                     .leds = 8,
                     .most_failures = 1},
            .make = [width](Wire &wire) {
                return std::make_unique<EppRegisters>(std::make_unique<SimulatedPort>(wire), width);
            }};
}

TEST(EppCodec, BytesAreLowFirst) {
    EXPECT_EQ(epp::address_bytes(0x0100), (std::array<std::uint8_t, 2>{0x00, 0x81}));
    EXPECT_EQ(epp::address_bytes(0x7FFC), (std::array<std::uint8_t, 2>{0xFC, 0xFF}));
    EXPECT_EQ(epp::data_bytes(0x55AACAFE), (std::array<std::uint8_t, 4>{0xFE, 0xCA, 0xAA, 0x55}));
    for (const std::uint32_t value : {0U, 1U, 0x80000000U, 0xDEADBEEFU, 0xFFFFFFFFU}) {
        EXPECT_EQ(epp::word_of(epp::data_bytes(value)), value);
    }
}

// The accesses are those of LinuxCNC's hm2_7i90 for the same registers.
TEST(EppRegisters, SendWhatLinuxCncSends) {
    board::Board board(*board::load_model("7i90"));
    Wire wire{board};
    std::vector<std::string> log;
    EppRegisters wide(std::make_unique<SimulatedPort>(wire, &log), Width::WIDE);
    std::uint32_t values[2] = {};
    EXPECT_TRUE(wide.read(0x0104, values));
    const std::uint32_t reset[] = {0x5A000000};
    EXPECT_TRUE(wide.write(0x0E00, reset));
    EXPECT_EQ(log, (std::vector<std::string>{"address 0", "in8 0", "address 4", "address 81", "in32 0",
                                             "in32 0", "address 0", "address 8e", "out32 5a000000"}));
    log.clear();
    EppRegisters bytes(std::make_unique<SimulatedPort>(wire, &log), Width::BYTES);
    EXPECT_TRUE(bytes.write(0x0E00, reset));
    EXPECT_EQ(log, (std::vector<std::string>{"address 0", "in8 0", "address 0", "address 8e", "out8 0",
                                             "out8 0", "out8 0", "out8 5a"}));
}

class EppBoards : public ::testing::TestWithParam<std::pair<const char *, Width>> {};

TEST_P(EppBoards, AMotorFollowsItsCommand) {
    DirectRig rig(plan_of(GetParam().first, GetParam().second));
    run_stepper(rig);
}

INSTANTIATE_TEST_SUITE_P(All, EppBoards,
                         ::testing::Values(std::pair{"7i43", Width::WIDE}, std::pair{"7i43", Width::BYTES},
                                           std::pair{"7i90", Width::WIDE}, std::pair{"7i90", Width::BYTES}));

// As in LinuxCNC, the first time-out stops the traffic.
TEST(EppRegisters, ATimeOutStopsTheTrafficUntilAReset) {
    DirectRig rig(plan_of("7i90", Width::WIDE));
    rig.cycle(10);
    rig.wire.is_cut = true;
    rig.cycle();
    EXPECT_TRUE(rig.bus->isStopped());
    EXPECT_EQ(rig.bus->fault(), DirectFault::ACCESS);
    EXPECT_EQ(rig.bus->last_error(), ETIMEDOUT);
    rig.wire.is_cut = false;
    rig.cycle(20);
    EXPECT_EQ(rig.bus->failed_cycles(), 1U);
    EXPECT_EQ(rig.simulated.firmware().read(0x0D00), 1U) << "the watchdog has bitten";
    rig.bus->resume();
    rig.cycle(30);
    EXPECT_FALSE(rig.bus->isStopped()) << "the time-out is cleared in the port";
    rig.pins.set("watchdog.has_bit", 0);
    rig.cycle(3);
    EXPECT_EQ(rig.simulated.firmware().read(0x0D00), 0U);
}

/// A port without answers, to test the bus alone.
class EmptyPort final : public epp::Port {
  public:
    std::uint8_t read(epp::Register) noexcept override { return 0; }
    void write(epp::Register, std::uint8_t) noexcept override {}
    std::uint32_t read_wide() noexcept override { return 0x55AACAFE; }
    void write_wide(std::uint32_t) noexcept override {}
};

TEST(EppRegisters, ACycleAllocatesNothing) {
    EppRegisters access(std::make_unique<EmptyPort>(), Width::WIDE);
    const RegisterRange ranges[] = {{.address = 0x0100}, {.address = 0x1000, .count = 3}};
    const RegisterWrite writes[] = {{0x1000, 1}, {0x1004, 2}, {0x0E00, 0x5A000000}};
    std::uint32_t values[4] = {};
    const mw::testing::AllocationGuard guard;
    EXPECT_TRUE(access.read_list(ranges, values));
    EXPECT_TRUE(access.write_list(writes));
}

}  // namespace
}  // namespace mw::mesa::test
