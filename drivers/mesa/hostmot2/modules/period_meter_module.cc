// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/period_meter.hh"

namespace mw::mesa {

namespace {

enum PeriodMeterRegister { MODE, PERIOD, WIDTH, LIMIT };

class PeriodMeters final : public Module {
  public:
    explicit PeriodMeters(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)) {}

    void plan(Registers &registers) override {
        const auto count = static_cast<std::uint16_t>(instances_.size());
        // Reading the mode register latches period and width of the same pulse.
        modes_ = registers.read({module_.address(MODE), count}, ReadOrder::INPUT);
        periods_ = registers.read({module_.address(PERIOD), count}, ReadOrder::INPUT);
        widths_ = registers.read({module_.address(WIDTH), count}, ReadOrder::INPUT);
        int number = 0;
        for (Instance &one : instances_) {
            one.mode =
                registers.write(module_.address(MODE, number), WriteOrder::CONFIGURATION, Send::CHANGED);
            one.limit =
                registers.write(module_.address(LIMIT, number++), WriteOrder::CONFIGURATION, Send::CHANGED);
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            binding_.bind(space, fmt::format("periodm.{:02}", number++), PERIOD_METER_PINS, one.pins);
        }
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        int number = 0;
        for (Instance &one : instances_) {
            period_meter_read(one.pins, {registers.value(modes_, number), registers.value(periods_, number),
                                         registers.value(widths_, number), module_.clock_hz});
            ++number;
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        for (Instance &one : instances_) {
            registers.set(one.mode, period_meter_mode(one.pins, module_.clock_hz));
            registers.set(one.limit, period_meter_limit(one.pins, module_.clock_hz));
        }
    }

  private:
    struct Instance {
        PeriodMeterPins pins;
        WriteHandle mode, limit;
    };
    UsedModule module_;
    std::vector<Instance> instances_;
    PinBinding binding_;
    ReadHandle modes_, periods_, widths_;
};

}  // namespace

std::unique_ptr<Module> make_period_meters(const ModuleRequest &request) {
    return std::make_unique<PeriodMeters>(request);
}

}  // namespace mw::mesa
