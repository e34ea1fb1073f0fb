// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of arms like the Puma 560 (kinematics/puma.hh), switchable to identity.
#include "components/motion/switchable.hh"
#include "kinematics/puma.hh"

static mw::components::PinnedModel<mw::kinematics::Puma> pinned;

static int declare_model(int comp_id, const char *) {
    return pinned.declare(comp_id, "pumakins");
}

MW_SWITCHABLE_MODULE(pinned, "pumakins", "XYZABCUVW", declare_model);
