// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/one_shot.hh"

namespace mw::mesa {

namespace {

enum OneShotRegister { WIDTH_1, WIDTH_2, FILTER_1, FILTER_2, RATE, CONTROL };

class OneShots final : public Module {
  public:
    explicit OneShots(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)) {}

    void plan(Registers &registers) override {
        controls_ = registers.read({module_.address(CONTROL), static_cast<std::uint16_t>(instances_.size())},
                                   ReadOrder::INPUT);
        int number = 0;
        for (Instance &one : instances_) {
            const auto add = [&](int reg) {
                return registers.write(module_.address(reg, number), WriteOrder::CONFIGURATION,
                                       Send::CHANGED);
            };
            one.width1 = add(WIDTH_1);
            one.width2 = add(WIDTH_2);
            one.filter1 = add(FILTER_1);
            one.filter2 = add(FILTER_2);
            one.rate = add(RATE);
            one.control =
                registers.write(module_.address(CONTROL, number++), WriteOrder::RATE, Send::CHANGED);
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            binding_.bind(space, fmt::format("oneshot.{:02}", number++), ONE_SHOT_PINS, one.pins);
        }
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        int number = 0;
        for (Instance &one : instances_) {
            one_shot_read(one.pins, registers.value(controls_, number++));
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        const std::uint32_t clock = module_.clock_hz;
        for (Instance &one : instances_) {
            registers.set(one.width1, one_shot_width(one.pins.width1, clock));
            registers.set(one.width2, one_shot_width(one.pins.width2, clock));
            registers.set(one.filter1, one_shot_filter(one.pins.filter1, clock));
            registers.set(one.filter2, one_shot_filter(one.pins.filter2, clock));
            registers.set(one.rate, one_shot_rate(one.pins.rate, clock));
            registers.set(one.control, one_shot_control(one.pins));
        }
    }

  private:
    struct Instance {
        OneShotPins pins;
        WriteHandle width1, width2, filter1, filter2, rate, control;
    };
    UsedModule module_;
    std::vector<Instance> instances_;
    PinBinding binding_;
    ReadHandle controls_;
};

}  // namespace

std::unique_ptr<Module> make_one_shots(const ModuleRequest &request) {
    return std::make_unique<OneShots>(request);
}

}  // namespace mw::mesa
