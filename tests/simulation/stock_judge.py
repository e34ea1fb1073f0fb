#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Judge of material removal: calculates by brute force the stock that remains after canonical moves of rs274.

Shares no code and no method with web/src/lib/simulation. The tool is placed at many positions along each move. At each position
every point of the stock inside the tool is lowered. The points are at random positions in the squares of a grid, so that no wall
lies on a line of points. Units: mm.
"""
import math
import re

import numpy

STEP = 0.12
CALL = re.compile(r'^\s*\d+\s+N(\S+)\s+(\w+)\(([^)]*)\)')


def moves_of(canon):
    """Yields (line, tool, isRapid, from, function of 0..1, length) of each move."""
    at, plane, tool, selected = [0.0, 0.0, 0.0], 'XY', 0, 0
    for text in canon.splitlines():
        match = CALL.match(text)
        if match is None:
            continue
        line = int(match[1]) if match[1].isdigit() else 0
        name, words = match[2], [one.strip() for one in match[3].split(',')]
        if name == 'SELECT_PLANE':
            plane = words[0].rsplit('_', 1)[1]
        elif name == 'SELECT_TOOL':
            selected = int(words[0])
        elif name == 'CHANGE_TOOL':
            tool = selected
        elif name in ('STRAIGHT_TRAVERSE', 'STRAIGHT_FEED'):
            to = [float(one) for one in words[:3]]
            yield line, tool, name == 'STRAIGHT_TRAVERSE', straight(at, to), math.dist(at, to)
            at = to
        elif name == 'ARC_FEED':
            to, curve, length = arc(at, plane, [float(one) for one in words[:6]])
            yield line, tool, False, curve, length
            at = to


def straight(begin, end):
    def place(part):
        return [a + part * (b - a) for a, b in zip(begin, end)]
    return place


def arc(begin, plane, words):
    """End, curve and length of ARC_FEED in XY, YZ or XZ; the latter counts Z as its first axis."""
    first, second, normal = {'XY': (0, 1, 2), 'YZ': (1, 2, 0), 'XZ': (2, 0, 1)}[plane]
    end = [0.0, 0.0, 0.0]
    end[first], end[second], end[normal] = words[0], words[1], words[5]
    centre, rotation = (words[2], words[3]), int(words[4])
    start = complex(begin[first] - centre[0], begin[second] - centre[1])
    stop = complex(words[0] - centre[0], words[1] - centre[1])
    turn = math.atan2(stop.imag, stop.real) - math.atan2(start.imag, start.real)
    sign = 1 if rotation > 0 else -1
    turn = (turn * sign) % (2 * math.pi)
    if turn < 1e-7:
        turn = 2 * math.pi
    angle = sign * (turn + 2 * math.pi * (abs(rotation) - 1))

    def place(part):
        point = [0.0, 0.0, 0.0]
        radius = abs(start) + part * (abs(stop) - abs(start))
        reach = radius * complex(math.cos(math.atan2(start.imag, start.real) + part * angle),
                                 math.sin(math.atan2(start.imag, start.real) + part * angle))
        point[first], point[second] = centre[0] + reach.real, centre[1] + reach.imag
        point[normal] = begin[normal] + part * (end[normal] - begin[normal])
        return point
    return end, place, abs(angle) * abs(start) + abs(end[normal] - begin[normal])


def profile(tool, distance):
    """Height of a tool above its tip, at distances from its axis; infinite outside of it."""
    radius = tool['diameter_mm'] / 2
    inside = numpy.minimum(distance, radius)
    if tool['shape'] == 'ball':
        height = radius - numpy.sqrt(radius * radius - inside * inside)
    elif tool['shape'] == 'bull':
        corner = tool['corner_radius_mm']
        out = numpy.maximum(inside - (radius - corner), 0)
        height = corner - numpy.sqrt(numpy.maximum(corner * corner - out * out, 0))
    elif tool['shape'] in ('vee', 'drill'):
        flat = tool['tip_diameter_mm'] / 2 if tool['shape'] == 'vee' else 0
        height = numpy.maximum(inside - flat, 0) / math.tan(math.radians(tool['point_angle_deg'] / 2))
    else:
        height = numpy.zeros_like(inside)
    return numpy.where(distance <= radius, height, numpy.inf)


class Stock:
    """Points with a height each."""

    def __init__(self, stock, grid, seed):
        self.low, self.high, self.grid = stock['low'], stock['high'], grid
        self.columns = int(round((self.high[0] - self.low[0]) / grid))
        self.rows = int(round((self.high[1] - self.low[1]) / grid))
        random = numpy.random.default_rng(seed)
        shape = (self.rows, self.columns)
        self.x = self.low[0] + (numpy.arange(self.columns)[None, :] + random.random(shape)) * grid
        self.y = self.low[1] + (numpy.arange(self.rows)[:, None] + random.random(shape)) * grid
        self.z = numpy.full(shape, float(self.high[2]))
        if stock['kind'] == 'cylinder':
            middle = [(a + b) / 2 for a, b in zip(self.low, self.high)]
            radius = min(self.high[0] - self.low[0], self.high[1] - self.low[1]) / 2
            self.z[numpy.hypot(self.x - middle[0], self.y - middle[1]) > radius] = self.low[2]
        self.whole = self.volume()

    def volume(self):
        return float((self.z - self.low[2]).sum()) * self.grid * self.grid

    def near(self, place, radius):
        """The points of all squares that a disc may touch; none where it is outside."""
        span = []
        for axis, count in ((0, self.columns), (1, self.rows)):
            begin = max(0, math.floor((place[axis] - radius - self.low[axis]) / self.grid))
            end = min(count, math.ceil((place[axis] + radius - self.low[axis]) / self.grid))
            if begin >= end:
                return None
            span.append(slice(begin, end))
        return span[1], span[0]

    def contact(self, place, tool, inset):
        """Depth of the highest point of the stock inside the tool, whose surface is reduced by `inset`."""
        part = self.near(place, tool['diameter_mm'] / 2)
        if part is None:
            return -math.inf
        distance = numpy.hypot(self.x[part] - place[0], self.y[part] - place[1])
        depth = numpy.where(self.z[part] > self.low[2], self.z[part], -numpy.inf) - place[2] - profile(tool, distance + inset)
        return float(depth.max())

    def cut(self, place, tool):
        part = self.near(place, tool['diameter_mm'] / 2)
        if part is not None:
            distance = numpy.hypot(self.x[part] - place[0], self.y[part] - place[1])
            surface = numpy.maximum(place[2] + profile(tool, distance), self.low[2])
            numpy.minimum(self.z[part], surface, out=self.z[part])


def raised(place, tool):
    """Height at which the holder begins."""
    return [place[0], place[1], place[2] + tool['stickout_mm']]


def to_box(place, box):
    return math.hypot(max(box['low'][0] - place[0], 0, place[0] - box['high'][0]),
                      max(box['low'][1] - place[1], 0, place[1] - box['high'][1]))


class Verdict:
    """The removed volume, and for each (line, kind) the deepest contact with the tool and with a smaller one."""

    def __init__(self):
        self.removed = 0.0
        self.certain = {}
        self.possible = {}

    def note(self, line, kind, certain, possible):
        self.certain[line, kind] = max(self.certain.get((line, kind), -math.inf), certain)
        self.possible[line, kind] = max(self.possible.get((line, kind), -math.inf), possible)


CERTAIN_INSET, POSSIBLE_INSET = 0.15, 0.0


def judge(canon, job, grid=0.1, seed=1):
    """The effects of a program, from the canonical calls of rs274 and the setup of `job` (see simulation_campaign.py)."""
    stock, verdict = Stock(job['stock'], grid, seed), Verdict()
    for line, number, isRapid, place, length in moves_of(canon):
        tool = job['tools'].get(str(number))
        if tool is None:
            continue
        radius = tool['holder_diameter_mm'] / 2
        holder = {'shape': 'flat', 'diameter_mm': 2 * radius} if tool['stickout_mm'] is not None else None
        steps = max(1, math.ceil(length / STEP))
        places = [place(i / steps) for i in range(steps + 1)]
        for at in places:
            verdict.note(line, 'floor', job['floor_mm'] - at[2], job['floor_mm'] - at[2])
            for box in job['fixtures']:
                hit_box(verdict, line, at, tool, box)
                if holder is not None:
                    hit_box(verdict, line, raised(at, tool), holder, box)
        low = [at for at in places if at[2] < stock.high[2]]
        for at in low if isRapid else []:  # before the move cuts
            verdict.note(line, 'rapid', stock.contact(at, tool, CERTAIN_INSET), stock.contact(at, tool, POSSIBLE_INSET))
        for at in low:
            stock.cut(at, tool)
        for at in low if holder is not None and min(one[2] for one in places) + tool['stickout_mm'] < stock.high[2] else []:
            above = raised(at, tool)
            verdict.note(line, 'holder', stock.contact(above, holder, CERTAIN_INSET), stock.contact(above, holder, POSSIBLE_INSET))
    verdict.removed = stock.whole - stock.volume()
    return verdict


def hit_box(verdict, line, at, tool, box):
    distance = to_box(at, box)
    for inset, sink in ((CERTAIN_INSET, verdict.certain), (POSSIBLE_INSET, verdict.possible)):
        depth = box['high'][2] - at[2] - float(profile(tool, numpy.array([distance + inset]))[0])
        sink[line, 'fixture'] = max(sink.get((line, 'fixture'), -math.inf), depth)
