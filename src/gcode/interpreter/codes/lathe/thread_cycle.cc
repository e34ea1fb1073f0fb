// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_functions.hh"
#include "gcode/interpreter/codes/moves/moves.hh"
#include "gcode/interpreter/codes/step_count.hh"

namespace mw::gcode::detail {
namespace {

constexpr int MAX_PASSES = 10000;

constexpr double DEGREE = std::numbers::pi / 180.0;

/// A thread to be cut [program units, radii].
struct ThreadPlan {
    int spindle = 0, springs = 0;
    double pitch = 0, first_cut = 0, full_depth = 0, degression = 1, taper_length = 0;
    double tangent = 0;  ///< tangent of the infeed angle
    double start_x = 0, start_z = 0, end_z = 0, peak_x = 0;
    double inward = 1;  ///< +1: cuts towards larger X
    double along = 1;   ///< sign of the cutting direction in Z
    bool has_entry_taper = false, has_exit_taper = false;
};

bool check_thread_cycle(const BlockValues &values, const State &state, const CodeParts &parts,
                        ThreadPlan &plan) {
    int taper = 0;
    plan.springs = 0;
    if (!values.spindle(parts.count_spindles(), plan.spindle) ||
        (values.has('h') && !values.whole('h', plan.springs)) ||
        (values.has('l') && !values.whole('l', taper))) {
        return false;
    }
    plan.spindle = std::max(plan.spindle, 0);
    plan.pitch = values.at('p');
    plan.first_cut = values.at('j');
    plan.full_depth = values.at('k');
    plan.degression = values.at('r', 1.0);
    plan.taper_length = values.at('e', 0.0);
    plan.has_entry_taper = (taper & 1) != 0;
    plan.has_exit_taper = (taper & 2) != 0;
    plan.tangent = std::tan(values.at('q', 0.0) * DEGREE);
    struct Check {
        bool bad;
        char word;
        const char *text;
    };
    const Check checks[] = {
        {state.plane != Plane::XZ, 'z', "G76 needs the plane G18"},
        {values.has('x') || values.has('y') || values.has('a') || values.has('b') || values.has('c') ||
             values.has('u') || values.has('v') || values.has('w'),
         'x', "G76 accepts only the axis word Z"},
        {plan.pitch <= 0.0, 'p', "The pitch P of G76 must be above 0"},
        {plan.first_cut <= 0.0, 'j', "The first cut J of G76 must be above 0"},
        {plan.full_depth <= 0.0, 'k', "The depth K of G76 must be above 0"},
        {plan.first_cut >= plan.full_depth, 'k', "In G76, K must be greater than J"},
        {plan.degression < 1.0, 'r', "The degression R of G76 must be at least 1"},
        {plan.springs < 0 || plan.springs > MAX_PASSES, 'h',
         "The number of spring passes H of G76 must be 0 to 10000"},
        {taper < 0 || taper > 3, 'l', "The taper L of G76 must be 0, 1, 2 or 3"},
        {plan.taper_length < 0.0, 'e', "The taper length E of G76 must not be negative"},
        {taper != 0 && plan.taper_length == 0.0, 'l', "A taper L of G76 needs its length E"},
        {values.at('q', 0.0) < 0.0 || values.at('q', 0.0) > 80.0, 'q',
         "The angle Q of G76 must be 0 to 80 degrees"},
        {values.at('i') == 0.0, 'i', "The offset I of the thread peaks must not be 0"},
        {state.comp.isOn(), 'z', "Cannot do G76 with cutter radius compensation on"},
        {state.spindles[static_cast<std::size_t>(plan.spindle)].direction == 0, 'z',
         "Spindle not turning in G76"},
    };
    for (const Check &check : checks) {
        if (check.bad) {
            return values.fail(check.text, check.word);
        }
    }
    return check_pitch(values, parts, state, plan.spindle, plan.pitch, 'p');
}

/// Number of passes without spring passes: the first n whose depth J * n^(1/R) reaches K, so n = (K / J)^R
/// rounded up. The tolerance is the rounding error of J, K and R, propagated through the power.
double count_passes(const ThreadPlan &plan) {
    const double ratio = plan.full_depth / plan.first_cut;
    const double passes = std::pow(ratio, plan.degression);
    return count_steps(passes, passes * FIGURE_ERROR * (1.0 + plan.degression * (2.0 + std::log(ratio))));
}

/// One cut at `depth` below the crests, with infeed along the flank.
void thread_pass(const ThreadPlan &plan, double depth, State &state, CanonQueue &canon) {
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
    const auto go = [&](bool rapid, double x, double z) {
        state.position[geometry::AXIS_X] = x;
        state.position[geometry::AXIS_Z] = z;
        rapid ? canon.take(StraightTraverse{state.position}) : canon.take(StraightFeed{state.position});
    };
    go(true, safe_x, from_z);
    if (plan.has_entry_taper) {
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
    if (plan.has_exit_taper) {
        go(false, cut_x, to_z - plan.along * plan.taper_length);
        canon.take(StartSpeedFeedSynch{plan.spindle, taper_pitch, false});
        go(false, taper_x, to_z);
    } else {
        go(false, cut_x, to_z);
    }
    canon.take(StopSpeedFeedSynch{});
    go(true, safe_x, to_z);
    if (state.is_feed_override) {
        canon.take(SwitchFeedOverride{true});
    }
}

}  // namespace

Effect cut_thread(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    ThreadPlan plan;
    if (!values.has('z')) {
        return values.fail("G76 needs the word Z, the end of the thread");
    }
    if (!check_thread_cycle(values, state, parts, plan)) {
        return false;
    }
    const Pose start = state.position;
    plan.start_x = start[geometry::AXIS_X];
    plan.start_z = start[geometry::AXIS_Z];
    plan.end_z = target(values, state)[geometry::AXIS_Z];
    const double scale = state.isDiameter ? 0.5 : 1.0;
    plan.peak_x = plan.start_x + values.at('i') * scale;
    plan.first_cut *= scale;
    plan.full_depth *= scale;
    plan.inward = values.at('i') < 0.0 ? -1.0 : 1.0;
    plan.along = plan.end_z < plan.start_z ? -1.0 : 1.0;
    const int tapers = (plan.has_entry_taper ? 1 : 0) + (plan.has_exit_taper ? 1 : 0);
    if (tapers * plan.taper_length > std::fabs(plan.end_z - plan.start_z)) {
        return values.fail("The tapers of G76 are longer than the thread", 'e');
    }
    const double passes = count_passes(plan);
    if (!(passes <= MAX_PASSES)) {
        return values.fail("G76 would need more than 10000 passes: the first cut J is too small", 'j');
    }
    state.motion = code;
    state.cycle.running = false;
    state.comp.set_exit(false);
    for (int pass = 1; pass < static_cast<int>(passes); ++pass) {
        thread_pass(plan, plan.first_cut * std::pow(pass, 1.0 / plan.degression), state, parts.canon);
    }
    for (int pass = 0; pass <= plan.springs; ++pass) {
        thread_pass(plan, plan.full_depth, state, parts.canon);
    }
    state.position = start;
    state.position[geometry::AXIS_Z] = plan.end_z;
    parts.canon.take(StraightTraverse{state.position});
    return true;
}

}  // namespace mw::gcode::detail
