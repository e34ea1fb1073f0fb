# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the interpreter on a program and reads the canonical calls that it prints as moves of the tool's end."""
import dataclasses
import math
import pathlib
import re
import subprocess

CALL = re.compile(r'^\s*\d+\s+N\S*\s+(\w+)\((.*)\)\s*$')
NUMBER = re.compile(r'-?\d+(?:\.\d+)?(?:e[-+]?\d+)?')
MACHINE_TOP = 500.0


@dataclasses.dataclass
class Move:
    kind: str  # rapid, feed, arc, tap
    start: tuple
    end: tuple
    centre: tuple = (0.0, 0.0)
    turns: float = 0.0  # signed, whole and part circles, anticlockwise positive [rad]
    feed: float = 0.0
    spindle: float = 0.0  # signed
    coolant: str = ''
    step: int = 0  # number of the operation, from its comment
    pitch: float = 0.0  # while feed follows the spindle


@dataclasses.dataclass
class Run:
    error: str
    moves: list
    units: str
    system: int
    isEnded: bool
    spindle: float
    coolant: str
    pitches: dict  # K of rigid taps by move


def write_tables(folder, tools):
    """A tool table without lengths, and offsets that put machine Z 0 far above the part in all systems."""
    folder = pathlib.Path(folder)
    (folder / 'tools.tbl').write_text(''.join(f'T{number} P{number} D{diameter:.6f}\n' for number, diameter in sorted(tools.items())))
    lines = []
    for system in range(9):
        for axis in range(9):
            lines.append(f'{5221 + 20 * system + axis}\t{-MACHINE_TOP if axis == 2 else 0.0:.6f}')
    lines[:0] = [f'{n}\t0.000000' for n in (*range(5161, 5170), *range(5181, 5190), *range(5210, 5220))]
    lines.insert(len(lines) - 81, '5220\t1.000000')
    (folder / 'rs274.var').write_text('\n'.join(lines) + '\n')
    (folder / 'mill.ini').write_text('[RS274NGC]\nPARAMETER_FILE = rs274.var\n[TRAJ]\nLINEAR_UNITS = mm\nANGULAR_UNITS = degree\nCOORDINATES = X Y Z\n[EMCIO]\nTOOL_TABLE = tools.tbl\n')


def run(rs274, folder, program, units):
    folder = pathlib.Path(folder)
    (folder / 'program.ngc').write_text(program, encoding='utf-8')
    done = subprocess.run([rs274, '-g', '-n', '2', '-i', 'mill.ini', '-t', 'tools.tbl', '-v', 'rs274.var', 'program.ngc'], cwd=folder, capture_output=True,
                          text=True, timeout=120, errors='replace', check=False)
    return read(done.stdout, done.stderr, done.returncode, units)


def numbers(text):
    return [float(one) for one in NUMBER.findall(text)]


class Reader:
    def __init__(self, units):
        scale = 25.4 if units == 'inch' else 1.0
        self.at = (0.0, 0.0, MACHINE_TOP / scale)
        self.run = Run('', [], '', 0, False, 0.0, 'off', {})
        self.feed, self.speed, self.turning, self.step, self.pitch = 0.0, 0.0, 0, 0, 0.0
        self.flood = self.mist = self.isLathe = False

    def move(self, kind, end, **more):
        coolant = '+'.join(name for name, isOn in (('flood', self.flood), ('mist', self.mist)) if isOn) or 'off'
        self.run.moves.append(Move(kind, self.at, end, feed=self.feed, spindle=self.speed * self.turning, coolant=coolant, step=self.step, pitch=self.pitch, **more))
        self.at = end

    def call(self, name, text):
        if name == 'STRAIGHT_TRAVERSE':
            self.move('rapid', tuple(numbers(text)[:3]))
        elif name == 'STRAIGHT_FEED':
            self.move('feed', tuple(numbers(text)[:3]))
        elif name == 'RIGID_TAP':
            end = tuple(numbers(text)[:3])
            self.run.pitches[len(self.run.moves)] = self.pitch
            start = self.at
            self.move('tap', end)
            self.move('feed', start)
        elif name == 'ARC_FEED':
            self.arc(numbers(text))
        elif name == 'SET_FEED_RATE':
            self.feed = numbers(text)[0]
        elif name == 'START_SPEED_FEED_SYNCH' or name == 'START_SPEED_FEED_SYNC':
            self.pitch = numbers(text)[0]
        elif name in ('STOP_SPEED_FEED_SYNCH', 'STOP_SPEED_FEED_SYNC'):
            self.pitch = 0.0
        elif name == 'SELECT_PLANE':
            self.isLathe = 'XZ' in text
        elif name == 'COMMENT':
            found = re.match(r'"?(\d+)\. ', text)
            self.step = int(found.group(1)) if found else self.step
        else:
            self.state(name, text)

    def state(self, name, text):
        if name == 'SET_SPINDLE_SPEED':
            self.speed = numbers(text)[-1]
        elif name == 'START_SPINDLE_CLOCKWISE':
            self.turning = 1
        elif name == 'START_SPINDLE_COUNTERCLOCKWISE':
            self.turning = -1
        elif name == 'STOP_SPINDLE_TURNING':
            self.turning = 0
        elif name in ('FLOOD_ON', 'FLOOD_OFF'):
            self.flood = name.endswith('ON')
        elif name in ('MIST_ON', 'MIST_OFF'):
            self.mist = name.endswith('ON')
        elif name == 'USE_LENGTH_UNITS':
            units = 'inch' if 'INCH' in text else 'mm'
            if self.run.units and units != self.run.units:
                factor = 25.4 if units == 'mm' else 1 / 25.4
                self.at = tuple(value * factor for value in self.at)
            elif not self.run.units:
                self.at = tuple(value if units == 'mm' else value for value in (0.0, 0.0, MACHINE_TOP / (25.4 if units == 'inch' else 1.0)))
            self.run.units = units
        elif name == 'SET_G5X_OFFSET' and not self.run.isEnded:
            self.run.system = int(numbers(text)[0])
        elif name == 'PROGRAM_END':
            self.run.isEnded = True
            self.run.spindle = self.speed * self.turning
            self.run.coolant = 'on' if self.flood or self.mist else 'off'

    def turned_arc(self, values):
        """An arc in the ZX plane, as short lines."""
        z, x, cz, cx, rotation = values[:5]
        a, b = math.atan2(self.at[0] - cx, self.at[2] - cz), math.atan2(x - cx, z - cz)
        sweep = (b - a) % (2 * math.pi) if rotation > 0 else -((a - b) % (2 * math.pi))
        radius = math.hypot(self.at[0] - cx, self.at[2] - cz)
        for i in range(1, 97):
            turn = a + sweep * i / 96
            self.move('feed', (cx + radius * math.sin(turn), self.at[1], cz + radius * math.cos(turn)))

    def arc(self, values):
        if self.isLathe:
            self.turned_arc(values)
            return
        x, y, cx, cy, rotation, z = values[:6]
        a = math.atan2(self.at[1] - cy, self.at[0] - cx)
        b = math.atan2(y - cy, x - cx)
        sweep = (b - a) % (2 * math.pi) if rotation > 0 else -((a - b) % (2 * math.pi))
        if math.hypot(x - self.at[0], y - self.at[1]) < 1e-9 or abs(sweep) < 1e-9:
            sweep = math.copysign(2 * math.pi, rotation)
        sweep += math.copysign(2 * math.pi * (abs(rotation) - 1), rotation)
        self.move('arc', (x, y, z), centre=(cx, cy), turns=sweep)


def read(output, errors, status, units):
    reader = Reader(units)
    systemAtEnd = 0
    for line in output.splitlines():
        found = CALL.match(line)
        if found:
            if found.group(1) in ('STRAIGHT_FEED', 'ARC_FEED', 'RIGID_TAP'):
                systemAtEnd = reader.run.system
            reader.call(found.group(1), found.group(2))
    run_ = reader.run
    run_.system = systemAtEnd
    told = [line for line in errors.splitlines() if line.strip() and line.strip() != 'executing']
    if status != 0 or told or not run_.isEnded:
        run_.error = ' / '.join(told[:3]) or f'exit status {status}, program {"ended" if run_.isEnded else "did not end"}'
    return run_
