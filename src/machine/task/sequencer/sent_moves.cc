// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/sent_moves.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mw::task {
namespace {

using Vector = std::array<double, 3>;
constexpr double TURN = 2 * std::numbers::pi;
/// Maximum distance of a point on the arc. [machine units]
constexpr double ON_ARC = 1e-6;
/// Maximum distance of a position between two moves. [machine units, degrees]
constexpr double AT_END = 1e-6;

Vector part(const geometry::Pose &pose, int first) {
    return {pose[first], pose[first + 1], pose[first + 2]};
}
double dot(const Vector &a, const Vector &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector &a, const Vector &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector across(const Vector &v, const Vector &normal) {
    const double along = dot(v, normal);
    return {v[0] - along * normal[0], v[1] - along * normal[1], v[2] - along * normal[2]};
}
double length(const Vector &v) {
    return std::sqrt(dot(v, v));
}

double distance(const geometry::Pose &a, const geometry::Pose &b) {
    double furthest = 0;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        furthest = std::max(furthest, std::fabs(a[axis] - b[axis]));
    }
    return furthest;
}

bool isMove(const gcode::MachineCall &call) {
    return std::holds_alternative<gcode::LineMove>(call) || std::holds_alternative<gcode::ArcMove>(call);
}

bool isOutput(const gcode::MachineCall &call) {
    return std::holds_alternative<gcode::SetDigitalOutput>(call) ||
           std::holds_alternative<gcode::SetAnalogOutput>(call);
}

const geometry::Pose *end_of(const gcode::MachineCall &call) {
    const auto *line = std::get_if<gcode::LineMove>(&call);
    const auto *arc = std::get_if<gcode::ArcMove>(&call);
    return line != nullptr ? &line->end : arc != nullptr ? &arc->end : nullptr;
}

}  // namespace

geometry::Pose SentMoves::note(motion::CommandId id, const Item &item, const geometry::Pose &position) {
    const geometry::Pose start = sent_.empty() || isEndUnknown_ ? position : end_;
    isEndUnknown_ = std::holds_alternative<gcode::ProbeMove>(item.call);
    sent_.push_back({id, item, start});
    const geometry::Pose *const end = end_of(item.call);
    end_ = end != nullptr ? *end : start;
    return start;
}

void SentMoves::follow(const motion::Status &status) {
    const auto show = [this](const Item &item) {
        if (!isOutput(item.call)) {
            line_ = item.source.line;
        }
    };
    while (!sent_.empty() && sent_.front().id <= status.last_path_id) {
        // a move may be shorter than a cycle of task, so that it is never seen as the current move
        show(sent_.front().item);
        sent_.pop_front();
    }
    if (status.queue_depth == 0 || sent_.empty()) {
        return;
    }
    if (status.active_path_id != 0) {
        line_ = status.source.line;  // in a reverse run it is an earlier move
    } else {
        show(sent_.front().item);
    }
}

const Item *SentMoves::oldest_after(motion::CommandId id) const {
    const auto first = std::ranges::find_if(sent_, [id](const Sent &one) { return one.id > id; });
    return first == sent_.end() ? nullptr : &first->item;
}

std::deque<SentMoves::Sent>::const_iterator SentMoves::under_way(const motion::Status &status) const {
    return std::find_if(sent_.begin(), sent_.end(), [&](const Sent &one) {
        return status.active_path_id != 0 ? one.id >= status.active_path_id : one.id > status.last_path_id;
    });
}

std::string SentMoves::why_not(const motion::Status &status, const geometry::Pose &place) const {
    const auto first = under_way(status);
    // After a reverse run the position is in a move that counts as done.
    const bool known =
        status.active_path_id == 0 || (first != sent_.end() && first->id == status.active_path_id);
    if (status.isReverse ||
        (!known && distance(place, first == sent_.end() ? end_ : first->start) > AT_END)) {
        return "it has run in reverse along its path";
    }
    if (first == sent_.end()) {
        return {};
    }
    const gcode::MachineCall &call = first->item.call;
    const auto *line = std::get_if<gcode::LineMove>(&call);
    const auto *arc = std::get_if<gcode::ArcMove>(&call);
    const bool is_thread = (line != nullptr && line->settings.feed_per_revolution > 0) ||
                           (arc != nullptr && arc->settings.feed_per_revolution > 0);
    if (is_thread) {
        return "the move follows the spindle";
    }
    const bool plain = isMove(call) || std::holds_alternative<gcode::SetDigitalOutput>(call) ||
                       std::holds_alternative<gcode::SetAnalogOutput>(call);
    return plain ? "" : "a probe move or a tap is active";
}

std::vector<Item> SentMoves::rest(const motion::Status &status, const geometry::Pose &place) const {
    std::vector<Item> all;
    bool is_first_move = true;
    for (auto at = under_way(status); at != sent_.end(); ++at) {
        const auto *arc = std::get_if<gcode::ArcMove>(&at->item.call);
        if (is_first_move && arc != nullptr) {
            for (const gcode::MachineCall &call :
                 rest_of_arc(*arc, at->start, place, status.distance_to_go)) {
                all.push_back({at->item.source, call, at->item.read});
            }
        } else {
            all.push_back(at->item);
        }
        is_first_move = is_first_move && !isMove(at->item.call);
    }
    return all;
}

std::vector<gcode::MachineCall> rest_of_arc(const gcode::ArcMove &arc, const geometry::Pose &start,
                                            const geometry::Pose &place, double to_go) {
    const bool in_uvw = length(part(arc.normal, geometry::AXIS_X)) == 0;
    const int first = in_uvw ? geometry::AXIS_U : geometry::AXIS_X;
    const Vector normal = part(arc.normal, first), centre = part(arc.centre, first);
    const auto radius_at = [&](const geometry::Pose &pose) {
        const Vector p = part(pose, first);
        return across({p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]}, normal);
    };
    const Vector from = radius_at(start), to = radius_at(arc.end), here = radius_at(place);
    const double radius = length(from);
    if (radius == 0 || length(here) == 0 || arc.angle_rad == 0) {
        return {arc};
    }
    const double sense = arc.angle_rad > 0 ? 1 : -1, whole = std::fabs(arc.angle_rad);
    double left = sense * std::atan2(dot(cross(here, to), normal), dot(here, to));
    left = left < 0 ? left + TURN : left;
    // For an arc of several revolutions: as many revolutions as remain.
    const double along = dot(part(arc.end, first), normal) - dot(part(start, first), normal);
    const double expected = std::min(whole, to_go / std::hypot(radius, along / whole));
    const double turns = std::max(0.0, std::round((expected - left) / TURN));
    left = std::min(whole, left + turns * TURN);

    std::vector<gcode::MachineCall> calls;
    const double done = 1 - left / whole;
    geometry::Pose on = place;
    for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        const double height =
            // distance along the normal
            dot(part(start, first), normal) - dot(centre, normal) + done * along;
        on[first + i] = centre[axis] + here[axis] * radius / length(here) + height * normal[axis];
    }
    const Vector a = part(on, first), b = part(place, first);
    if (length({a[0] - b[0], a[1] - b[1], a[2] - b[2]}) > ON_ARC) {
        gcode::LineMove line;
        line.end = on;
        line.settings = arc.settings;
        calls.emplace_back(line);
    }
    gcode::ArcMove rest = arc;
    rest.angle_rad = sense * left;
    calls.emplace_back(rest);
    return calls;
}

}  // namespace mw::task
