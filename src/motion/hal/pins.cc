// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/hal/pins.hh"

#include <bit>
#include <cstring>

#include "hal/include/millwright_ext.h"

namespace mw::motion {

namespace {

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Creates one set of pins for each number below `count` that is in `mask`; stops at the first failure.
template <class Set, std::size_t SIZE>
int declare_each(Set (&sets)[SIZE], int comp_id, int count, unsigned mask = ~0U) noexcept {
    int status = 0;
    for (int i = 0; i < count && status == 0; ++i) {
        const bool isWanted = mask == ~0U || (mask >> i & 1U) != 0;
        status = isWanted ? sets[i].declare(comp_id, i) : 0;
    }
    return status;
}

/// Copies `part` to the last values; returns true if they differ. Called for every joint in every cycle.
template <std::size_t WORDS>
bool replace(std::array<std::uint64_t, WORDS> &shown, const void *part) noexcept {
    const auto *from = static_cast<const unsigned char *>(part);
    std::uint64_t other = 0;
#pragma GCC unroll 8
    for (std::size_t i = 0; i < WORDS; ++i) {
        std::uint64_t word = 0;
        std::memcpy(&word, from + 8 * i, 8);
        other |= word ^ shown[i];
    }
    if (other == 0) {
        return false;
    }
    std::memcpy(shown.data(), from, sizeof shown);
    return true;
}

}  // namespace

int MotionPins::declare(int comp_id, const PinCounts &wanted) noexcept {
    counts_ = wanted;
    links_ = mw_ext_links();
    lost_positions_ = mw_ext_lost_positions();
    int status = motion_.declare(comp_id);
    status = status == 0 && counts_.isSwitchable ? switchable_.declare(comp_id) : status;
    status = status == 0 ? declare_each(digital_, comp_id, counts_.digital) : status;
    status = status == 0 ? declare_each(analog_, comp_id, counts_.analog) : status;
    status = status == 0 ? declare_each(misc_error_, comp_id, counts_.misc_errors) : status;
    status = status == 0 ? declare_each(joint_, comp_id, counts_.joints) : status;
    status = status == 0 ? declare_each(seldom_joint_, comp_id, counts_.joints) : status;
    if (!counts_.areHomingPinsMade) {
        status = status == 0 ? declare_each(homing_, comp_id, counts_.joints) : status;
        status = status == 0 ? declare_each(seldom_homing_, comp_id, counts_.joints) : status;
    }
    const auto unlocked = static_cast<unsigned>(counts_.unlock_mask);
    status = status == 0 && unlocked != 0 ? declare_each(unlock_, comp_id, counts_.joints, unlocked) : status;
    const unsigned extra = ((1U << counts_.extra_joints) - 1U) << (counts_.joints - counts_.extra_joints);
    status = status == 0 ? declare_each(posthome_, comp_id, counts_.joints, extra) : status;
    status = status == 0 ? declare_each(axis_, comp_id, MAX_AXES) : status;
    status = status == 0 ? declare_each(seldom_axis_, comp_id, MAX_AXES) : status;
    return status == 0 ? declare_each(spindle_, comp_id, counts_.spindles) : status;
}

/// Pins that are rarely present are read in separate functions, because each taken branch costs one
/// misprediction per cycle.
void MotionPins::read(Inputs &in) noexcept {
    in.time_ns = rtapi_get_time();
    in.lost_positions = __atomic_load_n(lost_positions_, __ATOMIC_RELAXED);
    in.digital_in = 0;
    in.misc_errors = 0;
    motion_.read(in);
    if (counts_.isSwitchable) [[unlikely]] {
        switchable_.read(in);
    }
    for (int i = 0; i < counts_.digital; ++i) {
        ChannelIn channel{in, i};
        digital_[i].read(channel);
    }
    for (int i = 0; i < counts_.misc_errors; ++i) {
        ChannelIn channel{in, i};
        misc_error_[i].read(channel);
    }
    for (int i = 0; i < counts_.analog; ++i) {
        ChannelIn channel{in, i};
        analog_[i].read(channel);
    }
    for (int j = 0; j < counts_.joints; ++j) {
        joint_[j].read(in.joint[at(j)]);
        if (!counts_.areHomingPinsMade) [[likely]] {
            homing_[j].read(in.joint[at(j)]);
        }
        if (isUnlockable(j)) [[unlikely]] {
            unlock_[j].read(in.joint[at(j)]);
        }
        if (j >= counts_.joints - counts_.extra_joints) [[unlikely]] {
            posthome_[j].read(in.joint[at(j)]);
        }
    }
    for (std::uint32_t left = axes_; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        AxisInputs axis{in.axis_wheel[at(i)], in.axis_offset[at(i)]};
        axis_[i].read(axis);
    }
    for (int n = 0; n < counts_.spindles; ++n) {
        spindle_[n].read(in.spindle[at(n)]);
    }
}

/// True if the value of a pin may have another address than in the last cycle.
bool MotionPins::areLinksOther() noexcept {
    const std::uint32_t links = __atomic_load_n(links_, __ATOMIC_ACQUIRE);
    const bool areOther = links != last_links_ || axes_ != last_axes_;
    last_links_ = links;
    last_axes_ = axes_;
    return areOther;
}

void MotionPins::write(const Outputs &out) noexcept {
    const Status &s = out.status;
    motion_.write(MotionView{out, s.time_ns - last_time_ns_});
    last_time_ns_ = s.time_ns;
    for (int i = 0; i < counts_.digital; ++i) {
        digital_[i].write(ChannelOut{s, i});
    }
    for (int i = 0; i < counts_.analog; ++i) {
        analog_[i].write(ChannelOut{s, i});
    }
    axes_ = out.axes;
    const bool areAllDue = areLinksOther();
    for (int j = 0; j < counts_.joints; ++j) {
        const JointView view{s.joint[at(j)], out.joint[at(j)]};
        joint_[j].write(view);
        if (!counts_.areHomingPinsMade) [[likely]] {
            homing_[j].write(view);
        }
        if (isUnlockable(j)) [[unlikely]] {
            unlock_[j].write(view);
        }
        const bool areFlagsOther =
            replace(flags_shown_[at(j)], reinterpret_cast<const unsigned char *>(&view.s) + FLAGS);
        const bool areOthers =
            replace(joint_shown_[at(j)], static_cast<const SeldomJointOutputs *>(&view.o)) || areFlagsOther;
        if (areOthers || areAllDue) [[unlikely]] {
            seldom_joint_[j].write(view);
            if (!counts_.areHomingPinsMade) {
                seldom_homing_[j].write(view);
            }
        }
    }
    for (std::uint32_t left = axes_; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        const AxisOutputs &axis = out.axis[at(i)];
        axis_[i].write(axis);
        const bool isOther = replace(axis_shown_[at(i)], static_cast<const SeldomAxisOutputs *>(&axis));
        if (isOther || areAllDue) [[unlikely]] {
            seldom_axis_[i].write(axis);
        }
    }
    for (int n = 0; n < counts_.spindles; ++n) {
        spindle_[n].write(SpindleView{s.spindle[at(n)], out.spindle[at(n)]});
    }
}

}  // namespace mw::motion
