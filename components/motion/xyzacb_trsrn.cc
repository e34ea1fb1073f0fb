// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a rotary table A under a head with an inclined axis B.
#include "components/motion/leaning_head.hh"

namespace {

mw::components::LeaningHead<mw::kinematics::NutatingHeadOverA> head;
mw::components::Switchable &switchable = head.switchable();

int declare_model(int comp_id, const char *letters) {
    return head.declare(comp_id, "xyzacb_trsrn", "xyzacb_trsrn_kins", letters);
}

}  // namespace

MW_SWITCHED_MODULE("xyzacb_trsrn", "XYZABC", declare_model);
