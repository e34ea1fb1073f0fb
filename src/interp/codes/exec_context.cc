// SPDX-License-Identifier: GPL-2.0-or-later
// M70 to M73: modes saved and restored, per level of call.
#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

bool isSamePose(const Pose &a, const Pose &b) {
    return a == b;
}

int coordinate_code(int index) {
    return index <= 6 ? 530 + 10 * index : 584 + index;
}

}  // namespace

void Executor::push_call() {
    parameters.push_call();
    saved_modes.push_call();
}

/// Fanuc-style calls have no arguments: #1 to #30 are the caller's own.
bool Executor::pop_call(bool isFanuc) {
    const std::optional<State> modes = saved_modes.pop_call();
    parameters.pop_call(isFanuc);
    remaps.end_above(saved_modes.depth());
    if (!modes) {
        return true;
    }
    keep_state();
    return restore_context(*modes);
}

void Executor::drop_calls(std::size_t depth) {
    for (std::size_t calls = saved_modes.depth(); calls > depth; --calls) {
        parameters.pop_call(false);
    }
    saved_modes.drop_calls(depth);
    remaps.end_above(depth);
    if (depth == 0) {
        lathe_.reset();
    }
}

bool Executor::do_context(const Code &code, const BlockValues &) {
    switch (code.number) {
    case 70: saved_modes.save(state); return true;
    case 73: saved_modes.save_until_return(state); return true;
    case 71: saved_modes.forget(); return true;
    default: break;
    }
    const State *const saved = saved_modes.saved();
    if (saved == nullptr) {
        return fault.set(
            "M72 has nothing to restore: there is no M70 or M73 at this level, or M71 dropped it");
    }
    return restore_context(*saved);
}

/// Runs one code as if it stood alone.
bool Executor::run_code(char letter_char, int number, BlockValues values) {
    const Code &code = *find_code(letter_char, number);
    return (this->*code.handler)(code, values);
}

/// Those of motion and geometry, in the order of execution.
bool Executor::restore_geometry(const State &saved) {
    bool isDone = true;
    const BlockValues none;
    if (saved.plane != state.plane) {
        state.plane = saved.plane;
        canon.take(SelectPlane{state.plane});
    }
    if (saved.isDiameter != state.isDiameter) {
        isDone = run_code('g', saved.isDiameter ? 70 : 80, none);
    }
    if (saved.comp == CompSide::OFF && state.comp != CompSide::OFF) {
        isDone = isDone && run_code('g', 400, none);
    }
    const double length_factor =
        saved.units == state.units ? 1.0 : (state.units == LengthUnits::MM ? 25.4 : 1 / 25.4);
    const Pose offset = scale_lengths(saved.tool_offset, length_factor);
    if (!isSamePose(offset, state.tool_offset)) {
        apply_tool_offset(offset, saved.tool_offset_code);
    }
    state.tool_offset_code = saved.tool_offset_code;
    if (saved.g5x_index != state.g5x_index) {
        isDone = isDone && run_code('g', coordinate_code(saved.g5x_index), none);
    }
    BlockValues control;
    if (saved.control == geom::PathMode::BLEND) {
        control.present = letters("pq");
        control.value[letter('p')] = saved.tolerance;
        control.value[letter('q')] = saved.naivecam;
    }
    const int control_code = saved.control == geom::PathMode::BLEND        ? 640
                             : saved.control == geom::PathMode::EXACT_PATH ? 610
                                                                           : 611;
    isDone = isDone && run_code('g', control_code, control);
    isDone = isDone && run_code('g', saved.isIncremental ? 910 : 900, none);
    isDone = isDone && run_code('g', saved.isCentreAbsolute ? 901 : 911, none);
    if (saved.isRetractToR != state.isRetractToR) {
        isDone = isDone && run_code('g', saved.isRetractToR ? 990 : 980, none);
    }
    return isDone;
}

bool Executor::restore_spindles(const State &saved) {
    for (int i = 0; i < world_.count_spindles(); ++i) {
        const SpindleState &want = saved.spindles[static_cast<std::size_t>(i)];
        SpindleState &have = state.spindles[static_cast<std::size_t>(i)];
        if (want.isConstantSurface != have.isConstantSurface || want.css_max_rpm != have.css_max_rpm) {
            have.isConstantSurface = want.isConstantSurface;
            have.css_max_rpm = want.css_max_rpm;
            canon.take(SetSpindleMode{i, want.css_max_rpm});
        }
    }
    if (saved.feed_mode != state.feed_mode) {
        const int code = saved.feed_mode == FeedMode::INVERSE_TIME       ? 930
                         : saved.feed_mode == FeedMode::UNITS_PER_MINUTE ? 940
                                                                         : 950;
        BlockValues chosen;
        chosen.present = letters("$");
        chosen.value[LETTER_DOLLAR] = saved.active_spindle;
        if (!run_code('g', code, chosen)) {
            return false;
        }
    }
    state.active_spindle = saved.active_spindle;
    state.feed = saved.feed;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {  // there each move has a rate of its own
        canon.take(SetFeedRate{state.feed});
    }
    for (int i = 0; i < world_.count_spindles(); ++i) {
        const SpindleState &want = saved.spindles[static_cast<std::size_t>(i)];
        SpindleState &have = state.spindles[static_cast<std::size_t>(i)];
        have.speed = want.speed;
        canon.take(SetSpindleSpeed{i, want.speed});
        if (want.direction != have.direction) {
            have.direction = want.direction;
            if (want.direction != 0) {
                canon.take(StartSpindle{i, want.direction > 0, true});
            } else {
                canon.take(StopSpindle{i});
            }
        }
    }
    return true;
}

void Executor::restore_overrides(const State &saved) {
    if (saved.isFeedOverride != state.isFeedOverride) {
        canon.take(SwitchFeedOverride{saved.isFeedOverride});
    }
    for (int i = 0; i < world_.count_spindles(); ++i) {
        const SpindleState &want = saved.spindles[static_cast<std::size_t>(i)];
        SpindleState &have = state.spindles[static_cast<std::size_t>(i)];
        if (want.isOverridden != have.isOverridden) {
            have.isOverridden = want.isOverridden;
            canon.take(SwitchSpeedOverride{i, want.isOverridden});
        }
    }
    if (saved.isAdaptive != state.isAdaptive) {
        canon.take(SwitchAdaptiveFeed{saved.isAdaptive});
    }
    if (saved.isFeedHold != state.isFeedHold) {
        canon.take(SwitchFeedHold{saved.isFeedHold});
    }
    state.isFeedOverride = saved.isFeedOverride;
    state.isAdaptive = saved.isAdaptive;
    state.isFeedHold = saved.isFeedHold;
}

/// Positions, motion mode, tool and offsets of coordinate systems stay what they are.
bool Executor::restore_context(const State &wanted) {
    const State saved = wanted;
    if (saved.units != state.units && !run_code('g', saved.units == LengthUnits::INCH ? 200 : 210, {})) {
        return false;
    }
    if (!restore_spindles(saved)) {
        return false;
    }
    if (saved.isMist && !state.isMist && !run_code('m', 7, {})) {
        return false;
    }
    if (!restore_geometry(saved)) {
        return false;
    }
    if (!saved.isMist && !saved.isFlood && (state.isMist || state.isFlood)) {
        run_code('m', 9, {});
    }
    if (state.isMist && !saved.isMist) {
        state.isMist = false;
        canon.take(SwitchMist{false});
    }
    if (state.isFlood && !saved.isFlood) {
        state.isFlood = false;
        canon.take(SwitchFlood{false});
    }
    if (saved.isFlood && !state.isFlood) {
        run_code('m', 8, {});
    }
    restore_overrides(saved);
    return true;
}

}  // namespace mw::interp::detail
