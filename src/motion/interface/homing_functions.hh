// SPDX-License-Identifier: GPL-2.0-or-later
// Functions that a homing module must export (declared in hal/include/homing.h). A module without one of them
// is not accepted.
#pragma once

namespace mw::motion {

inline constexpr const char *HOMING_FUNCTIONS[] = {
    "homeMotFunctions",
    "homing_init",
    "read_homing_in_pins",
    "write_homing_out_pins",
    "do_home_joint",
    "do_cancel_homing",
    "do_homing",
    "set_unhomed",
    "set_joint_homing_params",
    "update_joint_homing_params",
    "get_home_sequence",
    "get_homing",
    "get_homed",
    "get_allhomed",
    "get_homing_is_active",
    "get_home_is_idle",
    "get_home_is_synchronized",
    "get_home_needs_unlock_first",
    "get_index_enable",
    "get_homing_at_index_search_wait",
};

}  // namespace mw::motion
