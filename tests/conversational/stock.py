# SPDX-License-Identifier: GPL-2.0-or-later
"""A block of material as a height map, cut by a flat tool parallel to Z. It detects rapid moves in material, cuts that are too
deep, and plunges. A cell counts as cut when the tool passes over its centre, so distances are exact whatever the cell size. Probe
points lie close to walls."""
import math

import numpy as np

MOST_CELLS = 170
SLOPED_PIECE_RAD = math.radians(12)


class Stock:
    def __init__(self, low, high, top, radius):
        size = max(high[0] - low[0], high[1] - low[1])
        self.cell = max(radius / 5, size / MOST_CELLS)
        self.xs = np.arange(low[0] + 0.37 * self.cell, high[0], self.cell)
        self.ys = np.arange(low[1] + 0.41 * self.cell, high[1], self.cell)
        self.x, self.y = np.meshgrid(self.xs, self.ys)
        self.top = top
        self.height = np.full(self.x.shape, float(top))
        self.probe_x = self.probe_y = self.probe_height = np.zeros(0)

    def add_probes(self, distance, off):
        """Points at distance `off` on both sides of the wall, where the signed distance is 0: a wall is judged with this accuracy."""
        away = distance(self.x, self.y)
        isNear = np.abs(away) < 1.5 * self.cell
        x, y = self.x[isNear], self.y[isNear]
        step = 1e-3 * self.cell
        here = away[isNear]
        dx, dy = (distance(x + step, y) - here) / step, (distance(x, y + step) - here) / step
        xs, ys = [], []
        for side in (-off, off):
            px, py = x - (here - side) * dx, y - (here - side) * dy
            isOnWall = np.abs(distance(px, py) - side) < 0.2 * off
            isInside = (px > self.xs[0]) & (px < self.xs[-1]) & (py > self.ys[0]) & (py < self.ys[-1])
            xs.append(px[isOnWall & isInside])
            ys.append(py[isOnWall & isInside])
        x, y = np.concatenate(xs), np.concatenate(ys)
        order = np.argsort(x)
        self.probe_x, self.probe_y = x[order], y[order]
        self.probe_height = np.full(order.shape, float(self.top))

    def under(self, move_from, move_to, radius, centre=None, sweep=0.0):
        """Heights of cells and probe points near a move, each with a mask of those that the tool passes over."""
        if centre is None:
            low = (min(move_from[0], move_to[0]) - radius, min(move_from[1], move_to[1]) - radius)
            high = (max(move_from[0], move_to[0]) + radius, max(move_from[1], move_to[1]) + radius)
        else:
            reach = math.hypot(move_from[0] - centre[0], move_from[1] - centre[1]) + radius
            low, high = (centre[0] - reach, centre[1] - reach), (centre[0] + reach, centre[1] + reach)
        distance = line_distance if centre is None else arc_distance
        more = () if centre is None else (centre, sweep)
        columns, rows = slice(*np.searchsorted(self.xs, [low[0], high[0]])), slice(*np.searchsorted(self.ys, [low[1], high[1]]))
        probes = slice(*np.searchsorted(self.probe_x, [low[0], high[0]]))
        cells = (rows, columns)
        return [(self.height[cells], distance(self.x[cells], self.y[cells], move_from, move_to, *more) < radius),
                (self.probe_height[probes], distance(self.probe_x[probes], self.probe_y[probes], move_from, move_to, *more) < radius)]


def line_distance(x, y, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    share = np.clip(((x - a[0]) * dx + (y - a[1]) * dy) / square, 0, 1) if square > 0 else 0.0
    return np.hypot(x - a[0] - share * dx, y - a[1] - share * dy)


def arc_distance(x, y, a, b, centre, sweep):
    radius = math.hypot(a[0] - centre[0], a[1] - centre[1])
    around = np.abs(np.hypot(x - centre[0], y - centre[1]) - radius)
    if abs(sweep) >= 2 * math.pi - 1e-9:
        return around
    first = math.atan2(a[1] - centre[1], a[0] - centre[0])
    turned = np.arctan2(y - centre[1], x - centre[0]) - first
    turned = np.mod(turned if sweep > 0 else -turned, 2 * math.pi)
    ends = np.minimum(np.hypot(x - a[0], y - a[1]), np.hypot(x - b[0], y - b[1]))
    return np.where(turned <= abs(sweep), around, ends)


class Judge:
    """Follows moves through a stock. `rules`: step (maximum cut), slope (maximum entry angle; None: plunges are allowed), level
    (minimum Z of rapid moves along X and Y), slack (of lengths)."""

    def __init__(self, stock, radius, rules):
        self.stock, self.radius, self.rules = stock, radius, rules
        self.faults = []
        self.deepest = 0.0
        self.steepest = 0.0

    def fault(self, text, move):
        if len(self.faults) < 5:
            self.faults.append(f'{text}: {move.kind} {tuple(round(v, 4) for v in move.start)} to {tuple(round(v, 4) for v in move.end)}')

    def follow(self, moves):
        for move in moves:
            if move.kind == 'rapid':
                self.rapid(move)
            elif move.kind == 'arc' and abs(move.end[2] - move.start[2]) > 1e-9:
                self.helix(move)
            else:
                self.cut(move, move.start, move.end, move.centre if move.kind == 'arc' else None, move.turns)

    def rapid(self, move):
        across = math.hypot(move.end[0] - move.start[0], move.end[1] - move.start[1])
        lowest = min(move.start[2], move.end[2])
        slack = self.rules['slack']
        if across > slack and lowest < self.rules['level'] - slack:
            self.fault('rapid move across below the clearance', move)
        if any(np.any(heights[mask] > lowest + slack) for heights, mask in self.stock.under(move.start, move.end, self.radius - 2 * slack)):
            self.fault('rapid move in material', move)

    def helix(self, move):
        count = max(1, math.ceil(abs(move.turns) / SLOPED_PIECE_RAD))
        first = math.atan2(move.start[1] - move.centre[1], move.start[0] - move.centre[0])
        reach = math.hypot(move.start[0] - move.centre[0], move.start[1] - move.centre[1])
        before = move.start
        for i in range(1, count + 1):
            turn = first + move.turns * i / count
            here = (move.centre[0] + reach * math.cos(turn), move.centre[1] + reach * math.sin(turn), move.start[2] + (move.end[2] - move.start[2]) * i / count)
            self.cut(move, before, here, move.centre, move.turns / count)
            before = here

    def cut(self, move, begin, end, centre, sweep):
        drop = begin[2] - end[2]
        length = abs(sweep) * math.hypot(begin[0] - centre[0], begin[1] - centre[1]) if centre else math.hypot(end[0] - begin[0], end[1] - begin[1])
        pieces = max(1, math.ceil(length / (self.radius / 2))) if centre is None and abs(drop) > 1e-9 and length > 1e-9 else 1
        before = begin
        for i in range(1, pieces + 1):
            here = tuple(begin[k] + (end[k] - begin[k]) * i / pieces for k in range(3))
            self.piece(move, before, here, centre, sweep, drop / pieces, length / pieces)
            before = here

    def piece(self, move, begin, end, centre, sweep, drop, length):
        z = min(begin[2], end[2])
        under = self.stock.under(begin, end, self.radius, centre, sweep)
        slack = self.rules['slack']
        depth = max(float(np.max(heights[mask] - z, initial=0.0)) for heights, mask in under)
        if depth > slack:
            if move.spindle == 0.0 and move.kind != 'tap':
                self.fault('spindle stopped in material', move)
            self.deepest = max(self.deepest, depth)
            if depth > self.rules['step'] + slack:
                self.fault(f'cut {depth:.4f} deep at once', move)
            if drop > slack and self.rules['slope'] is not None:
                slope = drop / length if length > 1e-9 else math.inf
                self.steepest = max(self.steepest, slope)
                if slope > self.rules['slope'] * 1.02 + 1e-3:
                    self.fault(f'enters material at a slope of {slope:.3f}', move)
        for heights, mask in under:
            heights[mask] = np.minimum(heights[mask], z)
