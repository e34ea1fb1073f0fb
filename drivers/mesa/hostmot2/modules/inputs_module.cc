// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/inputs.hh"

namespace mw::mesa {

namespace {

class ScannedInputs final : public Module {
  public:
    ScannedInputs(const ModuleRequest &request, const char *name)
        : module_(request.module), name_(name),
          instances_(static_cast<std::size_t>(request.module.instances)) {}

    Result<> prepare(RegisterBus &bus) override {
        int number = 0;
        for (Instance &one : instances_) {
            const auto control = bus.read_now({module_.address(CONTROL, number++), 1});
            if (!control) {
                return std::unexpected(control.error());
            }
            one.pins.scan_width = inputs_width(control->front());
        }
        return {};
    }

    void plan(Registers &registers) override {
        const auto count = static_cast<std::uint16_t>(instances_.size());
        const auto add_read = [&](int reg) {
            return registers.read({module_.address(reg), count}, ReadOrder::INPUT);
        };
        filtered_ = add_read(FILTERED);
        raw_ = add_read(RAW);
        counters_ = add_read(COUNTERS);
        int number = 0;
        for (Instance &one : instances_) {
            const auto add = [&](int reg) {
                return registers.write(module_.address(reg, number), WriteOrder::CONFIGURATION,
                                       Send::CHANGED);
            };
            one.control = add(CONTROL);
            one.filter = add(FILTER);
            one.modes = add(COUNTERS);
            ++number;
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            declare_one(space, fmt::format("{}.{:02}", name_, number++), one.pins);
        }
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        int number = 0;
        for (Instance &one : instances_) {
            inputs_show(one.pins, registers.value(filtered_, number), registers.value(raw_, number));
            inputs_count(one.state, one.pins, registers.value(counters_, number));
            ++number;
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        for (Instance &one : instances_) {
            registers.set(one.control, inputs_control(one.pins, module_.clock_hz));
            registers.set(one.filter, inputs_filter(one.pins));
            registers.set(one.modes, inputs_wheel_modes(one.pins));
        }
        binding_.store();
    }

  private:
    enum InputsRegister { CONTROL, FILTER, FILTERED, RAW, COUNTERS };
    struct Instance {
        InputsPins pins;
        InputsState state;
        WriteHandle control, filter, modes;
    };

    void declare_one(PinSpace &space, const std::string &name, InputsPins &pins) {
        const auto bit = [&](const std::string &pin, Access access, bool &value) {
            binding_.add(space, name + "." + pin, PinType::BIT, access, &value);
        };
        for (std::size_t i = 0; i < pins.scan_width; ++i) {
            bit(fmt::format("input-{:02}", i), Access::OUT, pins.input[i]);
            bit(fmt::format("input-{:02}-not", i), Access::OUT, pins.input_not[i]);
            bit(fmt::format("raw-input-{:02}", i), Access::OUT, pins.raw[i]);
            bit(fmt::format("raw-input-{:02}-not", i), Access::OUT, pins.raw_not[i]);
            bit(fmt::format("input-{:02}-slow", i), Access::IN, pins.slow[i]);
        }
        for (std::size_t i = 0; i < HAND_WHEELS; ++i) {
            binding_.add(space, fmt::format("{}.enc{}-count", name, i), PinType::S32, Access::OUT,
                         &pins.count[i]);
            bit(fmt::format("enc{}-reset", i), Access::IN, pins.reset[i]);
            bit(fmt::format("enc{}_4xmode", i), Access::RW, pins.four_x[i]);
        }
        binding_.bind(space, name, INPUTS_PARAMS, pins);
    }

    UsedModule module_;
    const char *name_;
    std::vector<Instance> instances_;
    PinBinding binding_;
    ReadHandle filtered_, raw_, counters_;
};

}  // namespace

std::unique_ptr<Module> make_inmuxs(const ModuleRequest &request) {
    return std::make_unique<ScannedInputs>(request, "inmux");
}
std::unique_ptr<Module> make_inms(const ModuleRequest &request) {
    return std::make_unique<ScannedInputs>(request, "inm");
}

}  // namespace mw::mesa
