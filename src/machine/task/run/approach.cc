// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/approach.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mw::task {
namespace {

/// Positions closer than this are equal. [machine units, degrees]
constexpr double NEAR = 1e-7;
/// Time after which it is assumed that a person has seen a proposal. [ns]
constexpr std::int64_t SEEN_NS = 500000000;

bool isSame(const geometry::Pose &a, const geometry::Pose &b) {
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (std::fabs(a[axis] - b[axis]) > NEAR) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::vector<ApproachMove> approach_moves(const geometry::Pose &from, const geometry::Pose &to,
                                         double safe_z) {
    std::vector<ApproachMove> moves;
    if (isSame(from, to)) {
        return moves;
    }
    const double height = std::max({safe_z, from[geometry::AXIS_Z], to[geometry::AXIS_Z]});
    geometry::Pose at = from, above = to;
    above[geometry::AXIS_Z] = height;
    geometry::Pose over = from;
    over[geometry::AXIS_Z] = to[geometry::AXIS_Z];
    const bool over_place = isSame(over, to) && from[geometry::AXIS_Z] >= to[geometry::AXIS_Z];
    const auto go = [&](const geometry::Pose &end, bool rapid) {
        if (!isSame(at, end)) {
            moves.push_back({end, rapid});
            at = end;
        }
    };
    if (!over_place) {
        geometry::Pose up = from;
        up[geometry::AXIS_Z] = height;
        go(up, true);
        go(above, true);
    }
    go(to, false);
    return moves;
}

void ApproachPlan::find_way(double safe_z, const geometry::Pose &changed_at) {
    if (!mustChangeTool()) {
        moves = approach_moves(from, modes.position, safe_z);
        return;
    }
    geometry::Pose up = from;
    up[geometry::AXIS_Z] = std::max(safe_z, from[geometry::AXIS_Z]);
    moves.clear();
    moves.push_back({up, true});
    const auto rest = approach_moves(changed_at, modes.position, safe_z);
    moves.insert(moves.end(), rest.begin(), rest.end());
}

bool ApproachPlan::isNeeded() const {
    return !moves.empty() || mustChangeTool() || !modes.spindles.empty() || modes.isMistOn ||
           modes.isFloodOn || !modes.user_codes.empty();
}

std::vector<gcode::MachineCall> ApproachPlan::calls() const {
    std::vector<gcode::MachineCall> all;
    const auto move = [&](const ApproachMove &one) {
        gcode::LineMove leg;
        leg.end = one.end;
        leg.settings.isRapid = one.isRapid;
        leg.settings.mode = geometry::PathMode::EXACT_STOP;
        leg.settings.feed = one.isRapid ? 0 : feed;
        all.emplace_back(leg);
    };
    std::size_t done = 0;
    geometry::Pose above = from;
    above[geometry::AXIS_Z] = moves.empty() ? above[geometry::AXIS_Z] : moves[0].end[geometry::AXIS_Z];
    if (!moves.empty() && moves[0].isRapid && isSame(moves[0].end, above)) {
        move(moves[done++]);
    }
    if (mustChangeTool()) {
        for (const geometry::Pose &place : change_moves) {
            move({place, true});
        }
        all.emplace_back(gcode::SelectTool{modes.tool});
        all.emplace_back(gcode::ChangeTool{});
    }
    if (modes.selected_tool >= 0) {
        all.emplace_back(gcode::SelectTool{modes.selected_tool});
    }
    all.insert(all.end(), modes.settings.begin(), modes.settings.end());
    all.insert(all.end(), modes.spindles.begin(), modes.spindles.end());
    while (done + 1 < moves.size()) {
        move(moves[done++]);
    }
    all.emplace_back(gcode::SwitchMist{modes.isMistOn});
    all.emplace_back(gcode::SwitchFlood{modes.isFloodOn});
    if (done < moves.size()) {
        move(moves[done]);
    }
    return all;
}

void Approach::propose(ApproachPlan plan, std::int64_t now_ns) {
    plan_ = std::move(plan);
    ++number_;
    since_ns_ = now_ns;
}

Result<> Approach::check(std::uint64_t number, std::int64_t now_ns) const {
    if (!isOpen()) {
        return fail("no approach is proposed");
    }
    if (number != 0 && number != number_) {
        return fail(fmt::format("the proposed approach is number {}", number_));
    }
    if (number == 0 && now_ns - since_ns_ < SEEN_NS) {
        return fail("the approach was proposed a moment ago", {}, "check the approach, then confirm it");
    }
    return {};
}

void Approach::show(ApproachStatus &status, const OffsetsStatus &offsets, const CodesStatus &codes) const {
    if (!isOpen()) {
        if (status.number != 0) {
            status = {};
        }
        return;
    }
    status.number = number_;
    status.to = plan_->to;
    status.line = plan_->line;
    status.tool = plan_->modes.tool;
    status.mustChangeTool = plan_->mustChangeTool();
    status.isMistOn = plan_->modes.isMistOn;
    status.isFloodOn = plan_->modes.isFloodOn;
    status.feed = plan_->feed;
    status.speeds_rpm = plan_->modes.speeds_rpm;
    status.offsets = offsets;
    if (const auto &found = plan_->modes.offsets; found.has_value()) {
        status.offsets.g5x_index = found->g5x_index;
        status.offsets.g5x = found->g5x;
        status.offsets.g92 = found->g92;
        status.offsets.rotation_xy_deg = found->rotation_xy_deg;
    }
    status.offsets.tool =
        plan_->modes.tool_offset.has_value() ? plan_->modes.tool_offset->offset : offsets.tool;
    status.codes = codes;
    status.num_moves = static_cast<std::uint32_t>(plan_->moves.size());
    std::copy(plan_->moves.begin(), plan_->moves.end(), status.moves.begin());
}

std::string approach_text(const ApproachPlan &plan) {
    static constexpr const char *AXES = "XYZABCUVW";
    std::string text;
    const auto add = [&](const std::string &part) { text += (text.empty() ? "" : ", ") + part; };
    std::optional<geometry::Pose> before;
    for (const ApproachMove &move : plan.moves) {
        std::string words;
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const bool reported = before.has_value() ? std::fabs(move.end[axis] - (*before)[axis]) > NEAR
                                                     : axis == geometry::AXIS_Z;
            words += reported ? fmt::format(" {}{:.3f}", AXES[axis], move.end[axis]) : "";
        }
        words = words.empty() ? fmt::format(" Z{:.3f}", move.end[geometry::AXIS_Z]) : words;
        add(fmt::format("{} to machine{}", move.isRapid ? "rapid" : "feed", words));
        before = move.end;
    }
    if (plan.mustChangeTool()) {
        add(fmt::format("tool {}", plan.modes.tool));
    }
    for (std::size_t i = 0; i < plan.modes.speeds_rpm.size(); ++i) {
        if (plan.modes.speeds_rpm[i] != 0) {
            add(fmt::format("spindle {} at {:g}", i, plan.modes.speeds_rpm[i]));
        }
    }
    if (plan.modes.isMistOn || plan.modes.isFloodOn) {
        add(plan.modes.isFloodOn ? "flood" : "mist");
    }
    for (const int code : plan.modes.user_codes) {
        add(fmt::format("M{} was skipped", code));
    }
    return text;
}

}  // namespace mw::task
