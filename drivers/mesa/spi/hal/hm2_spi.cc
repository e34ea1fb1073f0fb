// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_spi: Mesa boards on SPI, through /dev/spidev.
//
//     loadrt hostmot2
//     loadrt hm2_spi spidev_path=/dev/spidev1.0 spidev_rate=24000 config="num_encoders=1"
#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/spi/hal/spi_boards.hh"
#include "hal/sdk/module.hh"

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

struct Boards {
    int comp_id = 0;

    int load(int id) noexcept {
        comp_id = id;
        int status = 0;
        for (int i = 0; i < MAX_SPI_BOARDS && spidev_path[i] != nullptr && status == 0; ++i) {
            status =
                mw::mesa::load_spi_board({.comp_id = id,
                                          .module = "hm2_spi",
                                          .path = spidev_path[i],
                                          .rate_khz = spidev_rate[i],
                                          .read_rate_khz = 0,
                                          .config = mw::mesa::text_at(config, static_cast<unsigned>(i))});
        }
        return status;
    }
    void end() noexcept { mw::mesa::remove_direct_boards(comp_id); }
};

}  // namespace

MW_COMPONENT_DEVICE(Boards, "hm2_spi");
