// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/offsets/external_offsets.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::motion {

namespace {

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Range within which it can stop.
JogRange reach_of(const ExternalOffset &offset) noexcept {
    JogRange out{offset.next, offset.next};
    offset.planner.add_reach(out.low, out.high);
    return out;
}

/// Converts counts since the last cycle to a distance. A value that is not a number has no effect.
void take_counts(ExternalOffset &offset, const OffsetInput &pins, bool isHonoured) noexcept {
    // Unsigned difference: counters overflow.
    const auto turned = static_cast<std::int32_t>(static_cast<std::uint32_t>(pins.counts) -
                                                  static_cast<std::uint32_t>(offset.counts));
    offset.counts = pins.counts;
    const double request = offset.request + turned * pins.scale;
    if (isHonoured && pins.isEnabled && std::isfinite(request)) {
        offset.request = request;
    }
    if (isHonoured && pins.isClearing) {
        offset.request = 0;
    }
}

/// `to` limited by the soft limits. An offset outside them moves no further out.
double allowed(const ExternalOffset &offset, double to, const JogRange &available) noexcept {
    const double rest = offset.planner.rest();
    return std::clamp(to, std::min(available.low, rest), std::max(available.high, rest));
}

JogRange both(const JogRange &a, const JogRange &b) noexcept {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

}  // namespace

/// Range for this axis within the soft limits of shared joints, next to the program and other offsets.
JogRange ExternalOffsets::range_in_joints(const OffsetInputs &in, PoseRange others, int axis) const noexcept {
    JogRange available{-UNBOUNDED, UNBOUNDED};
    others.low[axis] = others.high[axis] = 0;
    const JointRange taken = shared_.within(others);
    for (std::uint32_t left = shared_.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        const double k = shared_.slope[j][axis];
        if (k != 0) {
            const double low = (in.limits.joints.low[j] - in.programmed.joints.low[j] - taken.low[j]) / k;
            const double high = (in.limits.joints.high[j] - in.programmed.joints.high[j] - taken.high[j]) / k;
            available = both(available, k > 0 ? JogRange{low, high} : JogRange{high, low});
        }
    }
    return available;
}

void ExternalOffsets::step(const OffsetInputs &in) noexcept {
    limited_ = false;
    const bool isShared = shared_.joints != 0;
    PoseRange all = isShared ? range() : PoseRange{};
    for (int i = 0; i < MAX_AXES; ++i) {
        if (!hasOffset(i)) {
            continue;
        }
        ExternalOffset &offset = axis_[at(i)];
        if ((added_ >> i & 1U) != 0) [[unlikely]] {
            offset.counts = in.pins[at(i)].counts;
        }
        take_counts(offset, in.pins[at(i)], in.isHonoured);
        JogRange available{in.limits.low[i] - in.programmed.axes.low[i],
                           in.limits.high[i] - in.programmed.axes.high[i]};
        available = isShared ? both(available, range_in_joints(in, all, i)) : available;
        trajectory::AxisMotion &p = offset.planner;
        if (in.isHonoured) {
            const MotionLimits &most = in.limits.offset[at(i)];
            if (most.velocity > 0) {
                p.max_velocity = most.velocity;
                p.max_acceleration = most.acceleration;
                p.max_jerk = most.jerk;
            }
            p.target = allowed(offset, offset.next, available);
            offset.next = allowed(offset, offset.request, available);
            offset.isLimited = offset.next != offset.request;
        }
        if (isShared) {
            const JogRange reach = reach_of(offset);
            all.low[i] = reach.low;
            all.high[i] = reach.high;
        }
        p.step(in.period_s);
        pose_[i] = p.position;
        limited_ = limited_ || offset.isLimited;
    }
    added_ = 0;
}

const TravelRange &ExternalOffsets::extend_travelled(const geometry::Pose &pose, bool isNew) noexcept {
    const TravelRange here{{pose, pose}, shared_.at(pose)};
    if (isNew) {
        travelled_ = here;
    }
    travelled_.include(here);
    return travelled_;
}

void ExternalOffsets::configure(const FoldedLimits &limits, const AxisMap &map) noexcept {
    const std::uint32_t had = axes_;
    axes_ = 0;
    for (int i = 0; i < MAX_AXES; ++i) {
        // An existing offset remains, also if the axis may no longer have one.
        const bool isThere = pose_[i] != 0.0 || !axis_[at(i)].planner.isAtRest();
        axes_ |= limits.offset[at(i)].velocity > 0 || isThere ? 1U << i : 0U;
    }
    added_ = (added_ | ~had) & axes_;
    shared_ = shared_joints(map.linear, axes_);
    limited_ = limited_ && axes_ != 0;
    if (!limits.homed.areAll) {
        for (ExternalOffset &offset : axis_) {
            const std::int32_t counts = offset.counts;
            offset = {};
            offset.counts = counts;
        }
        pose_ = {};
        limited_ = false;
    }
}

void ExternalOffsets::start_at_zero(const Inputs &in) noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        axis_[at(i)] = {};
        axis_[at(i)].counts = in.axis_offset[at(i)].counts;
    }
    added_ = 0;
    pose_ = {};
    limited_ = false;
}

void ExternalOffsets::stop() noexcept {
    for (ExternalOffset &offset : axis_) {
        offset.planner.stop();
        offset.next = offset.planner.target;
    }
}

void ExternalOffsets::stop_at_once() noexcept {
    for (ExternalOffset &offset : axis_) {
        offset.planner.reset(offset.planner.position);
        offset.next = offset.planner.position;
    }
}

bool ExternalOffsets::isAtRest() const noexcept {
    return std::all_of(axis_.begin(), axis_.end(),
                       [](const ExternalOffset &offset) { return offset.planner.isAtRest(); });
}

bool ExternalOffsets::isMotionRequested(const std::array<OffsetInput, MAX_AXES> &pins) const noexcept {
    std::uint32_t asked = 0;
    for (std::size_t i = 0; i < pins.size(); ++i) {
        const ExternalOffset &offset = axis_[i];
        const bool isAsked = pins[i].isEnabled && pins[i].counts != offset.counts;
        asked |= isAsked || offset.request != offset.planner.position ? 1U << i : 0U;
    }
    return (asked & axes_ & ~added_) != 0;
}

PoseRange ExternalOffsets::range() const noexcept {
    PoseRange out;
    for (int i = 0; i < MAX_AXES; ++i) {
        const JogRange reach = reach_of(axis_[at(i)]);
        out.low[i] = reach.low;
        out.high[i] = reach.high;
    }
    return out;
}

geometry::Pose ExternalOffsets::remove_from(const geometry::Pose &pose) const noexcept {
    if (axes_ != 0) [[unlikely]] {
        return pose - pose_;
    }
    return pose;
}

void ExternalOffsets::narrow(JogRange &jog, int axis) const noexcept {
    if (hasOffset(axis)) {
        const JogRange reach = reach_of(axis_[at(axis)]);
        jog.low -= reach.low;
        jog.high -= reach.high;
    }
}

void ExternalOffsets::remove_from(std::array<double, MAX_JOINTS> &joints,
                                  trajectory::JointLimits &limits) const noexcept {
    const JointRange here = shared_.at(pose_);
    const JointRange reach = shared_.within(range());
    for (std::uint32_t left = shared_.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        joints[j] -= here.low[j];
        limits.low[j] -= reach.low[j];
        limits.high[j] -= reach.high[j];
    }
}

void ExternalOffsets::fill(Outputs &out) const noexcept {
    out.areOffsetsQuiet = axes_ == 0;
    out.touched |= part_range(status_part::AXES, 1);
    out.isOffsetActive = false;
    out.isOffsetLimited = limited_;
    for (std::uint32_t left = out.axes; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        out.status.axis[at(i)].external_offset = pose_[i];
        out.axis[at(i)].offset = pose_[i];
        out.axis[at(i)].offset_request = axis_[at(i)].request;
        out.isOffsetActive = out.isOffsetActive || pose_[i] != 0.0;
    }
}

}  // namespace mw::motion
