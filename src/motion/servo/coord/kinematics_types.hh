// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of several types: the active type, and when it may change (motion.switchkins-type). The joints
// are stopped during a change. The pose becomes that of the new type.
#pragma once

#include <cstdint>

namespace mw::motion {

struct TypeInputs {
    double pin = 0;
    bool isOnPath = false;  ///< a path is executed or waiting
    bool isMoving = false;  ///< joints or axes are jogged or homed
    /// Count of requests that the path planner has seen while it was empty. It accepts no path until the new
    /// type is active.
    std::uint32_t seen = 0;
};

enum class TypeStep : std::uint8_t {
    NONE,
    WAIT,
    SWITCH,        ///< to `wanted`, now
    NO_SUCH_TYPE,  ///< the value of the pin is not a whole number of 0 or more
    ON_PATH,       ///< requested while a path is executed: the path must be stopped. Reported once
};

class KinematicsTypes {
  public:
    /// One cycle.
    TypeStep step(const TypeInputs &in) noexcept;
    /// Result of SWITCH. If the type does not exist or has no pose, the active type remains until the pin
    /// changes.
    void settle(bool isSwitched) noexcept;

    int active() const noexcept { return active_; }
    /// Value of the pin.
    int wanted() const noexcept { return wanted_; }
    /// True while the type requested by the pin is not active.
    bool isPending() const noexcept { return pending_; }
    /// Counts changes of the pin.
    std::uint32_t requests() const noexcept { return requests_; }
    /// Counts changes of the type, with overflow.
    std::uint8_t switches() const noexcept { return switches_; }

  private:
    int active_ = 0;
    int wanted_ = 0;
    std::uint32_t requests_ = 0;
    std::uint8_t switches_ = 0;
    bool pending_ = false;
    bool reported_ = false;  ///< a message has already reported that the type is not possible
};

}  // namespace mw::motion
