// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of several types: which is in force, and when it may be another (motion.switchkins-type). The
// joints stand while it changes; the pose is the one that the new type has for them.
#pragma once

#include <cstdint>

namespace mw::motion {

struct KinematicsTypes {
    int type = 0;               ///< in force
    int wanted = 0;             ///< of the pin
    std::uint32_t asks = 0;     ///< counts changes of the pin
    std::uint8_t switches = 0;  ///< counts them, round and round
    bool isPending = false;     ///< the type wanted is not in force yet
    bool isTold = false;        ///< that it cannot be
};

struct TypeInputs {
    double pin = 0;
    bool isOnPath = false;  ///< a path is driven or waits
    bool isMoving = false;  ///< joints or axes are jogged or homed
    /// The count of asks that the path planner has seen while it had nothing: it takes no path until the new
    /// type is in force.
    std::uint32_t seen = 0;
};

enum class TypeStep : std::uint8_t {
    NONE,
    WAIT,
    SWITCH,        ///< to `wanted`, now
    NO_SUCH_TYPE,  ///< the pin is no whole number of 0 or more
    ON_PATH,       ///< asked for while a path is driven: the path is to be stopped. Told once
};

/// One cycle.
TypeStep step(KinematicsTypes &types, const TypeInputs &in) noexcept;
/// What came of SWITCH: when there is no such type, or no pose of it, the one in force stays until the pin
/// changes.
void settle(KinematicsTypes &types, bool isSwitched) noexcept;

}  // namespace mw::motion
