// SPDX-License-Identifier: GPL-2.0-or-later
// Judges motion that is synchronized with the spindle, by the true angle of the rotor.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "campaign/session.hh"

namespace mw::campaign {
namespace {

/// Samples in which only Z moves, towards the end of the synchronized move.
struct Pass {
    std::size_t first = 0, last = 0;
    double length = 0;
};

std::vector<Pass> passes_of(const std::vector<geometry::Pose> &path, const SyncWish &sync) {
    std::vector<Pass> all;
    const double sense = sync.to > sync.from ? 1 : -1;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const geometry::Pose step = path[i] - path[i - 1];
        const double z = step[geometry::AXIS_Z];
        const bool isAlone = std::abs(step[geometry::AXIS_X]) < 1e-9;
        if (!isAlone || !(z * sense > 1e-12)) {
            continue;
        }
        // Z may wait for the spindle at the start. With few encoder counts it may stop again within the first
        // part of a revolution. A move in the same direction may end at the start position.
        constexpr std::size_t WAIT = 3;
        constexpr double BEGUN = 1e-3;
        const auto isAtStart = [&](std::size_t n) {
            return std::abs(path[n][geometry::AXIS_Z] - sync.from) <= 1e-6;
        };
        const bool isAnother = !all.empty() && isAtStart(i - 1) && !isAtStart(all.back().first);
        const bool isGoingOn =
            !all.empty() && (all.back().last + WAIT >= i || all.back().length < BEGUN * std::abs(sync.lead));
        if (!isGoingOn || isAnother) {
            all.push_back({i - 1, i, 0});
        }
        all.back().last = i;
        all.back().length += std::abs(z);
    }
    std::erase_if(all, [&](const Pass &p) {
        return p.length < 0.6 * std::abs(sync.to - sync.from) ||
               std::abs(path[p.first][geometry::AXIS_Z] - sync.from) > 1e-6;
    });
    return all;
}

struct Spread {
    double low = 1e300, high = -1e300;
    int count = 0;
    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
        ++count;
    }
    double width() const { return count > 0 ? high - low : 0; }
    double middle() const { return 0.5 * (low + high); }
};

}  // namespace

void Session::check_sync(const Act &act, End end) {
    static constexpr const char *NAMES[] = {"", "threads", "rigid taps", "feed per turn", "surface speed"};
    Extension &count = verdict_.extensions[NAMES[static_cast<int>(act.sync.kind)]];
    ++count.ran;
    verdict_.ended += end == End::DONE ? 1 : 0;
    if (isStopped_ || isDisturbed_ || act.isToFail || end != End::DONE || act.sync.isShort) {
        return;
    }
    ++count.judged;
    switch (act.sync.kind) {
    case Sync::NONE: break;
    case Sync::THREAD:
    case Sync::TAP: check_helix(act.sync); break;
    case Sync::PER_TURN: check_per_turn(act.sync); break;
    case Sync::SURFACE: check_surface(act.sync); break;
    }
}

/// Between acceleration and braking the tool follows one helix, and every pass follows the same helix.
void Session::check_helix(const SyncWish &sync) {
    const Design &d = plan_.design;
    const std::vector<Pass> passes = passes_of(path_, sync);
    if (passes.size() < static_cast<std::size_t>(sync.passes)) {
        fail("work", fmt::format("{} passes in step with the spindle, where {} are asked for", passes.size(),
                                 sync.passes));
        return;
    }
    // A tap is deeper than its helix while the spindle brakes, and less deep as it has reversed. Motion
    // rejects a tap if the expected deviation exceeds 0.1 rev; it knows the ramp with an accuracy of a fifth.
    constexpr double THREAD = 0.001, WORST = 0.12;
    // The judge does not know the part of the jerk limits that the curves of joints need.
    const bool isKnown = d.isTrivial || !d.isJerkLimited;
    const double late = isKnown ? std::min(d.off_helix(sync.lead, d.spindle.ramp), WORST) : WORST;
    const double rough = 2.0 / d.spindle.counts_per_turn;
    const double most = rough + THREAD + (sync.kind == Sync::TAP ? 2 * late : 0);
    const double sense = sync.to > sync.from ? 1 : -1;
    const double turning = sync.rpm > 0 ? 1 : -1;
    const double length = std::abs(sync.to - sync.from);
    double phase = NAN;
    for (const Pass &p : passes) {
        Spread helix;
        double deepest = 0;
        for (std::size_t i = p.first; i <= p.last && i + 1 < turns_.size(); ++i) {
            const double way = (path_[i][geometry::AXIS_Z] - sync.from) * sense;
            deepest = std::max(deepest, way);
            // The rest is for acceleration and braking; a tap has it after its end.
            if (way > 0.4 * length && (way < 0.6 * length || sync.kind == Sync::TAP)) {
                helix.add(way / sync.lead - turning * turns_[i + 1]);
            }
        }
        if (helix.width() > most) {
            fail("helix",
                 fmt::format("Z leaves its helix by {:.4f} turns, {:.4f} allowed", helix.width(), most));
        }
        const double here = helix.middle() - std::floor(helix.middle());
        phase = std::isnan(phase) ? here : phase;
        if (helix.count > 0 && std::abs(std::remainder(here - phase, 1.0)) > most + 0.002) {
            fail("helix",
                 fmt::format("a pass is {:.4f} turns beside another one", std::remainder(here - phase, 1.0)));
        }
        constexpr double BOTTOM = 0.25;  // of a revolution; the first hole relies on the start of the spindle
        const double deep = sync.kind == Sync::TAP ? BOTTOM * sync.lead : 1e-6;
        if (std::abs(deepest - length) > deep) {
            fail("work", fmt::format("a pass is {:.6g} deep instead of {:.6g}", deepest, length));
        }
    }
    const double end = std::abs(path_.back()[geometry::AXIS_Z] - sync.from);
    if (sync.kind == Sync::TAP && end > 1e-6) {
        fail("work", fmt::format("a tap ends {:.4g} from its start", end));
    }
}

void Session::check_per_turn(const SyncWish &sync) {
    const std::vector<Pass> passes = passes_of(path_, sync);
    if (passes.size() != 1) {
        fail("work", fmt::format("{} moves of feed per turn instead of one", passes.size()));
        return;
    }
    const double length = std::abs(sync.to - sync.from);
    double way = 0, turns = 0;
    for (std::size_t i = passes[0].first + 1; i <= passes[0].last; ++i) {
        const double done = std::abs(path_[i][geometry::AXIS_Z] - sync.from);
        if (done > 0.4 * length && done < 0.6 * length) {
            way += std::abs(path_[i][geometry::AXIS_Z] - path_[i - 1][geometry::AXIS_Z]);
            turns += std::abs(turns_[i] - turns_[i - 1]);
        }
    }
    constexpr double PART = 0.01;
    if (turns > 0 && std::abs(way / turns / sync.lead - 1) > PART) {
        fail("helix", fmt::format("{:.5f} for a turn instead of {:.5f}", way / turns, sync.lead));
    }
}

void Session::check_surface(const SyncWish &sync) {
    double worst = 0;
    int judged = 0;
    for (std::size_t i = 1; i + 1 < path_.size(); ++i) {
        const double x = path_[i][geometry::AXIS_X];
        const bool isCut =
            x < path_[i - 1][geometry::AXIS_X] && x <= sync.from && x >= sync.to && rpm_[i] > 0;
        if (!isCut) {
            continue;
        }
        const auto wish = [&](double at) {
            return std::min(sync.rpm, sync.lead * 1000 / (2 * 3.14159265358979 * std::max(at, 1e-9)));
        };
        // The tool follows a spindle angle that is at most two cycles old.
        const double low = wish(path_[i - 1][geometry::AXIS_X] + 2 * (path_[i - 1][geometry::AXIS_X] - x));
        const double high = wish(x);
        worst = std::max({worst, low / rpm_[i] - 1, rpm_[i] / high - 1});
        ++judged;
    }
    if (judged == 0 || worst > 0.005) {
        fail("surface", fmt::format("the spindle's speed is {:.2f} % off its surface speed", 100 * worst));
    }
}

}  // namespace mw::campaign
