// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of industrial arms with a spherical wrist (kinematics/ortho_parallel.hh), switchable to
// identity.
#include "components/motion/switchable.hh"
#include "kinematics/ortho_parallel.hh"

static mw::components::PinnedModel<mw::kinematics::OrthoParallel> pinned;

static int declare_model(int comp_id, const char *) {
    return pinned.declare(comp_id, "three21kins");
}

MW_SWITCHABLE_MODULE(pinned, "three21kins", "XYZABCUVW", declare_model);
