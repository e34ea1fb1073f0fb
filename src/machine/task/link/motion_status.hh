// SPDX-License-Identifier: GPL-2.0-or-later
// What motion tells, in the words of the vocabulary.
#pragma once

#include "messages/declarations/status_parts.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// Writes trajectory, motion, joints, axes and spindles of `status` as far as they belong to the `fresh`
/// parts (motion::status_part) of what motion tells. Joints, axes and spindles that the machine does not have
/// are marked so and carry no values (H1). Gives the parts of `status` (messages::status_part) that it has
/// written.
PartMask tell_motion(const motion::Status &motion, PartMask fresh, unsigned axis_mask,
                     messages::MachineStatus &status);

}  // namespace mw::task
