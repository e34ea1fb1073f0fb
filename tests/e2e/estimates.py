#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the planner's time estimate of programs with the actual time.

usage: estimates.py MILLWRIGHT SOURCE_FOLDER
Each program of nc_files runs on its machine, without jerk limits and with 10 times the accelerations.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

MILLWRIGHT, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
PROGRAMS = {'mill_mm': ['contour', 'drilling', 'engraving', 'pocket', 'subroutines'], 'mill_inch': ['inch_plate'],
            'lathe': ['lathe_part'], 'mill_xyza': ['four_axis'], 'mill_xyzac': ['five_axis']}
MOST = 0.03


def seconds(text):
    minutes = re.fullmatch(r'(?:(\d+) min )?([\d.]+) s', text)
    return 60 * int(minutes[1] or 0) + float(minutes[2])


def with_jerk(ini):
    def limited(section):
        acceleration = float(re.search(r'MAX_ACCELERATION = (\S+)', section[0])[1])
        return section[0].rstrip('\n') + f'\nMAX_JERK = {10 * acceleration}\n\n'

    ini = re.sub(r'\[(?:AXIS|JOINT)_\w+\][^\[]*', limited, ini)
    linear = float(re.search(r'MAX_LINEAR_ACCELERATION = (\S+)', ini)[1])
    return ini.replace('[TRAJ]\n', f'[TRAJ]\nPLANNER_TYPE = 1\nMAX_LINEAR_JERK = {10 * linear}\n')


def main():
    failures = runs = 0
    with tempfile.TemporaryDirectory() as scratch:
        for machine, programs in PROGRAMS.items():
            text = (SOURCE / f'configs/sim/{machine}.ini').read_text()
            text = text.replace('../../nc_files', str(SOURCE / 'nc_files'))
            text = re.sub(r'(HALFILE|TOOL_TABLE) = (?!LIB)(\S+)', rf'\1 = {SOURCE}/configs/sim/\2', text)
            for name, ini in (('plain', text), ('smooth', with_jerk(text))):
                for program in programs:
                    folder = pathlib.Path(scratch, f'{machine}_{name}_{program}')
                    folder.mkdir()
                    (folder / 'm.ini').write_text(ini)
                    done = subprocess.run([MILLWRIGHT, 'run', 'm.ini', str(SOURCE / f'nc_files/{program}.ngc')], cwd=folder,
                                          capture_output=True, text=True, check=False)
                    took = re.search(r'^cycle time +(.*)$', done.stdout, re.M)
                    expected = re.search(r'^  time (.*?):', done.stdout, re.M)
                    runs += 1
                    if done.returncode != 0 or not took or not expected:
                        failures += 1
                        print(f'FAILED: {folder.name}: {done.stdout}{done.stderr}')
                        continue
                    ratio = seconds(expected[1]) / seconds(took[1])
                    print(f'{folder.name}: took {took[1]}, expected {expected[1]}, {ratio:.4f}')
                    if abs(ratio - 1) > MOST:
                        failures += 1
                        print(f'FAILED: {folder.name}: expected {expected[1]}, took {took[1]}')
    print(f'{runs - failures} passed, {failures} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
