// SPDX-License-Identifier: GPL-2.0-or-later
// Codes that set modes, and the words F, S and T.
#include <cmath>

#include <fmt/format.h>

#include "interp/detail/executor.hh"

namespace mw::interp::detail {

bool Executor::do_feed_word(const Code &, const BlockValues &values) {
    const double feed = values.at('f');
    if (feed < 0.0) {
        return fault.set("Negative f word used", values.column_of('f'));
    }
    state.feed = feed;
    canon.set_feed_rate(feed);
    return true;
}

bool Executor::do_speed_word(const Code &, const BlockValues &) {
    return fault.set("S is not supported yet");
}

bool Executor::do_tool_word(const Code &, const BlockValues &) {
    return fault.set("T is not supported yet");
}

bool Executor::do_units(const Code &code, const BlockValues &) {
    const LengthUnits units = code.number == 200 ? LengthUnits::INCH : LengthUnits::MM;
    if (units != state.units) {
        const double factor = units == LengthUnits::MM ? 25.4 : 1.0 / 25.4;
        state.units = units;
        state.position = scale_lengths(state.position, factor);
        state.g5x = scale_lengths(state.g5x, factor);
        state.g92 = scale_lengths(state.g92, factor);
        state.tool_offset = scale_lengths(state.tool_offset, factor);
    }
    canon.use_length_units(units);
    return true;
}

bool Executor::do_end(const Code &, const BlockValues &) {
    canon.program_end();
    outcome = Outcome::PROGRAM_END;
    return true;
}

void Executor::run_comments(const BlockView &, std::string_view) {}

void Executor::announce() {
    canon.use_length_units(state.units);
    canon.set_g5x_offset(state.g5x_index, state.g5x);
    canon.set_g92_offset(state.g92);
    canon.set_xy_rotation(state.rotation_deg);
    canon.set_feed_reference_xyz();
}

void Executor::synch() {
    const MachineSnapshot snapshot = world_.snapshot();
    state.position = frame().to_program(scale_lengths(snapshot.position, machine_to_program()));
}

ActiveCodes Executor::active_codes() const {
    return {};
}

bool Executor::isBuiltInName(std::string_view) const {
    return false;
}

std::optional<double> Executor::built_in(std::string_view) const {
    return std::nullopt;
}

double Executor::built_in(int) const {
    return 0.0;
}

}  // namespace mw::interp::detail
