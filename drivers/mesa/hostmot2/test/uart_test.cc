// SPDX-License-Identifier: GPL-2.0-or-later
#include <deque>
#include <random>

#include "drivers/mesa/hostmot2/modules/uart.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t TX = 0x6100, TX_COUNT = 0x6200, TX_RATE = 0x6300, TX_MODE = 0x6400, RX = 0x6500,
                        RX_COUNT = 0x6600, RX_RATE = 0x6700, RX_MODE = 0x6800, STRIDE = 0x10;

/// Simulates the second of two UARTs: FIFOs of 16 words and 16 bytes.
class UartOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        Idrom idrom = firmware();
        for (const auto &[gtag, base] : {std::pair{Gtag::UART_TX, TX}, {Gtag::UART_RX, RX}}) {
            ModuleDescriptor module = module_of(gtag, 2, base);
            module.instance_stride = 1;
            idrom.modules.push_back(module);
        }
        idrom.header.instance_strides[1] = STRIDE;
        bus.on_write = [&](RegisterWrite write) {
            if (write.address >= TX + STRIDE && write.address < TX + 2 * STRIDE) {
                EXPECT_LT(tx_words, 16U) << "the FIFO is full";
                ++tx_words;
                for (unsigned i = 0; i <= (write.address - TX - STRIDE) / 4U; ++i) {
                    line.push_back(static_cast<std::uint8_t>(write.value >> (8 * i)));
                }
            } else if (write.address == RX_COUNT + STRIDE) {
                fifo.clear();
            }
        };
        bus.on_read_register = [&](std::uint16_t address) -> std::optional<std::uint32_t> {
            if (address == TX_COUNT + STRIDE) {
                return static_cast<std::uint32_t>(tx_words);
            }
            if (address == RX_COUNT + STRIDE) {
                return static_cast<std::uint32_t>(fifo.size());
            }
            if (address >= RX + STRIDE && address < RX + 2 * STRIDE) {
                std::uint32_t word = 0;
                for (unsigned i = 0; i <= (address - RX - STRIDE) / 4U; ++i) {
                    EXPECT_FALSE(fifo.empty()) << "nothing to read";
                    word |= fifo.empty() ? 0U : std::uint32_t{fifo.front()} << (8 * i);
                    if (!fifo.empty()) {
                        fifo.pop_front();
                    }
                }
                return word;
            }
            return std::nullopt;
        };
        load(idrom);
        const Ports ports = board->ports();
        ASSERT_EQ(ports.uarts.size(), 2U);
        EXPECT_EQ(ports.uarts[1].name, "uart.1");
        uart = ports.uarts[1].port;
        cycle();
    }

    Uart *uart = nullptr;
    std::size_t tx_words = 0;
    std::vector<std::uint8_t> line;
    std::deque<std::uint8_t> fifo;
};

TEST_F(UartOfBoard, WritesNothingBeforeItsSetup) {
    cycle(3);
    EXPECT_EQ(bus.last(TX_RATE + STRIDE), -1);
    uart->setup({115200, 0x20, 4});
    cycle();
    const double made = static_cast<double>(bus.registers[TX_RATE + STRIDE]) * CLOCK_LOW / 1048576.0;
    EXPECT_NEAR(made, 115200, 50);
    EXPECT_EQ(bus.registers[RX_RATE + STRIDE], bus.registers[TX_RATE + STRIDE]);
    EXPECT_EQ(bus.registers[TX_MODE + STRIDE], 0x20U);
    EXPECT_EQ(bus.registers[RX_MODE + STRIDE], 4U);
    bus.next_write_lost = true;
    cycle();
    bus.registers[TX_MODE + STRIDE] = 0;
    cycle();
    EXPECT_EQ(bus.registers[TX_MODE + STRIDE], 0x20U) << "again after a lost packet";
}

TEST_F(UartOfBoard, SendsEveryByteInOrderAndNeverOverfillsTheBoard) {
    std::mt19937 random(9);
    std::vector<std::uint8_t> sent;
    for (int i = 0; i < 3000; ++i) {
        std::vector<std::uint8_t> bytes(random() % 40);
        for (std::uint8_t &byte : bytes) {
            byte = static_cast<std::uint8_t>(random());
        }
        if (uart->send(bytes) == bytes.size()) {
            sent.insert(sent.end(), bytes.begin(), bytes.end());
        }
        cycle();
        tx_words -= std::min<std::size_t>(tx_words, random() % 8);
    }
    for (int i = 0; i < 400; ++i) {
        cycle();
        tx_words = 0;
    }
    EXPECT_EQ(line, sent);
}

TEST_F(UartOfBoard, ReceivesEveryByteInOrder) {
    std::mt19937 random(10);
    std::vector<std::uint8_t> sent, received;
    for (int i = 0; i < 3000; ++i) {
        for (std::size_t n = random() % 12; n > 0 && fifo.size() < 16; --n) {
            sent.push_back(static_cast<std::uint8_t>(random()));
            fifo.push_back(sent.back());
        }
        bus.next_write_lost = random() % 9 == 0;
        cycle();
        std::uint8_t bytes[16];
        const std::size_t count = uart->receive(bytes);
        received.insert(received.end(), bytes, bytes + count);
    }
    cycle(3);
    std::uint8_t bytes[64];
    const std::size_t count = uart->receive(bytes);
    received.insert(received.end(), bytes, bytes + count);
    EXPECT_EQ(received, sent);
}

TEST_F(UartOfBoard, TakesNothingWhileReadsFail) {
    fifo.assign({1, 2, 3});
    cycle();
    bus.next_read = CycleRead::FAILED;
    cycle();
    cycle(3);
    std::uint8_t bytes[16];
    EXPECT_EQ(uart->receive(bytes), 3U);
}

}  // namespace
}  // namespace mw::mesa::test
