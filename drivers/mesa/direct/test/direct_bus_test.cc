// SPDX-License-Identifier: GPL-2.0-or-later
#include <cerrno>

#include <gtest/gtest.h>

#include "drivers/mesa/direct/test/rig.hh"

namespace mw::mesa::test {
namespace {

DirectRig::Plan plan_of(const std::string &model = "5i20") {
    return {.model = model,
            .config = {},
            .physics = STEPPER,
            .card = {.hal_name = model,
                     .connectors = {"P2", "P3", "P4"},
                     .port_width = 24,
                     .leds = 8,
                     .most_failures = 5},
            .make = [](Wire &wire) { return std::make_unique<WiredRegisters>(wire); }};
}

TEST(DirectBus, AMotorFollowsItsCommand) {
    DirectRig rig(plan_of());
    run_stepper(rig);
}

TEST(DirectBus, ABoardWithoutFirmwareIsRejected) {
    board::Board board(*board::load_model("5i20"));
    Wire wire{board, true};
    const auto bus =
        DirectBus::open(std::make_unique<WiredRegisters>(wire), {.hal_name = "5i20"}, "PCI 0000:01:00.0");
    ASSERT_FALSE(bus.has_value());
    EXPECT_EQ(bus.error().message,
              "The board 5i20 at PCI 0000:01:00.0 has no HostMot2 firmware: its cookie is 0xffffffff, "
              "not 0x55aacafe.");
    Wire broken{board, false, 0, ETIMEDOUT};
    const auto failed = DirectBus::open(std::make_unique<WiredRegisters>(broken), {.hal_name = "7i43"},
                                        "parallel port 0x378");
    ASSERT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().message, "The board 7i43 at parallel port 0x378: the read of register 0x0100 "
                                      "has failed: Connection timed out.");
}

TEST(DirectBus, ASingleFailureKeepsPinsAndIsFollowedByAFullWrite) {
    DirectRig rig(plan_of());
    rig.cycle(10);
    rig.wire.is_cut = true;
    rig.cycle();
    EXPECT_TRUE(rig.bus->isFailed());
    EXPECT_EQ(rig.bus->fault(), DirectFault::NO_COOKIE);
    EXPECT_EQ(rig.bus->cookie(), 0xFFFFFFFFU);
    EXPECT_FALSE(rig.bus->isStopped());
    rig.wire.is_cut = false;
    rig.simulated.firmware().write(0x2500, 0x123);  // a write that did not reach the board
    rig.cycle();
    EXPECT_FALSE(rig.bus->isFailed());
    EXPECT_EQ(rig.bus->failed_cycles(), 1U);
    EXPECT_EQ(rig.simulated.firmware().read(0x2500), 0x3FFFU) << "all registers are written again";
}

// No traffic after too many failures: the watchdog of the board switches its outputs off.
TEST(DirectBus, FailuresInARowStopTheTraffic) {
    DirectRig rig(plan_of());
    rig.cycle(10);
    ASSERT_NE(rig.simulated.firmware().read(0x1108), 0U) << "outputs are on";
    rig.wire.is_cut = true;
    rig.cycle(5);
    EXPECT_TRUE(rig.bus->isStopped());
    rig.wire.is_cut = false;
    rig.cycle(20);
    EXPECT_EQ(rig.bus->failed_cycles(), 5U) << "it does not even read";
    EXPECT_EQ(rig.simulated.firmware().read(0x1108), 0U) << "the watchdog has bitten";
    EXPECT_EQ(rig.simulated.firmware().read(0x0D00), 1U);
}

TEST(DirectBus, AfterAResetTheSameBoardIsServedAgain) {
    DirectRig rig(plan_of());
    rig.cycle(10);
    rig.wire.is_cut = true;
    rig.cycle(5);
    rig.wire.is_cut = false;
    rig.restart_board();
    rig.cycle(10);
    rig.bus->resume();
    rig.cycle();
    EXPECT_EQ(rig.simulated.firmware().read(0x1108), 0U) << "nothing is written before it is compared";
    rig.cycle(30);
    EXPECT_FALSE(rig.bus->isStopped());
    EXPECT_FALSE(rig.bus->isFailed());
    EXPECT_EQ(rig.pins.get("watchdog.has_bit"), 1.0) << "the operator has to clear it";
    rig.pins.set("watchdog.has_bit", 0);
    rig.cycle(3);
    EXPECT_NE(rig.simulated.firmware().read(0x1108), 0U);
}

/// A card that was replaced while the traffic was stopped.
class OtherBoard final : public RegisterAccess {
  public:
    OtherBoard(Wire &wire, Wire &other, const bool &is_other)
        : first_(wire), other_(other), is_other_(is_other) {}
    bool read(std::uint16_t address, std::span<std::uint32_t> values) noexcept override {
        return (is_other_ ? other_ : first_).read(address, values);
    }
    bool write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept override {
        return (is_other_ ? other_ : first_).write(address, values);
    }

  private:
    WiredRegisters first_, other_;
    const bool &is_other_;
};

TEST(DirectBus, AnotherBoardIsNeverWritten) {
    board::Board other(*board::load_model("7i90"));
    Wire other_wire{other};
    bool is_other = false;
    auto plan = plan_of();
    plan.make = [&](Wire &wire) { return std::make_unique<OtherBoard>(wire, other_wire, is_other); };
    DirectRig rig(plan);
    rig.cycle(10);
    rig.bus->stop();
    is_other = true;
    rig.bus->resume();
    rig.cycle(50);
    EXPECT_TRUE(rig.bus->isStopped());
    EXPECT_EQ(rig.bus->fault(), DirectFault::OTHER_BOARD);
    EXPECT_EQ(other.firmware().read(0x1100), 0U);
    EXPECT_EQ(other.firmware().read(0x0C00), 0U);
}

TEST(DirectBus, RawAccessReadsAnotherAddress) {
    auto plan = plan_of();
    DirectRig rig(plan);
    const RegisterRange ranges[] = {{.address = 0x0100}, {.address = 0x1000, .count = 3}};
    ASSERT_TRUE(rig.bus->set_lists(ranges, 10).has_value());
    EXPECT_TRUE(rig.bus->redirect(0, 0x0104));
    EXPECT_FALSE(rig.bus->redirect(1, 0x0104)) << "several registers";
    EXPECT_FALSE(rig.bus->redirect(2, 0x0104));
    std::uint32_t values[4] = {};
    EXPECT_EQ(rig.bus->read(values, DirectRig::PERIOD_NS), CycleRead::DONE);
    EXPECT_EQ(values[0], 0x54534F48U) << "HOST";
}

TEST(DirectBus, AListOfWritesKeepsItsOrder) {
    board::Board board(*board::load_model("5i20"));
    Wire wire{board};
    WiredRegisters access(wire);
    const RegisterWrite writes[] = {{0x2300, 1}, {0x2304, 2}, {0x2308, 3}, {0x2300, 4}, {0x2310, 5}};
    EXPECT_EQ(consecutive_writes(writes, 32), 3U);
    EXPECT_EQ(consecutive_writes(writes, 2), 2U);
    EXPECT_EQ(consecutive_writes({}, 2), 0U);
    EXPECT_TRUE(access.write_list(writes));
    EXPECT_EQ(board.firmware().read(0x2300), 4U);
    EXPECT_EQ(board.firmware().read(0x2304), 2U);
    EXPECT_EQ(board.firmware().read(0x2308), 3U);
}

}  // namespace
}  // namespace mw::mesa::test
