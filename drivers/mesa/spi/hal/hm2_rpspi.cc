// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_rpspi: Mesa boards on the SPI buses of a Raspberry Pi, through /dev/spidev.
//
//     loadrt hostmot2
//     loadrt hm2_rpspi spiclk_rate=12500 config="num_encoders=1"
#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/spi/hal/spi_boards.hh"
#include "hal/sdk/module.hh"

namespace {

int spiclk_rate = 31'250, spiclk_rate_rd = -1, spi_probe = 1;
int spiclk_base = 400'000'000, spi_pull_miso = 1, spi_pull_mosi = 1, spi_pull_sclk = 1, spi_debug = -1;
char *config[mw::mesa::MAX_SPI_BOARDS];
RTAPI_MP_INT(spiclk_rate, "clock rate [kHz]");
RTAPI_MP_INT(spiclk_rate_rd, "clock rate of reads [kHz]; -1: the same");
RTAPI_MP_INT(spi_probe, "boards, a sum of 1: SPI0/CE0, 2: SPI0/CE1, 4: SPI1/CE0, 8: SPI1/CE1, 16: SPI1/CE2");
RTAPI_MP_ARRAY_STRING(config, mw::mesa::MAX_SPI_BOARDS, "which modules of each board are used");
// Linux sets up the controller and its pins.
RTAPI_MP_INT(spiclk_base, "accepted for files of LinuxCNC, without an effect");
RTAPI_MP_INT(spi_pull_miso, "accepted for files of LinuxCNC, without an effect");
RTAPI_MP_INT(spi_pull_mosi, "accepted for files of LinuxCNC, without an effect");
RTAPI_MP_INT(spi_pull_sclk, "accepted for files of LinuxCNC, without an effect");
RTAPI_MP_INT(spi_debug, "accepted for files of LinuxCNC, without an effect");

struct Boards {
    int comp_id = 0;

    int load(int id) noexcept {
        comp_id = id;
        return mw::mesa::load_probed_boards({.comp_id = id,
                                             .module = "hm2_rpspi",
                                             .probe = static_cast<unsigned>(spi_probe),
                                             .rates_khz = {&spiclk_rate, 1},
                                             .read_rates_khz = {&spiclk_rate_rd, 1},
                                             .configs = config});
    }
    void end() noexcept { mw::mesa::remove_direct_boards(comp_id); }
};

}  // namespace

MW_COMPONENT_DEVICE(Boards, "hm2_rpspi");
