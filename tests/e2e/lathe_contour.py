#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures the distance between the moves of G70 to G72, as an rs274 prints them, and the programmed contour.

usage: lathe_contour.py RS274 [--program FILE | --digits N] [--gouge MM] [--standing MM] [-- WORD...]
Reads the contour from the program's first subroutine (G0 to G3 with X, Z, I and K in mm, a fillet A between two lines) and the
cycles after it, runs the program with RS274 and measures each cycle: the deepest feed move below the contour plus the allowance
of the cycle (D, or the passes of G70), and the distance of the G70 passes above it. Arcs whose ends have different radii, due to
rounded numbers, change evenly from one radius to the other. Words after -- precede the command (`-- runuser -u op --`). Without a
program: a built-in one, with N decimals. Exit status 1: a measure exceeds its bound.
"""
import argparse
import bisect
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

# A turned pin with the rounding of a CAM system: tangent lines and arcs whose numbers have two to four decimals.
PROGRAM = '''G54 G18 G21
F200
o200 sub
  G0 X4 Z1
  G1 Z-3
  X3.134 Z-4.5
  G2 X2.732 Z-6 I2.598 K-1.5
  G1 Z-8
  G2 X4.732 Z-10 I2 K0
  G1 X5
  G3 X7.165 Z-13.75 I0 K-2.5
  G2 Z-18.75 I4.33 K-2.5
  G1 X12 A0.3
  X10.5 Z-21.598
  X12 Z-24.196
  Z-26
  G2 X12.551 Z-33.2 I5.5 K-3.2
  G1 X14.006 Z-35
  Z-37
  X18
o200 endsub
G71.1 Q200 X18 Z1 D1 I1 R0.3
G71.2 Q200 X18 Z1 D0.51 I0.5 R0.3
G70 Q200 X18 Z1 E0 D0.5 P2
M2
'''
SAMPLE = 0.01  # of moves [mm]
WORD = re.compile(r'([A-Z])\s*([-+]?[\d.]+)')
CALL = re.compile(r'(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED|DWELL)\(([^)]*)\)')


class Stroke:
    """A line or an arc between two points (z, x); `turn`: 1 counterclockwise from Z to X, -1 clockwise, 0 for a line."""

    def __init__(self, start, end, centre=None, turn=0):
        self.start, self.end, self.centre, self.turn = start, end, centre, turn
        if turn:
            self.radii = math.dist(centre, start), math.dist(centre, end)
            self.first = math.atan2(start[1] - centre[1], start[0] - centre[0])
            self.swept = self.turned(end)

    def turned(self, place):
        angle = math.atan2(place[1] - self.centre[1], place[0] - self.centre[0])
        return (angle - self.first) * self.turn % (2 * math.pi)

    def length(self):
        return self.radii[0] * self.swept if self.turn else math.dist(self.start, self.end)

    def at(self, part):
        if not self.turn:
            return tuple(a + part * (b - a) for a, b in zip(self.start, self.end))
        angle = self.first + self.turn * part * self.swept
        radius = self.radii[0] + part * (self.radii[1] - self.radii[0])
        return self.centre[0] + radius * math.cos(angle), self.centre[1] + radius * math.sin(angle)

    def samples(self):
        count = 1 + int(self.length() / SAMPLE)
        return [self.at(i / count) for i in range(count + 1)]

    def distance(self, place):
        ends = min(math.dist(place, self.start), math.dist(place, self.end))
        if self.turn:
            turned = self.turned(place)
            if turned > self.swept or self.swept == 0.0:
                return ends
            radius = self.radii[0] + turned / self.swept * (self.radii[1] - self.radii[0])
            return min(ends, abs(math.dist(place, self.centre) - radius))
        length = math.dist(self.start, self.end)
        along = 0.0 if length == 0.0 else sum((p - a) * (b - a) for p, a, b in zip(place, self.start, self.end)) / length**2
        return math.dist(place, self.at(along)) if 0.0 < along < 1.0 else ends


def filleted(strokes, fillets):
    """Inserts an arc of the radius fillets[i] between the lines i and i + 1."""
    out = list(strokes)
    for i, radius in fillets.items():
        before, after = out[i], out[i + 1]
        corner = before.end
        back = [(a - b) / before.length() for a, b in zip(before.start, corner)]
        ahead = [(a - b) / after.length() for a, b in zip(after.end, corner)]
        half = math.acos(sum(a * b for a, b in zip(back, ahead))) / 2
        reach = radius / math.tan(half)
        begin, end = (tuple(c + reach * d for c, d in zip(corner, way)) for way in (back, ahead))
        middle = [a + b for a, b in zip(back, ahead)]
        centre = tuple(c + m / math.hypot(*middle) * radius / math.sin(half) for c, m in zip(corner, middle))
        turn = 1 if back[0] * ahead[1] - back[1] * ahead[0] < 0 else -1
        out[i], out[i + 1] = Stroke(before.start, begin), Stroke(end, after.end)
        out.insert(i + 1, Stroke(begin, end, centre, turn))
    return out


def contour_of(text):
    """The strokes of the first subroutine."""
    body = re.search(r'^\s*o\d+\s+sub\b(.*?)^\s*o\d+\s+endsub', text, re.I | re.M | re.S).group(1)
    strokes, fillets, at, motion = [], {}, None, 0
    for line in body.upper().splitlines():
        words = dict(WORD.findall(line.split(';')[0]))
        if not words:
            continue
        motion = int(words.get('G', motion))
        z, x = at or (0.0, 0.0)
        to = float(words.get('Z', z)), float(words.get('X', x))
        if at is not None:
            centre = (at[0] + float(words.get('K', 0)), at[1] + float(words.get('I', 0))) if motion > 1 else None
            strokes.append(Stroke(at, to, centre, {2: -1, 3: 1}.get(motion, 0)))
            if 'A' in words:
                fillets[len(strokes) - 1] = float(words['A'])
        at = to
    return filleted(strokes, fillets)


def cycles_of(text):
    """(code, allowance that each of its passes leaves)"""
    out = []
    for line in text.upper().splitlines():
        words = dict(WORD.findall(line))
        if words.get('G', '')[:2] not in ('70', '71', '72') or 'Q' not in words:
            continue
        depth, last, passes = float(words.get('D', 0)), float(words.get('E', 0)), int(words.get('P', 1))
        levels = [last + (depth - last) * i / passes for i in range(passes - 1, -1, -1)] if words['G'] == '70' else [depth]
        out.append((words['G'], levels))
    return out


def rounded(text, digits):
    """The program with fewer digits in its contour."""
    contour, cycles = text.split('G71.1', 1)
    return re.sub(r'\d+\.\d+', lambda number: f'{float(number[0]):.{digits}f}', contour) + 'G71.1' + cycles


def with_dwells(text):
    """The program with a dwell before each cycle, which separates their moves."""
    return re.sub(r'^(?=[ \t]*G7[0-2][.\d]*\s*Q)', 'G4 P0.01\n', text, flags=re.I | re.M)


def cycle_runs(output):
    """For each cycle its runs of feed moves, between rapid moves."""
    at, cycles, is_rapid = None, [], True
    for name, text in CALL.findall(output):
        if name == 'DWELL':
            cycles.append([])
            continue
        values = [float(value) for value in text.split(',')]
        is_arc = name == 'ARC_FEED'
        to = (values[0], values[1]) if is_arc else (values[2], values[0])
        if name == 'STRAIGHT_TRAVERSE':
            is_rapid = True
        elif cycles:
            if is_rapid:
                cycles[-1].append([])
            cycles[-1][-1].append(Stroke(at, to, (values[2], values[3]), 1 if values[4] > 0 else -1) if is_arc else Stroke(at, to))
            is_rapid = False
        at = to
    return cycles


class Contour:
    """Strokes along falling Z with the part below them."""

    def __init__(self, strokes):
        self.strokes = strokes
        self.places = [place for stroke in strokes for place in stroke.samples()]
        self.behind = [-z for z, _ in self.places]

    def height(self, z):
        """The highest point at `z`, interpolated between the adjacent samples."""
        after = bisect.bisect_left(self.behind, -z - 1e-12)
        if after in (0, len(self.places)):
            return -math.inf
        best = self.places[after][1] if self.behind[after] <= -z + 1e-12 else -math.inf
        (z0, x0), (z1, x1) = self.places[after - 1], self.places[after]
        return max(best, x1 if z0 == z1 else x0 + (z - z0) / (z1 - z0) * (x1 - x0))

    def clearance(self, place):
        """Distance to the contour; negative in the part."""
        near = min(stroke.distance(place) for stroke in self.strokes)
        return -near if place[1] < self.height(place[0]) and near > 1e-5 else near


def offs(contour, run, level):
    """Distance of the points of a run of moves above the contour plus `level`; points before it do not count."""
    places = [place for stroke in run for place in stroke.samples() if place[0] <= contour.places[0][0]]
    return [(contour.clearance(place) - level, place) for place in places]


def farthest(contour, run):
    """Checks that a run of moves has followed the contour from its beginning to its end."""
    return max(min(stroke.distance(place) for stroke in run) for place in contour.places[::20])


def judge(contour, cycles, runs, options):
    """Prints the measures; returns whether one exceeds its bound."""
    is_bad = len(runs) != len(cycles)
    for (code, levels), cycle in zip(cycles, runs):
        is_finishing = code == '70'
        if is_finishing and len(cycle) != len(levels):
            print(f'G70 has made {len(cycle)} passes instead of {len(levels)}')
            return True
        for level, made in zip(levels, [[run] for run in cycle] if is_finishing else [cycle]):
            found = [one for run in made for one in offs(contour, run, level)]
            lowest, highest = min(found), max(found)
            line = f'G{code} leaving {level:.3f}: deepest {-lowest[0]:.5f} mm below it at Z{lowest[1][0]:.3f} X{lowest[1][1]:.3f}'
            is_bad = is_bad or -lowest[0] > options.gouge
            if is_finishing:
                left = farthest(contour, made[0])
                line += (f', highest {highest[0]:.5f} mm above it at Z{highest[1][0]:.3f} X{highest[1][1]:.3f}, '
                         f'no place of the contour farther than {left:.4f} mm')
                # In a corner of the contour the distance of the tool is larger by up to a factor of 2.
                is_bad = is_bad or highest[0] > options.standing or left > 2 * level + options.standing
            print(line)
    return is_bad


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('rs274')
    parser.add_argument('--program', type=pathlib.Path)
    parser.add_argument('--digits', type=int, default=3)
    parser.add_argument('--gouge', type=float, default=0.003)
    parser.add_argument('--standing', type=float, default=0.003)
    words = sys.argv[1:]
    before = words[words.index('--') + 1:] if '--' in words else []
    options = parser.parse_args(words[:words.index('--')] if '--' in words else words)
    text = options.program.read_text() if options.program else rounded(PROGRAM, options.digits)
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        program = pathlib.Path(folder, 'program.ngc')
        program.write_text(with_dwells(text))
        done = subprocess.run([*before, options.rs274, '-g', str(program)], capture_output=True, text=True, check=False)
    if 'PROGRAM_END()' not in done.stdout:
        print(f'{options.rs274} did not run the program to its end: {done.stderr.strip()}')
        return 1
    return 1 if judge(Contour(contour_of(text)), cycles_of(text), cycle_runs(done.stdout), options) else 0


if __name__ == '__main__':
    sys.exit(main())
