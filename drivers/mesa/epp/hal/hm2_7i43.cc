// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_7i43: Mesa 7I43 boards on parallel ports in EPP mode.
//
//     loadrt hostmot2
//     loadrt hm2_7i43 ioaddr=0x378 config="num_encoders=1 num_stepgens=3"
#include "drivers/mesa/epp/hal/epp_component.hh"

MW_COMPONENT_DEVICE(EppBoards<mw::mesa::EppCard::CARD_7I43>, "hm2_7i43");
