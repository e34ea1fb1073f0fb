// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of bridge mills with a head that turns and tilts (kinematics/bridge_mill.hh), switchable to
// identity.
#include "components/motion/switchable.hh"
#include "kinematics/bridge_mill.hh"

static mw::components::PinnedModel<mw::kinematics::BridgeMill> pinned;

static int declare_model(int comp_id, const char *letters) {
    if (!pinned.base().set_letters(letters)) {
        return -EINVAL;  // already reported
    }
    return pinned.declare(comp_id, "5axiskins");
}

MW_SWITCHABLE_MODULE(pinned, "5axiskins", "XYZBCW", declare_model);
