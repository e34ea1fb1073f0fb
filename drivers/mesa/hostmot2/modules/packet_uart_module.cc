// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/packet_uart.hh"
#include "drivers/mesa/hostmot2/modules/uart.hh"

namespace mw::mesa {

namespace {

enum PacketUartRegister { DATA, COUNT, BIT_RATE, MODE };
constexpr int RATE_BITS = 24;
constexpr std::size_t BYTES_PER_WORD = 4;

class PacketUarts final : public Module {
  public:
    explicit PacketUarts(const ModuleRequest &request)
        : tx_(*find_module(request.assignment, Gtag::PKT_UART_TX)),
          rx_(*find_module(request.assignment, Gtag::PKT_UART_RX)),
          instances_(static_cast<std::size_t>(std::min(tx_.instances, rx_.instances))) {
        for (Instance &one : instances_) {
            one.uart.describe(tx_.clock_hz, tx_.descriptor.version);
        }
    }

    void plan(Registers &registers) override {
        int number = 0;
        for (Instance &one : instances_) {
            const auto add = [&](const UsedModule &module, int reg, Send send) {
                return registers.write(module.address(reg, number), WriteOrder::CONFIGURATION, send);
            };
            one.tx_state = registers.read({tx_.address(MODE, number), 1}, ReadOrder::OTHER);
            one.rx_state = registers.read({rx_.address(MODE, number), 1}, ReadOrder::OTHER);
            for (ReadHandle &slot : one.slots) {
                slot = registers.read({rx_.address(MODE, number), 1}, ReadOrder::OTHER);
            }
            one.clear_tx = add(tx_, MODE, Send::REQUESTED);
            one.clear_rx = add(rx_, MODE, Send::REQUESTED);
            one.tx_rate = add(tx_, BIT_RATE, Send::REPEATED);
            one.rx_rate = add(rx_, BIT_RATE, Send::REPEATED);
            one.tx_mode = add(tx_, MODE, Send::REPEATED);
            one.rx_mode = add(rx_, MODE, Send::REPEATED);
            for (WriteHandle &word : one.words) {
                word = registers.write(tx_.address(DATA, number), WriteOrder::RATE, Send::REQUESTED);
            }
            one.send_count = registers.write(tx_.address(COUNT, number), WriteOrder::RATE, Send::REQUESTED);
            ++number;
        }
    }
    void declare(PinSpace &) override {}
    void add_ports(Ports &ports) override {
        int number = 0;
        for (Instance &one : instances_) {
            ports.packet_uarts.push_back({fmt::format("pktuart.{}", number++), &one.uart});
        }
    }
    void read(const Registers &registers, const Cycle &cycle) noexcept override {
        for (Instance &one : instances_) {
            one.uart.show_modes(registers.value(one.tx_state), registers.value(one.rx_state));
            one.frames = (registers.value(one.rx_state) & packet_uart_bit::FRAMES) >> 16U;
            take(registers, one);
            if (cycle.has_lost_write && one.sending) {
                // Words of a frame may be missing in the board, and would be mixed with the next frame.
                one.tx_clear_due = true;
                one.frame_left = 0;
                one.uart.count_failure();
            }
            one.sending = one.frame_left > 0;
            one.rx_clear_due = one.rx_clear_due || (cycle.has_lost_write && one.rx_clearing);
            one.rx_clearing = false;
        }
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        int number = 0;
        for (Instance &one : instances_) {
            const bool usable = cycle.fresh && cycle.writing;
            if (!usable && one.step != Step::NONE) {
                one.rx_clear_due = true;  // the words that were removed with the lost answer are unknown
                one.uart.drop_frame();
            }
            one.step = Step::NONE;
            if (usable) {
                setup(registers, one);
                send(registers, one);
                one.step = next_step(one);
            }
            schedule(registers, one, number++);
        }
    }

  private:
    /// The data that the current request reads from the receiver.
    enum class Step : std::uint8_t { NONE, SIZE, BYTES };
    struct Instance {
        PacketUart uart;
        ReadHandle tx_state, rx_state;
        std::array<ReadHandle, PACKET_RX_SLOTS> slots;
        std::array<WriteHandle, PACKET_TX_WORDS> words;
        WriteHandle send_count, clear_tx, clear_rx, tx_rate, rx_rate, tx_mode, rx_mode;
        Step step = Step::NONE;
        std::uint32_t frames = 0;  ///< in the board
        bool tx_clear_due = false, rx_clear_due = false, sending = false, rx_clearing = false;
        std::array<std::uint8_t, MAX_FRAME_BYTES + 1> frame{};  ///< being sent
        std::size_t frame_size = 0, frame_left = 0;
    };

    static Step next_step(const Instance &one) noexcept {
        if (one.uart.missing() > 0) {
            return Step::BYTES;
        }
        return one.frames > 0 && one.uart.hasSpace() ? Step::SIZE : Step::NONE;
    }
    static void take(const Registers &registers, Instance &one) noexcept {
        constexpr std::uint32_t SIZE_MASK = 0x3FF, LINE_ERRORS = 0xC000;
        if (one.step == Step::SIZE) {
            const std::uint32_t count = registers.value(one.slots[0]);
            one.uart.begin_frame(count & SIZE_MASK);
            if ((count & LINE_ERRORS) != 0) {
                one.uart.count_failure();
            }
            one.frames = one.frames > 0 ? one.frames - 1 : 0;
        }
        for (std::size_t i = 0; one.step == Step::BYTES && i < one.slots.size() && one.uart.missing() > 0;
             ++i) {
            one.uart.take(bytes_of(registers.value(one.slots[i])));
        }
    }
    void setup(Registers &registers, Instance &one) const noexcept {
        PacketUart::Settings settings;
        if (one.uart.take_settings(settings)) {
            one.tx_clear_due = one.tx_clear_due || settings.tx_cleared;
            one.rx_clear_due = one.rx_clear_due || settings.rx_cleared;
            registers.request(one.tx_rate, uart_rate(settings.bitrate, tx_.clock_hz, RATE_BITS));
            registers.request(one.rx_rate, uart_rate(settings.bitrate, rx_.clock_hz, RATE_BITS));
            if (settings.tx_mode >= 0) {
                registers.request(one.tx_mode, static_cast<std::uint32_t>(settings.tx_mode));
            }
            if (settings.rx_mode >= 0) {
                registers.request(one.rx_mode, static_cast<std::uint32_t>(settings.rx_mode));
            }
        }
        if (one.uart.take_reset()) {
            one.tx_clear_due = one.rx_clear_due = true;
            one.frame_left = 0;
        }
        if (one.tx_clear_due) {
            registers.request(one.clear_tx, packet_uart_bit::CLEAR);
            one.sending = true;
        }
        if (one.rx_clear_due) {
            registers.request(one.clear_rx, packet_uart_bit::CLEAR);
            one.frames = 0;
            one.rx_clearing = true;
        }
        one.tx_clear_due = one.rx_clear_due = false;
    }
    /// Sends the words of a frame, in as many cycles as needed, and then its size, which starts the
    /// transmission.
    static void send(Registers &registers, Instance &one) noexcept {
        if (one.frame_left == 0) {
            one.frame_size = one.frame_left = one.uart.next_frame(one.frame);
        }
        if (one.frame_left == 0) {
            return;
        }
        one.sending = true;
        for (std::size_t i = 0; i < one.words.size() && one.frame_left > 0; ++i) {
            const std::size_t count = std::min(one.frame_left, BYTES_PER_WORD);
            const auto bytes = std::span(one.frame).subspan(one.frame_size - one.frame_left, count);
            registers.request(one.words[i], word_of(bytes));
            one.frame_left -= count;
        }
        if (one.frame_left == 0) {
            registers.request(one.send_count, static_cast<std::uint32_t>(one.frame_size));
        }
    }
    void schedule(Registers &registers, Instance &one, int number) const noexcept {
        const std::size_t words = (one.uart.missing() + BYTES_PER_WORD - 1) / BYTES_PER_WORD;
        for (std::size_t i = 0; i < one.slots.size(); ++i) {
            std::uint16_t address = rx_.address(MODE, number);
            if (one.step == Step::SIZE && i == 0) {
                address = rx_.address(COUNT, number);
            } else if (one.step == Step::BYTES && i < words) {
                address = rx_.address(DATA, number);
            }
            if (!registers.redirect(one.slots[i], address)) {
                one.step = Step::NONE;  // this bus cannot receive
            }
        }
    }

    UsedModule tx_, rx_;
    std::vector<Instance> instances_;
};

}  // namespace

std::unique_ptr<Module> make_packet_uarts(const ModuleRequest &request) {
    const bool is_pair = find_module(request.assignment, Gtag::PKT_UART_RX) != nullptr;
    return is_pair ? std::make_unique<PacketUarts>(request) : nullptr;
}

}  // namespace mw::mesa
