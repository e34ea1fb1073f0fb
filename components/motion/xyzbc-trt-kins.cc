// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a rotary table C on a tilting one B (kinematics/tilting_table.hh), switchable to identity.
#include "components/motion/switchable.hh"
#include "kinematics/tilting_table.hh"

static mw::components::PinnedModel<mw::kinematics::XyzbcTable> pinned;

static int declare_model(int comp_id, const char *letters) {
    if (!pinned.base().set_letters(letters)) {
        return -EINVAL;  // already reported
    }
    return pinned.declare(comp_id, "xyzbc-trt-kins");
}

MW_SWITCHABLE_MODULE(pinned, "xyzbc-trt-kins", "XYZBC", declare_model);
