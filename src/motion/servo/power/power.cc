// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/power/power.hh"

namespace mw::motion {

Reason check_mode(const Power &power, Mode mode, const ModeConditions &conditions) noexcept {
    if (mode == power.mode) {
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

bool begin_stop(Power &power) noexcept {
    const bool isNew = power.isReady();
    power.isStopping = power.isStopping || isNew;
    return isNew;
}

void switch_on(Power &power) noexcept {
    power.isEnabled = true;
    ++power.enables;
}

void switch_off(Power &power) noexcept {
    power.isEnabled = false;
    power.isStopping = false;
}

}  // namespace mw::motion
