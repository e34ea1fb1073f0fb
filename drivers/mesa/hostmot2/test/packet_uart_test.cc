// SPDX-License-Identifier: GPL-2.0-or-later
#include <deque>
#include <random>

#include "drivers/mesa/hostmot2/modules/packet_uart.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t TX = 0x6100, TX_COUNT = 0x6200, TX_RATE = 0x6300, TX_MODE = 0x6400, RX = 0x6500,
                        RX_COUNT = 0x6600, RX_MODE = 0x6800;
using Frame = std::vector<std::uint8_t>;

Frame random_frame(std::mt19937 &random, std::size_t most) {
    Frame frame(1 + random() % most);
    for (std::uint8_t &byte : frame) {
        byte = static_cast<std::uint8_t>(random());
    }
    return frame;
}

/// Simulates a packet UART.
class PacketUartOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        Idrom idrom = firmware();
        idrom.modules.push_back(module_of(Gtag::PKT_UART_TX, 1, TX));
        idrom.modules.push_back(module_of(Gtag::PKT_UART_RX, 1, RX));
        bus.on_write = [&](RegisterWrite write) {
            if (write.address == TX) {
                tx_words.push_back(write.value);
            } else if (write.address == TX_COUNT) {
                Frame frame;
                for (std::size_t i = 0; i < write.value; ++i) {
                    ASSERT_LT(i / 4, tx_words.size());
                    frame.push_back(static_cast<std::uint8_t>(tx_words[i / 4] >> (8 * (i % 4))));
                }
                EXPECT_EQ(tx_words.size(), (frame.size() + 3) / 4);
                tx_words.clear();
                line.push_back(frame);
            } else if (write.address == TX_MODE && write.value == packet_uart_bit::CLEAR) {
                tx_words.clear();
            } else if (write.address == RX_MODE && write.value == packet_uart_bit::CLEAR) {
                frames.clear();
                data.clear();
            }
        };
        bus.on_read_register = [&](std::uint16_t address) -> std::optional<std::uint32_t> {
            if (address == RX_MODE) {
                return static_cast<std::uint32_t>(frames.size()) << 16U;
            }
            if (address == RX_COUNT) {
                const std::uint32_t size = frames.empty() ? 0U : frames.front();
                EXPECT_FALSE(frames.empty());
                frames.pop_front();
                return size;
            }
            if (address == RX) {
                const std::uint32_t word = data.empty() ? 0U : data.front();
                EXPECT_FALSE(data.empty());
                data.pop_front();
                return word;
            }
            return std::nullopt;
        };
        load(idrom);
        uart = board->ports().packet_uarts.at(0).port;
        cycle();
    }
    void arrive(const Frame &frame) {
        frames.push_back(static_cast<std::uint32_t>(frame.size()));
        for (std::size_t i = 0; i < frame.size(); i += 4) {
            std::uint32_t word = 0;
            for (std::size_t k = i; k < std::min(i + 4, frame.size()); ++k) {
                word |= std::uint32_t{frame[k]} << (8 * (k - i));
            }
            data.push_back(word);
        }
    }
    Frame receive() {
        Frame frame(uart->frame_sizes().empty() ? 0 : uart->frame_sizes()[0]);
        EXPECT_EQ(uart->receive(frame), frame.size());
        return frame;
    }

    PacketUart *uart = nullptr;
    std::vector<std::uint32_t> tx_words;
    std::vector<Frame> line;
    std::deque<std::uint32_t> frames, data;
};

TEST_F(PacketUartOfBoard, HasABitRateOf24Bits) {
    uart->setup({19200, 0x2820, 0x1408, true, true});
    cycle();
    EXPECT_NEAR(static_cast<double>(bus.registers[TX_RATE]) * CLOCK_LOW / 16777216.0, 19200, 4);
    EXPECT_EQ(bus.registers[TX_MODE], 0x2820U) << "after the FIFO was cleared";
    EXPECT_EQ(uart->clock_hz(), CLOCK_LOW);
}

TEST_F(PacketUartOfBoard, SendsWholeFramesInOrder) {
    std::mt19937 random(1);
    std::vector<Frame> sent;
    for (int i = 0; i < 500; ++i) {
        const Frame frame = random_frame(random, 260);
        if (uart->send(frame)) {
            sent.push_back(frame);
        }
        cycle();
    }
    cycle(2000);
    EXPECT_GT(sent.size(), 50U);
    EXPECT_EQ(line, sent);
    EXPECT_FALSE(uart->send({}));
    EXPECT_FALSE(uart->send(Frame(1024)));
}

TEST_F(PacketUartOfBoard, ReceivesWholeFramesInOrder) {
    std::mt19937 random(2);
    std::vector<Frame> sent, received;
    for (int i = 0; i < 5000; ++i) {
        if (frames.size() < 4 && random() % 6 == 0) {
            sent.push_back(random_frame(random, 260));
            arrive(sent.back());
        }
        cycle();
        EXPECT_EQ((uart->rx_status() >> 16U) & 0x1FU, uart->frame_sizes().size());
        while (!uart->frame_sizes().empty()) {
            received.push_back(receive());
        }
    }
    for (int i = 0; i < 100; ++i) {
        cycle();
        while (!uart->frame_sizes().empty()) {
            received.push_back(receive());
        }
    }
    EXPECT_GT(sent.size(), 100U);
    EXPECT_EQ(received, sent);
}

TEST_F(PacketUartOfBoard, ALostPacketNeverMixesFrames) {
    std::mt19937 random(3);
    std::vector<Frame> sent;
    for (int i = 0; i < 3000; ++i) {
        bus.next_write_lost = random() % 20 == 0;
        const Frame frame = random_frame(random, 100);
        if (random() % 4 == 0 && uart->send(frame)) {
            sent.push_back(frame);
        }
        cycle();
    }
    for (const Frame &frame : line) {
        EXPECT_NE(std::ranges::find(sent, frame), sent.end());
    }
    EXPECT_GT(line.size(), 100U);
}

TEST_F(PacketUartOfBoard, AFailedReadDropsOneFrameAndGoesOn) {
    arrive(Frame(40, 1));
    cycle(2);
    bus.next_read = CycleRead::FAILED;
    cycle(3);
    EXPECT_EQ(uart->failures(), 1U);
    arrive(Frame{7, 8, 9});
    cycle(4);
    EXPECT_EQ(receive(), (Frame{7, 8, 9}));
}

}  // namespace
}  // namespace mw::mesa::test
