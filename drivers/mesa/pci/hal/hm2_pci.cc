// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_pci: Mesa boards on PCI, PCI Express and PC/104-Plus.
//
//     loadrt hostmot2
//     loadrt hm2_pci config="num_encoders=1 num_stepgens=5 sserial_port_0=00xxxx"
//
// Strings of several boards are separated by commas, in the order of the PCI addresses.
#include "drivers/mesa/pci/hal/pci_boards.hh"
#include "hal/sdk/module.hh"

namespace {

char *config[mw::mesa::MAX_PCI_BOARDS];
RTAPI_MP_ARRAY_STRING(config, mw::mesa::MAX_PCI_BOARDS, "which modules of each board are used");

struct Boards {
    int comp_id = 0;

    int load(int id) noexcept {
        comp_id = id;
        return mw::mesa::load_pci_boards(id, config);
    }
    void end() noexcept { mw::mesa::unload_pci_boards(comp_id); }
};

}  // namespace

MW_COMPONENT_DEVICE(Boards, "hm2_pci");
