// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "base/options/letters.hh"

namespace mw::options {
namespace {

constexpr KnownLetter KNOWN[] = {{'k'}, {'f'}, {'h'}, {'i', "the name of a file"}};

std::string told(const Result<Letters> &read) {
    if (!read.has_value()) {
        return read.error().message;
    }
    std::string out;
    for (const Letter &one : read->options) {
        out += std::string(1, one.letter) + (one.value.empty() ? "" : '=' + one.value) + ' ';
    }
    for (const std::string &word : read->words) {
        out += '[' + word + ']';
    }
    return out;
}

TEST(Letters, StandSeveralBehindOneDashAndTakeValuesAtOnceOrAsTheNextWord) {
    EXPECT_EQ(
        told(read_letters({"-kf", "-iA.ini", "-i", "B.ini", "-ki", "-x"}, KNOWN, EndOfLetters::FIRST_WORD)),
        "k f i=A.ini i=B.ini k i=-x ");
}

TEST(Letters, EndAtTheFirstWordOrAtTwoDashes) {
    EXPECT_EQ(told(read_letters({"-k", "setp", "-5", "-f"}, KNOWN, EndOfLetters::FIRST_WORD)),
              "k [setp][-5][-f]");
    EXPECT_EQ(told(read_letters({"-k", "a", "-f", "-", "--", "-k"}, KNOWN, EndOfLetters::ALL_WORDS)),
              "k f [a][-][-k]");
    EXPECT_EQ(told(read_letters({"--", "-k"}, KNOWN, EndOfLetters::FIRST_WORD)), "[-k]");
}

TEST(Letters, AFirstWordHelpIsItsLetter) {
    EXPECT_EQ(told(read_letters({"--help"}, KNOWN, EndOfLetters::FIRST_WORD)), "h ");
}

TEST(Letters, WhatIsNotKnownOrLacksItsValueIsAnError) {
    EXPECT_EQ(told(read_letters({"-kx"}, KNOWN, EndOfLetters::FIRST_WORD)), "unknown option -x");
    EXPECT_EQ(told(read_letters({"-:"}, KNOWN, EndOfLetters::FIRST_WORD)), "unknown option -:");
    EXPECT_EQ(told(read_letters({"-ki"}, KNOWN, EndOfLetters::FIRST_WORD)),
              "option -i needs the name of a file");
}

}  // namespace
}  // namespace mw::options
