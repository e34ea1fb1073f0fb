// SPDX-License-Identifier: GPL-2.0-or-later
// The speed of a move along the curve where a user's planner module chooses it.
#pragma once

#include "trajectory/path/limits.hh"
#include "trajectory/path/planned_path.hh"
#include "trajectory/path/speed_choice.hh"

namespace mw::trajectory::plan {

/// A move for which a speed is chosen. Speeds along the parameter of its primitive [1/s].
struct ChoiceOfSpeed {
    Sequence number = 0;
    const Primitive &primitive;
    const MoveTag &tag;
    double before = 0;  ///< chosen for the move before; 0: none
    double most = 0;    ///< that feed, overrides and limits allow
    bool is_end = false;
};

struct ChosenSpeed {
    double most = 0;      ///< the highest of the chosen speeds; 0 where they are wrong
    Overreach overreach;  ///< why
};

/// With jerk limits the module chooses how fast, and the planner how the speed changes: the maximum speed
/// of the module's phases is a limit of speed on the move.
ChosenSpeed choose_speed(SpeedChooser &chooser, const ChoiceOfSpeed &choice, const Limits &limits) noexcept;

}  // namespace mw::trajectory::plan
