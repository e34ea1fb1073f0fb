// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/three_phase_pwm.hh"

namespace mw::mesa {

namespace {

enum ThreePhaseRegister { VALUE, ENABLE, SETUP, RATE };

struct BoardPins {
    std::uint32_t frequency = 20'000;  ///< [Hz]
};
constexpr PinRow<BoardPins> BOARD_PINS[] = {{"frequency", Access::RW, &BoardPins::frequency}};

class ThreePhaseGenerators final : public Module {
  public:
    explicit ThreePhaseGenerators(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)) {}

    void plan(Registers &registers) override {
        enables_ = registers.read({module_.address(ENABLE), static_cast<std::uint16_t>(instances_.size())},
                                  ReadOrder::OTHER);
        rate_ = registers.write(module_.address(RATE), WriteOrder::CONFIGURATION, Send::CHANGED);
        int number = 0;
        for (Instance &one : instances_) {
            one.setup =
                registers.write(module_.address(SETUP, number), WriteOrder::CONFIGURATION, Send::CHANGED);
            one.value = registers.write(module_.address(VALUE, number), WriteOrder::RATE, Send::ALWAYS);
            one.enable = registers.write(module_.address(ENABLE, number), WriteOrder::RATE, Send::REQUESTED);
            ++number;
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            binding_.bind(space, fmt::format("3pwmgen.{:02}", number++), THREE_PHASE_PINS, one.pins);
        }
        binding_.bind(space, "3pwmgen", BOARD_PINS, board_);
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        int number = 0;
        for (Instance &one : instances_) {
            three_phase_read(one.state, one.pins, registers.value(enables_, number++));
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        const ThreePhaseRate rate = three_phase_rate(board_.frequency, module_.clock_hz);
        board_.frequency = rate.frequency_hz;
        registers.set(rate_, rate.rate);
        for (Instance &one : instances_) {
            registers.set(one.setup, three_phase_setup(one.pins, rate.pwm_clock_hz));
            registers.set(one.value, three_phase_values(one.pins));
            const bool sending = cycle.writing && cycle.fresh;
            if (const auto enable = three_phase_enable(one.state, one.pins, sending); enable.isDue) {
                registers.request(one.enable, enable.value);
            }
        }
        binding_.store();
    }

  private:
    struct Instance {
        ThreePhasePins pins;
        ThreePhaseState state;
        WriteHandle value, enable, setup;
    };
    UsedModule module_;
    std::vector<Instance> instances_;
    BoardPins board_;
    PinBinding binding_;
    ReadHandle enables_;
    WriteHandle rate_;
};

}  // namespace

std::unique_ptr<Module> make_three_phase_pwms(const ModuleRequest &request) {
    return std::make_unique<ThreePhaseGenerators>(request);
}

}  // namespace mw::mesa
