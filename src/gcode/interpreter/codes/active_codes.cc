// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/active_codes.hh"

namespace mw::gcode::detail {

ActiveCodes active_codes(const State &state, const Parameters &parameters, const BlockCodes &block,
                         int sequence) {
    ActiveCodes out;
    const SpindleState &spindle = state.spindles[static_cast<std::size_t>(state.active_spindle)];
    out.g = {sequence,
             number_of(state.motion),
             block.non_modal,
             number_of(plane_code(state.plane)),
             number_of(state.comp.code()),
             state.units == LengthUnits::INCH ? 200 : 210,
             state.incremental ? 910 : 900,
             number_of(feed_mode_code(state.feed_mode)),
             number_of(coordinate_system_code(state.g5x_index)),
             number_of(state.tool.offset_code),
             state.retract_to_r ? 990 : 980,
             number_of(path_control_code(state.control)),
             -1,
             spindle.is_constant_surface ? 960 : 970,
             state.centre_absolute ? 901 : 911,
             state.isDiameter ? 70 : 80,
             parameters.get(P_G92_APPLIED) != 0.0 ? 923 : -1};
    const bool is_speed_override = spindle.overridden;
    out.m = {sequence,
             block.stop,
             spindle.direction > 0 ? 3 : (spindle.direction < 0 ? 4 : 5),
             block.tool_change,
             state.isMist ? 7 : (state.isFlood ? -1 : 9),
             state.isFlood ? 8 : -1,
             state.is_feed_override ? (is_speed_override ? 48 : 50) : (is_speed_override ? 51 : 49),
             state.adaptive ? 52 : -1,
             state.is_feed_hold ? 53 : -1,
             -1};
    out.settings = {static_cast<double>(sequence), state.feed_in_units(), spindle.speed, state.tolerance,
                    state.naivecam};
    return out;
}

}  // namespace mw::gcode::detail
