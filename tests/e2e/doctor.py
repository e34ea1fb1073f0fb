#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""millwright doctor reports nothing about our machines, and reports each of many faults at its position.

usage: doctor.py MILLWRIGHT ROOT [--seed N] [--typing-errors N]

A fault is one changed, added or removed line of a correct configuration; a finding must name its line. The seed selects keys for
typing errors.
"""
import argparse
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile


class Files:
    """A copy of the mill, and the damaged line."""

    def __init__(self, root, place):
        self.folder = pathlib.Path(place) / 'configs/sim'
        shutil.copytree(root / 'configs/sim', self.folder, ignore=shutil.ignore_patterns('*.var', '*.journal'))
        (pathlib.Path(place) / 'nc_files').symlink_to(root / 'nc_files')
        self.ini = self.folder / 'mill_mm.ini'
        self.line = None

    def lines(self, name='mill_mm.ini'):
        return (self.folder / name).read_text().splitlines()

    def write(self, lines, number, name='mill_mm.ini'):
        (self.folder / name).write_text('\n'.join(lines) + '\n')
        self.line = f'{name}:{number + 1}:'

    def find(self, section, key, lines):
        start = lines.index(f'[{section}]')
        return next(i for i in range(start, len(lines)) if re.match(rf'{key}\s*=', lines[i]))

    def set(self, section, key, value):
        lines = self.lines()
        at = self.find(section, key, lines)
        lines[at] = f'{key} = {value}'
        self.write(lines, at)

    def add(self, section, line):
        lines = self.lines()
        at = lines.index(f'[{section}]') + 1
        lines.insert(at, line)
        self.write(lines, at)

    def remove(self, section, key):
        lines = self.lines()
        at = self.find(section, key, lines)
        del lines[at]
        self.write(lines, at)
        self.line = ''

    def replace(self, name, old, new):
        lines = self.lines(name)
        at = next(i for i, line in enumerate(lines) if old in line)
        lines[at] = lines[at].replace(old, new)
        self.write(lines, at, name)


# The change and the expected finding. The seed chooses JOINT and AXIS.
SETTINGS = [
    ('JOINT', 'MIN_LIMIT', '900', 'above'), ('JOINT', 'HOME', '9999', 'outside'), ('JOINT', 'MAX_VELOCITY', '0', 'above 0'),
    ('JOINT', 'MAX_VELOCITY', 'fast', 'not a number'), ('JOINT', 'MAX_ACCELERATION', '1,5', 'not a number'),
    ('JOINT', 'MIN_FERROR', '5', 'is above'), ('JOINT', 'HOME_LATCH_VEL', '0', None), ('JOINT', 'HOME_SEARCH_VEL', '0', None),
    ('JOINT', 'HOME_LATCH_VEL', '75', 'faster than'), ('JOINT', 'HOME_SEQUENCE', '7', 'use consecutive numbers'),
    ('JOINT', 'TYPE', 'ANGULAR', 'unit is wrong'), ('JOINT', 'TYPE', 'ROUND', 'not a known value'), ('JOINT', 'HOME_SEQUENCE', '5000', 'out of range'),
    ('AXIS', 'MAX_VELOCITY', '900', 'exceeds'), ('AXIS', 'MAX_LIMIT', '900', 'exceeds'), ('AXIS', 'MIN_LIMIT', '-900', 'exceeds'),
    ('AXIS', 'MAX_LIMIT', '-900', 'MIN_LIMIT is above MAX_LIMIT'), ('TRAJ', 'COORDINATES', 'X Y Z A', None), ('TRAJ', 'COORDINATES', 'X Y Q', 'letter'),
    ('TRAJ', 'LINEAR_UNITS', 'inch', None), ('TRAJ', 'LINEAR_UNITS', 'cm', 'not a known value'), ('TRAJ', 'DEFAULT_LINEAR_VELOCITY', '900', 'is above'),
    ('KINS', 'JOINTS', '2', None), ('KINS', 'JOINTS', '40', 'out of range'), ('KINS', 'KINEMATICS', 'trivkin', None),
    ('EMC', 'VERSION', '1.0', 'older format'), ('EMCMOT', 'SERVO_PERIOD', '1', 'out of range'), ('EMCMOT', 'BASE_PERIOD', '2000000', 'longer than'),
    ('EMCIO', 'TOOL_TABLE', 'no/tools.tbl', 'no folder'), ('RS274NGC', 'PARAMETER_FILE', 'no/mill.var', 'no folder'),
    ('RS274NGC', 'SUBROUTINE_PATH', '../../nc_files/lip', 'no folder'), ('DISPLAY', 'PROGRAM_PREFIX', '../../nc_file', 'no folder'),
    ('DISPLAY', 'DISPLAY', 'axsi', 'no program'), ('TASK', 'CYCLE_TIME', '0', 'out of range'),
]
ADDED = [
    ('DISPLAY', 'MIN_SPINDLE_OVERRIDE = 3', 'is above'), ('DISPLAY', 'MAX_SPINDLE_0_OVERRIDE = 150', 'may reach 15000 %'),
    ('DISPLAY', 'DEFAULT_LINEAR_VELOCITY = 3000', 'exceeds the maximum jog speed'), ('APPLICATIONS', 'APP = ./nothing -x', 'no program'), ('HAL', 'POSTGUI_HALFILE = gone.hal', 'not found'),
    ('HAL', 'HALFILE = gone.hal', 'not found'), ('HAL', 'HALFILE', 'not a KEY = VALUE line'), ('JOINT', 'SCALE = 0', 'no unit'),
    ('JOINT', 'STEPGEN_MAXACCEL = 10', None), ('RS274NGC', 'REMAP = M400 modalgroup=10 ngc=gone', 'no file'), ('AXIS_X', 'MIN_LIMIT = 5', 'appears twice'),
    ('SPINDLE_0', 'MIN_FORWARD_VELOCITY = 90', None), ('AXIS_A', 'MAX_VELOCITY = 9', 'belongs to an axis'), ('DISPLAY', 'OPEN_FILE = gone.ngc', 'no file'),
]
# In spindle_sim.hal.
HAL = [('loadrt near', 'loadrt nearr', 'no module'), ('spindle-inertia.gain', 'spindle-inertia.gian', 'did you mean'),
       ('addf spindle-near servo', 'addf spindle-near sevro', 'does not exist'), ('=> spindle.0.speed-in', '=> spindle.0.speed-inn', 'does not exist'),
       ('setp spindle-near.difference 5', 'setp spindle-near.difference five', ''), ('net spindle-index', 'nett spindle-index', '')]


def damages(random_source, typing_errors):
    joint = lambda name: f'JOINT_{random_source.randrange(3)}' if name == 'JOINT' else name
    some = lambda name: f'AXIS_{random_source.choice("XYZ")}' if name == 'AXIS' else joint(name)
    for section, key, value, text in SETTINGS:
        where = some(section)
        yield f'[{where}]{key} = {value}', text, lambda files, w=where, k=key, v=value: files.set(w, k, v)
    for section, line, text in ADDED:
        where = joint(section)

        def add(files, where=where, line=line):
            if f'[{where}]' not in files.lines():
                files.ini.write_text(files.ini.read_text() + f'\n[{where}]\n' + ('MAX_FORWARD_VELOCITY = 50\n' if 'SPINDLE' in where else ''))
            files.add(where, line)
        yield f'added to [{where}]: {line}', text, add
    for old, new, text in HAL:
        yield f'{old} -> {new}', text, lambda files, o=old, n=new: files.replace('spindle_sim.hal', o, n)
    for section, key in (('KINS', 'KINEMATICS'), ('TRAJ', 'COORDINATES'), ('KINS', 'JOINTS'), ('HAL', 'HALFILE = LIB:core_sim.hal')):
        yield f'without [{section}]{key}', 'missing' if '=' not in key else '', \
            lambda files, s=section, k=key: files.remove(s, re.escape(k.split(' = ')[0]))
    for _ in range(typing_errors):
        yield 'typing error', 'nearest', lambda files: mistype(files, random_source)


def mistype(files, random_source):
    """A key of four letters or more loses a letter, has a wrong letter, or has two letters exchanged."""
    lines = files.lines()
    known = [i for i, line in enumerate(lines) if re.match(r'[A-Z_]{4,} =', line) and not re.match(r'(HALFILE|HOME|COORD|KINEM|JOINTS)', line)]
    at = random_source.choice(known)
    key, value = lines[at].split(' =', 1)
    i = random_source.randrange(1, len(key) - 1)
    wrong = random_source.choice((key[:i] + key[i + 1:], key[:i] + random_source.choice('QXJ') + key[i + 1:],
                                  key[:i] + key[i + 1] + key[i] + key[i + 2:]))
    if wrong == key:
        wrong = key[:i] + key[i + 1:]
    lines[at] = f'{wrong} ={value}'
    files.write(lines, at)
    files.mistyped = (wrong, key)


def examine(millwright, ini):
    done = subprocess.run([millwright, 'doctor', str(ini), '--latency', '0', '--no-system'], cwd=ini.parent, capture_output=True,
                          text=True, check=False, timeout=60, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('millwright')
    parser.add_argument('root', type=pathlib.Path)
    parser.add_argument('--seed', type=int, default=20261123)
    parser.add_argument('--typing-errors', type=int, default=12)
    options = parser.parse_args()
    failures = 0
    for ini in sorted((options.root / 'configs/sim').glob('*.ini')):
        status, findings = examine(options.millwright, ini)
        if status != 0 or ' error: ' in findings or ' warning: ' in findings:
            failures += 1
            print(f'FAIL {ini.name} is good, status {status}:\n{findings}')
    print(f'seed {options.seed}')
    random_source = random.Random(options.seed)
    found = 0
    for what, text, damage in damages(random_source, options.typing_errors):
        with tempfile.TemporaryDirectory() as place:
            files = Files(options.root, place)
            damage(files)
            status, findings = examine(options.millwright, files.ini)
        told = [line for line in findings.splitlines() if re.search(r' (error|warning): ', line)]
        if text == 'nearest':
            wrong, key = files.mistyped
            what = f'{key} written {wrong}'
            hits = [line for line in told if wrong in line and files.line in line] or [line for line in told if 'misspelling' in line and wrong in line]
        else:
            # If two lines contradict each other, the finding may name either of them.
            hits = [line for line in told if (text or '') in line and (text is None or not files.line or files.line in line or 'mill_mm.ini' in line)]
        if hits:
            found += 1
        else:
            failures += 1
            print(f'FAIL {what}: not found; status {status}\n{findings}')
    print(f'{found} damages found, {failures} failures')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
