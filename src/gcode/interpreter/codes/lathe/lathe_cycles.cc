// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/lathe/lathe_cycles.hh"

#include <cmath>
#include <expected>
#include <limits>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/lathe/lathe_offset.hh"
#include "gcode/interpreter/codes/moves/moves.hh"

namespace mw::gcode::detail {
namespace {

constexpr int Z = geometry::AXIS_Z, X = geometry::AXIS_X;

/// Maximum distance that an arc of a profile may go back while the profile counts as monotonic. Arcs with
/// rounded numbers that touch a shoulder go back slightly.
constexpr double TOLERANCE_MM = 0.001, TOLERANCE_INCH = TOLERANCE_MM / 25.4;

/// A profile in the frame of its cut.
struct FramedProfile {
    CutFrame frame;
    Profile profile;
};

/// True if the profile is for cuts along X. G70 follows the last roughing with the same subroutine; without
/// one, a profile for both directions is for cuts along Z, if that puts the distance D on the same side. If
/// this cannot be decided, returns the text after "The profile of Gxx ".
std::expected<bool, std::string> choose_facing(const LatheRequest &request, std::optional<bool> roughed,
                                               double tolerance) {
    if (request.code != G(70)) {
        return request.code >= G(72);
    }
    const CutFrame turned = frame_of(request.profile, false), faced = frame_of(request.profile, true);
    const bool turnable = isMonotonic(in_frame(request.profile, turned), tolerance);
    const bool faceable = isMonotonic(in_frame(request.profile, faced), tolerance);
    if (!turnable && !faceable) {
        return std::unexpected("is not monotonic: it reverses along both Z and X");
    }
    if (!turnable || !faceable) {
        return !turnable;
    }
    const bool distance_used = request.distance > 0.0 || request.end_distance > 0.0;
    if (!roughed && distance_used && turned.turn(1) != faced.turn(1)) {
        return std::unexpected("fits G71 and G72, whose allowances D have opposite sides: rough it in this "
                               "program, or program no D and E");
    }
    return roughed.value_or(false);
}

/// The profile with its corners in the frame of its cut. If it cannot be cut, returns the text after "The
/// profile of Gxx ".
std::expected<FramedProfile, std::string> framed_profile(const Profile &raw, bool isFacing,
                                                         double tolerance) {
    FramedProfile framed;
    framed.frame = frame_of(raw, isFacing);
    framed.profile = in_frame(raw, framed.frame);
    if (!isMonotonic(framed.profile, tolerance)) {
        return std::unexpected(fmt::format("is not monotonic: it reverses along {}", isFacing ? "X" : "Z"));
    }
    if (!round_corners(framed.profile) || !isMonotonic(framed.profile, tolerance)) {
        return std::unexpected("has a corner that is too small for its fillet A or chamfer C");
    }
    drop_short(framed.profile, tolerance / 10.0);
    return framed;
}

/// The contour of one pass. Arcs that go back are removed unless the pass only follows the contour.
Profile contour_of(const Profile &profile, bool followed, double tolerance) {
    Profile contour = profile;
    if (!followed) {
        straighten(contour);
        drop_short(contour, tolerance / 10.0);
    }
    for (std::size_t i = 0; i < contour.size(); ++i) {
        contour[i].source = static_cast<int>(i);
    }
    return contour;
}

bool isEndingAbove(const Profile &profile) {
    return profile.back().end.y > profile.front().end.y;
}

/// Adds a move from the end of the cut to `height`, at feed, because there may be material.
void add_way_out(Profile &cut, double height) {
    const Point end = cut.back().end;
    if (end.y < height) {
        ProfileSegment up;
        up.start = end;
        up.end = {end.x, height};
        up.source = cut.back().source + 1;
        cut.push_back(up);
    }
}

/// Height of the start, or of the contour if that is higher.
double clear_height(const Profile &cut) {
    double height = cut.front().start.y;
    for (const ProfileSegment &segment : cut) {
        height = std::fmax(height, top_of(segment));
    }
    return height;
}

/// Reports that the start of the cycle is inside the profile's range in X (facing: Z), so that no side is
/// free of material.
bool refuse_side(const LatheRequest &request, const CutFrame &cut, std::string_view name, bool is_diameter,
                 Fault &fault) {
    const auto highest = [&](double across) {
        const CutFrame frame{.isFacing = cut.isFacing, .across = across};
        double top = -std::numeric_limits<double>::infinity();
        for (const ProfileSegment &segment :
             in_frame({request.profile.begin() + 1, request.profile.end()}, frame)) {
            top = std::fmax(top, top_of(segment));
        }
        return top;
    };
    const char axis = cut.isFacing ? 'Z' : 'X';
    const double scale = is_diameter && !cut.isFacing ? 2.0 : 1.0;
    const double low = -highest(-1) * scale, high = highest(1) * scale;
    const double start = request.start[cut.isFacing ? Z : X] * scale;
    return fault.set(
        fmt::format(
            "The profile of {} goes from {}{:g} to {}{:g}, and the cycle starts between them at {}{:g}", name,
            axis, low, axis, high, axis, start),
        0,
        cut.isFacing ? fmt::format("start at Z{:g} or more for a front face, at Z{:g} or less for a back "
                                   "face: move there before the cycle, or program it as Z of the cycle",
                                   high, low)
                     : fmt::format("start at X{:g} or more for an outside, at X{:g} or less for a bore: move "
                                   "there before the cycle, or program it as X of the cycle",
                                   high, low));
}

/// Sends a move of the cycle, compensated when G41 or G42 is on.
bool send_profile_move(const ProfileMove &move, const CutFrame &frame, State &state, CanonQueue &canon,
                       Fault &fault) {
    Pose end = state.position;
    const Point machine = frame.from(move.end), centre = frame.from(move.centre);
    end[Z] = machine.x;
    end[X] = machine.y;
    const bool compensated = state.comp.isOn();
    const CompPlace place{state.position, state.plane, state.units};
    if (move.isArc) {
        const int rotation = frame.turn(move.turn);
        if (compensated) {
            if (!state.comp.move_along_arc(place, {end, centre.x, centre.y, rotation}, canon, fault)) {
                return false;
            }
        } else {
            canon.take(ArcFeed{end[Z], end[X], centre.x, centre.y, rotation, end[geometry::AXIS_Y], end});
        }
    } else if (compensated) {
        if (!state.comp.move_straight(place, move.isRapid, end, canon, fault)) {
            return false;
        }
    } else {
        move.isRapid ? canon.take(StraightTraverse{end}) : canon.take(StraightFeed{end});
    }
    state.position = end;
    return true;
}

}  // namespace

Effect begin_lathe_cycle(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    const std::string name = code_name(code);
    static constexpr std::string_view OTHER_AXES = "yabcuvw";
    for (const char c : OTHER_AXES) {
        if (values.has(c)) {
            return values.fail(fmt::format("{} accepts only the axis words X and Z", name), c);
        }
    }
    LatheRequest request;
    request.code = code;
    if (!values.whole('q', request.label) || (values.has('p') && !values.whole('p', request.passes))) {
        return false;
    }
    request.distance = values.at('d', 0.0);
    request.end_distance = values.at('e', 0.0);
    request.roughing.increment = values.at('i', request.roughing.increment);
    request.roughing.retract = values.at('r', request.roughing.retract);
    request.roughing.is_visiting_starts = request.distance != 0.0;
    request.roughing.pockets = static_cast<RoughingPlan::Pockets>(number_of(code) % 10);
    constexpr int MAX_PASSES = 10000;
    struct Check {
        bool bad;
        char word;
        const char *text;
    };
    const Check checks[] = {
        {state.plane != Plane::XZ, 'q', "needs the plane G18"},
        {state.comp.isOn() && code != G(70), 'q', "cannot be used with cutter radius compensation on"},
        {values.has('@') || values.has('^'), 'q', "takes no polar words"},
        {state.feed_mode == FeedMode::INVERSE_TIME, 'q', "cannot be used with inverse time feed"},
        {state.feed == 0.0, 'q', "needs a feed: program F first"},
        {request.roughing.increment <= 0.0, 'i', "needs a cutting increment I above 0"},
        {request.distance < 0.0, 'd', "needs a distance D of 0 or more"},
        {request.end_distance < 0.0, 'e', "needs a last distance E of 0 or more"},
        {request.passes < 1 || request.passes > MAX_PASSES, 'p', "needs a number of passes P of 1 to 10000"},
    };
    for (const Check &check : checks) {
        if (check.bad) {
            return values.fail(fmt::format("{} {}", name, check.text), check.word);
        }
    }
    if (!check_feed_per_revolution(values, state)) {
        return false;
    }
    request.start = request.position = target(values, state);
    parts.lathe.open(std::move(request));
    return Outcome::PROFILE;
}

/// Records the move of a block of the profile's subroutine, if it has one.
bool LatheCycles::record(const BlockValues &values, const Settings &settings, const State &state) {
    LatheRequest &request = *request_;
    const auto isMove = [](GCode motion) {
        return motion == G(0) || motion == G(1) || motion == G(2) || motion == G(3);
    };
    for (const ActiveCode &active : values.codes) {
        const bool is_motion = active.code->group == Group::MOTION;
        if (is_motion && isMove(active.code->id)) {
            request.motion = active.code->id;
        } else if (active.code->usesAxes) {
            return true;  // the axis words do not belong to a move
        }
    }
    const std::uint32_t used = letters("xzuw");
    if ((values.present & used) == 0 || !isMove(request.motion)) {
        return true;
    }
    const Pose from = request.position;
    // The words U and W are increments along X and Z in every distance mode.
    Pose end = from;
    for (const auto &[name, step, axis] : {std::tuple{'x', 'u', X}, std::tuple{'z', 'w', Z}}) {
        const double scale = axis == X && state.isDiameter ? 0.5 : 1.0;
        if (values.has(name)) {
            end[axis] = values.at(name) * scale + (state.incremental ? end[axis] : 0.0);
        }
        if (values.has(step)) {
            end[axis] += values.at(step) * scale;
        }
    }
    request.position = end;
    bool done = true;
    ProfileSegment line;
    line.start = {from[Z], from[X]};
    line.end = {end[Z], end[X]};
    const bool first = request.profile.empty();
    const bool moving = from[X] != end[X] || from[Z] != end[Z];
    if (request.motion >= G(2)) {
        if (first) {  // the contour begins at the start of the cycle
            line.end = line.start;
            request.profile.push_back(line);
        }
        done = record_arc(values, settings, state, from, end);
    } else if (first || moving) {  // the first move goes to the contour and may have any length
        request.profile.push_back(line);
    }
    return done && take_corner_word(values);
}

bool LatheCycles::record_arc(const BlockValues &values, const Settings &settings, const State &state,
                             const Pose &from, const Pose &end) {
    State begin = state;
    begin.position = from;
    BlockValues words = values;
    words.present &= ~(letters("xzacuvwpby"));
    for (const auto &[name, axis] : {std::pair{'x', X}, std::pair{'z', Z}}) {
        const double relative = state.incremental ? end[axis] - begin.position[axis] : end[axis];
        words.present |= bit_of(BlockValues::index(name));
        words.value[static_cast<std::size_t>(BlockValues::index(name))] =
            axis == X && state.isDiameter ? 2.0 * relative : relative;
    }
    ArcPlan arc;
    if (!plan_arc(request_->motion == G(3), words, settings, begin, arc)) {
        return false;
    }
    ProfileSegment segment;
    segment.isArc = true;
    segment.start = {begin.position[Z], begin.position[X]};
    segment.end = {end[Z], end[X]};
    segment.centre = {arc.first_centre, arc.second_centre};
    segment.turn = arc.rotation;
    request_->profile.push_back(segment);
    return true;
}

/// A: a fillet at the end of this move; C: a chamfer.
bool LatheCycles::take_corner_word(const BlockValues &values) {
    if (!values.has('a') && !values.has('c')) {
        return true;
    }
    const char name = values.has('a') ? 'a' : 'c';
    if (values.has('a') && values.has('c')) {
        return values.fail("A corner of the profile has either a fillet A or a chamfer C", 'c');
    }
    if (values.at(name) < 0.0) {
        return values.fail("The fillet A or chamfer C of a profile must not be negative", name);
    }
    if (!request_->profile.empty()) {
        request_->profile.back().fillet = values.at(name);
        request_->profile.back().is_chamfer = name == 'c';
    }
    return true;
}

bool LatheCycles::finish(State &state, CanonQueue &canon, Fault &fault) {
    const LatheRequest request = std::move(*request_);
    request_.reset();
    return cut(request, state, canon, fault);
}

bool LatheCycles::cut(const LatheRequest &request, State &state, CanonQueue &canon, Fault &fault) {
    const std::string name = code_name(request.code);
    const bool finishing = request.code == G(70);
    state.motion = G(1);
    state.cycle.running = false;
    state.comp.set_exit(false);
    const auto rapid = [](Point to) { return ProfileMove{true, false, to, {}, 1, -1}; };
    if (!send_profile_move(rapid({request.start[Z], request.start[X]}), {}, state, canon, fault)) {
        return false;
    }
    if (request.profile.size() < 2) {  // the profile contains only the move to its start
        return true;
    }
    const double tolerance = state.units == LengthUnits::MM ? TOLERANCE_MM : TOLERANCE_INCH;
    const bool is_roughed = roughed_ && roughed_->label == request.label;
    const std::expected<bool, std::string> isFacing =
        choose_facing(request, is_roughed ? std::optional(roughed_->isFacing) : std::nullopt, tolerance);
    std::expected<FramedProfile, std::string> framed =
        isFacing ? framed_profile(request.profile, *isFacing, tolerance) : std::unexpected(isFacing.error());
    if (!framed) {
        return fault.set(fmt::format("The profile of {} {}", name, framed.error()));
    }
    const bool side_needed = !finishing || request.distance > 0.0 || request.end_distance > 0.0;
    if (side_needed && !framed->frame.side_clear) {
        return refuse_side(request, framed->frame, name, state.isDiameter, fault);
    }
    ProfileSegment &entry = framed->profile.front();
    entry.start.x = std::fmin(entry.start.x, entry.end.x);
    const ProfileMove to_begin = rapid(entry.start);
    if (!send_profile_move(to_begin, framed->frame, state, canon, fault)) {
        return false;
    }
    RoughingPlan roughing = request.roughing;
    roughing.narrowest = 20.0 * tolerance;
    for (int pass = request.passes - 1; pass >= 0; --pass) {
        const double ahead = (request.distance - request.end_distance) * pass / request.passes;
        const double distance = finishing ? request.end_distance + ahead : request.distance;
        const bool is_leaving_cut = !finishing || pass > 0;
        Profile cut = contour_of(framed->profile, finishing && distance == 0.0, tolerance);
        if (is_leaving_cut && !isEndingAbove(cut)) {  // a profile without a shoulder ends at a layer
            add_way_out(cut, cut.front().start.y);
        }
        cut = offset_profile(cut, distance, tolerance);
        const Point begin = entry.start, back{begin.x, finishing ? clear_height(cut) : begin.y};
        if (is_leaving_cut) {
            add_way_out(cut, back.y);
        }
        std::optional<std::vector<ProfileMove>> moves =
            finishing ? finish_moves(cut) : rough_moves(cut, roughing);
        if (!moves) {
            return fault.set(fmt::format("{} would make more than a million moves: is I too small?", name));
        }
        if (finishing && pass > 0) {
            if (back.y > begin.y) {  // first moves above the contour
                moves->push_back(rapid(back));
            }
            moves->push_back(to_begin);
        }
        for (const ProfileMove &move : *moves) {
            if (!send_profile_move(move, framed->frame, state, canon, fault)) {
                return false;
            }
        }
    }
    if (!finishing) {
        roughed_ = {request.label, *isFacing};
    }
    return true;
}

}  // namespace mw::gcode::detail
