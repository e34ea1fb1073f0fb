// SPDX-License-Identifier: GPL-2.0-or-later
// A bus that passes calls on to another bus. A derived class overrides the functions that it changes; all
// others are passed on.
#pragma once

#include "drivers/mesa/hostmot2/register_bus.hh"

namespace mw::mesa {

class ForwardingBus : public RegisterBus {
  public:
    /// `inner` must outlive this object.
    explicit ForwardingBus(RegisterBus &inner) : inner_(inner) {}

    std::string card_name() const override { return inner_.card_name(); }
    std::vector<std::string> connectors() const override { return inner_.connectors(); }
    int port_width() const override { return inner_.port_width(); }
    int leds() const override { return inner_.leds(); }
    Result<std::vector<std::uint32_t>> read_now(RegisterRange range) override {
        return inner_.read_now(range);
    }
    Result<> write_now(std::uint16_t address, std::span<const std::uint32_t> values) override {
        return inner_.write_now(address, values);
    }
    void pause_now(std::chrono::nanoseconds duration) override { inner_.pause_now(duration); }
    Result<> set_lists(std::span<const RegisterRange> reads, int max_writes) override {
        return inner_.set_lists(reads, max_writes);
    }
    void request() noexcept override { inner_.request(); }
    CycleRead read(std::span<std::uint32_t> values, long period_ns) noexcept override {
        return inner_.read(values, period_ns);
    }
    bool redirect(int range, std::uint16_t address) noexcept override {
        return inner_.redirect(range, address);
    }
    bool write(std::span<const RegisterWrite> writes) noexcept override { return inner_.write(writes); }
    bool hasImmediateAccess() const noexcept override { return inner_.hasImmediateAccess(); }
    bool read_immediately(std::uint16_t address, std::span<std::uint32_t> values) noexcept override {
        return inner_.read_immediately(address, values);
    }
    bool write_immediately(std::span<const RegisterWrite> writes) noexcept override {
        return inner_.write_immediately(writes);
    }
    bool take_rewrite() noexcept override { return inner_.take_rewrite(); }
    bool isRestartVisible() const noexcept override { return inner_.isRestartVisible(); }
    bool take_restart() noexcept override { return inner_.take_restart(); }
    void note_watchdog_bite() noexcept override { inner_.note_watchdog_bite(); }

  private:
    RegisterBus &inner_;
};

}  // namespace mw::mesa
