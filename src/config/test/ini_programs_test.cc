// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/text.hh"
#include "config/ini_programs.hh"

namespace mw::config {
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

TEST_F(IniPrograms, inivar_prints_the_value_as_it_stands_A2) {
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

TEST_F(IniPrograms, inivar_fails_with_the_words_that_scripts_know_A2) {
    ProgramOutput failed = inivar("-var NOPE");
    EXPECT_EQ(failed.status, 1);
    EXPECT_EQ(failed.err, "Can not find -sec (null) -var NOPE -num 1 \n");
    EXPECT_EQ(inivar("-var X -sec A -num 3").err, "Can not find -sec A -var X -num 3 \n");
    EXPECT_EQ(inivar("-var X -sec a").err, "Can not find -sec a -var X -num 1 \n");
    EXPECT_EQ(inivar("-var EMPTY").status, 1);
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

TEST_F(IniPrograms, inivar_names_a_key_that_stands_before_any_section_A2) {
    std::ofstream(path) << "KEY = 1\n[A]\nX = 2\n";
    EXPECT_EQ(inivar("-var KEY").err, path + ":1: error: Tag 'KEY' found without prior section definition\n");
    EXPECT_EQ(inivar("-var KEY").status, 1);
    EXPECT_EQ(inivar("-var X").out, "2\n");
}

TEST_F(IniPrograms, inivalue_checks_types_and_has_defaults_A2) {
    EXPECT_EQ(inivalue("--var=X --sec=B --type=sint").out, "31\n");
    EXPECT_EQ(inivalue("--var=ON --type=bool").out, "TRUE\n");
    EXPECT_EQ(inivalue("--var=EMPTY").out, "\n");
    EXPECT_EQ(inivalue("--var=NOPE --default=7 --type=real").out, "7\n");
    EXPECT_EQ(inivalue("--var=Y --type=real").err,
              "inivalue: " + path + ":3:5: 'hello world  ; c' is no real\n");
    EXPECT_EQ(inivalue("--var=NOPE --sec=A").err, "inivalue: " + path + ": there is no [A]NOPE\n");
    EXPECT_EQ(inivalue("--var=X --num=0").status, 2);
    EXPECT_EQ(inivalue("--foo").status, 2);
    EXPECT_EQ(run_inivalue({"--help"}).status, 0);
}

}  // namespace
}  // namespace mw::config
