// SPDX-License-Identifier: GPL-2.0-or-later
// Answers about axes and joints: all, or the named one.
#pragma once

#include <span>

#include "clients/rsh/answers.hh"

namespace mw::rsh {

struct NamedAnswer {
    const char *name;
    Answering answering;
};
/// Answers from legacy::JOINT_STATUS.
std::span<const NamedAnswer> joint_answers();

/// The position of all axes, or of the one that is requested.
Answer pose(const Asked &asked, const char *name, const geometry::Pose &pose);
Answer axis_velocity(const Asked &asked);
Answer position_offset(const Asked &asked);
Answer joint_velocity(const Asked &asked);

}  // namespace mw::rsh
