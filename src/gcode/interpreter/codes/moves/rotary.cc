// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "gcode/interpreter/codes/moves/moves.hh"

namespace mw::gcode::detail {
namespace {

constexpr double TURN = 360;
/// Angles closer than this are equal: sums of angles are rounded. [degrees]
constexpr double SAME_ANGLE = 1e-6;

/// True if G91 applies; G90 and G91 apply from their own block on.
bool isIncremental(const BlockValues &values, const State &state) {
    bool is = state.incremental;
    for (const ActiveCode &active : values.codes) {
        is = active.code->id == G(91) || (is && active.code->id != G(90));
    }
    return is;
}

/// True for axis words that are positions: those of moves, and of the path to G28 and G30.
bool areAxesPlaces(const BlockValues &values) {
    bool are = values.motion != nullptr;
    for (const ActiveCode &active : values.codes) {
        are = are || active.code->id == G(28) || active.code->id == G(30);
    }
    return are;
}

bool check_indexer(const BlockValues &values, int axis) {
    const char name = geometry::AXIS_LETTERS_LOWER[axis];
    const bool placed = values.has(name) && values.motion != nullptr;
    if (!placed) {
        return true;
    }
    if (values.motion->id != G(0)) {
        return values.fail(
            fmt::format("Indexing axis {} can only be moved with G0", geometry::AXIS_LETTERS[axis]), name);
    }
    bool alone = !values.has('@') && !values.has('^');
    for (int other = 0; other < geometry::AXIS_COUNT; ++other) {
        alone = alone && (other == axis || !values.has(geometry::AXIS_LETTERS_LOWER[other]));
    }
    return alone ||
           values.fail(fmt::format("Indexing axis {} can only be moved alone", geometry::AXIS_LETTERS[axis]),
                       name);
}

}  // namespace

bool check_rotary(const BlockValues &values, const State &state) {
    if (!state.rotary.hasAny() || !values.hasAxes() || !areAxesPlaces(values)) {
        return true;
    }
    const bool absolute = !isIncremental(values, state);
    for (int axis = RotaryAxes::FIRST; axis <= RotaryAxes::LAST; ++axis) {
        const char name = geometry::AXIS_LETTERS_LOWER[axis];
        const bool wrapped = absolute && state.rotary.isWrapped(axis) && values.has(name);
        if (wrapped && !(std::fabs(values.at(name)) < TURN)) {
            return values.fail(
                fmt::format("Invalid absolute position {:.2f} for wrapped rotary axis {}: it must be "
                            "between -360 and 360, and its sign is the direction",
                            values.at(name), geometry::AXIS_LETTERS[axis]),
                name);
        }
        if (state.rotary.isIndexer(axis) && !check_indexer(values, axis)) {
            return false;
        }
    }
    return true;
}

double unwrapped(double word, double here) {
    const double angle = std::fabs(word);
    const double turns = (here - angle) / TURN;
    constexpr double SAME = SAME_ANGLE / TURN;
    return angle + TURN * (std::signbit(word) ? std::floor(turns + SAME) : std::ceil(turns - SAME));
}

double unwrapped_place(double place, double here) {
    const double angle = std::fmod(place, TURN);
    return unwrapped(angle < 0 ? angle + TURN : std::fabs(angle), here);
}

void take_indexing(const Pose &end, const State &state, CanonQueue &canon) {
    const geometry::PathMode control = state.control;
    const bool changing = control != geometry::PathMode::EXACT_PATH;
    if (changing) {
        canon.take(SetMotionControlMode{geometry::PathMode::EXACT_PATH, 0.0});
    }
    canon.take(StraightTraverse{end});
    if (changing) {
        canon.take(
            SetMotionControlMode{control, control == geometry::PathMode::BLEND ? state.tolerance : 0.0});
        canon.take(SetNaivecamTolerance{state.naivecam});
    }
}

void take_rapid(const Pose &end, State &state, CanonQueue &canon) {
    for (int axis = RotaryAxes::FIRST; axis <= RotaryAxes::LAST; ++axis) {
        if (state.rotary.isIndexer(axis) && end[axis] != state.position[axis]) {
            state.position[axis] = end[axis];
            take_indexing(state.position, state, canon);
        }
    }
    canon.take(StraightTraverse{end});
    state.position = end;
}

}  // namespace mw::gcode::detail
