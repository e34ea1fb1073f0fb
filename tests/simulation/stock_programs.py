#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Random milling programs with planted collisions, for the campaign of the simulation. Units: mm."""
import math
import random

SAFE_Z = 5
SHORT_STICKOUT = 9.0
TOP_OF_CLAMP = 4.0


class Writer:
    """Lines with N words that are their line numbers, so that canonical calls refer to them."""

    def __init__(self):
        self.lines = []
        self.planted = []

    def add(self, text, plant=None):
        number = len(self.lines) + 1
        self.lines.append(f'N{number} {text}')
        if plant is not None:
            self.planted.append((number, plant))


def make_tool(rng, number):
    shape = rng.choice(['flat', 'flat', 'ball', 'bull', 'vee', 'drill'])
    diameter = round(rng.uniform(4, 12), 2)
    return {'number': number, 'shape': shape, 'diameter_mm': diameter,
            'corner_radius_mm': round(diameter * rng.uniform(0.1, 0.35), 3),
            'point_angle_deg': rng.choice([60, 90, 118, 140]),
            'tip_diameter_mm': rng.choice([0, round(diameter * 0.2, 3)]),
            'stickout_mm': rng.choice([None, SHORT_STICKOUT, SHORT_STICKOUT, 60.0]),
            'holder_diameter_mm': round(diameter + rng.uniform(8, 25), 2)}


class Program:
    def __init__(self, seed):
        rng = self.rng = random.Random(seed)
        self.size = [rng.randint(36, 60), rng.randint(30, 45), rng.randint(14, 22)]
        self.tools = [make_tool(rng, number) for number in (1, 2, 3)]
        low, high = [0, 0, -self.size[2]], [self.size[0], self.size[1], 0]
        self.stock = {'kind': rng.choice(['box', 'box', 'box', 'cylinder']), 'low': low, 'high': high}
        gap = 14
        self.clamp = {'name': 'clamp', 'low': [high[0] + gap, 5, -5], 'high': [high[0] + gap + 12, high[1] - 5, TOP_OF_CLAMP]}
        self.out = Writer()

    def write(self):
        rng, out = self.rng, self.out
        out.add('G21 G17 G90 G40 G49 G54 G64 F400')
        parts = [self.line, self.line, self.arc, self.helix, self.tunnel, self.saddle, self.drill, self.pocket]
        plants = [self.plant_rapid, self.plant_plunge, self.plant_floor, self.plant_clamp, self.plant_holder]
        chosen = [rng.choice(parts) for _ in range(rng.randint(2, 6))]
        chosen += [rng.choice(plants) for _ in range(rng.choice([0, 1, 1, 2]))]
        rng.shuffle(chosen)
        self.change()
        for part in chosen:
            if rng.random() < 0.3:
                self.change()
            part()
        out.add('M2')
        return '\n'.join(out.lines) + '\n'

    def change(self, tools=None):
        self.tool = self.rng.choice(tools or self.tools)
        self.out.add(f'G0 Z{SAFE_Z}')
        self.out.add(f'T{self.tool["number"]} M6')

    def place(self):
        return [round(self.rng.uniform(0, self.size[axis]), 3) for axis in (0, 1)]

    def depth(self):
        """A depth that no holder reaches."""
        return round(-self.rng.uniform(0.3, min(self.size[2] - 1, SHORT_STICKOUT - 1)), 3)

    def begin(self, place, z):
        self.out.add(f'G0 Z{SAFE_Z}')
        self.out.add(f'G0 X{place[0]:.4f} Y{place[1]:.4f}')
        self.out.add(f'G1 Z{z:.4f}')

    def end(self):
        self.out.add(f'G0 Z{SAFE_Z}')

    def line(self):
        self.begin(self.place(), self.depth())
        for _ in range(self.rng.randint(1, 4)):
            x, y = self.place()
            self.out.add(f'G1 X{x} Y{y}' + (f' Z{self.depth()}' if self.rng.random() < 0.4 else ''))
        self.end()

    def turned(self, radius, angle):
        return radius * math.cos(angle), radius * math.sin(angle)

    def arc(self):
        centre, radius = self.place(), self.rng.uniform(2, 12)
        begin, turn = self.rng.uniform(0, 6.28), self.rng.uniform(0.5, 6)
        code = self.rng.choice(['G2', 'G3'])
        final = begin + (turn if code == 'G3' else -turn)
        (dx, dy), (ex, ey) = self.turned(radius, begin), self.turned(radius, final)
        self.begin([centre[0] + dx, centre[1] + dy], self.depth())
        rise = f' Z{self.depth()}' if self.rng.random() < 0.5 else ''
        self.out.add(f'{code} X{centre[0] + ex:.4f} Y{centre[1] + ey:.4f} I{-dx:.4f} J{-dy:.4f}{rise}')
        self.end()

    def helix(self):
        centre, radius = self.place(), self.rng.uniform(1, 7)
        self.begin([centre[0] + radius, centre[1]], -0.2)
        code = self.rng.choice(['G2', 'G3'])
        self.out.add(f'{code} X{centre[0] + radius:.4f} Y{centre[1]:.4f} I{-radius:.4f} J0 Z{self.depth()} P{self.rng.randint(1, 4)}')
        self.end()

    def vertical_arc(self, plane, first, second):
        """A half circle up or down, along X or Y."""
        begin, z, radius = self.place(), self.depth(), self.rng.uniform(1.5, 3)
        self.begin(begin, z)
        along = 0 if first == 'X' else 1
        isDown = z - radius > 1 - self.size[2] and z - radius > 1 - SHORT_STICKOUT and self.rng.random() < 0.6
        to = begin[along] + 2 * radius
        code = {('X', True): 'G3', ('X', False): 'G2', ('Y', True): 'G3', ('Y', False): 'G2'}[first, isDown]
        if first == 'X':  # G18 is seen from Y+, with Z as its first axis
            code = 'G2' if code == 'G3' else 'G3'
        self.out.add(f'{plane} {code} {first}{to:.4f} Z{z:.4f} {second}{radius:.4f} K0')
        self.out.add('G17')
        self.end()

    def tunnel(self):
        self.vertical_arc('G18', 'X', 'I')

    def saddle(self):
        self.vertical_arc('G19', 'Y', 'J')

    def drill(self):
        self.out.add(f'G0 Z{SAFE_Z}')
        x, y = self.place()
        self.out.add(f'G0 X{x} Y{y}')
        cycle = self.rng.choice(['G81', 'G83'])
        self.out.add(f'{cycle} X{x} Y{y} Z{self.depth()} R1' + (' Q1.5' if cycle == 'G83' else ''))
        for _ in range(self.rng.randint(0, 3)):
            x, y = self.place()
            self.out.add(f'X{x} Y{y}')
        self.out.add('G80')
        self.end()

    def pocket(self):
        begin, final = self.place(), self.place()
        step, y = self.tool['diameter_mm'] * 0.6, min(begin[1], final[1])
        z = self.depth()
        self.begin([begin[0], y], z)
        side = 0
        while y < max(begin[1], final[1]):
            side = 1 - side
            self.out.add(f'G1 X{(final if side else begin)[0]}')
            y += step
            self.out.add(f'G1 Y{y:.4f}')
        self.end()

    def plant_rapid(self):
        place, z = self.place(), self.depth()
        self.begin(place, z)
        x, y = self.place()
        self.out.add(f'G0 X{x} Y{y}', 'rapid')
        self.end()

    def plant_plunge(self):
        x, y = self.place()
        self.out.add(f'G0 Z{SAFE_Z}')
        self.out.add(f'G0 X{x} Y{y}')
        self.out.add(f'G0 Z{self.depth()}', 'rapid')
        self.end()

    def plant_floor(self):
        x, y = self.place()
        self.begin([x, y], -0.2)
        self.out.add(f'G1 Z{-self.size[2] - self.rng.uniform(0.3, 2):.3f}', 'floor')
        self.end()

    def plant_clamp(self):
        low, high = self.clamp['low'], self.clamp['high']
        y = self.rng.uniform(low[1], high[1])
        self.out.add(f'G0 Z{TOP_OF_CLAMP - self.rng.uniform(1, 3):.3f}')
        self.out.add(f'G0 X{(low[0] + high[0]) / 2:.3f} Y{y:.3f}', 'fixture')
        self.out.add(f'G0 Z{SAFE_Z + 5}', 'fixture')
        self.end()

    def plant_holder(self):
        self.change([one for one in self.tools if one['stickout_mm'] == SHORT_STICKOUT])
        x, y = self.place()
        deepest = self.size[2] - 0.5
        self.begin([x, y], -0.2)
        self.out.add(f'G1 Z{-min(deepest, SHORT_STICKOUT + self.rng.uniform(1, 4)):.3f}', 'holder')
        self.end()


def make(seed):
    """A program's text, its setup for judge and simulation, and its planted lines."""
    program = Program(seed)
    text = program.write()
    tools = {str(one['number']): {key: value for key, value in one.items() if key != 'number'} for one in program.tools}
    job = {'stock': program.stock, 'tools': tools, 'fixtures': [program.clamp], 'floor_mm': -program.size[2]}
    return text, job, program.out.planted
