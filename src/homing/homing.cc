// SPDX-License-Identifier: GPL-2.0-or-later
#include "homing/homing.hh"

#include <cmath>
#include <cstdlib>

namespace mw::homing {

namespace {

/// A signed move at a signed speed, as far as the travel goes.
void go(JointCommand &out, double velocity, double travel) noexcept {
    out.move = Move::BY;
    out.value = std::copysign(travel, velocity);
    out.velocity = std::abs(velocity);
}

}  // namespace

bool Homing::isActive() const noexcept {
    for (int j = 0; j < num_joints_; ++j) {
        if (isHoming(j)) {
            return true;
        }
    }
    return sequence_ >= 0;
}

bool Homing::hasWork() const noexcept {
    bool isStopping = false;
    for (int j = 0; j < num_joints_; ++j) {
        isStopping = isStopping || isStopping_[j];
    }
    return isStopping || isActive();
}

bool Homing::isAllHomed() const noexcept {
    for (int j = 0; j < num_joints_; ++j) {
        if (!isHomed(j)) {
            return false;
        }
    }
    return num_joints_ > 0;
}

void Homing::begin(int joint) noexcept {
    Joint &j = joints_[index(joint)];
    const bool isAbsoluteAgain = j.parameters.absolute_encoder != 0 && j.isHomed;
    if (isAbsoluteAgain || j.state != State::IDLE) {
        return;
    }
    j.state = State::START;
    j.isHomed = false;
    j.isMoving = false;
    j.isIndexWanted = false;
}

void Homing::start(int joint) noexcept {
    if (joint >= 0) {
        const Parameters &p = joints_[index(joint)].parameters;
        const bool isGroup = p.sequence < 0 && p.isInSequence();
        begin(joint);
        for (int k = 0; k < num_joints_ && isGroup; ++k) {
            if (std::abs(joints_[index(k)].parameters.sequence) == -p.sequence) {
                begin(k);
            }
        }
        return;
    }
    sequence_ = start_sequence(0) ? 0 : start_sequence(1) ? 1 : -1;
}

/// Begins all joints of a sequence number; false when there are none.
bool Homing::start_sequence(int number) noexcept {
    bool isAny = false;
    for (int k = 0; k < num_joints_; ++k) {
        const Parameters &p = joints_[index(k)].parameters;
        if (p.isInSequence() && std::abs(p.sequence) == number) {
            begin(k);
            isAny = true;
        }
    }
    return isAny;
}

void Homing::advance_sequence() noexcept {
    if (sequence_ < 0) {
        return;
    }
    for (int k = 0; k < num_joints_; ++k) {
        if (isHoming(k)) {
            return;
        }
    }
    ++sequence_;
    if (!start_sequence(sequence_)) {
        sequence_ = -1;
    }
}

void Homing::abort(Failure why) noexcept {
    for (int k = 0; k < num_joints_; ++k) {
        if (isHoming(k)) {
            fail(k, why);
            return;
        }
    }
    sequence_ = -1;
}

/// One joint fails: everything that is being homed stops.
void Homing::fail(int joint, Failure why) noexcept {
    failed_joint_ = joint;
    failure_ = why;
    sequence_ = -1;
    for (int k = 0; k < num_joints_; ++k) {
        Joint &j = joints_[index(k)];
        if (j.state != State::IDLE) {
            j.state = State::IDLE;
            j.isIndexWanted = false;
            isStopping_[k] = true;
        }
    }
}

int Homing::take_failure(Failure &why) noexcept {
    const int joint = failed_joint_;
    why = failure_;
    failed_joint_ = -1;
    failure_ = Failure::NONE;
    return joint;
}

/// All joints of a synchronised group have found their zero.
bool Homing::isGroupReady(int joint) const noexcept {
    const int number = std::abs(joints_[index(joint)].parameters.sequence);
    bool isSynchronised = false;
    bool isReady = true;
    for (int k = 0; k < num_joints_; ++k) {
        const Joint &j = joints_[index(k)];
        if (!j.parameters.isInSequence() || std::abs(j.parameters.sequence) != number ||
            j.state == State::IDLE) {
            continue;
        }
        isSynchronised = isSynchronised || j.parameters.sequence < 0;
        isReady = isReady && (j.state == State::WAIT_FOR_GROUP || j.state == State::FINAL);
    }
    return !isSynchronised || isReady;
}

void Homing::step(const JointInput *inputs, JointCommand *commands) noexcept {
    std::array<bool, MAX_JOINTS> isReady{};
    for (int k = 0; k < num_joints_; ++k) {
        commands[k] = {};
        isReady[index(k)] = joints_[index(k)].state == State::WAIT_FOR_GROUP && isGroupReady(k);
    }
    for (int k = 0; k < num_joints_; ++k) {
        Joint &j = joints_[index(k)];
        if (j.state == State::IDLE) {
            continue;
        }
        Failure why = Failure::NONE;
        if (inputs[k].isOnLimit) {
            why = Failure::LIMIT_HIT;
        } else if (isReady[index(k)]) {
            j.state = State::FINAL;
            j.isMoving = false;
        }
        if (why == Failure::NONE) {
            why = step_joint(j, inputs[k], commands[k]);
        }
        if (why != Failure::NONE) {
            fail(k, why);
        }
    }
    for (int k = 0; k < num_joints_; ++k) {
        if (isStopping_[k]) {
            commands[k] = {};
            commands[k].move = Move::STOP;
            isStopping_[k] = false;
        }
    }
    advance_sequence();
}

Failure Homing::step_start(Joint &j, const JointInput &in, JointCommand &out) noexcept {
    const Parameters &p = j.parameters;
    if (p.absolute_encoder != 0 || (p.search_vel == 0 && p.latch_vel == 0 && !p.isUsingIndex)) {
        out.isShifting = true;
        out.shift = p.offset - in.pos_fb;
        if (p.absolute_encoder == 2) {
            j.state = State::IDLE;
            j.isHomed = true;
        } else {
            j.state = State::WAIT_FOR_GROUP;
        }
        return Failure::NONE;
    }
    if (p.latch_vel == 0) {
        return p.search_vel != 0 ? Failure::SEARCH_WITHOUT_LATCH : Failure::INDEX_WITHOUT_LATCH;
    }
    if (p.search_vel == 0) {
        if (!p.isUsingIndex) {
            return Failure::LATCH_WITHOUT_INDEX;
        }
        j.state = State::INDEX;
        j.isIndexWanted = true;
        go(out, p.latch_vel, p.travel);
        return Failure::NONE;
    }
    if (in.isSwitchClosed && p.isSharedSwitch) {
        return Failure::SHARED_SWITCH_CLOSED;
    }
    j.state = in.isSwitchClosed ? State::INITIAL_BACKOFF : State::SEARCH;
    go(out, in.isSwitchClosed ? -p.search_vel : p.search_vel, p.travel);
    return Failure::NONE;
}

/// On the slow way to the switch's edge.
Failure Homing::step_latch(Joint &j, const JointInput &in, JointCommand &out) noexcept {
    const Parameters &p = j.parameters;
    const bool isToClosed = (p.search_vel > 0) == (p.latch_vel > 0);
    if (in.isSwitchClosed != isToClosed) {
        return in.isAtRest ? (isToClosed ? Failure::SWITCH_NOT_FOUND : Failure::SWITCH_STUCK) : Failure::NONE;
    }
    if (p.isUsingIndex) {
        j.state = State::INDEX;
        j.isIndexWanted = true;
        j.wait = 0;
        return Failure::NONE;
    }
    out.isShifting = true;
    out.shift = p.offset - in.pos_fb;
    finish_latch(j, out);
    return Failure::NONE;
}

Failure Homing::step_index(Joint &j, const JointInput &in, JointCommand &out) noexcept {
    const Parameters &p = j.parameters;
    // The pin shows what we set one cycle later; before that a low pin says nothing.
    constexpr int SETTLE_CYCLES = 2;
    const bool isSettled = ++j.wait > SETTLE_CYCLES;
    if (!isSettled || in.isIndexEnabled) {
        return isSettled && in.isAtRest ? Failure::INDEX_NOT_FOUND : Failure::NONE;
    }
    j.isIndexWanted = false;
    if (p.isIndexWithoutReset) {
        out.isShifting = true;
        out.shift = p.offset - in.pos_fb;
    } else {
        out.isSettingZero = true;
        out.zero = p.offset;
    }
    finish_latch(j, out);
    return Failure::NONE;
}

void Homing::finish_latch(Joint &j, JointCommand &out) noexcept {
    out.move = Move::STOP;
    j.state = State::LATCHED_STOP;
}

Failure Homing::step_joint(Joint &j, const JointInput &in, JointCommand &out) noexcept {
    const Parameters &p = j.parameters;
    switch (j.state) {
    case State::IDLE: break;
    case State::START: j.wait = 0; return step_start(j, in, out);
    case State::INITIAL_BACKOFF:
    case State::LATCH_BACKOFF:
        if (!in.isSwitchClosed) {
            out.move = Move::STOP;
            j.state =
                j.state == State::LATCH_BACKOFF ? State::LATCH_BACKOFF_STOP : State::INITIAL_BACKOFF_STOP;
        } else if (in.isAtRest) {
            return Failure::SWITCH_STUCK;
        }
        break;
    case State::INITIAL_BACKOFF_STOP:
        if (in.isAtRest) {
            j.state = State::SEARCH;
            go(out, p.search_vel, p.travel);
        }
        break;
    case State::SEARCH:
        if (in.isSwitchClosed) {
            out.move = Move::STOP;
            j.state = State::SEARCH_STOP;
        } else if (in.isAtRest) {
            return Failure::SWITCH_NOT_FOUND;
        }
        break;
    case State::SEARCH_STOP:
        if (in.isAtRest) {
            const bool isSameWay = (p.search_vel > 0) == (p.latch_vel > 0);
            if (!in.isSwitchClosed) {
                return Failure::SWITCH_LOST;
            }
            j.state = isSameWay ? State::LATCH_BACKOFF : State::LATCH;
            go(out, isSameWay ? -p.search_vel : p.latch_vel, p.travel);
        }
        break;
    case State::LATCH_BACKOFF_STOP:
        if (in.isAtRest) {
            j.state = State::LATCH;
            go(out, p.latch_vel, p.travel);
        }
        break;
    case State::LATCH: return step_latch(j, in, out);
    case State::INDEX: return step_index(j, in, out);
    case State::LATCHED_STOP: j.state = in.isAtRest ? State::WAIT_FOR_GROUP : State::LATCHED_STOP; break;
    case State::WAIT_FOR_GROUP: break;
    case State::FINAL:
        if (!j.isMoving) {
            out.move = Move::TO;
            out.value = p.home;
            out.velocity = p.final_vel > 0 ? p.final_vel : 0;
            j.isMoving = true;
        } else if (in.isAtRest) {
            j.state = State::IDLE;
            j.isHomed = true;
        }
        break;
    }
    return Failure::NONE;
}

const char *failure_text(Failure failure) noexcept {
    switch (failure) {
    case Failure::NONE: return "no failure";
    case Failure::SEARCH_WITHOUT_LATCH:
        return "HOME_SEARCH_VEL is set but HOME_LATCH_VEL is 0; set both, or neither for immediate homing";
    case Failure::LATCH_WITHOUT_INDEX:
        return "HOME_LATCH_VEL is set without HOME_SEARCH_VEL, and HOME_USE_INDEX is NO; there is nothing to "
               "latch on";
    case Failure::INDEX_WITHOUT_LATCH:
        return "HOME_USE_INDEX is set but HOME_LATCH_VEL is 0; set the speed to look for the index with";
    case Failure::SHARED_SWITCH_CLOSED:
        return "the shared home switch is already closed; jog the joint that closes it off the switch";
    case Failure::SWITCH_NOT_FOUND:
        return "the home switch did not close within the joint's travel; check the switch and "
               "HOME_SEARCH_VEL's sign";
    case Failure::SWITCH_STUCK: return "the home switch did not open when backing off; check the switch";
    case Failure::SWITCH_LOST:
        return "the home switch opened again while stopping; search slower or lengthen the switch's cam";
    case Failure::INDEX_NOT_FOUND:
        return "no index pulse within the joint's travel; check the connection of index-enable";
    case Failure::LIMIT_HIT:
        return "a limit switch closed; if it is also the home switch, set HOME_IGNORE_LIMITS";
    case Failure::ABORTED: return "aborted";
    case Failure::GROUP_FAILED: return "another joint of its group failed";
    }
    return "unknown failure";
}

}  // namespace mw::homing
