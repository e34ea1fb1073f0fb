// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/planner_mode.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "motion/interface/limits.hh"

namespace mw::task {
namespace {

using motion::Parameter;

constexpr double LOWEST_SCALE = 0.1, HIGHEST_SCALE = 1.0;

}  // namespace

void PlannerMode::configure(const std::vector<motion::SetParameter> &parameters) {
    for (const motion::SetParameter &p : parameters) {
        switch (static_cast<Parameter>(p.parameter)) {
        case Parameter::TRAJ_PLANNER_TYPE: type_ = wish_ = static_cast<int>(p.value); break;
        case Parameter::TRAJ_CORNER_SCALE: corner_scale_ = p.value; break;
        case Parameter::TRAJ_MAX_JERK: linear_jerk_ = p.value; break;
        case Parameter::AXIS_MAX_JERK:
        case Parameter::JOINT_MAX_JERK: least_jerk_ = std::min(least_jerk_, p.value); break;
        default: break;
        }
    }
}

bool PlannerMode::isJerkOff() const {
    return linear_jerk_ < motion::LEAST_JERK || std::min(linear_jerk_, least_jerk_) >= motion::NO_JERK_LIMIT;
}

void PlannerMode::announce() {
    if (type_ == 1 && isJerkOff()) {
        hooks_.post(MessageKind::OPERATOR_TEXT,
                    "PLANNER_TYPE 1 needs jerk limits, which are off: the trapezoidal planner is used; set "
                    "[TRAJ]MAX_LINEAR_JERK (machine units/s^3, at least 1)");
    }
}

motion::CommandId PlannerMode::set(int type) {
    wish_ = type;
    if (type == type_) {
        return 0;
    }
    type_ = type;
    announce();
    return hooks_.send(
        {static_cast<std::uint16_t>(Parameter::TRAJ_PLANNER_TYPE), 0, static_cast<double>(type)});
}

void PlannerMode::wish(int type) {
    if (type != 0 && type != 1) {
        hooks_.post(MessageKind::OPERATOR_ERROR, "ini.traj-planner-type is " + std::to_string(type) +
                                                     ": 0 (trapezoidal) or 1 (jerk-limited) expected");
        return;
    }
    wish_ = type;
    wait_announced_ = false;
}

void PlannerMode::set_corner_scale(double scale) {
    ScaleFault fault = ScaleFault::NONE;
    if (!std::isfinite(scale)) {
        fault = ScaleFault::NO_NUMBER;
    } else {
        fault = scale < LOWEST_SCALE    ? ScaleFault::TOO_LOW
                : scale > HIGHEST_SCALE ? ScaleFault::TOO_HIGH
                                        : ScaleFault::NONE;
        corner_scale_ = std::clamp(scale, LOWEST_SCALE, HIGHEST_SCALE);
        hooks_.send({static_cast<std::uint16_t>(Parameter::TRAJ_CORNER_SCALE), 0, corner_scale_});
    }
    const bool is_new = fault != told_fault_;
    told_fault_ = fault;
    if (is_new && fault != ScaleFault::NONE) {
        hooks_.post(
            MessageKind::OPERATOR_ERROR,
            fmt::format("ini.traj-scurve-peak-scale is {}: a number from {} to {} expected; {} is used",
                        scale, LOWEST_SCALE, HIGHEST_SCALE, corner_scale_));
    }
}

void PlannerMode::step(bool idle) {
    if (wish_ == type_) {
        return;
    }
    if (idle) {
        set(wish_);
    } else if (!wait_announced_) {
        wait_announced_ = true;
        hooks_.post(MessageKind::OPERATOR_TEXT, "the change of the planner waits until motion is idle");
    }
}

}  // namespace mw::task
