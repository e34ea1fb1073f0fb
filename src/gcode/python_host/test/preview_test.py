#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Remaps with Python inside gcode.parse: a Python program whose previews run other people's scripts (I1)."""
import os
import sys
import tempfile
import unittest

import gcode

INI = """[PYTHON]
TOPLEVEL = toplevel.py
PATH_PREPEND = .
[RS274NGC]
REMAP = M400 argspec=P py=steps
"""
REMAP = """from interpreter import INTERP_EXECUTE_FINISH


def steps(self, **words):
    assert self.task == 0
    self.execute('G0 X%g' % words['p'])
    yield INTERP_EXECUTE_FINISH
    self.execute('G0 X%g' % (2 * words['p']))
"""


class Canon:
    def __init__(self):
        self.ends = []

    def __getattr__(self, name):
        if name.startswith("__") or name in ("use_move_batches", "parameter_file", "random", "move_batch"):
            raise AttributeError(name)

        def method(*args):
            if name == "get_tool":
                return (-1,) + (0.0,) * 12 + (0,)
            if name.startswith("get_"):
                return 1
            if name == "straight_traverse":
                self.ends.append(args[0])
            return False
        return method


class PreviewTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        for name, text in {"test.ini": INI, "toplevel.py": "import remap\n", "remap.py": REMAP}.items():
            self.write(name, text)
        os.environ["INI_FILE_NAME"] = os.path.join(self.folder.name, "test.ini")
        self.addCleanup(os.environ.pop, "INI_FILE_NAME")

    def write(self, name, text):
        path = os.path.join(self.folder.name, name)
        with open(path, "w") as file:
            file.write(text)
        return path

    def parse(self, text):
        canon = Canon()
        result = gcode.parse(self.write("part.ngc", text), canon, "G20", "")
        return canon, result

    def test_scripts_run_and_leave_the_process_as_it_was(self):
        before = (list(sys.path), sys.modules["__main__"], sys.stdout)
        for _ in range(3):
            canon, (result, _) = self.parse("M400 P1\nG0 X5\nM2\n")
            self.assertLess(result, gcode.MIN_ERROR + 1)
            self.assertEqual([round(x, 9) for x in canon.ends], [1.0, 2.0, 5.0])
        main, out = before[1:]
        self.assertIs(sys.modules["__main__"], main)
        self.assertIs(sys.stdout, out)
        self.assertEqual([p for p in sys.path if p == self.folder.name], [])
        self.assertNotIn("remap", sys.modules)

    def test_errors_of_scripts_are_errors_of_the_program(self):
        self.write("remap.py", "def steps(self, **words):\n    return 1 / 0\n")
        _, (result, line) = self.parse("G0 X1\nM400 P1\nM2\n")
        self.assertGreater(result, gcode.MIN_ERROR)
        self.assertEqual(line, 2)
        self.assertIn("ZeroDivisionError", gcode.strerror(result))


if __name__ == "__main__":
    unittest.main()
