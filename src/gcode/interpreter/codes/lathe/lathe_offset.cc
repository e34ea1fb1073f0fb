// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/lathe/lathe_offset.hh"

#include <algorithm>

namespace mw::gcode::detail {
namespace {

constexpr double SAME_X = 1e-10;      ///< positions along the cut closer than this are equal
constexpr double SAME_HEIGHT = 1e-9;  ///< heights closer than this are equal

double height_at(const ProfileSegment &piece, double x) {
    if (piece.isArc) {
        const double radius = radius_of(piece), aside = x - piece.centre.x;
        return piece.centre.y - piece.turn * std::sqrt(std::fmax(0.0, radius * radius - aside * aside));
    }
    const double part = (x - piece.start.x) / (piece.end.x - piece.start.x);
    return piece.start.y + part * (piece.end.y - piece.start.y);
}

/// The exact start or end of a piece; otherwise the point on it.
Point point_at(const ProfileSegment &piece, double x) {
    if (std::fabs(x - piece.start.x) < SAME_X) {
        return piece.start;
    }
    return std::fabs(x - piece.end.x) < SAME_X ? piece.end : Point{x, height_at(piece, x)};
}

bool isUpright(const ProfileSegment &piece) {
    return std::fabs(piece.end.x - piece.start.x) < SAME_X;
}

ProfileSegment line(Point from, Point to) {
    ProfileSegment one;
    one.start = from;
    one.end = to;
    return one;
}

/// The arc through its own end points: the rounded numbers of a programmed arc may give two radii, and with a
/// single radius the arc would miss one end.
ProfileSegment with_one_radius(const ProfileSegment &segment) {
    ProfileSegment out = segment;
    if (segment.isArc && distance(segment.start, segment.end) > SAME_X) {
        const Point along = unit(segment.start, segment.end);
        const Point middle{(segment.start.x + segment.end.x) / 2.0, (segment.start.y + segment.end.y) / 2.0};
        const Point aside{segment.centre.x - middle.x, segment.centre.y - middle.y};
        out.centre = sum(segment.centre, along, -dot(aside, along));
    }
    return out;
}

/// The arc around a corner, between two directions of travel.
ProfileSegment around(Point corner, Point from, Point to, double by) {
    ProfileSegment arc;
    arc.isArc = true;
    arc.centre = corner;
    arc.turn = -1;
    arc.start = sum(corner, {-from.y, from.x}, by);
    arc.end = sum(corner, {-to.y, to.x}, by);
    return arc;
}

/// Intersection of the offset neighbours of a nearly straight corner, extended if necessary. Empty if the
/// intersection is not near their ends.
std::optional<Point> meeting_point(const ProfileSegment &before, const ProfileSegment &after, Point corner,
                                   double by, double tolerance) {
    const double near = 100.0 * tolerance;
    Crossings found = crossings(before, after);
    // An arc that misses the line by less than the rounding error counts as tangent.
    if (found.count == 0 && before.isArc != after.isArc) {
        const ProfileSegment &arc = before.isArc ? before : after, &straight = before.isArc ? after : before;
        const Point along = unit(straight.start, straight.end);
        const Point to_centre{arc.centre.x - straight.start.x, arc.centre.y - straight.start.y};
        const Point foot = sum(straight.start, along, dot(to_centre, along));
        found = {std::fabs(distance(foot, arc.centre) - radius_of(arc)) < tolerance ? 1 : 0, {foot, foot}};
    }
    std::optional<Point> best;
    for (int i = 0; i < found.count; ++i) {
        const Point point = found.points[i];
        const bool between = point.x > before.start.x + SAME_X && point.x < after.end.x - SAME_X;
        const bool is_near = distance(point, before.end) < near && distance(point, after.start) < near &&
                             distance(point, corner) > by - SAME_HEIGHT &&
                             distance(point, corner) < by + tolerance;
        if (between && is_near && (!best || point.x < best->x)) {
            best = point;
        }
    }
    return best;
}

/// Appends a piece. If rounded numbers of an arc leave a gap, a line closes it.
void append_piece(Profile &chain, const ProfileSegment &piece) {
    if (!chain.empty() && piece.start.x > chain.back().end.x) {
        chain.push_back(line(chain.back().end, piece.start));
    }
    chain.push_back(piece);
}

/// Connects the offset path at the corner before `next`: an arc when it is convex, or only a common point
/// when it is nearly straight.
void join(Profile &chain, const ProfileSegment &before, const ProfileSegment &after, double by,
          double tolerance, std::optional<ProfileSegment> &next) {
    const Point corner = after.start;
    const Point from = direction(before, before.end), to = direction(after, corner);
    constexpr double STRAIGHT = 1e-9;
    const double shortest_arc = 10.0 * tolerance;
    const bool before_present = moved(before, by).has_value();
    const double bend = cross(from, to);
    const bool nearly_straight = by * distance(from, to) < shortest_arc && dot(from, to) > 0.0;
    if (nearly_straight && next && before_present && !isUpright(chain.back()) && !isUpright(*next)) {
        if (distance(chain.back().end, next->start) < SAME_HEIGHT) {
            return;
        }
        if (const std::optional<Point> meeting = meeting_point(chain.back(), *next, corner, by, tolerance)) {
            chain.back().end = next->start = *meeting;
            return;
        }
    }
    // A rise followed by a fall is a peak, a fall followed by a rise is a slit. This does not depend on
    // the rounding of both directions.
    const bool folded = dot(from, to) < 0.0 && from.y * to.y < 0.0;
    if (folded ? from.y > 0.0 : bend < -STRAIGHT) {
        append_piece(chain, around(corner, from, to, by));
    }
}

/// The offset segments and the arcs around convex corners, in order; they may cross each other.
Profile chain_of(const Profile &profile, double by, double tolerance) {
    Profile chain;
    for (std::size_t i = 1; i < profile.size(); ++i) {
        const ProfileSegment &segment = profile[i];
        std::optional<ProfileSegment> next = moved(segment, by);
        if (i > 1) {
            join(chain, profile[i - 1], segment, by, tolerance, next);
        } else if (direction(segment, segment.start).y < -SAME_HEIGHT) {
            chain.push_back(around(segment.start, {1.0, 0.0}, direction(segment, segment.start), by));
        }
        if (next) {
            append_piece(chain, *next);
        }
    }
    return chain;
}

/// An interval of a piece along x.
struct Run {
    std::size_t piece;
    double from, to;
};

/// All x positions where another piece may become the highest.
std::vector<double> break_points(const Profile &pieces) {
    std::vector<double> places;
    std::vector<std::size_t> order(pieces.size()), active;
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return pieces[i].start.x; });
    for (const std::size_t i : order) {
        const ProfileSegment &one = pieces[i];
        std::erase_if(active, [&](std::size_t k) { return pieces[k].end.x <= one.start.x; });
        for (const std::size_t k : active) {
            const ProfileSegment &other = pieces[k];
            const Crossings found = crossings(one, other);
            for (int c = 0; c < found.count; ++c) {
                const double x = found.points[c].x;
                if (x > one.start.x && x < std::fmin(one.end.x, other.end.x)) {
                    places.push_back(x);
                }
            }
        }
        active.push_back(i);
        places.push_back(one.start.x);
        places.push_back(one.end.x);
    }
    std::ranges::sort(places);
    std::vector<double> apart;
    for (const double x : places) {
        if (apart.empty() || x > apart.back() + SAME_X) {
            apart.push_back(x);
        }
    }
    return apart;
}

/// The highest pieces from left to right.
std::vector<Run> highest_runs(const Profile &pieces) {
    std::vector<Run> runs;
    std::vector<std::size_t> order(pieces.size()), active;
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return pieces[i].start.x; });
    const std::vector<double> places = break_points(pieces);
    std::size_t next = 0;
    for (std::size_t b = 1; b < places.size(); ++b) {
        const double from = places[b - 1], to = places[b], middle = (from + to) / 2.0;
        while (next < order.size() && pieces[order[next]].start.x < middle) {
            active.push_back(order[next++]);
        }
        std::erase_if(active, [&](std::size_t k) { return pieces[k].end.x <= middle; });
        if (active.empty()) {
            continue;
        }
        const auto height = [&](std::size_t k) { return height_at(pieces[k], middle); };
        std::size_t best = *std::ranges::max_element(active, {}, height);
        const bool continuing = !runs.empty() &&
                                std::ranges::find(active, runs.back().piece) != active.end() &&
                                height(runs.back().piece) > height(best) - SAME_HEIGHT;
        best = continuing ? runs.back().piece : best;
        if (!runs.empty() && runs.back().piece == best && runs.back().to > from - SAME_X) {
            runs.back().to = to;
        } else {
            runs.push_back({best, from, to});
        }
    }
    return runs;
}

void append(Profile &out, const ProfileSegment &piece) {
    const bool is_gap = !out.empty() && distance(out.back().end, piece.start) > 0.0;
    if (is_gap && distance(out.back().end, piece.start) < SAME_HEIGHT) {
        out.push_back(piece);
        out.back().start = out[out.size() - 2].end;
        return;
    }
    if (is_gap) {
        out.push_back(line(out.back().end, piece.start));
    }
    out.push_back(piece);
}

/// The runs as segments, connected by straight lines at steps.
Profile edge_of(const Profile &pieces, const std::vector<Run> &runs) {
    Profile out;
    for (const Run &run : runs) {
        ProfileSegment piece = pieces[run.piece];
        piece.start = point_at(pieces[run.piece], run.from);
        piece.end = point_at(pieces[run.piece], run.to);
        append(out, piece);
    }
    return out;
}

}  // namespace

Profile offset_profile(const Profile &programmed, double by, double tolerance) {
    if (by == 0.0 || programmed.size() < 2) {
        return programmed;
    }
    Profile profile = programmed;
    std::ranges::transform(profile, profile.begin(), with_one_radius);
    const Profile chain = chain_of(profile, by, tolerance);
    const ProfileSegment &last = profile.back();
    const Point heading = direction(last, last.end);
    const Point end = sum(last.end, {-heading.y, heading.x}, by);
    const bool is_rising_at_end = heading.y > SAME_HEIGHT;
    Profile all = chain;
    if (is_rising_at_end) {  // the end of the segment covers the profile behind it
        append_piece(all, around(last.end, heading, {1.0, 0.0}, by));
    }
    Profile pieces;
    std::ranges::copy_if(all, std::back_inserter(pieces),
                         [](const ProfileSegment &piece) { return !isUpright(piece); });
    std::vector<Run> runs = highest_runs(pieces);
    if (is_rising_at_end) {
        const auto cap = std::ranges::find_if(runs, [&](const Run &run) {
            return run.piece + 1 == pieces.size() && std::fabs(run.from - end.x) < SAME_HEIGHT;
        });
        runs.erase(cap, runs.end());
    }
    const double limit = is_rising_at_end ? last.end.x : end.x;
    std::erase_if(runs, [&](const Run &run) { return run.from > limit - SAME_X; });
    if (!runs.empty()) {
        runs.back().to = std::fmin(runs.back().to, limit);
    }
    const Profile edge = edge_of(pieces, runs);
    const bool end_reached =
        edge.empty() || (std::fabs(edge.back().end.x - end.x) < SAME_HEIGHT &&
                         (is_rising_at_end || (!chain.empty() && isUpright(chain.back()))));
    Profile out{profile.front()};
    const Point begin = chain.empty() ? end : chain.front().start;
    const bool wall_first = !chain.empty() && isUpright(chain.front());
    const bool wall_kept =
        wall_first && !edge.empty() && std::fabs(begin.x - edge.front().start.x) < SAME_HEIGHT;
    if (wall_kept && distance(begin, edge.front().start) > SAME_HEIGHT) {
        out.push_back(line(begin, edge.front().start));
    }
    out.insert(out.end(), edge.begin(), edge.end());
    if (end_reached && distance(out.back().end, end) > SAME_HEIGHT) {
        out.push_back(line(out.size() > 1 ? out.back().end : begin, end));
    }
    out.front().end = out.size() > 1 ? out[1].start : end;
    return out;
}

}  // namespace mw::gcode::detail
