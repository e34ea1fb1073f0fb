// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "base/options/command_line.hh"

namespace mw::options {
namespace {

struct Read {
    bool strict = false, checked = true, isOn = true;
    std::string plot;
    Words outputs, trigger, rest;
    double patience_s = 60;
    int count = 7;
};

class CommandLineTest : public ::testing::Test {
  protected:
    CommandLineTest() {
        line.flag("--strict", "unknown keys are errors", read.strict);
        line.flag("--no-check", "start anyhow", read.checked, false);
        line.text("--plot", "FILE", "draw", read.plot);
        line.texts("-o,--output", "FILE", "write", read.outputs);
        line.on_or_off("--optional-stop", "M1 stops", read.isOn);
        line.number("--patience", "SECONDS", "timeout", read.patience_s, 0.001, 600);
        line.number("--count", "N", "so many", read.count, 1, 100);
        line.take("--trigger", 3, "NAME KIND LEVEL", "when to begin", [this](const Words &words) -> Result<> {
            read.trigger = words;
            return words[1] == "above" ? Result<>{} : fail("'" + words[1] + "' is no kind");
        });
        line.rest(read.rest);
    }
    std::string error(const Words &words) {
        const auto status = line.parse(words);
        return status.has_value() ? "" : status.error().str();
    }

    Read read;
    CommandLine line{"prog WORD... [options]", "Does it.\n"};
};

TEST_F(CommandLineTest, ReadsFlagsValuesAndTheOtherWordsInAnyOrder) {
    EXPECT_EQ(error({"a.ini", "--strict", "--plot", "p.png", "b.ngc", "--no-check", "--patience=2.5",
                     "--count", "9", "--optional-stop=off", "-o", "x.csv", "--output=y.csv", "-oz.csv"}),
              "");
    EXPECT_TRUE(read.strict);
    EXPECT_FALSE(read.checked);
    EXPECT_FALSE(read.isOn);
    EXPECT_EQ(read.plot, "p.png");
    EXPECT_EQ(read.patience_s, 2.5);
    EXPECT_EQ(read.count, 9);
    EXPECT_EQ(read.outputs, Words({"x.csv", "y.csv", "z.csv"}));
    EXPECT_EQ(read.rest, Words({"a.ini", "b.ngc"}));
}

TEST_F(CommandLineTest, WhatIsNotGivenStaysAsItIs) {
    EXPECT_EQ(error({}), "");
    EXPECT_TRUE(!read.strict && read.checked && read.isOn);
    EXPECT_EQ(read.patience_s, 60);
    EXPECT_TRUE(read.rest.empty());
}

TEST_F(CommandLineTest, AnOptionTakesExactlyItsWordsWhateverTheyLookLike) {
    EXPECT_EQ(error({"--trigger", "joint.0.f-error", "above", "-0.5", "name", "--plot", "--strict"}), "");
    EXPECT_EQ(read.trigger, Words({"joint.0.f-error", "above", "-0.5"}));
    EXPECT_EQ(read.rest, Words({"name"}));
    EXPECT_EQ(read.plot, "--strict");
    EXPECT_FALSE(read.strict);
}

TEST_F(CommandLineTest, OfAnOptionThatComesTwiceTheLastOneCounts) {
    EXPECT_EQ(error({"--count", "3", "--count=4", "--strict", "--strict", "--plot=a", "--plot=b"}), "");
    EXPECT_EQ(read.count, 4);
    EXPECT_EQ(read.plot, "b");
}

TEST_F(CommandLineTest, WordsBehindTwoDashesAndASingleDashAreNoOptions) {
    EXPECT_EQ(error({"-", "--", "--strict", "-x"}), "");
    EXPECT_EQ(read.rest, Words({"-", "--strict", "-x"}));
    EXPECT_FALSE(read.strict);
}

TEST_F(CommandLineTest, WordsAreHandedOverAsTheyAre) {
    EXPECT_EQ(error({"[a,b]", "{}", "", "%%", "\1", "--plot", "[p]", "--output", "", "--trigger", "{}",
                     "above", "[1]"}),
              "");
    EXPECT_EQ(read.rest, Words({"[a,b]", "{}", "", "%%", "\1"}));
    EXPECT_EQ(read.plot, "[p]");
    EXPECT_EQ(read.outputs, Words({""}));
    EXPECT_EQ(read.trigger, Words({"{}", "above", "[1]"}));
}

TEST_F(CommandLineTest, OfATextWordsOfOneDashBelongToIt) {
    line.rest_of_text(read.rest);
    EXPECT_EQ(error({"G0", "X", "-.5", "-5", "-[2]", "-#1", "-o", "x.csv", "Y1"}), "");
    EXPECT_EQ(read.rest, Words({"G0", "X", "-.5", "-5", "-[2]", "-#1", "Y1"}));
    EXPECT_EQ(read.outputs, Words({"x.csv"}));
    EXPECT_EQ(error({"--stict"}), "unknown option --stict (did you mean --strict?)");
}

TEST_F(CommandLineTest, ErrorsNameTheOptionAndTheNearestOne) {
    EXPECT_EQ(error({"--stict"}), "unknown option --stict (did you mean --strict?)");
    EXPECT_EQ(error({"a", "--polt=x.png", "b"}), "unknown option --polt (did you mean --plot?)");
    EXPECT_EQ(error({"-x"}), "unknown option -x (see --help)");
    EXPECT_EQ(error({"--plot"}), "option --plot needs a value");
    EXPECT_EQ(error({"--strict=no"}), "option --strict takes no value");
    EXPECT_EQ(error({"--trigger", "a", "above"}), "option --trigger takes 3 arguments");
    EXPECT_EQ(error({"--trigger", "a", "beside", "3"}), "option --trigger: 'beside' is no kind");
    EXPECT_EQ(error({"--patience", "-1"}), "option --patience: '-1' is not a number from 0.001 to 600");
    EXPECT_EQ(error({"--patience", "nan"}), "option --patience: 'nan' is not a number from 0.001 to 600");
    EXPECT_EQ(error({"--count", "2.5"}), "option --count: '2.5' is not a whole number from 1 to 100");
    EXPECT_EQ(error({"--count", "101"}), "option --count: '101' is not a whole number from 1 to 100");
    EXPECT_EQ(error({"--optional-stop", "maybe"}), "option --optional-stop: use on or off, not 'maybe'");
}

TEST(CommandLine, WordsWithoutAPlaceAreRefused) {
    const CommandLine line("prog", "");
    EXPECT_EQ(line.parse({"word"}).error().message, "unexpected argument 'word'");
    EXPECT_TRUE(line.parse({}).has_value());
}

TEST_F(CommandLineTest, HelpTellsEachOptionAndWrapsItsText) {
    std::string long_doc;
    for (int i = 0; i < 40; ++i) {
        long_doc += "word ";
    }
    line.text("--a-name-that-is-too-long", "FOR-THE-COLUMN", long_doc, read.plot);
    line.flag("--hidden", "", read.strict);
    line.footer("exit status: 0\n");
    const std::string help = line.help();
    EXPECT_TRUE(help.starts_with("usage: prog WORD... [options]\n\nDoes it.\n\n"
                                 "  --strict              unknown keys are errors\n"))
        << help;
    EXPECT_NE(help.find("  -o,--output FILE      write\n"), std::string::npos) << help;
    EXPECT_NE(help.find("\n  --a-name-that-is-too-long FOR-THE-COLUMN\n                        word"),
              std::string::npos);
    EXPECT_EQ(help.find("--hidden"), std::string::npos);
    EXPECT_TRUE(help.ends_with("\n\nexit status: 0\n"));
    for (std::size_t at = 0; at < help.size();) {
        const std::size_t end = help.find('\n', at);
        EXPECT_LE(end - at, 100U);
        at = end + 1;
    }
    EXPECT_TRUE(wantsHelp({"a", "--help"}) && wantsHelp({"-h"}) && !wantsHelp({"help"}));
}

}  // namespace
}  // namespace mw::options
