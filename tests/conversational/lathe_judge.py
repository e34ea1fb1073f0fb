# SPDX-License-Identifier: GPL-2.0-or-later
"""Turns a bar with the moves of a lathe operation and compares it with the form. The bar is a radius for each Z; for a bore, the
radius of the hole. The tool is a nose with the cutting edge beside it, or a rectangle."""
import math

import numpy as np

SLACK = {'mm': 0.004, 'inch': 0.0003}
CELLS = 1100
WIDE = {'groove', 'part_off'}


class Bar:
    def __init__(self, low, high, radius, slack, isBore):
        self.cell = (high - low) / CELLS
        self.z = low + (np.arange(CELLS) + 0.37) * self.cell
        self.radius = np.full(CELLS, float(radius))
        self.slack, self.isBore = slack, isBore

    def under(self, low, high):
        return slice(*np.searchsorted(self.z, [low, high]))


def nose_profile(v, z, x, tip_z, sign, body):
    """Radius to which a tool with its tip at (x, tip_z) cuts each z; sign -1: a boring bar."""
    r = v['nose']
    middle, centre = tip_z + r, x + sign * r
    away = np.abs(z - middle)
    round_ = centre - sign * np.sqrt(np.maximum(r * r - away * away, 0))
    profile = np.where(away <= r, round_, np.nan)
    return np.where((z > middle) & (z <= middle + body), x, profile)


class Judge:
    def __init__(self, kind, v, bar):
        self.kind, self.v, self.bar = kind, v, bar
        self.faults = []
        self.body = {'turn': 1.6, 'lathe_bore': 1.6, 'lathe_face': 1.6}.get(kind, 0) * v.get('cut', 0) + (2 * v['nose'] if kind in ('turn', 'lathe_bore', 'lathe_face') else 0)
        self.sign = -1 if bar.isBore else 1

    def fault(self, text, move):
        if len(self.faults) < 4:
            self.faults.append(f'{text}: {move.kind} X{move.start[0]:.4f} Z{move.start[2]:.4f} to X{move.end[0]:.4f} Z{move.end[2]:.4f}')

    def profile(self, x, z):
        v, bar = self.v, self.bar
        if self.kind in WIDE:
            left = z if v['tool_edge'] == 'left' else z - v['tool_width']
            at = bar.under(left, left + v['tool_width'])
            return at, np.full(at.stop - at.start, x)
        at = bar.under(z, z + 2 * v['nose'] + self.body)
        return at, nose_profile(v, bar.z[at], x, z, self.sign, self.body)

    def follow(self, moves):
        for move in moves:
            length = math.hypot(move.end[0] - move.start[0], move.end[2] - move.start[2])
            # A cusp remains between two positions of the nose.
            step = self.v['tool_width'] / 4 if self.kind in WIDE else max(min(self.v['nose'] / 10, math.sqrt(4 * self.v['nose'] * self.bar.slack)) if move.kind != 'rapid' else self.v['nose'] / 2, self.bar.cell / 4)
            count = min(max(1, math.ceil(length / step)), 2000)
            for i in range(count + 1):
                x, z = (move.start[k] + (move.end[k] - move.start[k]) * i / count for k in (0, 2))
                self.at(move, x, z)

    def at(self, move, x, z):
        at, profile = self.profile(x, z)
        radii = self.bar.radius[at]
        if radii.size == 0:
            return
        removed = (radii - profile) * self.sign
        slack = self.bar.slack
        isCut = removed > slack
        if not np.any(isCut):
            return
        if move.kind == 'rapid':
            self.fault('rapid move in material', move)
        if move.spindle == 0:
            self.fault('spindle stopped in material', move)
        self.depth(move, x, z, at)
        self.bar.radius[at] = np.where(isCut, profile, radii)

    def depth(self, move, x, z, at):
        v, slack = self.v, self.bar.slack
        if self.kind in WIDE:
            # Each cut is one feed move from the end of the previous cut.
            if move.end[0] < move.start[0]:
                deepest = float(np.max(self.bar.radius[at])) - move.end[0]
                if deepest > v['peck'] + v['clearance'] + slack:
                    self.fault(f'peck of {deepest:.4f}', move)
            return
        isAlong = abs(move.end[0] - move.start[0]) < 1e-9
        if self.kind in ('turn', 'lathe_bore') and isAlong:
            column = np.searchsorted(self.bar.z, z + v['nose'])
            if column < CELLS:
                deep = (self.bar.radius[column] - x) * self.sign
                if deep > v['cut'] + slack:
                    self.fault(f'cut {deep:.4f} deep', move)


def wanted(kind, v, z):
    """(radius, isJudged) for each z."""
    free = v.get('nose', 0)
    if kind in ('turn', 'lathe_bore'):
        before, after = (v['stock_diameter'], v['part_diameter']) if kind == 'turn' else (v['hole_diameter'], v['bore_diameter'])
        return np.where(z > v['z_end'], after / 2, before / 2), (z < v['z_end']) | (z > v['z_end'] + free)
    if kind == 'lathe_face':
        isShoulder = v['end_diameter'] > 0
        return np.where(z > v['z_end'], v['end_diameter'] / 2, v['stock_diameter'] / 2), (z < v['z_end']) | (z > v['z_end'] + (free if isShoulder else 0))
    if kind == 'groove':
        isIn = (z < v['z_edge']) & (z > v['z_edge'] - v['groove_width'])
        return np.where(isIn, v['groove_diameter'] / 2, v['stock_diameter'] / 2), np.ones(z.shape, dtype=bool)
    if kind == 'part_off':
        isIn = (z < v['z_edge']) & (z > v['z_edge'] - v['tool_width'])
        return np.where(isIn, v['end_diameter'] / 2, v['stock_diameter'] / 2), np.ones(z.shape, dtype=bool)
    edge = v['part_diameter'] / 2
    if kind == 'chamfer':
        return np.minimum(edge, edge - v['chamfer'] + (v['z_start'] - z)), np.ones(z.shape, dtype=bool)
    r = v['radius']
    beyond = np.clip(z - (v['z_start'] - r), 0, r)
    return edge - r + np.sqrt(np.maximum(r * r - beyond * beyond, 0)), z < v['z_start'] - 0.002 * r


def judge_operation(kind, v, moves, unit, pitches=None):
    slack = SLACK[unit]
    if kind == 'lathe_thread':
        return thread_faults(v, moves, slack), {}
    if len(moves) > 1500:
        return [], {'isTooLong': True}
    start = v.get('z_start', 0.0)
    if kind in WIDE:
        wide = v.get('groove_width', v['tool_width'])
        low, high = v['z_edge'] - 2 * wide - v['tool_width'], v['z_edge'] + wide + v['tool_width']
    elif kind in ('chamfer', 'radius'):
        low, high = start - 2 * v[kind] - 2 * v['nose'], start
    else:
        low, high = v['z_end'] - max(2 * v['nose'], (start - v['z_end']) / 4), start
    isBore = kind == 'lathe_bore'
    if kind not in WIDE and v['nose'] < 3 * (high - low) / CELLS:
        return [], {'isTooLong': True}  # the nose is smaller than a cell
    bar = Bar(low, high, v['hole_diameter'] / 2 if isBore else v.get('stock_diameter', v.get('part_diameter')) / 2, slack, isBore)
    judge = Judge(kind, v, bar)
    judge.follow(moves)
    radius, isJudged = wanted(kind, v, bar.z)
    # One cell beside a wall is not judged: the tool is sampled.
    steep = np.abs(np.diff(radius, prepend=radius[0])) > 4 * bar.cell
    isJudged &= ~(steep | np.roll(steep, -1) | np.roll(steep, 1))
    error = (bar.radius - radius) * (-1 if isBore else 1)
    tolerance = slack * np.hypot(1, np.gradient(radius, bar.cell)) + 0.6 * bar.cell
    isThrough = radius <= 0
    wrong = isJudged & np.where(isThrough, bar.radius > slack, np.abs(error) > tolerance)
    faults = list(judge.faults)
    if np.any(wrong):
        at = int(np.argmax(wrong))
        faults.append(f'{"cut too deep" if error[at] < 0 else "material left"}: {int(np.sum(wrong))} of {CELLS} cells, at Z{bar.z[at]:.4f} radius {bar.radius[at]:.4f}, not {radius[at]:.4f}')
    return faults, {'removed': float(np.mean(np.abs(bar.radius - bar.radius[0])))}


def thread_faults(v, moves, slack):
    isOut = v['thread_side'] == 'external'
    sign = 1 if isOut else -1
    crest, root = (v['major'] / 2, v['minor'] / 2) if isOut else (v['minor'] / 2, v['major'] / 2)
    faults = []
    cuts = [m for m in moves if m.kind == 'feed' and abs(m.end[2] - m.start[2]) > v['pitch'] / 2 and (m.end[0] - crest) * sign < 0]
    if not cuts:
        return ['no thread is cut']
    for m in moves:
        lowest = min((m.start[0]) * sign, (m.end[0]) * sign)
        # G76 ends each pass in this way
        isPullOut = m.end[2] == m.start[2] and (m.end[0] - m.start[0]) * sign > 0
        if m.kind == 'rapid' and not isPullOut and lowest < crest * sign - slack and min(m.start[2], m.end[2]) < v['z_start'] - slack:
            faults.append(f'rapid move in the thread: {m.start} {m.end}')
    deepest = min(m.end[0] * sign for m in cuts) * sign
    if abs(deepest - root) > slack:
        faults.append(f'root at {deepest:.4f}, not {root:.4f}')
    last = cuts[-1]
    if abs(last.end[2] - v['z_end']) > slack or last.start[2] < v['z_start'] + 0.5 * v['pitch']:
        faults.append(f'thread from Z{last.start[2]:.4f} to Z{last.end[2]:.4f}')
    if any(abs(m.pitch - v['pitch']) > 1e-4 for m in cuts):
        faults.append(f'pitch {cuts[0].pitch}')
    depths = [abs(m.end[0] - crest) for m in cuts]
    steps = [b - a for a, b in zip([0.0, *depths], depths)]
    if max(steps) > v['first_cut'] + slack:
        faults.append(f'cut {max(steps):.4f} deep, first cut {v["first_cut"]}')
    full = sum(abs(m.end[0] - root) <= slack for m in cuts)
    if not v['springs'] + 1 <= full <= v['springs'] + 2:
        faults.append(f'{full} passes at full depth')
    if any(m.spindle == 0 for m in cuts):
        faults.append('spindle stopped')
    return faults[:4]
