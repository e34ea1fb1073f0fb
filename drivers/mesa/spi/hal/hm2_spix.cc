// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_spix: Mesa boards on the SPI buses of a small computer, through /dev/spidev.
//
//     loadrt hostmot2
//     loadrt hm2_spix spi_probe=3 spiclk_rate=25000,20000 config="num_encoders=1,num_stepgens=4"
#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/spi/hal/spi_boards.hh"
#include "hal/sdk/module.hh"

namespace {

using mw::mesa::MAX_SPI_BOARDS;

int spiclk_rate[MAX_SPI_BOARDS] = {25'000}, spiclk_rate_rd[MAX_SPI_BOARDS], spi_probe = 1;
char *config[MAX_SPI_BOARDS];
char *force_driver = nullptr;
RTAPI_MP_ARRAY_INT(spiclk_rate, MAX_SPI_BOARDS, "clock rates [kHz]; 0: as the first");
RTAPI_MP_ARRAY_INT(spiclk_rate_rd, MAX_SPI_BOARDS, "clock rates of reads [kHz]; 0: the same");
RTAPI_MP_INT(spi_probe, "boards, a sum of 1: SPI0/CE0, 2: SPI0/CE1, 4: SPI1/CE0, 8: SPI1/CE1, 16: SPI1/CE2");
RTAPI_MP_ARRAY_STRING(config, MAX_SPI_BOARDS, "which modules of each board are used");
RTAPI_MP_STRING(force_driver, "accepted for files of LinuxCNC: Linux chooses the driver of the controller");

struct Boards {
    int comp_id = 0;

    int load(int id) noexcept {
        comp_id = id;
        return mw::mesa::load_probed_boards({.comp_id = id,
                                             .module = "hm2_spix",
                                             .probe = static_cast<unsigned>(spi_probe),
                                             .rates_khz = spiclk_rate,
                                             .read_rates_khz = spiclk_rate_rd,
                                             .configs = config});
    }
    void end() noexcept { mw::mesa::remove_direct_boards(comp_id); }
};

}  // namespace

MW_COMPONENT_DEVICE(Boards, "hm2_spix");
