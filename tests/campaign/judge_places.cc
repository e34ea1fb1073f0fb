// SPDX-License-Identifier: GPL-2.0-or-later
// Checks that slides are at the reported joint positions and do not move at standstill.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "campaign/judge.hh"

namespace mw::campaign {
namespace {

constexpr double HELD_ROUNDING = 2e-6;  ///< at standstill [units]
/// Travel of a motion that has begun together with the stop [units].
constexpr double WITH_THE_STOP = 1e-3;

/// Accuracy of the slide position after homing.
double found_within(const JointDesign &d, double period_s) {
    const bool hasIndex = d.home_kind == HomeKind::SWITCH_AND_INDEX;
    const bool hasSwitch = d.home_kind == HomeKind::SWITCH;
    const double latched = hasSwitch ? std::abs(d.latch) * (2 * period_s + d.bounce_s) + d.hysteresis : 0;
    return latched + 3 / d.counts_per_unit + 1e-6 + (hasIndex ? 0.01 : 0);
}

}  // namespace

/// A stopped axis stays at its position, except rounding, until a motion is commanded. With a jerk limit a
/// command that arrived with the stop is too slow to see at first, and backlash is compensated where it
/// reverses.
void Judge::check_stale(const Sample &s, bool wasAtRest) {
    const bool wasHeld = held_cycles_ > 0;
    const bool isHeld = !allowed_.isMotion && restless_ == 0 && (wasAtRest || wasHeld);
    held_cycles_ = isHeld ? held_cycles_ + 1 : 0;
    const double rise_s = design_.rise_s();
    const int settling = rise_s > 0 ? static_cast<int>((rise_s + time_to_correct()) / period_) : 0;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointDesign &d = design_.joints[j];
        const JointSample &q = s.joints[j];
        const JointSample &before = last_.joints[j];
        const bool isKept = isHeld && wasHeld && q.isAmpOn && before.isAmpOn && held_cycles_ != settling + 1;
        const double place = q.motor_place();
        const double held = isKept ? joints_[j].held : isHeld ? before.motor_place() : place;
        joints_[j].held = q.isAmpOn && before.isAmpOn ? held : place;
        const double late_part =
            held_cycles_ <= settling ? WITH_THE_STOP + std::max(d.backlash, d.play) : 0.0;
        if (isHeld && q.isAmpOn && before.isAmpOn && std::abs(place - held) > HELD_ROUNDING + late_part) {
            fail("stale", fmt::format("joint {} moves without a command since the last stop", j));
        }
    }
}

/// The reported position of a homed joint is its true position.
void Judge::check_homes(const Sample &s) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        JointJudge &judge = joints_[j];
        const JointDesign &d = design_.joints[j];
        const bool isNew = q.isHomed && !judge.wasHomed;
        judge.wasHomed = q.isHomed;
        if (isNew) {
            judge.reference = d.home_kind == HomeKind::IMMEDIATE ? q.pos_fb - q.position : 0;
        }
        if (!q.isHomed || !q.isTruthKnown || !std::isfinite(q.motor_fb)) {
            continue;
        }
        const double off = q.pos_fb - q.position - judge.reference;
        // In motion, corrections may be late and the backlash may be on either side.
        const double allowed = found_within(d, period_) + 2 * d.play + 2 * d.screw_error;
        if (!(std::abs(off) <= allowed)) {
            fail("homed", fmt::format("joint {} says {:.6g} and is at {:.6g}", j, q.pos_fb,
                                      q.position + judge.reference));
        }
    }
}

/// At standstill a slide is at its commanded position: backlash and screw errors are corrected.
void Judge::check_places(const Sample &s) {
    constexpr int RESTED = 60;           // the drive has settled
    constexpr double DRIVE = 3e-3;       // deviation that friction causes
    constexpr double OVERSHOOT = 0.012;  // backlash of the motor, which moves the slide in one direction only
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        JointJudge &judge = joints_[j];
        const JointDesign &d = design_.joints[j];
        const bool isKnown =
            q.isAmpOn && last_.joints[j].isAmpOn && q.isHomed && q.isTruthKnown && !q.isHoming;
        judge.travel = isKnown ? judge.travel + std::abs(q.pos_cmd - last_.joints[j].pos_cmd) : 0;
        judge.isPlaceKnown = judge.isPlaceKnown && q.isHomed && q.isTruthKnown;
        // Before a travel longer than the backlash, the side of the backlash is unknown.
        const bool isJudged =
            d.isCorrected() && standing_ == RESTED && judge.travel > 1 + 4 * d.play && d.isInTable(q.pos_cmd);
        if (!isJudged) {
            continue;
        }
        const double off = q.position - q.pos_cmd;
        judge.place = judge.isPlaceKnown ? judge.place : off;
        judge.isPlaceKnown = true;
        ++judged_[d.screw_type >= 0 ? "screw" : "backlash"];
        const double allowed = DRIVE + 3 / d.counts_per_unit + (d.play > 0 ? OVERSHOOT : 0);
        if (std::abs(off - judge.place) > allowed) {
            fail("place",
                 fmt::format("joint {} is {:.6g} off, and was {:.6g} off before", j, off, judge.place));
        }
        // If the switch closes soon after a reversal, the backlash is only partly compensated.
        const double late = d.play + (design_.isJerkLimited ? d.screw_error : 0);
        const bool isMeasured = d.home_kind != HomeKind::IMMEDIATE;
        if (isMeasured && std::abs(off) > allowed + late + found_within(d, period_)) {
            fail("place", fmt::format("joint {} is {:.6g} off its homed position", j, off));
        }
    }
}

/// In the next cycle that reads a pin, at most two cycles of braking are left.
bool Judge::mayBeAtRest() const {
    constexpr double CYCLES = 2;
    bool isSlow = true;
    for (std::size_t j = 0; j < velocity_.size(); ++j) {
        isSlow = isSlow && std::abs(velocity_[j]) <= CYCLES * design_.joints[j].acceleration * period_;
    }
    // The backlash correction may still move while the path is stopped.
    const std::vector<geometry::Pose> &path = stop_.path.axes;
    bool isPathSlow = last_.areAxesKnown && path.size() > 1;
    for (const AxisDesign &a : design_.axes) {
        isPathSlow = isPathSlow && std::abs(path.back()[a.axis] - path[path.size() - 2][a.axis]) <=
                                       CYCLES * a.acceleration * period_ * period_;
    }
    return standing_ > 0 || isSlow || isPathSlow;
}

}  // namespace mw::campaign
