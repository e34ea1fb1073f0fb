// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/lathe/lathe_profile.hh"

#include <algorithm>
#include <numbers>

namespace mw::gcode::detail {
namespace {

constexpr double TINY = 1e-9;

bool isOn(const ProfileSegment &segment, Point point) {
    if (!segment.isArc) {
        const double length = distance(segment.start, segment.end);
        const double at = length < TINY ? 0.0
                                        : dot({point.x - segment.start.x, point.y - segment.start.y},
                                              unit(segment.start, segment.end));
        return at > -TINY && at < length + TINY;
    }
    return distance(segment.start, point) < TINY ||
           sweep(segment, segment.start, point) < sweep(segment, segment.start, segment.end) + TINY;
}

/// The crossing of both segments that is nearest to `corner`.
std::optional<Point> common_point(const ProfileSegment &a, const ProfileSegment &b, Point corner) {
    const Crossings found = crossings(a, b);
    std::optional<Point> best;
    for (int i = 0; i < found.count; ++i) {
        const Point point = found.points[i];
        if (isOn(a, point) && isOn(b, point) &&
            (!best || distance(point, corner) < distance(*best, corner))) {
            best = point;
        }
    }
    return best;
}

/// The fillet between a segment and the next; shortens both. False when it does not fit.
bool make_fillet(ProfileSegment &a, ProfileSegment &b, ProfileSegment &fillet) {
    const Point out = direction(a, a.end), in = direction(b, b.start);
    const double bend = cross(out, in);
    const double radius = a.fillet;
    fillet = {};
    fillet.isArc = !a.is_chamfer;
    fillet.turn = bend > 0.0 ? 1 : -1;
    const std::optional<ProfileSegment> ma = moved(a, radius * fillet.turn),
                                        mb = moved(b, radius * fillet.turn);
    if (!ma || !mb) {
        return false;
    }
    const std::optional<Point> centre = common_point(*ma, *mb, a.end);
    if (!centre) {
        return false;
    }
    const auto foot = [&](const ProfileSegment &segment) {
        if (segment.isArc) {
            return sum(segment.centre, unit(segment.centre, *centre), radius_of(segment));
        }
        const Point along = unit(segment.start, segment.end);
        return sum(segment.start, along,
                   dot({centre->x - segment.start.x, centre->y - segment.start.y}, along));
    };
    fillet.centre = *centre;
    fillet.start = foot(a);
    fillet.end = foot(b);
    a.end = fillet.start;
    b.start = fillet.end;
    return true;
}

/// Distance that an arc goes back along x at one of its ends: 0 for most arcs.
double setback(const ProfileSegment &arc, Point at) {
    return direction(arc, at).x < 0.0 ? radius_of(arc) - std::fabs(at.x - arc.centre.x) : 0.0;
}

}  // namespace

Profile in_frame(const Profile &profile, const CutFrame &frame) {
    Profile out = profile;
    for (ProfileSegment &segment : out) {
        segment.start = frame.to(segment.start);
        segment.end = frame.to(segment.end);
        segment.centre = frame.to(segment.centre);
        segment.turn = frame.turn(segment.turn);
    }
    return out;
}

CutFrame frame_of(const Profile &profile, bool isFacing) {
    CutFrame frame{.isFacing = isFacing};
    const Point begin = frame.to(profile.front().start), first = frame.to(profile.front().end),
                last = frame.to(profile.back().end);
    const double way = std::fabs(last.x - first.x) > TINY ? last.x - first.x : first.x - begin.x;
    frame.along = way > 0.0 ? 1.0 : -1.0;
    if (std::fabs(begin.y - first.y) > TINY) {
        frame.across = begin.y > first.y ? 1.0 : -1.0;
        return frame;
    }
    CutFrame mirrored = frame;
    mirrored.across = -1.0;
    const auto isBelowStart = [&](const CutFrame &one) {
        return std::ranges::all_of(in_frame({profile.begin() + 1, profile.end()}, one),
                                   [&](const ProfileSegment &segment) {
                                       return top_of(segment) <= one.to(profile.front().start).y + TINY;
                                   });
    };
    if (isBelowStart(frame)) {
        return frame;
    }
    mirrored.side_clear = isBelowStart(mirrored);
    return mirrored;
}

double radius_of(const ProfileSegment &arc) {
    return distance(arc.centre, arc.start);
}

Point direction(const ProfileSegment &segment, Point at) {
    if (!segment.isArc) {
        return unit(segment.start, segment.end);
    }
    const Point out = unit(segment.centre, at);
    return segment.turn > 0 ? Point{-out.y, out.x} : Point{out.y, -out.x};
}

double sweep(const ProfileSegment &arc, Point from, Point to) {
    const Point a{from.x - arc.centre.x, from.y - arc.centre.y}, b{to.x - arc.centre.x, to.y - arc.centre.y};
    const double angle = std::atan2(cross(a, b), dot(a, b)) * arc.turn;
    return angle < -TINY ? angle + 2.0 * std::numbers::pi : std::fmax(angle, 0.0);
}

Crossings crossings(const ProfileSegment &a, const ProfileSegment &b) {
    if (a.isArc && b.isArc) {
        return cross_circles(a.centre, radius_of(a), b.centre, radius_of(b));
    }
    if (a.isArc || b.isArc) {
        const ProfileSegment &arc = a.isArc ? a : b, &line = a.isArc ? b : a;
        return cross_line_circle(line.start, unit(line.start, line.end), arc.centre, radius_of(arc));
    }
    const Point da = unit(a.start, a.end), db = unit(b.start, b.end);
    const double sine = cross(da, db);
    if (std::fabs(sine) < SAME_POINT) {
        return {};
    }
    const Point gap{b.start.x - a.start.x, b.start.y - a.start.y};
    const Point point = sum(a.start, da, cross(gap, db) / sine);
    return {1, {point, point}};
}

std::optional<ProfileSegment> moved(const ProfileSegment &segment, double by) {
    ProfileSegment out = segment;
    if (!segment.isArc) {
        const Point along = unit(segment.start, segment.end), left{-along.y, along.x};
        out.start = sum(segment.start, left, by);
        out.end = sum(segment.end, left, by);
        return out;
    }
    const double radius = radius_of(segment) - by * segment.turn;
    if (radius < TINY) {
        return std::nullopt;
    }
    // The segment has one radius, although the numbers of a programmed arc may give two.
    out.start = sum(segment.centre, unit(segment.centre, segment.start), radius);
    out.end = sum(segment.centre, unit(segment.centre, segment.end), radius);
    return out;
}

Profile split_arcs(const Profile &profile) {
    Profile out;
    for (const ProfileSegment &segment : profile) {
        const Point top = segment.isArc
                              ? Point{segment.centre.x, segment.centre.y - segment.turn * radius_of(segment)}
                              : Point{};
        const bool split = segment.isArc && top.x > segment.start.x + TINY && top.x < segment.end.x - TINY;
        out.push_back(segment);
        if (split) {
            out.back().end = top;
            out.push_back(segment);
            out.back().start = top;
        }
    }
    return out;
}

bool isDescending(const ProfileSegment &segment) {
    return segment.end.y < segment.start.y - TINY;
}

double top_of(const ProfileSegment &segment) {
    const double ends = std::fmax(segment.start.y, segment.end.y);
    const bool over_centre = segment.isArc && segment.turn < 0 && segment.start.x < segment.centre.x &&
                             segment.end.x > segment.centre.x;
    return over_centre ? std::fmax(ends, segment.centre.y + radius_of(segment)) : ends;
}

bool round_corners(Profile &profile) {
    Profile out;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        ProfileSegment segment = profile[i];
        const bool is_corner =
            segment.fillet > 0.0 && i + 1 < profile.size() && distance(segment.start, segment.end) > TINY;
        constexpr double TANGENT = 1e-6;
        if (!is_corner || std::fabs(cross(direction(segment, segment.end),
                                          direction(profile[i + 1], profile[i + 1].start))) < TANGENT) {
            out.push_back(segment);
            continue;
        }
        ProfileSegment fillet;
        if (!make_fillet(segment, profile[i + 1], fillet)) {
            return false;
        }
        out.push_back(segment);
        out.push_back(fillet);
    }
    profile = std::move(out);
    return true;
}

bool isMonotonic(const Profile &profile, double tolerance) {
    for (std::size_t i = 1; i < profile.size(); ++i) {
        const ProfileSegment &segment = profile[i];
        if (segment.end.x < segment.start.x - TINY) {
            return false;
        }
        if (!segment.isArc) {
            continue;
        }
        const double spare = std::acos(std::fmax(-1.0, 1.0 - tolerance / radius_of(segment)));
        const bool forward =
            sweep(segment, segment.start, segment.end) < std::numbers::pi + 2.0 * spare + TINY &&
            distance(segment.start, segment.end) > TINY && setback(segment, segment.start) <= tolerance &&
            setback(segment, segment.end) <= tolerance;
        if (!forward) {
            return false;
        }
    }
    return true;
}

void drop_short(Profile &profile, double length) {
    for (std::size_t i = profile.size() - 1; i > 0 && profile.size() > 2; --i) {
        const Point from = profile[i].start, to = profile[i].end;
        if (distance(from, to) >= length) {
            continue;
        }
        const bool is_last = i + 1 == profile.size();
        const Point middle = is_last ? to : Point{(from.x + to.x) / 2.0, (from.y + to.y) / 2.0};
        profile[i - 1].end = middle;
        if (!is_last) {
            profile[i + 1].start = middle;
        }
        profile.erase(profile.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

void straighten(Profile &profile) {
    Profile out{profile.front()};
    const auto line = [](Point from, Point to) {
        ProfileSegment one;
        one.start = from;
        one.end = to;
        return one;
    };
    for (std::size_t i = 1; i < profile.size(); ++i) {
        ProfileSegment segment = profile[i];
        if (!segment.isArc) {
            out.push_back(segment);
            continue;
        }
        const auto mirrored = [&](Point at) { return Point{at.x, 2.0 * segment.centre.y - at.y}; };
        const Point begin = segment.start, end = segment.end;
        const bool back_at_start = setback(segment, begin) > 0.0, back_at_end = setback(segment, end) > 0.0;
        if (back_at_start) {
            segment.start = mirrored(begin);
            out.push_back(line(begin, segment.start));
        }
        segment.end = back_at_end ? mirrored(end) : end;
        if (segment.end.x > segment.start.x) {
            out.push_back(segment);
        }
        if (back_at_end) {
            out.push_back(line(segment.end, end));
        }
    }
    profile = std::move(out);
}

}  // namespace mw::gcode::detail
