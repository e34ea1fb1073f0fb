// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_setup.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t BASE = 0x5A00;

/// Simulates the processor of a port with a card at channel 1. Registers have separate values for reading and
/// writing.
class Processor {
  public:
    explicit Processor(MemoryBus &bus) : bus_(bus) {
        bus_.on_load_write = [this](RegisterWrite write) { take(write); };
    }
    int slowness = 0;  ///< number of reads until a command is done
    bool isDead = false, card_dead = false;
    std::uint8_t minor = 43;
    std::map<std::uint16_t, std::uint8_t> memory;
    std::map<std::uint16_t, std::uint32_t> host;
    std::vector<std::uint32_t> commands;

    void pause() {
        if (--left_ <= 0 && !isDead) {
            bus_.registers[BASE] = 0;
        }
    }

  private:
    void take(RegisterWrite write) {
        host[write.address] = write.value;
        if (write.address != BASE) {
            return;
        }
        commands.push_back(write.value);
        left_ = slowness;
        bus_.registers[BASE] = slowness > 0 || isDead ? write.value | 0x80000000U : 0x80000000U;
        execute(write.value);
    }
    void execute(std::uint32_t command) {
        if ((command & 0xF000U) == 0x2000U) {
            const std::uint16_t address = command & 0x0FFFU;
            bus_.registers[BASE + 0x100] = address == 2 ? 1U : address == 3 ? minor : address == 7 ? 2U : 0U;
        } else if ((command & 0xFF00U) == 0x0F00U) {
            bus_.registers[BASE + 0x100] = command & 0xFFU & ~2U;
            bus_.registers[BASE + 0x304] = 12345;
            bus_.registers[BASE + 0x404] = 0x36374937;
            bus_.registers[BASE + 0x504] = 0x02000100;
        } else if ((command & 0xFF00U) == 0x0900U) {
            bus_.registers[BASE + 0x100] = 0;
        } else if ((command & 0xF000U) == 0x1000U) {
            const std::uint32_t request = host[BASE + 0x204];
            bus_.registers[BASE + 0x204] = card_dead ? 0x2000U : 0U;
            bus_.registers[BASE + 0x304] = memory[static_cast<std::uint16_t>(request)];
        }
    }
    MemoryBus &bus_;
    int left_ = 0;
};

class SetupOfSmartSerial : public ::testing::Test {
  protected:
    SetupOfSmartSerial() {
        module.descriptor.gtag = Gtag::SMART_SERIAL;
        module.descriptor.base_address = BASE;
        module.register_stride = 0x100;
        module.instance_stride = 0x40;
    }
    UsedModule module;
    MemoryBus bus;
    Processor processor{bus};
    SserialSetup setup{bus, module, 0, [this] { processor.pause(); }};
};

TEST_F(SetupOfSmartSerial, ResetsThePortAndReadsItsVersion) {
    processor.slowness = 100;
    const auto port = setup.reset();
    ASSERT_TRUE(port.has_value()) << port.error().message;
    EXPECT_EQ(port->major, 1);
    EXPECT_EQ(port->minor, 43);
    EXPECT_EQ(port->channels, 2);
    ASSERT_GE(processor.commands.size(), 2U);
    EXPECT_EQ(processor.commands[0], 0x4000U);
    EXPECT_EQ(processor.commands[1], 0U);
}

TEST_F(SetupOfSmartSerial, FindsTheChannelsWithACard) {
    const auto found = setup.start_setup(0b11);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(*found, 0b10U);
    const auto card = setup.card(1);
    ASSERT_TRUE(card.has_value());
    EXPECT_EQ(card->name, "7i76");
    EXPECT_EQ(card->serial_number, 12345U);
    EXPECT_EQ(card->ptoc, 0x0100);
    EXPECT_EQ(card->gtoc, 0x0200);
    EXPECT_EQ(processor.commands, (std::vector<std::uint32_t>{0x8FF, 0xF03}));
}

TEST_F(SetupOfSmartSerial, ReadsTheMemoryOfACard) {
    processor.memory[0x0123] = 0xA5;
    const auto byte = setup.read_card_byte(1, 0x0123);
    ASSERT_TRUE(byte.has_value()) << byte.error().message;
    EXPECT_EQ(*byte, 0xA5);
    EXPECT_EQ(processor.host[BASE + 0x204], 0x4C000123U);
    EXPECT_EQ(processor.commands.back(), 0x1002U);
}

TEST_F(SetupOfSmartSerial, StartsChannelsWithTheirModes) {
    const std::uint8_t modes[] = {0, 2};
    const auto running = setup.start_normal(0b11, modes);
    ASSERT_TRUE(running.has_value());
    EXPECT_EQ(*running, 0b11U);
    EXPECT_EQ(processor.host[BASE + 0x200], 0U);
    EXPECT_EQ(processor.host[BASE + 0x204], 0x02000000U);
    EXPECT_EQ(processor.commands.back(), 0x903U);
}

TEST_F(SetupOfSmartSerial, NamesAPortThatDoesNotAnswer) {
    processor.isDead = true;
    const auto port = setup.reset();
    ASSERT_FALSE(port.has_value());
    EXPECT_NE(port.error().message.find("port 0 does not answer"), std::string::npos);
}

TEST_F(SetupOfSmartSerial, NamesACardThatDoesNotAnswer) {
    processor.card_dead = true;
    const auto byte = setup.read_card_byte(1, 0);
    ASSERT_FALSE(byte.has_value());
    EXPECT_NE(byte.error().message.find("channel 0.1 does not answer (status 0x00002000)"),
              std::string::npos);
}

TEST_F(SetupOfSmartSerial, RejectsOldFirmware) {
    processor.minor = 30;
    EXPECT_FALSE(setup.reset().has_value());
}

}  // namespace
}  // namespace mw::mesa::test
