#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests of the modules gcode, rs274, preview_helpers and linuxcnc.ini, as preview programs use them."""
import contextlib
import io
import math
import os
import tempfile
import unittest

import gcode
import linuxcnc
import preview_helpers
import rs274.interpret


class Recorder:
    """Stores all calls; answers queries from `answers`."""

    def __init__(self, **answers):
        self.calls = []
        self.answers = answers

    def __getattr__(self, name):
        if name.startswith("__") or name in ("use_move_batches", "parameter_file", "random", "move_batch"):
            raise AttributeError(name)

        def method(*args):
            if name in self.answers:
                answer = self.answers[name]
                return answer(*args) if callable(answer) else answer
            if name in ("check_abort", "get_block_delete"):
                return False
            if name == "get_tool":
                return (-1,) + (0.0,) * 12 + (0,)
            if name == "get_axis_mask":
                return 0x1ff
            if name.startswith("get_"):
                return 1
            self.calls.append((name, args))
            return None
        return method

    def named(self, name):
        return [args for called, args in self.calls if called == name]


class GcodeTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, text, name="part.ngc"):
        path = os.path.join(self.folder.name, name)
        with open(path, "w") as out:
            out.write(text)
        return path

    @staticmethod
    def read(path):
        with open(path) as file:
            return file.read()

    def parse(self, text, canon=None, unitcode="G21", initcode=""):
        canon = Recorder() if canon is None else canon
        return canon, gcode.parse(self.write(text), canon, unitcode, initcode)

    def test_moves_come_in_inches_with_offsets_told_apart(self):
        canon, result = self.parse("G0 X25.4\nG92 X0\nG1 F254 Y50.8 A90\nG43.1 Z2.54\nG10 L2 P1 X25.4\nM2\n")
        self.assertEqual(result, (1, 6))
        self.assertEqual(canon.named("straight_traverse"), [(1, 0, 0, 0, 0, 0, 0, 0, 0)])
        self.assertEqual(canon.named("straight_feed"), [(0, 2, 0, 90, 0, 0, 0, 0, 0)])
        self.assertEqual(canon.named("set_feed_rate")[0], (10,))
        self.assertEqual(canon.named("set_g92_offset")[1], (1, 0, 0, 0, 0, 0, 0, 0, 0))
        self.assertAlmostEqual(canon.named("tool_offset")[0][2], 0.1)
        self.assertEqual(canon.named("set_g5x_offset")[1][:2], (1, 1))

    def test_arcs_planes_and_others_have_the_arguments_that_previews_know(self):
        canon, result = self.parse("%\nF100 G3 X50.8 I25.4 Z25.4\nG18\nG2 X0 Z0 R50 \n(hello)\n(msg, look)\nG4 P0.5\n"
                                   "M100 P1 Q2\nG20 M3 S100\nG33.1 Z1 K1\n%\n")
        self.assertEqual(result, (gcode.MIN_ERROR, 11))
        self.assertEqual(canon.named("arc_feed")[0], (2, 0, 1, 0, 1, 1, 0, 0, 0, 0, 0, 0))
        self.assertEqual(canon.named("set_plane"), [(3,)])
        self.assertIn(("hello",), canon.named("comment"))
        self.assertEqual(canon.named("message"), [(" look",)])
        self.assertEqual(canon.named("dwell"), [(0.5,)])
        self.assertEqual(canon.named("user_defined_function"), [(0, 1.0, 2.0)])
        self.assertEqual(canon.named("rigid_tap"), [(0, 0, 1)])

    def test_next_line_comes_before_the_first_call_of_a_line_with_the_codes_before_it(self):
        canon, _ = self.parse("G0 X1\n#1=2\nG1 X2 F10\nM2\n")
        lines = [args[0] for args in canon.named("next_line")]
        self.assertEqual([line.sequence_number for line in lines], [0, 1, 3, 4])
        self.assertEqual(lines[1].motion_mode, 800)
        self.assertEqual(lines[2].motion_mode, 0)
        self.assertEqual(lines[3].motion_mode, 10)
        self.assertEqual(len(lines[3].gcodes), 17)
        self.assertEqual(len(lines[3].mcodes), 10)
        self.assertEqual(lines[3].feed_rate, 10)

    def test_codes_may_come_as_a_list_and_without_a_file(self):
        """Uses the functions as screens do (J2)."""
        canon = Recorder()
        result, _ = gcode.parse(self.write("G1 F600 X1\nM2\n"), canon, ["G20", "G91"], "")
        self.assertLessEqual(result, gcode.MIN_ERROR)
        self.assertEqual([args[0] for name, args in canon.calls if name == "straight_feed"], [1.0])
        told = []

        class Asked(Recorder):
            def user_defined_function(self, number, p, q):
                told.append((number, p))

        result, _ = gcode.parse("", Asked(), "M199 P[2*3+1]", "M2")
        self.assertLessEqual(result, gcode.MIN_ERROR)
        self.assertEqual(told, [(99, 7.0)])

    def test_errors_have_line_and_text(self):
        _, (result, line) = self.parse("G0 X1\nG1 X2\nM2\n")
        self.assertGreater(result, gcode.MIN_ERROR)
        self.assertEqual(line, 2)
        self.assertIn("zero feed rate", gcode.strerror(result))
        _, (result, line) = self.parse("G0 X1\n")
        self.assertGreater(result, gcode.MIN_ERROR)
        with self.assertRaises(RuntimeError):
            gcode.parse("/nowhere/part.ngc", Recorder())
        with self.assertRaises(RuntimeError):
            gcode.parse(self.write("M2\n"), Recorder(), "", "", "other.so")

    def test_codes_before_the_program(self):
        canon, _ = self.parse("G0 X1\nM2\n", None, "G20", "G91\nG0 X5")
        self.assertEqual([args[0] for args in canon.named("straight_traverse")], [5, 6])
        _, (result, _) = self.parse("M2\n", None, "G21", "G1 X1 Q")
        self.assertGreater(result, gcode.MIN_ERROR)

    def test_tools_come_from_the_canon(self):
        table = {0: (0,), 1: (7, 0, 0, 25.4), 2: (3, 0, 0, 50.8)}
        canon = Recorder(get_tool=lambda index: table.get(index, (-1,)))
        canon, result = self.parse("T3 M6\nG43\nM2\n", canon)
        self.assertEqual(result[0], 1)
        self.assertEqual(canon.named("change_tool"), [(2,)])
        self.assertEqual(canon.named("tool_offset")[0][2], 2)

    def test_exceptions_of_the_canon_come_through(self):
        canon = Recorder()

        def refuse(_):
            raise KeyError("dwell")
        canon.dwell = refuse
        with self.assertRaises(KeyError):
            self.parse("G4 P1\nG0 X1\nM2\n", canon)
        self.assertEqual(canon.named("straight_traverse"), [])

    def test_check_abort_ends_a_program_without_end(self):
        with self.assertRaises(KeyboardInterrupt):
            self.parse("o1 while [1]\nG4 P0\no1 endwhile\nM2\n", Recorder(check_abort=True))

    def test_moves_in_batches(self):
        canon = Recorder()
        canon.use_move_batches = True
        batches = []
        canon.move_batch = batches.append
        self.parse("G0 X25.4\nG1 Y25.4 F100\n(stop)\nG1 Z25.4\nM2\n", canon)
        self.assertEqual(batches, [[(0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0)], [(1, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0)],
                                   [(1, 4, 1, 1, 1, 0, 0, 0, 0, 0, 0)]])

    def test_parameters_are_read_and_not_written(self):
        path = self.write("5221 25.4\n100 3\n", "p.var")
        before = self.read(path)
        canon = Recorder()
        canon.parameter_file = path
        self.parse("G0 X#100\nM2\n", canon)
        self.assertAlmostEqual(canon.named("straight_traverse")[0][0], 3 / 25.4)
        self.assertEqual(self.read(path), before)

    def test_remaps_of_the_ini_file(self):
        self.write("from interpreter import *\ndef m400(self, **words):\n    self.execute('G0 X%g' % words['p'])\n"
                   "    return INTERP_OK\n", "remap.py")
        self.write("import remap\n", "toplevel.py")
        self.write("o<deep> sub\nG0 Z#<z>\no<deep> endsub\nM2\n", "deep.ngc")
        ini = self.write("[PYTHON]\nTOPLEVEL = toplevel.py\nPATH_APPEND = .\n[RS274NGC]\n"
                         "SUBROUTINE_PATH = %s\nREMAP = M400 modalgroup=10 argspec=P py=m400\n"
                         "REMAP = G88.1 modalgroup=1 argspec=z ngc=deep\n" % self.folder.name, "m.ini")
        os.environ["INI_FILE_NAME"] = ini
        self.addCleanup(os.environ.pop, "INI_FILE_NAME")
        canon, result = self.parse("G20\nM400 P5\nG88.1 Z-2\nM2\n")
        self.assertEqual(result, (1, 4), gcode.strerror(result[0]))
        self.assertEqual([args[:3] for args in canon.named("straight_traverse")], [(5, 0, 0), (5, 0, -2)])

    def test_extents(self):
        nothing = gcode.calc_extents([])
        self.assertEqual(nothing, ([9e99] * 3, [-9e99] * 3, [9e99] * 3, [-9e99] * 3))
        moves = [(1, (0,) * 9, (1, 2, 3, 4, 5, 6, 7, 8, 9), (0, 0, 5)),
                 (2, (-3,) * 9, (1,) * 9, 100.0, (0, 0, 2))]
        self.assertEqual(gcode.calc_extents(moves, []), ([-3, -3, -3], [1, 2, 3], [-3, -3, -1], [1, 2, 8]))
        with self.assertRaises(TypeError):
            gcode.calc_extents([(1, 2)])


class CanonTest(unittest.TestCase):
    class Chords(rs274.interpret.ArcsToSegmentsMixin, rs274.interpret.Translated):
        lo = (1.0,) + (0.0,) * 8

        def straight_arcsegments(self, segments):
            self.segments = segments

    def test_arcs_become_chords_behind_the_offsets(self):
        canon = self.Chords()
        canon.arcdivision = 8
        canon.arc_feed(0.0, 1.0, 0.0, 0.0, 1, 4.0, 0, 0, 0, 0, 0, 0)
        self.assertEqual(len(canon.segments), 2)
        self.assertAlmostEqual(canon.segments[0][0], math.sqrt(0.5))
        self.assertAlmostEqual(canon.segments[0][2], 2)
        self.assertEqual(canon.segments[-1][:3], (0, 1, 4))
        canon.set_g5x_offset(1, 10, 20, 30, 0, 0, 0, 0, 0, 0)
        canon.set_xy_rotation(90)
        canon.lo = (10.0, 21.0, 30.0) + (0.0,) * 6
        canon.arc_feed(1.0, 0.0, 0.0, 0.0, -1, 0.0, 0, 0, 0, 0, 0, 0)
        self.assertEqual(len(canon.segments), 8)
        for x, y in [point[:2] for point in canon.segments]:
            self.assertAlmostEqual(math.hypot(x - 10, y - 20), 1)

    def test_translated(self):
        canon = rs274.interpret.Translated()
        canon.set_g5x_offset(2, 10, 20, 30, 40, 50, 60, 70, 80, 90)
        canon.set_g92_offset(1, 0, 0, 0, 0, 0, 0, 0, 0)
        canon.set_xy_rotation(90)
        for got, wanted in zip(canon.rotate_and_translate(1, 2, 3, 4, 5, 6, 7, 8, 9),
                               (8, 22, 33, 44, 55, 66, 77, 88, 99)):
            self.assertAlmostEqual(got, wanted)

    def test_print_canon_with_a_status_runs_a_program(self):
        class Status:
            tool_table = [(0,) * 14, (5, 0, 0, 1.0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0)]
            linear_units, angular_units, axis_mask, block_delete = 1.0, 1.0, 7, True
            gcodes = (0, 800, -1, 170, 400, 210, 910, 940, 550, 490, 990, 640, -1, 970, 911, 80, 920)

        class Canon(rs274.interpret.StatMixin, rs274.interpret.PrintCanon):
            pass

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "part.ngc")
            with open(path, "w") as out:
                out.write("T5 M6\nG0 X25.4\nG3 X0 I-12.7 F100\n/G0 Z100\nM2\n")
            ini_path = os.path.join(folder, "m.ini")
            with open(ini_path, "w") as out:
                out.write("[RS274NGC]\nRS274NGC_STARTUP_CODE = G64 P0.01\n")
            codes = preview_helpers.create_unitcode_and_initcode(Status, linuxcnc.ini(ini_path))
            self.assertEqual(codes, ("G21", "G17 G40 G91 G94 G55 G49 G99 G97 G91.1"))
            canon = Canon(Status, 0)
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                result, _ = gcode.parse(path, canon, *codes)
        self.assertEqual(result, 1)
        self.assertEqual(canon.get_tool(0)[0], 5)
        self.assertEqual(canon.get_tool(1000)[0], -1)
        self.assertIn("straight_traverse 1 0 0 0 0 0 0 0 0\n", printed.getvalue())
        self.assertNotIn("straight_traverse 1 0 3.9", printed.getvalue())

    def test_a_preview_begins_where_the_machine_stands(self):
        class Status:
            linear_units, axis_mask, position = 1.0, 0b101, (1.5, 7.0, -2.0, 0, 0, 0, 0, 0, 0)
            polls = 0
            gcodes = (0, 800, -1, 170, 410, 210, 900, 940, 540, 431, 990, 640, -1, 970, 911, 80, -1)

            @classmethod
            def poll(cls):
                cls.polls += 1

        with tempfile.TemporaryDirectory() as folder:
            ini_path = os.path.join(folder, "m.ini")
            with open(ini_path, "w") as out:
                out.write("[RS274NGC]\nRS274NGC_STARTUP_CODE = G43.1 Z1\n")
            ini = linuxcnc.ini(ini_path)
            self.assertEqual(preview_helpers.create_unitcode_and_initcode(Status, ini),
                             ("G21", "G17 G90 G94 G54 G99 G97 G91.1\nG90 G53 G0 X1.500000 Z-2.000000"))
            self.assertEqual(Status.polls, 1)
            Status.gcodes = ()
            self.assertEqual(preview_helpers.create_unitcode_and_initcode(Status, ini), ("G21", "G43.1 Z1"))


class IniTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "m.ini")
        with open(self.path, "w") as out:
            out.write("[A]\nX = 1\nY = hello ; c\nX = -2\nEMPTY =\nT = yes\nF = 1,5\n[B]\nX = 0x10\n")
        self.ini = linuxcnc.ini(self.path)

    def test_find(self):
        self.assertEqual(self.ini.find("A", "X"), "1")
        self.assertEqual(self.ini.find("A", "X", 2), "-2")
        self.assertEqual(self.ini.findall("A", "X"), ["1", "-2"])
        self.assertEqual(self.ini.find("A", "Y"), "hello ; c")
        for section, variable in (("A", "NO"), ("NO", "X"), ("A", "EMPTY")):
            self.assertIsNone(self.ini.find(section, variable))
        self.assertEqual(self.ini.findall("A", "NO"), [])
        with self.assertRaises(linuxcnc.error):
            linuxcnc.ini(self.path + ".no")
        with self.assertRaises(TypeError):
            self.ini.find("A")

    def test_typed_values(self):
        self.assertEqual(self.ini.getsint("A", "X", 2), -2)
        self.assertEqual(self.ini.getint("B", "X"), 16)
        self.assertEqual(self.ini.getreal("A", "X"), 1.0)
        self.assertIs(self.ini.getbool("A", "T"), True)
        self.assertEqual(self.ini.getstring("A", "EMPTY"), "")
        self.assertEqual(self.ini.getfloat("A", "NO", fallback=2.5), 2.5)
        self.assertIsNone(self.ini.getreal("A", "NO"))
        messages = io.StringIO()
        with contextlib.redirect_stderr(messages):
            # A value that does not exist is never replaced by the fallback.
            self.assertIsNone(self.ini.getbool("A", "Y", fallback=True))
            self.assertIsNone(self.ini.getint("A", "Y", fallback=3))
            self.assertEqual(self.ini.getuint("A", "X", 2), 2**64 - 2)
            self.assertEqual(self.ini.getreal("A", "F"), 1.0)
        told = messages.getvalue().splitlines()
        self.assertEqual(len(told), 4)
        for line, (number, kind) in zip(told, ((3, "error"), (3, "error"), (4, "warning"), (7, "warning"))):
            self.assertTrue(line.startswith(f"{self.path}:{number}: {kind}: "), line)

    def test_escapes(self):
        with open(self.path, "w") as out:
            out.write("[A]\nX = a\\tb \\u00e9\nBAD = \\xg0\n")
        ini = linuxcnc.ini(self.path)
        self.assertEqual(ini.getstring("A", "X"), "a\tb é")
        self.assertEqual(ini.find("A", "X"), "a\tb é")
        with self.assertRaisesRegex(linuxcnc.error, "m.ini:3: error: "):
            ini.find("A", "BAD")

    def test_lists_and_places(self):
        self.assertEqual(self.ini.getsections(), ["A", "B"])
        self.assertEqual(self.ini.getvariables("B"), [("X", "0x10")])
        self.assertIn(("Y", "hello ; c"), self.ini.getvariables())
        self.assertEqual(self.ini.getvariables("NO"), [])
        self.assertEqual(self.ini.findall("A", ""), ["1", "hello ; c", "-2", "yes", "1,5"])
        self.assertEqual(self.ini.lineof("A", "NO"), (None, None))
        self.assertTrue(self.ini.hassection("B"))
        self.assertFalse(self.ini.hasvariable("B", "Y"))
        self.assertEqual(self.ini.lineof("A", "X", 2), (self.path, 4))


if __name__ == "__main__":
    unittest.main()
