// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/homing/table.hh"

namespace mw::homing {

const char *failure_text(Failure failure) noexcept {
    switch (failure) {
    case Failure::NONE: return "no failure";
    case Failure::SEARCH_WITHOUT_LATCH:
        return "HOME_SEARCH_VEL is set but HOME_LATCH_VEL is 0; set both, or neither for immediate homing";
    case Failure::LATCH_WITHOUT_INDEX:
        return "HOME_LATCH_VEL is set without HOME_SEARCH_VEL, and HOME_USE_INDEX is NO; there is nothing to "
               "latch on";
    case Failure::INDEX_WITHOUT_LATCH:
        return "HOME_USE_INDEX is set but HOME_LATCH_VEL is 0; set the speed of the search for the index";
    case Failure::SHARED_SWITCH_CLOSED:
        return "the shared home switch is already closed; jog the joint that closes it off the switch";
    case Failure::SWITCH_NOT_FOUND:
        return "the home switch did not close within the joint's travel; check the switch and "
               "HOME_SEARCH_VEL's sign";
    case Failure::SWITCH_STUCK: return "the home switch did not open when backing off; check the switch";
    case Failure::SWITCH_LOST:
        return "the home switch opened again while stopping; search slower or lengthen the switch's cam";
    case Failure::SWITCH_CLOSED_AGAIN:
        return "the home switch closed again while stopping after backing off; check the switch";
    case Failure::INDEX_NOT_FOUND:
        return "no index pulse within the joint's travel; check the connection of index-enable";
    case Failure::LIMIT_HIT:
        return "a limit switch closed; if it is also the home switch, set HOME_IGNORE_LIMITS";
    case Failure::ABORTED: return "aborted";
    case Failure::TEAM_DIFFERS:
        return "other joints of its axis have different homing settings, which would rack the axis; set the "
               "same signs of HOME_SEARCH_VEL and HOME_LATCH_VEL, and the same HOME_USE_INDEX, "
               "HOME_ABSOLUTE_ENCODER and LOCKING_INDEXER";
    case Failure::TEAM_SKEWED:
        return "the axis would be racked: the joint and another joint of the axis differ by more than "
               "HOME_MAX_SKEW; check the home switches of both, and HOME_OFFSET";
    case Failure::NOT_UNLOCKED:
        return "the indexer did not unlock in time; check the pin joint.N.is-unlocked, which joints in "
               "motmod's "
               "unlock_joints_mask have";
    case Failure::NOT_LOCKED: return "the indexer did not lock in time; check the pin joint.N.is-unlocked";
    case Failure::INHIBITED: return "homing is inhibited: pin motion.homing-inhibit is TRUE";
    case Failure::MODULE_FAILED: return "the homing module reported a failure; check its messages";
    case Failure::MODULE_NONSENSE:
        return "the homing module commanded a position, speed or offset that is not a finite number";
    }
    return "unknown failure";
}

}  // namespace mw::homing
