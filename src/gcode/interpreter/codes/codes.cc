// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/codes.hh"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "gcode/interpreter/codes/code_functions.hh"

namespace mw::gcode {

std::string code_name(GCode code) {
    const int number = number_of(code);
    if (letter_of(code) != 'g') {
        return fmt::format("{}{}", letter_of(code), number);
    }
    return number % 10 == 0 ? fmt::format("g{}", number / 10)
                            : fmt::format("g{}.{}", number / 10, number % 10);
}

namespace detail {
namespace {

using enum Group;

constexpr std::string_view ARC =
    "i=centre, along X|j=centre, along Y|k=centre, along Z|r=radius; negative for more than "
    "half a turn|p=turns, from 1";
constexpr std::string_view THREAD = "k=distance per spindle revolution|$=spindle";
constexpr std::string_view CYCLE = "r=height to which it retracts and from which it feeds|l=repeats";
constexpr std::string_view DWELL_CYCLE =
    "r=height to which it retracts and from which it feeds|l=repeats|p=time to wait at the "
    "bottom [s]";
constexpr std::string_view SPINDLE_CYCLE =
    "r=height to which it retracts and from which it feeds|l=repeats|p=time to wait at the "
    "bottom [s]|$=spindle";
constexpr std::string_view PECK_CYCLE =
    "r=height to which it retracts and from which it feeds|l=repeats|q=depth of one peck|p=way "
    "back between pecks";
constexpr std::string_view PROFILE =
    "q=number of the subroutine with the profile|x=position at the beginning|z=position at the "
    "beginning|d=allowance left on the profile; of G70 the first distance|e=last distance of G70|"
    "i=depth of one cut|r=retract after a cut|p=number of passes";
constexpr std::string_view SPINDLE_WORD = "$=spindle; -1 all of them";
constexpr std::string_view ON_OFF = "p=0 off, else on";

// Code, group, words (* axes), required words, function, description, descriptions of the words.
const Code TABLE[] = {
    row(G(0), MOTION, "*", "", move_straight, "rapid move in a straight line"),
    row(G(1), MOTION, "*", "", move_straight, "straight move at the feed rate"),
    row(G(2), MOTION, "*ijkrp", "", move_along_arc, "clockwise arc or helix at the feed rate", ARC),
    row(G(3), MOTION, "*ijkrp", "", move_along_arc, "counterclockwise arc or helix at the feed rate", ARC),
    row(G(4), DWELL, "p", "", dwell, "dwell: wait", "p=time to wait [s]"),
    row(G(5), MOTION, "*ijpq", "pq", move_along_cubic, "cubic spline in the plane",
        "i=first control point from the start, along the first axis|j=the same along the second "
        "axis|p=second control point from the end, along the first axis|q=the same along the second axis"),
    row(G(5, 1), MOTION, "*ij", "", move_along_quadratic, "quadratic spline in the plane",
        "i=control point from the start, along the first axis|j=the same along the second axis"),
    row(G(5, 2), MOTION, "*pl", "", add_nurbs_point, "control point of a NURBS in the plane",
        "p=weight|l=order of the NURBS, on its first line"),
    row(G(5, 3), MOTION, "", "", end_nurbs, "end of a NURBS, which runs now"),
    row(G(7), DIAMETER, "", "", set_diameter_mode, "diameter mode: X words are diameters"),
    row(G(8), DIAMETER, "", "", set_diameter_mode, "radius mode: X words are radii"),
    row(G(10), NON_MODAL, "*lprijq", "l", set_stored_data,
        "set offsets, coordinate systems and the tool table",
        "l=1 tool table, 2 coordinate system, 10 and 11 tool table from the position, 20 coordinate system "
        "from the position|p=tool, or coordinate system from 1, 0 the active one|r=tool radius, or rotation "
        "[deg]|i=front angle of a lathe tool [deg]|j=back angle of a lathe tool [deg]|q=orientation of a "
        "lathe tool, 0 to 9"),
    row(G(17), PLANE, "", "", select_plane, "plane XY"),
    row(G(17, 1), PLANE, "", "", select_plane, "plane UV"),
    row(G(18), PLANE, "", "", select_plane, "plane XZ"),
    row(G(18, 1), PLANE, "", "", select_plane, "plane UW"),
    row(G(19), PLANE, "", "", select_plane, "plane YZ"),
    row(G(19, 1), PLANE, "", "", select_plane, "plane VW"),
    row(G(20), UNITS, "", "", set_units, "inches"),
    row(G(21), UNITS, "", "", set_units, "millimetres"),
    row(G(28), NON_MODAL, "*", "", go_to_reference, "go to the first stored position through the given one"),
    row(G(28, 1), NON_MODAL, "*", "", go_to_reference, "store the machine's position as the first one (G28)"),
    row(G(30), NON_MODAL, "*", "", go_to_reference, "go to the second stored position through the given one"),
    row(G(30, 1), NON_MODAL, "*", "", go_to_reference,
        "store the machine's position as the second one (G30)"),
    row(G(33), MOTION, "*k$", "k", move_with_spindle, "straight move in step with the spindle", THREAD),
    row(G(33, 1), MOTION, "*ki$", "k", move_with_spindle,
        "rigid tapping: in step with the spindle, there and back",
        "k=distance per spindle revolution|i=factor of the spindle speed for the retract|$=spindle"),
    row(G(38, 2), MOTION, "*", "", move_probe,
        "probe towards the work piece until contact; none is an error"),
    row(G(38, 3), MOTION, "*", "", move_probe, "probe towards the work piece until contact"),
    row(G(38, 4), MOTION, "*", "", move_probe,
        "probe away from the work piece until contact is lost; none lost is an error"),
    row(G(38, 5), MOTION, "*", "", move_probe, "probe away from the work piece until contact is lost"),
    row(G(40), COMP, "", "", set_compensation, "cutter compensation off"),
    row(G(41), COMP, "d", "", set_compensation, "cutter compensation left of the path",
        "d=tool whose radius counts; else the one in the spindle"),
    row(G(41, 1), COMP, "dl", "d", set_compensation, "cutter compensation left of the path, of a given size",
        "d=diameter|l=orientation of a lathe tool, 0 to 9"),
    row(G(42), COMP, "d", "", set_compensation, "cutter compensation right of the path",
        "d=tool whose radius counts; else the one in the spindle"),
    row(G(42, 1), COMP, "dl", "d", set_compensation, "cutter compensation right of the path, of a given size",
        "d=diameter|l=orientation of a lathe tool, 0 to 9"),
    row(G(43), TOOL_OFFSET, "h", "", set_tool_offset, "tool offset from the tool table",
        "h=tool; else the one in the spindle"),
    row(G(43, 1), TOOL_OFFSET, "*", "", set_tool_offset, "tool offset as given"),
    row(G(43, 2), TOOL_OFFSET, "*h", "", set_tool_offset, "one more tool offset on top",
        "h=tool whose offset is added; else axis words"),
    row(G(49), TOOL_OFFSET, "", "", set_tool_offset, "tool offset off"),
    row(G(52), NON_MODAL, "*", "", shift_axes, "shift the coordinate system by the amounts given"),
    row(G(53), DWELL, "", "", note_machine_coordinates, "this line is in machine coordinates"),
    row(G(54), COORDINATES, "", "", use_coordinates, "coordinate system 1"),
    row(G(55), COORDINATES, "", "", use_coordinates, "coordinate system 2"),
    row(G(56), COORDINATES, "", "", use_coordinates, "coordinate system 3"),
    row(G(57), COORDINATES, "", "", use_coordinates, "coordinate system 4"),
    row(G(58), COORDINATES, "", "", use_coordinates, "coordinate system 5"),
    row(G(59), COORDINATES, "", "", use_coordinates, "coordinate system 6"),
    row(G(59, 1), COORDINATES, "", "", use_coordinates, "coordinate system 7"),
    row(G(59, 2), COORDINATES, "", "", use_coordinates, "coordinate system 8"),
    row(G(59, 3), COORDINATES, "", "", use_coordinates, "coordinate system 9"),
    row(G(61), CONTROL, "", "", set_path_control, "exact path: no corner is rounded"),
    row(G(61, 1), CONTROL, "", "", set_path_control, "exact stop: stop after each move"),
    row(G(64), CONTROL, "pqr", "", set_path_control, "continuous path: corners may be rounded",
        "p=how far the path may leave the programmed one|q=how far points of small moves may be left "
        "out|r=planner: 0 limited by acceleration, above 0 by jerk, with this part of the corner speed"),
    row(G(70), MOTION, "*qdep", "q", begin_lathe_cycle, "lathe finishing: run along a profile", PROFILE),
    row(G(71), MOTION, "*qdir", "q", begin_lathe_cycle, "lathe roughing with cuts along Z", PROFILE),
    row(G(71, 1), MOTION, "*qdir", "q", begin_lathe_cycle,
        "lathe roughing with cuts along Z, pockets left out", PROFILE),
    row(G(71, 2), MOTION, "*qdir", "q", begin_lathe_cycle,
        "lathe roughing with cuts along Z, only what G71.1 has left out", PROFILE),
    row(G(72), MOTION, "*qdir", "q", begin_lathe_cycle, "lathe roughing with cuts along X", PROFILE),
    row(G(72, 1), MOTION, "*qdir", "q", begin_lathe_cycle,
        "lathe roughing with cuts along X, pockets left out", PROFILE),
    row(G(72, 2), MOTION, "*qdir", "q", begin_lathe_cycle,
        "lathe roughing with cuts along X, only what G72.1 has left out", PROFILE),
    row(G(73), MOTION, "*rlqp", "", run_canned_cycle, "drilling that breaks the chip", PECK_CYCLE),
    row(G(74), MOTION, "*rlp$", "", run_canned_cycle, "left-hand tapping with a floating chuck",
        SPINDLE_CYCLE),
    row(G(76), MOTION, "*pijkrqhel$", "pijk", cut_thread, "lathe threading in several cuts",
        "p=distance per spindle revolution|i=height of the thread's crest from the drive line|j=depth of the "
        "first cut|k=depth of the thread|r=how the depth of cuts decreases|q=angle of the compound slide "
        "[deg]|h=spring passes|e=length of the taper|l=taper: 0 none, 1 entry, 2 exit, 3 both|$=spindle"),
    row(G(80), MOTION, "", "", cancel_motion, "no motion mode: axis words alone are an error"),
    row(G(81), MOTION, "*rl", "", run_canned_cycle, "drilling", CYCLE),
    row(G(82), MOTION, "*rlp", "", run_canned_cycle, "drilling with a dwell at the bottom", DWELL_CYCLE),
    row(G(83), MOTION, "*rlqp", "", run_canned_cycle, "deep drilling with full retracts", PECK_CYCLE),
    row(G(84), MOTION, "*rlp$", "", run_canned_cycle, "right-hand tapping with a floating chuck",
        SPINDLE_CYCLE),
    row(G(85), MOTION, "*rl", "", run_canned_cycle, "boring, out at the feed rate", CYCLE),
    row(G(86), MOTION, "*rlp$", "", run_canned_cycle, "boring with a dwell, spindle stop and rapid out",
        SPINDLE_CYCLE),
    row(G(87), MOTION, "*rlijkp", "", run_canned_cycle, "back boring",
        "r=height to which it retracts|l=repeats|i=sidestep along X|j=sidestep along Y|k=upper end of the "
        "bore|p=time to wait at the bottom [s]"),
    row(G(88), MOTION, "*rlp", "", run_canned_cycle, "boring with a dwell, spindle stop and program stop",
        DWELL_CYCLE),
    row(G(89), MOTION, "*rlp", "", run_canned_cycle, "boring with a dwell, out at the feed rate",
        DWELL_CYCLE),
    row(G(90), DISTANCE, "", "", set_distance_mode, "absolute distances"),
    row(G(90, 1), CENTRE_DISTANCE, "", "", set_centre_distance_mode, "absolute centres of arcs"),
    row(G(91), DISTANCE, "", "", set_distance_mode, "incremental distances"),
    row(G(91, 1), CENTRE_DISTANCE, "", "", set_centre_distance_mode, "incremental centres of arcs"),
    row(G(92), NON_MODAL, "*", "", shift_axes, "offset so that the position is what is given"),
    row(G(92, 1), NON_MODAL, "", "", shift_axes, "forget the G92 offset"),
    row(G(92, 2), NON_MODAL, "", "", shift_axes, "suspend the G92 offset"),
    row(G(92, 3), NON_MODAL, "", "", shift_axes, "restore the suspended G92 offset"),
    row(G(93), FEED_MODE, "", "", set_feed_mode, "inverse time: F is one over the minutes of the move"),
    row(G(94), FEED_MODE, "", "", set_feed_mode, "F in units per minute"),
    row(G(95), FEED_MODE, "$", "", set_feed_mode, "F in units per revolution", "$=spindle"),
    row(G(96), SPINDLE_MODE, "d$", "s", set_spindle_mode, "constant surface speed",
        "d=maximum spindle speed [rev/min]|$=spindle"),
    row(G(97), SPINDLE_MODE, "$", "", set_spindle_mode, "constant speed of the spindle", "$=spindle"),
    row(G(98), RETRACT, "", "", set_retract_mode, "cycles retract to where the first one began"),
    row(G(99), RETRACT, "", "", set_retract_mode, "cycles retract to R"),
    row(M(0), STOP, "", "", stop_program, "stop until cycle start"),
    row(M(1), STOP, "", "", stop_program, "stop if optional stops are on"),
    row(M(2), STOP, "", "", end_program, "end of the program"),
    row(M(3), SPINDLE, "$", "", turn_spindle, "spindle on clockwise", SPINDLE_WORD),
    row(M(4), SPINDLE, "$", "", turn_spindle, "spindle on counterclockwise", SPINDLE_WORD),
    row(M(5), SPINDLE, "$", "", turn_spindle, "spindle off", SPINDLE_WORD),
    row(M(6), TOOL_CHANGE, "", "", change_tool, "change to the tool that T selected"),
    row(M(7), COOLANT, "", "", switch_coolant, "mist on"),
    row(M(8), COOLANT, "", "", switch_coolant, "flood on"),
    row(M(9), COOLANT, "", "", switch_coolant, "mist and flood off"),
    row(M(19), SPINDLE, "rqp$", "", orient_spindle, "orient the spindle",
        "r=angle [deg]|q=longest time for it [s]|p=0 the shorter way, 1 clockwise, 2 "
        "counterclockwise|$=spindle"),
    row(M(30), STOP, "", "", end_program, "exchange pallets and end the program"),
    row(M(48), OVERRIDE, "", "", switch_overrides, "speed and feed overrides on"),
    row(M(49), OVERRIDE, "", "", switch_overrides, "speed and feed overrides off"),
    row(M(50), OVERRIDE, "p", "", switch_overrides, "feed override", ON_OFF),
    row(M(51), OVERRIDE, "p$", "", switch_overrides, "spindle override", "p=0 off, else on|$=spindle"),
    row(M(52), OVERRIDE, "p", "", switch_overrides, "adaptive feed", ON_OFF),
    row(M(53), OVERRIDE, "p", "", switch_overrides, "feed stop", ON_OFF),
    row(M(60), STOP, "", "", stop_program, "exchange pallets and stop until cycle start"),
    row(M(61), TOOL_CHANGE, "q", "q", set_tool_number, "set the number of the tool in the spindle", "q=tool"),
    row(M(62), IO, "p", "p", set_output, "digital output on, in step with motion", "p=output"),
    row(M(63), IO, "p", "p", set_output, "digital output off, in step with motion", "p=output"),
    row(M(64), IO, "p", "p", set_output, "digital output on, at once", "p=output"),
    row(M(65), IO, "p", "p", set_output, "digital output off, at once", "p=output"),
    row(M(66), IO, "pelq", "", wait_for_input, "wait for an input",
        "p=digital input|e=analog input|l=0 do not wait, 1 rise, 2 fall, 3 high, 4 low|q=longest wait [s]"),
    row(M(67), IO, "eq", "eq", set_output, "analog output, in step with motion", "e=output|q=value"),
    row(M(68), IO, "eq", "eq", set_output, "analog output, at once", "e=output|q=value"),
    row(M(70), CONTEXT, "", "", keep_modes, "remember the modes"),
    row(M(71), CONTEXT, "", "", keep_modes, "forget the remembered modes"),
    row(M(72), CONTEXT, "", "", keep_modes, "restore the remembered modes"),
    row(M(73), CONTEXT, "", "", keep_modes, "remember the modes until the subroutine ends"),
    row(M(98), STOP, "pl", "", call_or_return, "call a subroutine of Fanuc style", "p=its number|l=repeats"),
    row(M(99), STOP, "", "", call_or_return,
        "return from a subroutine of Fanuc style, or begin the program again"),
};

const Code WORDS[] = {
    row(gcode::WORD_F, Group::WORD_F, "", "", set_feed, "feed"),
    row(gcode::WORD_S, Group::WORD_S, "$", "", set_speed, "spindle speed"),
    row(gcode::WORD_T, Group::WORD_T, "", "", select_tool, "tool"),
};

constexpr int MAX_G = 1000, MAX_M = 200, FIRST_USER_CODE = 100;

struct Index {
    std::array<const Code *, MAX_G> g{};
    std::array<const Code *, MAX_M> m{};
    std::array<Code, MAX_M - FIRST_USER_CODE> users{};  ///< M100 to M199 differ only in their number

    Index() {
        for (const Code &code : TABLE) {
            const auto at = static_cast<std::size_t>(number_of(code.id));
            (letter_of(code.id) == 'g' ? g[at] : m[at]) = &code;
        }
        for (int number = FIRST_USER_CODE; number < MAX_M; ++number) {
            Code &user = users[static_cast<std::size_t>(number - FIRST_USER_CODE)];
            user =
                row(M(number), USER, "pq", "", run_user_code, "runs the program of this name, with P and Q");
            m[static_cast<std::size_t>(number)] = &user;
        }
    }
};

}  // namespace

std::span<const Code> all_codes() {
    return TABLE;
}

const Code *find_code(GCode code) {
    static const Index INDEX;
    const int number = number_of(code);
    switch (letter_of(code)) {
    case 'g': return number >= 0 && number < MAX_G ? INDEX.g[static_cast<std::size_t>(number)] : nullptr;
    case 'm': return number < MAX_M ? INDEX.m[static_cast<std::size_t>(number)] : nullptr;
    default: return &*std::ranges::find(WORDS, code, &Code::id);
    }
}

std::string_view Code::word_text(char name) const {
    std::string_view rest = word_texts;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('|'), rest.size());
        if (rest[0] == name) {
            return rest.substr(2, end - 2);
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
}

}  // namespace detail
}  // namespace mw::gcode
