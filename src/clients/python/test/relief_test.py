#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Judges image-to-gcode only by its programs (J4): they are parsed as text, and the tool is moved over the
relief by brute force.
usage: relief_test.py BIN_FOLDER"""
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BIN = pathlib.Path(sys.argv.pop()).resolve()
try:
    import numpy as np
    from PIL import Image
except ImportError:
    print('skipped: python3-pil and python3-numpy are not installed')
    sys.exit(77)


def rise(kind, radius, r):
    """The lower surface of the tool above its tip, from its description."""
    if kind == 'flat':
        return np.zeros_like(r)
    if kind == 'ball':
        return radius - np.sqrt(np.maximum(radius ** 2 - r ** 2, 0))
    return r * {'vee30': math.sqrt(1 / 3), 'vee45': 1.0, 'vee60': math.sqrt(3)}[kind]


def path_of(text):
    """[(rapid, feed, x, y, z)] for the end of each move, from the words of the program only."""
    here, moves, code, feed = {'X': 0.0, 'Y': 0.0, 'Z': None}, [], None, None
    for line in text.splitlines():
        line = re.sub(r'\(.*\)', '', line).strip()
        for g in re.findall(r'G([01])(?![0-9])', line):
            code = int(g)
        if match := re.search(r'F([0-9.]+)', line):
            feed = float(match[1])
        words = re.findall(r'([XYZ])(-?[0-9.]+)', line)
        if words:
            here.update({letter: float(value) for letter, value in words})
            moves.append((code == 0, feed, here['X'], here['Y'], here['Z']))
    return moves


class Judge:
    """The stock that a tool on this path leaves, and its depth of cut into the relief. Heights [row from
    below, column]."""

    def __init__(self, heights, pixel, kind, diameter):
        self.h, self.pixel, self.kind, self.radius = heights, pixel, kind, diameter / 2
        self.left = np.full(heights.shape, np.inf)
        self.gouge, self.rapid_depth = -np.inf, np.inf

    def stand(self, x, y, z):
        reach = self.radius / self.pixel
        i, j = x / self.pixel, y / self.pixel
        rows = slice(max(math.ceil(j - reach), 0), max(math.floor(j + reach) + 1, 0))
        columns = slice(max(math.ceil(i - reach), 0), max(math.floor(i + reach) + 1, 0))
        part = self.h[rows, columns]
        if not part.size:
            return
        yy, xx = np.mgrid[rows.start:rows.start + part.shape[0], columns.start:columns.start + part.shape[1]]
        r = np.hypot(xx * self.pixel - x, yy * self.pixel - y)
        tool = np.where(r <= self.radius + 1e-12, z + rise(self.kind, self.radius, r), np.inf)
        self.gouge = max(self.gouge, float((part - tool).max()))
        self.left[rows, columns] = np.minimum(self.left[rows, columns], tool)

    # Positions are at eighths of a pixel, because the edge of a tool lies on pixels.
    def run(self, moves, every=0.125):
        last = None
        for rapid, _, x, y, z in moves:
            if last:
                count = max(1, math.ceil(math.hypot(x - last[0], y - last[1]) / self.pixel / every - 1e-6))
                for n in range(1, count + 1):
                    f = n / count
                    self.stand(*(a + (b - a) * f for a, b in zip(last, (x, y, z))))
                if rapid and (x, y) != last[:2]:
                    self.rapid_depth = min(self.rapid_depth, z, last[2])
            last = x, y, z
        return self


class ReliefTest(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory(prefix='mw_relief_')
        self.folder = pathlib.Path(self.place.name)
        self.env = {**os.environ, 'HOME': str(self.folder), 'XDG_CONFIG_HOME': str(self.folder / 'config'), 'LC_ALL': 'C'}
        self.env.pop('PYTHONPATH', None)

    def tearDown(self):
        self.place.cleanup()

    def call(self, *words):
        return subprocess.run([BIN / 'image-to-gcode', *map(str, words)], cwd=self.folder, env=self.env, capture_output=True, text=True, check=False, timeout=120)

    def program(self, *words):
        done = self.call(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def picture(self, name, function, width=22, height=17):
        """A picture of function(x, y) in 0..1, y from below; its gray steps as fractions of 1."""
        gray = np.array([[round(255 * function(x, y)) for x in range(width)] for y in range(height)], dtype=np.uint8)
        Image.fromarray(gray[::-1]).save(self.folder / name)
        return gray / 255

    @staticmethod
    def dome(x, y):
        return max(0.0, 0.9 - ((x - 11) ** 2 + (y - 8) ** 2) / 150)

    @staticmethod
    def steps(x, y):
        return 1.0 if 8 <= x < 13 and 5 <= y < 11 else 0.5 if x < 4 else 0.75 if y > 14 and x > 18 else 0.0

    COMMON = '--units mm --pixel-size 0.5 --depth 4 --tool-diameter 3 --safety-height 2 --tolerance 0.02'.split()

    def judge(self, gray, text, tool, safety=2.0):
        judge = Judge((gray - 1) * 4, 0.5, tool, 3.0).run(path_of(text))
        # half of the tolerance, and the rounding of digits
        self.assertLessEqual(judge.gouge, 0.01 + 2e-4, tool)
        self.assertGreaterEqual(judge.rapid_depth, safety)
        self.assertTrue(np.isfinite(judge.left).all(), 'the whole area is covered')
        return judge

    def test_no_gouge_and_all_is_cut(self):
        for name in ('dome', 'steps'):
            gray = self.picture(f'{name}.png', getattr(self, name))
            for number, tool in enumerate(('ball', 'flat', 'vee30', 'vee45', 'vee60')):
                patterns = (('rows', 'positive', 1), ('columns', 'negative', 2), ('rows-columns', 'alternating', 2), ('columns-rows', 'up', 3),
                            ('rows', 'down', 1), ('columns', 'alternating', 1))
                for pattern, direction, over in patterns[number % 2::2]:
                    text = self.program(f'{name}.png', *self.COMMON, '--tool', tool, '--pattern', pattern, '--direction', direction, '--step-over', over)
                    judge = self.judge(gray, text, tool)
                    if over == 1:
                        # Everything that the tool can reach is cut, except for the margin of an eighth of a
                        # pixel on slopes.
                        reached = self.reachable(judge)
                        slope = max(np.abs(np.diff(judge.h, axis=0)).max(), np.abs(np.diff(judge.h, axis=1)).max())
                        self.assertLessEqual((judge.left - reached).max(), 0.01 + slope / 4 + 2e-4, (name, tool, pattern))
                        self.assertLessEqual(np.median(judge.left - reached), 0.01 + slope / 16, (name, tool, pattern))

    @staticmethod
    def reachable(judge):
        """The minimum height that the tool can leave above each pixel, by brute force over all positions."""
        rows, columns = judge.h.shape
        yy, xx = np.mgrid[0:rows, 0:columns]
        left = np.full(judge.h.shape, np.inf)
        for j in range(rows):
            for i in range(columns):
                r = np.hypot(xx - i, yy - j) * judge.pixel
                tool = np.where(r <= judge.radius, rise(judge.kind, judge.radius, r), np.inf)
                left = np.minimum(left, (judge.h - tool).max() + tool)
        return left

    def test_directions(self):
        self.picture('dome.png', self.dome)
        rows = {}
        for direction in ('positive', 'negative', 'alternating', 'up', 'down'):
            moves = path_of(self.program('dome.png', *self.COMMON, '--direction', direction, '--step-over', 3))
            rows[direction] = [(a, b) for a, b in zip(moves, moves[1:]) if not b[0] and a[3] == b[3] and a[2] != b[2]]
        self.assertTrue(all(b[2] > a[2] for a, b in rows['positive']))
        self.assertTrue(all(b[2] < a[2] for a, b in rows['negative']))
        self.assertEqual({b[2] > a[2] for a, b in rows['alternating']}, {True, False})
        # A straight line may deviate by the tolerance.
        self.assertTrue(all(b[4] >= a[4] - 0.02 for a, b in rows['up']))
        self.assertTrue(all(b[4] <= a[4] + 0.02 for a, b in rows['down']))
        self.assertTrue(any(b[4] > a[4] + 0.1 for a, b in rows['up']))

    def test_lace_bounding(self):
        for name in ('dome', 'steps'):
            gray = self.picture(f'{name}.png', getattr(self, name), 60, 50)
            lengths = []
            for lace in ('none', 'secondary', 'full'):
                text = self.program(f'{name}.png', *self.COMMON, '--pattern', 'rows-columns', '--step-over', 2, '--tool', 'flat', '--lace', lace)
                self.judge(gray, text, 'flat')
                moves = path_of(text)
                lengths.append(sum(math.dist(a[2:], b[2:]) for a, b in zip(moves, moves[1:]) if not b[0]))
            self.assertLess(lengths[1], lengths[0] * 0.95)
            self.assertLess(lengths[2], lengths[0])

    def test_roughing(self):
        gray = self.picture('steps.png', self.steps)
        text = self.program('steps.png', *self.COMMON, '--tool', 'flat', '--step-over', 2, '--roughing-offset', 0.5, '--roughing-depth', 1.5)
        self.judge(gray, text, 'flat')
        # No cut is deeper than a layer. The remaining height is updated along the path.
        judge, last = Judge((gray - 1) * 4, 0.5, 'flat', 3.0), None
        judge.left[:] = 0.0
        for rapid, _, x, y, z in path_of(text):
            if last and not rapid:
                for n in range(1, 20):
                    at = [a + (b - a) * n / 19 for a, b in zip(last, (x, y, z))]
                    column, row = round(at[0] / 0.5), round(at[1] / 0.5)
                    self.assertLessEqual(judge.left[row, column] - at[2], 1.5 + 0.02)
            if last:
                for n in range(1, 20):
                    judge.stand(*(a + (b - a) * n / 19 for a, b in zip(last, (x, y, z))))
            last = x, y, z

    def test_pictures(self):
        common = [*self.COMMON, '--step-over', 1, '--tool', 'flat', '--tool-diameter', 0.4, '--tolerance', 0]

        def depth_at(text, x, y):
            """Depth of the cut along its moves in x."""
            moves, found = path_of(text), []
            for (_, _, a, b, c), (rapid, _, d, e, f) in zip(moves, moves[1:]):
                if not rapid and b == e == y and min(a, d) <= x <= max(a, d):
                    found.append(min(c, f) if a == d else c + (f - c) * (x - a) / (d - a))
            return round(min(found), 6)
        one = np.zeros((5, 6), np.uint8)
        one[0, 2] = 255  # the pixel is in the uppermost row
        Image.fromarray(one).save(self.folder / 'one.png')
        text = self.program('one.png', *common)
        self.assertEqual((depth_at(text, 1.0, 2.0), depth_at(text, 1.0, 0.0), depth_at(text, 2.5, 2.0)), (0.0, -4.0, -4.0))
        self.assertEqual(depth_at(self.program('one.png', *common, '--invert'), 1.0, 2.0), -4.0)
        # 16 bits are not reduced to 8; normalized from black to white.
        Image.fromarray(np.array([[1000, 1100], [1200, 1300]], np.uint16)).save(self.folder / 'deep.png')
        text = self.program('deep.png', *common, '--normalize')
        self.assertEqual([round(depth_at(text, x, y), 3) for x, y in ((0, 0.5), (0.5, 0.5), (0, 0), (0.5, 0))], [-4, -2.667, -1.333, 0])
        # The border is outside of the picture, whose position does not change.
        text = self.program('one.png', *common, '--expand', 'white', '--tool-diameter', 1.2)
        self.assertEqual(min(x for _, _, x, *_ in path_of(text)), -1.5)
        self.assertEqual(depth_at(text, 1.0, 2.0), 0.0)

    def test_settings_are_remembered_when_asked(self):
        self.picture('dome.png', self.dome)
        first = self.program('dome.png', '--step-over', 4)
        self.assertIn('G20', first)
        self.program('dome.png', *self.COMMON, '--step-over', 4, '--remember')
        again = self.call('dome.png')
        self.assertIn('G21', again.stdout)
        self.assertIn('pixel-size=0.5', again.stdout)
        self.assertIn(f'settings of {self.folder}/config/millwright/image-to-gcode.json', again.stderr)
        self.assertIn('tool-diameter=0.118', self.program('dome.png', '--units', 'in'))  # 3 mm
        self.assertEqual(self.program('dome.png', '--forget', '--step-over', 4), first)
        kept = self.folder / 'config/millwright/image-to-gcode.json'
        for text, said in (('{', 'Expecting'), ('{"depth": "deep"}', '"depth": "deep" is no setting'), ('{"dept": 1}', '"dept": 1 is no'), ('[]', 'is no setting')):
            kept.write_text(text)
            done = self.call('dome.png')
            self.assertEqual((done.returncode, done.stdout), (1, ''))
            self.assertIn(said, done.stderr)
        kept.write_text(json.dumps({'tool': 'flat'}))
        self.assertIn('tool=flat', self.program('dome.png'))

    def test_what_is_wrong_is_said(self):
        self.picture('dome.png', self.dome)
        (self.folder / 'text.png').write_text('no picture')
        Image.new('L', (5, 5), 7).save(self.folder / 'even.png')
        Image.new('L', (1, 5), 7).save(self.folder / 'thin.png')
        for words, said in ((['none.png'], 'none.png: No such file'), (['text.png'], 'cannot identify'), (['even.png', '--normalize'], 'all pixels are the same'),
                            (['thin.png'], 'at least 2 x 2'), (['dome.png', '--depth', '0'], '--depth 0'), (['dome.png', '--safety-height', '-1'], 'above zero'),
                            (['dome.png', '--feed', 'nan'], 'above zero'), (['dome.png', '--contact-angle', '90'], 'between 0 and 90')):
            done = self.call(*words)
            self.assertEqual((done.returncode, done.stdout), (1, ''), words)
            self.assertIn(said, done.stderr)
        self.assertIn('stock stays between them', self.call('dome.png', '--step-over', 20).stderr)
        # A file is written completely or not at all.
        self.program('dome.png', '-o', 'out.ngc')
        self.assertTrue((self.folder / 'out.ngc').read_text().endswith('M5\nM2\n'))
        self.assertEqual(self.call('dome.png', '-o', 'nowhere/out.ngc').returncode, 1)

    @unittest.skipUnless((BIN / 'rs274').exists(), 'rs274 is not built')
    def test_the_interpreter_takes_it(self):
        self.picture('dome (1).png', self.dome)
        self.program('dome (1).png', *self.COMMON, '--pattern', 'rows-columns', '-o', 'out.ngc')
        done = subprocess.run([BIN / 'rs274', '-g', 'out.ngc'], cwd=self.folder, env=self.env, capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('STRAIGHT_FEED', done.stdout)


if __name__ == '__main__':
    unittest.main()
