// SPDX-License-Identifier: GPL-2.0-or-later
// The component under the virtual clock, with simulated boards.
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

class HmEth : public ::testing::Test {
  protected:
    ~HmEth() override { ::unsetenv("MILLWRIGHT_MESA"); }

    /// Text of a file with one motor at step generator 0.
    static std::string motor_file() {
        const std::string path = ::testing::TempDir() + "hm2_eth_motor.txt";
        std::ofstream(path) << "motor x stepgen=0 steps_per_rev=200\n"
                               "encoder 0 motor=x counts_per_rev=4000 index_rev=0.25\n";
        return path;
    }
};

constexpr const char *FUNCTIONS = "\naddf hm2_7i76e.0.read t\naddf hm2_7i76e.0.write t";

TEST_F(HmEth, MovesAMotorInVirtualTime) {
    Bench bench{"loadrt hostmot2\nloadrt hm2_eth board_ip=192.168.1.121 virtual_board=7i76e:" + motor_file() +
                " config=\"num_stepgens=1 num_encoders=1\"" + FUNCTIONS};
    for (const auto &[name, value] : {std::pair{"position-scale", 100.0},
                                      {"steplen", 2000.0},
                                      {"stepspace", 2000.0},
                                      {"maxaccel", 1000.0},
                                      {"enable", 1.0},
                                      {"position-cmd", 5.0}}) {
        bench.set(std::string("hm2_7i76e.0.stepgen.00.") + name, value);
    }
    bench.pass(2000);
    EXPECT_NEAR(bench.get("hm2_7i76e.0.stepgen.00.position-fb"), 5.0, 0.01);
    EXPECT_NEAR(bench.get("hm2_7i76e.0.encoder.00.count"), 5.0 * 100 * 20, 20);
    EXPECT_EQ(bench.get("hm2_7i76e.0.watchdog.has_bit"), 0.0);
    EXPECT_EQ(bench.get("hm2_7i76e.0.packet-error-total"), 0.0);
}

// Packets take time within a cycle; this must not advance the time of the board against the clock.
TEST_F(HmEth, TheTimeOfAVirtualBoardIsThatOfTheClock) {
    Bench bench{
        "loadrt hostmot2\nloadrt hm2_eth board_ip=10.0.0.1 virtual_board=7i76e config=num_stepgens=1" +
        std::string(FUNCTIONS)};
    for (const auto &[name, value] : {std::pair{"position-scale", 100.0},
                                      {"steplen", 2000.0},
                                      {"stepspace", 2000.0},
                                      {"maxaccel", 1e6},
                                      {"control-type", 1.0},
                                      {"velocity-cmd", 10.0},
                                      {"enable", 1.0}}) {
        bench.set(std::string("hm2_7i76e.0.stepgen.00.") + name, value);
    }
    bench.pass(100);
    const double before = bench.get("hm2_7i76e.0.stepgen.00.position-fb");
    bench.pass(10'000);
    EXPECT_NEAR(bench.get("hm2_7i76e.0.stepgen.00.position-fb") - before, 100.0, 0.02);
}

TEST_F(HmEth, FindsSmartSerialCardsOfAVirtualBoardOnPci) {
    const std::string physics = ::testing::TempDir() + "hm2_eth_card.txt";
    std::ofstream(physics) << "remote 0 card=7i76\n";
    ::setenv("MILLWRIGHT_MESA", ("hm2_pci=5i25:" + physics).c_str(), 1);
    Bench bench{"loadrt hostmot2\nloadrt hm2_pci\naddf hm2_5i25.0.read t\naddf hm2_5i25.0.write t"};
    EXPECT_FALSE(bench.hal().pins().list("hm2_5i25.0.7i76.0.0.input-00").empty());
    bench.pass(1000);
    EXPECT_EQ(bench.get("hm2_5i25.0.sserial.port-0.port_state"), 3.0) << "running";
    EXPECT_EQ(bench.get("hm2_5i25.0.sserial.port-0.fault"), 0.0);
}

TEST_F(HmEth, TakesModelsFromTheEnvironmentForFilesOfOthers) {
    ::setenv("MILLWRIGHT_MESA", "10.0.0.1=7i92,192.168.1.121=7i96s", 1);
    Bench bench{"loadrt hostmot2\nloadrt hm2_eth board_ip=192.168.1.121,10.0.0.1"};
    EXPECT_FALSE(bench.hal().pins().list("hm2_7i96s.0.packet-error").empty());
    EXPECT_FALSE(bench.hal().pins().list("hm2_7i92.0.packet-error").empty());
}

TEST_F(HmEth, AsksNoBoardUnderTheVirtualClock) {
    Bench bench{"loadrt hostmot2"};
    bench.run("loadrt hm2_eth board_ip=127.0.0.1");
    EXPECT_NE(bench.output.errors, "");
}

TEST_F(HmEth, ReportsAModelThatDoesNotExist) {
    Bench bench{"loadrt hostmot2"};
    bench.run("loadrt hm2_eth board_ip=127.0.0.1 virtual_board=7i77e");
    EXPECT_NE(bench.output.errors, "");
}

}  // namespace
}  // namespace mw::components::test
