// SPDX-License-Identifier: GPL-2.0-or-later
// G70 (finishing), G71 and G72 (roughing along Z and along X) and their variants for pockets. The profile is
// a subroutine of which only the moves count; it is read as a call, then cut as a whole.
#include <cmath>

#include <fmt/format.h>

#include "interp/detail/executor.hh"

namespace mw::interp::detail {
namespace {

constexpr int Z = geom::AXIS_Z, X = geom::AXIS_X;

/// From (Z, X) to the frame of a cut, and back.
struct CutFrame {
    bool isFacing = false;  ///< the cut runs along X
    double along = 1, across = 1;

    Point to(Point p) const {
        return isFacing ? Point{p.y * along, p.x * across} : Point{p.x * along, p.y * across};
    }
    Point from(Point p) const {
        return isFacing ? Point{p.y * across, p.x * along} : Point{p.x * along, p.y * across};
    }
    int turn(int one) const { return (along * across > 0.0) != isFacing ? one : -one; }
};

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

/// The cut runs to where the profile ends, which is not deeper in the material than its beginning.
CutFrame frame_of(const Profile &profile, bool isFacing) {
    CutFrame frame{isFacing, 1, 1};
    const Point begin = frame.to(profile.front().start), first = frame.to(profile.front().end),
                last = frame.to(profile.back().end);
    frame.along = last.x > first.x ? 1.0 : -1.0;
    const bool isUp = last.y == first.y ? begin.y >= first.y : last.y > first.y;
    frame.across = isUp ? 1.0 : -1.0;
    return frame;
}

}  // namespace

bool Executor::do_lathe_cycle(const Code &code, const BlockValues &values) {
    const std::string name = code_name(code);
    static constexpr std::string_view OTHER_AXES = "yabcuvw";
    for (const char c : OTHER_AXES) {
        if (values.has(c)) {
            return fault.set(fmt::format("{} takes no axis words but X and Z", name), values.column_of(c));
        }
    }
    LatheRequest request;
    request.code = code.number;
    if (!whole_word(values, 'q', request.label) ||
        (values.has('p') && !whole_word(values, 'p', request.passes))) {
        return false;
    }
    request.distance = values.at('d', 0.0);
    request.end_distance = values.at('e', 0.0);
    request.roughing.increment = values.at('i', request.roughing.increment);
    request.roughing.retract = values.at('r', request.roughing.retract);
    request.roughing.isVisitingStarts = request.distance != 0.0;
    request.roughing.pockets = static_cast<RoughingPlan::Pockets>(code.number % 10);
    constexpr int MAX_PASSES = 10000;
    struct Check {
        bool isBad;
        char word;
        const char *text;
    };
    const Check checks[] = {
        {state.plane != Plane::XZ, 'q', "needs the plane G18"},
        {state.comp != CompSide::OFF, 'q', "cannot be used with cutter radius compensation on"},
        {values.isMachineCoordinates, 'q', "cannot be used with g53"},
        {values.has('@') || values.has('^'), 'q', "takes no polar words"},
        {state.feed_mode == FeedMode::INVERSE_TIME, 'q', "cannot be used with inverse time feed"},
        {state.feed == 0.0, 'q', "needs a feed: give F first"},
        {request.roughing.increment <= 0.0, 'i', "needs a cutting increment I above 0"},
        {request.passes < 1 || request.passes > MAX_PASSES, 'p', "needs a number of passes P of 1 to 10000"},
    };
    for (const Check &check : checks) {
        if (check.isBad) {
            return fault.set(fmt::format("{} {}", name, check.text), values.column_of(check.word));
        }
    }
    if (!check_feed_per_revolution()) {
        return false;
    }
    request.start = request.position = target(values);
    request.motion = state.motion;
    lathe_ = std::move(request);
    outcome = Outcome::PROFILE;
    return true;
}

/// A block of the profile's subroutine: its move, if it has one.
bool Executor::record_profile(BlockValues values) {
    LatheRequest &request = *lathe_;
    const auto isMove = [](int motion) {
        return motion == 0 || motion == 10 || motion == 20 || motion == 30;
    };
    for (const ActiveCode &active : values.codes) {
        const bool isMotion = active.code->group == Group::MOTION;
        if (isMotion && isMove(active.code->number)) {
            request.motion = active.code->number;
        } else if (active.code->usesAxes) {
            return true;  // the axis words are not for a move
        }
    }
    const std::uint32_t used = letters("xzuw");
    if ((values.present & used) == 0 || !isMove(request.motion)) {
        return true;
    }
    const Pose from = request.position;
    const Pose present = state.position;
    // The words U and W are steps along X and Z, whatever the distance mode.
    Pose end = from;
    for (const auto &[name, step, axis] : {std::tuple{'x', 'u', X}, std::tuple{'z', 'w', Z}}) {
        const double scale = axis == X && state.isDiameter ? 0.5 : 1.0;
        if (values.has(name)) {
            end[axis] = values.at(name) * scale + (state.isIncremental ? end[axis] : 0.0);
        }
        if (values.has(step)) {
            end[axis] += values.at(step) * scale;
        }
    }
    request.position = end;
    bool isDone = true;
    if (request.motion >= 20) {
        state.position = from;
        isDone = record_arc(values, end);
        state.position = present;
    } else if (from[X] != end[X] || from[Z] != end[Z]) {
        ProfileSegment line;
        line.start = {from[Z], from[X]};
        line.end = {end[Z], end[X]};
        request.profile.push_back(line);
    }
    return isDone && take_corner_word(values);
}

bool Executor::record_arc(const BlockValues &values, const Pose &end) {
    BlockValues words = values;
    words.present &= ~(letters("xzacuvwpby"));
    for (const auto &[name, axis] : {std::pair{'x', X}, std::pair{'z', Z}}) {
        const double relative = state.isIncremental ? end[axis] - state.position[axis] : end[axis];
        words.present |= bit_of(BlockValues::index(name));
        words.value[static_cast<std::size_t>(BlockValues::index(name))] =
            axis == X && state.isDiameter ? 2.0 * relative : relative;
    }
    ArcPlan arc;
    if (!plan_arc(lathe_->motion == 30, words, arc)) {
        return false;
    }
    ProfileSegment segment;
    segment.isArc = true;
    segment.start = {state.position[Z], state.position[X]};
    segment.end = {end[Z], end[X]};
    segment.centre = {arc.first_centre, arc.second_centre};
    segment.turn = arc.rotation;
    lathe_->profile.push_back(segment);
    return true;
}

/// A: a fillet at the end of this move, C: a chamfer.
bool Executor::take_corner_word(const BlockValues &values) {
    if (!values.has('a') && !values.has('c')) {
        return true;
    }
    const char name = values.has('a') ? 'a' : 'c';
    if (values.has('a') && values.has('c')) {
        return fault.set("A corner of the profile has either a fillet A or a chamfer C",
                         values.column_of('c'));
    }
    if (values.at(name) < 0.0) {
        return fault.set("The fillet A or chamfer C of a profile must not be negative",
                         values.column_of(name));
    }
    if (!lathe_->profile.empty()) {
        lathe_->profile.back().fillet = values.at(name);
        lathe_->profile.back().isChamfer = name == 'c';
    }
    return true;
}

bool Executor::finish_lathe_cycle() {
    const LatheRequest request = std::move(*lathe_);
    lathe_.reset();
    return run_lathe_cycle(request);
}

bool Executor::run_lathe_cycle(const LatheRequest &request) {
    const std::string name = code_name(*find_code('g', request.code));
    const bool isFinishing = request.code == 700;
    state.position = request.start;
    canon.straight_traverse(state.position);
    state.motion = 10;
    state.cycle.isRunning = state.isCompExit = false;
    Profile raw = request.profile;
    if (raw.size() < 2) {  // no more than the way to its beginning
        return true;
    }
    CutFrame frame = frame_of(raw, request.code >= 720);
    Profile profile = in_frame(raw, frame);
    if (isFinishing && !isMonotonic(profile)) {
        frame = frame_of(raw, true);
        profile = in_frame(raw, frame);
    }
    if (!isMonotonic(profile)) {
        return fault.set(fmt::format("The profile of {} is not monotonic: it goes back along {}", name,
                                     isFinishing ? "both Z and X" : (frame.isFacing ? "X" : "Z")));
    }
    if (!round_corners(profile) || !isMonotonic(profile)) {
        return fault.set(fmt::format("A fillet A or chamfer C of the profile of {} does not fit", name));
    }
    const auto go = [&](Point at, Pose &pose) {
        const Point machine = frame.from(at);
        pose[Z] = machine.x;
        pose[X] = machine.y;
    };
    ProfileSegment &entry = profile.front();
    entry.start.x = std::fmin(entry.start.x, entry.end.x);
    const Point begin = entry.start, first = entry.end;
    go(begin, state.position);
    canon.straight_traverse(state.position);
    for (int pass = request.passes - 1; pass >= 0; --pass) {
        const double distance =
            isFinishing
                ? request.end_distance + (request.distance - request.end_distance) * pass / request.passes
                : request.distance;
        Profile cut = profile;
        const double by = begin.y < first.y ? -distance : distance;  // towards the start
        if (!offset_profile(cut, by)) {
            return fault.set(
                fmt::format("Nothing is left of the profile of {} at the distance {}", name, by));
        }
        if (!isFinishing && cut.back().end.y < begin.y) {
            ProfileSegment up;  // what is cut lies below the level of the start
            up.start = cut.back().end;
            up.end = {up.start.x, begin.y};
            cut.push_back(up);
        }
        const std::optional<std::vector<ProfileMove>> moves =
            isFinishing ? finish_moves(cut) : rough_moves(cut, request.roughing);
        if (!moves) {
            return fault.set(fmt::format("{} would make more than a million moves: is I too small?", name));
        }
        if (pass + 1 < request.passes) {
            go(begin, state.position);
            canon.straight_traverse(state.position);
        }
        for (const ProfileMove &move : *moves) {
            Pose end = state.position;
            go(move.end, end);
            const Point centre = frame.from(move.centre);
            if (move.isArc) {
                canon.arc_feed(
                    {end[Z], end[X], centre.x, centre.y, frame.turn(move.turn), end[geom::AXIS_Y], end});
            } else {
                move.isRapid ? canon.straight_traverse(end) : canon.straight_feed(end);
            }
            state.position = end;
        }
    }
    return true;
}

}  // namespace mw::interp::detail
