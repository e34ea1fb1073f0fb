// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/test/board_fixture.hh"

namespace mw::mesa::test {
namespace {

Idrom with_outputs() {
    Idrom idrom = firmware();
    idrom.modules.push_back({Gtag::SSR, 0, false, 1, 0x7D00, 2, 0, 0, 0});
    idrom.modules.push_back({Gtag::OUT_M, 0, false, 1, 0x8600, 1, 0, 0, 0});
    for (std::uint8_t i = 0; i < 4; ++i) {
        idrom.pins[40U + i] = {static_cast<std::uint8_t>(0x81 + i), Gtag::SSR, 0, Gtag::IO_PORT};
        idrom.pins[44U + i] = {static_cast<std::uint8_t>(0x81 + i), Gtag::OUT_M, 0, Gtag::IO_PORT};
    }
    return idrom;
}

class OutputsOfBoard : public BoardTest {};

TEST_F(OutputsOfBoard, AreBitsOfOneWord) {
    load(with_outputs());
    cycle();
    EXPECT_EQ(bus.registers[0x7D00], 0U);
    EXPECT_EQ(bus.registers[0x7E00], (1U << 12U) | 48U);
    pins.set("ssr.00.out-01", 1);
    pins.set("ssr.00.invert-03", 1);
    pins.set("outm.00.out-00", 1);
    cycle();
    EXPECT_EQ(bus.registers[0x7D00], 0b1010U);
    EXPECT_EQ(bus.registers[0x8600], 1U);
    EXPECT_FALSE(pins.pins.contains("ssr.00.out-04"));
    EXPECT_FALSE(pins.pins.contains("outm.00.rate"));
}

TEST_F(OutputsOfBoard, ReleaseTheirPinsWhenTheyAreNotUsed) {
    load(with_outputs(), "num_ssrs=0 num_outms=0");
    EXPECT_TRUE(pins.pins.contains("gpio.040.out"));
    EXPECT_FALSE(pins.pins.contains("ssr.00.out-00"));
}

TEST_F(OutputsOfBoard, RawAccessReadsAndWritesAnyRegister) {
    load(firmware(), "enable_raw");
    bus.registers[0x1234] = 77;
    pins.set("raw.read_address", 0x1234);
    cycle(2);
    EXPECT_EQ(pins.get("raw.read_data"), 77.0);
    pins.set("raw.write_address", 0x4321);
    pins.set("raw.write_data", 99);
    cycle();
    EXPECT_FALSE(bus.registers.contains(0x4321));
    pins.set("raw.write_strobe", 1);
    cycle();
    EXPECT_EQ(bus.registers[0x4321], 99U);
    EXPECT_EQ(pins.get("raw.write_strobe"), 0.0);
    const auto count = bus.written.size();
    cycle();
    ASSERT_EQ(bus.written.size(), count + 1);
    EXPECT_EQ(bus.last(0x4321), -1) << "once";
}

TEST_F(OutputsOfBoard, StateOfTheBoardIsDescribedOnRequest) {
    load(with_outputs(), "enable_raw");
    cycle();
    EXPECT_FALSE(board->take_events().dump_requested);
    pins.set("raw.dump_state", 1);
    cycle();
    EXPECT_EQ(pins.get("raw.dump_state"), 0.0);
    EXPECT_TRUE(board->take_events().dump_requested);
    EXPECT_FALSE(board->take_events().dump_requested) << "once";
    std::string all;
    char text[128];
    for (int line = 0; board->describe(line, text); ++line) {
        all += std::string(text) + "\n";
    }
    EXPECT_NE(all.find("module StepGen version 2 at 0x2000: 5 used, clock 100000000 Hz"), std::string::npos)
        << all;
    EXPECT_NE(all.find("register 0x7E00 = 0x00001030"), std::string::npos) << all;
}

TEST_F(OutputsOfBoard, RawAccessExistsOnlyWhenItIsEnabled) {
    load(firmware());
    EXPECT_FALSE(pins.pins.contains("raw.read_address"));
}

}  // namespace
}  // namespace mw::mesa::test
