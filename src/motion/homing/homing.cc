// SPDX-License-Identifier: GPL-2.0-or-later
// Sequences and single cycles of homing. team.cc moves joints together.
#include "motion/homing/homing.hh"

#include <cmath>
#include <cstdlib>

namespace mw::homing {

void Homing::summarise() const noexcept {
    Summary s;
    for (int j = 0; j < MAX_JOINTS; ++j) {
        const Joint &joint = at(j);
        const bool isHere = j < num_joints_;
        const bool isBusy = joint.state != State::IDLE || joint.isStopping || joint.isUnlockWanted;
        s.isAnyHoming = s.isAnyHoming || (isHere && joint.state != State::IDLE);
        s.isAnyBusy = s.isAnyBusy || (isHere && isBusy);
        s.isQuiet = s.isQuiet && !isBusy && !joint.isIndexWanted;
        s.homed |= joint.isHomed ? 1U << j : 0U;
    }
    s.isCurrent = true;
    summary_ = s;
}

void Homing::begin(int joint) noexcept {
    Joint &j = at(joint);
    const bool isAbsoluteAgain = j.parameters.absolute_encoder != 0 && j.isHomed;
    const Transition *row = j.state == State::IDLE ? transition(joint, event::BEGIN) : nullptr;
    if (isAbsoluteAgain || row == nullptr || !j.parameters.isActive) {
        return;
    }
    j.state = row->next;
    j.isUnlockWanted = row->action == Action::UNLOCK;
    j.isHomed = false;
    j.isIndexWanted = false;
    j.wait = 0;
    j.way = 0;
    j.team_acceleration = 0;
}

void Homing::start(int joint) noexcept {
    if (joint >= 0) {
        const Parameters &p = at(joint).parameters;
        const bool isGroup = p.sequence < 0 && p.isInSequence();
        begin(joint);
        for (int k = 0; k < num_joints_ && isGroup; ++k) {
            if (std::abs(at(k).parameters.sequence) == -p.sequence) {
                begin(k);
            }
        }
        return;
    }
    sequence_ = start_sequence(0) ? 0 : start_sequence(1) ? 1 : -1;
}

/// Starts all joints of a sequence number; false if there are none.
bool Homing::start_sequence(int number) noexcept {
    bool isAny = false;
    for (int k = 0; k < num_joints_; ++k) {
        const Parameters &p = at(k).parameters;
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

void Homing::abort(event::Event why, int joint) noexcept {
    for (int k = 0; k < num_joints_; ++k) {
        if (isHoming(k) && (joint < 0 || k == joint)) {
            fail(k, transition(k, why)->failure);
            return;
        }
    }
    sequence_ = -1;
}

void Homing::lock() noexcept {
    for (Joint &j : joints_) {
        j.isUnlockWanted = false;
    }
}

/// Reports the failure of a joint and stops all homing.
void Homing::fail(int joint, Failure why) noexcept {
    failed_joint_ = joint;
    failure_ = why;
    sequence_ = -1;
    for (int k = 0; k < num_joints_; ++k) {
        Joint &j = at(k);
        const Transition *row = isHoming(k) ? transition(k, event::MEMBER_FAILED) : nullptr;
        if (row != nullptr) {
            j.state = row->next;
            j.isIndexReleased = j.isIndexWanted && !j.parameters.isIndexWithoutReset;
            j.isIndexWanted = false;
            j.isStopping = true;
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

/// The matching row of the table; nullptr if nothing changes.
const Transition *Homing::transition(int joint, std::uint32_t events) const noexcept {
    const State state = at(joint).state;
    const std::uint32_t settings = settings_of(joint);
    for (const Transition &row : TRANSITIONS) {
        const bool isHere = row.state == UNDER_WAY ? state != State::IDLE : row.state == state;
        const bool areEvents = (row.events & events) == row.events;
        if (isHere && areEvents && (row.when & settings) == row.when && (row.unless & settings) == 0) {
            return &row;
        }
    }
    return nullptr;
}

void Homing::step(const JointInput *inputs, JointCommand *commands) noexcept {
    std::array<std::uint32_t, MAX_JOINTS> events{};
    for (int k = 0; k < num_joints_; ++k) {
        commands[k] = {};
        at(k).way += inputs[k].vel_cmd * period_s_;
        at(k).closed_way = inputs[k].isSwitchClosed ? at(k).way : at(k).closed_way;
        ++at(k).wait;
    }
    for (int k = 0; k < num_joints_; ++k) {
        events[static_cast<std::size_t>(k)] = isHoming(k) ? events_of(k, inputs) : 0;
    }
    for (int k = 0; k < num_joints_; ++k) {
        const Transition *row = isHoming(k) ? transition(k, events[static_cast<std::size_t>(k)]) : nullptr;
        if (row != nullptr && row->failure != Failure::NONE) {
            fail(k, row->failure);
        } else if (row != nullptr) {
            apply(k, *row, inputs, commands[k]);
        }
    }
    for (int k = 0; k < num_joints_; ++k) {
        Joint &j = at(k);
        if (j.isStopping) {
            commands[k] = {};
            commands[k].move = Move::STOP;
            commands[k].acceleration = j.team_acceleration;
            // This position is not the zero, but the encoder reset must not move the motor.
            commands[k].isSettingZero = j.isIndexReleased && !inputs[k].isIndexEnabled;
            commands[k].zero = j.parameters.offset;
            j.isStopping = false;
            j.isIndexReleased = false;
        } else if (j.state == State::LOCK || (j.state == State::IDLE && inputs[k].isAtRest)) {
            j.isUnlockWanted = false;
        }
    }
    advance_sequence();
}

std::uint32_t Homing::settings_of(int joint) const noexcept {
    const Parameters &p = at(joint).parameters;
    std::uint32_t out = 0;
    out |= p.search_vel != 0 ? setting::SEARCHING : 0U;
    out |= p.latch_vel != 0 ? setting::LATCHING : 0U;
    out |= p.isUsingIndex ? setting::INDEX : 0U;
    out |= (p.search_vel > 0) == (p.latch_vel > 0) ? setting::SAME_WAY : 0U;
    out |= p.isSharedSwitch ? setting::SHARED : 0U;
    out |= p.absolute_encoder != 0 ? setting::ABSOLUTE : 0U;
    out |= p.absolute_encoder == 2 ? setting::STAYING : 0U;
    out |= p.isLockingIndexer ? setting::LOCKING : 0U;
    out |= hasTeam(joint) ? setting::TEAM : 0U;
    return out;
}

std::uint32_t Homing::events_of(int joint, const JointInput *inputs) const noexcept {
    const Joint &j = at(joint);
    const JointInput &in = inputs[joint];
    std::uint32_t out = in.isSwitchClosed ? event::SWITCH_CLOSED : event::SWITCH_OPEN;
    out |= in.isAtRest ? event::AT_REST : 0U;
    // The pin was TRUE in the last cycle and is FALSE now. The encoder has cleared it and may have reset
    // itself.
    out |= j.isIndexWanted && !in.isIndexEnabled ? event::INDEX : 0U;
    out |= in.isUnlocked ? 0U : event::LOCKED;
    out |= j.wait * period_s_ > LONGEST_LOCKING_S ? event::OVERDUE : 0U;
    out |= isGroupReady(joint) ? event::GROUP_READY : 0U;
    return out | team_events(joint, inputs);
}

void Homing::set_place(int joint, const JointInput &in, JointCommand &out) noexcept {
    out.isShifting = true;
    out.shift = at(joint).parameters.offset - in.pos_fb;
}

void Homing::apply(int joint, const Transition &row, const JointInput *inputs, JointCommand &out) noexcept {
    Joint &j = at(joint);
    const JointInput &in = inputs[joint];
    switch (row.action) {
    case Action::NOTHING:
    case Action::UNLOCK: break;
    case Action::SET_PLACE:
    case Action::SET_PLACE_STOP: set_place(joint, in, out); break;
    case Action::TAKE_INDEX:
    case Action::TAKE_INDEX_STOP:
        j.isIndexWanted = false;
        if (j.parameters.isIndexWithoutReset) {
            set_place(joint, in, out);
        } else {
            out.isSettingZero = true;
            out.zero = j.parameters.offset;
        }
        break;
    case Action::SEARCH: go(joint, &Parameters::search_vel, 1, inputs, out); break;
    case Action::BACK_OFF: go(joint, &Parameters::search_vel, -1, inputs, out); break;
    case Action::LATCH: go(joint, &Parameters::latch_vel, 1, inputs, out); break;
    case Action::LATCH_ASK_INDEX:
        go(joint, &Parameters::latch_vel, 1, inputs, out);
        j.isIndexWanted = true;
        break;
    case Action::ASK_INDEX: j.isIndexWanted = true; break;
    case Action::GO_HOME: go_home(joint, inputs, out); break;
    case Action::STOP: break;
    }
    const bool isStopping = row.action == Action::STOP || row.action == Action::SET_PLACE_STOP ||
                            row.action == Action::TAKE_INDEX_STOP;
    if (isStopping) {
        out.move = Move::STOP;
        out.acceleration = j.team_acceleration;
    }
    j.state = row.next;
    j.wait = 0;
    j.isHomed = j.isHomed || row.isHomed;
}

}  // namespace mw::homing
