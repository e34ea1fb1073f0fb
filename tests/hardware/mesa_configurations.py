#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""LinuxCNC's sample configurations with Mesa boards on PCI and EPP, unmodified, on simulated boards in virtual time: doctor has no error, the machine is
switched on, homes as its files say, runs a program and ends. by_machine/smithy is left out: there is no description of its firmware SVST2_4_7I47.

usage: mesa_configurations.py MILLWRIGHT MODELS [FOLDER]
MODELS is drivers/mesa/board/models, FOLDER the sample configurations of LinuxCNC (Debian's by default). Exit status: 0 all pass, 1 one does not, 77 skipped.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
SAMPLES = '/usr/share/doc/linuxcnc/examples/sample-configs'
FOLDERS = ('by_interface/mesa',)
# Configurations that only doctor checks, with the reason.
DOCTOR_ONLY = {'plasma-5i20/plasma-5i20.ini': 'its switches are at a parallel port, which has no motors in virtual time',
               'hm2-servo/7i90.ini': 'its home switch is at a pin that is a step generator in the firmware of our model'}
COUNTS_PER_REV = 4000
# Boards that have the firmware of another board, with their ports of 24 pins.
SIMILAR = {'3x20': ('5i20', 6), '4i65': ('5i20', 3), '4i68': ('5i20', 3), '5i22': ('5i20', 4), '5i23': ('5i20', 3)}
PROGRAMS = {'metric': 'G21 G90 G64\nG1 X2 Z-1 F100\nG1 X0 Z0\nM2\n', 'inch': 'G20 G90 G64\nG1 X0.1 Z-0.05 F5\nG1 X0 Z0\nM2\n'}


def settings(text, section, key):
    """The values of a key."""
    part = re.search(rf'^\[{section}\](.*?)(?=^\[|\Z)', text, re.M | re.S)
    return re.findall(rf'^\s*{key}\s*=\s*(.*?)\s*$', part[1], re.M) if part else []


def model_of(board, models, folder):
    if (models / f'{board}.txt').exists():
        return board
    base, ports = SIMILAR[board]
    text = (models / f'{base}.txt').read_text()
    text = re.sub(r'card=\S+', f'card={board.upper()}', text)
    path = folder / f'{board}.txt'
    text = re.sub(r'(module ioport +instances=)\d+', rf'\g<1>{ports}', text)
    path.write_text(re.sub(r' ports=\d+', f' ports={ports}', text))
    return str(path)


def physics_of(ini, text, folder):
    """Servo motors that reach the speed of the command with the scales of the file, and the home switch of their HAL file; empty: none."""
    if 'hm2-servo' not in str(ini):
        return ''
    lines = []
    for joint in range(3):
        scale, counts, offset, search = (float(settings(text, f'JOINT_{joint}', key)[0]) for key in ('OUTPUT_SCALE', 'INPUT_SCALE', 'HOME_OFFSET', 'HOME_SEARCH_VEL'))
        full, closed = scale * counts / COUNTS_PER_REV, counts / COUNTS_PER_REV * (-0.2 if search < 0 else 0.2)
        side = 'below_rev' if closed < 0 else 'above_rev'
        lines += [f'motor m{joint} pwm={joint} full_rev_s={full} time_constant_s=0.002', f'encoder {joint} motor=m{joint} counts_per_rev={COUNTS_PER_REV}',
                  f'switch 25 motor=m{joint} {side}={closed} closed=low']
    path = folder / 'motors.txt'
    path.write_text('\n'.join(lines) + '\n')
    return f':{path}'


def board_of(ini, text):
    """Driver and board that a configuration uses; None if it has no Mesa board."""
    driver, board = settings(text, 'HOSTMOT2', 'DRIVER'), settings(text, 'HOSTMOT2', 'BOARD')
    if driver and board:
        return driver[0], board[0]
    hal = ''.join((ini.parent / name.split()[0]).read_text(errors='replace') for name in settings(text, 'HAL', 'HALFILE') if (ini.parent / name.split()[0]).exists())
    used = re.search(r'^\s*loadrt\s+(hm2_\w+)', hal, re.M)
    name = re.search(r'\bhm2_(\d\w+)\.0', hal)
    return (used[1], name[1]) if used and name else None


def judge(millwright, ini, models, folder):
    text = ini.read_text(errors='replace')
    used = board_of(ini, text)
    if used is None:
        return None
    driver, board = used
    env = dict(os.environ, MILLWRIGHT_MESA=f'{driver}={model_of(board, models, folder)}{physics_of(ini, text, folder)}')
    doctor = subprocess.run([millwright, 'doctor', ini, '--latency', '0', '--no-system'], capture_output=True, text=True, timeout=120, env=env)
    errors = [line for line in doctor.stdout.splitlines() if ': error:' in line]
    if errors:
        return f'{len(errors)} errors: ' + ' | '.join(errors[:3])
    if '/'.join(ini.parts[-2:]) in DOCTOR_ONLY:
        return ''
    program = folder / 'program.ngc'
    inch = settings(text, 'TRAJ', 'LINEAR_UNITS')[:1] in (['inch'], ['in'])
    program.write_text(PROGRAMS['inch' if inch else 'metric'])
    run = subprocess.run([millwright, 'run', ini, program], capture_output=True, text=True, timeout=300, env=env)
    return '' if run.returncode == 0 else 'does not run: ' + ' | '.join((run.stderr + run.stdout).splitlines()[-4:])


def main():
    samples = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else SAMPLES)
    if not samples.exists():
        print(f'skipped: {samples} is not there: apt-get install linuxcnc-doc-en')
        return SKIPPED
    millwright, models = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    failed = passed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for part in FOLDERS:
            shutil.copytree(samples / part, folder / part)
        subprocess.run(['gunzip', '-rq', folder], check=False)
        for ini in sorted(folder.rglob('*.ini')):
            result = judge(millwright, ini, models, folder)
            if result is None:
                continue
            print(f'{ini.relative_to(folder)}: {result or "passed"}', flush=True)
            failed += 1 if result else 0
            passed += 0 if result else 1
    print(f'{passed} passed, {failed} failed')
    return 1 if failed or not passed else 0


if __name__ == '__main__':
    sys.exit(main())
