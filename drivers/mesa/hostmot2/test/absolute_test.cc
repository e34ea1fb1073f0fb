// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/absolute.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t SSI = 0x6900, BISS = 0x4A00, FANUC = 0x1500;

class AbsoluteOfBoard : public BoardTest {
  protected:
    void load_with(Gtag gtag, std::uint16_t base, const std::string &config) {
        Idrom idrom = with_module(module_of(gtag, 2, base), {0x81, 0x82, 0x03});
        idrom.pins[23] = {0x81, gtag, 1, Gtag::IO_PORT};
        load(idrom, config);
        cycle();
    }
};

/// Compares with the registers that LinuxCNC's driver writes and the pins that it shows.
TEST_F(AbsoluteOfBoard, SsiAgreesWithLinuxCnc) {
    load_with(Gtag::SSI, SSI, "num_dplls=0 ssi_chan_0=error%1bposition%24ge");
    EXPECT_EQ(bus.registers[SSI + 0x200], 0x01470119U);
    bus.registers[SSI] = 7;
    cycle();
    EXPECT_EQ(pins.get("ssi.00.position.rawcounts"), 2.0);
    EXPECT_EQ(pins.get("ssi.00.error"), 1.0);
    EXPECT_EQ(pins.get("ssi.00.error-not"), 0.0);
    pins.set("ssi.00.frequency-khz", 1000);
    pins.set("ssi.00.timer-number", 4);
    cycle();
    EXPECT_EQ(bus.registers[SSI + 0x200], 0x028F4219U);
    pins.set("ssi.00.timer-number", 9);
    cycle();
    EXPECT_EQ(pins.get("ssi.00.timer-number"), 4.0);
    EXPECT_TRUE(pins.pins.contains("gpio.023.out")) << "the channel without a format";
    EXPECT_FALSE(pins.pins.contains("gpio.020.out"));
}

TEST_F(AbsoluteOfBoard, DataThatAreNotCompleteAreNotTaken) {
    load_with(Gtag::SSI, SSI, "ssi_chan_0=position%24e");
    EXPECT_EQ(pins.get("ssi.00.timer-number"), 1.0) << "there is a phase-locked loop";
    bus.registers[SSI] = 100;
    cycle();
    bus.registers[SSI] = 5;
    bus.registers[SSI + 0x300] = 1;
    cycle();
    EXPECT_EQ(pins.get("ssi.00.data-incomplete"), 1.0);
    EXPECT_EQ(pins.get("ssi.00.position.rawcounts"), 100.0);
    bus.registers[SSI + 0x300] = 2;
    bus.next_read = CycleRead::FAILED;
    cycle();
    EXPECT_EQ(pins.get("ssi.00.position.rawcounts"), 100.0);
    cycle();
    EXPECT_EQ(pins.get("ssi.00.data-incomplete"), 0.0);
    EXPECT_EQ(pins.get("ssi.00.position.rawcounts"), 5.0);
}

TEST_F(AbsoluteOfBoard, BissAgreesWithLinuxCnc) {
    load_with(Gtag::BISS, BISS, "num_dplls=0 biss_chan_0=position%24mex%2pfld%3funs%5usig%6s");
    EXPECT_EQ(bus.registers[BISS + 0x100], 0x0147FC28U);
    EXPECT_EQ(bus.registers[BISS + 0x200], 0x100U);
    pins.set("biss.00.frequency-khz", 4000);
    pins.set("biss.00.timer-number", 2);
    cycle();
    EXPECT_EQ(bus.registers[BISS + 0x100], 0x0A3D3028U);
    EXPECT_EQ(bus.registers[BISS + 0x200], 0x2200U);
    bus.registers[BISS] = 0xFF;  // both words
    cycle();
    EXPECT_EQ(pins.get("biss.00.position.rawcounts"), 255.0);
    EXPECT_NEAR(pins.get("biss.00.uns"), 24.0 / 31.0, 1e-9);
    EXPECT_EQ(pins.get("biss.00.sig"), -1.0 / 32.0);
    EXPECT_EQ(pins.get("biss.00.fld-00"), 0.0);
    EXPECT_EQ(pins.get("biss.00.fld-02-not"), 1.0);
}

TEST_F(AbsoluteOfBoard, FanucAa64AgreesWithLinuxCnc) {
    load_with(Gtag::FANUC_ABSOLUTE, FANUC, "fanuc_chan_1=AA64");
    bus.registers[FANUC + 4] = 0x00040020;
    bus.registers[FANUC + 0x104] = 0x00400010;
    cycle();
    EXPECT_EQ(pins.get("fanuc.01.batt_fail"), 1.0);
    EXPECT_EQ(pins.get("fanuc.01.pos_invalid"), 0.0);
    EXPECT_EQ(pins.get("fanuc.01.encoder.rawcounts"), 65537.0);
    EXPECT_NEAR(pins.get("fanuc.01.comm"), 1.0 / 1023.0, 1e-9);
    bus.registers[FANUC + 0x204] = 0x80000000;
    bus.registers[FANUC + 4] = 0;
    cycle();
    EXPECT_EQ(pins.get("fanuc.01.data-invalid"), 1.0) << "no cable";
    EXPECT_EQ(pins.get("fanuc.01.data-incomplete"), 0.0);
    EXPECT_EQ(pins.get("fanuc.01.batt_fail"), 1.0);
}

TEST_F(AbsoluteOfBoard, FanucIsSetUpWhileItsRegistersAreOpen) {
    std::vector<RegisterWrite> seen;
    bus.on_write = [&](RegisterWrite write) {
        if (write.address >= FANUC && write.address < FANUC + 0x600) {
            seen.push_back(write);
        }
    };
    load_with(Gtag::FANUC_ABSOLUTE, FANUC, "fanuc_chan_0=AA64");
    const std::vector<RegisterWrite> expected{{FANUC + 0x300, 0x1280},
                                              {FANUC + 0x200, (76U << 24U) | (800U << 14U)},
                                              {FANUC + 0x400, 10737U | (15U << 28U)},
                                              {FANUC + 0x300, 0x1200}};
    EXPECT_EQ(seen, expected) << "1.024 MHz";
    seen.clear();
    bus.next_write_lost = true;
    cycle();
    seen.clear();
    cycle();
    EXPECT_EQ(seen, expected) << "again after a lost packet";
}

TEST_F(AbsoluteOfBoard, ATriggerIsSentOnceAndOnlyWithoutAPhaseLockedLoop) {
    load_with(Gtag::SSI, SSI, "num_dplls=0 ssi_chan_0=position%24e");
    ASSERT_TRUE(board->hasTriggers());
    EXPECT_EQ(bus.last(SSI + 0x300), -1);
    board->trigger_encoders();
    cycle();
    EXPECT_EQ(bus.last(SSI + 0x300), 1);
    cycle();
    EXPECT_EQ(bus.last(SSI + 0x300), -1);
    auto other =
        Board::make(bus, with_module(module_of(Gtag::SSI, 1, SSI)), *parse_config("ssi_chan_0=p%8e"));
    ASSERT_TRUE(other.has_value());
    EXPECT_FALSE((*other)->hasTriggers());
}

TEST_F(AbsoluteOfBoard, AWrongConfigurationIsRefused) {
    const Idrom idrom = with_module(module_of(Gtag::SSI, 2, SSI));
    for (const char *config :
         {"ssi_chan_2=a%8e", "ssi_chan_0=a%8z", "biss_chan_0=a%8e", "ssi_chan_1=a%65u"}) {
        EXPECT_FALSE(Board::make(bus, idrom, *parse_config(config)).has_value()) << config;
    }
}

TEST(AbsoluteRegisters, RatesAreLimited) {
    const Clocks clocks{CLOCK_LOW, CLOCK_HIGH};
    EXPECT_EQ(ssi_control(0.0001, 8, 0, clocks) >> 16U, 1U);
    EXPECT_EQ(ssi_control(1e9, 8, 0, clocks) >> 16U, 0xFFFFU);
    for (double khz = 10; khz < 40'000; khz *= 1.3) {
        const double made = (ssi_control(khz, 8, 0, clocks) >> 16U) * (CLOCK_LOW / 65536.0) / 1000.0;
        EXPECT_NEAR(made, khz, 1.6) << khz;
    }
}

}  // namespace
}  // namespace mw::mesa::test
