# SPDX-License-Identifier: GPL-2.0-or-later
"""Random generator of G-code programs over all codes and modal combinations of the dialect.

Faults of LinuxCNC's standalone program are avoided. It takes its position from its canon at a tool change (so a move of all axes
follows), loses the tool offset there and does not convert it with the units (so G49 precedes them), and lets a probe stop before
its end (so a move of all axes follows). It rejects L in G74 and axis words in G43.2. After a break, a do loop runs once. M61
leaves the data of the tool. G10 L2 R ignores G92. It fails in lathe profiles of one segment, with collinear or nearly collinear
segments, arcs beside an allowance, and arcs whose lowest point is inside them.
"""
import math
import random

import interp_lathe_programs

PLANES = {'G17': ('X', 'Y', 'Z', 'I', 'J', 'K'), 'G18': ('Z', 'X', 'Y', 'K', 'I', 'J'),
          'G19': ('Y', 'Z', 'X', 'J', 'K', 'I')}
UNARY = ('abs', 'acos', 'asin', 'cos', 'exp', 'fix', 'fup', 'ln', 'round', 'sin', 'sqrt', 'tan')
BINARY = ('+', '-', '*', '/', '**', 'mod', 'and', 'or', 'xor', 'eq', 'ne', 'gt', 'ge', 'lt', 'le')


class Program:
    """One program; `text()` returns it. Keeps just enough of the modal state to make most lines valid."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.lines = []
        self.plane = 'G17'
        self.at = {letter: 0.0 for letter in 'XYZABC'}
        self.is_incremental = False
        self.is_arc_absolute = False
        self.is_metric = False
        self.feed_mode = 'G94'
        self.is_compensated = False
        self.labels = 100
        self.motion = 'G80'  # the meaning of axis words without a G code
        self.has_break = False
        self.is_numbered = False  # M61: the data of the tool are not active
        self.spindles = 3 if seed % 2 == 1 else 1
        count = self.random.randint(5, 40)
        self.header()
        while len(self.lines) < count:
            self.statement()
        self.lines.append(self.random.choice(('M2', 'M2', 'M2', 'M30', '%')) if self.lines[0] == '%'
                          else self.random.choice(('M2', 'M30')))
        if self.chance(0.03):
            self.lines.insert(self.random.randint(1, len(self.lines)),
                              self.random.choice(('%', '%', ' % ', '% end', '/%', 'G0 X1 %')))

    def text(self):
        return '\n'.join(self.lines) + '\n'

    # ---- small parts
    def chance(self, probability):
        return self.random.random() < probability

    def number(self, low, high, digits=None):
        value = self.random.uniform(low, high)
        digits = self.random.choice((0, 1, 2, 3, 4)) if digits is None else digits
        return f'{value:.{digits}f}'

    def value(self, low, high):
        """A number, or an expression with that value."""
        plain = self.number(low, high)
        kind = self.random.random()
        if kind < 0.85:
            return plain
        if kind < 0.92:
            part = self.number(0, 3)
            return f'[{plain}+{part}-{part}]'
        if kind < 0.97:
            self.lines.append(f'#{self.random.randint(31, 40)}={plain}')
            return self.lines[-1].split('=')[0]
        return f'[{plain}*1]'

    def words(self, letters, low=-5, high=5):
        return ' '.join(f'{letter}{self.value(low, high)}' for letter in letters)

    def axes(self, most=3):
        letters = self.random.sample('XYZ', self.random.randint(1, most))
        if self.chance(0.12):
            letters.append(self.random.choice('ABC'))
        return sorted(letters, key='XYZABC'.index)

    def add(self, line):
        if self.chance(0.06):
            line = f'N{self.random.randint(1, 99999)} {line}'
        if self.chance(0.04):
            line = self.random.choice((line.lower(), line.replace(' ', ''), line.replace(' ', '\t ')))
        if self.chance(0.03):
            line += self.random.choice((' (a comment)', ' ; rest', ' (MSG, hello)', ' (debug,#5420 %d#5421)'))
        if self.chance(0.02):
            line = '/' + line
        self.lines.append(line)

    def header(self):
        if self.chance(0.15):
            self.lines.append('%')
        if self.chance(0.4):
            self.add(self.random.choice(('G20', 'G21')))
        self.add(f'F{self.number(1, 500)}' + (f' S{self.number(1, 3000)} M3' if self.chance(0.5) else ''))

    # ---- statements
    def statement(self):
        kinds = ((12, self.straight), (8, self.arc), (7, self.cycle), (5, self.modal), (4, self.coordinates),
                 (4, self.machine_code), (3, self.parameters), (3, self.flow), (2, self.tool), (2, self.compensation),
                 (2, self.comment), (1, self.polar), (1, self.threading), (1, self.feed), (1, self.nonsense),
                 (1, self.spline), (1, self.home), (1, self.lathe), (1, self.probe), (1, self.oriented), (1, self.call),
                 (1, self.tabled_tool))
        chosen = self.random.choices([k for _, k in kinds], [w for w, _ in kinds])[0]
        chosen()

    def straight(self):
        code = self.random.choice(('G0', 'G1', 'G1', 'G1', ''))
        if code == '' and self.motion not in ('G0', 'G1') and self.chance(0.98):
            code = 'G1'
        self.motion = code or self.motion
        extra = f' F{self.value(1, 500)}' if self.chance(0.15) or self.feed_mode == 'G93' else ''
        prefix = 'G53 ' if code in ('G0', 'G1') and self.chance(0.03) else ''
        self.add(f'{prefix}{code} {self.words(self.axes())}{extra}'.strip())

    def arc(self):
        first, second, third, first_offset, second_offset, _ = PLANES[self.plane]
        code = self.random.choice(('G2', 'G3'))
        self.motion = code
        helix = f' {third}{self.value(-3, 3)}' if self.chance(0.25) else ''
        turns = f' P{self.random.randint(1, 4)}' if self.chance(0.1) else ''
        feed = f' F{self.value(1, 500)}' if self.feed_mode == 'G93' else ''
        if self.chance(0.35):
            x, y = self.number(-2, 2), self.number(-2, 2)
            if not self.is_incremental:
                self.add(f'G1 {first}0 {second}0{feed}')
            chord = math.hypot(float(x), float(y))
            radius = chord / 2 * self.random.uniform(1.0, 3) + 0.001
            sign = self.random.choice(('', '-'))
            self.add(f'{code} {first}{x} {second}{y}{helix} R{sign}{radius:.4f}{turns}{feed}')
            return
        radius = self.random.uniform(0.2, 3)
        a0, a1 = self.random.uniform(0, 2 * math.pi), self.random.uniform(0, 2 * math.pi)
        if self.chance(0.15):
            a1 = a0
        start = (radius * math.cos(a0), radius * math.sin(a0))
        end = (radius * math.cos(a1), radius * math.sin(a1))
        if self.is_incremental:
            move = (end[0] - start[0], end[1] - start[1])
        else:
            self.add(f'G1 {first}{start[0]:.6f} {second}{start[1]:.6f}{feed}')
            move = end
        centre = (0.0, 0.0) if self.is_arc_absolute and not self.is_incremental else (-start[0], -start[1])
        self.add(f'{code} {first}{move[0]:.6f} {second}{move[1]:.6f}{helix} '
                 f'{first_offset}{centre[0]:.6f} {second_offset}{centre[1]:.6f}{turns}{feed}')

    def cycle(self):
        first, second, third, *_ = PLANES[self.plane]
        code = self.random.choice(('G73', 'G81', 'G82', 'G83', 'G85', 'G86', 'G88', 'G89', 'G74', 'G84', 'G87'))
        if code in ('G74', 'G84', 'G87') and self.chance(0.6):
            code = 'G81'
        if self.feed_mode == 'G93' and self.chance(0.95):
            self.feed_mode = 'G94'
            self.add(f'G94 F{self.number(1, 50)}')
        if code in ('G74', 'G84', 'G86', 'G87', 'G88') and self.chance(0.95):
            self.add('S500 ' + ('M4' if code == 'G74' else 'M3'))
        retract, depth = self.random.uniform(0, 3), self.random.uniform(-3, 0)
        line = f'{self.random.choice(("", "G98 ", "G99 "))}{code} {self.words((first, second))} ' \
               f'{third}{depth:.3f} R{retract:.3f}'
        if code in ('G82', 'G86', 'G88', 'G89', 'G84', 'G74') and self.chance(0.98):
            line += f' P{self.number(0, 2)}'
        if code == 'G87' and self.chance(0.95):
            line += f' I{self.number(-1, 1)} J{self.number(-1, 1)} K{self.number(-1, 1)}'
        if code in ('G73', 'G83'):
            line += f' Q{self.random.uniform(0.2, 2):.3f}'
        if self.chance(0.15) and code != 'G74':
            line += f' L{self.random.randint(1, 3)}'
        if self.feed_mode == 'G93':
            line += ' F10'
        self.add(line)
        for _ in range(self.random.randint(0, 2)):
            again = f' R{self.number(0, 3, 1)}' if self.chance(0.04) else ''
            self.add(self.words((self.random.choice((first, second)),)) + again + (' F10' if self.feed_mode == 'G93' else ''))
        self.add('G80')
        self.motion = 'G80'

    def modal(self):
        choice = self.random.choice(('plane', 'distance', 'units', 'arc', 'path', 'feed', 'return', 'lathe'))
        if choice == 'plane' and not self.is_compensated:
            self.plane = self.random.choice(('G17', 'G17', 'G18', 'G19'))
            self.add(self.plane)
        elif choice == 'distance':
            self.is_incremental = self.chance(0.3)
            self.add('G91' if self.is_incremental else 'G90')
        elif choice == 'units':
            self.is_metric = self.chance(0.5)
            self.lines.append('G49')
            self.add('G21' if self.is_metric else 'G20')
        elif choice == 'arc':
            self.is_arc_absolute = self.chance(0.3)
            self.add('G90.1' if self.is_arc_absolute else 'G91.1')
        elif choice == 'path':
            self.add(self.random.choice(('G61', 'G61.1', 'G64', f'G64 P{self.number(0, 1)}',
                                         f'G64 P{self.number(0, 1)} Q{self.number(0, 1)}')))
        elif choice == 'feed':
            self.feed_mode = self.random.choice(('G93', 'G94', 'G94', 'G95'))
            if self.feed_mode == 'G95':
                self.add(f'S{self.random.randint(100, 2000)} M3')
            self.add(self.feed_mode)
            self.motion = 'G1'
            self.add(f'G1 {self.words(self.axes())} F{self.number(1, 50)}')
        elif choice == 'return':
            self.add(self.random.choice(('G98', 'G99')))
        elif choice == 'lathe' and self.chance(0.3):
            self.add(self.random.choice(('G7', 'G8', 'G8')))

    def coordinates(self):
        number = self.random.randint(1, 9)
        self.add(self.random.choice((
            f'G10 L2 P{number} {self.words(self.axes())}',
            f'G92.1\nG10 L2 P{number} R{self.number(-90, 90)}', f'G10 L2 P0 {self.words(self.axes())}', f'G10 L20 P0 {self.words(self.axes())}',
            f'G10 L20 P{number} {self.words(self.axes())}',
            f'G92 {self.words(self.axes())}', 'G92.1', 'G92.2', 'G92.3', f'G52 {self.words(self.axes())}', 'G52 X0 Y0 Z0',
            self.random.choice(('G54', 'G55', 'G56', 'G57', 'G58', 'G59', 'G59.1', 'G59.2', 'G59.3')))))

    def machine_code(self):
        spindle = self.random.choice(('', '', f' ${self.random.randint(0, self.spindles - 1)}', ' $-1' if self.spindles > 1 else ''))
        self.add(self.random.choice((
            f'M3{spindle}', f'M4{spindle}', f'M5{spindle}', f'S{self.number(1, 900)}{spindle}', f'S300 M3{spindle}',
            f'G96 D500 S90{spindle}', f'G97 S90{spindle}',
            'M3', 'M4', 'M5', 'M7', 'M8', 'M9', 'M0', 'M1', 'M60', 'M48', 'M49', 'M50 P0', 'M50 P1', 'M51 P0', 'M51 P1',
            'M52 P0', 'M52 P1', 'M53 P0', 'M53 P1', f'M62 P{self.random.randint(0, 3)}', f'M63 P{self.random.randint(0, 3)}',
            f'M64 P{self.random.randint(0, 3)}', f'M65 P{self.random.randint(0, 3)}', f'M67 E{self.random.randint(0, 3)} Q{self.number(-5, 5)}',
            f'M68 E{self.random.randint(0, 3)} Q{self.number(-5, 5)}', f'M66 P{self.random.randint(0, 3)} L{self.random.randint(0, 4)} Q{self.number(0, 2)}',
            f'M66 E{self.random.randint(0, 3)} L0', f'G4 P{self.number(0, 3)}', f'S{self.number(1, 3000)}', 'M70', 'M71', 'M73',
            f'M19 R{self.number(0, 359)}', f'G96 D{self.number(100, 3000)} S{self.number(1, 300)}', f'G97 S{self.number(1, 3000)}')))

    def expression(self, depth=0):
        kind = self.random.random()
        if depth > 2 or kind < 0.3:
            return self.number(-4, 9)
        if kind < 0.4:
            return f'#{self.random.randint(31, 40)}'
        if kind < 0.6:
            name = self.random.choice(UNARY)
            return f'{name}[{self.expression(depth + 1)}]'
        if kind < 0.65:
            return f'atan[{self.expression(depth + 1)}]/[{self.number(1, 9)}]'
        return f'[{self.expression(depth + 1)} {self.random.choice(BINARY)} {self.expression(depth + 1)}]'

    def parameters(self):
        target = self.random.choice((f'#{self.random.randint(31, 40)}', '#<name>', '#<_global>', '#[30+5]'))
        self.lines.append(f'{target}={self.expression()}')
        if self.chance(0.5):
            self.lines.append(f'({self.random.choice(("print", "debug", "msg"))}, {target} %.2f{target} %d{target})'
                              if target.startswith('#3') or '<' in target else f'G4 P[abs[{target}]]')
        if self.chance(0.1):
            self.lines.append(f'#31=EXISTS[#<{self.random.choice(("name", "nothing", "_vmajor"))}>]')

    def label(self):
        self.labels += 1
        return self.random.choice((f'o{self.labels}', f'o<l{self.labels}>'))

    def body(self):
        for _ in range(self.random.randint(1, 2)):
            self.random.choice((self.straight, self.machine_code, self.parameters))()

    def flow(self):
        label = self.label()
        self.motion = 'G80'
        kind = self.random.choice(('if', 'while', 'do', 'repeat', 'sub', 'sub'))
        if kind == 'if':
            self.lines.append(f'{label} if [{self.expression()} gt {self.number(-1, 3)}]')
            self.body()
            if self.chance(0.3):
                self.lines.append(f'{label} elseif [{self.number(-1, 3)}]')
                self.body()
            if self.chance(0.5):
                self.lines.append(f'{label} else')
                self.body()
            self.lines.append(f'{label} endif')
        elif kind == 'while':
            self.lines += ['#30=0', f'{label} while [#30 lt {self.random.randint(0, 4)}]', '#30=[#30+1]']
            if self.chance(0.2):
                inner = self.label()
                leave = self.random.choice(('break', 'continue'))
                self.has_break = self.has_break or leave == 'break'
                self.lines += [f'{inner} if [#30 eq 2]', f'{label} {leave}', f'{inner} endif']
            self.body()
            self.lines.append(f'{label} endwhile')
        elif kind == 'do' and not self.has_break:
            self.lines += ['#30=0', f'{label} do', '#30=[#30+1]']
            self.body()
            self.lines.append(f'{label} while [#30 lt {self.random.randint(0, 4)}]')
        elif kind == 'repeat':
            self.lines.append(f'{label} repeat [{self.random.choice((0, 1, 2, 3, "0.4", "1.6"))}]')
            if self.chance(0.1):
                inner = self.label()
                self.lines += [f'{inner} if [{self.random.choice((0, 0, 1))}]',
                               f'{label} {self.random.choice(("break", "continue"))}', f'{inner} endif']
            self.body()
            self.lines.append(f'{label} endrepeat')
        else:
            self.lines.append(f'{label} sub')
            self.lines.append('#<x>=[#1*2+#2]')
            self.body()
            if self.chance(0.2):
                self.lines += ['M70' if self.chance(0.5) else 'M73', self.random.choice(('G91', 'G61', 'F77', 'G18', 'M9', 'G98')), 'M72']
            if self.chance(0.3):
                self.lines.append(f'{label} return [#<x>]')
            self.lines.append(f'{label} endsub' + (' [#<x>]' if self.chance(0.5) else ''))
            self.lines.append(f'{label} call [{self.number(-2, 2)}] [{self.number(-2, 2)}]')
            if self.chance(0.4):
                self.lines.append('(print, %.3f#<_value> %d#<_value_returned>)')

    def tool(self):
        change = self.random.choice(('', '', f'T{self.random.randint(1, 3)} M6', f'M61 Q{self.random.randint(1, 3)}'))
        if change:
            if self.feed_mode == 'G93':
                self.feed_mode = 'G94'
                self.add('G94')
            self.add('G49')
            self.add(change)
            self.is_numbered = change.startswith('M61')
            self.is_incremental, self.motion = False, 'G1'
            self.lines.append(f'G90 G1 {self.words("XYZABC")} F{self.number(1, 90)}')
            return
        self.add(self.random.choice((
            f'T{self.random.randint(1, 3)}', 'G43 H1' if self.is_numbered else 'G43', f'G43 H{self.random.randint(1, 3)}',
            f'G43.1 {self.words(self.axes())}', f'G43.2 H{self.random.randint(1, 3)}', 'G49',
            f'G10 L1 P{self.random.randint(1, 3)} {self.words(("X", "Z"))} I{self.number(0, 90)} J{self.number(0, 90)} Q{self.random.randint(0, 9)}',
            f'G10 L1 P{self.random.randint(1, 3)} {self.words(("Z",))} R{self.number(0, 0.5)}',
            f'G10 L10 P{self.random.randint(1, 3)} {self.words(("Z",))}',
            f'G10 L11 P{self.random.randint(1, 3)} {self.words(("Z",))}')))

    def compensation(self):
        if self.feed_mode == 'G93':
            return
        self.add('G80')
        self.add(self.random.choice(('G17', 'G17', 'G18')))
        self.plane = self.lines[-1][-3:].upper() if self.lines[-1][-3:].upper() in PLANES else 'G17'
        self.add('G90')
        self.is_incremental = False
        first, second = PLANES[self.plane][:2]
        at = [float(self.number(-3, 3)), float(self.number(-3, 3))]
        self.add(f'G40 G1 {first}{at[0]} {second}{at[1]}')
        self.add(self.random.choice(('G41.1', 'G42.1')) + f' D{self.random.uniform(0.05, 0.3):.3f}')
        self.is_compensated = True
        heading = None
        for _ in range(self.random.randint(1, 6)):
            to = [self.random.uniform(-5, 5), self.random.uniform(-5, 5)]
            direction = math.atan2(to[1] - at[1], to[0] - at[0])
            if heading is not None and abs(math.remainder(direction - heading, 2 * math.pi)) > math.radians(165):
                continue
            at, heading = to, direction
            self.add(f'{self.random.choice(("G1", "G1", "G0"))} {first}{to[0]:.3f} {second}{to[1]:.3f}')
        self.add('G40')
        self.is_compensated = False
        if self.chance(0.7):
            self.add(f'G0 {first}{self.number(-5, 5)} {second}{self.number(-5, 5)}')

    def comment(self):
        self.lines.append(self.random.choice(('(just text)', '; nothing', '(MSG, operator)', '(debug, #31 #32)', '(print, %d#33)', '()', '')))

    def polar(self):
        if self.plane == 'G17':
            self.motion = 'G1'
            self.add(f'G1 @{self.number(0.5, 4)} ^{self.number(-180, 180)}' + (' F10' if self.feed_mode == 'G93' else ''))
            if self.chance(0.4):
                self.add(self.random.choice((f'^{self.number(-180, 180)}', f'@{self.number(1, 5)}', f'G0 @{self.number(1, 5)} Z1')) +
                         (' F10' if self.feed_mode == 'G93' else ''))
                self.motion = 'G80'

    def threading(self):
        self.add('S100 M3')
        self.motion = 'G80'
        if self.chance(0.4):  # K is the depth of an integer number of passes
            first, passes = self.random.randint(1, 9), self.random.randint(1 if self.chance(0.05) else 2, 8)
            power, depth = self.random.choice(((1, passes), (2, passes), ('1.5', passes**2)))
            self.add(f'G18 G76 P{self.number(0.05, 0.2, 2)} Z{self.number(-3, -1)} I-0.1 J0.0{first} '
                     f'K{first * depth / 100:.2f} R{power} H{self.random.randint(0, 1)}')
            self.plane = 'G18'
            return
        self.add(self.random.choice((f'G33 Z{self.number(-3, 3)} K{self.random.uniform(0.02, 0.2):.3f}',
                                     f'G33.1 Z{self.number(-3, 3)} K{self.random.uniform(0.02, 0.2):.3f}',
                                     f'G18 G76 P{self.random.uniform(0.05, 0.2):.3f} Z{self.number(-3, -1)} I-0.1 J0.01 K0.05 R{self.number(1, 2)} Q29.5 H{self.random.randint(0, 2)} E0.05 L{self.random.randint(0, 3)}')))
        if 'G76' in self.lines[-1].upper():
            self.plane = 'G18'

    def feed(self):
        self.add(f'F{self.value(1, 900)}')

    def nonsense(self):
        """Lines that must be rejected."""
        if self.chance(0.5):
            return
        self.add(self.random.choice(('G1 X', 'G1 X1 X2', 'G2 X1 Y1', 'G0 G1 X1', 'G43.1', 'M66', 'G10 L2', 'G81 X1', 'T-1 M6', 'S-1', 'G2 X1 Y1 R0.01',
                                     'G4', 'G999', 'M999', '#31=[1/0]', 'G1 X[1', 'Q1', 'G92', 'G53 X1', 'G41 D99', 'G64 P-1', 'G10 L2 P10 X1', 'F-1', 'G33 Z1', 'G96', 'H1 D1', 'G5 X1',
                                     'G53', 'G53 M5', 'G53 F10', 'G53 G2 X1 I0.5', 'G53 G81 X1 Z-1 R1', 'G53 G33 Z1 K1', 'G53 G80', 'G53 G43.1 X1',
                                     'G53 G38.2 X1', 'M67 E1', 'M68 E1', 'M66 P0 L5', 'M66 P0 L5 Q1')))

    def spline(self):
        kind = self.random.choice(('G5', 'G5.1', 'G5.2', 'G5'))
        self.motion = 'G80'
        if self.plane != 'G17' or self.feed_mode != 'G94':
            return
        if kind == 'G5':
            self.add(f'G5 X{self.number(-3, 3)} Y{self.number(-3, 3)} I{self.number(-2, 2)} J{self.number(-2, 2)} P{self.number(-2, 2)} Q{self.number(-2, 2)}')
            if self.chance(0.5):
                self.add(f'G5 X{self.number(-3, 3)} Y{self.number(-3, 3)} P{self.number(-2, 2)} Q{self.number(-2, 2)}')
        elif kind == 'G5.1':
            self.add(f'G5.1 X{self.number(-3, 3)} Y{self.number(-3, 3)} I{self.number(-2, 2)} J{self.number(-2, 2)}')
        else:
            self.add(f'G5.2 P{self.number(1, 2)} L3 X{self.number(-3, 3)} Y{self.number(-3, 3)}')
            for _ in range(self.random.randint(2, 5)):
                self.add(f'X{self.number(-3, 3)} Y{self.number(-3, 3)} P{self.number(1, 2)}')
            self.add('G5.3')
            self.lines.append('G90 G1 X1 Y1' + (' F10' if self.feed_mode == 'G93' else ''))
            self.is_incremental = False

    def home(self):
        self.add(self.random.choice(('G28', 'G30', 'G28.1', 'G30.1', f'G28 {self.words(self.axes())}', f'G30 {self.words(self.axes())}')))

    def probe(self):
        if self.feed_mode != 'G94':
            return
        self.motion, self.is_incremental = 'G1', False
        self.lines.append(f'{self.random.choice(("G38.2", "G38.3", "G38.4", "G38.5"))} {self.words(self.axes())} F{self.number(1, 90)}')
        self.lines.append(f'G90 G1 {self.words("XYZABC")}')

    def lathe(self):
        if self.is_compensated or self.feed_mode == 'G93':
            return
        self.lines += ['G80', 'G18', 'G90', 'G91.1', 'G8', f'F{self.number(1, 300)}']
        if self.feed_mode == 'G95':
            self.lines.append('S100')
        self.plane, self.is_incremental, self.is_arc_absolute, self.motion = 'G18', False, False, 'G80'
        self.labels += 1
        self.lines += interp_lathe_programs.lathe_cycle(self.random, self.labels)

    def oriented(self):
        """Compensation of a lathe tool."""
        if self.feed_mode == 'G93' or self.is_compensated:
            return
        self.lines += ['G80', 'G18', 'G90', 'G8', 'G40 G1 X20 Z10 F100' + (' S100' if self.feed_mode == 'G95' else '')]
        self.plane, self.is_incremental, self.motion = 'G18', False, 'G80'
        self.lines.append(f'{self.random.choice(("G41.1", "G42.1"))} D{self.random.uniform(0.1, 0.6):.3f} L{self.random.randint(0, 9)}')
        x, z = 10.0, 5.0
        for _ in range(self.random.randint(1, 5)):
            self.lines.append(f'G1 X{x:.3f} Z{z:.3f}')
            x += self.random.uniform(1, 4)
            z -= self.random.uniform(0.5, 4)
        self.lines += ['G40', f'G0 X{self.number(20, 30)} Z{self.number(5, 10)}']

    def tabled_tool(self):
        """G41 and G42 with a tool of the table, of any orientation, in any plane."""
        if self.feed_mode == 'G93' or self.is_compensated:
            return
        number = self.random.randint(1, 3)
        plane = self.random.choice(('G17', 'G18', 'G18', 'G18', 'G19'))
        orientation = self.random.choice((0, 0, 9, self.random.randint(1, 8)))
        self.lines += ['G80 G90 G40', f'G10 L1 P{number} R{self.number(0.05, 0.3, 3)} Q{orientation}', plane,
                       'G1 X0 Y0 Z0 F100' + (' S100' if self.feed_mode == 'G95' else ''),
                       f'{self.random.choice(("G41", "G42"))} D{number}']
        self.plane, self.is_incremental, self.motion = plane, False, 'G80'
        first, second = PLANES[plane][:2]
        at = [0.0, 0.0]
        for _ in range(self.random.randint(1, 4)):
            at = [at[0] + self.random.uniform(1, 4), at[1] + self.random.uniform(-2, 2)]
            self.lines.append(f'G1 {first}{at[0]:.3f} {second}{at[1]:.3f}')
        self.lines += ['G40', f'G1 {first}{at[0] + 3:.3f} {second}{at[1]:.3f}']

    def call(self):
        """Subroutines that call each other, by number and by expression; M98."""
        self.motion = 'G80'
        self.labels += 2
        inner, outer = self.labels - 1, self.labels
        if self.chance(0.3):
            self.lines += [f'o{inner} sub', f'G0 X#1 Y[#2+{self.number(0, 2)}]', f'o{inner} endsub [#1*2]',
                           f'o{outer} sub', '#<a>=#1', f'o{inner} call [#<a>] [3]', f'o{outer} if [#<_value> gt 1]', 'G0 Z1',
                           f'o{outer} else', 'G0 Z2', f'o{outer} endif', f'o{outer} endsub']
            self.lines.append(f'o[{outer - 1}+1] call [{self.number(0, 2)}]')
            self.lines.append(f'(debug, %.4f#<_value> #5420)')
        else:
            self.lines.append(f'#{self.random.randint(31, 35)}=[{self.number(1, 5)}] #[31+5]={self.number(0, 3)}')
            self.lines.append(f'#<_g{self.labels}>=##36' if self.chance(0.2) else f'#<_g{self.labels}>=[#36+1]')
            self.lines.append(f'G0 X#<_g{self.labels}> Y[#<_g{self.labels}>/2]')
