// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/time_estimate.hh"

#include <algorithm>

#include <fmt/format.h>

#include "motion/api/parameters.hh"

namespace mw::machine {

namespace {

constexpr double JERK_OFF = 1e9;
/// Time lost in places that are kept until the worst are known; beyond that many the least are let go.
constexpr std::size_t MOST_PLACES = 100000;

double setting(const MachineConfig &machine, motion::Parameter parameter, int index) {
    double value = motion::PARAMETERS[static_cast<std::size_t>(parameter)].preset;
    for (const motion::SetParameter &p : machine.parameters) {
        if (p.parameter == static_cast<std::uint16_t>(parameter) && p.index == index) {
            value = p.value;
        }
    }
    return value;
}

std::string name_of(const traj::MoveEstimate &move) {
    const std::string axis = move.axis == traj::XYZ_NORM ? "[TRAJ] (X Y Z)"
                             : move.axis >= 0
                                 ? std::string(1, geom::AXIS_LETTERS[static_cast<std::size_t>(move.axis)])
                                 : "";
    switch (move.binding) {
    case traj::Binding::FEED: return "feed";
    case traj::Binding::VELOCITY: return "velocity of " + axis;
    case traj::Binding::ACCELERATION: return "acceleration of " + axis;
    case traj::Binding::JERK: return "jerk of " + axis;
    case traj::Binding::TOLERANCE: return "tolerance or short moves";
    }
    return {};
}

}  // namespace

traj::Limits path_limits(const MachineConfig &machine) {
    using motion::Parameter;
    traj::Limits out;
    const auto merge = [&](int axis, double v, double a, double jerk) {
        const auto i = static_cast<std::size_t>(axis);
        out.velocity[i] = std::min(out.velocity[i], v);
        out.acceleration[i] = std::min(out.acceleration[i], a);
        out.jerk[i] = std::min(out.jerk[i], jerk < JERK_OFF ? jerk : traj::UNLIMITED);
    };
    out.velocity.fill(traj::UNLIMITED);
    out.acceleration.fill(traj::UNLIMITED);
    out.jerk.fill(traj::UNLIMITED);
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        merge(axis, setting(machine, Parameter::AXIS_MAX_VELOCITY, axis),
              setting(machine, Parameter::AXIS_MAX_ACCELERATION, axis),
              setting(machine, Parameter::AXIS_MAX_JERK, axis));
    }
    for (int joint = 0; joint < machine.num_joints && joint < static_cast<int>(machine.coordinates.size());
         ++joint) {
        const int axis = geom::axis_of_letter(machine.coordinates[static_cast<std::size_t>(joint)]);
        if (axis >= 0) {
            merge(axis, setting(machine, Parameter::JOINT_MAX_VELOCITY, joint),
                  setting(machine, Parameter::JOINT_MAX_ACCELERATION, joint),
                  setting(machine, Parameter::JOINT_MAX_JERK, joint));
        }
    }
    const double jerk = setting(machine, Parameter::TRAJ_MAX_JERK, 0);
    merge(traj::XYZ_NORM, setting(machine, Parameter::TRAJ_MAX_VELOCITY, 0),
          setting(machine, Parameter::TRAJ_MAX_ACCELERATION, 0), jerk);
    out.isJerkLimited = setting(machine, Parameter::TRAJ_PLANNER_TYPE, 0) != 0 && jerk >= 1;
    return out;
}

TimeEstimate::TimeEstimate(const MachineConfig &machine)
    : machine_(machine), limits_(path_limits(machine)),
      corner_scale_(setting(machine, motion::Parameter::TRAJ_CORNER_SCALE, 0)),
      isMergeAdded_(setting(machine, motion::Parameter::TRAJ_ADDED_TOLERANCES, 0) != 0),
      estimator_(std::make_unique<traj::Estimator>(limits_,
                                                   static_cast<double>(machine.servo_period_ns) * 1e-9,
                                                   [this](const traj::MoveEstimate &move) { take(move); })) {
    geom::Pose low, high;
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        low[axis] = machine.axis_min[static_cast<std::size_t>(axis)];
        high[axis] = machine.axis_max[static_cast<std::size_t>(axis)];
    }
    estimator_->set_machine(setting(machine, motion::Parameter::MAX_FEED_SCALE, 0), low, high);
}

void TimeEstimate::start(const geom::Pose &position) {
    position_ = position;
    estimator_->begin(position);
}

void TimeEstimate::set_place(const std::string &file, int line, const std::string &section) {
    line_ = line;
    if (files_.empty() || files_[file_] != file) {
        const auto found = std::find(files_.begin(), files_.end(), file);
        file_ = static_cast<std::uint32_t>(found - files_.begin());
        if (found == files_.end()) {
            files_.push_back(file);
        }
    }
    auto &sections = figures_.by_section;
    if (sections.empty() || sections[section_].first != section) {
        const auto found =
            std::find_if(sections.begin(), sections.end(), [&](const auto &s) { return s.first == section; });
        section_ = static_cast<std::size_t>(found - sections.begin());
        if (found == sections.end()) {
            sections.emplace_back(section, 0.0);
        }
    }
}

traj::MoveRequest TimeEstimate::request_of(const interp::MoveSettings &settings) {
    traj::MoveRequest r;
    r.tag.requested_velocity = settings.feed;
    r.tag.line = line_;
    r.tag.file_index = file_;
    r.tag.block = static_cast<std::uint32_t>(section_);
    r.isRapid = settings.kind == interp::FeedKind::RAPID || !(settings.feed > 0);
    r.tolerance = settings.tolerance;
    r.isMergeAdded = isMergeAdded_;
    r.set_merge(settings.naivecam_tolerance);
    r.corner_scale = settings.corner_scale > 0 ? settings.corner_scale : corner_scale_;
    r.join = settings.control == interp::MotionControl::EXACT_STOP   ? traj::Join::STOP
             : settings.control == interp::MotionControl::EXACT_PATH ? traj::Join::EXACT
                                                                     : traj::Join::BLEND;
    return r;
}

void TimeEstimate::line(const geom::Pose &end, const interp::MoveSettings &settings) {
    estimator_->add(traj::make_line(position_, end), request_of(settings));
    position_ = end;
}

void TimeEstimate::arc(const interp::ArcMove &move) {
    traj::Primitive p;
    const traj::ArcShape shape{move.centre, move.normal, move.angle_rad, geom::norm_uvw(move.normal) > 0};
    if (traj::make_arc(position_, move.end, shape, p) == traj::ArcFault::NONE) {
        estimator_->add(p, request_of(move.settings));
    }
    position_ = move.end;
}

void TimeEstimate::dwell(double seconds) {
    stop();
    figures_.dwell_s += seconds;
    figures_.by_tool[tool_] += seconds;
    if (section_ < figures_.by_section.size()) {
        figures_.by_section[section_].second += seconds;
    }
}

void TimeEstimate::stop() {
    estimator_->finish();
    estimator_->begin(position_);
}

void TimeEstimate::set_smooth(bool isSmooth) {
    stop();
    limits_.isJerkLimited = isSmooth && setting(machine_, motion::Parameter::TRAJ_MAX_JERK, 0) >= 1;
    estimator_->set_limits(limits_);
}

void TimeEstimate::set_tool(int tool) {
    stop();
    tool_ = tool;
}

void TimeEstimate::take(const traj::MoveEstimate &move) {
    (move.tag.requested_velocity > 0 ? figures_.cutting_s : figures_.rapid_s) += move.seconds;
    figures_.by_tool[tool_] += move.seconds;
    if (move.tag.block < figures_.by_section.size()) {
        figures_.by_section[move.tag.block].second += move.seconds;
    }
    const double lost = move.seconds - move.seconds_at_feed;
    if (move.binding == traj::Binding::FEED || !(move.seconds_at_feed > 0) || !(lost > 0)) {
        return;
    }
    if (places_.size() >= MOST_PLACES) {
        std::erase_if(places_, [&](const auto &p) { return p.second.lost_s < lost; });
        if (places_.size() >= MOST_PLACES) {
            return;
        }
    }
    SlowPlace &place = places_[{move.tag.file_index, move.tag.line}];
    place.file = files_.empty() ? std::string() : files_[move.tag.file_index];
    place.line = move.tag.line;
    place.lost_s += lost;
    place.limit = name_of(move);
}

const TimeFigures &TimeEstimate::finish() {
    estimator_->finish();
    figures_.isComplete = estimator_->isComplete();
    figures_.total_s = figures_.cutting_s + figures_.rapid_s + figures_.dwell_s;
    std::vector<SlowPlace> all;
    for (const auto &[key, place] : places_) {
        all.push_back(place);
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const SlowPlace &a, const SlowPlace &b) { return a.lost_s > b.lost_s; });
    all.resize(std::min(all.size(), SLOW_PLACES));
    figures_.slowest = std::move(all);
    return figures_;
}

}  // namespace mw::machine
