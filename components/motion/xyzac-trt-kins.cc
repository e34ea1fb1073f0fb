// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a rotary table C on a tilting one A (kinematics/tilting_table.hh), switchable to identity.
#include "components/motion/switchable.hh"
#include "kinematics/tilting_table.hh"

static mw::components::PinnedModel<mw::kinematics::XyzacTable> pinned;

static int declare_model(int comp_id, const char *letters) {
    if (!pinned.base().set_letters(letters)) {
        return -EINVAL;  // already reported
    }
    return pinned.declare(comp_id, "xyzac-trt-kins");
}

MW_SWITCHABLE_MODULE(pinned, "xyzac-trt-kins", "XYZAC", declare_model);
