// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes without scripts: the REMAP line, argspec, order, recursion, and the error without a script
// language.
#include <gtest/gtest.h>

#include "gcode/interpreter/ini_settings.hh"
#include "gcode/interpreter/scripts/script_host.hh"
#include "recorder.hh"

namespace mw::gcode::test {
namespace {

/// A machine with REMAP lines in lines 10, 11, ... of test.ini, column 7.
Settings with_remaps(std::vector<std::string> lines) {
    Settings settings;
    int line = 10;
    for (std::string &text : lines) {
        settings.remaps.emplace_back(std::move(text), SourcePlace{"test.ini", line++, 7});
    }
    return settings;
}

/// Runs a program; returns its output and calls.
std::vector<std::string> calls_of(Machine &machine, const std::string &program) {
    machine.record.calls.clear();
    EXPECT_EQ(machine.run(program), Step::PROGRAM_END) << machine.error();
    return machine.record.calls;
}

std::string begin_error(const std::string &remap) {
    Machine machine(with_remaps({remap}));
    const Result<> begun = machine.interpreter->begin();
    return begun ? "" : begun.error().str();
}

TEST(Remap, ArgspecGivesWordsByNameAndChecksWhatIsRequired) {
    Machine machine(with_remaps({"M400 argspec=PQrn ngc=rm400"}));
    machine.write("rm400.ngc", "o<rm400> sub\n(print,p=#<p> q=#<q> r=#<r> n=%d#<n>)\no<rm400> endsub\n");
    EXPECT_EQ(calls_of(machine, "G21\nM400 P1 Q2\n")[0], "printp=1.000000 q=2.000000 r=###### n=2");
    EXPECT_EQ(calls_of(machine, "M400 P1 Q2 R3\n")[0], "printp=1.000000 q=2.000000 r=3.000000 n=1");
    EXPECT_EQ(machine.run("M400\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "user-defined M400: missing: P,Q");
    EXPECT_EQ(machine.interpreter->error().line_text, "O <rm400> call ");
}

TEST(Remap, PositionalWordsStandInTheOrderOfTheArgspec) {
    Settings settings = with_remaps({"G88.1 modalgroup=1 argspec=@xYpQ ngc=cycle"});
    settings.argument_count_named = true;
    Machine machine(settings);
    machine.write("cycle.ngc", "o<cycle> sub\n(print,%d#1 #2 #3 #4 n #<n_args>)\no<cycle> endsub\n");
    EXPECT_EQ(calls_of(machine, "G88.1 X1 Y2 P3 Q4\n")[0], "print1 2 3 4 n 4");
    EXPECT_EQ(calls_of(machine, "G88.1 Y2 Q4\n")[0], "print2 4 0 0 n 2");
}

TEST(Remap, FeedAndSpeedMayBeDemanded) {
    Machine machine(with_remaps({"M400 argspec=^> ngc=rm400"}));
    machine.write("rm400.ngc", "o<rm400> sub\n(print,ran)\no<rm400> endsub\n");
    EXPECT_EQ(machine.run("M400\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "user-defined M400: missing: F>0,S>0");
    EXPECT_EQ(calls_of(machine, "F100 S1000\nM400\n").at(1), "printran");
}

TEST(Remap, ModalGroupSaysWhenTheCodeRuns) {
    Machine machine(with_remaps({"M410 modalgroup=5 ngc=say", "M411 modalgroup=8 ngc=say", "M412 ngc=say"}));
    machine.write("say.ngc", "o<say> sub\n(print,remap)\no<say> endsub\n");
    EXPECT_EQ(calls_of(machine, "M410 M3 S10\n"),
              (std::vector<std::string>{"spindle_speed", "printremap", "spindle_cw", "spindle_off",
                                        "spindle_mode", "end"}));
    EXPECT_EQ(calls_of(machine, "M411 M3 M0\n")[1], "printremap");
    EXPECT_EQ(calls_of(machine, "M412 G0 X1\n")[0], "printremap");
    EXPECT_EQ(machine.run("M411 M8\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "Two m codes used from same modal group");
}

TEST(Remap, CodeInsideItsOwnProcedureHasItsOwnMeaning) {
    Machine machine(with_remaps({"M6 modalgroup=6 ngc=change", "T ngc=prepare", "S ngc=speed", "F ngc=feed",
                                 "M1 ngc=pause", "M8 ngc=coolant"}));
    for (const auto &[name, code] :
         std::initializer_list<std::pair<const char *, const char *>>{{"change", "M6"},
                                                                      {"prepare", "T1"},
                                                                      {"speed", "S50"},
                                                                      {"feed", "F60"},
                                                                      {"pause", "M1"},
                                                                      {"coolant", "M8"}}) {
        machine.write(std::string(name) + ".ngc", std::string("o<") + name + "> sub\n(print," + name + ")\n" +
                                                      code + "\no<" + name + "> endsub\n");
    }
    ToolEntry tool;
    tool.toolno = 1;
    machine.mill.tools.push_back(tool);
    EXPECT_EQ(
        calls_of(machine, "S1 F1 T1\nM8\nM1\nM6\n"),
        (std::vector<std::string>{"printfeed", "printspeed", "spindle_speed", "printprepare", "select_tool 1",
                                  "printcoolant", "flood_on", "printpause", "optional_stop", "printchange",
                                  "spindle_off", "change_tool", "spindle_off", "spindle_mode", "end"}));
    EXPECT_DOUBLE_EQ(machine.interpreter->active_codes().settings[2], 50.0);
}

TEST(Remap, NewCodeCannotStandInItsOwnProcedure) {
    Machine machine(with_remaps({"M400 ngc=rm400", "M401 ngc=rm401"}));
    machine.write("rm400.ngc", "o<rm400> sub\nM401\no<rm400> endsub\n");
    machine.write("rm401.ngc", "o<rm401> sub\nM400\no<rm401> endsub\n");
    EXPECT_EQ(machine.run("M400\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("M400 is used in its own remap procedure"), std::string::npos)
        << machine.error();
    EXPECT_EQ(machine.interpreter->error().called_from.size(), 2u);
    EXPECT_EQ(machine.run("G0 X1\n"), Step::PROGRAM_END);
}

TEST(Remap, RemappedMotionIsNotModalByItself) {
    Machine machine(with_remaps({"G88.3 argspec=x ngc=g883"}));
    machine.write("g883.ngc", "o<g883> sub\n(print,x#<x>)\no<g883> endsub\n");
    EXPECT_EQ(machine.run("G0 X1\nG88.3 X2\nX4\n"), Step::PROGRAM_END);
    EXPECT_DOUBLE_EQ(machine.record.lines.back().end[0], 4.0);
    EXPECT_EQ(machine.record.calls[0], "printx2.000000");
}

TEST(Remap, BadLinesNameTheirPlace) {
    EXPECT_NE(begin_error("M400 argspec=P? ngc=x").find("test.ini:10:21:"), std::string::npos)
        << begin_error("M400 argspec=P? ngc=x");
    EXPECT_NE(begin_error("M400 argspec=Pp ngc=x").find("twice"), std::string::npos);
    EXPECT_NE(begin_error("M400 modalgroup=3 ngc=x").find("modal group 3"), std::string::npos);
    EXPECT_NE(begin_error("G88.1 modalgroup=2 ngc=x").find("modal group 2"), std::string::npos);
    EXPECT_NE(begin_error("M400").find("ngc=NAME or py=NAME is missing"), std::string::npos);
    EXPECT_NE(begin_error("M400 ngc=a py=b").find("not both"), std::string::npos);
    EXPECT_NE(begin_error("M400 colour=red ngc=a").find("unknown option 'colour=red'"), std::string::npos);
    EXPECT_NE(begin_error("X12 ngc=a").find("a code such as M400"), std::string::npos);
    EXPECT_NE(begin_error("M1000 ngc=a").find("below 1000"), std::string::npos);
    EXPECT_NE(begin_error("").find("must come first"), std::string::npos);
}

TEST(Remap, CodeWhoseMeaningCannotChangeIsWarnedAbout) {
    Machine machine(with_remaps({"G1 ngc=x", "M400 ngc=rm400"}));
    machine.write("rm400.ngc", "o<rm400> sub\n(print,ran)\no<rm400> endsub\n");
    EXPECT_EQ(calls_of(machine, "F100 G1 X1\nM400\n").front(), "printran");
    ASSERT_EQ(machine.interpreter->warnings().size(), 1u);
    EXPECT_NE(machine.interpreter->warnings()[0].find("test.ini:10:7: REMAP=G1 ngc=x: G1 cannot be remapped"),
              std::string::npos);
}

TEST(Remap, TwoLinesForOneCodeAreRefused) {
    Machine machine(with_remaps({"M400 ngc=a", "m400 ngc=b"}));
    const Result<> begun = machine.interpreter->begin();
    ASSERT_FALSE(begun);
    EXPECT_EQ(begun.error().place.line, 11);
    EXPECT_NE(begun.error().message.find("remapped twice"), std::string::npos);
}

TEST(Remap, PythonFunctionNeedsAToplevel) {
    EXPECT_NE(begin_error("M400 py=handler").find("[PYTHON]TOPLEVEL is missing"), std::string::npos);
}

TEST(Remap, MissingPythonIsOneClearErrorAndOnlyWhereItIsNeeded) {
    Settings settings = with_remaps({"M400 py=handler"});
    settings.scripts.top_level = "toplevel.py";
    settings.scripts.place = {"test.ini", 20, 3};
    settings.make_script_host = [] { return open_script_host("/nonexistent/python_host.so"); };
    Machine machine(settings);
    const Result<> begun = machine.interpreter->begin();
    ASSERT_FALSE(begun);
    EXPECT_EQ(begun.error().message,
              "[PYTHON]TOPLEVEL needs Python: /nonexistent/python_host.so is not installed");
    EXPECT_EQ(begun.error().place.line, 20);
    EXPECT_NE(begun.error().hint.find("install the Python part"), std::string::npos);

    settings = with_remaps({"M400 ngc=rm400"});
    settings.make_script_host = [] { return open_script_host("/nonexistent/python_host.so"); };
    Machine plain(settings);
    plain.write("rm400.ngc", "o<rm400> sub\n(print,ran)\no<rm400> endsub\n");
    EXPECT_EQ(calls_of(plain, "M400\n; py, a comment\n")[0], "printran");
    EXPECT_EQ(plain.run("G0 X1\n;py,print(1)\n"), Step::FAILED);
    EXPECT_NE(plain.error().find("a line that begins with ;py, needs Python"), std::string::npos)
        << plain.error();
    EXPECT_EQ(plain.interpreter->error().what.place.line, 2);
}

TEST(ScriptLines, AMachineWithoutPythonInItsIniFileDoesNotRunThem) {
    for (const bool configured : {false, true}) {
        diagnostics::Sink sink;
        const std::string text = configured ? "[PYTHON]\nTOPLEVEL = top.py\n" : "[PYTHON]\nLOG_LEVEL = 0\n";
        const auto ini = ini::IniFile::parse(text, "m.ini", sink);
        ini::IniReader reader(ini, sink);
        EXPECT_EQ(settings_from_ini(reader).scripts.lines_run, configured);
    }
    Settings settings;
    settings.scripts.lines_run = false;
    bool made = false;
    settings.make_script_host = [&made]() -> Result<std::unique_ptr<ScriptHost>> {
        made = true;
        return fail("no host");
    };
    Machine machine(settings);
    EXPECT_EQ(machine.run("G0 X1\n;py,print(1)\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("are not run on this machine"), std::string::npos) << machine.error();
    EXPECT_EQ(machine.interpreter->error().what.place.line, 2);
    EXPECT_FALSE(made);
}

}  // namespace
}  // namespace mw::gcode::test
