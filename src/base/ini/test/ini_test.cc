// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "base/ini/ini_reader.hh"

namespace mw::ini {
namespace {

constexpr IniKey NUMBER = ini_number("J", "V", "", 7.0, {-INI_UNBOUNDED, INI_UNBOUNDED}, "");

constexpr IniKey named(std::string_view section, std::string_view name) {
    return ini_text(section, name, "");
}

struct Read {
    explicit Read(std::string_view text)
        : file(IniFile::parse(text, "dir/m.ini", sink)), reader(file, sink) {}
    std::string first_message() const { return sink.all().empty() ? "" : sink.all().front().what.str(); }

    diagnostics::Sink sink;
    IniFile file;
    IniReader reader;
};

TEST(Ini, EntriesKeepTheirPlaceAndComments) {
    Read ini("# c\n[A]\n  K =  v ; kept # too \n[B]\nK=1\nK = 2\n");
    ASSERT_FALSE(ini.sink.hasErrors());
    EXPECT_EQ(ini.file.find("A", "K")->value, "v ; kept # too");
    EXPECT_EQ(ini.file.find("A", "K")->place.str(), "dir/m.ini:3:8");
    EXPECT_EQ(ini.file.find_all("B", "K").size(), 2U);
    EXPECT_EQ(ini.file.resolve_path("x.hal"), "dir/x.hal");
}

TEST(Ini, AContinuedLineIsOneValue) {
    Read ini("[A]\nK = a \\\nb\nL = 1\n");
    EXPECT_EQ(ini.file.find("A", "K")->value, "a b");
    EXPECT_EQ(ini.file.find("A", "L")->place.line, 4);
}

TEST(Ini, EveryMalformedLineIsReported) {
    Read ini("K = 1\n[A\nstray\n[A]\n= 5\n");
    EXPECT_EQ(ini.sink.all().size(), 4U);
    EXPECT_EQ(ini.sink.count_errors(), 3) << "a single word is a warning";
    EXPECT_EQ(ini.sink.all()[1].what.place.line, 2);
}

TEST(Ini, AProblemOfAValueWithACommentBehindItSaysThatACommentNeedsItsOwnLine) {
    const std::string own_line = "write the comment on a separate line";
    const auto units = ini_choice("T", "UNITS", "mm", "mm inch", "");
    Read choice("[T]\nUNITS = mm   # metric\n");
    choice.reader.choice(units);
    EXPECT_NE(choice.first_message().find(own_line), std::string::npos) << choice.first_message();
    EXPECT_NE(choice.first_message().find("expected one of"), std::string::npos) << choice.first_message();
    Read semicolon("[J]\nV = abc\t; left stop\n");
    semicolon.reader.real(NUMBER);
    EXPECT_NE(semicolon.first_message().find(own_line), std::string::npos) << semicolon.first_message();
    Read elsewhere("[J]\nK = X Y # two axes\nV = abc\n");
    elsewhere.reader.real(NUMBER);
    EXPECT_EQ(elsewhere.first_message().find(own_line), std::string::npos) << elsewhere.first_message();
    elsewhere.reader.sink().error("the letter '#'", elsewhere.file.find("J", "K")->place);
    EXPECT_NE(elsewhere.sink.all()[1].what.str().find(own_line), std::string::npos)
        << "the reader of the value";
    Read sign("[T]\nUNITS = mm#\n");
    sign.reader.choice(units);
    EXPECT_EQ(sign.first_message().find(own_line), std::string::npos) << "no comment was meant";
}

TEST(Ini, AByteOrderMarkAtTheStartIsSkipped) {
    Read ini("\xEF\xBB\xBF[A]\nK = 1\n");
    EXPECT_TRUE(ini.sink.all().empty()) << ini.first_message();
    EXPECT_EQ(ini.file.find("A", "K")->value, "1");
}

TEST(Ini, NumbersAreTypedAndRanged) {
    Read ini("[J]\nV = 1,5\nA = -3\nF = 2.5 # fast\n");
    EXPECT_EQ(ini.reader.real(NUMBER), 7.0);
    EXPECT_EQ(ini.reader.real(ini_number("J", "A", "", 7.0, {0.0, INI_UNBOUNDED}, "")), 7.0);
    EXPECT_EQ(ini.reader.real(ini_number("J", "F", "", 7.0, {0.0, 9.0}, "")), 2.5);
    ASSERT_EQ(ini.sink.count_errors(), 2);
    EXPECT_EQ(ini.first_message(),
              "dir/m.ini:2:5: [J]V = '1,5' is not a number (expected a number, with a decimal point)");
}

TEST(Ini, AMissingKeySaysWhatWasExpected) {
    Read ini("[KINS]\nJOINT = 3\n");
    ini.reader.integer(ini_required(ini_whole("KINS", "JOINTS", "", 1, {1, 16}, "")));
    EXPECT_EQ(ini.first_message(),
              "dir/m.ini:1:1: [KINS]JOINTS is missing (expected [KINS]JOINTS = a whole number "
              "from 1 to 16; is 'JOINT' a misspelling?)");
    ini.reader.list(ini_required(ini_list("HAL", "HALFILE", "")));
    EXPECT_EQ(ini.sink.all().back().what.message, "section [HAL] is missing");
}

TEST(Ini, UnknownKeysAreWarnedOnceWithTheNearestName) {
    Read ini("[J]\nMAX_VELOCTY = 1\n[OTHER]\nX = 1\n");
    ini.reader.text(named("J", "MAX_VELOCITY"));
    ini.reader.report_unknown(false);
    ini.reader.report_unknown(false);
    ASSERT_EQ(ini.sink.all().size(), 1U);
    EXPECT_EQ(ini.sink.all()[0].what.hint, "did you mean MAX_VELOCITY?");
    EXPECT_FALSE(ini.sink.hasErrors());
}

TEST(Ini, AnUnknownKeyIsNeverSuggestedForAnother) {
    Read ini("[E]\nM60_COMMAND = 1\nM61_COMMAND = 1\nM61_COMMAND = 2\n");
    ini.reader.declare({{named("E", "TOOL_TABLE")}});
    ini.reader.report_unknown(false);
    ini.reader.report_unknown(false);
    ASSERT_EQ(ini.sink.all().size(), 2U) << "once for each key";
    EXPECT_EQ(ini.sink.all()[0].what.hint, "");
    EXPECT_EQ(ini.sink.all()[1].what.hint, "");
}

TEST(Ini, KeysWithoutEffectAreSaidWithTheReasonAndAreErrorsWhenStrict) {
    Read ini("[J]\nTPMOD = mine\n");
    ini.reader.declare({{ini_without_effect("J", "TPMOD", "there is one planner", "tpmod"),
                         ini_without_effect("J", "HOMEMOD", "not set here")}});
    ini.reader.report_unknown(true);
    ASSERT_EQ(ini.sink.all().size(), 1U);
    EXPECT_EQ(ini.first_message(), "dir/m.ini:2:1: [J]TPMOD has no effect: there is one planner");
    EXPECT_TRUE(ini.sink.hasErrors());
}

TEST(Ini, WordsWithWhichNothingIsLostAreTakenInSilence) {
    Read ini("[J]\nTPMOD = tpmod\n");
    ini.reader.declare({{ini_without_effect("J", "TPMOD", "there is one planner", "tpmod usual")}});
    ini.reader.report_unknown(true);
    EXPECT_TRUE(ini.sink.all().empty());
}

TEST(Ini, MisspeltSectionsAreSaidAndOthersAreNot) {
    Read ini("[JIONT_0]\nA = 1\n[MY_PLASMA]\nB = 1\n[JOINT_O]\nC = 1\n");
    ini.reader.declare_in("JOINT_0", "JOINT_*", {{named("JOINT_*", "MAX_VELOCITY")}});
    ini.reader.use_section("JOINT_O");  // by a HAL file
    ini.reader.report_unknown(false);
    ini.reader.report_unknown(false);
    ASSERT_EQ(ini.sink.all().size(), 1U);
    EXPECT_EQ(ini.first_message(),
              "dir/m.ini:1:1: unknown section [JIONT_0]; it has no effect (did you mean [JOINT_0]?)");
}

TEST(Ini, AKeyThatWasCutShortIsNearerThanAnotherOne) {
    Read ini("[T]\nMAX_LINEAR_ACCEL = 1\n");
    ini.reader.declare({{named("T", "MAX_LINEAR_JERK"), named("T", "MAX_LINEAR_ACCELERATION")}});
    ini.reader.report_unknown(false);
    ASSERT_EQ(ini.sink.all().size(), 1U);
    EXPECT_EQ(ini.sink.all()[0].what.hint, "did you mean MAX_LINEAR_ACCELERATION?");
}

TEST(Ini, WhatHasNoEffectInTheFieldIsAWarning) {
    Read ini("[J]\nduh\n#INCLUDE\nV = 2\n");
    EXPECT_FALSE(ini.sink.hasErrors());
    EXPECT_EQ(ini.sink.all().size(), 2U);
    EXPECT_EQ(ini.reader.real(NUMBER), 2.0);
    Read value("[J]\nMAX_VELOCITY 5\n");
    EXPECT_TRUE(value.sink.hasErrors()) << "a setting whose '=' is missing was meant";
}

TEST(Ini, DevicesAndPipesAreNoIniFiles) {
    diagnostics::Sink sink;
    EXPECT_FALSE(IniFile::load("/dev/zero", sink));
    const std::string pipe =
        std::filesystem::temp_directory_path() / ("mw_ini_" + std::to_string(::getpid()));
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_FALSE(IniFile::load(pipe, sink));
    const IniFile file = IniFile::parse("#INCLUDE /dev/zero\n", "m.ini", sink);
    EXPECT_TRUE(sink.hasErrors());
    ::unlink(pipe.c_str());
}

TEST(Ini, AScalarGivenTwiceNamesTheOneUsed) {
    Read ini("[J]\nV = 1\nV = 2\n");
    EXPECT_EQ(ini.reader.real(NUMBER), 1.0);
    EXPECT_EQ(ini.reader.real(NUMBER), 1.0);
    ASSERT_EQ(ini.sink.all().size(), 1U);
    EXPECT_NE(ini.first_message().find("dir/m.ini:2:5"), std::string::npos);
}

TEST(Ini, WholeNumbersMayBeWrittenAsRealsWithinReason) {
    Read ini("[J]\nA = 3.0\nB = 1e300\nC = 2.5\n");
    EXPECT_EQ(ini.reader.integer(ini_whole("J", "A", "", 0, {0, 9}, "")), 3);
    EXPECT_EQ(ini.reader.integer(ini_whole("J", "B", "", 7, {0, 9}, "")), 7);
    EXPECT_EQ(ini.reader.integer(ini_whole("J", "C", "", 7, {0, 9}, "")), 7);
    EXPECT_EQ(ini.sink.count_errors(), 2);
}

TEST(Ini, BooleansInAllSpellings) {
    Read ini("[J]\nA = yes\nB = False\nC = maybe\n");
    EXPECT_TRUE(ini.reader.boolean(ini_flag("J", "A", false, "")));
    EXPECT_FALSE(ini.reader.boolean(ini_flag("J", "B", true, "")));
    EXPECT_TRUE(ini.reader.boolean(ini_flag("J", "C", true, "")));
    EXPECT_EQ(ini.sink.count_errors(), 1);
}

/// Comparing each section or key with each other takes longer than the timeout of the test.
TEST(Ini, TwoHundredThousandSectionsAndKeysAreFoundWithoutComparingAll) {
    constexpr int MANY = 200000;
    std::string text;
    for (int i = 0; i < MANY; ++i) {
        text += "[S_" + std::to_string(i) + "]\nK = " + std::to_string(i) + " ; c\n";
    }
    text += "[LONG]\n";
    for (int i = 0; i < MANY; ++i) {
        text += "K_" + std::to_string(i) + " = x ; c\n";
    }
    Read ini(text);
    for (int i = 0; i < MANY; ++i) {
        const IniEntry *const entry = ini.file.find("S_" + std::to_string(i), "K");
        ASSERT_NE(entry, nullptr);
        ASSERT_EQ(entry->place.line, 2 * i + 2);
        ASSERT_EQ(ini.file.find_all("LONG", "K_" + std::to_string(i)).size(), 1U);
        ASSERT_EQ(ini.file.place_of_section("S_" + std::to_string(i)).line, 2 * i + 1);
        ini.reader.sink().warning("each", entry->place);
    }
    EXPECT_EQ(ini.file.sections().size(), static_cast<std::size_t>(MANY + 1));
    EXPECT_EQ(ini.file.keys("LONG").size(), static_cast<std::size_t>(MANY));
    EXPECT_NE(ini.sink.all().back().what.hint.find("at the start of a line"), std::string::npos);
}

TEST(Ini, ALineHasALimitAndSoHasTheNumberOfWrongLines) {
    const Read longest("[A]\nB = " + std::string(65532, 'x') + "\nC = 1\n");
    EXPECT_FALSE(longest.sink.hasErrors());
    const Read longer("[A]\nB = \\\n" + std::string(65536, 'x') + "\nC = 1\n# " + std::string(70000, 'x'));
    ASSERT_EQ(longer.sink.all().size(), 1U);
    EXPECT_EQ(longer.sink.all().front().what.place.line, 2);
    EXPECT_NE(longer.file.find("A", "C"), nullptr);
    std::string wrong;
    for (int i = 0; i < 1000; ++i) {
        wrong += "[A\n";
    }
    EXPECT_EQ(Read(wrong).sink.all().size(), 101U);
}

}  // namespace
}  // namespace mw::ini
