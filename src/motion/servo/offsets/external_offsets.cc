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

bool hasOffset(const ExternalOffsets &offsets, int axis) noexcept {
    return (offsets.axes >> axis & 1U) != 0;
}

/// Range that it can reach until it stops.
JogRange reach_of(const ExternalOffset &offset) noexcept {
    JogRange out{offset.next, offset.next};
    offset.planner.add_reach(out.low, out.high);
    return out;
}

/// Turns counts since the last cycle into a distance; a value that is no number has no effect.
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

/// `to`, limited by the soft limits; an offset outside them does not move further out.
double allowed(const ExternalOffset &offset, double to, const JogRange &room) noexcept {
    const double rest = offset.planner.rest();
    return std::clamp(to, std::min(room.low, rest), std::max(room.high, rest));
}

JogRange both(const JogRange &a, const JogRange &b) noexcept {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

/// Range for this axis within the soft limits of shared joints, besides the program and the other offsets.
JogRange room_of_joints(const ExternalOffsets &offsets, const OffsetInputs &in, PoseRange others,
                        int axis) noexcept {
    JogRange room{-UNBOUNDED, UNBOUNDED};
    others.low[axis] = others.high[axis] = 0;
    const JointRange taken = offsets.shared.within(others);
    for (std::uint32_t left = offsets.shared.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        const double k = offsets.shared.slope[j][axis];
        if (k != 0) {
            const double low = (in.limits.joints.low[j] - in.programmed.joints.low[j] - taken.low[j]) / k;
            const double high = (in.limits.joints.high[j] - in.programmed.joints.high[j] - taken.high[j]) / k;
            room = both(room, k > 0 ? JogRange{low, high} : JogRange{high, low});
        }
    }
    return room;
}

}  // namespace

void step(ExternalOffsets &offsets, const OffsetInputs &in) noexcept {
    offsets.isLimited = false;
    const bool isShared = offsets.shared.joints != 0;
    PoseRange all = isShared ? range(offsets) : PoseRange{};
    for (int i = 0; i < MAX_AXES; ++i) {
        if (!hasOffset(offsets, i)) {
            continue;
        }
        ExternalOffset &offset = offsets.axis[at(i)];
        if ((offsets.added >> i & 1U) != 0) [[unlikely]] {
            offset.counts = in.pins[at(i)].counts;
        }
        take_counts(offset, in.pins[at(i)], in.isHonoured);
        JogRange room{in.limits.low[i] - in.programmed.axes.low[i],
                      in.limits.high[i] - in.programmed.axes.high[i]};
        room = isShared ? both(room, room_of_joints(offsets, in, all, i)) : room;
        trajectory::AxisMotion &p = offset.planner;
        if (in.isHonoured) {
            const JogLimits &most = in.limits.offset[at(i)];
            if (most.velocity > 0) {
                p.max_velocity = most.velocity;
                p.max_acceleration = most.acceleration;
                p.max_jerk = most.jerk;
            }
            p.target = allowed(offset, offset.next, room);
            offset.next = allowed(offset, offset.request, room);
            offset.isLimited = offset.next != offset.request;
        }
        if (isShared) {
            const JogRange reach = reach_of(offset);
            all.low[i] = reach.low;
            all.high[i] = reach.high;
        }
        p.step(in.period_s);
        offsets.pose[i] = p.position;
        offsets.isLimited = offsets.isLimited || offset.isLimited;
    }
    offsets.added = 0;
}

void configure(ExternalOffsets &offsets, const FoldedLimits &limits, const AxisMap &map) noexcept {
    const std::uint32_t had = offsets.axes;
    offsets.axes = 0;
    for (int i = 0; i < MAX_AXES; ++i) {
        // An existing offset stays, also if no offset is possible any more.
        const bool isThere = offsets.pose[i] != 0.0 || !offsets.axis[at(i)].planner.isAtRest();
        offsets.axes |= limits.offset[at(i)].velocity > 0 || isThere ? 1U << i : 0U;
    }
    offsets.added = (offsets.added | ~had) & offsets.axes;
    offsets.shared = shared_joints(map.linear, offsets.axes);
    offsets.isLimited = offsets.isLimited && offsets.axes != 0;
    if (!limits.homed.areAll) {
        for (ExternalOffset &offset : offsets.axis) {
            const std::int32_t counts = offset.counts;
            offset = {};
            offset.counts = counts;
        }
        offsets.pose = {};
        offsets.isLimited = false;
    }
}

void start_at_zero(ExternalOffsets &offsets, const Inputs &in) noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        offsets.axis[at(i)] = {};
        offsets.axis[at(i)].counts = in.axis_offset[at(i)].counts;
    }
    offsets.added = 0;
    offsets.pose = {};
    offsets.isLimited = false;
}

void stop(ExternalOffsets &offsets) noexcept {
    for (ExternalOffset &offset : offsets.axis) {
        offset.planner.stop();
        offset.next = offset.planner.target;
    }
}

void stop_at_once(ExternalOffsets &offsets) noexcept {
    for (ExternalOffset &offset : offsets.axis) {
        offset.planner.reset(offset.planner.position);
        offset.next = offset.planner.position;
    }
}

bool areAtRest(const ExternalOffsets &offsets) noexcept {
    return std::all_of(offsets.axis.begin(), offsets.axis.end(),
                       [](const ExternalOffset &offset) { return offset.planner.isAtRest(); });
}

bool areAsked(const ExternalOffsets &offsets, const std::array<OffsetInput, MAX_AXES> &pins) noexcept {
    std::uint32_t asked = 0;
    for (std::size_t i = 0; i < pins.size(); ++i) {
        const ExternalOffset &offset = offsets.axis[i];
        const bool isAsked = pins[i].isEnabled && pins[i].counts != offset.counts;
        asked |= isAsked || offset.request != offset.planner.position ? 1U << i : 0U;
    }
    return (asked & offsets.axes & ~offsets.added) != 0;
}

PoseRange range(const ExternalOffsets &offsets) noexcept {
    PoseRange out;
    for (int i = 0; i < MAX_AXES; ++i) {
        const JogRange reach = reach_of(offsets.axis[at(i)]);
        out.low[i] = reach.low;
        out.high[i] = reach.high;
    }
    return out;
}

geometry::Pose without(const ExternalOffsets &offsets, const geometry::Pose &pose) noexcept {
    if (offsets.axes != 0) [[unlikely]] {
        return pose - offsets.pose;
    }
    return pose;
}

void narrow(JogRange &jog, const ExternalOffsets &offsets, int axis) noexcept {
    if (hasOffset(offsets, axis)) {
        const JogRange reach = reach_of(offsets.axis[at(axis)]);
        jog.low -= reach.low;
        jog.high -= reach.high;
    }
}

void take_off(const ExternalOffsets &offsets, std::array<double, MAX_JOINTS> &joints,
              trajectory::JointLimits &limits) noexcept {
    const JointRange here = offsets.shared.at(offsets.pose);
    const JointRange reach = offsets.shared.within(range(offsets));
    for (std::uint32_t left = offsets.shared.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        joints[j] -= here.low[j];
        limits.low[j] -= reach.low[j];
        limits.high[j] -= reach.high[j];
    }
}

void fill(const ExternalOffsets &offsets, Outputs &out) noexcept {
    out.areOffsetsQuiet = offsets.axes == 0;
    out.touched |= part_range(status_part::AXES, 1);
    out.isOffsetActive = false;
    out.isOffsetLimited = offsets.isLimited;
    for (std::uint32_t left = out.axes; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        out.status.axis[at(i)].external_offset = offsets.pose[i];
        out.axis[at(i)].offset = offsets.pose[i];
        out.axis[at(i)].offset_request = offsets.axis[at(i)].request;
        out.isOffsetActive = out.isOffsetActive || offsets.pose[i] != 0.0;
    }
}

}  // namespace mw::motion
