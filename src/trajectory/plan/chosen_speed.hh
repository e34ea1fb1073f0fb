// SPDX-License-Identifier: GPL-2.0-or-later
// The speed of a move along the curve, chosen by a user's planner module.
#pragma once

#include "trajectory/path/limits.hh"
#include "trajectory/path/planned_path.hh"
#include "trajectory/path/speed_choice.hh"

namespace mw::trajectory::plan {

/// A move for which the module chooses a speed. Speeds are along the parameter of its primitive [1/s].
struct ChoiceOfSpeed {
    Sequence number = 0;
    const Primitive &primitive;
    const MoveTag &tag;
    double before = 0;  ///< speed chosen for the previous move; 0: none
    double most = 0;    ///< maximum speed by feed and overrides
    bool is_end = false;
};

struct ChosenSpeed {
    double most = 0;      ///< maximum of the chosen speeds; 0: the choice is rejected
    Overreach overreach;  ///< reason for a rejection
};

/// Asks the module for the speed of a move. The module chooses the speed, and the planner how the speed
/// changes: the maximum speed of the module's phases becomes a speed limit on the move.
ChosenSpeed choose_speed(SpeedChooser &chooser, const ChoiceOfSpeed &choice, const Limits &limits) noexcept;

}  // namespace mw::trajectory::plan
