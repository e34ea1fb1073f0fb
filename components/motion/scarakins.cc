// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of SCARA arms (kinematics/scara.hh), switchable to identity.
#include "components/motion/switchable.hh"
#include "kinematics/scara.hh"

static mw::components::PinnedModel<mw::kinematics::Scara> pinned;

static int declare_model(int comp_id, const char *) {
    return pinned.declare(comp_id, "scarakins");
}

MW_SWITCHABLE_MODULE(pinned, "scarakins", "XYZABCUVW", declare_model);
