// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_spix: Mesa boards on the SPI buses of a small computer, through /dev/spidev.
//
//     loadrt hostmot2
//     loadrt hm2_spix spi_probe=3 spiclk_rate=25000,20000 config="num_encoders=1,num_stepgens=4"
#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/spi/hal/spi_boards.hh"
#include "hal/sdk/component.hh"

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

int comp_id = -1;

}  // namespace

int rtapi_app_main(void) {
    comp_id = hal_init("hm2_spix");
    if (comp_id < 0) {
        return comp_id;
    }
    const int status = mw::mesa::load_probed_boards({.comp_id = comp_id,
                                                     .module = "hm2_spix",
                                                     .probe = static_cast<unsigned>(spi_probe),
                                                     .rates_khz = spiclk_rate,
                                                     .read_rates_khz = spiclk_rate_rd,
                                                     .configs = config});
    const int result = mw::sdk::finish(comp_id, status);
    return result < 0 ? result : 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);  // no function of a board runs after this
    mw::mesa::remove_direct_boards(comp_id);
}
