// SPDX-License-Identifier: GPL-2.0-or-later
// Tests a board with every module: no cycle allocates memory, and nothing moves before a user enables it.
#include <random>

#include "drivers/mesa/hostmot2/modules/packet_uart.hh"
#include "drivers/mesa/hostmot2/modules/uart.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::mesa::test {
namespace {

Idrom all_modules() {
    Idrom idrom = firmware();
    std::erase_if(idrom.modules,
                  [](const ModuleDescriptor &m) { return m.gtag == Gtag::STEPGEN || m.gtag == Gtag::PWM; });
    for (const auto &[gtag, instances, base] : {std::tuple{Gtag::STEPGEN, 4, 0x2000},
                                                {Gtag::FANUC_ABSOLUTE, 2, 0x1500},
                                                {Gtag::RESOLVER, 1, 0x3C00},
                                                {Gtag::PWM, 4, 0x4100},
                                                {Gtag::THREE_PHASE_PWM, 2, 0x4600},
                                                {Gtag::BISS, 2, 0x4A00},
                                                {Gtag::BSPI, 1, 0x5500},
                                                {Gtag::PKT_UART_TX, 2, 0x6100},
                                                {Gtag::PKT_UART_RX, 2, 0x6500},
                                                {Gtag::SSI, 2, 0x6900},
                                                {Gtag::IN_MUX, 1, 0x8000},
                                                {Gtag::IN_M, 1, 0x8500},
                                                {Gtag::XY2_100, 1, 0x9200},
                                                {Gtag::RC_PWM, 4, 0x9D00},
                                                {Gtag::ONE_SHOT, 1, 0xB100},
                                                {Gtag::PERIOD_METER, 2, 0xB700}}) {
        ModuleDescriptor module = module_of(gtag, instances, static_cast<std::uint16_t>(base));
        module.version = gtag == Gtag::STEPGEN ? 0xC2 : 0;
        module.instance_stride = gtag == Gtag::BSPI ? 1 : 0;
        idrom.modules.push_back(module);
    }
    idrom.pins[40] = {0x83, Gtag::STEPGEN, 0, Gtag::IO_PORT};
    return idrom;
}

class AllModulesOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        bus.registers[0x8000] = 31;
        bus.registers[0x8500] = 31;
        load(all_modules(),
             "stepgen_width=4 enable_raw ssi_chan_0=a%24geb%8u biss_chan_1=a%40eb%8f fanuc_chan_0=AA64");
    }
};

TEST_F(AllModulesOfBoard, NoCycleAllocates) {
    cycle(3);
    const Ports ports = board->ports();
    ASSERT_EQ(ports.packet_uarts.size(), 2U);
    for (auto &[name, pin] : pins.pins) {
        if (pin.type == PinType::BIT && (pin.access == Access::IN || pin.access == Access::IO)) {
            pin.bit = true;
        }
    }
    pins.set("stepgen.00.step_type", 9);
    bus.recording = false;
    const std::uint8_t frame[] = {1, 2, 3, 4, 5};
    mw::testing::AllocationGuard guard;
    for (int i = 0; i < 200; ++i) {
        bus.next_read = i % 7 == 0 ? CycleRead::FAILED : CycleRead::DONE;
        bus.next_write_lost = i % 11 == 0;
        (void)ports.packet_uarts[0].port->send(frame);
        cycle();
    }
    EXPECT_EQ(guard.calls(), 0U);
}

/// Rates, values and enables of every output.
TEST_F(AllModulesOfBoard, IsOffUntilAUserEnablesIt) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> any(-100.0, 100.0);
    for (auto &[name, pin] : pins.pins) {
        if (pin.type == PinType::FLOAT && pin.access == Access::IN && !name.starts_with("rcpwm")) {
            pin.real = any(random);
        }
    }
    for (int i = 0; i < 50; ++i) {
        bus.next_read = random() % 4 == 0 ? CycleRead::FAILED : CycleRead::DONE;
        bus.next_write_lost = random() % 4 == 0;
        cycle();
        for (const int off : {0x2000, 0x200C, 0x4100, 0x4700, 0x4704, 0x9200, 0x9400, 0x9600}) {
            ASSERT_EQ(bus.registers[static_cast<std::uint16_t>(off)], 0U) << off;
        }
        ASSERT_EQ(bus.registers[0x4500], 0U) << "PWM enables";
        ASSERT_EQ(bus.registers[0xB600] & 0x400040U, 0U) << "one-shot enables";
        if (i > 10) {
            ASSERT_EQ(bus.registers[0x9D00], 0xFFFFFFFFU) << "no RC pulse";
        }
    }
}

TEST_F(AllModulesOfBoard, FailedReadsKeepEveryOutputPin) {
    cycle(3);
    std::mt19937 random(9);
    for (auto &[address, value] : bus.registers) {
        value = address >= 0x1000 ? static_cast<std::uint32_t>(random()) : value;
    }
    cycle();
    std::map<std::string, std::uint64_t> before;
    for (const auto &[name, pin] : pins.pins) {
        before[name] = pin.all;
    }
    for (auto &[address, value] : bus.registers) {
        value = address >= 0x1000 ? static_cast<std::uint32_t>(random()) : value;
    }
    bus.next_read = CycleRead::FAILED;
    read();
    for (const auto &[name, pin] : pins.pins) {
        EXPECT_EQ(pin.all, before[name]) << name;
    }
}

}  // namespace
}  // namespace mw::mesa::test
