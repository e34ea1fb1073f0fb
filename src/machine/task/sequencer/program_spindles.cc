// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/program_spindles.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "gcode/canon/surface_speed.hh"

namespace mw::task {

void ProgramSpindles::send(int spindle, MotionLink &motion) {
    const Spindle &state = at(spindle);
    motion::SpindleOn on;
    on.spindle = spindle;
    on.css_max_rpm = state.css_max_rpm;
    on.isWaitingForSpeed = state.waiting;
    if (state.css_max_rpm > 0) {
        // Constant surface speed: the motion controller divides it by the radius.
        on.css_factor = state.direction * gcode::surface_speed_factor(state.speed, state.surface_unit);
        on.css_x_offset = centre_line_x_;
        on.speed_rpm = state.direction * state.css_max_rpm;
    } else {
        on.speed_rpm = state.direction * state.speed;
    }
    motion.send(on);
    set_awaited(spindle, state.waiting);
}

void ProgramSpindles::set_awaited(int spindle, bool awaited) {
    const std::uint32_t bit = 1U << spindle;
    awaited_ = awaited ? awaited_ | bit : awaited_ & ~bit;
}

void ProgramSpindles::set_mode(const gcode::SetSpindleMode &mode) {
    at(mode.spindle).css_max_rpm = mode.css_max_rpm;
}

void ProgramSpindles::set_speed(const gcode::UseSpindleSpeed &speed, MotionLink &motion) {
    Spindle &state = at(speed.spindle);
    const bool is_new = state.speed != speed.speed || state.surface_unit != speed.surface_unit;
    state.speed = speed.speed;
    state.surface_unit = speed.surface_unit;
    if (is_new && state.direction != 0) {
        send(speed.spindle, motion);
    }
}

void ProgramSpindles::start(const gcode::StartSpindle &start, MotionLink &motion) {
    Spindle &state = at(start.spindle);
    state.direction = start.direction();
    state.waiting = start.waiting;
    send(start.spindle, motion);
}

void ProgramSpindles::stop(const gcode::StopSpindle &stop, MotionLink &motion) {
    at(stop.spindle).direction = 0;
    set_awaited(stop.spindle, false);
    motion.send(motion::SpindleOff{stop.spindle});
}

void ProgramSpindles::command(int spindle, double signed_rpm, bool waiting, MotionLink &motion) {
    Spindle &state = at(spindle);
    state.css_max_rpm = 0;
    state.direction = signed_rpm > 0 ? 1 : (signed_rpm < 0 ? -1 : 0);
    state.waiting = waiting;
    if (state.direction == 0) {
        stop({spindle}, motion);
        return;
    }
    state.speed = std::fabs(signed_rpm);
    send(spindle, motion);
}

Result<double> ProgramSpindles::stepped_rpm(int spindle, double step_rpm) const {
    constexpr double SLOWEST_RPM = 1;
    const Spindle &state = spindles_[static_cast<std::size_t>(spindle)];
    if (state.direction == 0) {
        return fail(fmt::format("spindle {} is stopped", spindle));
    }
    if (state.css_max_rpm > 0) {
        return fail(fmt::format("spindle {} is in constant surface speed mode (G96)", spindle));
    }
    return state.direction * std::max(SLOWEST_RPM, state.speed + step_rpm);
}

std::vector<gcode::MachineCall> ProgramSpindles::starts() const {
    std::vector<gcode::MachineCall> calls;
    for (int i = 0; i < MAX_SPINDLES; ++i) {
        const Spindle &state = spindles_[static_cast<std::size_t>(i)];
        if (state.direction != 0) {
            calls.emplace_back(gcode::SetSpindleMode{i, state.css_max_rpm});
            calls.emplace_back(gcode::UseSpindleSpeed{i, state.speed, state.surface_unit});
            calls.emplace_back(gcode::StartSpindle{i, state.direction > 0, true});
        }
    }
    return calls;
}

bool ProgramSpindles::isKeptBy(const ProgramSpindles &other) const {
    for (std::size_t i = 0; i < spindles_.size(); ++i) {
        if (!spindles_[i].isKeptBy(other.spindles_[i])) {
            return false;
        }
    }
    return true;
}

void ProgramSpindles::stop_all(MotionLink &motion) {
    for (int i = 0; i < motion.status().num_spindles; ++i) {
        stop({i}, motion);
    }
}

void ProgramSpindles::use(const gcode::UseOffsets &offsets, MotionLink &motion) {
    offsets_ = offsets;
    follow_offsets(motion);
}

void ProgramSpindles::use(const gcode::UseToolOffset &offset, MotionLink &motion) {
    tool_offset_ = offset;
    follow_offsets(motion);
}

void ProgramSpindles::follow_offsets(MotionLink &motion) {
    const double x =
        gcode::centre_line_x(offsets_.g5x, offsets_.g92, offsets_.rotation_xy_deg, tool_offset_.offset);
    if (x == centre_line_x_) {
        return;
    }
    centre_line_x_ = x;
    for (int n = 0; n < MAX_SPINDLES; ++n) {
        if (at(n).css_max_rpm > 0 && at(n).direction != 0) {
            send(n, motion);
        }
    }
}

}  // namespace mw::task
