// SPDX-License-Identifier: GPL-2.0-or-later
#include <map>

#include <gtest/gtest.h>

#include "hal/script/lexer.hh"

namespace mw::hal::script {
namespace {

class MapIni : public IniLookup {
  public:
    std::map<std::string, std::map<std::string, std::string>> entries;

    std::optional<std::string> find(std::string_view section, std::string_view name) const override {
        const auto s = entries.find(std::string(section));
        if (s == entries.end()) {
            return std::nullopt;
        }
        const auto e = s->second.find(std::string(name));
        return e == s->second.end() ? std::nullopt : std::optional<std::string>(e->second);
    }
    std::vector<std::string> names(std::string_view section) const override {
        std::vector<std::string> result;
        const auto s = entries.find(std::string(section));
        if (s != entries.end()) {
            for (const auto &[name, value] : s->second) {
                result.push_back(name);
            }
        }
        return result;
    }
};

std::optional<std::string> test_environment(const std::string &name) {
    return name == "FOO" ? std::optional<std::string>("bar") : std::nullopt;
}

/// The words of the only line of `source`, or the text of the error.
std::string words_of(const std::string &source) {
    MapIni ini;
    ini.entries["KINS"] = {{"KINEMATICS", "trivkins coordinates=XYZ"}, {"JOINTS", "3"}};
    const Variables variables{test_environment, &ini};
    std::string result;
    for (const LogicalLine &line : split_lines(source)) {
        const Result<PlacedText> text = substitute(line.text, "f.hal", variables);
        if (!text) {
            return text.error().str();
        }
        const auto words = split_words(*text, "f.hal");
        if (!words) {
            return words.error().str();
        }
        for (const Word &word : *words) {
            result += word.text + "|";
        }
    }
    return result;
}

TEST(HalLexer, SplitsAtBlanksAndCutsComments) {
    EXPECT_EQ(words_of("net a  b.c\t=> d.e  # text"), "net|a|b.c|=>|d.e|");
    EXPECT_EQ(words_of("# all comment\n\n   \n"), "");
    EXPECT_EQ(words_of("print \"a # b\""), "print|a # b|");
    EXPECT_EQ(words_of("net a b\r\n"), "net|a|b|");
}

TEST(HalLexer, JoinsLinesAtBackslashWithNothingInserted) {
    EXPECT_EQ(words_of("loadrt ddt names=d1\\\n,d2\\\n,d3\n"), "loadrt|ddt|names=d1,d2,d3|");
    EXPECT_EQ(words_of("sets \\\n    hello \\\n    \\\n    true\n"), "sets|hello|true|");
    EXPECT_EQ(words_of("start \\"), "start|");
}

TEST(HalLexer, QuotesGroupAndAreRemoved) {
    EXPECT_EQ(words_of("loadrt stepgen step_type=\"2, 2\"'x'"), "loadrt|stepgen|step_type=2, 2x|");
    EXPECT_EQ(words_of("print \"abc"), "f.hal:1:7: unterminated quoted string");
}

TEST(HalLexer, SubstitutesEnvironment) {
    EXPECT_EQ(words_of("x $FOO x$(FOO).y"), "x|bar|xbar.y|");
    EXPECT_EQ(words_of("x $NO"), "f.hal:1:3: environment variable 'NO' is not set");
    EXPECT_EQ(words_of("x $(FOO"), "f.hal:1:4: missing ')' after a variable name");
}

TEST(HalLexer, SubstitutesIniEntriesAlsoInsideWordsAndQuotes) {
    EXPECT_EQ(words_of("loadrt [KINS]KINEMATICS"), "loadrt|trivkins|coordinates=XYZ|");
    EXPECT_EQ(words_of("x num_joints=[KINS]JOINTS [KINS](JOINTS)a"), "x|num_joints=3|3a|");
    EXPECT_EQ(words_of("x \"[KINS]JOINTS\""), "x|3|");
}

TEST(HalLexer, UnknownIniEntryNamesTheNearest) {
    EXPECT_EQ(words_of("x\ny [KINS]JOINT"),
              "f.hal:2:3: INI entry '[KINS]JOINT' not found (did you mean '[KINS]JOINTS'?)");
    EXPECT_EQ(words_of("x [KINS"), "f.hal:1:3: missing ']' after an INI section name");
    EXPECT_EQ(words_of("x [KINS] "), "f.hal:1:3: empty variable name");
}

TEST(HalLexer, PlacesSurviveContinuationAndSubstitution) {
    const auto lines = split_lines("\nnet $(FOO) \\\n  here\n");
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].first_line, 2);
    const auto text = substitute(lines[0].text, "f", Variables{test_environment, nullptr});
    ASSERT_TRUE(text.has_value());
    const auto words = split_words(*text, "f");
    ASSERT_TRUE(words.has_value());
    ASSERT_EQ(words->size(), 3U);
    EXPECT_EQ((*words)[1].place.str(), "f:2:5");
    EXPECT_EQ((*words)[2].place.str(), "f:3:3");
}

TEST(HalLexer, Arrows) {
    for (const char *arrow : {"=>", "<=", "<=>", "==>", "<=="}) {
        EXPECT_TRUE(isArrow(arrow)) << arrow;
    }
    for (const char *word : {"=", "==", ">", "a=>", ""}) {
        EXPECT_FALSE(isArrow(word)) << word;
    }
}

}  // namespace
}  // namespace mw::hal::script
