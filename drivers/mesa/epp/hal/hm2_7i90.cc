// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_7i90: Mesa 7I90 boards on parallel ports in EPP mode.
//
//     loadrt hostmot2
//     loadrt hm2_7i90 ioaddr=0x378 config="num_encoders=1 num_stepgens=3"
#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/epp/hal/epp_boards.hh"
#include "hal/sdk/component.hh"

namespace {

using mw::mesa::MAX_EPP_BOARDS;

// Without ioaddr= there is one board at the first port of Linux.
int ioaddr[MAX_EPP_BOARDS] = {0, -1, -1, -1, -1, -1, -1, -1};
int ioaddr_hi[MAX_EPP_BOARDS];
int epp_wide[MAX_EPP_BOARDS] = {1, 1, 1, 1, 1, 1, 1, 1};
int debug_epp[MAX_EPP_BOARDS];
char *config[MAX_EPP_BOARDS];
RTAPI_MP_ARRAY_INT(ioaddr, MAX_EPP_BOARDS, "addresses of the parallel ports, or their numbers");
RTAPI_MP_ARRAY_INT(ioaddr_hi, MAX_EPP_BOARDS, "addresses of their ECP registers; 0: found out");
RTAPI_MP_ARRAY_INT(epp_wide, MAX_EPP_BOARDS, "0: accesses of 8 bits only");
RTAPI_MP_ARRAY_INT(debug_epp, MAX_EPP_BOARDS, "accepted for files of LinuxCNC; failures are always counted");
RTAPI_MP_ARRAY_STRING(config, MAX_EPP_BOARDS, "which modules of each board are used");

int comp_id = -1;

}  // namespace

int rtapi_app_main(void) {
    comp_id = hal_init("hm2_7i90");
    if (comp_id < 0) {
        return comp_id;
    }
    const int status = mw::mesa::load_epp_boards({.comp_id = comp_id,
                                                  .card = mw::mesa::EppCard::CARD_7I90,
                                                  .addresses = ioaddr,
                                                  .high_addresses = ioaddr_hi,
                                                  .wide = epp_wide,
                                                  .configs = config});
    const int result = mw::sdk::finish(comp_id, status);
    return result < 0 ? result : 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);  // no function of a board runs after this
    mw::mesa::remove_direct_boards(comp_id);
}
