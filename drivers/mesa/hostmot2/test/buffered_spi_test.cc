// SPDX-License-Identifier: GPL-2.0-or-later
#include <deque>

#include "drivers/mesa/hostmot2/modules/buffered_spi.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t FIFO = 0x5500, DESCRIPTOR = 0x5600, COUNT = 0x5700;

/// Simulates devices that return the received word plus 1, before the next read.
class SpiOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        ModuleDescriptor module = module_of(Gtag::BSPI, 1, FIFO);
        module.instance_stride = 1;
        bus.on_write = [&](RegisterWrite write) {
            if (write.address >= FIFO && write.address < FIFO + 64) {
                words.push_back({(write.address - FIFO) / 4, write.value});
                answers.push_back(write.value + 1);
            } else if (write.address == DESCRIPTOR) {
                descriptors.push_back(write.value);
            } else if (write.address == COUNT) {
                answers.clear();
            }
        };
        bus.on_read_register = [&](std::uint16_t address) -> std::optional<std::uint32_t> {
            if (address == COUNT) {
                return static_cast<std::uint32_t>(answers.size());
            }
            if (address == FIFO) {
                const std::uint32_t word = answers.empty() ? 0xDEADU : answers.front();
                if (!answers.empty()) {
                    answers.pop_front();
                }
                return word;
            }
            return std::nullopt;
        };
        load(with_module(module));
        spi = board->ports().spis.at(0).port;
        for (int channel = 0; channel < 3; ++channel) {
            ASSERT_TRUE(spi->setup_channel(channel, {.chip_select = channel, .bits = 16, .mhz = 5}));
        }
        cycle();
        words.clear();
    }
    BufferedSpi *spi = nullptr;
    std::vector<std::pair<int, std::uint32_t>> words;
    std::vector<std::uint32_t> descriptors;
    std::deque<std::uint32_t> answers;
};

TEST_F(SpiOfBoard, DescriptorsAreWrittenFromTheLastOn) {
    ASSERT_EQ(descriptors.size(), 16U);
    EXPECT_EQ(descriptors[15] & 0xFFFFFU, 15U | (9U << 8U)) << "16 bits, 100 MHz / 20";
    EXPECT_EQ((descriptors[13] >> 16U) & 0xFU, 2U);
}

TEST_F(SpiOfBoard, ExchangesItsFramesInEachCycle) {
    const auto first = spi->add_frame(1), second = spi->add_frame(2);
    ASSERT_NE(second.received, nullptr);
    for (std::uint32_t i = 0; i < 100; ++i) {
        *first.sent = i;
        *second.sent = 1000 + i;
        bus.next_write_lost = i % 13 == 12;
        bus.next_read = i % 17 == 16 ? CycleRead::FAILED : CycleRead::DONE;
        cycle();
        const std::uint32_t echo = *first.received;
        EXPECT_EQ(*second.received, echo == 0 ? 0 : echo + 1000) << "both of one cycle";
        EXPECT_LE(echo, i + 1);
        EXPECT_GE(echo + 4, i) << "a failure does not last";
    }
}

TEST_F(SpiOfBoard, WritesSingleWordsOnce) {
    EXPECT_TRUE(spi->write(2, 77));
    cycle();
    EXPECT_EQ(words, (std::vector<std::pair<int, std::uint32_t>>{{2, 77}}));
    cycle(3);
    EXPECT_EQ(words.size(), 1U);
    EXPECT_FALSE(spi->write(16, 0));
}

TEST_F(SpiOfBoard, CallsItsUserAroundTheCycle) {
    struct Calls {
        int reads = 0, writes = 0;
    } calls;
    spi->set_read([](void *self) { return ++static_cast<Calls *>(self)->reads; }, &calls);
    spi->set_write([](void *self) { return ++static_cast<Calls *>(self)->writes; }, &calls);
    cycle(5);
    EXPECT_EQ(calls.reads, 5);
    EXPECT_EQ(calls.writes, 5);
}

TEST(SpiDescriptors, NeverClockFasterThanRequired) {
    for (double mhz = 0.05; mhz < 60; mhz *= 1.07) {
        const std::uint32_t word = spi_descriptor({.chip_select = 0, .bits = 8, .mhz = mhz}, CLOCK_LOW);
        const double made = CLOCK_LOW / 2e6 / (((word >> 8U) & 0xFFU) + 1);
        EXPECT_TRUE(made <= mhz * 1.0001 || ((word >> 8U) & 0xFFU) == 255U) << mhz;
    }
}

}  // namespace
}  // namespace mw::mesa::test
