// SPDX-License-Identifier: GPL-2.0-or-later
// Driver, direct bus and simulated board together, in virtual time.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "drivers/mesa/board/board.hh"
#include "drivers/mesa/direct/direct_bus.hh"
#include "drivers/mesa/hostmot2/board.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa::test {

/// Faults between host and board, set by a test.
struct Wire {
    board::Board &board;
    bool is_cut = false;                  ///< nothing reaches the board, and reads return `floating`
    std::uint32_t floating = 0xFFFFFFFF;  ///< value read from an open line
    int error = 0;                        ///< errno of the access; 0: none
};

/// Registers of the simulated board without any protocol, as on PCI.
class WiredRegisters final : public RegisterAccess {
  public:
    explicit WiredRegisters(Wire &wire) : wire_(wire) {}
    bool read(std::uint16_t address, std::span<std::uint32_t> values) noexcept override {
        for (std::uint32_t &value : values) {
            value = wire_.is_cut ? wire_.floating : wire_.board.firmware().read(address);
            address = static_cast<std::uint16_t>(address + 4);
        }
        return wire_.error == 0;
    }
    bool write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept override {
        for (const std::uint32_t value : values) {
            if (!wire_.is_cut) {
                wire_.board.firmware().write(address, value);
            }
            address = static_cast<std::uint16_t>(address + 4);
        }
        return wire_.error == 0;
    }
    int last_error() const noexcept override { return wire_.error; }

  private:
    Wire &wire_;
};

class DirectRig {
  public:
    static constexpr long PERIOD_NS = 1'000'000;
    using MakeAccess = std::function<std::unique_ptr<RegisterAccess>(Wire &)>;

    struct Plan {
        std::string model{};
        std::string config{};
        std::string physics{};
        DirectCard card{};
        MakeAccess make{};
    };

    explicit DirectRig(const Plan &plan)
        : model_(*board::load_model(plan.model)),
          simulated(model_, *board::parse_physics(plan.physics, "physics", model_.idrom)), wire{simulated} {
        auto opened = DirectBus::open(plan.make(wire), plan.card, "test");
        EXPECT_TRUE(opened.has_value()) << opened.error().str();
        bus = std::move(*opened);
        const auto idrom = decode_idrom([&](std::uint16_t address, int count) {
            return bus->read_now({.address = address, .count = static_cast<std::uint16_t>(count)});
        });
        EXPECT_TRUE(idrom.has_value()) << idrom.error().str();
        EXPECT_EQ(*idrom, model_.idrom);
        auto made = Board::make(*bus, *idrom, *parse_config(plan.config));
        EXPECT_TRUE(made.has_value()) << made.error().str();
        driver = std::move(*made);
        driver->declare(pins);
    }

    /// Runs cycles of a servo thread.
    void cycle(int count = 1) {
        for (int i = 0; i < count; ++i) {
            wait(PERIOD_NS);
            driver->read(PERIOD_NS, now_ns_);
            driver->write(PERIOD_NS, now_ns_);
        }
    }
    /// Advances the time without the driver.
    void wait(std::int64_t duration_ns) {
        now_ns_ += duration_ns;
        simulated.advance(now_ns_);
    }
    void restart_board() { simulated.restart(now_ns_, 0); }
    std::int64_t now_ns() const { return now_ns_; }

  private:
    board::Model model_;

  public:
    board::Board simulated;
    Wire wire;
    std::unique_ptr<DirectBus> bus;
    std::unique_ptr<Board> driver;
    PinMap pins;

  private:
    std::int64_t now_ns_ = 0;
};

/// Drives the first step generator to 3.5 revolutions; motor and encoder must agree.
inline void run_stepper(DirectRig &rig) {
    rig.pins.set("stepgen.00.position-scale", 200);
    rig.pins.set("stepgen.00.steplen", 2000);
    rig.pins.set("stepgen.00.stepspace", 2000);
    rig.pins.set("stepgen.00.maxaccel", 100);
    rig.pins.set("stepgen.00.maxvel", 20);
    rig.pins.set("stepgen.00.enable", 1);
    rig.pins.set("stepgen.00.position-cmd", 3.5);
    rig.cycle(2000);
    EXPECT_NEAR(rig.pins.get("stepgen.00.position-fb"), 3.5, 0.005);
    EXPECT_NEAR(static_cast<double>(rig.simulated.physics().position_steps(0)), 700, 1);
    EXPECT_EQ(rig.bus->failed_cycles(), 0U);
}

constexpr const char *STEPPER = "motor x stepgen=0 steps_per_rev=200\n";

}  // namespace mw::mesa::test
