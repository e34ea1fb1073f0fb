// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/power/power.hh"

namespace mw::motion {

Reason Power::check_mode(Mode mode, const ModeConditions &conditions) const noexcept {
    if (mode == mode_) {
        return Reason::NONE;
    }
    if (conditions.isHoming) {
        return Reason::HOMING;
    }
    if (conditions.isMoving) {
        return Reason::MOVING;
    }
    const bool isLost = mode != Mode::FREE && conditions.needsHome && !conditions.areAllHomed;
    return isLost ? Reason::NOT_HOMED : Reason::NONE;
}

bool Power::begin_stop() noexcept {
    const bool isNew = isReady();
    stopping_ = stopping_ || isNew;
    return isNew;
}

void Power::switch_on() noexcept {
    enabled_ = true;
    ++enables_;
}

void Power::switch_off() noexcept {
    enabled_ = false;
    stopping_ = false;
}

}  // namespace mw::motion
