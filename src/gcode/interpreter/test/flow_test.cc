// SPDX-License-Identifier: GPL-2.0-or-later
// Subroutines, loops, conditions, remaps, errors in callers, parameter files.
#include <gtest/gtest.h>

#include "gcode/interpreter/test/recorder.hh"

namespace mw::gcode {
namespace {

using test::Machine;
using Calls = std::vector<std::string>;

TEST(Flow, SubroutineGetsArgumentsAndReturnsAValue) {
    Machine machine;
    EXPECT_EQ(machine.run("O1 sub\n#5=9\nO1 return [#1*10+#2]\nO1 endsub\n#1=7 #5=1\nO1 call [3] [4]\n"
                          "(print,#<_value> #1 #5 #<_value_returned>)\n"),
              Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.record.calls[0], "print34.000000 7.000000 1.000000 1.000000");
}

TEST(Flow, ANurbsWithoutItsEndIsToldAndLeavesNothingBehind) {
    Machine machine;
    EXPECT_EQ(machine.run("%\nF10\nG5.2 P1 L2\nX1 Y1\n%\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("G5.3"), std::string::npos) << machine.error();
    EXPECT_EQ(machine.run("F10\nG5.2 P1 L2\nX1 Y1\nM2\n"), Step::FAILED);
    EXPECT_EQ(machine.run("G0 X1\n"), Step::PROGRAM_END) << machine.error();
}

TEST(Flow, SubroutineInAFileOfItsOwn) {
    Machine machine;
    machine.write("drill.ngc", "o<drill> sub\nG0 X#1\no<other> call\no<drill> endsub\nM2\n");
    machine.write("other.ngc", "o<other> sub\nG0 Y5\no<other> endsub\n");
    EXPECT_EQ(machine.run("o<Drill> call [4]\n"), Step::PROGRAM_END) << machine.error();
    ASSERT_EQ(machine.record.lines.size(), 2u);
    EXPECT_EQ(machine.record.lines[1].end[0], 4);
    EXPECT_EQ(machine.record.lines[1].end[1], 5);
}

TEST(Flow, ErrorInASubroutineNamesPlaceAndCallers) {
    Machine machine;
    machine.write("inner.ngc", "o<inner> sub\nG0 X1\nG1 X[2/0] F1\no<inner> endsub\n");
    EXPECT_EQ(machine.run("o1 sub\no<inner> call\no1 endsub\no1 call\n"), Step::FAILED);
    const diagnostics::Diagnostic &error = machine.interpreter->error();
    EXPECT_TRUE(error.what.place.file.ends_with("inner.ngc"));
    EXPECT_EQ(error.what.place.line, 3);
    EXPECT_EQ(error.what.place.column, 7);
    EXPECT_EQ(error.line_text, "G1 X[2/0] F1");
    ASSERT_EQ(error.called_from.size(), 2u);
    EXPECT_EQ(error.called_from[0].line, 2);
    EXPECT_EQ(error.called_from[1].line, 4);
    EXPECT_EQ(machine.interpreter->call_level(), 0);
}

TEST(Flow, LoopsAndConditions) {
    Machine machine;
    EXPECT_EQ(
        machine.run(
            "#1=0\n"
            "o1 while [1]\n#1=[#1+1]\n"
            "o2 if [#1 eq 2]\no1 continue\no2 elseif [#1 eq 4]\no1 break\no2 else\n(print,w#1)\no2 endif\n"
            "o1 endwhile\n"
            "o3 do\n(print,d#1)\n#1=[#1-1]\no3 while [#1 gt 2]\n"
            "o4 repeat [2]\n(print,r)\no4 endrepeat\n"
            "o5 repeat [0]\n(print,never)\no5 endrepeat\n"),
        Step::PROGRAM_END)
        << machine.error();
    const Calls want{"printw1.000000", "printw3.000000", "printd4.000000",
                     "printd3.000000", "printr",         "printr"};
    EXPECT_EQ(Calls(machine.record.calls.begin(), machine.record.calls.begin() + 6), want);
}

TEST(Flow, FailedJumpGoesOnWithTheNextLine) {
    for (const char *line :
         {"o1 endwhile", "o1 else", "o1 endif", "o1 while [1]", "o1 break", "o1 endrepeat"}) {
        Machine machine;
        EXPECT_EQ(machine.run(std::string("G0 X1\n") + line + "\nG0 Y1\n"), Step::FAILED) << line;
        EXPECT_EQ(machine.interpreter->step(), Step::OK) << line;
        ASSERT_EQ(machine.record.lines.size(), 2u) << line;
        EXPECT_EQ(machine.record.lines[1].end[1], 1) << line;
    }
}

TEST(Flow, AnErrorAtTheEndOfAFileStandsInItsLastLine) {
    Machine machine;
    ASSERT_TRUE(machine.interpreter->begin());
    machine.interpreter->open_text("text", "G0 X1\no1 nonsense\no1 endif\n");
    EXPECT_EQ(machine.interpreter->step(), Step::OK);
    EXPECT_EQ(machine.interpreter->step(), Step::FAILED);
    EXPECT_EQ(machine.interpreter->step(), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.place.line, 2) << "the likely reason of the endif without if";
    EXPECT_EQ(machine.interpreter->step(), Step::FAILED);
    EXPECT_NE(machine.error().find("File ended"), std::string::npos) << machine.error();
    EXPECT_EQ(machine.interpreter->error().what.place.line, 3);
}

TEST(Flow, RecursionIsBounded) {
    Machine machine;
    EXPECT_EQ(machine.run("o1 sub\no1 call\no1 endsub\no1 call\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("nested"), std::string::npos);
}

TEST(Flow, EndlessLoopEndsByTheBudget) {
    Settings settings;
    settings.statement_budget = 1000;
    Machine machine(settings);
    EXPECT_EQ(machine.run("o1 while [1]\no1 endwhile\n"), Step::FAILED);
}

/// An error names the line that breaks the structure of O words, not the line in which it is detected.
TEST(Flow, BrokenOWordsAreNamedWhereTheyStand) {
    const struct {
        const char *program, *error;
        int line;
    } cases[] = {
        {"o1 if [1]\no1 if [1]\no1 endif\no1 endif\n", "o1: this label is still in use (line 1)", 2},
        {"o1 repeat [2]\no1 if [1]\no1 endif\no1 endrepeat\n", "this label is still in use (line 1)", 2},
        {"o1 do\no2 repeat [1]\no1 do\no1 while [0]\no2 endrepeat\no1 while [0]\n", "still in use", 3},
        {"o1 sub\no1 endsub\no1 sub\no1 endsub\n", "o1: this subroutine is defined already (line 1)", 3},
        {"o1 sub\n#1=2\no1 endsub G0\n", "Only a comment may follow here", 3},
        {"o1 if [0]\n#1=2\no1 elsif [1]\n#1=3\no1 endif\n", "", 3},
        {"o1 if [1]\n#1=2\no1 else\no2 while [1\no1 endif\n", "", 4},
        {"o1 while [0]\no1 endwihle\no1 endwhile\n", "", 2},
        {"o1 if [1]\no2 repeat [3]\n#1=2\no1 endif\n", "o2: there is no matching endrepeat", 2},
    };
    for (const auto &one : cases) {
        Machine machine;
        EXPECT_EQ(machine.run(one.program), Step::FAILED) << one.program;
        EXPECT_NE(machine.error().find(one.error), std::string::npos) << machine.error();
        EXPECT_EQ(machine.interpreter->error().what.place.line, one.line) << machine.error();
    }
}

TEST(Flow, LabelsMayBeUsedAgainAfterTheirEnd) {
    Machine machine;
    EXPECT_EQ(
        machine.run("o1 if [1]\n#1=1\no1 endif\no1 repeat [2]\n#1=[#1+1]\no1 endrepeat\no1 do\n#1=[#1+1]\n"
                    "o1 while [#1 lt 9]\no1 while [#1 lt 12]\n#1=[#1+1]\no1 endwhile\n(print,%d#1)\n"),
        Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.record.calls[0], "print12");
}

TEST(Flow, DebugTextsCanBeSwitchedOff) {
    Machine machine;
    EXPECT_EQ(machine.run("(debug,a)\n#5599=0\n(debug,b)\n(msg,c)\n(print,d)\n#5599=1\n(debug,e)\n"),
              Step::PROGRAM_END);
    const std::vector<std::string> want = {"messagea", "messagec", "printd", "messagee"};
    EXPECT_EQ(std::vector<std::string>(machine.record.calls.begin(), machine.record.calls.begin() + 4), want);
}

TEST(Flow, NamesOfIniAndHalCanBeSwitchedOff) {
    class Source final : public test::Mill {
        std::optional<double> ini_value(std::string_view, std::string_view) const override { return 4; }
        std::optional<double> hal_value(std::string_view) const override { return 5; }
    } source;
    for (const bool on : {true, false}) {
        Settings settings;
        settings.ini_readable = settings.hal_readable = on;
        test::Recorder record;
        MachineFrame frame(record, source.units);
        Interpreter interpreter(frame, source, source, source, settings);
        ASSERT_TRUE(interpreter.begin());
        for (const char *line : {"G0 X#<_ini[a]b>", "G0 X#<_hal[c.d]>"}) {
            EXPECT_EQ(interpreter.execute(line), on ? Step::FILE_END : Step::FAILED) << line;
        }
        EXPECT_EQ(interpreter.execute("#1=[exists[#<_hal[c.d]>]] G0 Y#1"), Step::FILE_END);
        EXPECT_EQ(interpreter.parameter(1), on ? 1.0 : 0.0);
    }
}

TEST(Flow, AToolOffsetThatIsRetainedFollowsTheTool) {
    for (const bool retained : {true, false}) {
        Settings settings;
        settings.tool_offset_retained = retained;
        Machine machine(settings);
        for (const double z : {10.0, 20.0}) {
            ToolEntry tool;
            tool.toolno = static_cast<int>(z / 10);
            tool.offset[2] = z;
            machine.mill.tools.push_back(tool);
        }
        constexpr const char *SHOW = "(print,%.0f#<_z> #<_tool_offset>)\n";
        const std::string show = SHOW;
        EXPECT_EQ(machine.run("T1 M6\n" + show + "G43 G0 Z5\nT2 M6\n" + show + "M61 Q1\n" + show +
                              "G0 Z5\nT0 M6\n" + show + "T2 M6\n" + show + "G43.1 Z1\nG20 T1 M6\n" + show +
                              "G49\n"),
                  Step::PROGRAM_END)
            << machine.error();
        Calls prints;
        for (const std::string &call : machine.record.calls) {
            if (call.starts_with("print")) {
                prints.push_back(call);
            }
        }
        const Calls followed = {"print0 0", "print-5 1", "print5 1", "print15 0", "print15 0", "print0 1"};
        const Calls kept = {"print0 0", "print5 1", "print5 1", "print5 1", "print5 1", "print1 1"};
        EXPECT_EQ(prints, retained ? followed : kept);
    }
}

TEST(Flow, NamesOfHalKeepTheirCase) {
    class Source final : public test::Mill {
        std::optional<double> hal_value(std::string_view name) const override {
            return name == "Panel.Speed" ? std::optional<double>(7) : std::nullopt;
        }
    } source;
    test::Recorder record;
    MachineFrame frame(record, source.units);
    Interpreter interpreter(frame, source, source, source, Settings{});
    ASSERT_TRUE(interpreter.begin());
    EXPECT_EQ(interpreter.execute("#<Mine>=#< _HAL[Panel.Speed] > (print,%.0f#<MINE> #<_hal[Panel.Speed]>)"),
              Step::FILE_END)
        << interpreter.error().str();
    EXPECT_EQ(record.calls.back(), "print7 7");
}

TEST(Flow, FanucCallsShareParameters) {
    Machine machine;
    EXPECT_EQ(machine.run("#1=0\nM98 P7 L3\n(print,#1)\nM2\nO7\n#1=[#1+2]\nM99\n"), Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.record.calls[0], "print6.000000");
}

TEST(Flow, ModesSavedByM73ComeBackAfterTheCall) {
    Machine machine;
    EXPECT_EQ(machine.run("G91\no1 sub\nM73\nG90 G20\no1 endsub\no1 call\nG0 X1\nX1\n"), Step::PROGRAM_END)
        << machine.error();
    EXPECT_DOUBLE_EQ(machine.record.lines.back().end[0], 2.0);
}

TEST(Flow, RemappedCodeRunsItsSubroutineWithWords) {
    Settings settings;
    settings.remaps = {"M400 modalgroup=5 argspec=Pq ngc=rm400"};
    Machine machine(settings);
    machine.write("rm400.ngc", "o<rm400> sub\n(print,p=#<p> level #<_remap_level>)\no<rm400> endsub\n");
    EXPECT_EQ(machine.run("M400 P3 G0 X1\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(machine.record.calls[0], "printp=3.000000 level 1.000000");
    EXPECT_EQ(machine.record.lines.size(), 1u);
    EXPECT_EQ(machine.run("M400 Q3\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "user-defined M400: missing: P");
}

TEST(Flow, MdiGoesOnAfterAFailedLine) {
    Machine machine;
    ASSERT_TRUE(machine.interpreter->begin());
    EXPECT_EQ(machine.interpreter->execute("G0 X1"), Step::FILE_END);
    EXPECT_EQ(machine.interpreter->execute("G0 X["), Step::FAILED);
    EXPECT_EQ(machine.interpreter->execute("G0 Y1"), Step::FILE_END);
    EXPECT_EQ(machine.record.lines.size(), 2u);
}

TEST(ParameterFile, ComesBackAsWritten) {
    Machine machine;
    machine.write("a.var", "5221\t12.5\n31 7\n");
    const std::string path = (machine.folder / "a.var").string();
    ASSERT_TRUE(machine.interpreter->load_parameters(path));
    EXPECT_EQ(machine.interpreter->parameter(5221), 12.5);
    ASSERT_TRUE(machine.interpreter->save_parameters(path));
    Machine other;
    ASSERT_TRUE(other.interpreter->load_parameters(path));
    EXPECT_EQ(other.interpreter->parameter(5221), 12.5);
    EXPECT_EQ(other.interpreter->parameter(31), 7);
}

TEST(ParameterFile, BadLinesAreNamed) {
    for (const char *text : {"5221 1\nx 2\n", "5221 1\n5222\n", "5221 1\n5222 1,5\n", "5221 1\n99999 1\n"}) {
        Machine machine;
        machine.write("a.var", text);
        const auto loaded = machine.interpreter->load_parameters((machine.folder / "a.var").string());
        ASSERT_FALSE(loaded) << text;
        EXPECT_EQ(loaded.error().place.line, 2);
        EXPECT_EQ(machine.interpreter->parameter(5221), 0.0) << "nothing is taken from a bad file";
    }
}

}  // namespace
}  // namespace mw::gcode
