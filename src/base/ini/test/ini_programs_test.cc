// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/ini/ini_programs.hh"
#include "base/text.hh"

namespace mw::ini {
namespace {

class IniPrograms : public testing::Test {
  protected:
    IniPrograms() {
        path = (std::filesystem::temp_directory_path() / "query-XXXXXX").string();
        ::close(::mkstemp(path.data()));
        std::ofstream(path)
            << "[A]\nX = 1\nY = hello world  ; c\nX = 2\nT = ~/foo\nEMPTY =\n  SP  =  padded  \n"
               "LONG = a \\\n b\nON = yes\n[B]\nX = 0x1f\nx = lower\n";
        ::setenv("HOME", "/home/somebody", 1);
    }
    ~IniPrograms() override { std::filesystem::remove(path); }

    ProgramOutput inivar(const std::string &words) {
        return run_inivar(split_words(words + " -ini " + path));
    }
    ProgramOutput inivalue(const std::string &words) { return run_inivalue(split_words(words + " " + path)); }

    std::string path;
};

TEST_F(IniPrograms, InivarPrintsTheValueAsItStands) {
    EXPECT_EQ(inivar("-var X").out, "1\n");
    EXPECT_EQ(inivar("-var X -sec A -num 2").out, "2\n");
    EXPECT_EQ(inivar("-var X -num 3").out, "0x1f\n");
    EXPECT_EQ(inivar("-var X -num 0").out, "1\n");
    EXPECT_EQ(inivar("-var Y -sec A").out, "hello world  ; c\n");
    EXPECT_EQ(inivar("-var x").out, "lower\n");
    EXPECT_EQ(inivar("-var SP").out, "padded\n");
    EXPECT_EQ(inivar("-var LONG").out, "a  b\n");
    EXPECT_EQ(inivar("-var T").out, "~/foo\n");
    EXPECT_EQ(inivar("-var T -tildeexpand").out, "/home/somebody/foo\n");
}

TEST_F(IniPrograms, InivarFailsWithTheWordsThatScriptsKnow) {
    ProgramOutput failed = inivar("-var NOPE");
    EXPECT_EQ(failed.status, 1);
    EXPECT_EQ(failed.err, "Can not find -sec (null) -var NOPE -num 1 \n");
    EXPECT_EQ(inivar("-var X -sec A -num 3").err, "Can not find -sec A -var X -num 3 \n");
    EXPECT_EQ(inivar("-var X -sec a").err, "Can not find -sec a -var X -num 1 \n");
    EXPECT_EQ(inivar("-var EMPTY").status, 0) << "a variable without a value is there";
    EXPECT_EQ(inivar("-var EMPTY").out, "\n");
    EXPECT_EQ(inivar("-sec A").err, "inivar: no variable supplied\n");
    EXPECT_EQ(inivar("-var X -num a").err, "inivar: invalid number after -num\n");
    EXPECT_EQ(run_inivar({"-var"}).err, "inivar: variable name not specified after -var\n");
    EXPECT_EQ(run_inivar({"-var", "X", "-num"}).err, "inivar: line not specified after -num\n");
    failed = run_inivar({"-var", "X", "-ini", "/nowhere/a.ini"});
    EXPECT_EQ(failed.status, 255);
    EXPECT_EQ(failed.err, "inivar: can't open /nowhere/a.ini\n");
    EXPECT_EQ(inivar("extra -var X").err,
              "inivar: -var <variable> {-tildeexpand} {-sec <section>} {-ini <INI "
              "file>} [-num <nth item>]\n");
}

TEST_F(IniPrograms, InivarNamesAKeyThatStandsBeforeAnySection) {
    std::ofstream(path) << "KEY = 1\n[A]\nX = 2\n";
    EXPECT_EQ(inivar("-var KEY").err, path + ":1: error: Tag 'KEY' found without prior section definition\n");
    EXPECT_EQ(inivar("-var KEY").status, 1);
    EXPECT_EQ(inivar("-var X").out, "2\n");
}

TEST_F(IniPrograms, InivalueChecksTypesAndHasDefaults) {
    EXPECT_EQ(inivalue("--var=X --sec=B --type=i").out, "31\n");
    EXPECT_EQ(inivalue("--var X --sec B --type sint").out, "31\n");
    EXPECT_EQ(inivalue("--var=ON --type=bool").out, "true\n");
    EXPECT_EQ(inivalue("--var=ON --type=b -b").out, "1\n");
    EXPECT_EQ(inivalue("--var=ON --type=b -B").out, "True\n");
    EXPECT_EQ(inivalue("--var=EMPTY").out, "\n");
    EXPECT_EQ(inivalue("--var=NOPE --default=7 --type=r").out, "7.000000000000000e+00\n");
    EXPECT_EQ(inivalue("--var=NOPE --default=x --type=r").status, 1);
    EXPECT_EQ(inivalue("--var=Y --type=r").err,
              path + ":3: error: Invalid floating point [A]Y='hello world  ; c'\n"
                     "error: Invalid real []Y='hello world  ; c' or out of range "
                     "[-1.79769e+308,1.79769e+308]\n");
    EXPECT_EQ(inivalue("--var=NOPE --sec=A").err, "error: Cannot find instance 1 of '[A]NOPE'\n");
    EXPECT_EQ(inivalue("--var=X --num=0").status, 2);
    EXPECT_EQ(inivalue("--var=X --type=q").status, 2);
    EXPECT_EQ(inivalue("--foo").status, 2);
    EXPECT_EQ(run_inivalue({"--var"}).status, 2);
    EXPECT_EQ(run_inivalue({"--help"}).status, 0);
}

TEST_F(IniPrograms, InivalueKeepsNumbersInTheirRange) {
    EXPECT_EQ(inivalue("--var=X --type=i -m 1 -M 1").out, "1\n");
    EXPECT_EQ(inivalue("--var=X --type=i -m 2").status, 1);
    EXPECT_EQ(inivalue("--var=X --type=u -M 0").status, 1);
    EXPECT_EQ(inivalue("--var=X --type=r -m 0.5 -M 1.5").out, "1.000000000000000e+00\n");
    EXPECT_EQ(inivalue("--var=X --type=r -m 1.5").status, 1);
    EXPECT_EQ(inivalue("--var=X --type=i -m 2 -M 1").err, "error: Invalid integer range min '2' > max '1'\n");
    EXPECT_EQ(inivalue("--var=X --type=i -m low").err, "error: 'low' after -m is no integer\n");
    std::ofstream(path) << "[A]\nB = 0b11\nO = -0o17\nT = 3 mm\nM = -1\nL = 9223372036854775808\n"
                           "S = -9223372036854775808\n";
    EXPECT_EQ(inivalue("--var=B --type=u").out, "3\n");
    EXPECT_EQ(inivalue("--var=O --type=i").out, "-15\n");
    EXPECT_EQ(inivalue("--var=T --type=i").out, "3\n");
    EXPECT_NE(inivalue("--var=T --type=i").err.find(path + ":4: warning: "), std::string::npos);
    EXPECT_EQ(inivalue("--var=M --type=u").out, "18446744073709551615\n");
    EXPECT_NE(inivalue("--var=M --type=u").err.find(path + ":5: warning: "), std::string::npos);
    EXPECT_EQ(inivalue("--var=L --type=i").status, 1);
    EXPECT_EQ(inivalue("--var=L --type=u").out, "9223372036854775808\n");
    EXPECT_EQ(inivalue("--var=S --type=i").out, "-9223372036854775808\n");
}

TEST_F(IniPrograms, InivalueListsWhatIsThere) {
    EXPECT_EQ(inivalue("--sections").out, "A\nB\n");
    EXPECT_EQ(inivalue("--var=X --all").out, "1\n2\n0x1f\n");
    EXPECT_EQ(inivalue("--var=X --all --num=3").out, "0x1f\n");
    EXPECT_EQ(inivalue("--var=X --all --num=4").err, "error: No instance 4 or more of '[]X'\n");
    EXPECT_EQ(inivalue("--variables --sec B").out, "X\nx\n");
    EXPECT_EQ(inivalue("--variables --content --sec=B").out, "X=0x1f\nx=lower\n");
    EXPECT_EQ(inivalue("--variables --sec=C").status, 1);
}

TEST_F(IniPrograms, InivalueStopsAtTheFirstFaultWithItsLine) {
    const auto fault = [&](const std::string &text) {
        std::ofstream(path) << text;
        const ProgramOutput result = inivalue("--var=X");
        EXPECT_EQ(result.status, 1) << text;
        EXPECT_EQ(result.out, "") << text;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << text;
        return result.err.substr(0, result.err.find("error: "));
    };
    for (const char *text : {"X = 1\n", "#INCLUDE\n", "[A\n", "[ ]\n", "[1A]\n", "[A B]\n"}) {
        EXPECT_EQ(fault(std::string(text) + "[B]\nX = 1\nalso wrong\n"), path + ":1: ");
    }
    for (const char *text : {"X\n", "= 1\n", "1X = 1\n", "X Y = 1\n", "X = \\x0g\n"}) {
        EXPECT_EQ(fault("[A]\n" + std::string(text) + "also wrong\n"), path + ":2: ");
    }
    EXPECT_EQ(fault("[A]\nX = 1 \\\n"), path + ":2: ");
    EXPECT_EQ(fault("[A]\nX = 1\n#INCLUDE " + path + "\n"), path + ":3: ");
    EXPECT_EQ(fault("#INCLUDE " + path + ".none\n"), path + ".none: ");
    EXPECT_EQ(run_inivalue({"--var=X", "/nowhere/a.ini"}).err,
              "/nowhere/a.ini: error: Cannot open ini-file (errno=2 (No such file or directory))\n");
    EXPECT_EQ(run_inivalue({"--var=X", "/dev/null"}).status, 1);

    std::ofstream(path) << "[A] more\n[A] ; comment\nX = 1 # kept\n";
    const ProgramOutput warned = inivalue("--var=X");
    EXPECT_EQ(warned.out, "1 # kept\n");
    EXPECT_NE(warned.err.find(path + ":1: warning: "), std::string::npos);
    EXPECT_NE(warned.err.find(path + ":2: warning: "), std::string::npos);
}

TEST_F(IniPrograms, InivalueNeedsAHomeToExpand) {
    EXPECT_EQ(inivalue("--var=T --tildeexpand").out, "/home/somebody/foo\n");
    ::unsetenv("HOME");
    EXPECT_EQ(inivalue("--var=T --tildeexpand").status, 1);
    EXPECT_EQ(inivalue("--var=T").out, "~/foo\n");
}

}  // namespace
}  // namespace mw::ini
