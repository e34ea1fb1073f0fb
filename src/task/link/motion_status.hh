// SPDX-License-Identifier: GPL-2.0-or-later
// What motion tells, in the words of the vocabulary.
#pragma once

#include "motion/api/status.hh"
#include "msgs/status.hh"

namespace mw::task {

/// Writes trajectory, motion, joints, axes and spindles of `status`. Joints, axes and spindles that the
/// machine does not have are marked so and carry no values (H1).
void tell_motion(const motion::Status &motion, unsigned axis_mask, msgs::MachineStatus &status);

}  // namespace mw::task
