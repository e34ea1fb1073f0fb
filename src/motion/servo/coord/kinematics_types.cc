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

TypeStep step(KinematicsTypes &types, const TypeInputs &in) noexcept {
    const int wanted = type_of(in.pin);
    if (wanted != types.wanted) {
        types.wanted = wanted;
        types.isPending = wanted != types.type;
        types.isTold = false;
        ++types.asks;
        if (wanted == NO_TYPE) {
            types.isPending = false;
            return TypeStep::NO_SUCH_TYPE;
        }
    }
    if (!types.isPending) {
        return TypeStep::NONE;
    }
    if (in.isOnPath && !types.isTold) {
        types.isTold = true;
        return TypeStep::ON_PATH;
    }
    return in.isOnPath || in.isMoving || in.seen != types.asks ? TypeStep::WAIT : TypeStep::SWITCH;
}

void settle(KinematicsTypes &types, bool isSwitched) noexcept {
    types.type = isSwitched ? types.wanted : types.type;
    if (isSwitched) {
        ++types.switches;
    }
    types.isPending = false;
}

}  // namespace mw::motion
