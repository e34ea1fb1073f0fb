// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_pci: Mesa boards on PCI, PCI Express and PC/104-Plus.
//
//     loadrt hostmot2
//     loadrt hm2_pci config="num_encoders=1 num_stepgens=5 sserial_port_0=00xxxx"
//
// Strings of several boards are separated by commas, in the order of the PCI addresses.
#include "drivers/mesa/pci/hal/pci_boards.hh"
#include "hal/sdk/component.hh"

namespace {

char *config[mw::mesa::MAX_PCI_BOARDS];
RTAPI_MP_ARRAY_STRING(config, mw::mesa::MAX_PCI_BOARDS, "which modules of each board are used");

int comp_id = -1;

}  // namespace

int rtapi_app_main(void) {
    comp_id = hal_init("hm2_pci");
    if (comp_id < 0) {
        return comp_id;
    }
    const int result = mw::sdk::finish(comp_id, mw::mesa::load_pci_boards(comp_id, config));
    return result < 0 ? result : 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);  // no function of a board runs after this
    mw::mesa::unload_pci_boards(comp_id);
}
