// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/motion_mode.hh"

namespace mw::motion {
namespace {

constexpr FreeMode FREE;
constexpr TeleopMode TELEOP;
constexpr CoordMode COORD;

}  // namespace

const MotionMode &motion_mode(Mode mode) noexcept {
    switch (mode) {
    case Mode::FREE: return FREE;
    case Mode::TELEOP: return TELEOP;
    case Mode::COORD: break;
    }
    return COORD;
}

bool isAnythingMoving(const ControllerParts &parts) noexcept {
    const bool isOnPath =
        !parts.executor.isAtRest() || parts.retracing.isMoving() || parts.alignment.isMoving();
    return isOnPath || motion_mode(parts.power.mode()).isJogging(parts);
}

}  // namespace mw::motion
