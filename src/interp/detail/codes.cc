// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/detail/codes.hh"

#include <array>

#include "interp/detail/executor.hh"

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
    ROW('g', 200, UNITS, UNITS, false, "", "", do_units),
    ROW('g', 210, UNITS, UNITS, false, "", "", do_units),
    ROW('m', 2, STOP, STOP, false, "", "", do_end),
    ROW('m', 30, STOP, STOP, false, "", "", do_end),
};

const Code F_CODE = ROW('f', 0, WORD_F, FEED, false, "", "", do_feed_word);
const Code S_CODE = ROW('s', 0, WORD_S, SPEED, false, "$", "", do_speed_word);
const Code T_CODE = ROW('t', 0, WORD_T, TOOL, false, "", "", do_tool_word);
#undef ROW

struct Index {
    std::array<const Code *, MAX_G> g{};
    std::array<const Code *, MAX_M> m{};

    Index() {
        for (const Code &code : TABLE) {
            (code.letter == 'g' ? g[static_cast<std::size_t>(code.number)]
                                : m[static_cast<std::size_t>(code.number)]) = &code;
        }
    }
};

}  // namespace

const Code *find_code(char letter_char, int number) {
    static const Index INDEX;
    const int limit = letter_char == 'g' ? MAX_G : MAX_M;
    if (number < 0 || number >= limit) {
        return nullptr;
    }
    return letter_char == 'g' ? INDEX.g[static_cast<std::size_t>(number)]
                              : INDEX.m[static_cast<std::size_t>(number)];
}

const Code *find_word_code(char letter_char) {
    return letter_char == 'f' ? &F_CODE : (letter_char == 's' ? &S_CODE : &T_CODE);
}

}  // namespace mw::interp::detail
