// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/coord/kinematics_types.hh"

namespace mw::motion {
namespace {

constexpr int NO_TYPE = -1;

int type_of(double pin) noexcept {
    constexpr double MOST = 1000;
    const bool isPossible = pin >= 0 && pin <= MOST;  // false of NaN
    const int type = isPossible ? static_cast<int>(pin) : NO_TYPE;
    return static_cast<double>(type) == pin ? type : NO_TYPE;
}

}  // namespace

TypeStep KinematicsTypes::step(const TypeInputs &in) noexcept {
    const int wanted = type_of(in.pin);
    if (wanted != wanted_) {
        wanted_ = wanted;
        pending_ = wanted != active_;
        reported_ = false;
        ++requests_;
        if (wanted == NO_TYPE) {
            pending_ = false;
            return TypeStep::NO_SUCH_TYPE;
        }
    }
    if (!pending_) {
        return TypeStep::NONE;
    }
    if (in.isOnPath && !reported_) {
        reported_ = true;
        return TypeStep::ON_PATH;
    }
    return in.isOnPath || in.isMoving || in.seen != requests_ ? TypeStep::WAIT : TypeStep::SWITCH;
}

void KinematicsTypes::settle(bool isSwitched) noexcept {
    active_ = isSwitched ? wanted_ : active_;
    if (isSwitched) {
        ++switches_;
    }
    pending_ = false;
}

}  // namespace mw::motion
