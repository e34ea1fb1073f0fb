// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/time_estimate.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::gcode {

namespace {

/// Number of positions with lost time that are stored to find the slowest; above it the positions with the
/// least loss are dropped.
constexpr std::size_t MOST_PLACES = 100000;

/// Types of moves in their tags.
enum class Shape : std::uint8_t { STRAIGHT, ARC };

std::string name_of(const trajectory::MoveEstimate &move) {
    const bool is_arc = move.tag.type == static_cast<std::uint8_t>(Shape::ARC);
    const std::string axis = move.axis == trajectory::XYZ_NORM ? "[TRAJ] (X Y Z)"
                             : move.axis >= 0
                                 ? std::string(1, geometry::AXIS_LETTERS[static_cast<std::size_t>(move.axis)])
                                 : "";
    switch (move.binding) {
    case trajectory::Binding::FEED: return "feed";
    case trajectory::Binding::VELOCITY: return "velocity of " + axis;
    case trajectory::Binding::ACCELERATION:
        return is_arc ? "curvature: acceleration of " + axis : "acceleration of " + axis;
    case trajectory::Binding::JERK: return "jerk of " + axis;
    case trajectory::Binding::TOLERANCE: return "tolerance or short moves";
    }
    return {};
}

}  // namespace

TimeEstimate::TimeEstimate(const TimedMachine &machine, const Overrides &overrides, Watch watch)
    : watch_(std::move(watch)), limits_(machine.limits), corner_scale_(machine.corner_scale),
      has_jerk_limit_(machine.has_jerk_limit),
      estimator_(std::make_unique<trajectory::Estimator>(
          limits_, machine.servo_period_s, [this](const trajectory::MoveEstimate &move) { count(move); })) {
    trajectory::Scales scales;
    scales.feed = overrides.feed;
    scales.rapid = overrides.rapid;
    scales.max_velocity = overrides.max_velocity > 0 ? overrides.max_velocity : scales.max_velocity;
    estimator_->set_machine(scales, machine.low, machine.high);
}

void TimeEstimate::start(const geometry::Pose &position) {
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

trajectory::MoveRequest TimeEstimate::request_of(const geometry::MoveSettings &settings) {
    trajectory::MoveRequest r;
    r.tag.requested_velocity = settings.feed;
    r.tag.line = line_;
    r.tag.id = id_;
    r.tag.file_index = file_;
    r.tag.block = static_cast<std::uint32_t>(section_);
    r.isRapid = settings.isRapid || !(settings.feed > 0);
    r.tolerance = settings.tolerance;
    r.corner_scale = settings.corner_scale > 0 ? settings.corner_scale : corner_scale_;
    r.join = settings.mode;
    return r;
}

namespace {

/// Settings with the feed of moves that follow the spindle, calculated from its programmed speed.
geometry::MoveSettings timed(const PreviewEvent &event) {
    geometry::MoveSettings out = event.settings;
    if (out.feed_per_revolution > 0 && event.spindle_rpm > 0) {
        out.feed = out.feed_per_revolution * event.spindle_rpm / 60.0;
    }
    return out;
}

}  // namespace

void TimeEstimate::take(const PreviewEvent &event, std::uint64_t id) {
    using Kind = PreviewKind;
    id_ = id;
    if (event.spindle_awaited) {
        stop();  // the waiting time is unknown, but the move begins from standstill
    }
    switch (event.kind) {
    case Kind::RAPID: line(event.end, event.settings); break;
    case Kind::FEED: line(event.end, timed(event)); break;
    case Kind::ARC: arc({event.end, event.centre, event.normal, event.angle_rad, timed(event)}); break;
    case Kind::PROBE:
        stop();
        line(event.end, timed(event));
        stop();
        break;
    case Kind::RIGID_TAP:
        line(event.end, timed(event));
        line(event.start, timed(event));
        break;
    case Kind::DWELL: dwell(event.value); break;
    case Kind::TOOL_CHANGE: set_tool(event.number); break;
    case Kind::PLANNER: set_smooth(event.number != 0); break;
    case Kind::STOP: stop(); break;
    }
}

void TimeEstimate::line(const geometry::Pose &end, const geometry::MoveSettings &settings) {
    estimator_->add(trajectory::make_line(position_, end), request_of(settings));
    position_ = end;
}

void TimeEstimate::arc(const ArcMove &move) {
    trajectory::Primitive p;
    const trajectory::ArcShape shape{move.centre, move.normal, move.angle_rad,
                                     geometry::norm_uvw(move.normal) > 0};
    if (trajectory::make_arc(position_, move.end, shape, p) == trajectory::ArcFault::NONE) {
        trajectory::MoveRequest request = request_of(move.settings);
        request.tag.type = static_cast<std::uint8_t>(Shape::ARC);
        estimator_->add(p, request);
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
    if (watch_) {
        watch_({id_, line_, seconds, 0});
    }
}

void TimeEstimate::stop() {
    estimator_->finish();
    estimator_->begin(position_);
}

void TimeEstimate::set_smooth(bool smooth) {
    stop();
    limits_.isJerkLimited = smooth && has_jerk_limit_;
    estimator_->set_limits(limits_);
}

void TimeEstimate::set_tool(int tool) {
    stop();
    tool_ = tool;
}

void TimeEstimate::count(const trajectory::MoveEstimate &move) {
    if (watch_) {
        watch_({move.tag.id, move.tag.line, move.seconds, move.top_velocity});
    }
    (move.tag.requested_velocity > 0 ? figures_.cutting_s : figures_.rapid_s) += move.seconds;
    figures_.by_tool[tool_] += move.seconds;
    if (move.tag.block < figures_.by_section.size()) {
        figures_.by_section[move.tag.block].second += move.seconds;
    }
    const double lost = move.seconds - move.seconds_at_feed;
    if (move.binding == trajectory::Binding::FEED || !(move.seconds_at_feed > 0) || !(lost > 0)) {
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

const TimeFigures &TimeEstimate::finish(std::size_t slow_places) {
    estimator_->finish();
    figures_.isComplete = estimator_->isComplete();
    figures_.total_s = figures_.cutting_s + figures_.rapid_s + figures_.dwell_s;
    std::vector<SlowPlace> all;
    for (const auto &[key, place] : places_) {
        all.push_back(place);
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const SlowPlace &a, const SlowPlace &b) { return a.lost_s > b.lost_s; });
    all.resize(std::min(all.size(), slow_places));
    figures_.slowest = std::move(all);
    return figures_;
}

}  // namespace mw::gcode
