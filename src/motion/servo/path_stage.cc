// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/path_stage.hh"

namespace mw::motion {

void apply_holds(ControllerParts &parts, const Inputs &in) noexcept {
    Holds &holds = parts.holds;
    holds.step({in.adaptive_feed, in.isFeedHeld, in.isFeedInhibited,
                parts.link->steps_done.load(std::memory_order_acquire)});
    const bool isReversing = holds.isReverseWanted() || parts.retracing.isAway();
    parts.executor.hold(holds.isHoldWanted() || parts.alignment.isMisaligned() ||
                        (parts.power.mode() == Mode::COORD && isReversing));
}

void follow_spindles(ControllerParts &parts) noexcept {
    for (int n = 0; n < parts.model.num_spindles(); ++n) {
        parts.executor.set_spindle(n, parts.spindles[n].turns);
        parts.executor.set_brakings(n, parts.spindles.brakings(n, parts.model.settings()));
    }
}

}  // namespace mw::motion
