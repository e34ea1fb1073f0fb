// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/lathe/lathe_layers.hh"

#include <algorithm>
#include <utility>

namespace mw::gcode::detail {
namespace {

constexpr double TINY = 1e-9;
constexpr std::size_t MOST_MOVES = 1000000;  // maximum number of moves for one cycle

/// Point of a segment without extremes at height `y`, which lies between its ends.
Point at_height(const ProfileSegment &segment, double y) {
    if (std::fabs(y - segment.start.y) < TINY || std::fabs(y - segment.end.y) < TINY) {
        return std::fabs(y - segment.start.y) < TINY ? segment.start : segment.end;
    }
    if (segment.isArc) {
        const double rise = y - segment.centre.y, radius = radius_of(segment);
        const double half = std::sqrt(std::fmax(0.0, radius * radius - rise * rise));
        const double middle = (segment.start.x + segment.end.x) / 2.0;
        const double x = segment.centre.x + (middle < segment.centre.x ? -half : half);
        return {std::clamp(x, segment.start.x, std::fmax(segment.start.x, segment.end.x)), y};
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

    double level() const { return top_ - static_cast<double>(layer_) * plan_.increment; }
    void move_to(const ProfileSegment &segment, Point end, bool isRapid);
    std::optional<Crossing> rise_through(std::size_t after, double level) const;
    void cut(Point from, Point to, bool isRapid);
    void descend(std::size_t index);
    void rise(const ProfileSegment &segment);
    void follow_envelope(std::size_t first);
    bool isUnderTool(Point at) const;

    const Profile &profile_;
    const RoughingPlan &plan_;
    std::vector<ProfileMove> moves_;
    double surface_ = 0;   ///< height of the material: the height of the cycle's start
    double top_ = 0;       ///< height of the first layer
    long long layer_ = 0;  ///< next layer, from the top
    double rim_ = 0;       ///< height of the pocket's rim
    bool in_pocket_ = false, too_long_ = false;
};

void add_move(std::vector<ProfileMove> &moves, const ProfileSegment &segment, Point end, bool isRapid) {
    const bool isArc = segment.isArc && !isRapid;
    const bool continuing = isArc && !moves.empty() && moves.back().isArc &&
                            moves.back().source == segment.source && moves.back().centre == segment.centre;
    if (continuing) {
        moves.back().end = end;
        return;
    }
    moves.push_back({isRapid, isArc, end, segment.centre, segment.turn, segment.source});
}

void Rougher::move_to(const ProfileSegment &segment, Point end, bool isRapid) {
    add_move(moves_, segment, end, isRapid);
}

/// The next position where the profile rises through `level`.
std::optional<Rougher::Crossing> Rougher::rise_through(std::size_t after, double level) const {
    for (std::size_t i = after + 1; i < profile_.size(); ++i) {
        const ProfileSegment &segment = profile_[i];
        if (segment.start.y < level - TINY && segment.end.y >= level - TINY) {
            return Crossing{i, at_height(segment, level)};
        }
    }
    return std::nullopt;
}

bool Rougher::isUnderTool(Point at) const {
    return !moves_.empty() && distance(moves_.back().end, at) < TINY;
}

/// Cuts across at one level, moves aside and returns to the start.
void Rougher::cut(Point from, Point to, bool isRapid) {
    if (to.x - from.x < plan_.narrowest) {
        moves_.push_back({false, false, to, {}, 1, -1});
        moves_.push_back({false, false, from, {}, 1, -1});
        return;
    }
    const double half = std::fabs(to.x - from.x) / 2.0;
    const double away = plan_.retract < 0.0 || plan_.retract > half ? half : plan_.retract;
    moves_.push_back({false, false, to, {}, 1, -1});
    moves_.push_back({true, false, {to.x - away, to.y + away}, {}, 1, -1});
    moves_.push_back({true, false, {from.x + away, from.y + away}, {}, 1, -1});
    moves_.push_back({isRapid, false, from, {}, 1, -1});
}

void Rougher::descend(std::size_t index) {
    const ProfileSegment &segment = profile_[index];
    const bool is_entry = index == 0;
    bool is_cut = false;
    const bool for_pockets_only = plan_.pockets == RoughingPlan::Pockets::ONLY;
    if (for_pockets_only && !in_pocket_) {
        rim_ = segment.start.y;
        top_ = std::fmin(rim_, surface_);
        layer_ = 0;
        in_pocket_ = true;
    }
    while (!too_long_ && level() <= segment.start.y + TINY && level() > segment.end.y + TINY) {
        const std::optional<Crossing> other = rise_through(index, level());
        if (!other) {
            break;
        }
        const Point from = at_height(segment, level());
        if (!isUnderTool(from) || is_entry) {
            move_to(segment, from, is_entry);
        }
        if (other->point.x - from.x > TINY) {
            cut(from, other->point, is_entry);
        }
        too_long_ = too_long_ || moves_.size() > MOST_MOVES;
        ++layer_;
        is_cut = true;
    }
    move_to(segment, segment.end, is_entry && is_cut);
}

void Rougher::rise(const ProfileSegment &segment) {
    move_to(segment, segment.end, false);
    const double steps = std::floor((segment.end.y - level() + TINY) / plan_.increment);
    layer_ = std::max(0LL, layer_ - static_cast<long long>(std::clamp(steps, 0.0, 1e9)));
    in_pocket_ = in_pocket_ && segment.end.y < rim_ - TINY;
}

/// G71.1: straight across the pockets.
void Rougher::follow_envelope(std::size_t first) {
    Point at = profile_[first].start;
    bool is_new = true;
    for (std::size_t i = first; i < profile_.size();) {
        ProfileSegment segment = profile_[i];
        segment.start = at;
        const bool is_same_arc = i > first && segment.isArc && segment.source == profile_[i - 1].source &&
                                 segment.centre == profile_[i - 1].centre;
        const bool visited = plan_.is_visiting_starts || i == first || i + 1 == profile_.size() ||
                             (!moves_.empty() && moves_.back().isArc);
        if (is_new && visited && !is_same_arc) {
            moves_.push_back({false, false, at, {}, 1, -1});
        }
        std::optional<Crossing> other = isDescending(segment) ? rise_through(i, at.y) : std::nullopt;
        const bool from_above =
            !other && isDescending(segment) && at.y > surface_ + TINY && segment.end.y < surface_ - TINY;
        if (from_above) {  // the pocket begins at the surface of the material
            at = at_height(segment, surface_);
            move_to(segment, at, false);
            other = rise_through(i, surface_);
        }
        at = other ? other->point : segment.end;
        if (other) {
            moves_.push_back({false, false, at, {}, 1, -1});
        } else {
            move_to(segment, at, false);
        }
        is_new = !other || distance(at, profile_[other->index].end) < TINY;
        i = other ? other->index + (is_new ? 1 : 0) : i + 1;
    }
}

std::optional<std::vector<ProfileMove>> Rougher::run() {
    using Pockets = RoughingPlan::Pockets;
    const bool falling = isDescending(profile_.front());
    std::size_t first = 0;
    surface_ = top_ = profile_.front().start.y;
    if (plan_.pockets == Pockets::ONLY && falling) {
        move_to(profile_.front(), profile_.front().end, true);
        first = 1;
    } else if (plan_.pockets != Pockets::ONLY && falling) {
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
    return too_long_ ? std::optional<std::vector<ProfileMove>>() : std::move(moves_);
}

}  // namespace

std::vector<ProfileMove> finish_moves(const Profile &profile) {
    std::vector<ProfileMove> moves;
    for (const ProfileSegment &segment : profile) {
        add_move(moves, segment, segment.end, moves.empty());
    }
    return moves;
}

std::optional<std::vector<ProfileMove>> rough_moves(const Profile &profile, const RoughingPlan &plan) {
    const Profile pieces = split_arcs(profile);
    return Rougher(pieces, plan).run();
}

}  // namespace mw::gcode::detail
