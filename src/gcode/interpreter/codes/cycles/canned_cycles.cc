// SPDX-License-Identifier: GPL-2.0-or-later
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_functions.hh"
#include "gcode/interpreter/codes/moves/moves.hh"
#include "gcode/interpreter/codes/step_count.hh"

namespace mw::gcode::detail {
namespace {

constexpr double MM_PER_INCH = 25.4;

bool isCycle(GCode motion) {
    return motion == G(73) || motion == G(74) || (motion >= G(81) && motion <= G(89));
}

bool needsDwell(GCode code) {
    return code == G(82) || code == G(86) || code == G(88) || code == G(89);
}

bool needsPeck(GCode code) {
    return code == G(73) || code == G(83);
}

bool needsSpindle(GCode code) {
    return code == G(74) || code == G(84) || (code >= G(86) && code <= G(88));
}

/// Reads the words of a cycle. Missing words keep the values of the previous cycle; the first cycle of its
/// type needs all of them.
bool take_cycle_words(GCode code, const BlockValues &values, State &state) {
    const bool first = state.motion != code;
    const char depth = geometry::AXIS_LETTERS_LOWER[plane_axes(state.plane).normal];
    const std::string name = code_name(code);
    CycleWords &cycle = state.cycle;
    struct Need {
        char word;
        bool needed;
        const char *text;
        double &value;
    };
    const Need needs[] = {
        {depth, true, "the depth", cycle.bottom},
        {'r', true, "R, the clearance plane,", cycle.r},
        {'p', needsDwell(code), "P, the dwell time,", cycle.p},
        {'q', needsPeck(code), "Q, the peck depth,", cycle.q},
        {'i', code == G(87), "I", cycle.i},
        {'j', code == G(87), "J", cycle.j},
        {'k', code == G(87), "K", cycle.k},
    };
    for (const Need &need : needs) {
        if (values.has(need.word)) {
            const bool halved = need.word == 'x' && state.isDiameter;
            need.value = values.at(need.word) * (halved ? 0.5 : 1.0);
        } else if (first && need.needed) {
            return values.fail(fmt::format("{} needs {}{}", name, need.text,
                                           need.word == depth
                                               ? fmt::format(" {}", static_cast<char>(std::toupper(depth)))
                                               : std::string()));
        }
    }
    cycle.has_clearance = needsPeck(code) && (values.has('p') || (cycle.has_clearance && !first));
    if (needsPeck(code) && cycle.q <= 0.0) {
        return values.fail(fmt::format("The peck depth Q of {} must be above 0", name), 'q');
    }
    if (cycle.p < 0.0) {
        return values.fail(needsPeck(code) ? "The peck clearance P must not be negative"
                                           : "The dwell time P must not be negative",
                           'p');
    }
    return true;
}

bool check_cycle(GCode code, const BlockValues &values, State &state, const CodeParts &parts, int &repeats) {
    static constexpr char OTHER_AXES[] = "abcuvw";
    for (const char c : std::string_view(OTHER_AXES)) {
        if (values.has(c)) {
            return values.fail(fmt::format("Cannot put an {} in canned cycle", c), c);
        }
    }
    if (plane_axes(state.plane).normal > geometry::AXIS_Z) {
        return values.fail("Canned cycles need one of the planes G17, G18 or G19");
    }
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        return values.fail("Cannot use inverse time feed with canned cycles");
    }
    if (state.comp.isOn()) {
        return values.fail("Cannot use canned cycles with cutter radius compensation on");
    }
    if (state.feed == 0.0) {
        return values.fail(fmt::format("Cannot do {} with zero feed rate", code_name(code)));
    }
    if (!check_feed_per_revolution(values, state)) {
        return false;
    }
    repeats = 1;
    if (values.has('l')) {
        if (!values.whole('l', repeats)) {
            return false;
        }
        if (repeats < 1) {
            return values.fail("The number of repeats L of a canned cycle must be at least 1", 'l');
        }
    }
    if (values.has('$')) {
        int chosen = 0;
        if (!values.spindle(parts.count_spindles(), chosen)) {
            return false;
        }
        if (chosen < 0) {
            return values.fail(fmt::format("{} is for one spindle: $ must not be negative", code_name(code)),
                               '$');
        }
        state.active_spindle = chosen;
    }
    const SpindleState &spindle = state.spindles[static_cast<std::size_t>(state.active_spindle)];
    if (needsSpindle(code) && spindle.direction == 0) {
        return values.fail(fmt::format("Spindle not turning in {}", code_name(code)));
    }
    if ((code == G(84) && spindle.direction < 0) || (code == G(74) && spindle.direction > 0)) {
        return values.fail(fmt::format("The spindle turns in the wrong direction for {}: program {} first",
                                       code_name(code), code == G(84) ? "M3" : "M4"));
    }
    return true;
}

/// One cycle with absolute heights, program coordinates along the plane's normal.
struct CyclePlan {
    GCode code{};
    double r = 0, bottom = 0, clear = 0;
};

/// Number of pecks of G73 and G83 from R to the bottom, at least one.
double count_pecks(const CyclePlan &plan, double peck) {
    const double error = FIGURE_ERROR * (std::fabs(plan.r) + std::fabs(plan.bottom)) / peck;
    const double pecks = (plan.r - plan.bottom) / peck;
    return std::fmax(1.0, count_steps(pecks, error + FIGURE_ERROR * pecks));
}

/// Moves of the cycles at one hole.
struct CycleMoves {
    const Settings &settings;
    State &state;
    CanonQueue &canon;

    void cycle_move(bool rapid, int axis, double value);
    void start_spindle(int direction);
    void tap_move(double height);
    void run_cycle(const CyclePlan &plan);
    void run_peck(const CyclePlan &plan);
    void run_tap(const CyclePlan &plan, int direction);
    void run_back_bore(const CyclePlan &plan, int direction);
};

/// Moves one axis to `value`.
void CycleMoves::cycle_move(bool rapid, int axis, double value) {
    state.position[axis] = value;
    if (rapid) {
        canon.take(StraightTraverse{state.position});
    } else {
        canon.take(StraightFeed{state.position});
    }
}

void CycleMoves::start_spindle(int direction) {
    const int spindle = state.active_spindle;
    canon.take(StartSpindle{spindle, direction > 0, true});
}

/// Moves from the clearance plane to the bottom and back to plan.clear.
void CycleMoves::run_cycle(const CyclePlan &plan) {
    const int normal = plane_axes(state.plane).normal;
    const int direction = state.spindles[static_cast<std::size_t>(state.active_spindle)].direction;
    switch (plan.code) {
    case G(73):
    case G(83): run_peck(plan); return;
    case G(74):
    case G(84): run_tap(plan, direction); return;
    case G(87): run_back_bore(plan, direction); return;
    default: break;
    }
    cycle_move(false, normal, plan.bottom);
    if (needsDwell(plan.code)) {
        canon.take(Dwell{state.cycle.p});
    }
    switch (plan.code) {
    case G(85):
        cycle_move(false, normal, plan.r);
        cycle_move(true, normal, plan.clear);
        break;
    case G(86):
        canon.take(StopSpindle{state.active_spindle});
        cycle_move(true, normal, plan.clear);
        start_spindle(direction);
        break;
    case G(88):  // G88: the operator retracts by hand to the clear height
        canon.take(StopSpindle{state.active_spindle});
        canon.take(ProgramStop{});
        start_spindle(direction);
        state.position[normal] = plan.clear;
        break;
    case G(89): cycle_move(false, normal, plan.clear); break;
    default: cycle_move(true, normal, plan.clear); break;
    }
}

/// G73 breaks chips, G83 retracts to R each time.
void CycleMoves::run_peck(const CyclePlan &plan) {
    const int normal = plane_axes(state.plane).normal;
    const bool deep = plan.code == G(83);
    const double clearance_mm =
        deep ? settings.parameter_g83_peck_clearance_mm : settings.parameter_g73_peck_clearance_mm;
    const double configured = clearance_mm / (state.units == LengthUnits::MM ? 1.0 : MM_PER_INCH);
    const double clearance = state.cycle.has_clearance ? state.cycle.p : configured;
    const double pecks = count_pecks(plan, state.cycle.q);
    for (int peck = 1; peck < static_cast<int>(pecks); ++peck) {
        const double depth = plan.r - peck * state.cycle.q;
        cycle_move(false, normal, depth);
        if (deep) {
            cycle_move(true, normal, plan.r);
        }
        cycle_move(true, normal, depth + clearance);
    }
    cycle_move(false, normal, plan.bottom);
    cycle_move(true, normal, plan.clear);
}

/// The two feed moves of a tap, along the plane's normal. LinuxCNC's rs274 converts plane coordinates to
/// machine coordinates twice in G18 and G19: such a move would drag the tap through the part, so only the
/// printed output follows it.
void CycleMoves::tap_move(double height) {
    const int normal = plane_axes(state.plane).normal;
    state.position[normal] = height;
    const Pose &place = state.position;
    Pose sent = place;
    const bool turned_twice = settings.tap_order_of_rs274 && normal != geometry::AXIS_Z;
    for (int axis = geometry::AXIS_X; axis <= geometry::AXIS_Z && turned_twice; ++axis) {
        constexpr int LENGTHS = 3;
        sent[axis] = place[(axis + (normal == geometry::AXIS_Y ? 1 : 2)) % LENGTHS];
    }
    canon.take(StraightFeed{sent});
}

/// Tapping with a floating chuck: the spindle reverses at the bottom.
void CycleMoves::run_tap(const CyclePlan &plan, int direction) {
    const int spindle = state.active_spindle;
    const bool is_speed_override = state.spindles[static_cast<std::size_t>(spindle)].overridden;
    canon.take(SwitchFeedOverride{false});
    canon.take(SwitchSpeedOverride{spindle, false});
    tap_move(plan.bottom);
    canon.take(StopSpindle{spindle});
    start_spindle(-direction);
    canon.take(Dwell{state.cycle.p});
    tap_move(plan.clear);
    canon.take(StopSpindle{spindle});
    start_spindle(direction);
    if (state.is_feed_override) {
        canon.take(SwitchFeedOverride{true});
    }
    if (is_speed_override) {
        canon.take(SwitchSpeedOverride{spindle, true});
    }
}

/// G87: with the oriented tool through the hole beside its axis, then cuts from below up to K.
void CycleMoves::run_back_bore(const CyclePlan &plan, int direction) {
    const PlaneAxes axes = plane_axes(state.plane);
    const int spindle = state.active_spindle;
    constexpr int COUNTERCLOCKWISE = 2;
    const Pose on_axis = state.position;
    const double along_first = axes.normal == geometry::AXIS_X ? state.cycle.j : state.cycle.i;
    const double along_second = axes.normal == geometry::AXIS_Z ? state.cycle.j : state.cycle.k;
    const auto shift = [&](bool beside) {
        const int a = axes.normal == geometry::AXIS_Y ? geometry::AXIS_X : axes.first;
        const int b = axes.normal == geometry::AXIS_Y ? geometry::AXIS_Z : axes.second;
        state.position[a] = on_axis[a] + (beside ? along_first : 0.0);
        state.position[b] = on_axis[b] + (beside ? along_second : 0.0);
        canon.take(StraightTraverse{state.position});
    };
    const double up = axes.normal == geometry::AXIS_Z
                          ? state.cycle.k
                          : (axes.normal == geometry::AXIS_Y ? state.cycle.j : state.cycle.i);
    const double top = up + (state.incremental ? plan.bottom : 0.0);
    const auto orient = [&] {
        constexpr double PATIENCE_S = 60.0;
        canon.take(StopSpindle{spindle});
        canon.take(OrientSpindle{spindle, 0.0, COUNTERCLOCKWISE});
        if (settings.is_task) {  // LinuxCNC's rs274 prints no call for the wait
            canon.take(WaitOrientComplete{spindle, PATIENCE_S});
        }
    };
    shift(true);
    orient();
    cycle_move(true, axes.normal, plan.bottom);
    shift(false);
    start_spindle(direction);
    cycle_move(false, axes.normal, top);
    cycle_move(false, axes.normal, plan.bottom);
    orient();
    shift(true);
    cycle_move(true, axes.normal, plan.clear);
    shift(false);
    start_spindle(direction);
}

}  // namespace

Effect run_canned_cycle(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    int repeats = 1;
    if (!values.hasAxes() && values.motion_implied) {
        return true;
    }
    if (!check_cycle(code, values, state, parts, repeats) || !take_cycle_words(code, values, state)) {
        return false;
    }
    const PlaneAxes axes = plane_axes(state.plane);
    const char normal_name = geometry::AXIS_LETTERS_LOWER[axes.normal];
    if (!isCycle(state.motion) || !state.cycle.running) {
        state.cycle.initial = state.position[axes.normal];
    }
    CycleMoves moves{parts.settings, state, parts.canon};
    CyclePlan plan;
    plan.code = code;
    // Incremental R is relative to the start of the sequence of cycles, so that all holes have the same
    // depth.
    plan.r = state.cycle.r + (state.incremental ? state.cycle.initial : 0.0);
    plan.bottom = state.cycle.bottom + (state.incremental ? plan.r : 0.0);
    if (plan.r < plan.bottom) {
        return values.fail(fmt::format("R value less than {} value in cycle", normal_name), 'r');
    }
    constexpr double MOST_MOVES = 1e6;  // more moves are probably a typing error
    const double pecks = needsPeck(code) ? count_pecks(plan, state.cycle.q) : 1.0;
    if (pecks * repeats > MOST_MOVES) {
        return values.fail(
            "This canned cycle would make more than a million moves: is L too large or Q too small?",
            pecks > repeats ? 'q' : 'l');
    }
    state.motion = code;
    state.cycle.running = true;
    Pose goal = target(values, state);
    if (!polar_target(values, state, goal)) {
        return false;
    }
    const geometry::PathMode control = state.control;
    // If a sequence began below R, every cycle makes this move; it has length zero except in the first cycle.
    const double height = state.position[axes.normal];
    if (height < plan.r || (height == plan.r && state.cycle.initial < plan.r)) {
        moves.cycle_move(true, axes.normal, plan.r);
    }
    if (control != geometry::PathMode::EXACT_PATH) {
        parts.canon.take(SetMotionControlMode{geometry::PathMode::EXACT_PATH, 0.0});
    }
    for (int i = 0; i < repeats; ++i) {
        plan.clear = state.retract_to_r ? plan.r : std::fmax(state.cycle.initial, plan.r);
        if (state.incremental && i > 0) {  // each repeat continues from the last hole, also with polar words
            goal = target(values, state);
            if (!polar_target(values, state, goal)) {
                return false;
            }
        }
        Pose over = state.position;
        over[axes.first] = goal[axes.first];
        over[axes.second] = goal[axes.second];
        over[axes.normal] = std::fmax(state.position[axes.normal], plan.clear);
        parts.canon.take(StraightTraverse{over});
        state.position = over;
        if (over[axes.normal] != plan.r) {
            moves.cycle_move(true, axes.normal, plan.r);
        }
        moves.run_cycle(plan);
    }
    if (control != geometry::PathMode::EXACT_PATH) {
        parts.canon.take(
            SetMotionControlMode{control, control == geometry::PathMode::BLEND ? state.tolerance : 0.0});
        parts.canon.take(SetNaivecamTolerance{state.naivecam});
    }
    return true;
}

}  // namespace mw::gcode::detail
