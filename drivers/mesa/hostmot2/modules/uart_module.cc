// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/uart.hh"

namespace mw::mesa {

namespace {

enum UartRegister { DATA, FIFO_COUNT, BIT_RATE, MODE };
constexpr std::uint32_t COUNT_MASK = 0x1F;
constexpr int RATE_BITS = 20;
constexpr std::size_t BYTES_PER_WORD = 4;

class Uarts final : public Module {
  public:
    explicit Uarts(const ModuleRequest &request)
        : tx_(*find_module(request.assignment, Gtag::UART_TX)),
          rx_(*find_module(request.assignment, Gtag::UART_RX)),
          instances_(static_cast<std::size_t>(std::min(tx_.instances, rx_.instances))) {}

    void plan(Registers &registers) override {
        int number = 0;
        for (Instance &one : instances_) {
            const auto add = [&](const UsedModule &module, int reg, Send send) {
                return registers.write(module.address(reg, number), WriteOrder::CONFIGURATION, send);
            };
            one.tx_count = registers.read({tx_.address(FIFO_COUNT, number), 1}, ReadOrder::OTHER);
            one.rx_count = registers.read({rx_.address(FIFO_COUNT, number), 1}, ReadOrder::OTHER);
            for (ReadHandle &slot : one.slots) {
                slot = registers.read({rx_.address(FIFO_COUNT, number), 1}, ReadOrder::OTHER);
            }
            one.clear_tx = add(tx_, FIFO_COUNT, Send::REQUESTED);
            one.clear_rx = add(rx_, FIFO_COUNT, Send::REQUESTED);
            one.tx_rate = add(tx_, BIT_RATE, Send::REPEATED);
            one.rx_rate = add(rx_, BIT_RATE, Send::REPEATED);
            one.tx_mode = add(tx_, MODE, Send::REPEATED);
            one.rx_mode = add(rx_, MODE, Send::REPEATED);
            for (WriteHandle &word : one.words) {
                word = registers.write(tx_.address(DATA, number), WriteOrder::RATE, Send::REQUESTED);
            }
            ++number;
        }
    }
    void declare(PinSpace &) override {}
    void add_ports(Ports &ports) override {
        int number = 0;
        for (Instance &one : instances_) {
            ports.uarts.push_back({fmt::format("uart.{}", number++), &one.uart});
        }
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        for (Instance &one : instances_) {
            one.sending = registers.value(one.tx_count) & COUNT_MASK;
            one.available = registers.value(one.rx_count) & COUNT_MASK;
            // There are fewer bytes than counted if another host has read them or the board was reset.
            if (one.scheduled <= one.available) {
                take(registers, one);
                one.available -= one.scheduled;
            }
        }
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        int number = 0;
        for (Instance &one : instances_) {
            const bool usable = cycle.fresh && cycle.writing;
            if (usable) {
                setup(registers, one);
                send(registers, one, number);
            }
            schedule(registers, one, usable ? one.uart.wanted(one.available) : 0, number);
            ++number;
        }
    }

  private:
    struct Instance {
        Uart uart;
        ReadHandle tx_count, rx_count;
        std::array<ReadHandle, UART_RX_SLOTS> slots;
        std::array<WriteHandle, UART_TX_WORDS> words;
        WriteHandle clear_tx, clear_rx, tx_rate, rx_rate, tx_mode, rx_mode;
        std::size_t sending = 0;    ///< words in the transmit FIFO
        std::size_t available = 0;  ///< bytes in the receive FIFO
        std::size_t scheduled = 0;  ///< number of bytes that the current request reads from it
    };

    static void take(const Registers &registers, Instance &one) noexcept {
        for (std::size_t i = 0; i * BYTES_PER_WORD < one.scheduled; ++i) {
            const auto bytes = bytes_of(registers.value(one.slots[i]));
            one.uart.take(
                std::span(bytes).first(std::min(one.scheduled - i * BYTES_PER_WORD, BYTES_PER_WORD)));
        }
    }
    void setup(Registers &registers, Instance &one) const noexcept {
        Uart::Settings settings;
        if (!one.uart.take_settings(settings)) {
            return;
        }
        registers.request(one.clear_tx, 0);
        registers.request(one.clear_rx, 0);
        registers.request(one.tx_rate, uart_rate(settings.bitrate, tx_.clock_hz, RATE_BITS));
        registers.request(one.rx_rate, uart_rate(settings.bitrate, rx_.clock_hz, RATE_BITS));
        if (settings.tx_mode >= 0) {
            registers.request(one.tx_mode, static_cast<std::uint32_t>(settings.tx_mode));
        }
        if (settings.rx_mode >= 0) {
            registers.request(one.rx_mode, static_cast<std::uint32_t>(settings.rx_mode));
        }
    }
    /// The address of the data register determines the number of bytes in a word.
    void send(Registers &registers, Instance &one, int number) const noexcept {
        const std::size_t space = UART_TX_WORDS - std::min(one.sending, UART_TX_WORDS);
        for (std::size_t i = 0; i < space && one.uart.hasQueued(); ++i) {
            std::array<std::uint8_t, BYTES_PER_WORD> bytes{};
            const std::size_t count = one.uart.next(bytes);
            registers.set_address(one.words[i], data_address(tx_, number, count));
            registers.request(one.words[i], word_of(std::span(bytes).first(count)));
        }
    }
    void schedule(Registers &registers, Instance &one, std::size_t wanted, int number) const noexcept {
        one.scheduled = wanted;
        for (std::size_t i = 0; i < one.slots.size(); ++i) {
            const std::size_t done = i * BYTES_PER_WORD;
            const std::uint16_t address =
                done < wanted ? data_address(rx_, number, std::min(wanted - done, BYTES_PER_WORD))
                              : rx_.address(FIFO_COUNT, number);
            if (!registers.redirect(one.slots[i], address)) {
                one.scheduled = 0;  // this bus cannot receive
            }
        }
    }
    static std::uint16_t data_address(const UsedModule &module, int number, std::size_t bytes) noexcept {
        return static_cast<std::uint16_t>(module.address(DATA, number) + BYTES_PER_WORD * (bytes - 1));
    }

    UsedModule tx_, rx_;
    std::vector<Instance> instances_;
};

}  // namespace

std::unique_ptr<Module> make_uarts(const ModuleRequest &request) {
    // Transmitters and receivers are two modules of the firmware.
    const bool is_pair = find_module(request.assignment, Gtag::UART_RX) != nullptr;
    return is_pair ? std::make_unique<Uarts>(request) : nullptr;
}

}  // namespace mw::mesa
