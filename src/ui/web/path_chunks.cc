// SPDX-License-Identifier: GPL-2.0-or-later
#include "ui/web/path_chunks.hh"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

namespace mw::ui::web {
namespace {

static_assert(std::endian::native == std::endian::little, "chunks are little-endian");

enum class Chunk : std::uint32_t { MOVES = 1, BOUNDS = 2, END = 3, ERROR = 4 };
enum class Move : std::uint8_t { RAPID = 0, FEED = 1, ARC = 2, PROBE = 3 };

using Place = std::array<double, 3>;

Place place_of(const geom::Pose &pose) {
    return {pose.x(), pose.y(), pose.z()};
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

template <class T>
void append(std::string &bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof raw);
}

/// With its head, and padded to whole words.
std::string chunk(Chunk kind, std::string body, char padding) {
    constexpr std::size_t WORD = 4;
    body.append((WORD - body.size() % WORD) % WORD, padding);
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(kind));
    append(bytes, static_cast<std::uint32_t>(body.size()));
    return bytes + body;
}

}  // namespace

bool PathChunks::take(std::span<const gcode::PreviewEvent> events) {
    const bool isFirst = count_ == 0;
    for (const gcode::PreviewEvent &event : events) {
        add(event);
        if (points_.size() >= POINTS_PER_CHUNK && !send()) {
            return false;
        }
    }
    return isFirst ? send() : isRead_;
}

void PathChunks::add(const gcode::PreviewEvent &event) {
    using Kind = gcode::PreviewKind;
    const auto go = [&](const geom::Pose &to, Move kind) {
        if (count_ == 0) {
            add_point(place_of(event.start), event, static_cast<std::uint8_t>(kind));
        }
        add_point(place_of(to), event, static_cast<std::uint8_t>(kind));
    };
    switch (event.kind) {
    case Kind::RAPID: go(event.end, Move::RAPID); return;
    case Kind::FEED: go(event.end, Move::FEED); return;
    case Kind::PROBE: go(event.end, Move::PROBE); return;
    case Kind::ARC:
        if (count_ == 0) {
            add_point(place_of(event.start), event, static_cast<std::uint8_t>(Move::ARC));
        }
        add_arc(event);
        return;
    case Kind::RIGID_TAP:
        go(event.end, Move::FEED);
        go(event.start, Move::FEED);
        return;
    case Kind::DWELL:
    case Kind::TOOL_CHANGE:
    case Kind::STOP:
    case Kind::PLANNER: return;
    }
}

/// The radius and the height change evenly on the way round. An arc in UVW is a line in XYZ.
void PathChunks::add_arc(const gcode::PreviewEvent &event) {
    constexpr int MOST_PER_TURN = 4096, LEAST_PER_TURN = 12;
    constexpr double MOST_CHORDS = 100000;  // of a helix
    const auto kind = static_cast<std::uint8_t>(Move::ARC);
    const Place centre = place_of(event.centre), end = place_of(event.end);
    Place normal = place_of(event.normal);
    const double length = std::sqrt(dot(normal, normal));
    if (length > 0) {
        normal = {normal[0] / length, normal[1] / length, normal[2] / length};
        const Place from = along(place_of(event.start), -1, centre), to = along(end, -1, centre);
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
            add_point(along(at, scale * std::sin(angle), side), event, kind);
        }
    }
    add_point(end, event, kind);
}

void PathChunks::add_point(const Place &place, const gcode::PreviewEvent &event, std::uint8_t kind) {
    Point point;
    for (std::size_t i = 0; i < place.size(); ++i) {
        point.place[i] = static_cast<float>(place[i]);
        low_[i] = count_ == 0 ? point.place[i] : std::min(low_[i], point.place[i]);
        high_[i] = count_ == 0 ? point.place[i] : std::max(high_[i], point.place[i]);
    }
    point.line = static_cast<std::uint32_t>(std::max(event.line, 0));
    point.kind = kind;
    points_.push_back(point);
    ++count_;
}

bool PathChunks::send() {
    if (points_.size() < 2 || !isRead_) {
        return isRead_;
    }
    std::string body;
    body.reserve(4 + points_.size() * 17 + 4);
    append(body, static_cast<std::uint32_t>(points_.size()));
    for (const Point &point : points_) {
        for (const float coordinate : point.place) {
            append(body, coordinate);
        }
    }
    for (const Point &point : points_) {
        append(body, point.line);
    }
    for (const Point &point : points_) {
        append(body, point.kind);
    }
    points_.erase(points_.begin(), points_.end() - 1);
    isRead_ = push_(chunk(Chunk::MOVES, std::move(body), '\0'));
    return isRead_;
}

void PathChunks::error(std::string_view text) {
    if (isRead_) {
        isRead_ = push_(chunk(Chunk::ERROR, std::string(text), ' '));
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
    isRead_ = push_(chunk(Chunk::BOUNDS, std::move(bounds), '\0')) &&
              push_(chunk(Chunk::END, std::move(counts), '\0'));
}

}  // namespace mw::ui::web
