// SPDX-License-Identifier: GPL-2.0-or-later
#include <charconv>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "base/text.hh"
#include "gcode/syntax/lexer.hh"

namespace mw::gcode::detail {
namespace {

/// The double nearest to an unsigned decimal number without an exponent.
double nearest(const std::string &text) {
    double value = -1;
    std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    return value;
}

TEST(Lexer, NumbersAreTheNearestDoubles) {
    constexpr unsigned SEED = 5;
    constexpr int COUNT = 1000000;
    std::mt19937_64 random(SEED);
    const auto below = [&random](std::uint64_t limit) { return random() % limit; };
    const auto digits = [&](std::uint64_t most) {
        std::string text;
        for (std::uint64_t left = below(most + 1); left > 0; --left) {
            text += static_cast<char>('0' + below(10));
        }
        return text;
    };
    for (int i = 0; i < COUNT; ++i) {
        // Short numbers as in programs, and long ones with more digits than a double has.
        const std::uint64_t most = i % 4 == 0 ? 22 : i % 4 == 1 ? 9 : 4;
        std::string text = digits(most);
        text += below(5) > 0 || text.empty() ? "." + digits(most) : "";
        if (text == ".") {
            text = "0.";
        }
        std::string spaced = text;
        if (below(8) == 0) {
            spaced.insert(below(spaced.size()), below(2) == 0 ? " " : "\t ");
        }
        Lexer in(spaced);
        double value = 0;
        if (in.take_number(value) != Lexer::Number::OK || value != nearest(text) || in.peek() != '\0') {
            ADD_FAILURE() << "seed " << SEED << ": '" << spaced << "' is read as " << to_text(value);
        }
    }
}

TEST(Lexer, NumbersEndWhereTheyCannotGoOn) {
    Lexer in("1 2. 5.75x");
    double value = 0;
    EXPECT_EQ(in.take_number(value), Lexer::Number::OK);
    EXPECT_EQ(value, 12.5);
    EXPECT_EQ(in.peek(), '.');
    EXPECT_EQ(in.take_number(value), Lexer::Number::OK);
    EXPECT_EQ(value, 0.75);
    EXPECT_EQ(in.peek(), 'x');
    EXPECT_EQ(in.take_number(value), Lexer::Number::NONE);
    Lexer dot(" . ");
    EXPECT_EQ(dot.take_number(value), Lexer::Number::BAD);
    EXPECT_EQ(dot.text_from(0), ".");
}

}  // namespace
}  // namespace mw::gcode::detail
