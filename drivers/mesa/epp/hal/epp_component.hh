// SPDX-License-Identifier: GPL-2.0-or-later
// The common part of hm2_7i43 and hm2_7i90: module parameters and loading. Each component includes it once.
#pragma once

#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/epp/hal/epp_boards.hh"
#include "hal/sdk/module.hh"

namespace {

using mw::mesa::MAX_EPP_BOARDS;

// Without ioaddr= there is one board, at the first port of Linux.
int ioaddr[MAX_EPP_BOARDS] = {0, -1, -1, -1, -1, -1, -1, -1};
int ioaddr_hi[MAX_EPP_BOARDS];
int epp_wide[MAX_EPP_BOARDS] = {1, 1, 1, 1, 1, 1, 1, 1};
int debug_epp[MAX_EPP_BOARDS];
char *config[MAX_EPP_BOARDS];
RTAPI_MP_ARRAY_INT(ioaddr, MAX_EPP_BOARDS, "addresses of the parallel ports, or their numbers");
RTAPI_MP_ARRAY_INT(ioaddr_hi, MAX_EPP_BOARDS, "addresses of their ECP registers; 0: detected");
RTAPI_MP_ARRAY_INT(epp_wide, MAX_EPP_BOARDS, "0: accesses of 8 bits only");
RTAPI_MP_ARRAY_INT(debug_epp, MAX_EPP_BOARDS, "accepted for files of LinuxCNC; failures are always counted");
RTAPI_MP_ARRAY_STRING(config, MAX_EPP_BOARDS, "which modules of each board are used");

template <mw::mesa::EppCard CARD>
struct EppBoards {
    int comp_id = 0;

    int load(int id) noexcept {
        comp_id = id;
        return mw::mesa::load_epp_boards({.comp_id = id,
                                          .card = CARD,
                                          .addresses = ioaddr,
                                          .high_addresses = ioaddr_hi,
                                          .wide = epp_wide,
                                          .configs = config});
    }
    void end() noexcept { mw::mesa::remove_direct_boards(comp_id); }
};

}  // namespace
