// SPDX-License-Identifier: GPL-2.0-or-later
// Moves in step with the spindle (G33, G33.1, G76) and probing (G38.2 to G38.5).
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

constexpr int MAX_PASSES = 10000;

constexpr double DEGREE = std::numbers::pi / 180.0;

}  // namespace

/// The feed that the pitch makes at the programmed speed must be within the machine's.
bool Executor::check_pitch(int spindle, double pitch, std::uint32_t column) {
    const SpindleState &turning = state.spindles[static_cast<std::size_t>(spindle)];
    if (settings_.max_velocity_mm_s <= 0.0 || turning.isConstantSurface) {
        return true;
    }
    constexpr double MM_PER_INCH = 25.4, SECONDS_PER_MINUTE = 60.0;
    const double unit = state.units == LengthUnits::MM ? 1.0 : MM_PER_INCH;
    const double needed = std::fabs(pitch) * unit * turning.speed / SECONDS_PER_MINUTE;
    if (needed <= settings_.max_velocity_mm_s) {
        return true;
    }
    return fault.set(
        fmt::format("A pitch of {:g} at {:g} turns a minute needs {:.4g} mm/s; the machine's limit is "
                    "{:.4g} mm/s",
                    pitch, turning.speed, needed, settings_.max_velocity_mm_s),
        column, "turn the spindle more slowly");
}

/// G33 (a synchronised straight move) and G33.1 (rigid tapping: there and back).
bool Executor::do_thread(const Code &code, const BlockValues &values) {
    int spindle = 0;
    const std::string name = code_name(code);
    if (!spindle_of(values, spindle)) {
        return false;
    }
    if (!values.hasAxes()) {
        return fault.set("All axes missing with motion code");
    }
    if (spindle < 0) {
        return fault.set(fmt::format("{} follows one spindle: $ must not be negative", name),
                         values.column_of('$'));
    }
    if (state.comp != CompSide::OFF) {
        return fault.set(fmt::format("Cannot do {} with cutter radius compensation on", name));
    }
    if (state.spindles[static_cast<std::size_t>(spindle)].direction == 0) {
        return fault.set(fmt::format("Spindle not turning in {}", name));
    }
    if (values.at('k') == 0.0) {
        return fault.set(fmt::format("The pitch K of {} must not be 0", name), values.column_of('k'));
    }
    Pose end;
    if (!check_pitch(spindle, values.at('k'), values.column_of('k')) || !straight_target(values, end)) {
        return false;
    }
    state.motion = code.number;
    state.cycle.isRunning = state.isCompExit = false;
    canon.take(StartSpeedFeedSynch{spindle, values.at('k'), false});
    if (code.number == 330) {
        canon.take(StraightFeed{end});
        state.position = end;
    } else {
        constexpr double SAME_SPEED = 1.0;
        canon.take(
            RigidTap{end[geom::AXIS_X], end[geom::AXIS_Y], end[geom::AXIS_Z], values.at('i', SAME_SPEED)});
    }
    canon.take(StopSpeedFeedSynch{});
    return true;
}

bool Executor::do_probe(const Code &code, const BlockValues &values) {
    if (!values.hasAxes()) {
        return fault.set("All axes missing with motion code");
    }
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot probe with cutter radius comp on");
    }
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        return fault.set("Cannot probe in inverse time feed mode");
    }
    if (!check_feed(values, code_name(code))) {
        return false;
    }
    Pose end;
    if (!straight_target(values, end)) {
        return false;
    }
    if (end == state.position) {
        return fault.set("The probe would not move: start and end are the same");
    }
    state.motion = code.number;
    state.cycle.isRunning = state.isCompExit = false;
    canon.take(StraightProbe{end, static_cast<ProbeKind>(code.number - 382)});
    state.position = end;
    // Until the machine tells, as if it had got there without contact.
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        parameters.set(P_PROBE_RESULT + axis, end[axis]);
    }
    parameters.set(P_PROBE_SUCCESS, 0.0);
    awaited.isProbe = true;
    outcome = Outcome::SYNC;
    return true;
}

// ------------------------------------------------------------------------------------------------- G76

bool Executor::check_thread_cycle(const BlockValues &values, ThreadPlan &plan) {
    int taper = 0;
    plan.springs = 0;
    if (!spindle_of(values, plan.spindle) || (values.has('h') && !whole_word(values, 'h', plan.springs)) ||
        (values.has('l') && !whole_word(values, 'l', taper))) {
        return false;
    }
    plan.spindle = std::max(plan.spindle, 0);
    plan.pitch = values.at('p');
    plan.first_cut = values.at('j');
    plan.full_depth = values.at('k');
    plan.degression = values.at('r', 1.0);
    plan.taper_length = values.at('e', 0.0);
    plan.hasEntryTaper = (taper & 1) != 0;
    plan.hasExitTaper = (taper & 2) != 0;
    plan.tangent = std::tan(values.at('q', 0.0) * DEGREE);
    struct Check {
        bool isBad;
        char word;
        const char *text;
    };
    const Check checks[] = {
        {state.plane != Plane::XZ, 'z', "G76 needs the plane G18"},
        {values.has('x') || values.has('y') || values.has('a') || values.has('b') || values.has('c') ||
             values.has('u') || values.has('v') || values.has('w'),
         'x', "G76 takes no axis word but Z"},
        {plan.pitch <= 0.0, 'p', "The pitch P of G76 must be above 0"},
        {plan.first_cut <= 0.0, 'j', "The first cut J of G76 must be above 0"},
        {plan.full_depth <= 0.0, 'k', "The depth K of G76 must be above 0"},
        {plan.first_cut > plan.full_depth, 'j', "The first cut J of G76 must not be deeper than K"},
        {plan.degression < 1.0, 'r', "The degression R of G76 must be at least 1"},
        {plan.springs < 0 || plan.springs > MAX_PASSES, 'h',
         "The number of spring passes H of G76 must be 0 to 10000"},
        {taper < 0 || taper > 3, 'l', "The taper L of G76 must be 0, 1, 2 or 3"},
        {plan.taper_length < 0.0, 'e', "The taper length E of G76 must not be negative"},
        {taper != 0 && plan.taper_length == 0.0, 'l', "A taper L of G76 needs its length E"},
        {values.at('q', 0.0) < 0.0 || values.at('q', 0.0) > 80.0, 'q',
         "The angle Q of G76 must be 0 to 80 degrees"},
        {values.at('i') == 0.0, 'i', "The offset I of the thread peaks must not be 0"},
        {state.comp != CompSide::OFF, 'z', "Cannot do G76 with cutter radius compensation on"},
        {state.spindles[static_cast<std::size_t>(plan.spindle)].direction == 0, 'z',
         "Spindle not turning in G76"},
    };
    for (const Check &check : checks) {
        if (check.isBad) {
            return fault.set(check.text, values.column_of(check.word));
        }
    }
    return check_pitch(plan.spindle, plan.pitch, values.column_of('p'));
}

bool Executor::do_thread_cycle(const Code &code, const BlockValues &values) {
    ThreadPlan plan;
    if (!values.has('z')) {
        return fault.set("G76 needs the word Z, the end of the thread");
    }
    if (!check_thread_cycle(values, plan)) {
        return false;
    }
    const Pose start = state.position;
    plan.start_x = start[geom::AXIS_X];
    plan.start_z = start[geom::AXIS_Z];
    plan.end_z = target(values)[geom::AXIS_Z];
    const double scale = state.isDiameter ? 0.5 : 1.0;
    plan.peak_x = plan.start_x + values.at('i') * scale;
    plan.first_cut *= scale;
    plan.full_depth *= scale;
    plan.inward = values.at('i') < 0.0 ? -1.0 : 1.0;
    plan.along = plan.end_z < plan.start_z ? -1.0 : 1.0;
    const int tapers = (plan.hasEntryTaper ? 1 : 0) + (plan.hasExitTaper ? 1 : 0);
    if (tapers * plan.taper_length > std::fabs(plan.end_z - plan.start_z)) {
        return fault.set("The tapers of G76 are longer than the thread", values.column_of('e'));
    }
    state.motion = code.number;
    state.cycle.isRunning = state.isCompExit = false;
    double depth = plan.first_cut;
    for (int pass = 1; depth < plan.full_depth; ++pass) {
        if (pass > MAX_PASSES) {
            return fault.set("G76 would need more than 10000 passes: the first cut J is too small",
                             values.column_of('j'));
        }
        thread_pass(plan, depth);
        depth = plan.first_cut * std::pow(pass + 1, 1.0 / plan.degression);
    }
    for (int pass = 0; pass <= plan.springs; ++pass) {
        thread_pass(plan, plan.full_depth);
    }
    state.position = start;
    state.position[geom::AXIS_Z] = plan.end_z;
    canon.take(StraightTraverse{state.position});
    return true;
}

/// One cut at `depth` below the peaks, infeed along the flank.
void Executor::thread_pass(const ThreadPlan &plan, double depth) {
    const double rest = plan.full_depth - depth;
    const double cut_x = plan.peak_x + plan.inward * depth;
    const double safe_x = plan.start_x - plan.inward * rest;
    const double from_z = plan.start_z + plan.along * depth * plan.tangent;
    const double to_z = plan.end_z - plan.along * rest * plan.tangent;
    const double taper_x = cut_x - plan.inward * plan.full_depth;
    const double taper_pitch =
        plan.taper_length > 0.0
            ? plan.pitch * std::hypot(plan.full_depth, plan.taper_length) / plan.taper_length
            : plan.pitch;
    const auto go = [&](bool isRapid, double x, double z) {
        state.position[geom::AXIS_X] = x;
        state.position[geom::AXIS_Z] = z;
        isRapid ? canon.take(StraightTraverse{state.position}) : canon.take(StraightFeed{state.position});
    };
    go(true, safe_x, from_z);
    if (plan.hasEntryTaper) {
        canon.take(SwitchFeedOverride{false});
        canon.take(StartSpeedFeedSynch{plan.spindle, taper_pitch, false});
        go(false, taper_x, from_z);
        go(false, cut_x, from_z + plan.along * plan.taper_length);
        canon.take(StartSpeedFeedSynch{plan.spindle, plan.pitch, false});
    } else {
        go(true, cut_x, from_z);
        canon.take(SwitchFeedOverride{false});
        canon.take(StartSpeedFeedSynch{plan.spindle, plan.pitch, false});
    }
    if (plan.hasExitTaper) {
        go(false, cut_x, to_z - plan.along * plan.taper_length);
        canon.take(StartSpeedFeedSynch{plan.spindle, taper_pitch, false});
        go(false, taper_x, to_z);
    } else {
        go(false, cut_x, to_z);
    }
    canon.take(StopSpeedFeedSynch{});
    go(true, safe_x, to_z);
    if (state.isFeedOverride) {
        canon.take(SwitchFeedOverride{true});
    }
}

}  // namespace mw::interp::detail
