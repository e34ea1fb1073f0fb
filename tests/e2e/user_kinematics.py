#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The example of a kinematics, built by halcompile, drives a machine in virtual time.

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


def main():
    programs, source = (pathlib.Path(word) for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        shutil.copytree(source / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var'))
        built = subprocess.run([programs / 'halcompile', '--compile', '-o', folder / 'userkins.so',
                                source / 'examples/kinematics/userkins.comp'], capture_output=True, text=True, check=False, timeout=120)
        assert built.returncode == 0, built.stdout + built.stderr
        machine = folder / 'configs/sim'
        text = (machine / 'mill_mm.ini').read_text()
        changed = text.replace('KINEMATICS = trivkins', 'KINEMATICS = userkins').replace(
            'HALFILE = spindle_sim.hal\n', f'HALFILE = spindle_sim.hal\nHALCMD = setp userkins.lean {LEAN}\n')
        assert changed.count('userkins') == 2, 'mill_mm.ini has changed'
        (machine / 'case.ini').write_text(changed)
        (folder / 'part.ngc').write_text(PROGRAM)
        trace = folder / 'trace.csv'
        done = subprocess.run([programs / 'millwright', 'run', machine / 'case.ini', folder / 'part.ngc', '--trace', trace],
                              env=dict(os.environ, MILLWRIGHT_MODULE_PATH=str(folder)), capture_output=True, text=True,
                              check=False, timeout=120)
        assert done.returncode == 0, done.stdout + done.stderr
        with open(trace, encoding='utf-8') as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        assert max(row['axis.y'] for row in rows) > 49.9
        worst = max(abs(row['joint.0'] - row['axis.x'] - LEAN * row['axis.y']) for row in rows)
        assert worst < 1e-9, f'joint 0 is off by {worst}'
    print(f'{len(rows)} cycles, joint 0 off by at most {worst:.1e}')


if __name__ == '__main__':
    main()
