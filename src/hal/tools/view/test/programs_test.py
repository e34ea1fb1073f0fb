#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""millwright hal and the latency programs against a realtime process (requirement B7). usage: programs_test.py BIN"""
import csv
import os
import pathlib
import pty
import select
import subprocess
import sys
import tempfile
import time
import unittest

BIN = pathlib.Path(sys.argv.pop(1)).resolve()
HAL_FILE = """
loadrt threads name1=servo period1=1000000
loadrt siggen
loadrt and2
addf siggen.0.update servo
addf and2.0 servo
setp siggen.0.frequency 10
net wave siggen.0.sine
net gate siggen.0.clock => and2.0.in0
start
"""


class ProgramsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.env = dict(os.environ, MILLWRIGHT_INSTANCE=f"view{os.getpid()}", XDG_RUNTIME_DIR=cls.folder.name,
                       TERM="xterm", LINES="30", COLUMNS="120", PATH=f"{BIN}:/usr/local/bin:/usr/bin:/bin")
        path = pathlib.Path(cls.folder.name, "m.hal")
        path.write_text(HAL_FILE, encoding="utf-8")
        # halrun -I runs until its input ends.
        cls.halrun = subprocess.Popen([BIN / "halrun", "-I", path], env=cls.env, stdin=subprocess.PIPE,
                                      stdout=subprocess.DEVNULL)
        end = time.monotonic() + 10
        while time.monotonic() < end and cls.run_program("millwright", "hal", "watch", "and2.0.out", "--count", "1")[0]:
            time.sleep(0.02)

    @classmethod
    def tearDownClass(cls):
        cls.halrun.stdin.close()
        cls.halrun.wait(20)
        cls.folder.cleanup()

    @classmethod
    def run_program(cls, program, *words):
        done = subprocess.run([BIN / program, *words], env=cls.env, capture_output=True, text=True, timeout=30,
                              check=False, cwd=cls.folder.name)
        return done.returncode, done.stdout, done.stderr

    def test_watch_prints_lines(self):
        status, out, _ = self.run_program("millwright", "hal", "watch", "siggen.0.frequency", "gate", "--count", "3",
                                          "--every", "0.01")
        self.assertEqual(status, 0)
        lines = out.splitlines()
        self.assertEqual(len(lines), 4)
        self.assertEqual(lines[0].split(), ["siggen.0.frequency", "gate"])
        self.assertEqual(lines[1].split()[0], "10")
        self.assertEqual({len(line) for line in lines}, {len(lines[0])}, "values are below their names")

    def test_capture_writes_csv_and_pictures(self):
        status, out, err = self.run_program("millwright", "hal", "capture", "wave", "gate", "--samples", "200",
                                            "--trigger", "wave", "rising", "0", "--pre", "50", "-o", "a.csv", "-o",
                                            "a.png", "-o", "a.svg")
        self.assertEqual((status, out, err), (0, "", ""))
        with open(os.path.join(self.folder.name, "a.csv"), encoding="utf-8") as text:
            rows = list(csv.reader(text))
        self.assertEqual(rows[0], ["time_s", "wave", "gate"])
        self.assertEqual(len(rows), 201)
        values = [float(row[1]) for row in rows[1:]]
        self.assertLessEqual(values[99], 0.0)
        self.assertGreater(values[100], 0.0)
        self.assertTrue(pathlib.Path(self.folder.name, "a.png").read_bytes().startswith(b"\x89PNG"))
        self.assertIn("<svg", pathlib.Path(self.folder.name, "a.svg").read_text(encoding="utf-8"))

    def test_capture_gives_up_or_is_forced(self):
        words = ("millwright", "hal", "capture", "wave", "--samples", "10", "--trigger", "wave", "above", "99",
                 "--timeout", "0.1")
        status, _, err = self.run_program(*words)
        self.assertEqual(status, 1)
        self.assertIn("no trigger", err)
        status, out, _ = self.run_program(*words, "--force")
        self.assertEqual((status, len(out.splitlines())), (0, 11))

    def test_wrong_words_are_told(self):
        for words, text in ((("hal", "capture", "wavee"), "did you mean 'wave'"),
                            (("hal", "capture", "wave", "--sample", "3"), "did you mean --samples"),
                            (("hal", "capture", "wave", "--trigger", "wave", "up", "1"), "unknown trigger type"),
                            (("hal", "watch"), "needs the name"), (("hal", "watch", "no.such"), "no.such"),
                            (("hal", "graph", "-o", "a.gif"), "a.gif")):
            status, _, err = self.run_program("millwright", *words)
            self.assertEqual(status, 1, words)
            self.assertIn(text, err)
        self.assertEqual(self.run_program("millwright", "hal", "grph")[0], 2)

    def test_graph_draws(self):
        status, out, _ = self.run_program("millwright", "hal", "graph")
        self.assertEqual(status, 0)
        self.assertIn('"siggen.0":"siggen.0.clock" -> "and2.0":"and2.0.in0"', out)
        self.assertEqual(self.run_program("millwright", "hal", "graph", "-o", "n.svg")[0], 0)

    def test_live_view_takes_keys(self):
        main, side = pty.openpty()
        viewer = subprocess.Popen([BIN / "millwright", "hal"], env=self.env, stdin=side, stdout=side, stderr=side,
                                  start_new_session=True)
        os.close(side)
        try:
            self.read_until(main, b"millwright hal")
            os.write(main, b"/frequency\r")
            self.read_until(main, b"frequency")
            os.write(main, b"\x1bOB\x1bOBs25\r")
            # The screen is updated only on changes, so the values in HAL are checked.
            end = time.monotonic() + 10
            while self.run_program("halcmd", "getp", "siggen.0.frequency")[1] != "25\n":
                self.assertLess(time.monotonic(), end)
                self.read_some(main)
            os.write(main, b"q")
            while viewer.poll() is None:
                self.read_some(main)
            self.assertEqual(viewer.returncode, 0)
        finally:
            viewer.kill()
            viewer.wait()
        os.close(main)
        self.run_program("halcmd", "setp", "siggen.0.frequency", "10")

    def read_until(self, terminal, text):
        seen = b""
        end = time.monotonic() + 10
        while text not in seen:
            self.assertLess(time.monotonic(), end, f"{text} not in {seen}")
            seen += self.read_some(terminal)

    @staticmethod
    def read_some(terminal):
        if not select.select([terminal], [], [], 0.1)[0]:
            return b""
        try:
            return os.read(terminal, 4096)
        except OSError:
            return b""  # the program has closed it

    def test_live_view_needs_a_terminal(self):
        status, _, err = self.run_program("millwright", "hal")
        self.assertEqual(status, 1)
        self.assertIn("needs a terminal", err)

    def test_latency_programs_measure(self):
        status, out, _ = self.run_program("latency-test", "100us", "1ms", "--seconds", "1", "-o", "l.png")
        self.assertEqual(status, 0)
        rows = out.splitlines()
        self.assertEqual([row.split()[0] for row in rows], ["thread", "base", "servo"])
        self.assertGreater(int(rows[2].split()[-1]), 20)
        status, out, _ = self.run_program("latency-histogram", "--nobase", "--servo", "1000000", "--seconds", "1",
                                          "--csv", "l.csv")
        self.assertEqual(status, 0)
        self.assertIn("intervals by deviation", out)
        with open(os.path.join(self.folder.name, "l.csv"), encoding="utf-8") as text:
            # The threads run a thousand periods. Most may be missing, because the computer may be busy.
            self.assertGreater(sum(int(row["count"]) for row in csv.DictReader(text)), 20)
        self.assertEqual(self.run_program("latency-test", "3x")[0], 1)


if __name__ == "__main__":
    unittest.main()
