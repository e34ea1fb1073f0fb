// SPDX-License-Identifier: GPL-2.0-or-later
// The scripts' view of the interpreter: parameters, attributes, blocks, call levels, tools, named parameters.
#include <algorithm>

#include "scripted.hh"

namespace mw::python_host::test {
namespace {

using Events = std::vector<std::string>;

/// Runs Python statements (indented here) as an O word. Each failed check is a program error.
void check(Scripted &it, const std::string &program, const std::string &body) {
    it.owords("import emccanon, interpreter\ndef check(self, *args):\n" + body);
    EXPECT_EQ(it.run(program), Step::PROGRAM_END) << it.error();
}

TEST(PythonSurface, ParametersByNumberAndName) {
    Scripted it;
    it.world.ini = [](std::string_view section, std::string_view key) -> std::optional<double> {
        return section == "FOO" && key == "BAR" ? std::optional(3.5) : std::nullopt;
    };
    check(it, "#31=4 #<_shared>=5\no<check> call [6] [7]\n(debug,%d#31 #<_shared> #<_new>)\n",
          "    p = self.params\n"
          "    assert p[31] == 4 and p[1] == 6 and p[2] == 7 and p['_shared'] == 5 and p['_x'] == 0\n"
          "    assert p['_ini[FOO]BAR'] == 3.5 and self.parameters[31] == 4\n"
          "    p[31], p['_shared'], p['_new'], p['local'] = 8, 9, 10, 11\n"
          "    assert p.locals() == ['local'] and '_new' in p.globals() and 'local' in p()\n"
          "    for bad in ('nope', '_nope', '_ini[FOO]NO', None, 1.5):\n"
          "        try:\n            p[bad]\n            raise ValueError(bad)\n"
          "        except RuntimeError:\n            pass\n"
          "    for bad in ('_x', 6000, '_ini[FOO]BAR', '_feed'):\n"
          "        try:\n            p[bad] = 1\n            raise ValueError(bad)\n"
          "        except RuntimeError:\n            pass\n");
    EXPECT_EQ(it.story().back(), "MESSAGE(\"8 9 10\")");
}

TEST(PythonSurface, AttributesOfStateAndOwnOnes) {
    Scripted it;
    it.write("toplevel.py", "import remap, oword\ndef __init__(self):\n    self.mine = 41\n");
    check(it, "G20 G91 G0 X1 F50 S60\nG17\no<check> call\nX1\n",
          "    assert self.mine == 41\n    self.mine += 1\n    assert interpreter.this is self and self.mine "
          "== 42\n"
          "    assert self.current_x == 1 and self.feed_rate == 50 and self.speed[0] == 60 and self.plane == "
          "1\n"
          "    assert self.distance_mode == MODE_INCREMENTAL and self.length_units == 1 and self.motion_mode "
          "== 0\n"
          "    assert self.task == 0 and self.call_level == 1 and self.remap_level == 0 and "
          "self.num_spindles == 1\n"
          "    assert self.filename.endswith('main.ngc') and self.linetext == 'o<check> call'\n"
          "    assert self.active_g_codes[1] == 0 and 200 in list(self.active_g_codes)\n"
          "    assert self.retract_mode == OLD_Z or self.retract_mode == R_PLANE\n"
          "    self.distance_mode = MODE_ABSOLUTE\n    self.current_x = 7\n"
          "    for name in ('call_level', 'task', 'filename', 'params', 'blocks', 'plane'):\n"
          "        try:\n            setattr(self, name, 1)\n            raise ValueError(name)\n"
          "        except AttributeError:\n            pass\n"
          "    try:\n        self.no_such_thing\n        raise ValueError('attribute')\n"
          "    except AttributeError as error:\n"
          "        assert str(error) == \"'Interp' object has no attribute 'no_such_thing'\"\n"
          "    assert equal(1, 1.000001) and is_near_int(2.00001) and nearest_int(2.6) == 3\n"
          "    assert str(INTERP_OK) == 'INTERP_OK' and INTERP_ERROR == 5 and INTERP_MIN_ERROR == 3\n");
    EXPECT_EQ(it.story().back(), "STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)");
}

TEST(PythonSurface, BlocksLevelsOfCallAndTools) {
    Scripted it;
    it.remap("M400 modalgroup=10 argspec=Pq py=look");
    it.handlers(
        "def look(self, **words):\n"
        "    b = self.blocks[self.remap_level]\n"
        "    assert b.p_flag and b.p_number == 2 and not b.q_flag and b.n_number == 7 and b.comment == 'c'\n"
        "    assert list(b.m_modes)[10] == 400 and b.g_modes[2] == 170 and b.g_modes[1] == -1\n"
        "    r = b.executing_remap\n"
        "    assert (r.name, r.argspec, r.remap_py, r.modal_group) == ('M400', 'Pq', 'look', 10)\n"
        "    assert [c.subname for c in self.sub_context][1:4] == ['outer', 'look', '']\n"
        "    names = {e.key(): e.data().value for e in self.sub_context[1].named_params}\n"
        "    assert names == {'here': 3.0}, names\n"
        "    assert [e.key() for e in self.sub_context[0].named_params][:2] == ['_a', '_abs_a']\n"
        "    t = self.tool_table[2]\n"
        "    assert t.toolno == 2 and abs(t.offset.z - 0.1) < 1e-9 and self.tool_table[900].toolno == -1\n"
        "    assert self.find_tool_pocket(3) == (0, 3) and self.find_tool_pocket(99)[0] == 5\n"
        "    assert self.tool_offset.z == 0 and self.tool_offset.tran.x == 0\n"
        "    return INTERP_OK\n");
    it.write("outer.ngc", "o<outer> sub\n#<here>=3\nN7 G17 M400 P2 (c)\no<outer> endsub\n");
    EXPECT_EQ(it.run("o<outer> call\n"), Step::PROGRAM_END) << it.error();
}

TEST(PythonSurface, ToolAtIndex0IsTheOneInTheSpindle) {
    Scripted it;
    it.owords(
        "def look(self, number, z):\n"
        "    t = self.tool_table[0]\n"
        "    assert (t.toolno, abs(t.offset.z - z) < 1e-9) == (number, True), (t.toolno, t.offset.z)\n");
    EXPECT_EQ(it.run("o<look> call [-1] [0]\nT3 M6\no<look> call [3] [1.273]\nG10 L1 P3 Z12.7\n"
                     "o<look> call [3] [12.7]\n"),
              Step::PROGRAM_END)
        << it.error();
}

TEST(PythonSurface, GlobalNamesAreThoseThatScriptsExpect) {
    Scripted it;
    it.write("toplevel.py", "import remap, oword, namedparams\n");
    it.write("namedparams.py", "def _made(self):\n    return 4\n");
    it.owords(
        "def look(self):\n"
        "    names = self.params.globals()\n"
        "    assert {'_abs_u', '_abs_v', '_abs_w', '_mine', 'foo', '_made'} <= set(names), names\n"
        "    assert names == sorted(set(names)), names\n"
        "    attr = {e.key(): e.data().attr for e in self.sub_context[0].named_params}\n"
        "    assert (attr['_made'], attr['_feed'], attr['_mine'], attr['foo']) == (35, 11, 2, 0), attr\n");
    EXPECT_EQ(it.run("#<_mine>=1\n#<foo>=2\no<look> call\n"), Step::PROGRAM_END) << it.error();
}

TEST(PythonSurface, OwordValuesAndErrors) {
    Scripted it;
    it.owords("def none(self, *a):\n    pass\n"
              "def number(self, a, b):\n    return a * b\n"
              "def whole(self):\n    return 5\n"
              "def text(self):\n    return 'no such luck'\n"
              "value = 3\n");
    it.write("number.ngc", "o<number> sub\n(debug,hidden by Python)\no<number> endsub\n");
    ASSERT_EQ(it.run("o<number> call [3] [4]\n(debug,%d#<_value> #<_value_returned>)\no<none> call\n"
                     "(debug,%d#<_value> #<_value_returned>)\n#1=2\no<whole> call\n(debug,%d#<_value> #1)\n"),
              Step::PROGRAM_END)
        << it.error();
    EXPECT_EQ(it.story(), (Events{"MESSAGE(\"12 1\")", "MESSAGE(\"0 0\")", "MESSAGE(\"5 2\")"}));
    ASSERT_EQ(it.run("o<text> call\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "no such luck");
    ASSERT_EQ(it.run("o<number> call [1]\n"), Step::FAILED);
    EXPECT_NE(it.error().find("missing 1 required positional argument"), std::string::npos);
    ASSERT_EQ(it.run("o<value> call\n"), Step::FAILED);
    EXPECT_NE(it.error().find("There is no subroutine o<value>"), std::string::npos);
}

TEST(PythonSurface, NamedParametersComeFromFunctions) {
    Scripted it;
    it.write("toplevel.py", "import remap, oword, namedparams\n");
    it.write("namedparams.py", "def _twice_x(self):\n    return 2 * self.current_x\n"
                               "def _text(self):\n    return 'not today'\n"
                               "def _none(self):\n    pass\n"
                               "def _moves(self):\n    self.execute('G0 X1')\n"
                               "def _feed(self):\n    return 77\n"
                               "def plain(self):\n    return 1\n");
    ASSERT_EQ(it.run("G0 X3\n#1=[#<_twice_x>+1]\n(debug,%d#1 #<_feed> #<plain>)\n"), Step::PROGRAM_END)
        << it.error();
    EXPECT_EQ(it.story().back(), "MESSAGE(\"7 77 ######\")");
    EXPECT_EQ(it.interpreter->warnings(), (Events{"Python redefines the named parameter #<_feed>"}));
    ASSERT_EQ(it.run("#1=#<_text>\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "not today");
    EXPECT_EQ(it.interpreter->error().what.place.column, 4);
    ASSERT_EQ(it.run("#1=#<_none>\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "Python function namedparams._none returns no number");
    ASSERT_EQ(it.run("#1=#<_moves>\n"), Step::FAILED);
    EXPECT_NE(it.error().find("the function of a named parameter cannot execute blocks"), std::string::npos);
    ASSERT_EQ(it.run("#<_twice_x>=3\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "Cannot assign to read-only parameter #<_twice_x>");
}

TEST(PythonSurface, LinesThatBeginWithPyRunAndOthersAreComments) {
    Scripted it;
    ASSERT_EQ(
        it.run(";py,import emccanon; x = 5\n;py,emccanon.MESSAGE('x is %d' % x)\n ;py,boom\nG0 X1 ;py,boom\n"
               "/;py,boom\n;py,self.execute('G0 X2'); this.params['lv'] = 3\n(debug,%d#<lv>)\n"),
        Step::PROGRAM_END)
        << it.error();
    EXPECT_EQ(
        it.story(),
        (Events{"MESSAGE(\"x is 5\")", "STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
                "STRAIGHT_TRAVERSE(2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)", "MESSAGE(\"3\")"}));
    ASSERT_EQ(it.run("\n;py,1/0\n"), Step::FAILED);
    EXPECT_EQ(it.interpreter->error().what.place.line, 2);
    EXPECT_EQ(it.error(), "ZeroDivisionError: division by zero (;py,:1)");
}

TEST(PythonSurface, CanonCallsStandInProgramOrder) {
    Scripted it;
    check(it, "G0 X1\no<check> call\nG0 X2\n",
          "    emccanon.STRAIGHT_FEED(5, 1, 2, 3, 4, 5, 6, 7, 8, 9)\n"
          "    emccanon.ARC_FEED(6, 1, 2, 3, 4, 1, 5, 6, 7, 8, 9, 10, 11)\n"
          "    emccanon.SET_MOTION_OUTPUT_BIT(1)\n    emccanon.CLEAR_AUX_OUTPUT_BIT(2)\n"
          "    emccanon.DWELL(2)\n    emccanon.COMMENT('c')\n    emccanon.CANON_ERROR('oops')\n"
          "    emccanon.SELECT_PLANE(emccanon.CANON_PLANE_XY)\n"
          "    try:\n        emccanon.SPINDLE_RETRACT()\n        raise ValueError('accepted')\n"
          "    except NotImplementedError:\n        pass\n");
    EXPECT_EQ(it.story(),
              (Events{"STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
                      "STRAIGHT_FEED(1.0000, 2.0000, 3.0000, 4.0000, 5.0000, 6.0000)",
                      "ARC_FEED(1.0000, 2.0000, 3.0000, 4.0000, 1, 5.0000, 6.0000, 7.0000, 8.0000)",
                      "SET_MOTION_OUTPUT_BIT(1)", "CLEAR_AUX_OUTPUT_BIT(2)", "DWELL(2.0000)",
                      "COMMENT(\"c\")", "CANON_ERROR(oops)", "SELECT_PLANE(CANON_PLANE_XY)",
                      "STRAIGHT_TRAVERSE(2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
}

TEST(PythonSurface, TwoInterpretersHaveModulesOfTheirOwn) {
    Scripted first("a"), second("b");
    for (Scripted *it : {&first, &second}) {
        it->owords(std::string("count = 0\ndef next(self):\n    global count\n    count += 1\n") +
                   "    import helper\n    return count * helper.FACTOR\n");
        it->write("helper.py", it == &first ? "FACTOR = 1\n" : "FACTOR = 10\n");
    }
    for (int round = 1; round <= 3; ++round) {
        for (Scripted *it : {&first, &second}) {
            ASSERT_EQ(it->run("o<next> call\n(debug,%d#<_value>)\n"), Step::PROGRAM_END) << it->error();
            EXPECT_EQ(it->story()[0],
                      "MESSAGE(\"" + std::to_string(it == &first ? round : round * 10) + "\")");
        }
    }
}

TEST(PythonSurface, HooksRunAtTheStartAndAtTheEnd) {
    std::string note;
    {
        Scripted it;
        note = (std::filesystem::temp_directory_path() / ("mw_pyhost_note_" + std::to_string(::getpid())))
                   .string();
        it.write("toplevel.py",
                 "import remap, oword, emccanon\ndef __init__(self):\n    self.execute('G0 X1')\n"
                 "    emccanon.MESSAGE('init %d' % self.task)\n"
                 "def __delete__(self):\n    open('" +
                     note + "', 'w').write('ended %g' % self.current_x)\n");
        ASSERT_EQ(it.run("G0 X4\n"), Step::PROGRAM_END);
    }
    std::ifstream file(note);
    std::string text;
    std::getline(file, text);
    EXPECT_EQ(text, "ended 4");
    std::filesystem::remove(note);
}

TEST(PythonSurface, ChangedScriptsAreLoadedAgainWhenAsked) {
    Scripted it;
    it.settings.scripts.reloading = true;
    it.owords("def value(self):\n    return 1\n");
    ASSERT_EQ(it.run("o<value> call\n(debug,%d#<_value>)\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story()[0], "MESSAGE(\"1\")");
    it.owords("def value(self):\n    return 22222\n");
    std::filesystem::last_write_time(it.folder / "oword.py",
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5));
    ASSERT_EQ(it.run("o<value> call\n(debug,%d#<_value>)\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story()[0], "MESSAGE(\"22222\")");
}

TEST(PythonSurface, InterpreterIsRefusedOutsideOfHandlers) {
    Scripted it;
    it.owords("import threading\nseen = []\n"
              "def thread(self):\n"
              "    def work():\n        try:\n            self.execute('G0 X1')\n"
              "        except RuntimeError as error:\n            seen.append(str(error))\n"
              "    t = threading.Thread(target=work)\n    t.start()\n    t.join()\n"
              "    return 'wrong' if not seen else None\n");
    EXPECT_EQ(it.run("o<thread> call\n"), Step::PROGRAM_END) << it.error();
}

}  // namespace
}  // namespace mw::python_host::test
