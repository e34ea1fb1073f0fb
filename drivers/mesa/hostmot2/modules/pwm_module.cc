// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/pwm.hh"

namespace mw::mesa {

namespace {

enum PwmRegister { VALUE, MODE, PWM_RATE, PDM_RATE, ENABLE };
constexpr std::uint8_t DITHER_VERSION = 1;
constexpr int MAX_GENERATORS = 32;  // bits of the enable register

struct BoardPins {
    std::uint32_t pwm_frequency = 20'000, pdm_frequency = 20'000;  ///< [Hz]
};
constexpr PinRow<BoardPins> BOARD_PINS[] = {
    {"pwm_frequency", Access::RW, &BoardPins::pwm_frequency},
    {"pdm_frequency", Access::RW, &BoardPins::pdm_frequency},
};

class PwmGenerators final : public Module {
  public:
    explicit PwmGenerators(const ModuleRequest &request)
        : module_(request.module),
          instances_(static_cast<std::size_t>(std::min(request.module.instances, MAX_GENERATORS))) {}

    void plan(Registers &registers) override {
        pwm_rate_ = registers.write(module_.address(PWM_RATE), WriteOrder::CONFIGURATION, Send::CHANGED);
        pdm_rate_ = registers.write(module_.address(PDM_RATE), WriteOrder::CONFIGURATION, Send::CHANGED);
        int number = 0;
        for (Instance &one : instances_) {
            one.mode =
                registers.write(module_.address(MODE, number), WriteOrder::CONFIGURATION, Send::CHANGED);
            one.value = registers.write(module_.address(VALUE, number), WriteOrder::RATE, Send::ALWAYS);
            ++number;
        }
        enable_ = registers.write(module_.address(ENABLE), WriteOrder::RATE, Send::CHANGED);
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            const std::string name = fmt::format("pwmgen.{:02}", number++);
            binding_.bind(space, name, PWM_PINS, one.pins);
            if (module_.descriptor.version >= DITHER_VERSION) {
                binding_.bind(space, name, PWM_DITHER_PINS, one.pins);
            }
        }
        binding_.bind(space, "pwmgen", BOARD_PINS, board_);
    }
    void read(const Registers &, const Cycle &) noexcept override {}
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        const PwmRate rate = pwm_rate(board_.pwm_frequency, module_.clock_hz);
        const PwmRate density = pdm_rate(board_.pdm_frequency, module_.clock_hz);
        board_.pwm_frequency = rate.frequency_hz;
        board_.pdm_frequency = density.frequency_hz;
        registers.set(pwm_rate_, rate.rate);
        registers.set(pdm_rate_, density.rate);
        std::uint32_t enabled = 0;
        unsigned number = 0;
        for (Instance &one : instances_) {
            const bool is_density = one.pins.output_type == PDM_DIRECTION;
            registers.set(one.mode, pwm_mode(one.pins, rate.bits));
            registers.set(one.value, pwm_value(one.pins, is_density ? PDM_BITS : rate.bits));
            enabled |= one.pins.enable ? 1U << number : 0U;
            ++number;
        }
        registers.set(enable_, enabled);
        binding_.store();
    }

  private:
    struct Instance {
        PwmPins pins;
        WriteHandle value, mode;
    };
    UsedModule module_;
    std::vector<Instance> instances_;
    BoardPins board_;
    PinBinding binding_;
    WriteHandle pwm_rate_, pdm_rate_, enable_;
};

}  // namespace

std::unique_ptr<Module> make_pwmgens(const ModuleRequest &request) {
    return std::make_unique<PwmGenerators>(request);
}

}  // namespace mw::mesa
