// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/path/path_chunks.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "clients/screen/path/detail/chunk.hh"

namespace mw::screen {
namespace {

using detail::append;
using detail::chunk;
using detail::Chunk;

enum class Move : std::uint8_t { RAPID = 0, FEED = 1, ARC = 2, PROBE = 3 };

/// X, Y, Z of a pose, or with `first` AXIS_U the other end of a wire.
Place place_of(const geometry::Pose &pose, int first = geometry::AXIS_X) {
    return {pose[first], pose[first + 1], pose[first + 2]};
}

double dot(const Place &a, const Place &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Place cross(const Place &a, const Place &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// a + k b
Place along(const Place &a, double k, const Place &b) {
    return {a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]};
}

}  // namespace

bool PathChunks::take(std::span<const gcode::PreviewEvent> events) {
    const bool is_first = count_ == 0;
    for (const gcode::PreviewEvent &event : events) {
        add(event);
        if (points_.size() >= POINTS_PER_CHUNK && !send()) {
            return false;
        }
    }
    return is_first ? send() : is_read_;
}

void PathChunks::add(const gcode::PreviewEvent &event) {
    using Kind = gcode::PreviewKind;
    const auto go = [&](const geometry::Pose &from, const geometry::Pose &to, Move move) {
        add_straight(event, from, to, static_cast<std::uint8_t>(move));
    };
    switch (event.kind) {
    case Kind::RAPID: go(event.start, event.end, Move::RAPID); return;
    case Kind::FEED: go(event.start, event.end, Move::FEED); return;
    case Kind::PROBE: go(event.start, event.end, Move::PROBE); return;
    case Kind::ARC: add_arc(event); return;
    case Kind::RIGID_TAP:
        go(event.start, event.end, Move::FEED);
        go(event.end, event.start, Move::FEED);
        return;
    case Kind::TOOL_CHANGE: range_.tool = static_cast<std::uint32_t>(std::max(event.number, 0)); return;
    case Kind::DWELL:
    case Kind::STOP:
    case Kind::PLANNER: return;
    }
}

/// A line that rotary axes curve in the picture consists of chords.
void PathChunks::add_straight(const gcode::PreviewEvent &event, const geometry::Pose &from,
                              const geometry::Pose &to, std::uint8_t kind) {
    constexpr double CHORD_DEG = 3, MOST_CHORDS = 20000;
    note_range(event, kind);
    note_offset(event);
    note_rotary(event);
    if (count_ == 0) {
        add_point(from, event, kind);
    }
    if (!look_.foam.has_value() && look_.geometry.isTurnedBetween(from, to)) {
        double most = 0;
        for (int axis = geometry::AXIS_A; axis <= geometry::AXIS_C; ++axis) {
            most = std::max(most, std::abs(to[axis] - from[axis]));
        }
        const auto chords = static_cast<int>(std::clamp(std::ceil(most / CHORD_DEG), 1.0, MOST_CHORDS));
        for (int i = 1; i < chords; ++i) {
            const double part = static_cast<double>(i) / chords;
            geometry::Pose pose;
            for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
                pose[axis] = from[axis] + part * (to[axis] - from[axis]);
            }
            add_point(pose, event, kind);
        }
    }
    add_point(to, event, kind);
}

/// Radius, height and the coordinates that do not belong to the arc change linearly along the arc.
void PathChunks::add_arc(const gcode::PreviewEvent &event) {
    constexpr int MOST_PER_TURN = 4096, LEAST_PER_TURN = 12;
    constexpr double MOST_CHORDS = 100000;  // maximum for a helix
    const auto kind = static_cast<std::uint8_t>(Move::ARC);
    note_range(event, kind);
    note_offset(event);
    note_rotary(event);
    if (count_ == 0) {
        add_point(event.start, event, kind);
    }
    const int first = geometry::norm_uvw(event.normal) > 0 ? geometry::AXIS_U : geometry::AXIS_X;
    const Place centre = place_of(event.centre, first);
    Place normal = place_of(event.normal, first);
    const double length = std::sqrt(dot(normal, normal));
    if (length > 0) {
        normal = {normal[0] / length, normal[1] / length, normal[2] / length};
        const Place from = along(place_of(event.start, first), -1, centre);
        const Place to = along(place_of(event.end, first), -1, centre);
        const double height = dot(from, normal), rise = dot(to, normal) - height;
        const Place radius = along(from, -height, normal), side = cross(normal, radius);
        const Place last = along(to, -height - rise, normal);
        const double begin = std::sqrt(dot(radius, radius));
        const double growth = begin > 0 ? std::sqrt(dot(last, last)) / begin - 1 : 0;
        const double turns = std::abs(event.angle_rad) / (2 * std::numbers::pi);
        const double flat =
            std::clamp(1 - DEVIATION_MM / std::max(begin * unit_mm_, DEVIATION_MM), -1.0, 1.0);
        const double per_turn = std::clamp(std::numbers::pi / std::max(std::acos(flat), 1e-9),
                                           double{LEAST_PER_TURN}, double{MOST_PER_TURN});
        const auto chords = static_cast<int>(std::clamp(std::ceil(turns * per_turn), 1.0, MOST_CHORDS));
        for (int i = 1; i < chords; ++i) {
            const double part = static_cast<double>(i) / chords, angle = event.angle_rad * part;
            const double scale = 1 + growth * part;
            Place at = along(centre, height + rise * part, normal);
            at = along(at, scale * std::cos(angle), radius);
            at = along(at, scale * std::sin(angle), side);
            geometry::Pose pose;
            for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
                const bool of_arc = axis >= first && axis < first + 3;
                pose[axis] = of_arc ? at[static_cast<std::size_t>(axis - first)]
                                    : event.start[axis] + part * (event.end[axis] - event.start[axis]);
            }
            add_point(pose, event, kind);
        }
    }
    add_point(event.end, event, kind);
}

/// Rapid moves have no feed, and do not change the feed of the last cut.
void PathChunks::note_range(const gcode::PreviewEvent &event, std::uint8_t kind) {
    constexpr double S_PER_MIN = 60;
    const geometry::MoveSettings &settings = event.settings;
    const bool is_per_turn = settings.feed_per_revolution > 0 && event.spindle_rpm > 0;
    const double feed =
        is_per_turn ? settings.feed_per_revolution * event.spindle_rpm / S_PER_MIN : settings.feed;
    if (kind != static_cast<std::uint8_t>(Move::RAPID)) {
        range_.feed = static_cast<float>(feed);
    }
    range_.first = count_;
    const bool same =
        !ranges_.empty() && ranges_.back().feed == range_.feed && ranges_.back().tool == range_.tool;
    if (!same) {
        ranges_.push_back(range_);
        ++unsent_;
    }
}

/// Points are counted as in ranges, so a client with the offset of a move can calculate its tool tip.
void PathChunks::note_offset(const gcode::PreviewEvent &event) {
    std::array<float, 3> active{};
    for (int axis = geometry::AXIS_X; axis <= geometry::AXIS_Z; ++axis) {
        active[static_cast<std::size_t>(axis)] = static_cast<float>(event.tool_offset[axis]);
    }
    if (active != offset_) {
        offset_ = active;
        offsets_.push_back({count_, active});
    }
}

/// Stores the first line that moves A, B or C.
void PathChunks::note_rotary(const gcode::PreviewEvent &event) {
    for (int axis = geometry::AXIS_A; axis <= geometry::AXIS_C && !rotary_line_.has_value(); ++axis) {
        if (event.start[axis] != event.end[axis]) {
            rotary_line_ = static_cast<std::uint32_t>(std::max(event.line, 0));
        }
    }
}

void PathChunks::add_point(const geometry::Pose &pose, const gcode::PreviewEvent &event, std::uint8_t kind) {
    Point point;
    const auto put = [&](std::array<float, 3> &to, const Place &place) {
        for (std::size_t i = 0; i < place.size(); ++i) {
            to[i] = static_cast<float>(place[i]);
            low_[i] = bounded_ ? std::min(low_[i], to[i]) : to[i];
            high_[i] = bounded_ ? std::max(high_[i], to[i]) : to[i];
        }
        bounded_ = true;
    };
    if (look_.foam.has_value()) {
        put(point.place, {pose[geometry::AXIS_X], pose[geometry::AXIS_Y], look_.foam->z});
        put(point.wire, {pose[geometry::AXIS_U], pose[geometry::AXIS_V], look_.foam->w});
    } else {
        put(point.place, look_.geometry.place(pose));
    }
    point.line = static_cast<std::uint32_t>(std::max(event.line, 0));
    point.kind = kind;
    points_.push_back(point);
    ++count_;
}

std::string PathChunks::moves(bool of_wire) const {
    std::string body;
    body.reserve(4 + points_.size() * 17 + 4);
    append(body, static_cast<std::uint32_t>(points_.size()));
    for (const Point &point : points_) {
        for (const float coordinate : of_wire ? point.wire : point.place) {
            append(body, coordinate);
        }
    }
    for (const Point &point : points_) {
        append(body, point.line);
    }
    for (const Point &point : points_) {
        append(body, point.kind);
    }
    return body;
}

std::string PathChunks::offsets() const {
    std::string body;
    append(body, static_cast<std::uint32_t>(offsets_.size()));
    for (const ToolOffset &one : offsets_) {
        append(body, one.first);
        for (const float coordinate : one.xyz) {
            append(body, coordinate);
        }
    }
    return body;
}

bool PathChunks::send() {
    if (points_.size() < 2 || !is_read_) {
        return is_read_;
    }
    if (!offsets_.empty()) {
        is_read_ = push_(chunk(Chunk::OFFSETS, offsets(), '\0'));
        offsets_.clear();
    }
    if (rotary_line_.has_value() && !has_sent_rotary_) {
        std::string body;
        append(body, *rotary_line_);
        has_sent_rotary_ = true;
        is_read_ = is_read_ && push_(chunk(Chunk::ROTARY, std::move(body), '\0'));
    }
    if (unsent_ > 0) {
        std::string body;
        append(body, static_cast<std::uint32_t>(unsent_));
        for (std::size_t i = ranges_.size() - unsent_; i < ranges_.size(); ++i) {
            append(body, ranges_[i].first);
            append(body, ranges_[i].feed);
            append(body, ranges_[i].tool);
        }
        ranges_.erase(ranges_.begin(), ranges_.end() - 1);  // the current range
        unsent_ = 0;
        is_read_ = is_read_ && push_(chunk(Chunk::RANGES, std::move(body), '\0'));
    }
    is_read_ = is_read_ && push_(chunk(Chunk::MOVES, moves(false), '\0'));
    if (look_.foam.has_value()) {
        is_read_ = is_read_ && push_(chunk(Chunk::WIRES, moves(true), '\0'));
    }
    points_.erase(points_.begin(), points_.end() - 1);
    return is_read_;
}

void PathChunks::error(std::string_view text) {
    if (is_read_) {
        is_read_ = push_(chunk(Chunk::ERROR, std::string(text), ' '));
    }
}

void PathChunks::end(std::uint32_t lines) {
    if (!send()) {
        return;
    }
    std::string bounds, counts;
    for (const auto &corner : {low_, high_}) {
        for (const float coordinate : corner) {
            append(bounds, coordinate);
        }
    }
    append(counts, lines);
    append(counts, count_);
    is_read_ = push_(chunk(Chunk::BOUNDS, std::move(bounds), '\0')) &&
               push_(chunk(Chunk::END, std::move(counts), '\0'));
}

}  // namespace mw::screen
