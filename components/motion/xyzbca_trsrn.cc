// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a rotary table B under a head with an inclined axis A.
#include "components/motion/leaning_head.hh"

namespace {

mw::components::LeaningHead<mw::kinematics::NutatingHeadOverB> head;
mw::components::Switchable &switchable = head.switchable();

int declare_model(int comp_id, const char *letters) {
    return head.declare(comp_id, "xyzbca_trsrn", "xyzbca_trsrn_kins", letters);
}

}  // namespace

MW_SWITCHED_MODULE("xyzbca_trsrn", "XYZABC", declare_model);
