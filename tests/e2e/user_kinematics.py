#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The kinematics examples, built by halcompile, drive machines in virtual time: one for a single machine, and one that is the
third type of a switchable module.

usage: user_kinematics.py BIN_FOLDER SOURCE_FOLDER
"""
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = 'G21 G90 G0 X10 Y0\nG1 Y50 F3000\nG0 X0 Y0\nM2\n'
LEAN = 0.1
# Switches to the user's type at X10 Y20, moves, and switches back.
SWITCHED = 'G21 G90 G0 X10 Y20\nM68 E3 Q2\nM66 E0 L0\nG1 X-20 Y30 F3000\nM68 E3 Q0\nM66 E0 L0\nG0 X0 Y0\nM2\n'
SHIFT = 7


def build(programs, source, folder, name):
    built = subprocess.run([programs / 'halcompile', '--compile', '-o', folder / f'{name}.so',
                            source / f'examples/kinematics/{name}.comp'], capture_output=True, text=True, check=False, timeout=120)
    assert built.returncode == 0, built.stdout + built.stderr


def run(programs, folder, text, program):
    """Runs the program on the machine and returns its trace."""
    (folder / 'configs/sim/case.ini').write_text(text)
    (folder / 'part.ngc').write_text(program)
    trace = folder / 'trace.csv'
    done = subprocess.run([programs / 'millwright', 'run', folder / 'configs/sim/case.ini', folder / 'part.ngc', '--trace', trace],
                          env=dict(os.environ, MILLWRIGHT_MODULE_PATH=str(folder)), capture_output=True, text=True,
                          check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    with open(trace, encoding='utf-8') as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def leaning(programs, source, folder):
    build(programs, source, folder, 'userkins')
    text = (folder / 'configs/sim/mill_mm.ini').read_text()
    changed = text.replace('KINEMATICS = trivkins', 'KINEMATICS = userkins').replace(
        'HALFILE = spindle_sim.hal\n', f'HALFILE = spindle_sim.hal\nHALCMD = setp userkins.lean {LEAN}\n')
    assert changed.count('userkins') == 2, 'mill_mm.ini has changed'
    rows = run(programs, folder, changed, PROGRAM)
    assert max(row['axis.y'] for row in rows) > 49.9
    worst = max(abs(row['joint.0'] - row['axis.x'] - LEAN * row['axis.y']) for row in rows)
    assert worst < 1e-9, f'joint 0 is off by {worst}'
    print(f'userkins: {len(rows)} cycles, joint 0 off by at most {worst:.1e}')


def switched(programs, source, folder):
    build(programs, source, folder, 'usertype')
    (folder / 'configs/sim/usertype.hal').write_text('loadrt usertype\n')
    text = (folder / 'configs/sim/table_xyzac.ini').read_text()
    changed = text.replace('[HAL]\n', '[HAL]\nHALFILE = usertype.hal\n').replace(
        'HALFILE = spindle_sim.hal\n', f'HALFILE = spindle_sim.hal\nHALCMD = setp usertype.shift {SHIFT}\n')
    assert changed.count('usertype') == 2, 'table_xyzac.ini has changed'
    rows = run(programs, folder, changed, SWITCHED)
    there = [row for row in rows if abs(row['axis.x'] + 20) < 1e-6 and abs(row['axis.y'] - 30) < 1e-6]
    assert there, 'X-20 Y30 was not reached'
    wrong = max(max(abs(row['joint.0'] + 20 - SHIFT), abs(row['joint.1'] + 30)) for row in there)
    assert wrong < 1e-6, f'joints are off by {wrong} in the user\'s type'
    step = max(abs(b[joint] - a[joint]) for a, b in zip(rows, rows[1:]) for joint in ('joint.0', 'joint.1'))
    assert step < 0.21, f'a joint went {step} in a cycle'
    print(f'usertype: {len(rows)} cycles, {len(there)} at the place, the largest step {step:.3f}')


def main():
    programs, source = (pathlib.Path(word) for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        shutil.copytree(source / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var'))
        shutil.copytree(source / 'nc_files', folder / 'nc_files')
        leaning(programs, source, folder)
        switched(programs, source, folder)


if __name__ == '__main__':
    main()
