// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the smart serial module between registers and pins: its lists, and the writes of a cycle.
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t BASE = 0x5A00;

DataRecord record(const char *name, int bits, FieldType type, FieldDirection direction) {
    DataRecord one;
    one.name = name;
    one.bits = bits;
    one.type = type;
    one.direction = direction;
    one.max = 10;
    return one;
}

FoundCard card(int channel, const char *name, std::vector<DataRecord> process) {
    FoundCard one;
    one.channel = channel;
    one.mode = 2;
    one.name = name;
    one.layout = *process_layout(process, 96);
    one.process = std::move(process);
    return one;
}

/// A port with a card of each type of data on channel 0, and one on channel 2.
class ModuleOfSmartSerial : public ::testing::Test {
  protected:
    ModuleOfSmartSerial() {
        module.descriptor.gtag = Gtag::SMART_SERIAL;
        module.descriptor.base_address = BASE;
        module.register_stride = 0x100;
        module.instance_stride = 0x40;
        module.instances = 1;
        using enum FieldType;
        using enum FieldDirection;
        FoundCard first = card(0, "7i99",
                               {record("Out", 16, BITS, OUTPUT), record("In", 16, BITS, INPUT),
                                record("Flag", 1, BOOLEAN, OUTPUT), record("U", 12, UNSIGNED, OUTPUT),
                                record("S", 12, SIGNED, OUTPUT), record("F", 32, FLOAT, OUTPUT),
                                record("T", 8, STREAM, OUTPUT), record("UI", 12, UNSIGNED, INPUT),
                                record("SI", 12, SIGNED, INPUT), record("FI", 32, FLOAT, INPUT),
                                record("E", 8, ENCODER, INPUT), record("B", 4, UNSIGNED, BOTH)});
        first.parameters = {{record("SwRevision", 8, UNSIGNED, INPUT), 14},
                            {record("NvUnit", 32, NV_UNSIGNED, BOTH), 0x10000001},
                            {record("Offset", 16, SIGNED, OUTPUT), 0xFFFB},
                            {record("Gain", 32, NV_FLOAT, OUTPUT), 0x3FC00000},
                            {record("Stream", 8, STREAM, OUTPUT), 1}};
        assignment.serial_ports.push_back(
            {.port = 0, .cards = {first, card(2, "7i84", {record("Input", 32, BITS, INPUT)})}});
        serial = make_sserial({module, assignment, config, idrom});
        serial->plan(registers);
        EXPECT_TRUE(registers.fix(bus).has_value());
        serial->declare(pins);
    }
    /// The list of a cycle in which the processor completes its command at once.
    std::vector<RegisterWrite> cycle(std::uint32_t command = 0) {
        for (std::uint32_t &word : registers.inputs()) {
            word = 0;
        }
        registers.inputs()[0] = command;
        step();
        const auto list = registers.list(false);
        return {list.begin(), list.end()};
    }
    void step() noexcept {
        Cycle now;
        now.fresh = now.writing = true;
        now.has_lost_write = write_lost;
        now.now_ns = time_ns += PERIOD_NS;
        serial->read(registers, now);
        now.now_ns += PERIOD_NS / 10;
        serial->write(registers, now);
    }

    UsedModule module;
    Assignment assignment;
    Config config;
    Idrom idrom;
    MemoryBus bus;
    Registers registers;
    PinMap pins;
    std::unique_ptr<Module> serial;
    std::int64_t time_ns = 0;
    bool write_lost = false;
};

TEST_F(ModuleOfSmartSerial, ReadsEachRegisterOfAllChannelsAtOnce) {
    const std::vector<RegisterRange> expected{{BASE, 1},         {BASE + 0x100, 1}, {BASE + 0x200, 3},
                                              {BASE + 0x300, 3}, {BASE + 0x400, 1}, {BASE + 0x500, 1}};
    EXPECT_EQ(registers.ranges(), expected);
}

TEST_F(ModuleOfSmartSerial, WritesTheCommandLast) {
    std::vector<RegisterWrite> start, exchange;
    for (int i = 0; i < 30; ++i) {
        const auto list = cycle();
        if (!list.empty() && list.back() == RegisterWrite{BASE, 0x905}) {
            start = list;
        } else if (!list.empty() && list.back() == RegisterWrite{BASE, 0x1005}) {
            exchange = list;
        }
    }
    ASSERT_FALSE(start.empty());
    EXPECT_NE(std::ranges::find(start, (RegisterWrite{BASE + 0x200, 0x02000000})), start.end());
    EXPECT_NE(std::ranges::find(start, (RegisterWrite{BASE + 0x208, 0x02000000})), start.end());
    ASSERT_EQ(exchange.size(), 4U) << "three words of outputs and the command";
    EXPECT_EQ(exchange[0].address, BASE + 0x300);
}

TEST_F(ModuleOfSmartSerial, WritesNothingWhileACommandIsInWork) {
    for (int i = 0; i < 30; ++i) {
        cycle();
    }
    EXPECT_TRUE(cycle(0x1005).empty());
    EXPECT_FALSE(cycle().empty());
}

TEST_F(ModuleOfSmartSerial, AnExchangeThatIsTooLongIsReportedWithItsCardsAndTimes) {
    for (int i = 0; i < 30; ++i) {
        cycle();
    }
    char text[512];
    std::string message;
    for (int i = 0; i < 12; ++i) {
        cycle(i % 2 == 0 ? 0x1005 : 0);
        message += std::string(text, serial->take_message(text));
    }
    EXPECT_EQ(
        message,
        "Smart serial port 0: an exchange with 7i99.0.0, 7i84.0.2 took 900 to 1900 us, longer than the "
        "servo period of 1000 us allows. Use a servo period of at least 2000 us, or connect fewer cards "
        "to this port.");
}

TEST_F(ModuleOfSmartSerial, ParametersShowWhatTheCardHas) {
    EXPECT_EQ(pins.get("7i99.0.0.swrevision"), 14);
    EXPECT_EQ(pins.pins["7i99.0.0.swrevision"].access, Access::RO);
    EXPECT_EQ(pins.get("7i99.0.0.nvunit"), 0x10000001);
    EXPECT_EQ(pins.get("7i99.0.0.offset"), -5);
    EXPECT_EQ(pins.get("7i99.0.0.gain"), 1.5);
    EXPECT_EQ(pins.pins["7i99.0.0.gain"].access, Access::RW);
    EXPECT_FALSE(pins.pins.contains("7i99.0.0.stream"));
}

/// The exchanges in set-up: status and first user register of channel 0.
std::vector<std::pair<std::uint32_t, std::uint32_t>>
setup_of(const std::vector<std::vector<RegisterWrite>> &lists) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> steps;
    for (const auto &list : lists) {
        if (list.empty() || list.back() != RegisterWrite{BASE, 0x1001}) {
            continue;
        }
        const auto value = [&](int address) {
            const auto found =
                std::ranges::find(list, static_cast<std::uint16_t>(address), &RegisterWrite::address);
            return found == list.end() ? 0U : found->value;
        };
        steps.emplace_back(value(BASE + 0x200), value(BASE + 0x300));
    }
    return steps;
}

TEST_F(ModuleOfSmartSerial, WritesParametersThatDifferBeforeItStartsTheCards) {
    pins.set("7i99.0.0.offset", -6);
    pins.set("7i99.0.0.gain", 2.0);
    std::vector<std::vector<RegisterWrite>> lists;
    for (int i = 0; i < 60; ++i) {
        lists.push_back(cycle());
    }
    // 16 bits at once; non-volatile memory is opened before and closed after the write, as in LinuxCNC.
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> expected{
        {0x65000000, 0xFFFA}, {0xEC000000, 1}, {0x66000000, 0x40000000}, {0xEC000000, 0}};
    EXPECT_EQ(setup_of(lists), expected);
    EXPECT_EQ(pins.get("sserial.port-0.port_state"), 3);
    const auto last = [&](std::uint32_t command) {
        return std::ranges::find_if(lists, [&](const auto &list) {
            return !list.empty() && list.back() == RegisterWrite{BASE, command};
        });
    };
    EXPECT_LT(last(0xF05), last(0x1001));
    EXPECT_LT(last(0x1001), last(0x905));
    pins.set("sserial.port-0.run", 0);
    cycle();
    pins.set("sserial.port-0.run", 1);
    lists.clear();
    for (int i = 0; i < 60; ++i) {
        lists.push_back(cycle());
    }
    EXPECT_TRUE(setup_of(lists).empty()) << "equal values are not written again";
}

TEST_F(ModuleOfSmartSerial, RepeatsAStepThatMayBeLost) {
    pins.set("7i99.0.0.offset", 7);
    std::vector<std::vector<RegisterWrite>> lists;
    bool lost = false;
    for (int i = 0; i < 80; ++i) {
        write_lost = lost;
        lists.push_back(cycle());
        const bool is_step = !lists.back().empty() && lists.back().back() == RegisterWrite{BASE, 0x1001};
        const bool is_setup = !lists.back().empty() && lists.back().back() == RegisterWrite{BASE, 0xF05};
        lost = (is_step || is_setup) && i < 40;
    }
    const auto steps = setup_of(lists);
    ASSERT_GE(steps.size(), 1U);
    for (const auto &step : steps) {
        EXPECT_EQ(step, (std::pair<std::uint32_t, std::uint32_t>{0x65000000, 7}));
    }
    EXPECT_EQ(pins.get("sserial.port-0.port_state"), 3);
}

TEST_F(ModuleOfSmartSerial, AParameterThatTheCardRejectsIsReportedOnce) {
    pins.set("7i99.0.0.offset", 7);
    std::size_t messages = 0;
    char text[512];
    for (int i = 0; i < 100; ++i) {
        for (std::uint32_t &word : registers.inputs()) {
            word = 0;
        }
        // The first set-up reports a fault of the card.
        registers.inputs()[2] = pins.get("sserial.port-0.port_state") == 7 ? 0x100U : 0U;
        step();
        (void)registers.list(false);
        const std::size_t length = serial->take_message(text);
        messages += length > 0 ? 1U : 0U;
        if (length > 0) {
            EXPECT_NE(std::string_view(text, length).find("7i99.0.0 has not taken a parameter"),
                      std::string_view::npos);
        }
    }
    EXPECT_EQ(messages, 1U);
    EXPECT_EQ(pins.get("sserial.port-0.port_state"), 3) << "the cards run without it";
}

TEST_F(ModuleOfSmartSerial, AnyRegistersAndPinsNeverAllocateNorGiveInvalidNumbers) {
    std::mt19937 random(11);
    std::vector<PinMap::Pin *> inputs, numbers;
    for (auto &[name, pin] : pins.pins) {
        const bool set = pin.access == Access::IN || pin.access == Access::IO || pin.access == Access::RW;
        if (set && name != "sserial.port-0.run") {
            inputs.push_back(&pin);
        }
        if (pin.access == Access::OUT && pin.type == PinType::FLOAT) {
            numbers.push_back(&pin);
        }
    }
    std::size_t messages = 0;
    char text[512];
    const mw::testing::AllocationGuard guard;
    for (int i = 0; i < 20'000; ++i) {
        for (std::uint32_t &word : registers.inputs()) {
            word = random() % 3 == 0 ? static_cast<std::uint32_t>(random()) : 0U;
        }
        registers.inputs()[0] = random() % 4 == 0 ? 0x1005U : 0U;
        PinMap::Pin &pin = *inputs[random() % inputs.size()];
        if (pin.type == PinType::BIT) {
            pin.bit = random() % 2 == 0;
        } else if (pin.type == PinType::FLOAT) {
            pin.real = static_cast<double>(static_cast<std::int32_t>(random())) / 1e8;
        } else {
            pin.u32 = static_cast<std::uint32_t>(random() % 300);
        }
        step();
        messages += serial->take_message(text) > 0 ? 1U : 0U;
        for (const PinMap::Pin *number : numbers) {
            ASSERT_EQ(number->real - number->real, 0.0) << "not finite in cycle " << i;
        }
        (void)registers.list(i % 50 == 0);
    }
    EXPECT_EQ(guard.calls(), 0U);
    EXPECT_GT(messages, 0U);
}

}  // namespace
}  // namespace mw::mesa::test
