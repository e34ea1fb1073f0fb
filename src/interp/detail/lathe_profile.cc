// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/detail/lathe_profile.hh"

#include <algorithm>
#include <numbers>

#include "interp/detail/plane_geometry.hh"

namespace mw::interp::detail {
namespace {

constexpr double TINY = 1e-9;
constexpr std::size_t MOST_MOVES = 1000000;  // of one cycle

double radius_of(const ProfileSegment &arc) {
    return distance(arc.centre, arc.end);
}

/// The direction of travel at `at`, which lies on the segment.
Point direction(const ProfileSegment &segment, Point at) {
    if (!segment.isArc) {
        return unit(segment.start, segment.end);
    }
    const Point out = unit(segment.centre, at);
    return segment.turn > 0 ? Point{-out.y, out.x} : Point{out.y, -out.x};
}

/// How far an arc turns from `from` to `to`, 0 to a full turn [rad].
double sweep(const ProfileSegment &arc, Point from, Point to) {
    const Point a{from.x - arc.centre.x, from.y - arc.centre.y}, b{to.x - arc.centre.x, to.y - arc.centre.y};
    const double angle = std::atan2(cross(a, b), dot(a, b)) * arc.turn;
    return angle < -TINY ? angle + 2.0 * std::numbers::pi : std::fmax(angle, 0.0);
}

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

/// Crossings of the whole lines or circles that two segments lie on.
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

/// The segment moved to its left by `by`. None when an arc vanishes.
std::optional<ProfileSegment> moved(const ProfileSegment &segment, double by) {
    ProfileSegment out = segment;
    const auto aside = [by](Point point, Point along) { return sum(point, {-along.y, along.x}, by); };
    if (segment.isArc && radius_of(segment) - by * segment.turn < TINY) {
        return std::nullopt;
    }
    out.start = aside(segment.start, direction(segment, segment.start));
    out.end = aside(segment.end, direction(segment, segment.end));
    return out;
}

/// The crossing of both segments that lies next to `corner`.
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

/// Appends `next` where it crosses what is there; what lies behind the crossing goes.
void append_cut(Profile &profile, ProfileSegment next, Point corner) {
    while (!profile.empty()) {
        ProfileSegment &last = profile.back();
        if (distance(last.end, next.start) < TINY) {
            break;
        }
        if (const std::optional<Point> cut = common_point(last, next, corner)) {
            last.end = next.start = *cut;
            break;
        }
        profile.pop_back();
    }
    profile.push_back(next);
}

/// What the offset path needs at the corner between two segments: an arc around it when it is convex, no more
/// than a longer way to the common point when it is nearly straight.
void join(Profile &out, const ProfileSegment &before, const ProfileSegment &segment, double by,
          std::optional<ProfileSegment> &next) {
    const Point corner = segment.start;
    const Point from = direction(before, corner), to = direction(segment, corner);
    constexpr double STRAIGHT = 1e-9, SHORTEST_ARC = 0.01;
    if (cross(from, to) * by > -STRAIGHT) {
        return;
    }
    const bool isNearlyStraight = std::fabs(by) * distance(from, to) < SHORTEST_ARC && dot(from, to) > 0.0;
    if (isNearlyStraight && next && !out.empty() && !before.isArc && !segment.isArc) {
        if (const Crossings found = crossings(out.back(), *next); found.count > 0) {
            out.back().end = next->start = found.points[0];
        }
        return;
    }
    ProfileSegment around;
    around.isArc = true;
    around.centre = corner;
    around.turn = by > 0.0 ? -1 : 1;
    around.start = sum(corner, {-from.y, from.x}, by);
    around.end = sum(corner, {-to.y, to.x}, by);
    append_cut(out, around, corner);
}

/// The fillet between a segment and the next, which it shortens. False when it does not fit.
bool make_fillet(ProfileSegment &a, ProfileSegment &b, ProfileSegment &fillet) {
    const Point out = direction(a, a.end), in = direction(b, b.start);
    const double bend = cross(out, in);
    const double radius = a.fillet;
    fillet = {};
    fillet.isArc = !a.isChamfer;
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

bool isDescending(const ProfileSegment &segment) {
    return segment.end.y < segment.start.y - TINY;
}

/// Arcs cut at their highest or lowest point: every piece only rises or only falls.
Profile split_arcs(const Profile &profile) {
    Profile out;
    for (const ProfileSegment &segment : profile) {
        const Point top = segment.isArc
                              ? Point{segment.centre.x, segment.centre.y - segment.turn * radius_of(segment)}
                              : Point{};
        const bool isSplit = segment.isArc && top.x > segment.start.x + TINY && top.x < segment.end.x - TINY;
        out.push_back(segment);
        if (isSplit) {
            out.back().end = top;
            out.push_back(segment);
            out.back().start = top;
        }
    }
    return out;
}

/// Where a segment without extremes is at height `y`, which lies between its ends.
Point at_height(const ProfileSegment &segment, double y) {
    if (std::fabs(y - segment.start.y) < TINY || std::fabs(y - segment.end.y) < TINY) {
        return std::fabs(y - segment.start.y) < TINY ? segment.start : segment.end;
    }
    if (segment.isArc) {
        const double rise = y - segment.centre.y, radius = radius_of(segment);
        const double half = std::sqrt(std::fmax(0.0, radius * radius - rise * rise));
        const double middle = (segment.start.x + segment.end.x) / 2.0;
        return {segment.centre.x + (middle < segment.centre.x ? -half : half), y};
    }
    const double span = segment.end.y - segment.start.y;
    const double part = std::fabs(span) < TINY ? 1.0 : (y - segment.start.y) / span;
    return {segment.start.x + part * (segment.end.x - segment.start.x), y};
}

/// Cuts a profile layer by layer.
class Rougher {
  public:
    Rougher(const Profile &profile, const RoughingPlan &plan) : profile_(profile), plan_(plan) {}
    std::optional<std::vector<ProfileMove>> run();

  private:
    struct Crossing {
        std::size_t index;
        Point point;
    };

    void move_to(const ProfileSegment &segment, Point end, bool isRapid);
    std::optional<Crossing> rise_through(std::size_t after, double level) const;
    void cut(Point from, Point to, bool isRapid);
    void descend(std::size_t index);
    void rise(const ProfileSegment &segment);
    void follow_envelope(std::size_t first);

    const Profile &profile_;
    const RoughingPlan &plan_;
    std::vector<ProfileMove> moves_;
    double level_ = 0, highest_ = 0;  ///< of the layers
    double rim_ = 0;                  ///< of the pocket that it is in
    bool isPastBeginning_ = false;    ///< the first descent is over: what goes down from here on are pockets
    bool isInPocket_ = false, isTooLong_ = false;
};

void Rougher::move_to(const ProfileSegment &segment, Point end, bool isRapid) {
    moves_.push_back({isRapid, segment.isArc && !isRapid, end, segment.centre, segment.turn});
}

/// The next place at which the profile comes up through `level`.
std::optional<Rougher::Crossing> Rougher::rise_through(std::size_t after, double level) const {
    for (std::size_t i = after + 1; i < profile_.size(); ++i) {
        const ProfileSegment &segment = profile_[i];
        if (segment.start.y < level - TINY && segment.end.y >= level - TINY) {
            return Crossing{i, at_height(segment, level)};
        }
    }
    return std::nullopt;
}

/// Across at one level, aside and back to where it began.
void Rougher::cut(Point from, Point to, bool isRapid) {
    const double half = std::fabs(to.x - from.x) / 2.0;
    const double away = plan_.retract < 0.0 || plan_.retract > half ? half : plan_.retract;
    const double forwards = to.x < from.x ? -1.0 : 1.0;
    moves_.push_back({false, false, to, {}, 1});
    moves_.push_back({true, false, {to.x - away * forwards, to.y + away}, {}, 1});
    moves_.push_back({true, false, {from.x + away * forwards, from.y + away}, {}, 1});
    moves_.push_back({isRapid, false, from, {}, 1});
}

void Rougher::descend(std::size_t index) {
    const ProfileSegment &segment = profile_[index];
    const bool isEntry = index == 0;
    bool isCut = false;
    const bool isForPocketsOnly = plan_.pockets == RoughingPlan::Pockets::ONLY;
    if (isForPocketsOnly && !isPastBeginning_) {  // the other cycle has cut what lies before the first pocket
        move_to(segment, segment.end, false);
        return;
    }
    if (isForPocketsOnly && !isInPocket_) {
        level_ = highest_ = rim_ = segment.start.y;
        isInPocket_ = true;
    }
    while (!isTooLong_ && level_ <= segment.start.y + TINY && level_ > segment.end.y + TINY) {
        const std::optional<Crossing> other = rise_through(index, level_);
        if (!other) {
            break;
        }
        const Point from = at_height(segment, level_);
        const bool isThere = !moves_.empty() && distance(moves_.back().end, from) < TINY;
        if (!isThere || isEntry) {
            move_to(segment, from, isEntry);
        }
        if (std::fabs(other->point.x - from.x) > TINY) {
            cut(from, other->point, isEntry);
        }
        isTooLong_ = isTooLong_ || moves_.size() > MOST_MOVES;
        level_ -= plan_.increment;
        isCut = true;
    }
    move_to(segment, segment.end, isEntry && isCut);
}

void Rougher::rise(const ProfileSegment &segment) {
    move_to(segment, segment.end, false);
    isPastBeginning_ = true;
    const double steps = std::floor((segment.end.y - level_ + TINY) / plan_.increment);
    level_ = std::fmin(highest_, level_ + std::fmax(0.0, steps) * plan_.increment);
    isInPocket_ = isInPocket_ && segment.end.y < rim_ - TINY;
}

/// G71.1: straight over the pockets.
void Rougher::follow_envelope(std::size_t first) {
    Point at = profile_[first].start;
    bool isNew = true;
    for (std::size_t i = first; i < profile_.size();) {
        ProfileSegment segment = profile_[i];
        segment.start = at;
        const bool isVisited = plan_.isVisitingStarts || i == first || i + 1 == profile_.size() ||
                               (moves_.size() > 0 && moves_.back().isArc);
        if (isNew && isVisited) {
            moves_.push_back({false, false, at, {}, 1});
        }
        const std::optional<Crossing> other =
            isDescending(segment) ? rise_through(i, at.y) : std::optional<Crossing>();
        at = other ? other->point : segment.end;
        if (other) {
            moves_.push_back({false, false, at, {}, 1});
        } else {
            move_to(segment, at, false);
        }
        isNew = !other || distance(at, profile_[other->index].end) < TINY;
        i = other ? other->index + (isNew ? 1 : 0) : i + 1;
    }
}

std::optional<std::vector<ProfileMove>> Rougher::run() {
    using Pockets = RoughingPlan::Pockets;
    const bool isFalling = isDescending(profile_.front());
    std::size_t first = 0;
    level_ = highest_ = profile_.front().start.y;
    if (plan_.pockets == Pockets::ONLY && isFalling) {
        move_to(profile_.front(), profile_.front().end, true);
        first = 1;
    } else if (plan_.pockets != Pockets::ONLY && isFalling) {
        descend(0);
        first = 1;
    }
    if (plan_.pockets == Pockets::SKIP) {
        while (first > 0 && first < profile_.size() && isDescending(profile_[first])) {
            descend(first);
            ++first;
        }
        follow_envelope(first);
        first = profile_.size();
    }
    for (std::size_t i = first; i < profile_.size(); ++i) {
        isDescending(profile_[i]) ? descend(i) : rise(profile_[i]);
    }
    return isTooLong_ ? std::optional<std::vector<ProfileMove>>() : std::move(moves_);
}

}  // namespace

bool round_corners(Profile &profile) {
    Profile out;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        ProfileSegment segment = profile[i];
        const bool isCorner = segment.fillet > 0.0 && i + 1 < profile.size();
        constexpr double TANGENT = 1e-6;
        if (!isCorner || std::fabs(cross(direction(segment, segment.end),
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

bool isMonotonic(const Profile &profile) {
    for (std::size_t i = 1; i < profile.size(); ++i) {
        const ProfileSegment &segment = profile[i];
        if (segment.end.x < segment.start.x - TINY) {
            return false;
        }
        const bool isForward =
            !segment.isArc ||
            (direction(segment, segment.start).x > -TINY && direction(segment, segment.end).x > -TINY &&
             sweep(segment, segment.start, segment.end) < std::numbers::pi + TINY &&
             distance(segment.start, segment.end) > TINY);
        if (!isForward) {
            return false;
        }
    }
    return true;
}

bool offset_profile(Profile &profile, double by) {
    if (by == 0.0) {
        return true;
    }
    Profile out;
    for (std::size_t i = 1; i < profile.size(); ++i) {
        std::optional<ProfileSegment> next = moved(profile[i], by);
        if (i > 1) {
            join(out, profile[i - 1], profile[i], by, next);
        }
        if (next) {
            append_cut(out, *next, profile[i].start);
        }
    }
    if (out.empty()) {
        return false;
    }
    profile.front().end = out.front().start;
    profile.erase(profile.begin() + 1, profile.end());
    profile.insert(profile.end(), out.begin(), out.end());
    return true;
}

std::vector<ProfileMove> finish_moves(const Profile &profile) {
    std::vector<ProfileMove> moves;
    for (const ProfileSegment &segment : split_arcs(profile)) {
        const bool isEntry = moves.empty();
        moves.push_back({isEntry, segment.isArc && !isEntry, segment.end, segment.centre, segment.turn});
    }
    return moves;
}

std::optional<std::vector<ProfileMove>> rough_moves(const Profile &profile, const RoughingPlan &plan) {
    const Profile pieces = split_arcs(profile);
    return Rougher(pieces, plan).run();
}

}  // namespace mw::interp::detail
