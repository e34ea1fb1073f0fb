// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/interpreter_state.hh"

#include "base/bytes.hh"
#include "gcode/interpreter/codes/active_codes.hh"

namespace mw::gcode {
namespace {

using detail::State;

constexpr std::uint32_t FORM = 2;
static_assert(sizeof(State) == 1176, "a new field belongs into the lists below, and FORM counts on");

template <class Io, class Pose>
void pose(Io &io, Pose &values) {
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        io(values[axis]);
    }
}

template <class Io, class Code>
void g_code(Io &io, Code &code) {
    int number = number_of(code);
    io(number);
    if constexpr (!std::is_const_v<Code>) {
        code = make_code('g', number);
    }
}

template <class Io, class Spindles>
void spindles(Io &io, Spindles &all) {
    for (auto &spindle : all) {
        io(spindle.speed);
        io(spindle.direction);
        io(spindle.is_constant_surface);
        io(spindle.css_max_rpm);
        io(spindle.overridden);
    }
}

template <class Io, class Tool>
void tool(Io &io, Tool &tool) {
    io(tool.selected);
    io(tool.selected_index);
    io(tool.in_spindle);
    io(tool.index);
    pose(io, tool.offset);
    io(tool.diameter);
    io(tool.frontangle);
    io(tool.backangle);
    io(tool.orientation);
    g_code(io, tool.offset_code);
}

template <class Io, class Cycle>
void cycle(Io &io, Cycle &words) {
    for (auto *word :
         {&words.bottom, &words.r, &words.p, &words.q, &words.i, &words.j, &words.k, &words.initial}) {
        io(*word);
    }
    io(words.running);
    io(words.has_clearance);
}

/// `state` is const when packing. Omits settings of the INI file (rotary axes) and states that
/// why_not_packed() rejects.
template <class Io, class AnyState>
void fields(Io &io, AnyState &state) {
    pose(io, state.position);
    pose(io, state.frame.g5x);
    pose(io, state.frame.g92);
    pose(io, state.frame.tool);
    io(state.frame.rotation_deg);
    io(state.g5x_index);
    g_code(io, state.motion);
    io.choice(state.plane, Plane::UW);
    io.choice(state.units, LengthUnits::MM);
    io(state.incremental);
    io(state.centre_absolute);
    io(state.isDiameter);
    io(state.retract_to_r);
    io.choice(state.feed_mode, FeedMode::UNITS_PER_REVOLUTION);
    io(state.feed);
    io.choice(state.feed_units, LengthUnits::MM);
    io.choice(state.control, geometry::PathMode::BLEND);
    io(state.tolerance);
    io(state.naivecam);
    io(state.active_spindle);
    spindles(io, state.spindles);
    io(state.isMist);
    io(state.isFlood);
    io(state.is_feed_override);
    io(state.is_feed_hold);
    io(state.adaptive);
    tool(io, state.tool);
    cycle(io, state.cycle);
    io(state.spline.out.x);
    io(state.spline.out.y);
    pose(io, state.probed);
}

bool canBe(const State &state) {
    constexpr int LAST_SYSTEM = 9, SPINDLES = MAX_SPINDLES;
    return state.g5x_index >= 1 && state.g5x_index <= LAST_SYSTEM && state.active_spindle >= 0 &&
           state.active_spindle < SPINDLES;
}

const char *why_not_packed(const State &state) {
    if (state.comp.isOn() || state.comp.isExit()) {
        return "cutter compensation is on at its start";
    }
    return state.spline.order != 0 ? "a NURBS is open at its start" : nullptr;
}

void pack_numbers(Packer &out, const detail::Parameters &parameters) {
    for (int number = 1; number < detail::PARAMETER_COUNT; ++number) {
        out(parameters.get(number));
    }
}

void unpack_numbers(Unpacker &in, detail::Parameters &parameters) {
    for (int number = 1; number < detail::PARAMETER_COUNT && in.isGood(); ++number) {
        double value = 0;
        in(value);
        parameters.set(number, value);
    }
    const double system = parameters.get(detail::P_COORDINATE_SYSTEM);
    if (!(system >= 1 && system <= 9)) {
        in.spoil();
    }
}

void pack_names(Packer &out, const std::vector<std::pair<detail::NameId, double>> &named,
                const detail::Names &names) {
    out(static_cast<std::uint64_t>(named.size()));
    for (const auto &[id, value] : named) {
        out(names.text(id));
        out(value);
    }
}

void unpack_names(Unpacker &in, bool global, detail::Parameters &parameters, detail::Names &names) {
    std::uint64_t count = 0;
    in(count);
    for (std::uint64_t i = 0; i < count && in.isGood(); ++i) {
        std::string name;
        double value = 0;
        in(name);
        in(value);
        parameters.set_named(names.intern(name), global, value);
    }
}

}  // namespace

ActiveCodes InterpreterState::active_codes(int sequence) const {
    return detail::active_codes(modes, parameters, block_codes, sequence);
}

bool InterpreterState::isThreading() const {
    return modes.motion == G(33) || modes.motion == G(33, 1);
}

std::string InterpreterState::why_no_start() const {
    if (modes.comp.isOn() || modes.comp.isExit()) {
        return "cutter compensation is on at this line";
    }
    if (modes.spline.order != 0) {
        return "it is in the middle of a NURBS";
    }
    const bool is_cycle =
        modes.motion >= G(73) && modes.motion <= G(89) && modes.motion != detail::MOTION_NONE;
    if (modes.cycle.running && is_cycle) {
        return "it is in the middle of a canned cycle";
    }
    return isThreading() ? "moves are synchronized to the spindle at this line" : "";
}

Result<std::string> pack(const InterpreterState &state, const detail::Names &names) {
    const char *const why = why_not_packed(state.modes);
    if (why != nullptr) {
        return fail(why);
    }
    Packer out;
    out(FORM);
    fields(out, state.modes);
    pack_numbers(out, state.parameters);
    pack_names(out, state.parameters.globals(), names);
    pack_names(out, state.parameters.locals(0), names);
    const State *const saved = state.saved_modes.saved();
    const bool is_saved = saved != nullptr && why_not_packed(*saved) == nullptr;
    out(is_saved);
    if (is_saved) {
        fields(out, *saved);
        out((state.saved_modes.status(0) & 2) != 0);
    }
    return out.bytes();
}

Result<InterpreterState> unpack(std::string_view bytes, const InterpreterState &now, detail::Names &names) {
    Unpacker in(bytes);
    std::uint32_t form = 0;
    in(form);
    if (form != FORM) {
        return fail("modes and parameters were written by another version");
    }
    InterpreterState kept{now.modes, now.parameters, {}, now.returned, now.block_codes};
    kept.modes.comp = {};
    kept.modes.spline = {};
    fields(in, kept.modes);
    unpack_numbers(in, kept.parameters);
    kept.parameters.forget_names();
    unpack_names(in, true, kept.parameters, names);
    unpack_names(in, false, kept.parameters, names);
    kept.parameters.commit();
    bool is_saved = false, for_return = false;
    in(is_saved);
    if (is_saved) {
        State saved = kept.modes;
        fields(in, saved);
        in(for_return);
        for_return ? kept.saved_modes.save_until_return(saved) : kept.saved_modes.save(saved);
        kept.saved_modes.commit();
    }
    if (!in.isComplete() || !canBe(kept.modes)) {
        return fail("modes and parameters cannot be read");
    }
    return kept;
}

}  // namespace mw::gcode
