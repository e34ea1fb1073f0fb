// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_spi: Mesa boards on SPI, through /dev/spidev.
//
//     loadrt hostmot2
//     loadrt hm2_spi spidev_path=/dev/spidev1.0 spidev_rate=24000 config="num_encoders=1"
#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/spi/hal/spi_boards.hh"
#include "hal/sdk/component.hh"

namespace {

using mw::mesa::MAX_SPI_BOARDS;

constexpr int DEFAULT_RATE_KHZ = 24'000;
char first_path[] = "/dev/spidev1.0";
char *spidev_path[MAX_SPI_BOARDS] = {first_path};
int spidev_rate[MAX_SPI_BOARDS] = {DEFAULT_RATE_KHZ, DEFAULT_RATE_KHZ, DEFAULT_RATE_KHZ, DEFAULT_RATE_KHZ,
                                   DEFAULT_RATE_KHZ};
char *config[MAX_SPI_BOARDS];
RTAPI_MP_ARRAY_STRING(spidev_path, MAX_SPI_BOARDS, "devices of the boards");
RTAPI_MP_ARRAY_INT(spidev_rate, MAX_SPI_BOARDS, "clock rates [kHz]");
RTAPI_MP_ARRAY_STRING(config, MAX_SPI_BOARDS, "which modules of each board are used");

int comp_id = -1;

int load_boards() {
    for (int i = 0; i < MAX_SPI_BOARDS && spidev_path[i] != nullptr; ++i) {
        const int status =
            mw::mesa::load_spi_board({.comp_id = comp_id,
                                      .module = "hm2_spi",
                                      .path = spidev_path[i],
                                      .rate_khz = spidev_rate[i],
                                      .read_rate_khz = 0,
                                      .config = mw::mesa::text_at(config, static_cast<unsigned>(i))});
        if (status != 0) {
            mw::mesa::remove_direct_boards(comp_id);
            return status;
        }
    }
    return 0;
}

}  // namespace

int rtapi_app_main(void) {
    comp_id = hal_init("hm2_spi");
    if (comp_id < 0) {
        return comp_id;
    }
    const int result = mw::sdk::finish(comp_id, load_boards());
    return result < 0 ? result : 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);  // no function of a board runs after this
    mw::mesa::remove_direct_boards(comp_id);
}
