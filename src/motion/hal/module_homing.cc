// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/hal/module_homing.hh"

#include <algorithm>
#include <cmath>

#include "hal/include/millwright_ext.h"
#include "motion/interface/homing_functions.hh"

namespace mw::motion {

namespace {

template <class Function>
void find_function(Function &function, const char *name) noexcept {
    function = reinterpret_cast<Function>(mw_ext_find_symbol(name));
}

std::size_t at(int joint) noexcept {
    return static_cast<std::size_t>(joint);
}

int flags_of(const homing::Parameters &p) noexcept {
    int flags = p.isIgnoringLimits ? HOME_IGNORE_LIMITS : 0;
    flags |= p.isUsingIndex ? HOME_USE_INDEX : 0;
    flags |= p.isSharedSwitch ? HOME_IS_SHARED : 0;
    flags |= p.isLockingIndexer ? HOME_UNLOCK_FIRST : 0;
    flags |= p.absolute_encoder != 0 ? HOME_ABSOLUTE_ENCODER | HOME_NO_REHOME : 0;
    flags |= p.absolute_encoder == 2 ? HOME_NO_FINAL_MOVE : 0;
    flags |= p.isIndexWithoutReset ? HOME_INDEX_NO_ENCODER_RESET : 0;
    return flags;
}

}  // namespace

ModuleHoming::Found ModuleHoming::find(const char *&missing) noexcept {
    int count = 0;
    missing = nullptr;
    for (const char *name : HOMING_FUNCTIONS) {
        const bool isThere = mw_ext_find_symbol(name) != nullptr;
        count += isThere ? 1 : 0;
        missing = isThere || missing != nullptr ? missing : name;
    }
    if (missing != nullptr) {
        return count == 0 ? Found::NONE : Found::SOME;
    }
    HomingFunctions &f = functions_;
    find_function(f.homeMotFunctions, "homeMotFunctions");
    find_function(f.homing_init, "homing_init");
    find_function(f.read_homing_in_pins, "read_homing_in_pins");
    find_function(f.write_homing_out_pins, "write_homing_out_pins");
    find_function(f.do_home_joint, "do_home_joint");
    find_function(f.do_cancel_homing, "do_cancel_homing");
    find_function(f.do_homing, "do_homing");
    find_function(f.set_unhomed, "set_unhomed");
    find_function(f.set_joint_homing_params, "set_joint_homing_params");
    find_function(f.update_joint_homing_params, "update_joint_homing_params");
    find_function(f.get_homing, "get_homing");
    find_function(f.get_homed, "get_homed");
    find_function(f.get_homing_is_active, "get_homing_is_active");
    find_function(f.get_index_enable, "get_index_enable");
    find_function(f.get_homing_at_index_search_wait, "get_homing_at_index_search_wait");
    return Found::ALL;
}

int ModuleHoming::hold(int comp_id) const noexcept {
    return mw_ext_use_module("do_homing", comp_id);
}

int ModuleHoming::start_module(int comp_id, double period_s, JointCounts counts, void (*on_unlock)(int, int),
                               int (*on_ask)(int)) noexcept {
    num_joints_ = counts.all;
    functions_.homeMotFunctions(on_unlock, on_ask);
    return functions_.homing_init(comp_id, period_s, counts.all, counts.extra, joints_.data());
}

void ModuleHoming::set_unlock(int joint, bool isWanted) noexcept {
    if (joint >= 0 && joint < num_joints_) {
        unlock_ = isWanted ? unlock_ | 1U << joint : unlock_ & ~(1U << joint);
    }
}

/// Parameters that may change while the machine runs have a separate function in the module.
void ModuleHoming::configure(int joint, const homing::Parameters &p) noexcept {
    homing::Parameters &known = parameters_[at(joint)];
    const bool isSame = known.search_vel == p.search_vel && known.latch_vel == p.latch_vel &&
                        known.final_vel == p.final_vel && known.isVolatile == p.isVolatile &&
                        flags_of(known) == flags_of(p);
    known = p;
    if ((configured_ >> joint & 1U) != 0 && isSame) {
        functions_.update_joint_homing_params(joint, p.offset, p.home, p.sequence);
        return;
    }
    configured_ |= 1U << joint;
    functions_.set_joint_homing_params(joint, p.offset, p.home, p.final_vel, p.search_vel, p.latch_vel,
                                       flags_of(p), p.sequence, p.isVolatile);
}

void ModuleHoming::start(int joint) noexcept {
    isCancelled_ = false;
    told_ = 0;
    begun_ = 0;
    functions_.do_home_joint(joint);
}

void ModuleHoming::abort(homing::event::Event, int) noexcept {
    isCancelled_ = true;
    if (isActive()) {
        functions_.do_cancel_homing(-1);
    }
}

void ModuleHoming::unhome(int joint) noexcept {
    functions_.set_unhomed(joint, EMCMOT_MOTION_FREE);
}

/// A module without failure codes reports only that homing failed, not why.
int ModuleHoming::take_failure(homing::Failure &why) noexcept {
    why = homing::Failure::NONE;
    return -1;
}

std::uint32_t ModuleHoming::take_clamped() noexcept {
    const std::uint32_t now = clamped_ & ~told_;
    told_ |= clamped_;
    clamped_ = 0;
    return now;
}

/// Command and feedback have different zeros, because the encoder has reset itself.
bool ModuleHoming::isAtIndex(int joint) const noexcept {
    return functions_.get_homing_at_index_search_wait(joint) && !functions_.get_index_enable(joint);
}

void ModuleHoming::show(int joint, const homing::JointInput &in) noexcept {
    emcmot_joint_t &j = joints_[at(joint)];
    const homing::Parameters &p = parameters_[at(joint)];
    const bool isDriven = (driven_ >> joint & 1U) != 0;
    j.pos_cmd = in.pos_cmd;
    j.coarse_pos = in.pos_cmd;
    j.vel_cmd = in.vel_cmd;
    j.pos_fb = in.pos_fb;
    j.motor_pos_fb = in.motor_pos_fb;
    j.motor_offset = in.motor_offset;
    j.backlash_filt = in.motor_pos_fb - in.motor_offset - in.pos_fb;
    j.motor_pos_cmd = in.pos_cmd + j.backlash_filt + in.motor_offset;
    j.max_pos_limit = p.high;
    j.min_pos_limit = p.low;
    j.vel_limit = in.max_velocity;
    j.acc_limit = in.max_acceleration;
    j.on_pos_limit = in.isOnPosLimit ? 1 : 0;
    j.on_neg_limit = in.isOnNegLimit ? 1 : 0;
    j.free_tp.curr_pos = in.pos_cmd;
    j.free_tp.curr_vel = in.vel_cmd;
    j.free_tp.active = in.isAtRest ? 0 : 1;
    if (!isDriven) {
        j.free_tp.pos_cmd = in.pos_cmd;
        j.free_tp.max_vel = in.max_velocity;
        j.free_tp.max_acc = in.max_acceleration;
        j.free_tp.enable = 0;
    }
}

void ModuleHoming::step(const homing::JointInput *inputs, homing::JointCommand *commands) noexcept {
    std::uint32_t at_index = 0;
    std::uint32_t homing = 0;
    unlocked_ = 0;
    for (int j = 0; j < num_joints_; ++j) {
        commands[j] = {};
        unlocked_ |= inputs[j].isUnlocked ? 1U << j : 0U;
        at_index |= functions_.get_homing_at_index_search_wait(j) ? 1U << j : 0U;
        homing |= isHoming(j) ? 1U << j : 0U;
        show(j, inputs[j]);
    }
    functions_.do_homing();
    for (int j = 0; j < num_joints_; ++j) {
        const bool isDriven = (driven_ >> j & 1U) != 0;
        const bool isOurs = isCancelled_ || (!isHoming(j) && (homing >> j & 1U) == 0);
        if (isOurs) {
            commands[j].move = isDriven ? homing::Move::STOP : homing::Move::NONE;
            driven_ &= ~(1U << j);
            continue;
        }
        if ((begun_ >> j & 1U) == 0) {
            begun_ |= 1U << j;
            origin_[at(j)] = inputs[j].pos_cmd;
        }
        take_offset(j, inputs[j], (at_index >> j & 1U) != 0, commands[j]);
        take_move(j, inputs[j], commands[j]);
    }
}

/// A new offset: the module has changed the joint's position. This does not move the motor.
void ModuleHoming::take_offset(int joint, const homing::JointInput &in, bool wasAtIndex,
                               homing::JointCommand &out) noexcept {
    const double offset = joints_[at(joint)].motor_offset;
    if (wasAtIndex && !parameters_[at(joint)].isIndexWithoutReset &&
        !functions_.get_homing_at_index_search_wait(joint) && isHoming(joint)) {
        out.isSettingZero = true;
        out.zero = -offset;
        begun_ &= ~(1U << joint);  // the new position is valid from the next cycle
    } else if (offset != in.motor_offset) {
        out.isShifting = true;
        out.shift = in.motor_offset - offset;
        origin_[at(joint)] += out.shift;
    }
}

void ModuleHoming::clamp(int joint) noexcept {
    clamped_ |= 1U << joint;
}

void ModuleHoming::take_move(int joint, const homing::JointInput &in, homing::JointCommand &out) noexcept {
    const simple_tp_t &tp = joints_[at(joint)].free_tp;
    const homing::Parameters &p = parameters_[at(joint)];
    const std::uint32_t bit = 1U << joint;
    if (tp.enable == 0 || tp.max_vel <= 0 || !isHoming(joint)) {
        out.move = homing::Move::STOP;  // no effect on a stopped joint; the next command replaces it
        driven_ &= ~bit;
        return;
    }
    driven_ |= bit;
    const double here = in.pos_cmd + out.shift;
    const double origin = (begun_ & bit) != 0 ? origin_[at(joint)] : here;
    const double low = isHomed(joint) ? std::min(p.low, here) : origin - p.travel;
    const double high = isHomed(joint) ? std::max(p.high, here) : origin + p.travel;
    out.move = homing::Move::TO;
    out.value = std::isnan(tp.pos_cmd) ? tp.pos_cmd : std::clamp(tp.pos_cmd, low, high);
    out.velocity = std::min(tp.max_vel, in.max_velocity);
    out.acceleration = tp.max_acc > 0 ? std::min(tp.max_acc, in.max_acceleration) : 0.0;
    if (std::isnan(tp.max_vel) || std::isnan(tp.max_acc)) {
        out.velocity = NAN;
    }
    if (out.value != tp.pos_cmd || tp.max_vel > in.max_velocity || tp.max_acc > in.max_acceleration) {
        clamp(joint);
    }
}

}  // namespace mw::motion
