// SPDX-License-Identifier: GPL-2.0-or-later
#include <random>

#include <gtest/gtest.h>

#include "base/ini/ini_escape.hh"

namespace mw::ini {
namespace {

TEST(IniEscape, EachEscapeIsItsCharacter) {
    EXPECT_EQ(decode_ini_value(R"(a\tb\\c\101\x42\u00e9\U0001F600)").value(), "a\tb\\cAB\u00e9\U0001F600");
    EXPECT_EQ(decode_ini_value(R"(\ud83d\ude00)").value(), "\U0001F600");
    EXPECT_EQ(decode_ini_value(R"(\xf0\x9f\x98\x80)").value(), "\U0001F600");
    EXPECT_EQ(decode_ini_value(R"(C:\d\)").value(), R"(C:\d\)") << "no escape: unchanged";
}

TEST(IniEscape, WhatIsNoCharacterIsAnError) {
    for (const char *text : {R"(\0)",
                             R"(\000)",
                             R"(\x00)",
                             R"(\u0000)",
                             R"(\U00000000)",
                             R"(\400)",
                             R"(\x)",
                             R"(\x1)",
                             R"(\xg0)",
                             R"(\x-1)",
                             R"(\u12)",
                             R"(\ud800)",
                             R"(\ud800\n)",
                             R"(\ud800\u0041)",
                             R"(\udc00)",
                             R"(\U00110000)",
                             R"(\U0000d800)",
                             "\xc3",
                             "\xc0\x80",
                             "\xe0\x80\x80",
                             "\xed\xa0\x80",
                             "\xf5\x80\x80\x80",
                             "\xf0\x8f\xbf\xbf",
                             "\xf4\x90\x80\x80",
                             "\x80"}) {
        EXPECT_FALSE(decode_ini_value(text)) << text;
    }
    EXPECT_FALSE(decode_ini_value(std::string_view("a\0b", 3)));
}

TEST(IniEscape, EncodedTextIsReadAsItWas) {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        std::string text;
        for (int left = static_cast<int>(random() % 12); left > 0; --left) {
            text += random() % 3 == 0 ? "\\" : std::string(1, static_cast<char>(1 + random() % 127));
        }
        const std::string encoded = encode_ini_value(text);
        EXPECT_EQ(decode_ini_value(encoded).value(), text) << encoded;
        EXPECT_EQ(encoded.find_first_of("\n\r\t"), std::string::npos);
        EXPECT_FALSE(encoded.starts_with(' ') || encoded.ends_with(' ') || encoded.ends_with('\\'));
    }
}

}  // namespace
}  // namespace mw::ini
