// SPDX-License-Identifier: GPL-2.0-or-later
// The expected results of a program that has probed.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "campaign/session.hh"

namespace mw::campaign {
namespace {

constexpr double PERIOD_S = 1e-3;

/// Maximum overtravel of a probe at this speed after the contact.
double way_to_stop(const Design &design, const JointDesign &joint, int axis, double speed) {
    constexpr double FACTOR = 2.2, SLACK_S = 0.02;  // as for any stop
    double a = std::min(joint.acceleration, design.acceleration);
    for (const AxisDesign &one : design.axes) {
        a = one.axis == axis ? std::min(a, one.acceleration_of_path()) : a;
    }
    // All axes of a path share one mean filter, that of the slowest axis.
    const double stop_s = speed / a + 2.5 * design.rise_s();
    constexpr double DRIVE = 0.03;
    return speed * (FACTOR * stop_s + SLACK_S) + DRIVE;
}

/// The result of a probing move: found or not, and the position.
struct Found {
    bool isFound = false;
    double place = 0;
};

std::vector<Found> read_found(const std::vector<std::string> &told) {
    std::vector<Found> all;
    for (const std::string &line : told) {
        double hit = 0, place = 0;
        if (std::sscanf(line.c_str(), "probe %lf %lf", &hit, &place) == 2) {
            all.push_back({hit != 0, place});
        }
    }
    return all;
}

}  // namespace

/// An offset moves the probe: it may miss the wall, and the next move begins without contact. In reverse run
/// (M52 of an aborted program is still active) it may touch the wall through which it came.
bool Session::isProbeMoved(const Act &act) const {
    const bool isGoneBack = isReversed_ && rig_->client().status().overrides.isAdaptiveFeedEnabled;
    return act.work == Work::PROBE && (hasTrouble(act, Upset::OFFSET) || isGoneBack);
}

void Session::check_probing(const Act &act, End end) {
    Extension &count = verdict_.extensions["probing"];
    ++count.ran;
    verdict_.ended += end == End::DONE ? 1 : 0;
    const bool isUnknown = isProbeMoved(act) && end != End::DONE;
    // but not the known results of the probe
    if (isStopped_ || isUnknown || hasTrouble(act, Upset::OFFSET)) {
        return;
    }
    const std::vector<Found> found = read_found(told_);
    std::size_t n = 0, moves = 0;
    std::map<int, double> farthest;
    for (std::size_t i = 0; i < act.blocks.size(); ++i) {
        const ProbeMove &probe = act.blocks[i].probe;
        if (probe.axis < 0) {
            continue;
        }
        ++moves;
        const JointDesign &joint =
            plan_.design.joints[plan_.design.coordinates.find(geometry::AXIS_LETTERS[probe.axis])];
        const double late = 2.5 * probe.speed * PERIOD_S + 3 / joint.counts_per_unit + 0.02 + 2 * joint.play +
                            2 * joint.screw_error;
        farthest[probe.axis] =
            std::max(farthest[probe.axis], late + way_to_stop(plan_.design, joint, probe.axis, probe.speed));
        if (n == found.size()) {
            continue;
        }
        const Found &f = found[n++];
        ++count.judged;
        if (f.isFound != probe.isMet || (probe.isMet && std::abs(f.place - probe.wall) > late)) {
            fail("probe", fmt::format("line {} has found {} at {:.6g}, where {} at {:.6g}", i + 1,
                                      f.isFound ? "a wall" : "nothing", f.place,
                                      probe.isMet ? "it is" : "none is on the way", probe.wall));
        }
    }
    // The probing move that must end the program prints nothing.
    if (found.size() != moves - (act.isToFail ? 1 : 0)) {
        fail("work", fmt::format("{} of {} probing moves have told what they found", found.size(), moves));
    }
    for (const auto &[axis, most] : farthest) {
        if (beyond_walls_[axis] > most) {
            fail("probe", fmt::format("overtravel {:.4g} past a wall of {}, {:.4g} allowed",
                                      beyond_walls_[axis], geometry::AXIS_LETTERS[axis], most));
        }
    }
}

}  // namespace mw::campaign
