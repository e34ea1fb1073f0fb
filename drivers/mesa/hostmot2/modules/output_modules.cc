// SPDX-License-Identifier: GPL-2.0-or-later
// Words of outputs: solid state relays, which have a drive frequency, and plain outputs (OutM).
#include <array>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/small.hh"

namespace mw::mesa {

namespace {

constexpr std::size_t MAX_BITS = 32;
constexpr std::uint8_t FIRST_OUTPUT = 0x81, LAST_OUTPUT = 0x9F;

class OutputWords final : public Module {
  public:
    OutputWords(const ModuleRequest &request, const char *name)
        : module_(request.module), name_(name), has_rate_(request.module.descriptor.gtag == Gtag::SSR),
          instances_(static_cast<std::size_t>(request.module.instances)) {
        for (const UsedPin &pin : request.assignment.pins) {
            const bool is_output = pin.module == module_.descriptor.gtag && pin.function >= FIRST_OUTPUT &&
                                   pin.function <= LAST_OUTPUT &&
                                   static_cast<std::size_t>(pin.instance) < instances_.size();
            if (is_output) {
                const auto bit = static_cast<unsigned>(pin.function - FIRST_OUTPUT);
                instances_[static_cast<std::size_t>(pin.instance)].used |= 1U << bit;
            }
        }
    }

    void plan(Registers &registers) override {
        enum OutputRegister { DATA, RATE };
        int number = 0;
        for (Instance &one : instances_) {
            if (has_rate_) {
                one.rate_word =
                    registers.write(module_.address(RATE, number), WriteOrder::CONFIGURATION, Send::CHANGED);
            }
            one.data = registers.write(module_.address(DATA, number), WriteOrder::RATE, Send::CHANGED);
            ++number;
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            const std::string name = fmt::format("{}.{:02}", name_, number++);
            if (has_rate_) {
                binding_.add(space, name + ".rate", PinType::U32, Access::IN, &one.rate_hz);
            }
            for (std::size_t i = 0; i < MAX_BITS; ++i) {
                if (((one.used >> i) & 1U) != 0) {
                    binding_.add(space, fmt::format("{}.out-{:02}", name, i), PinType::BIT, Access::IN,
                                 &one.out[i]);
                    binding_.add(space, fmt::format("{}.invert-{:02}", name, i), PinType::BIT, Access::IN,
                                 &one.invert[i]);
                }
            }
        }
    }
    void read(const Registers &, const Cycle &) noexcept override {}
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        for (Instance &one : instances_) {
            std::uint32_t word = 0;
            for (std::size_t i = 0; i < MAX_BITS; ++i) {
                word |= one.out[i] != one.invert[i] ? 1U << i : 0U;
            }
            registers.set(one.data, word & one.used);
            if (has_rate_) {
                registers.set(one.rate_word, ssr_rate(one.rate_hz, module_.clock_hz));
            }
        }
    }

  private:
    struct Instance {
        std::uint32_t used = 0, rate_hz = 1'000'000;
        std::array<bool, MAX_BITS> out{}, invert{};
        WriteHandle data, rate_word;
    };
    UsedModule module_;
    const char *name_;
    bool has_rate_;
    std::vector<Instance> instances_;
    PinBinding binding_;
};

}  // namespace

std::unique_ptr<Module> make_ssrs(const ModuleRequest &request) {
    return std::make_unique<OutputWords>(request, "ssr");
}
std::unique_ptr<Module> make_outms(const ModuleRequest &request) {
    return std::make_unique<OutputWords>(request, "outm");
}

}  // namespace mw::mesa
