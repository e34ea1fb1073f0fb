// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/rc_pwm.hh"

namespace mw::mesa {

namespace {

class RcPwmGenerators final : public Module {
  public:
    explicit RcPwmGenerators(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)) {}

    void plan(Registers &registers) override {
        enum RcPwmRegister { WIDTH, RATE };
        rate_ = registers.write(module_.address(RATE), WriteOrder::CONFIGURATION, Send::CHANGED);
        int number = 0;
        for (Instance &one : instances_) {
            one.width = registers.write(module_.address(WIDTH, number++), WriteOrder::RATE, Send::CHANGED);
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            binding_.bind(space, fmt::format("rcpwmgen.{:02}", number++), RC_PWM_PINS, one.pins);
        }
        binding_.add(space, "rcpwmgen.rate", PinType::FLOAT, Access::IN, &frequency_hz_);
    }
    void read(const Registers &, const Cycle &) noexcept override {}
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        registers.set(rate_, rc_pwm_rate(frequency_hz_, module_.clock_hz));
        for (Instance &one : instances_) {
            registers.set(one.width, rc_pwm_width(one.pins, module_.clock_hz));
        }
    }

  private:
    struct Instance {
        RcPwmPins pins;
        WriteHandle width;
    };
    UsedModule module_;
    std::vector<Instance> instances_;
    double frequency_hz_ = 50.0;
    PinBinding binding_;
    WriteHandle rate_;
};

}  // namespace

std::unique_ptr<Module> make_rc_pwms(const ModuleRequest &request) {
    return std::make_unique<RcPwmGenerators>(request);
}

}  // namespace mw::mesa
