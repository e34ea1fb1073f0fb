// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/factories.hh"

namespace mw::mesa {

namespace {

struct RawPins {
    std::uint32_t read_address = 0, read_data = 0, write_address = 0, write_data = 0;
    bool write_strobe = false, dump_state = false;
};
constexpr PinRow<RawPins> RAW_PINS[] = {
    {"read_address", Access::IN, &RawPins::read_address},   {"read_data", Access::OUT, &RawPins::read_data},
    {"write_address", Access::IN, &RawPins::write_address}, {"write_data", Access::IN, &RawPins::write_data},
    {"write_strobe", Access::IO, &RawPins::write_strobe},   {"dump_state", Access::IO, &RawPins::dump_state},
};

class Raw final : public Module {
  public:
    void plan(Registers &registers) override {
        data_ = registers.read({0, 1}, ReadOrder::OTHER);
        write_ = registers.write(0, WriteOrder::CONFIGURATION, Send::REQUESTED);
    }
    void declare(PinSpace &space) override { binding_.bind(space, "raw", RAW_PINS, pins_); }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        pins_.read_data = registers.value(data_);
        binding_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        constexpr std::uint32_t WHOLE_WORDS = 0xFFFC;
        const auto address = static_cast<std::uint16_t>(pins_.read_address & WHOLE_WORDS);
        if (address != address_ && registers.redirect(data_, address)) {
            address_ = address;
        }
        if (pins_.write_strobe && cycle.writing) {
            registers.set_address(write_, static_cast<std::uint16_t>(pins_.write_address));
            registers.request(write_, pins_.write_data);
            pins_.write_strobe = false;
        }
        dump_requested_ = dump_requested_ || pins_.dump_state;
        pins_.dump_state = false;
        binding_.store();
    }
    bool take_dump_request() noexcept override {
        const bool requested = dump_requested_;
        dump_requested_ = false;
        return requested;
    }

  private:
    RawPins pins_;
    PinBinding binding_;
    ReadHandle data_;
    WriteHandle write_;
    std::uint16_t address_ = 0;
    bool dump_requested_ = false;
};

}  // namespace

std::unique_ptr<Module> make_raw() {
    return std::make_unique<Raw>();
}

}  // namespace mw::mesa
