// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/diagnostics/sink.hh"
#include "hal/script/ini_file_lookup.hh"
#include "hal/script/session.hh"
#include "hal/script/two_pass.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::hal::script {
namespace {

namespace fs = std::filesystem;

class TextOutput final : public Output {
  public:
    void data(std::string_view text) override { answers += text; }
    void info(std::string_view) override {}
    void note(std::string_view text) override { notes += std::string(text) + "\n"; }
    void warning(const Error &warning) override { errors += "warning: " + warning.str() + "\n"; }
    void error(const Error &error) override { errors += error.str() + "\n"; }

    std::string answers, notes, errors;
};

class TclTest : public ::testing::Test {
  protected:
    TclTest() {
        fs::create_directories(folder);
        InstanceOptions hal_options;
        hal_options.name = "tcl-test";
        hal_options.scheduler = &clock;
        host = std::move(*LocalHost::create(hal_options));
        Instance &hal = host->hal();
        const int id = *hal.components().create("board");
        for (const char *name : {"board.in0", "board.in1"}) {
            EXPECT_TRUE(hal.pins().create(name, Type::FLOAT, Dir::IN, id));
        }
        EXPECT_TRUE(hal.pins().create("board.out", Type::FLOAT, Dir::OUT, id));
        EXPECT_TRUE(hal.components().set_ready(id));
        ini_file = ini::IniFile::parse("[JOINT_0]\nRADIUS = 2\nA = 1\nA = two words\n", "test.ini", sink);
        options.ini = &ini;
    }
    ~TclTest() override { fs::remove_all(folder); }

    std::string write(const std::string &name, const std::string &text) {
        const std::string path = folder / name;
        std::ofstream(path) << text;
        return path;
    }
    /// Runs a script; returns its output, errors last.
    std::string run(const std::string &text, const std::vector<std::string> &arguments = {}) {
        TextOutput output;
        Session session(*host, programs, output, options);
        last_result = session.run_file(write("test.tcl", text), arguments);
        return output.answers + output.errors;
    }

    fs::path folder = fs::temp_directory_path() / ("mw_tcl_" + std::to_string(::getpid()));
    runtime::VirtualScheduler clock;
    std::unique_ptr<LocalHost> host;
    InProcessProgramHost programs;
    diagnostics::Sink sink;
    ini::IniFile ini_file;
    IniFileLookup ini{ini_file};
    SessionOptions options;
    Result<> last_result;
};

TEST_F(TclTest, HalCommandsAreTclCommands) {
    EXPECT_EQ(run("net speed board.out => board.in0\n"
                  "foreach pin [hal list pin board.in*] { if {$pin ne \"board.in0\"} { setp $pin 3*4 } }\n"
                  "if {[getp board.in1] != 12} { error \"it is [getp board.in1]\" }\n"
                  "if {[stype speed] ne \"float\"} { error type }\n"
                  "if {[llength [list a b]] != 2} { error \"list is Tcl's own\" }\n"
                  "if {[string match {HAL locking*} [status lock]] != 1} { error status }\n"
                  "show sig\n"),
              "Signals:\nType                  Value  Name     (linked to)\n"
              "float                     0  speed\n"
              "                                 ==> board.in0\n"
              "                                 <== board.out\n\n");
    EXPECT_TRUE(last_result);
}

TEST_F(TclTest, HalShowIsAResultAndShowPrints) {
    EXPECT_EQ(run("net speed board.out => board.in0\nset text [hal show sig]\n"
                  "if {![string match \"*==> board.in0*\" $text]} { error \"it is '$text'\" }\n"),
              "");
    EXPECT_TRUE(last_result);
}

TEST_F(TclTest, AnIniValueOfSeveralWordsIsAModuleAndItsParameters) {
    // As in loadrt $::KINS(KINEMATICS): a list of one element.
    EXPECT_NE(run("loadrt [list {nosuchkins coordinates=xyz}]\n").find("'nosuchkins.so'"), std::string::npos);
    EXPECT_FALSE(last_result);
}

TEST_F(TclTest, ReturnWithAnErrorKeepsItsText) {
    EXPECT_NE(run("proc check {} { return -code error {no thread here} }\ncheck\n").find("no thread here"),
              std::string::npos);
}

TEST_F(TclTest, IniEntriesAreArraysOfLists) {
    EXPECT_EQ(run("setp board.in0 6.0*$::JOINT_0(RADIUS)\n"
                  "setp board.in1 \"[llength $::JOINT_0(A)] + [lindex $argv 1]\"\n",
                  {"x", "40"}),
              "");
    EXPECT_EQ(host->hal().values().get("board.in0")->as_float(), 12);
    EXPECT_EQ(host->hal().values().get("board.in1")->as_float(), 42);
}

TEST_F(TclTest, ErrorsNameTheLineAndCanBeCaught) {
    EXPECT_EQ(run("if {![catch {setp nosuch 1} text]} { error \"accepted\" }\n\n"
                  "setp bord.in0 1\n"
                  "setp board.in1 7\n"),
              (folder / "test.tcl").string() +
                  ":3: parameter or pin 'bord.in0' does not exist (did you mean 'board.in0'?)\n");
    EXPECT_FALSE(last_result);
    EXPECT_EQ(host->hal().values().get("board.in1")->as_float(), 0) << "a script stops at its first error";
    EXPECT_NE(run("proc p {} {\n net\n}\np\n").find("in procedure \"p\" line 2"), std::string::npos);
}

TEST_F(TclTest, FilesOfBothKindsSourceEachOther) {
    const std::string hal_file = write("part.hal", "newsig from-hal bit\nsource other.tcl\n");
    write("other.tcl", "newsig from-tcl bit\n");
    EXPECT_EQ(run("source " + hal_file + "\n"), "");
    EXPECT_TRUE(host->hal().signals().has("from-hal"));
    EXPECT_TRUE(host->hal().signals().has("from-tcl"));
}

TEST_F(TclTest, ExitEndsTheScriptOnly) {
    EXPECT_EQ(run("newsig before bit\nexit\nnewsig after bit\n"), "");
    EXPECT_TRUE(last_result);
    EXPECT_TRUE(host->hal().signals().has("before"));
    EXPECT_FALSE(host->hal().signals().has("after"));
    (void)run("exit 3\n");
    EXPECT_FALSE(last_result);
}

TEST_F(TclTest, ThePackageLinuxcncReadsIniFilesAndKnowsPlaces) {
    const std::string path = write("some.ini", "[A]\n K = 1 2 \n# N = 1\nK=[x]\n[B]\nlone\nC = a=b\n");
    const std::string source = "source " MW_TCL_FOLDER "/linuxcnc.tcl\n";
    const std::string read = source + "parse_ini " + path + "\n";
    EXPECT_EQ(
        run(read +
            "if {$::A(K) ne {{1 2} {[x]}} || $::B(C) ne {a=b} || [array size ::B] != 1} {error wrong}\n"),
        "");
    EXPECT_EQ(run(source +
                  "if {![info exists linuxcnc::TCL_DIR] || [package provide Linuxcnc] != 1.0} {error no}\n"),
              "");
    EXPECT_EQ(run(source + "hal newsig from-package bit\n"), "");
    EXPECT_TRUE(host->hal().signals().has("from-package"));
}

TEST_F(TclTest, AScriptForTwoPassesSaysSoInOne) {
    EXPECT_EQ(run("if {[namespace exists ::tp]} {error there}\n"), "");
    EXPECT_NE(run("::tp::passnumber\n").find("TWOPASS = on"), std::string::npos);
}

TEST_F(TclTest, ScriptsTakePartInTwoPasses) {
    TextOutput output;
    options.folders = {folder};
    Session session(*host, programs, output, options);
    write("one.tcl", "foreach i {1 2} { newsig $i bit }\n");
    write("two.hal", "net signal board.out\nlist sig\n");
    const Result<> result =
        run_two_pass(session, {{"one.tcl", {}}, {"two.hal", {}}}, "on", TwoPassReport::NOTHING);
    EXPECT_TRUE(result) << output.errors;
    EXPECT_EQ(output.answers, "\n1 2 signal \n");
}

TEST_F(TclTest, WhatAScriptSavesIsThereInBothPasses) {
    TextOutput output;
    options.folders = {folder};
    Session session(*host, programs, output, options);
    write("one.tcl", "set name \"" + (folder / "saved").string() +
                         ".[::tp::passnumber]\"\nhal save comp $name\nclose [open $name]\n");
    const Result<> result = run_two_pass(session, {{"one.tcl", {}}}, "on", TwoPassReport::NOTHING);
    EXPECT_TRUE(result) << output.errors;
    EXPECT_TRUE(fs::exists(folder / "saved.0"));
    EXPECT_TRUE(fs::exists(folder / "saved.1"));
}

}  // namespace
}  // namespace mw::hal::script
