// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/codes.hh"

#include <array>

#include "gcode/interpreter/codes/comp/comp_codes.hh"
#include "gcode/interpreter/codes/cycles/canned_cycles.hh"
#include "gcode/interpreter/codes/lathe/lathe_cycles.hh"
#include "gcode/interpreter/codes/lathe/thread_cycle.hh"
#include "gcode/interpreter/codes/modes/modes.hh"
#include "gcode/interpreter/codes/modes/restore_modes.hh"
#include "gcode/interpreter/codes/moves/arcs.hh"
#include "gcode/interpreter/codes/moves/moves.hh"
#include "gcode/interpreter/codes/moves/probes.hh"
#include "gcode/interpreter/codes/moves/spindle_moves.hh"
#include "gcode/interpreter/codes/moves/splines.hh"
#include "gcode/interpreter/codes/switches/program_calls.hh"
#include "gcode/interpreter/codes/switches/program_end.hh"
#include "gcode/interpreter/codes/switches/spindles.hh"
#include "gcode/interpreter/codes/switches/switches.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/stored_data.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {
namespace {

constexpr int MAX_G = 1000, MAX_M = 200;

// letter, number, group, phase, uses axis words, words, required words, handler
const Code TABLE[] = {
    row('g', 0, Group::MOTION, Phase::MOTION, true, "", "", move_straight),
    row('g', 10, Group::MOTION, Phase::MOTION, true, "", "", move_straight),
    row('g', 20, Group::MOTION, Phase::MOTION, true, "ijkrp", "", move_along_arc),
    row('g', 30, Group::MOTION, Phase::MOTION, true, "ijkrp", "", move_along_arc),
    row('g', 40, Group::NON_MODAL, Phase::DWELL, false, "p", "", dwell),
    row('g', 50, Group::MOTION, Phase::MOTION, true, "ijpq", "pq", move_along_cubic),
    row('g', 51, Group::MOTION, Phase::MOTION, true, "ij", "", move_along_quadratic),
    row('g', 52, Group::MOTION, Phase::MOTION, true, "pl", "", add_nurbs_point),
    row('g', 53, Group::MOTION, Phase::MOTION, false, "", "", end_nurbs),
    row('g', 70, Group::DIAMETER, Phase::DIAMETER, false, "", "", set_diameter_mode),
    row('g', 80, Group::DIAMETER, Phase::DIAMETER, false, "", "", set_diameter_mode),
    row('g', 100, Group::NON_MODAL, Phase::OFFSETS, true, "lprijq", "l", set_stored_data),
    row('g', 170, Group::PLANE, Phase::PLANE, false, "", "", select_plane),
    row('g', 171, Group::PLANE, Phase::PLANE, false, "", "", select_plane),
    row('g', 180, Group::PLANE, Phase::PLANE, false, "", "", select_plane),
    row('g', 181, Group::PLANE, Phase::PLANE, false, "", "", select_plane),
    row('g', 190, Group::PLANE, Phase::PLANE, false, "", "", select_plane),
    row('g', 191, Group::PLANE, Phase::PLANE, false, "", "", select_plane),
    row('g', 200, Group::UNITS, Phase::UNITS, false, "", "", set_units),
    row('g', 210, Group::UNITS, Phase::UNITS, false, "", "", set_units),
    row('g', 280, Group::NON_MODAL, Phase::OFFSETS, true, "", "", go_to_reference),
    row('g', 281, Group::NON_MODAL, Phase::OFFSETS, true, "", "", go_to_reference),
    row('g', 300, Group::NON_MODAL, Phase::OFFSETS, true, "", "", go_to_reference),
    row('g', 301, Group::NON_MODAL, Phase::OFFSETS, true, "", "", go_to_reference),
    row('g', 330, Group::MOTION, Phase::MOTION, true, "k$", "k", move_with_spindle),
    row('g', 331, Group::MOTION, Phase::MOTION, true, "ki$", "k", move_with_spindle),
    row('g', 382, Group::MOTION, Phase::MOTION, true, "", "", move_probe),
    row('g', 383, Group::MOTION, Phase::MOTION, true, "", "", move_probe),
    row('g', 384, Group::MOTION, Phase::MOTION, true, "", "", move_probe),
    row('g', 385, Group::MOTION, Phase::MOTION, true, "", "", move_probe),
    row('g', 400, Group::COMP, Phase::COMP, false, "", "", set_compensation),
    row('g', 410, Group::COMP, Phase::COMP, false, "d", "", set_compensation),
    row('g', 411, Group::COMP, Phase::COMP, false, "dl", "d", set_compensation),
    row('g', 420, Group::COMP, Phase::COMP, false, "d", "", set_compensation),
    row('g', 421, Group::COMP, Phase::COMP, false, "dl", "d", set_compensation),
    row('g', 430, Group::TOOL_OFFSET, Phase::TOOL_OFFSET, false, "h", "", set_tool_offset),
    row('g', 431, Group::TOOL_OFFSET, Phase::TOOL_OFFSET, true, "", "", set_tool_offset),
    row('g', 432, Group::TOOL_OFFSET, Phase::TOOL_OFFSET, true, "h", "", set_tool_offset),
    row('g', 490, Group::TOOL_OFFSET, Phase::TOOL_OFFSET, false, "", "", set_tool_offset),
    row('g', 520, Group::NON_MODAL, Phase::OFFSETS, true, "", "", shift_axes),
    row('g', 530, Group::NON_MODAL, Phase::DWELL, false, "", "", note_machine_coordinates),
    row('g', 540, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 550, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 560, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 570, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 580, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 590, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 591, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 592, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 593, Group::COORDINATES, Phase::COORDINATES, false, "", "", use_coordinates),
    row('g', 610, Group::CONTROL, Phase::CONTROL, false, "", "", set_path_control),
    row('g', 611, Group::CONTROL, Phase::CONTROL, false, "", "", set_path_control),
    row('g', 640, Group::CONTROL, Phase::CONTROL, false, "pqr", "", set_path_control),
    row('g', 760, Group::MOTION, Phase::MOTION, true, "pijkrqhel$", "pijk", cut_thread),
    row('g', 800, Group::MOTION, Phase::MOTION, false, "", "", cancel_motion),
    row('g', 700, Group::MOTION, Phase::MOTION, true, "qdep", "q", begin_lathe_cycle),
    row('g', 710, Group::MOTION, Phase::MOTION, true, "qdir", "q", begin_lathe_cycle),
    row('g', 711, Group::MOTION, Phase::MOTION, true, "qdir", "q", begin_lathe_cycle),
    row('g', 712, Group::MOTION, Phase::MOTION, true, "qdir", "q", begin_lathe_cycle),
    row('g', 720, Group::MOTION, Phase::MOTION, true, "qdir", "q", begin_lathe_cycle),
    row('g', 721, Group::MOTION, Phase::MOTION, true, "qdir", "q", begin_lathe_cycle),
    row('g', 722, Group::MOTION, Phase::MOTION, true, "qdir", "q", begin_lathe_cycle),
    row('g', 730, Group::MOTION, Phase::MOTION, true, "rlqp", "", run_canned_cycle),
    row('g', 740, Group::MOTION, Phase::MOTION, true, "rlp$", "", run_canned_cycle),
    row('g', 810, Group::MOTION, Phase::MOTION, true, "rl", "", run_canned_cycle),
    row('g', 820, Group::MOTION, Phase::MOTION, true, "rlp", "", run_canned_cycle),
    row('g', 830, Group::MOTION, Phase::MOTION, true, "rlqp", "", run_canned_cycle),
    row('g', 840, Group::MOTION, Phase::MOTION, true, "rlp$", "", run_canned_cycle),
    row('g', 850, Group::MOTION, Phase::MOTION, true, "rl", "", run_canned_cycle),
    row('g', 860, Group::MOTION, Phase::MOTION, true, "rlp$", "", run_canned_cycle),
    row('g', 870, Group::MOTION, Phase::MOTION, true, "rlijkp", "", run_canned_cycle),
    row('g', 880, Group::MOTION, Phase::MOTION, true, "rlp", "", run_canned_cycle),
    row('g', 890, Group::MOTION, Phase::MOTION, true, "rlp", "", run_canned_cycle),
    row('g', 900, Group::DISTANCE, Phase::DISTANCE, false, "", "", set_distance_mode),
    row('g', 901, Group::CENTRE_DISTANCE, Phase::CENTRE_DISTANCE, false, "", "", set_centre_distance_mode),
    row('g', 910, Group::DISTANCE, Phase::DISTANCE, false, "", "", set_distance_mode),
    row('g', 911, Group::CENTRE_DISTANCE, Phase::CENTRE_DISTANCE, false, "", "", set_centre_distance_mode),
    row('g', 920, Group::NON_MODAL, Phase::OFFSETS, true, "", "", shift_axes),
    row('g', 921, Group::NON_MODAL, Phase::OFFSETS, false, "", "", shift_axes),
    row('g', 922, Group::NON_MODAL, Phase::OFFSETS, false, "", "", shift_axes),
    row('g', 923, Group::NON_MODAL, Phase::OFFSETS, false, "", "", shift_axes),
    row('g', 930, Group::FEED_MODE, Phase::FEED_MODE, false, "", "", set_feed_mode),
    row('g', 940, Group::FEED_MODE, Phase::FEED_MODE, false, "", "", set_feed_mode),
    row('g', 950, Group::FEED_MODE, Phase::FEED_MODE, false, "$", "", set_feed_mode),
    row('g', 960, Group::SPINDLE_MODE, Phase::SPINDLE_MODE, false, "d$", "s", set_spindle_mode),
    row('g', 970, Group::SPINDLE_MODE, Phase::SPINDLE_MODE, false, "$", "", set_spindle_mode),
    row('g', 980, Group::RETRACT, Phase::RETRACT, false, "", "", set_retract_mode),
    row('g', 990, Group::RETRACT, Phase::RETRACT, false, "", "", set_retract_mode),

    row('m', 0, Group::STOP, Phase::STOP, false, "", "", stop_program),
    row('m', 1, Group::STOP, Phase::STOP, false, "", "", stop_program),
    row('m', 2, Group::STOP, Phase::STOP, false, "", "", end_program),
    row('m', 3, Group::SPINDLE, Phase::SPINDLE, false, "$", "", turn_spindle),
    row('m', 4, Group::SPINDLE, Phase::SPINDLE, false, "$", "", turn_spindle),
    row('m', 5, Group::SPINDLE, Phase::SPINDLE, false, "$", "", turn_spindle),
    row('m', 6, Group::TOOL_CHANGE, Phase::CHANGE_TOOL, false, "", "", change_tool),
    row('m', 7, Group::COOLANT, Phase::COOLANT, false, "", "", switch_coolant),
    row('m', 8, Group::COOLANT, Phase::COOLANT, false, "", "", switch_coolant),
    row('m', 9, Group::COOLANT, Phase::COOLANT, false, "", "", switch_coolant),
    row('m', 19, Group::SPINDLE, Phase::SPINDLE, false, "rqp$", "", orient_spindle),
    row('m', 30, Group::STOP, Phase::STOP, false, "", "", end_program),
    row('m', 48, Group::OVERRIDE, Phase::OVERRIDE, false, "", "", switch_overrides),
    row('m', 49, Group::OVERRIDE, Phase::OVERRIDE, false, "", "", switch_overrides),
    row('m', 50, Group::OVERRIDE, Phase::OVERRIDE, false, "p", "", switch_overrides),
    row('m', 51, Group::OVERRIDE, Phase::OVERRIDE, false, "p$", "", switch_overrides),
    row('m', 52, Group::OVERRIDE, Phase::OVERRIDE, false, "p", "", switch_overrides),
    row('m', 53, Group::OVERRIDE, Phase::OVERRIDE, false, "p", "", switch_overrides),
    row('m', 60, Group::STOP, Phase::STOP, false, "", "", stop_program),
    row('m', 61, Group::TOOL_CHANGE, Phase::CHANGE_TOOL, false, "q", "q", set_tool_number),
    row('m', 62, Group::IO, Phase::IO, false, "p", "p", set_output),
    row('m', 63, Group::IO, Phase::IO, false, "p", "p", set_output),
    row('m', 64, Group::IO, Phase::IO, false, "p", "p", set_output),
    row('m', 65, Group::IO, Phase::IO, false, "p", "p", set_output),
    row('m', 66, Group::IO, Phase::IO, false, "pelq", "", wait_for_input),
    row('m', 67, Group::IO, Phase::IO, false, "eq", "eq", set_output),
    row('m', 68, Group::IO, Phase::IO, false, "eq", "eq", set_output),
    row('m', 70, Group::CONTEXT, Phase::CONTEXT, false, "", "", keep_modes),
    row('m', 71, Group::CONTEXT, Phase::CONTEXT, false, "", "", keep_modes),
    row('m', 72, Group::CONTEXT, Phase::CONTEXT, false, "", "", keep_modes),
    row('m', 98, Group::STOP, Phase::STOP, false, "pl", "", call_or_return),
    row('m', 99, Group::STOP, Phase::STOP, false, "", "", call_or_return),
    row('m', 73, Group::CONTEXT, Phase::CONTEXT, false, "", "", keep_modes),
};

const Code F_CODE = row('f', 0, Group::WORD_F, Phase::FEED, false, "", "", set_feed);
const Code S_CODE = row('s', 0, Group::WORD_S, Phase::SPEED, false, "$", "", set_speed);
const Code T_CODE = row('t', 0, Group::WORD_T, Phase::TOOL, false, "", "", select_tool);

constexpr int FIRST_USER_CODE = 100;

struct Index {
    std::array<const Code *, MAX_G> g{};
    std::array<const Code *, MAX_M> m{};
    std::array<Code, MAX_M - FIRST_USER_CODE> users{};  ///< M100 to M199 differ only in their number

    Index() {
        for (const Code &code : TABLE) {
            (code.letter == 'g' ? g[static_cast<std::size_t>(code.number)]
                                : m[static_cast<std::size_t>(code.number)]) = &code;
        }
        for (std::size_t i = 0; i < users.size(); ++i) {
            users[i] = row('m', FIRST_USER_CODE + static_cast<int>(i), Group::USER, Phase::USER, false, "pq",
                           "", run_user_code);
        }
    }
};

}  // namespace

std::span<const Code> all_codes() {
    return TABLE;
}

const Code *find_code(char letter_char, int number) {
    static const Index INDEX;
    const int limit = letter_char == 'g' ? MAX_G : MAX_M;
    if (number < 0 || number >= limit) {
        return nullptr;
    }
    if (letter_char == 'm' && number >= FIRST_USER_CODE) {
        return &INDEX.users[static_cast<std::size_t>(number - FIRST_USER_CODE)];
    }
    return letter_char == 'g' ? INDEX.g[static_cast<std::size_t>(number)]
                              : INDEX.m[static_cast<std::size_t>(number)];
}

const Code *find_word_code(char letter_char) {
    return letter_char == 'f' ? &F_CODE : (letter_char == 's' ? &S_CODE : &T_CODE);
}

}  // namespace mw::gcode::detail
