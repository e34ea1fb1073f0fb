// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/small.hh"

namespace mw::mesa {

namespace {

constexpr std::size_t MAX_BITS = 32;

class Leds final : public Module {
  public:
    explicit Leds(const ModuleRequest &request)
        : module_(request.module),
          count_(std::min(static_cast<std::size_t>(request.module.instances), MAX_BITS)) {}

    void plan(Registers &registers) override {
        word_ = registers.write(module_.address(0), WriteOrder::RATE, Send::CHANGED);
    }
    void declare(PinSpace &space) override {
        for (std::size_t i = 0; i < count_; ++i) {
            binding_.add(space, fmt::format("led.CR{:02}", i + 1), PinType::BIT, Access::IN, &lit_[i]);
        }
    }
    void read(const Registers &, const Cycle &) noexcept override {}
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        registers.set(word_, led_word(std::span<const bool>(lit_).first(count_)));
    }

  private:
    UsedModule module_;
    std::size_t count_;
    std::array<bool, MAX_BITS> lit_{};
    PinBinding binding_;
    WriteHandle word_;
};

struct DpllPins {
    double timer_us[4] = {100.0, 100.0, 100.0, 100.0};
    double base_freq_khz = -1.0;  ///< negative: that of the thread
    double phase_error_us = 0.0;
    std::uint32_t time_const = 2000, plimit = 0x400000, ddsize = DPLL_DDS_BITS, prescale = 1;
};
constexpr PinRow<DpllPins> DPLL_PINS[] = {
    {"base-freq-khz", Access::IN, &DpllPins::base_freq_khz},
    {"phase-error-us", Access::OUT, &DpllPins::phase_error_us},
    {"time-const", Access::IN, &DpllPins::time_const},
    {"plimit", Access::IN, &DpllPins::plimit},
    {"ddsize", Access::OUT, &DpllPins::ddsize},
    {"prescale", Access::OUT, &DpllPins::prescale},
};

class Dpll final : public Module {
  public:
    explicit Dpll(const ModuleRequest &request) : module_(request.module) {}

    void plan(Registers &registers) override {
        sync_ = registers.read({module_.address(SYNC), 1}, ReadOrder::DPLL_SYNC);
        size_ = registers.read({module_.address(FILTER), 1}, ReadOrder::DPLL_SYNC);
        const auto add = [&](int reg) {
            return registers.write(module_.address(reg), WriteOrder::CONFIGURATION, Send::CHANGED);
        };
        base_ = add(BASE_RATE);
        control_ = add(CONTROL);
        filter_ = add(FILTER);
        timers_12_ = add(TIMERS_12);
        timers_34_ = add(TIMERS_34);
    }
    void declare(PinSpace &space) override {
        for (int i = 0; i < 4; ++i) {
            binding_.add(space, fmt::format("dpll.{:02}.timer-us", i + 1), PinType::FLOAT, Access::IN,
                         &pins_.timer_us[i]);
        }
        binding_.bind(space, "dpll", DPLL_PINS, pins_);
    }
    void read(const Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        constexpr std::uint32_t SIZE_MASK = 0xFF;
        pins_.phase_error_us = dpll_phase_error_us(registers.value(sync_), cycle.period_s);
        pins_.ddsize = registers.value(size_) & SIZE_MASK;
        binding_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        constexpr std::uint32_t MOST_LIMIT = 0xFFFFFF, MOST_TIME = 0xFFFF, MOST_PRESCALE = 0xFF;
        const double hz = pins_.base_freq_khz > 0.0 ? pins_.base_freq_khz * 1000.0 : 1.0 / cycle.period_s;
        const std::uint32_t prescale = std::clamp(pins_.prescale, 1U, MOST_PRESCALE);
        const auto timer = [&](int i) { return dpll_timer(pins_.timer_us[i], 1.0 / hz); };
        registers.set(base_, dpll_base_rate(hz, prescale, module_.clock_hz));
        registers.set(control_, (prescale << 24U) | std::min(pins_.plimit, MOST_LIMIT));
        registers.set(filter_, std::min(pins_.time_const, MOST_TIME) << 16U);
        registers.set(timers_12_, (timer(1) << 16U) | timer(0));
        registers.set(timers_34_, (timer(3) << 16U) | timer(2));
    }

  private:
    enum DpllRegister { BASE_RATE, PHASE_ERROR, CONTROL, FILTER, TIMERS_12, TIMERS_34, SYNC };
    UsedModule module_;
    DpllPins pins_;
    PinBinding binding_;
    ReadHandle sync_, size_;
    WriteHandle base_, control_, filter_, timers_12_, timers_34_;
};

}  // namespace

std::unique_ptr<Module> make_leds(const ModuleRequest &request) {
    return std::make_unique<Leds>(request);
}
std::unique_ptr<Module> make_dpll(const ModuleRequest &request) {
    return std::make_unique<Dpll>(request);
}

}  // namespace mw::mesa
