# SPDX-License-Identifier: GPL-2.0-or-later
"""Random programs as CAM systems post them: mills with 3 to 5 axes, lathes without Y, lasers without Z.

make(seed) returns a Program: its text, the letters of the machine's axes, and whether the machine unit is the inch. The
differences between posts are drawn once per program: arc ends rounded to 3 or 4 decimals, incremental or absolute centres or
radii, modal or full words, line numbers, comments, `%`, spaces, leading zeros. The numbers of an arc are rounded separately, as
posts do.
"""
import math
import random


class Program:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.kind = self.random.choice(('mill', 'mill', 'mill', 'mill4', 'mill5', 'lathe', 'lathe', 'laser'))
        self.axes = {'mill': 'XYZ', 'mill4': 'XYZA', 'mill5': 'XYZAC', 'lathe': 'XZ', 'laser': 'XY'}[self.kind]
        self.is_inch = self.chance(0.3)
        self.digits = self.random.choice((3, 4)) + (1 if self.is_inch and self.chance(0.5) else 0)
        self.is_numbered = self.chance(0.6)
        self.step = self.random.choice((1, 5, 10))
        self.is_spaced = self.chance(0.8)
        self.is_modal = self.chance(0.7)
        self.centres = self.random.choice(('incremental', 'incremental', 'absolute', 'radius'))
        self.is_semicolon = self.chance(0.3)
        self.isLeadingZero = self.chance(0.3)
        self.lines, self.number_of_line = [], 0
        self.position, self.mode = {}, None
        self.offset_tool = 0  # whose offset is active
        self.write()

    def chance(self, part):
        return self.random.random() < part

    def mm(self, low, high):
        """A length in mm, converted to the program's unit."""
        return self.random.uniform(low, high) / (25.4 if self.is_inch else 1.0)

    def rounded(self, value):
        return round(value, self.digits) + 0.0

    def figure(self, value):
        text = f'{self.rounded(value):.{self.digits}f}'
        if self.isLeadingZero:
            return text
        return text.rstrip('0') if text.rstrip('0').endswith('.') is False else text.rstrip('0')[:-1] + '.'

    def put(self, *words):
        joined = (' ' if self.is_spaced else '').join(words)
        if self.is_numbered and joined:
            self.number_of_line += self.step
            joined = f'N{self.number_of_line}' + (' ' if self.is_spaced else '') + joined
        self.lines.append(joined)

    def comment(self, text):
        self.lines.append(f'; {text}' if self.is_semicolon else f'({text})')

    def word(self, letter, value):
        return f'{letter}{self.figure(value)}'

    def move(self, code, feed=None, **target):
        """Modal posts omit words that do not change."""
        words = [] if self.is_modal and self.mode == code else [code]
        self.mode = code
        moved = {letter.upper(): self.rounded(value) for letter, value in target.items()}
        changed = {letter: value for letter, value in moved.items() if not self.is_modal or self.position.get(letter) != value}
        if not changed:
            return
        words += [self.word(letter, value) for letter, value in changed.items()]
        self.position.update(moved)
        if feed is not None:
            words.append(f'F{self.figure(feed)}')
        self.put(*words)

    def arc(self, isClockwise, centre, end, letters, **more):
        """About `centre` in the plane of two letters; each number is rounded separately."""
        code = 'G2' if isClockwise else 'G3'
        a, b = letters
        start = (self.position[a], self.position[b])
        radius = math.dist(start, centre)
        turned = math.atan2(end[1] - centre[1], end[0] - centre[0]) - math.atan2(start[1] - centre[1], start[0] - centre[0])
        turned = (-turned if isClockwise else turned) % (2 * math.pi)
        names = {'X': 'I', 'Y': 'J', 'Z': 'K'}
        words = [code, self.word(a, end[0]), self.word(b, end[1])]
        words += [self.word(letter, value) for letter, value in more.items()]
        # Posts do not write the radius of arcs of about half a turn or more, because its rounding moves the
        # centre.
        if self.centres == 'radius' and 0.2 < turned < 2.4:
            words.append(self.word('R', radius))
        elif self.centres == 'absolute':
            words += [self.word(names[a], centre[0]), self.word(names[b], centre[1])]
        else:
            words += [self.word(names[a], centre[0] - start[0]), self.word(names[b], centre[1] - start[1])]
        self.position.update({a: self.rounded(end[0]), b: self.rounded(end[1]),
                              **{letter: self.rounded(value) for letter, value in more.items()}})
        self.mode = code
        self.put(*words)

    def change_tool(self, tool):
        self.put(f'T{tool}', 'M6')
        self.mode = None
        if self.chance(0.7):
            self.put('G43', f'H{tool}')
            self.offset_tool = tool

    def write(self):
        isPercent = self.chance(0.6)
        if isPercent:
            self.lines.append('%')
        if self.chance(0.3):
            self.lines.append(f'({self.random.choice(("PROGRAM", "O1001", "PART 7"))} {self.kind})')
        self.comment(f'POST {self.random.randint(1, 99)}, {"INCH" if self.is_inch else "MM"}')
        plane = 'G18' if self.kind == 'lathe' else 'G17'
        self.put(plane, 'G20' if self.is_inch else 'G21', 'G90', 'G94', 'G40', 'G49', 'G80')
        self.put('G90.1' if self.centres == 'absolute' else 'G91.1')
        self.put('G54')
        self.put('G64', f'P{0.0005 if self.is_inch else 0.01}')
        {'lathe': self.lathe, 'laser': self.laser}.get(self.kind, self.mill)()
        self.put('M30' if self.chance(0.5) else 'M2')
        if isPercent:
            self.lines.append('%')

    def text(self):
        return '\n'.join(self.lines) + '\n'

    def expected_end(self):
        """The end point of the program by its words, in mm and degrees."""
        scale = 25.4 if self.is_inch else 1.0
        return {letter: value * (1.0 if letter in 'AC' else scale) for letter, value in self.position.items()}

    # ------------------------------------------------------------------------------------------------- mill
    def mill(self):
        for tool in range(1, self.random.randint(2, 3)):
            self.comment(f'TOOL {tool}')
            self.change_tool(tool)
            self.put(f'S{self.random.randint(800, 6000)}', self.random.choice(('M3', 'M3', 'M4')))
            self.put(self.random.choice(('M8', 'M7')))
            self.move('G0', Z=self.mm(15, 25))
            for _ in range(self.random.randint(1, 3)):
                choices = [self.contour, self.contour, self.slot, self.holes, self.helix]
                if 'A' in self.axes:
                    choices += [self.wrapped, self.wrapped]
                if 'C' in self.axes:
                    choices += [self.swung, self.swung]
                self.random.choice(choices)()
            self.move('G0', Z=self.mm(26, 30))
            if 'A' in self.axes:
                self.move('G0', A=0.0)
            self.put('M9')
            self.put('M5')

    def contour(self):
        """A rectangle with rounded corners, entered on a tangent quarter circle."""
        x, y, w, h = self.mm(-20, 20), self.mm(-20, 20), self.mm(15, 40), self.mm(15, 40)
        r, depth, lead = self.mm(1, 6), self.mm(-5, -0.5), self.mm(2, 4)
        self.comment('CONTOUR')
        self.move('G0', X=x + w / 2 - lead, Y=y - lead)
        self.move('G0', Z=self.mm(1, 3))
        self.move('G1', feed=self.mm(100, 300), Z=depth)
        self.move('G1', feed=self.mm(300, 900), X=x + w / 2, Y=y)
        corners = [((x + w - r, y), (x + w - r, y + r), (x + w, y + r)), ((x + w, y + h - r), (x + w - r, y + h - r), (x + w - r, y + h)),
                   ((x + r, y + h), (x + r, y + h - r), (x, y + h - r)), ((x, y + r), (x + r, y + r), (x + r, y))]
        for start, centre, end in corners:
            self.move('G1', X=start[0], Y=start[1])
            self.arc(False, centre, end, 'XY')
        self.move('G1', X=x + w / 2, Y=y)
        self.move('G0', Z=self.mm(5, 10))

    def slot(self):
        """Inclined lines with half circles between them."""
        x, y, r, length = self.mm(-20, 20), self.mm(-20, 20), self.mm(2, 8), self.mm(5, 25)
        angle = self.random.uniform(0, 2 * math.pi)
        u, v = (math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))

        def at(a, b):
            return (x + a * u[0] + b * v[0], y + a * u[1] + b * v[1])
        self.comment('SLOT')
        first = at(0, -r)
        self.move('G0', X=first[0], Y=first[1])
        self.move('G1', feed=self.mm(100, 300), Z=self.mm(-4, -1))
        for side in (1, -1):
            end = at(length if side > 0 else 0, -r * side)
            self.move('G1', feed=self.mm(300, 900) if side > 0 else None, X=end[0], Y=end[1])
            self.arc(False, at(length if side > 0 else 0, 0), at(length if side > 0 else 0, r * side), 'XY')
        self.move('G0', Z=self.mm(5, 10))

    def helix(self):
        x, y, r = self.mm(-20, 20), self.mm(-20, 20), self.mm(2, 10)
        z = self.mm(0.5, 1)
        self.comment('HELIX')
        self.move('G0', X=x + r, Y=y)
        self.move('G1', feed=self.mm(200, 600), Z=z)
        for i in range(self.random.randint(2, 4)):
            side = -1 if i % 2 == 0 else 1
            z -= self.mm(0.3, 0.8)
            self.arc(False, (x, y), (x + side * r, y), 'XY', Z=z)
        self.move('G0', Z=self.mm(5, 10))

    def holes(self):
        code = self.random.choice(('G81', 'G82', 'G83', 'G73'))
        depth, r = self.rounded(self.mm(-12, -3)), self.rounded(self.mm(1, 3))
        self.comment('DRILL')
        self.put(self.random.choice(('G98', 'G99')))
        for i in range(self.random.randint(2, 6)):
            x, y = self.rounded(self.mm(-30, 30)), self.rounded(self.mm(-30, 30))
            words = [self.word('X', x), self.word('Y', y)]
            if i == 0:
                words = [code, *words, self.word('Z', depth), self.word('R', r)]
                words += ['P0.1'] if code == 'G82' else [self.word('Q', self.mm(1, 3))] if code in ('G83', 'G73') else []
                words.append(f'F{self.figure(self.mm(80, 200))}')
            self.put(*words)
            self.position.update({'X': x, 'Y': y})
        self.put('G80')
        self.position.pop('Z', None)
        self.mode = None
        self.move('G0', Z=self.mm(8, 12))

    def wrapped(self):
        """Moves along X while A turns, with feed per minute."""
        self.comment('ROTARY')
        self.move('G0', X=self.mm(-30, 0), Y=0.0, A=0.0)
        self.move('G1', feed=self.mm(100, 300), Z=self.mm(-2, -0.5))
        for _ in range(self.random.randint(3, 12)):
            self.move('G1', X=self.position['X'] + self.mm(-2, 4), A=self.position['A'] + self.random.uniform(-30, 60))
        self.move('G0', Z=self.mm(8, 12))

    def swung(self):
        """Simultaneous moves of five axes, in short blocks."""
        self.comment('SWARF')
        self.move('G0', X=self.mm(-20, 0), Y=self.mm(-20, 0), A=0.0, C=0.0)
        self.move('G1', feed=self.mm(200, 600), Z=self.mm(-2, 0))
        phase = self.random.uniform(0, 6)
        for i in range(self.random.randint(10, 40)):
            t = i * 0.1 + phase
            self.move('G1', X=self.mm(19.999, 20) * math.cos(t), Y=self.mm(19.999, 20) * math.sin(t), Z=self.mm(-2, -1.9),
                      A=15 * math.sin(2 * t), C=30 * math.cos(t))
        self.move('G0', Z=self.mm(8, 12))
        self.move('G0', A=0.0, C=0.0)

    # ------------------------------------------------------------------------------------------------- lathe
    def lathe(self):
        self.put('G8')
        for tool in range(1, self.random.randint(2, 3)):
            self.comment(f'TURN {tool}')
            self.change_tool(tool)
            if self.chance(0.3):
                self.put('G96', f'S{self.random.randint(100, 250)}', 'D2500', 'M3')
            else:
                self.put('G97', f'S{self.random.randint(300, 2000)}', 'M3')
            self.move('G0', X=self.mm(45, 50), Z=self.mm(3, 6))
            for x in range(self.random.randint(0, 4)):
                depth = self.mm(42, 43) - x * self.mm(1.5, 1.6)
                self.move('G0', X=depth)
                self.move('G1', feed=self.mm(80, 200), Z=self.mm(-60, -40))
                self.move('G1', X=depth + self.mm(1, 2))
                self.move('G0', Z=self.mm(3, 6))
            self.turned_contour()
            self.move('G0', X=self.mm(45, 50))
            self.move('G0', Z=self.mm(5, 20))
            self.put('M5')

    def turned_contour(self):
        self.comment('FINISH')
        x, z = self.mm(2, 10), 0.0
        self.move('G0', X=x, Z=self.mm(1, 3))
        self.move('G1', feed=self.mm(60, 150), Z=z)
        for _ in range(self.random.randint(2, 6)):
            x, z = self.position['X'], self.position['Z']
            shape, r = self.random.randint(0, 4), self.mm(0.5, 5)
            if shape == 0:
                self.move('G1', Z=z - self.mm(1, 8))
            elif shape == 1:
                self.move('G1', X=x + self.mm(0.5, 4), Z=z - self.mm(0.5, 6))
            elif shape == 2:  # a convex quarter
                self.arc(False, (z - r, x), (z - r, x + r), 'ZX')
            elif shape == 3:  # a fillet into a shoulder
                self.arc(True, (z, x + r), (z - r, x + r), 'ZX')
            else:
                turn = self.random.uniform(0.3, 1.2)
                self.arc(True, (z, x + r), (z - r * math.sin(turn), x + r - r * math.cos(turn)), 'ZX')

    # ------------------------------------------------------------------------------------------------- laser
    def laser(self):
        for _ in range(self.random.randint(2, 6)):
            self.comment('CUT')
            x, y, r = self.mm(-80, 80), self.mm(-80, 80), self.mm(2, 20)
            self.move('G0', X=x + r, Y=y)
            self.put('M3', f'S{self.random.randint(100, 1000)}')
            if self.chance(0.3):
                self.put('G4', 'P0.05')
                self.mode = None
            self.move('G1', feed=self.mm(800, 3000), X=x + r, Y=y + self.mm(0.5, 3))
            self.move('G1', X=x + r, Y=y)
            angle = 0.0
            for _ in range(self.random.randint(1, 5)):
                angle += self.random.uniform(0.3, 2.8)
                self.arc(False, (x, y), (x + r * math.cos(angle), y + r * math.sin(angle)), 'XY')
                # The next arc begins at the rounded end of this arc.
            for _ in range(self.random.randint(0, 30)):
                self.move('G1', X=self.position['X'] + self.mm(-2, 2), Y=self.position['Y'] + self.mm(-2, 2))
            self.put('M5')


def make(seed):
    return Program(seed)
