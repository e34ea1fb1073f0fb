// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/buffered_spi.hh"
#include "drivers/mesa/hostmot2/modules/factories.hh"

namespace mw::mesa {

namespace {

enum SpiRegister { FIFO, DESCRIPTOR, FIFO_COUNT };

class BufferedSpis final : public Module {
  public:
    explicit BufferedSpis(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)) {}

    void plan(Registers &registers) override {
        int number = 0;
        for (Instance &one : instances_) {
            const std::uint16_t count = module_.address(FIFO_COUNT, number);
            one.count = registers.read({count, 1}, ReadOrder::OTHER);
            for (ReadHandle &slot : one.slots) {
                slot = registers.read({count, 1}, ReadOrder::OTHER);
            }
            one.clear = registers.write(count, WriteOrder::CONFIGURATION, Send::REQUESTED);
            for (WriteHandle &descriptor : one.descriptors) {
                descriptor = registers.write(module_.address(DESCRIPTOR, number), WriteOrder::CONFIGURATION,
                                             Send::REPEATED);
            }
            for (WriteHandle &word : one.words) {
                word = registers.write(module_.address(FIFO, number), WriteOrder::RATE, Send::REQUESTED);
            }
            ++number;
        }
    }
    void declare(PinSpace &) override {}
    void add_ports(Ports &ports) override {
        int number = 0;
        for (Instance &one : instances_) {
            ports.spis.push_back({fmt::format("bspi.{}", number++), &one.spi});
        }
    }
    void read(const Registers &registers, const Cycle &cycle) noexcept override {
        for (Instance &one : instances_) {
            take(registers, cycle, one);
            one.spi.call_read();
        }
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        int number = 0;
        for (Instance &one : instances_) {
            one.spi.call_write();
            const bool usable = cycle.fresh && cycle.writing;
            if (!usable && one.expected > 0) {
                one.clear_due = true;  // the words that were removed with the lost answer are unknown
            }
            one.expected = 0;
            if (usable) {
                setup(registers, one);
                send(registers, one, number);
            }
            schedule(registers, one, number++);
        }
    }

  private:
    struct Instance {
        BufferedSpi spi;
        ReadHandle count;
        std::array<ReadHandle, SPI_WORDS> slots;
        std::array<WriteHandle, SPI_CHANNELS> descriptors;
        std::array<WriteHandle, SPI_WORDS> words;
        WriteHandle clear;
        std::size_t expected = 0;                          ///< words that the devices return after this write
        std::array<std::uint32_t *, SPI_WORDS> targets{};  ///< their destinations; null: none
        bool clear_due = true;
    };

    /// Reads the words of a cycle together. If their number differs from the expected one, the FIFOs are
    /// cleared.
    static void take(const Registers &registers, const Cycle &cycle, Instance &one) noexcept {
        constexpr std::uint32_t RECEIVED_MASK = 0x1F;
        const std::size_t received = registers.value(one.count) & RECEIVED_MASK;
        if (received != one.expected || (cycle.has_lost_write && one.expected > 0)) {
            one.clear_due = true;
            return;
        }
        for (std::size_t i = 0; i < one.expected; ++i) {
            if (one.targets[i] != nullptr) {
                *one.targets[i] = registers.value(one.slots[i]);
            }
        }
    }
    /// Descriptors are written from the last to the first, always all of them.
    void setup(Registers &registers, Instance &one) const noexcept {
        if (one.spi.take_setup()) {
            for (std::size_t i = 0; i < SPI_CHANNELS; ++i) {
                registers.request(one.descriptors[SPI_CHANNELS - 1 - i],
                                  one.spi.descriptor(i, module_.clock_hz));
            }
            one.clear_due = true;
        }
        if (one.clear_due) {
            registers.request(one.clear, 0);
            one.clear_due = false;
        }
    }
    void send(Registers &registers, Instance &one, int number) const noexcept {
        std::size_t used = 0;
        const auto add = [&](int channel, std::uint32_t value, std::uint32_t *target) {
            if (used == one.words.size()) {
                return;
            }
            registers.set_address(one.words[used],
                                  static_cast<std::uint16_t>(module_.address(FIFO, number) + 4 * channel));
            registers.request(one.words[used++], value);
            if (one.spi.hasEcho(channel)) {
                one.targets[one.expected++] = target;
            }
        };
        for (const BufferedSpi::Frame &frame : one.spi.frames()) {
            add(frame.channel, *frame.sent, frame.received);
        }
        for (const BufferedSpi::Word &word : one.spi.take_words()) {
            add(word.channel, word.value, nullptr);
        }
    }
    void schedule(Registers &registers, Instance &one, int number) const noexcept {
        for (std::size_t i = 0; i < one.slots.size(); ++i) {
            const int reg = i < one.expected ? FIFO : FIFO_COUNT;
            if (!registers.redirect(one.slots[i], module_.address(reg, number))) {
                one.expected = 0;  // this bus cannot receive
            }
        }
    }

    UsedModule module_;
    std::vector<Instance> instances_;
};

}  // namespace

std::unique_ptr<Module> make_bspis(const ModuleRequest &request) {
    return std::make_unique<BufferedSpis>(request);
}

}  // namespace mw::mesa
