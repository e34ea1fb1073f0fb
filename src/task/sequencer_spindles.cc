// SPDX-License-Identifier: GPL-2.0-or-later
// Spindles as programmed and as the operator commands them.
#include <cmath>

#include "interp/surface_speed.hh"
#include "task/sequencer.hh"

namespace mw::task {

void Sequencer::send_spindle(int spindle) {
    const SpindleState &state = spindles_[static_cast<std::size_t>(spindle)];
    motion::SpindleOn on;
    on.spindle = spindle;
    on.css_max_rpm = state.css_max_rpm;
    on.isWaitingForSpeed = state.isWaiting;
    if (state.css_max_rpm > 0) {
        // Constant surface speed: the controller divides by the radius.
        on.css_factor = state.direction * interp::surface_speed_factor(state.speed, state.surface_unit);
        on.css_x_offset = centre_line_x_;
        on.speed_rpm = state.direction * state.css_max_rpm;
    } else {
        on.speed_rpm = state.direction * state.speed;
    }
    motion_.send(on);
    isNextMoveWaitingForSpeed_ = state.isWaiting;
}

void Sequencer::follow_offsets() {
    const double x =
        interp::centre_line_x(offsets_.g5x, offsets_.g92, offsets_.rotation_xy_deg, tool_offset_.offset);
    if (x == centre_line_x_) {
        return;
    }
    centre_line_x_ = x;
    for (int n = 0; n < MAX_SPINDLES; ++n) {
        const SpindleState &state = spindles_[static_cast<std::size_t>(n)];
        if (state.css_max_rpm > 0 && state.direction != 0) {
            send_spindle(n);
        }
    }
}

void Sequencer::command_spindle(int spindle, double signed_rpm, bool isWaiting) {
    SpindleState &state = spindles_[static_cast<std::size_t>(spindle)];
    state.css_max_rpm = 0;
    state.direction = signed_rpm > 0 ? 1 : (signed_rpm < 0 ? -1 : 0);
    state.isWaiting = isWaiting;
    if (state.direction == 0) {
        motion_.send(motion::SpindleOff{spindle});
        return;
    }
    state.speed = std::fabs(signed_rpm);
    send_spindle(spindle);
}

void Sequencer::stop_spindles() {
    for (int i = 0; i < motion_.status().num_spindles; ++i) {
        spindles_[static_cast<std::size_t>(i)].direction = 0;
        motion_.send(motion::SpindleOff{i});
    }
}

}  // namespace mw::task
