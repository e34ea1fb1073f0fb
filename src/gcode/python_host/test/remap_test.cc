// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes with Python: prolog, procedure, epilog, function; synchronisation points; errors.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "gcode/interpreter/scripts/script_stop.hh"
#include "scripted.hh"

namespace mw::python_host::test {
namespace {

using Events = std::vector<std::string>;

TEST(PythonRemap, PrologProcedureAndEpilogShareTheirLocalParameters) {
    Scripted it;
    it.remap("M400 argspec=Pq prolog=before ngc=rm400 epilog=after");
    it.handlers("def before(self, **words):\n"
                "    emccanon.MESSAGE('before %s level %d/%d' % (sorted(words.items()), self.call_level, "
                "self.remap_level))\n"
                "    self.params['doubled'] = 2 * words['p']\n"
                "    return INTERP_OK\n"
                "def after(self, **words):\n"
                "    emccanon.MESSAGE('after %g %g %d' % (self.params['made'], self.return_value, "
                "self.value_returned))\n"
                "    return INTERP_OK\n");
    it.write("rm400.ngc", "o<rm400> sub\n#<made> = [#<doubled> + 1]\nG0 X#<made>\no<rm400> endsub [7]\n");
    ASSERT_EQ(it.run("M400 P3 G0 Y1\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story(), (Events{"MESSAGE(\"before [('p', 3.0)] level 1/1\")",
                                  "STRAIGHT_TRAVERSE(7.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
                                  "MESSAGE(\"after 7 7 1\")",
                                  "STRAIGHT_TRAVERSE(7.0000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
    ASSERT_EQ(it.run("M400\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "user-defined M400: missing: P");
}

/// Another python3 with an empty library is first in PATH.
TEST(PythonRemap, FindsItsOwnModulesWhateverPythonIsFirstOnThePath) {
    namespace fs = std::filesystem;
    const fs::path other = fs::temp_directory_path() / ("mw-other-python-" + std::to_string(::getpid()));
    const fs::path modules = other / "lib" / ("python" MW_PYTHON_VERSION);
    fs::create_directories(modules / "lib-dynload");
    fs::create_directories(other / "bin");
    std::ofstream(modules / "os.py") << "";
    std::ofstream(other / "bin/python3") << "#!/bin/sh\n";
    fs::permissions(other / "bin/python3", fs::perms::owner_all);
    ::unsetenv("VIRTUAL_ENV");
    ::setenv("PATH", ((other / "bin").string() + ":/usr/bin:/bin").c_str(), 1);
    Scripted it;
    it.remap("M400 modalgroup=5 py=where");
    it.handlers(
        "import sys\ndef where(self, **words):\n    emccanon.MESSAGE(sys.prefix)\n    return INTERP_OK\n");
    EXPECT_EQ(it.run("M400\n"), Step::PROGRAM_END) << it.error();
    ASSERT_EQ(it.story().size(), 1U);
    EXPECT_EQ(it.story()[0].find(other.string()), std::string::npos) << it.story()[0];
    fs::remove_all(other);
}

TEST(PythonRemap, PrologRunsBeforeItsProcedureIsLookedFor) {
    Scripted it;
    it.remap("M400 modalgroup=5 prolog=fails ngc=not_there");
    it.remap("M401 modalgroup=5 prolog=says_yes ngc=not_there");
    it.handlers("def fails(self, **words):\n"
                "    emccanon.MESSAGE('it ran')\n"
                "    self.set_errormsg('the prolog said no')\n"
                "    return INTERP_ERROR\n"
                "def says_yes(self, **words):\n"
                "    return INTERP_OK\n");
    ASSERT_EQ(it.run("M400\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "the prolog said no");
    EXPECT_EQ(it.interpreter->error().line_text, "O <not_there> call ");
    EXPECT_EQ(it.story(), (Events{"MESSAGE(\"it ran\")"}));
    ASSERT_EQ(it.run("M401\n"), Step::FAILED);
    EXPECT_NE(it.error().find("There is no subroutine o<not_there>"), std::string::npos) << it.error();
    EXPECT_EQ(it.interpreter->call_level(), 0);
}

TEST(PythonRemap, FunctionExecutesBlocksAndSubroutinesInOrder) {
    Scripted it;
    it.remap("G88.1 modalgroup=1 argspec=xyp py=spiral");
    it.handlers(
        "def spiral(self, **words):\n"
        "    block = self.blocks[self.remap_level]\n"
        "    assert block.x_flag and block.x_number == 4 and not block.y_flag and block.comment == 'hi'\n"
        "    assert self.execute('G1 F100 X%g' % words['x']) == INTERP_OK\n"
        "    assert self.current_x == 4 and self.feed_rate == 100 and self.motion_mode == 10\n"
        "    self.execute('o<inner> call [5]')\n"
        "    assert self.return_value == 10.0 and self.value_returned == 1\n"
        "    return INTERP_OK\n");
    it.write("inner.ngc", "o<inner> sub\nG1 X#1\no<inner> endsub [#1 * 2]\n");
    ASSERT_EQ(it.run("G88.1 X4 (hi)\nG0 X0\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story(), (Events{"COMMENT(\"hi\")", "SET_FEED_RATE(100.0000)",
                                  "STRAIGHT_FEED(4.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
                                  "STRAIGHT_FEED(5.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
                                  "STRAIGHT_TRAVERSE(0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
}

TEST(PythonRemap, YieldWaitsInProgramOrder) {
    Scripted it;
    it.remap("M400 modalgroup=5 py=wait");
    it.handlers("def wait(self, **words):\n"
                "    emccanon.MESSAGE('at %g' % self.current_x)\n"
                "    self.execute('G0 X5')\n"
                "    yield INTERP_EXECUTE_FINISH\n"
                "    emccanon.MESSAGE('at %g' % emccanon.GET_EXTERNAL_POSITION_X())\n"
                "    self.execute('G0 X6')\n"
                "    yield INTERP_EXECUTE_FINISH\n"
                "    emccanon.MESSAGE('at %g' % emccanon.GET_EXTERNAL_POSITION_X())\n");
    ASSERT_EQ(it.run("G0 X1\nM400 G0 X9\nX10\n"), Step::PROGRAM_END) << it.error();
    Events short_story;
    for (const std::string &event : it.story()) {
        short_story.push_back(event.substr(0, event.find(',')));
    }
    EXPECT_EQ(short_story,
              (Events{"STRAIGHT_TRAVERSE(1.0000", "MESSAGE(\"at 1\")", "STRAIGHT_TRAVERSE(5.0000", "SYNC",
                      "MESSAGE(\"at 5\")", "STRAIGHT_TRAVERSE(6.0000", "SYNC", "MESSAGE(\"at 6\")",
                      "STRAIGHT_TRAVERSE(9.0000", "STRAIGHT_TRAVERSE(10.0000"}));
}

TEST(PythonRemap, YieldsInPrologEpilogNestedRemapsAndOwordsKeepTheirOrder) {
    Scripted it;
    it.remap("M400 prolog=step ngc=rm400 epilog=step");
    it.remap("M401 py=inner");
    it.handlers("def step(self, **words):\n"
                "    emccanon.MESSAGE('s1')\n    yield INTERP_EXECUTE_FINISH\n    emccanon.MESSAGE('s2')\n"
                "def inner(self, **words):\n"
                "    emccanon.MESSAGE('i1')\n    yield INTERP_EXECUTE_FINISH\n    emccanon.MESSAGE('i2')\n");
    it.owords("def wait(self, *args):\n"
              "    emccanon.MESSAGE('o1')\n    yield INTERP_EXECUTE_FINISH\n    emccanon.MESSAGE('o2')\n    "
              "return 4\n");
    it.write("rm400.ngc", "o<rm400> sub\nM401\no<wait> call [1]\n(debug,%d#<_value>)\no<rm400> endsub\n");
    ASSERT_EQ(it.run("M400\n(debug,end)\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story(),
              (Events{"MESSAGE(\"s1\")", "SYNC", "MESSAGE(\"s2\")", "MESSAGE(\"i1\")", "SYNC",
                      "MESSAGE(\"i2\")", "MESSAGE(\"o1\")", "SYNC", "MESSAGE(\"o2\")", "MESSAGE(\"4\")",
                      "MESSAGE(\"s1\")", "SYNC", "MESSAGE(\"s2\")", "MESSAGE(\"end\")"}));
}

TEST(PythonRemap, QueueBusterInExecuteSuspendsTheRestUntilTheYield) {
    Scripted it;
    it.remap("M400 py=probe");
    it.handlers("def probe(self, **words):\n"
                "    assert self.execute('o<touch> call') == INTERP_EXECUTE_FINISH\n"
                "    try:\n"
                "        self.execute('G0 X9')\n"
                "    except InterpreterException as error:\n"
                "        emccanon.MESSAGE(error.error_message[:33])\n"
                "    yield INTERP_EXECUTE_FINISH\n"
                "    emccanon.MESSAGE('tripped %g' % self.params[5070])\n"
                "    self.execute('G0 X3')\n");
    it.write("touch.ngc", "o<touch> sub\nG38.3 X2 F10\n(debug,after %d#5070)\no<touch> endsub\n");
    it.world.state.isProbeTripped = true;
    ASSERT_EQ(it.run("M400\nG0 X4\n"), Step::PROGRAM_END) << it.error();
    Events short_story;
    for (const std::string &event : it.story()) {
        if (!event.starts_with("TURN_PROBE")) {
            short_story.push_back(event.substr(0, event.find(',')));
        }
    }
    EXPECT_EQ(short_story,
              (Events{"SET_FEED_RATE(10.0000)", "STRAIGHT_PROBE(2.0000",
                      "MESSAGE(\"a synchronisation point is due (p\")", "SYNC", "MESSAGE(\"after 1\")",
                      "MESSAGE(\"tripped 1\")", "STRAIGHT_TRAVERSE(3.0000", "STRAIGHT_TRAVERSE(4.0000"}));
}

TEST(PythonRemap, AbortDuringAYieldClosesTheScriptAndLeavesTheInterpreterSound) {
    Scripted it;
    it.remap("M400 argspec=p prolog=wait ngc=rm400");
    it.handlers("log = []\n"
                "def wait(self, **words):\n"
                "    self.params['local'] = 1\n"
                "    try:\n"
                "        yield INTERP_EXECUTE_FINISH\n"
                "    finally:\n"
                "        try:\n"
                "            self.execute('G0 X99')\n"
                "        except InterpreterException as error:\n"
                "            log.append(error.error_message)\n");
    it.write("rm400.ngc", "o<rm400> sub\nG0 X50\no<rm400> endsub\n");
    ASSERT_TRUE(it.begin());
    it.interpreter->open_text("main.ngc", "o<a> sub\nM400 P1\no<a> endsub\no<a> call\nM2\n");
    Step step = Step::OK;
    while (step == Step::OK) {
        step = it.interpreter->step();
    }
    ASSERT_EQ(step, Step::SYNC);
    EXPECT_EQ(it.interpreter->call_level(), 2);
    it.interpreter->abort();
    EXPECT_EQ(it.interpreter->call_level(), 0);
    it.drain();
    ASSERT_EQ(it.run(";py,emccanon = __import__('emccanon'); emccanon.MESSAGE(remap.log[0])\nG0 X1\n"),
              Step::PROGRAM_END)
        << it.error();
    EXPECT_EQ(it.story()[0], "MESSAGE(\"cannot execute: the program has ended\")");
    EXPECT_EQ(it.story().size(), 2u);
}

TEST(PythonRemap, ErrorsCarryThePlaceInTheScript) {
    Scripted it;
    it.remap("M400 py=raises");
    it.remap("M401 py=text");
    it.remap("M402 py=code");
    it.remap("M403 py=executes");
    it.remap("M404 py=odd");
    it.remap("M405 prolog=fine ngc=rm405 epilog=text");
    it.handlers("def deep():\n    return 1 / 0\n"           // lines 4 and 5
                "def raises(self, **words):\n    deep()\n"  // 6 and 7
                "def text(self, **words):\n    return 'a plain text'\n"
                "def code(self, **words):\n    self.set_errormsg('set before')\n    return INTERP_ERROR\n"
                "def executes(self, **words):\n    self.execute('G3456')\n"
                "def odd(self, **words):\n    return [1]\n"
                "def fine(self, **words):\n    pass\n");
    it.write("rm405.ngc", "o<rm405> sub\no<rm405> endsub\n");
    const std::string file = (it.folder / "remap.py").string();
    ASSERT_EQ(it.run("M400\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "ZeroDivisionError: division by zero (" + file + ":5 in deep, called from " + file +
                              ":7 in raises)");
    EXPECT_EQ(it.interpreter->error().line_text, "O <raises> call ");
    EXPECT_EQ(it.interpreter->error().what.place.line, 1);
    ASSERT_EQ(it.run("M401\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "a plain text");
    ASSERT_EQ(it.run("M402\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "set before");
    ASSERT_EQ(it.run("G0 X1\nM403\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "Unknown g code used: g3456 (" + file + ":14 in executes)");
    EXPECT_EQ(it.interpreter->error().what.place.line, 2);
    ASSERT_EQ(it.run("M404\n"), Step::FAILED);
    EXPECT_NE(it.error().find("returned an object of type list"), std::string::npos);
    ASSERT_EQ(it.run("M405\n"), Step::FAILED);
    EXPECT_EQ(it.interpreter->error().line_text, "o<rm405> endsub");
    EXPECT_EQ(it.run("G0 X2\n"), Step::PROGRAM_END);
}

/// Like an abort of the machine, from another thread.
TEST(PythonRemap, AScriptWithoutAnEndIsEndedWithItsPlace) {
    Scripted it;
    it.remap("M400 modalgroup=5 py=endless");
    it.remap("M401 modalgroup=5 py=obstinate");
    it.handlers("def endless(self, **words):\n"
                "    while True:\n"
                "        pass\n"
                "def obstinate(self, **words):\n"
                "    ended = 0\n"
                "    while ended < 3:\n"
                "        try:\n"
                "            while True: pass\n"
                "        except:\n"
                "            ended += 1\n"
                "    while True: pass\n");
    gcode::ScriptStop &stop = gcode::script_stop();
    const auto run_and_stop = [&](const char *program) {
        stop.begin();
        std::thread other([&stop] {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            stop.request();
        });
        EXPECT_EQ(it.run(program), Step::FAILED);
        other.join();
        stop.begin();
    };
    run_and_stop("M400\n");
    EXPECT_NE(it.error().find("An abort has ended the script"), std::string::npos) << it.error();
    EXPECT_NE(it.error().find("remap.py:"), std::string::npos) << it.error();
    run_and_stop(";py,while True: pass\n");
    EXPECT_NE(it.error().find("An abort has ended the script (;py,:1"), std::string::npos) << it.error();
    run_and_stop("M401\n");
    EXPECT_NE(it.error().find("An abort has ended the script"), std::string::npos) << it.error();
    EXPECT_EQ(it.run(";py,x = sum(range(100000))\nG0 X1\nM2\n"), Step::PROGRAM_END) << it.error();
}

TEST(PythonRemap, FailedExecuteCanBeHandled) {
    Scripted it;
    it.remap("M400 py=tries");
    it.handlers(
        "def tries(self, **words):\n"
        "    try:\n"
        "        self.execute('o<bad> call', 33)\n"
        "    except InterpreterException as error:\n"
        "        emccanon.MESSAGE('%d|%s|%s' % (error.line_number, error.line_text, error.error_message))\n"
        "    assert self.call_level == 1\n"
        "    interpreter.throw_exceptions = 0\n"
        "    assert self.execute('G1 X') >= INTERP_MIN_ERROR\n"
        "    interpreter.throw_exceptions = 1\n"
        "    self.execute('G0 X2')\n");
    it.write("bad.ngc", "o<bad> sub\n#<here> = 1\nG0 X1\nG1 X2 F0\no<bad> endsub\n");
    ASSERT_EQ(it.run("M400\nG0 X3\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story().size(), 4u);
    EXPECT_EQ(it.story()[1].substr(0, 22), "MESSAGE(\"33|G1 X2 F0|C");
}

TEST(PythonRemap, FunctionThatIsMissingIsNamedAtTheStart) {
    Scripted it;
    it.remap("M400 py=nowhere");
    const Result<> begun = it.begin();
    ASSERT_FALSE(begun);
    EXPECT_EQ(begun.error().place.line, 10);
    EXPECT_NE(begun.error().message.find("'nowhere' is not a Python function of the module remap"),
              std::string::npos);
}

TEST(PythonRemap, ToplevelThatFailsNamesItsPlace) {
    Scripted it;
    it.write("toplevel.py", "import remap\nimport not_there_at_all\n");
    const Result<> begun = it.begin();
    ASSERT_FALSE(begun);
    EXPECT_NE(begun.error().message.find("No module named 'not_there_at_all'"), std::string::npos);
    EXPECT_NE(begun.error().message.find("toplevel.py:2"), std::string::npos);
    Scripted broken;
    broken.write("toplevel.py", "import remap\ndef (\n");
    const Result<> syntax = broken.begin();
    ASSERT_FALSE(syntax);
    EXPECT_NE(syntax.error().message.find("toplevel.py:2"), std::string::npos) << syntax.error().message;
}

TEST(PythonRemap, ProgramEndInsideAScriptEndsTheProgram) {
    Scripted it;
    it.remap("M400 py=ends");
    it.handlers("def ends(self, **words):\n    self.execute('M2')\n");
    ASSERT_EQ(it.run("o<a> sub\nM400\nG0 X5\no<a> endsub\no<a> call\n"), Step::PROGRAM_END);
    EXPECT_EQ(it.events.back(), "ON_RESET()");
    EXPECT_EQ(std::ranges::count(it.events, "PROGRAM_END()"), 1);
    EXPECT_EQ(it.interpreter->call_level(), 0);
}

}  // namespace
}  // namespace mw::python_host::test
