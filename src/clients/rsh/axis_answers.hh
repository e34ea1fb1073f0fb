// SPDX-License-Identifier: GPL-2.0-or-later
// Answers about axes and joints: of all, or of the one that is named.
#pragma once

#include "clients/rsh/answers.hh"

namespace mw::rsh {

Answer absolute_actual(const Asked &asked);
Answer absolute_commanded(const Asked &asked);
Answer relative_actual(const Asked &asked);
Answer relative_commanded(const Asked &asked);
Answer axis_velocity(const Asked &asked);
Answer position_offset(const Asked &asked);
Answer joint_fault(const Asked &asked);
Answer joint_homed(const Asked &asked);
Answer joint_limit(const Asked &asked);
Answer joint_position(const Asked &asked);
Answer joint_type(const Asked &asked);
Answer joint_units(const Asked &asked);
Answer joint_velocity(const Asked &asked);

}  // namespace mw::rsh
