// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a rotary table A on a rotary table B (kinematics/tilting_table.hh): type 0 is identity, type
// 1 the tables.
#include "components/motion/switchable.hh"
#include "kinematics/tilting_table.hh"

static mw::components::PinnedModel<mw::kinematics::XyzabTable> pinned;

static int declare_model(int comp_id, const char *) {
    return pinned.declare(comp_id, "xyzab_tdr_kins");
}

static mw::components::PartOf tables(pinned);
static mw::components::Switchable switchable(&tables, nullptr);

MW_SWITCHED_MODULE("xyzab_tdr_kins", "XYZAB", declare_model);
