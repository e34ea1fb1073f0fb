// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_test: boards with errors in the description of their firmware; all are rejected.
#include "drivers/mesa/hostmot2/hal/test_board.hh"
#include "hal/sdk/component.hh"

namespace {

int test_pattern = 0;
RTAPI_MP_INT(test_pattern, "number of the description, from 0");

int comp_id = -1;

}  // namespace

int rtapi_app_main(void) {
    comp_id = hal_init("hm2_test");
    if (comp_id < 0) {
        return comp_id;
    }
    const int status = mw::mesa::load_test_board(comp_id, test_pattern);
    return mw::sdk::finish(comp_id, status) < 0 ? status : 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
