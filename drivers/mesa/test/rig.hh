// SPDX-License-Identifier: GPL-2.0-or-later
// Driver, Ethernet bus and simulated board together, in virtual time.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "drivers/mesa/board/board_transport.hh"
#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/hostmot2/board.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa::test {

/// The parts of a rig, in the syntax of the program hm2-board.
struct RigPlan {
    std::string model = "7i76e";
    std::string config{};
    std::string physics{};
    std::string faults{};
    int sserial_baudrate = -1;
    bool is_named_by_serial_number = false;
};

class Rig {
  public:
    static constexpr long PERIOD_NS = 1'000'000;

    explicit Rig(const RigPlan &plan)
        : model_(*board::load_model(plan.model)),
          simulated(model_, *board::parse_physics(plan.physics, "physics", model_.idrom)),
          link(simulated, *board::parse_faults(plan.faults, "faults")) {
        auto made = std::make_unique<board::BoardTransport>(link);
        transport = made.get();
        auto opened = EthernetBus::open(std::move(made), "board");
        EXPECT_TRUE(opened.has_value()) << opened.error().str();
        bus = std::move(*opened);
        const auto idrom = decode_idrom([&](std::uint16_t address, int count) {
            return bus->read_now({.address = address, .count = static_cast<std::uint16_t>(count)});
        });
        EXPECT_TRUE(idrom.has_value()) << idrom.error().str();
        Config config = *parse_config(plan.config);
        config.sserial_baudrate = plan.sserial_baudrate;
        config.is_named_by_serial_number = plan.is_named_by_serial_number;
        auto driven = Board::make(*bus, *idrom, config);
        EXPECT_TRUE(driven.has_value()) << driven.error().str();
        driver = std::move(*driven);
        driver->declare(pins);
        next_ns_ = transport->now_ns();
    }

    /// Runs one cycle of a servo thread.
    void cycle() {
        read();
        write();
    }
    void read() {
        next_ns_ += PERIOD_NS;
        transport->sleep_until(next_ns_);
        driver->read(PERIOD_NS, transport->now_ns());
    }
    void write() { driver->write(PERIOD_NS, transport->now_ns()); }
    /// Advances the time without the driver, as after SIGKILL.
    void wait(std::int64_t duration_ns) {
        next_ns_ += duration_ns;
        transport->sleep_until(next_ns_);
    }
    std::int64_t steps(std::size_t motor) const { return simulated.physics().position_steps(motor); }

  private:
    board::Model model_;

  public:
    board::Board simulated;
    board::Link link;
    board::BoardTransport *transport = nullptr;
    std::unique_ptr<EthernetBus> bus;
    std::unique_ptr<Board> driver;
    PinMap pins;

  private:
    std::int64_t next_ns_ = 0;
};

}  // namespace mw::mesa::test
