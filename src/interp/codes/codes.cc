// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/codes/codes.hh"

#include <array>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

constexpr int MAX_G = 1000, MAX_M = 200;

#define ROW(LETTER, NUMBER, GROUP, PHASE, AXES_USED, WORDS, REQUIRED, HANDLER)                               \
    Code {                                                                                                   \
        LETTER, NUMBER, Group::GROUP, Phase::PHASE, AXES_USED, letters(WORDS), letters(REQUIRED),            \
            &Executor::HANDLER, nullptr                                                                      \
    }

// letter, number, group, phase, uses axis words, words, required words, handler
const Code TABLE[] = {
    ROW('g', 0, MOTION, MOTION, true, "", "", do_straight),
    ROW('g', 10, MOTION, MOTION, true, "", "", do_straight),
    ROW('g', 20, MOTION, MOTION, true, "ijkrp", "", do_arc),
    ROW('g', 30, MOTION, MOTION, true, "ijkrp", "", do_arc),
    ROW('g', 40, NON_MODAL, DWELL, false, "p", "", do_dwell),
    ROW('g', 50, MOTION, MOTION, true, "ijpq", "pq", do_cubic_spline),
    ROW('g', 51, MOTION, MOTION, true, "ij", "", do_quadratic_spline),
    ROW('g', 52, MOTION, MOTION, true, "pl", "", do_nurbs_point),
    ROW('g', 53, MOTION, MOTION, false, "", "", do_nurbs_end),
    ROW('g', 70, DIAMETER, DIAMETER, false, "", "", do_diameter),
    ROW('g', 80, DIAMETER, DIAMETER, false, "", "", do_diameter),
    ROW('g', 100, NON_MODAL, OFFSETS, true, "lprijq", "l", do_g10),
    ROW('g', 170, PLANE, PLANE, false, "", "", do_plane),
    ROW('g', 171, PLANE, PLANE, false, "", "", do_plane),
    ROW('g', 180, PLANE, PLANE, false, "", "", do_plane),
    ROW('g', 181, PLANE, PLANE, false, "", "", do_plane),
    ROW('g', 190, PLANE, PLANE, false, "", "", do_plane),
    ROW('g', 191, PLANE, PLANE, false, "", "", do_plane),
    ROW('g', 200, UNITS, UNITS, false, "", "", do_units),
    ROW('g', 210, UNITS, UNITS, false, "", "", do_units),
    ROW('g', 280, NON_MODAL, OFFSETS, true, "", "", do_reference),
    ROW('g', 281, NON_MODAL, OFFSETS, true, "", "", do_reference),
    ROW('g', 300, NON_MODAL, OFFSETS, true, "", "", do_reference),
    ROW('g', 301, NON_MODAL, OFFSETS, true, "", "", do_reference),
    ROW('g', 330, MOTION, MOTION, true, "k$", "k", do_thread),
    ROW('g', 331, MOTION, MOTION, true, "ki$", "k", do_thread),
    ROW('g', 382, MOTION, MOTION, true, "", "", do_probe),
    ROW('g', 383, MOTION, MOTION, true, "", "", do_probe),
    ROW('g', 384, MOTION, MOTION, true, "", "", do_probe),
    ROW('g', 385, MOTION, MOTION, true, "", "", do_probe),
    ROW('g', 400, COMP, COMP, false, "", "", do_comp),
    ROW('g', 410, COMP, COMP, false, "d", "", do_comp),
    ROW('g', 411, COMP, COMP, false, "dl", "d", do_comp),
    ROW('g', 420, COMP, COMP, false, "d", "", do_comp),
    ROW('g', 421, COMP, COMP, false, "dl", "d", do_comp),
    ROW('g', 430, TOOL_OFFSET, TOOL_OFFSET, false, "h", "", do_tool_offset),
    ROW('g', 431, TOOL_OFFSET, TOOL_OFFSET, true, "", "", do_tool_offset),
    ROW('g', 432, TOOL_OFFSET, TOOL_OFFSET, true, "h", "", do_tool_offset),
    ROW('g', 490, TOOL_OFFSET, TOOL_OFFSET, false, "", "", do_tool_offset),
    ROW('g', 520, NON_MODAL, OFFSETS, true, "", "", do_g92),
    ROW('g', 530, NON_MODAL, DWELL, false, "", "", do_nothing),
    ROW('g', 540, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 550, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 560, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 570, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 580, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 590, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 591, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 592, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 593, COORDINATES, COORDINATES, false, "", "", do_coordinates),
    ROW('g', 610, CONTROL, CONTROL, false, "", "", do_control),
    ROW('g', 611, CONTROL, CONTROL, false, "", "", do_control),
    ROW('g', 640, CONTROL, CONTROL, false, "pqr", "", do_control),
    ROW('g', 760, MOTION, MOTION, true, "pijkrqhel$", "pijk", do_thread_cycle),
    ROW('g', 800, MOTION, MOTION, false, "", "", do_cancel_motion),
    ROW('g', 700, MOTION, MOTION, true, "qdep", "q", do_lathe_cycle),
    ROW('g', 710, MOTION, MOTION, true, "qdir", "q", do_lathe_cycle),
    ROW('g', 711, MOTION, MOTION, true, "qdir", "q", do_lathe_cycle),
    ROW('g', 712, MOTION, MOTION, true, "qdir", "q", do_lathe_cycle),
    ROW('g', 720, MOTION, MOTION, true, "qdir", "q", do_lathe_cycle),
    ROW('g', 721, MOTION, MOTION, true, "qdir", "q", do_lathe_cycle),
    ROW('g', 722, MOTION, MOTION, true, "qdir", "q", do_lathe_cycle),
    ROW('g', 730, MOTION, MOTION, true, "rlqp", "", do_cycle),
    ROW('g', 740, MOTION, MOTION, true, "rlp$", "", do_cycle),
    ROW('g', 810, MOTION, MOTION, true, "rl", "", do_cycle),
    ROW('g', 820, MOTION, MOTION, true, "rlp", "", do_cycle),
    ROW('g', 830, MOTION, MOTION, true, "rlqp", "", do_cycle),
    ROW('g', 840, MOTION, MOTION, true, "rlp$", "", do_cycle),
    ROW('g', 850, MOTION, MOTION, true, "rl", "", do_cycle),
    ROW('g', 860, MOTION, MOTION, true, "rlp$", "", do_cycle),
    ROW('g', 870, MOTION, MOTION, true, "rlijkp", "", do_cycle),
    ROW('g', 880, MOTION, MOTION, true, "rlp", "", do_cycle),
    ROW('g', 890, MOTION, MOTION, true, "rlp", "", do_cycle),
    ROW('g', 900, DISTANCE, DISTANCE, false, "", "", do_distance),
    ROW('g', 901, CENTRE_DISTANCE, CENTRE_DISTANCE, false, "", "", do_centre_distance),
    ROW('g', 910, DISTANCE, DISTANCE, false, "", "", do_distance),
    ROW('g', 911, CENTRE_DISTANCE, CENTRE_DISTANCE, false, "", "", do_centre_distance),
    ROW('g', 920, NON_MODAL, OFFSETS, true, "", "", do_g92),
    ROW('g', 921, NON_MODAL, OFFSETS, false, "", "", do_g92),
    ROW('g', 922, NON_MODAL, OFFSETS, false, "", "", do_g92),
    ROW('g', 923, NON_MODAL, OFFSETS, false, "", "", do_g92),
    ROW('g', 930, FEED_MODE, FEED_MODE, false, "", "", do_feed_mode),
    ROW('g', 940, FEED_MODE, FEED_MODE, false, "", "", do_feed_mode),
    ROW('g', 950, FEED_MODE, FEED_MODE, false, "$", "", do_feed_mode),
    ROW('g', 960, SPINDLE_MODE, SPINDLE_MODE, false, "d$", "s", do_spindle_mode),
    ROW('g', 970, SPINDLE_MODE, SPINDLE_MODE, false, "$", "", do_spindle_mode),
    ROW('g', 980, RETRACT, RETRACT, false, "", "", do_retract),
    ROW('g', 990, RETRACT, RETRACT, false, "", "", do_retract),

    ROW('m', 0, STOP, STOP, false, "", "", do_stop),
    ROW('m', 1, STOP, STOP, false, "", "", do_stop),
    ROW('m', 2, STOP, STOP, false, "", "", do_end),
    ROW('m', 3, SPINDLE, SPINDLE, false, "$", "", do_spindle),
    ROW('m', 4, SPINDLE, SPINDLE, false, "$", "", do_spindle),
    ROW('m', 5, SPINDLE, SPINDLE, false, "$", "", do_spindle),
    ROW('m', 6, TOOL_CHANGE, CHANGE_TOOL, false, "", "", do_change_tool),
    ROW('m', 7, COOLANT, COOLANT, false, "", "", do_coolant),
    ROW('m', 8, COOLANT, COOLANT, false, "", "", do_coolant),
    ROW('m', 9, COOLANT, COOLANT, false, "", "", do_coolant),
    ROW('m', 19, SPINDLE, SPINDLE, false, "rqp$", "", do_orient),
    ROW('m', 30, STOP, STOP, false, "", "", do_end),
    ROW('m', 48, OVERRIDE, OVERRIDE, false, "", "", do_override),
    ROW('m', 49, OVERRIDE, OVERRIDE, false, "", "", do_override),
    ROW('m', 50, OVERRIDE, OVERRIDE, false, "p", "", do_override),
    ROW('m', 51, OVERRIDE, OVERRIDE, false, "p$", "", do_override),
    ROW('m', 52, OVERRIDE, OVERRIDE, false, "p", "", do_override),
    ROW('m', 53, OVERRIDE, OVERRIDE, false, "p", "", do_override),
    ROW('m', 60, STOP, STOP, false, "", "", do_stop),
    ROW('m', 61, TOOL_CHANGE, CHANGE_TOOL, false, "q", "q", do_tool_number),
    ROW('m', 62, IO, IO, false, "p", "p", do_output),
    ROW('m', 63, IO, IO, false, "p", "p", do_output),
    ROW('m', 64, IO, IO, false, "p", "p", do_output),
    ROW('m', 65, IO, IO, false, "p", "p", do_output),
    ROW('m', 66, IO, IO, false, "pelq", "", do_wait_input),
    ROW('m', 67, IO, IO, false, "eq", "eq", do_output),
    ROW('m', 68, IO, IO, false, "eq", "eq", do_output),
    ROW('m', 70, CONTEXT, CONTEXT, false, "", "", do_context),
    ROW('m', 71, CONTEXT, CONTEXT, false, "", "", do_context),
    ROW('m', 72, CONTEXT, CONTEXT, false, "", "", do_context),
    ROW('m', 98, STOP, STOP, false, "pl", "", do_fanuc),
    ROW('m', 99, STOP, STOP, false, "", "", do_fanuc),
    ROW('m', 73, CONTEXT, CONTEXT, false, "", "", do_context),
};

const Code F_CODE = ROW('f', 0, WORD_F, FEED, false, "", "", do_feed_word);
const Code S_CODE = ROW('s', 0, WORD_S, SPEED, false, "$", "", do_speed_word);
const Code T_CODE = ROW('t', 0, WORD_T, TOOL, false, "", "", do_tool_word);

constexpr int FIRST_USER_CODE = 100;

struct Index {
    std::array<const Code *, MAX_G> g{};
    std::array<const Code *, MAX_M> m{};
    std::array<Code, MAX_M - FIRST_USER_CODE> users{};  ///< M100 to M199 differ in their number only

    Index() {
        for (const Code &code : TABLE) {
            (code.letter == 'g' ? g[static_cast<std::size_t>(code.number)]
                                : m[static_cast<std::size_t>(code.number)]) = &code;
        }
        for (std::size_t i = 0; i < users.size(); ++i) {
            users[i] = ROW('m', FIRST_USER_CODE + static_cast<int>(i), USER, USER, false, "pq", "", do_user);
        }
    }
};

#undef ROW

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

}  // namespace mw::interp::detail
