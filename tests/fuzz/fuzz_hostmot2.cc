// SPDX-License-Identifier: GPL-2.0-or-later
// A firmware with a damaged description and arbitrary register values: the driver rejects it, or drives it
// without writing more than it has announced.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <string>

#include "drivers/mesa/board/model.hh"
#include "drivers/mesa/hostmot2/board.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace {

using namespace mw::mesa;

/// Numbers from the input; zeros after its end.
class Numbers {
  public:
    Numbers(const std::uint8_t *data, std::size_t size) : data_(data), size_(size) {}

    template <class T>
    T next() {
        T number{};
        const std::size_t bytes = std::min(sizeof number, size_);
        std::memcpy(&number, data_, bytes);
        data_ += bytes;
        size_ -= bytes;
        return number;
    }
    bool isEmpty() const { return size_ == 0; }

  private:
    const std::uint8_t *data_;
    std::size_t size_;
};

class Bus final : public RegisterBus {
  public:
    explicit Bus(Numbers &numbers) : numbers_(numbers) {}

    std::map<std::uint16_t, std::uint32_t> registers;
    int max_writes = 0;

    std::string card_name() const override { return "card"; }
    std::vector<std::string> connectors() const override { return {"P1", "P2", "P3"}; }
    mw::Result<std::vector<std::uint32_t>> read_now(RegisterRange range) override {
        std::vector<std::uint32_t> words;
        for (int i = 0; i < range.count; ++i) {
            words.push_back(registers[static_cast<std::uint16_t>(range.address + 4 * i)]);
        }
        return words;
    }
    mw::Result<> write_now(std::uint16_t, std::span<const std::uint32_t>) override { return {}; }
    mw::Result<> set_lists(std::span<const RegisterRange>, int writes) override {
        max_writes = writes;
        return {};
    }
    void request() noexcept override {}
    CycleRead read(std::span<std::uint32_t> values, long) noexcept override {
        for (std::uint32_t &value : values) {
            value = numbers_.next<std::uint32_t>();
        }
        return static_cast<CycleRead>(numbers_.next<std::uint8_t>() % 3);
    }
    bool write(std::span<const RegisterWrite> writes) noexcept override {
        if (writes.size() > static_cast<std::size_t>(max_writes)) {
            std::abort();
        }
        return (numbers_.next<std::uint8_t>() & 1U) != 0;
    }
    bool take_rewrite() noexcept override { return (numbers_.next<std::uint8_t>() & 1U) != 0; }

  private:
    Numbers &numbers_;
};

class Pins final : public PinSpace {
  public:
    void *const volatile *make(const std::string &, PinType type, Access) override {
        slots_.push_back({.mask = type == PinType::BIT ? 1U : ~std::uint64_t{0}});
        slots_.back().pointer = &slots_.back().value;
        return &slots_.back().pointer;
    }
    void alias_param(const std::string &, const std::string &) override {}
    void change(Numbers &numbers) {
        if (!slots_.empty()) {
            Slot &slot = slots_[numbers.next<std::uint16_t>() % slots_.size()];
            slot.value = numbers.next<std::uint64_t>() & slot.mask;
        }
    }

  private:
    struct Slot {
        std::uint64_t mask = 0, value = 0;
        void *pointer = nullptr;
    };
    std::deque<Slot> slots_;
};

constexpr const char *CONFIGS[] = {"",
                                   "num_stepgens=2 num_encoders=1 num_pwmgens=1",
                                   "enable_raw",
                                   "num_leds=2",
                                   "sserial_port_0=00000000",
                                   "num_encoders=0 num_stepgens=0"};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Numbers numbers(data, size);
    const auto models = board::built_in_models();
    const auto &built_in = models[numbers.next<std::uint8_t>() % models.size()];
    const auto model = board::parse_model(built_in.text, std::string(built_in.name));
    const char *const config_text = CONFIGS[numbers.next<std::uint8_t>() % std::size(CONFIGS)];
    Bus bus(numbers);
    for (const RegisterValue &one : *encode_idrom(model->idrom)) {
        bus.registers[one.address] = one.value;
    }
    for (int damaged = numbers.next<std::uint8_t>() % 8; damaged > 0; --damaged) {
        auto at = bus.registers.begin();
        std::advance(at, numbers.next<std::uint16_t>() % bus.registers.size());
        at->second ^= numbers.next<std::uint32_t>();
    }
    const auto idrom = decode_idrom([&](std::uint16_t address, int count) {
        return bus.read_now({.address = address, .count = static_cast<std::uint16_t>(count)});
    });
    if (!idrom) {
        return 0;
    }
    const auto config = parse_config(config_text);
    auto driver = Board::make(bus, *idrom, *config);
    if (!driver) {
        return 0;
    }
    Pins pins;
    (*driver)->declare(pins);
    std::int64_t now_ns = 0;
    for (int cycle = 0; cycle < 20 || (!numbers.isEmpty() && cycle < 200); ++cycle) {
        constexpr long PERIOD_NS = 1'000'000;
        pins.change(numbers);
        (*driver)->read(PERIOD_NS, now_ns);
        (*driver)->write(PERIOD_NS, now_ns += PERIOD_NS);
    }
    return 0;
}
