// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/resolver.hh"

namespace mw::mesa {

namespace {

class Resolvers final : public Module {
  public:
    explicit Resolvers(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)) {}

    bool isCounting() const noexcept override { return true; }
    void plan(Registers &registers) override {
        enum ResolverRegister { COMMAND, DATA, STATUS, VELOCITY, POSITION };
        const auto count = static_cast<std::uint16_t>(instances_.size());
        status_ = registers.read({module_.address(STATUS), 1}, ReadOrder::OTHER);
        velocities_ = registers.read({module_.address(VELOCITY), count}, ReadOrder::OTHER);
        positions_ = registers.read({module_.address(POSITION), count}, ReadOrder::OTHER);
        data_ = registers.write(module_.address(DATA), WriteOrder::CONFIGURATION, Send::REPEATED);
        command_ = registers.write(module_.address(COMMAND), WriteOrder::CONFIGURATION, Send::REPEATED);
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            binding_.bind(space, fmt::format("resolver.{:02}", number++), RESOLVER_PINS, one.pins);
        }
        binding_.add(space, "resolver.excitation-khz", PinType::FLOAT, Access::RW, &excitation_khz_);
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        const std::uint32_t errors = registers.value(status_);
        ResolverReading reading;
        reading.excitation_hz = static_cast<double>(module_.clock_hz) / excitation_.divisor;
        int number = 0;
        for (Instance &one : instances_) {
            reading.has_error = ((errors >> static_cast<unsigned>(number)) & 1U) != 0;
            reading.velocity = registers.value(velocities_, number);
            reading.position = registers.value(positions_, number);
            resolver_read(one.state, one.pins, reading);
            ++number;
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        const Excitation wanted = resolver_excitation(excitation_khz_);
        excitation_khz_ = wanted.khz;
        if (wanted.command != excitation_.command && wanted.command != 0 && cycle.writing) {
            registers.request(data_, 0);
            registers.request(command_, wanted.command);
            excitation_ = wanted;
        }
        binding_.store();
    }

  private:
    struct Instance {
        ResolverPins pins;
        ResolverState state;
    };
    UsedModule module_;
    std::vector<Instance> instances_;
    double excitation_khz_ = -1.0;
    Excitation excitation_;
    PinBinding binding_;
    ReadHandle status_, velocities_, positions_;
    WriteHandle data_, command_;
};

}  // namespace

std::unique_ptr<Module> make_resolvers(const ModuleRequest &request) {
    return std::make_unique<Resolvers>(request);
}

}  // namespace mw::mesa
