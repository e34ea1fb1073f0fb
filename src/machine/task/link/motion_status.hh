// SPDX-License-Identifier: GPL-2.0-or-later
// The status of motion, in the types of messages.
#pragma once

#include "messages/declarations/status_parts.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// Writes trajectory, motion, joints, axes and spindles of `status` that belong to the `fresh` parts
/// (motion::status_part). Joints, axes and spindles that the machine does not have are marked so and have no
/// values (H1). Returns the parts of `status` (messages::status_part) that it has written.
PartMask tell_motion(const motion::Status &motion, PartMask fresh, unsigned axis_mask,
                     messages::MachineStatus &status);

}  // namespace mw::task
