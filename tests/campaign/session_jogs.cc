// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of a session: by command, with a lease, by wheel.
#include <cmath>

#include <fmt/format.h>

#include "campaign/session.hh"

namespace mw::campaign {
namespace {

constexpr int LONGEST_MS = 120000;

}  // namespace

bool Session::begin_manual(bool isJoint) {
    if (!set_mode(messages::Mode::MANUAL) || ask(messages::SetTeleop{!isJoint}) != End::DONE) {
        fail("work", "the jogs' mode is not set with the machine at rest");
        return false;
    }
    settle(LONGEST_CALM_S);
    return true;
}

double Session::place_of(const Act &act, bool isJoint) const {
    return isJoint ? rig_->sample().joints[static_cast<std::size_t>(act.target)].pos_cmd
                   : rig_->sample().axes[act.target];
}

/// Gantry sides that have sagged align before any commanded motion.
bool Session::areSidesApart() const {
    const Design &d = plan_.design;
    const Sample s = rig_->sample();
    for (std::size_t j = 0; d.isTrivial && j < d.joints.size(); ++j) {
        const std::size_t first = d.coordinates.find(d.coordinates[j]);
        if (std::abs(s.joints[first].pos_cmd - s.joints[j].pos_cmd) > 1e-9) {
            return true;
        }
    }
    return false;
}

std::pair<double, double> Session::range_of(const Act &act, bool isJoint) const {
    if (isJoint) {
        const JointDesign &j = plan_.design.joints[static_cast<std::size_t>(act.target)];
        return {j.low, j.high};
    }
    for (const AxisDesign &a : plan_.design.axes) {
        if (a.axis == act.target) {
            return {a.low, a.high};
        }
    }
    return {-1e300, 1e300};
}

/// Renews a jog as long as it is wanted and then stays silent: the jog must end by itself.
void Session::keep_lease(const Act &act) {
    Extension &count = verdict_.extensions["leases"];
    ++count.ran;
    const bool isJoint = act.work == Work::JOG_JOINT;
    const int every = std::max(1, act.lease_ms / 3);
    for (int i = 0; i < act.length_ms && !isOver(); ++i) {
        if (i % every == 0 && !isStopped_) {
            post(messages::JogContinuous{isJoint, act.target, act.velocity, act.lease_ms, true});
        }
        step_troubles();
        cycle();
    }
    constexpr int ON_ITS_WAY = 10;
    for (int i = 0; i < act.lease_ms + ON_ITS_WAY && !isOver(); ++i) {
        step_troubles();
        cycle();
    }
    if (!isStopped_ && !isDisturbed_ && !isOver()) {
        ++count.judged;
        judge_.stop(Stop::ALONG_THE_PATH, 0);
    }
}

void Session::jog(const Act &act) {
    const bool isJoint = act.work == Work::JOG_JOINT;
    if (!begin_manual(isJoint)) {
        return;
    }
    const double from = place_of(act, isJoint);
    begin_troubles(act);
    judge_.allow(Leave::MOVE);
    const bool isIncrement = act.distance != 0;
    const client::Serial posted =
        isIncrement ? post(messages::JogIncrement{isJoint, act.target, std::abs(act.velocity), act.distance})
                    : post(messages::JogContinuous{isJoint, act.target, act.velocity, act.lease_ms, false});
    const End end = wait(posted, 5);
    if (act.lease_ms > 0) {
        keep_lease(act);
    } else {
        for (int i = 0; i < act.length_ms && !isOver(); ++i) {
            step_troubles();
            cycle();
        }
        if (!isIncrement) {
            ask(messages::JogStop{isJoint, act.target});
        }
    }
    for (int i = 0; i < LONGEST_MS && !isOver() && !(judge_.isAtRest() && rig_->isInPosition()); ++i) {
        step_troubles();
        cycle();
    }
    if (isStopped_ || isDisturbed_ || isOver() || !plan_.design.isTrivial) {
        return;
    }
    // A jog that would end outside a limit is rejected. The joint may have coasted outside the limits after
    // an e-stop.
    const auto [low, high] = range_of(act, isJoint);
    const double wanted = from + act.distance;
    const bool fits = wanted >= low && wanted <= high && from > low && from < high;
    if (end != End::DONE && fits) {
        fail("work", fmt::format("a jog from {:.6g} by {:.6g} is rejected", from, act.distance));
    } else if (isIncrement && end == End::DONE && std::abs(place_of(act, isJoint) - wanted) > 1e-6) {
        fail("work", fmt::format("a jog from {:.6g} by {:.6g} ends at {:.6g}", from, act.distance,
                                 place_of(act, isJoint)));
    }
}

/// Turns a wheel for some time; the operator releases it before he stops the machine.
void Session::turn(const Act &act) {
    const Turning &t = act.turning;
    Extension &count = verdict_.extensions[t.isVelocityMode ? "wheels that stop" : "wheels"];
    ++count.ran;
    if (!begin_manual(t.isJoint)) {
        return;
    }
    const double from = place_of(act, t.isJoint);
    const bool isLedFirst = !t.isJoint && areSidesApart();
    rig_->link_wheel(&t, act.target);
    constexpr double SLACK_S = 0.1;
    // With the fraction of the acceleration for the wheel.
    const double gently_s =
        judge_.time_to_brake() * (1 / t.accel_fraction - 1) + (t.accel_fraction < 1 ? SLACK_S : 0);
    const bool isShared = !t.isJoint && !plan_.design.isTrivial;
    judge_.stops_later_s = isShared ? gently_s : 0;
    for (int i = 0; i < 5 && !isOver(); ++i) {
        cycle();
    }
    begin_troubles(act);
    judge_.allow(Leave::MOVE);
    std::int64_t counts = 0;
    for (int i = 0; i < t.cycles && !isOver(); ++i) {
        if (i % t.pause == 0 && !isStopped_) {
            rig_->turn_wheel(t.counts_per_cycle);
            counts += t.counts_per_cycle;
        }
        step_troubles();
        cycle();
    }
    if (t.isVelocityMode && !isStopped_ && !isDisturbed_ && !isOver()) {
        // The joint stops when the wheel stops.
        judge_.stops_later_s = gently_s + SLACK_S;
        judge_.stop(Stop::ALONG_THE_PATH, 5);
    }
    for (int i = 0; i < LONGEST_MS && !isOver() && !(judge_.isAtRest() && rig_->isInPosition()); ++i) {
        step_troubles();
        cycle();
    }
    const auto [low, high] = range_of(act, t.isJoint);
    const double wanted = from + static_cast<double>(counts) * t.scale;
    const double at = place_of(act, t.isJoint);
    const bool fits = wanted >= low && wanted <= high && from > low && from < high;
    if (isStopped_ || isDisturbed_ || isOver() || !plan_.design.isTrivial || !fits) {
        return;
    }
    ++count.judged;
    const bool isBeyond = (at - wanted) * (wanted - from) > 1e-6;
    if (t.isVelocityMode ? isBeyond || (at == from && !isLedFirst) : std::abs(at - wanted) > 1e-6) {
        fail("work", fmt::format("a wheel turned from {:.6g} to {:.6g} has moved the joint to {:.6g}", from,
                                 wanted, at));
    }
}

}  // namespace mw::campaign
