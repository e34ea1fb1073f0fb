#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Wrong input gives one clear error with file, line and column and status 1; no process remains and no file is changed.

usage: wrong_input.py MILLWRIGHT ROOT
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

GOOD = 'G21 G90\nF600\nG0 X1 Y1\nG1 X5\nM2\n'


def replace(path, old, new):
    text = path.read_text()
    assert old in text, f'{old!r} is not in {path}'
    path.write_text(text.replace(old, new, 1))


def append(path, text):
    path.write_text(path.read_text() + text)


# Each case: name, the change in the folder, and the text of the expected error.
CASES = [
    ('missing section', lambda d: replace(d / 'configs/sim/mill_mm.ini', '[KINS]', '[KINSS]'),
     r'mill_mm\.ini.*error: section \[KINS\] is missing'),
    ('missing joint section', lambda d: replace(d / 'configs/sim/mill_mm.ini', '[JOINT_1]', '[JOINT_9]'),
     r'mill_mm\.ini.*error: section \[JOINT_1\] is missing'),
    ('value out of range', lambda d: replace(d / 'configs/sim/mill_mm.ini', 'SERVO_PERIOD = 1000000', 'SERVO_PERIOD = -5'),
     r'mill_mm\.ini:\d+:\d+: error: \[EMCMOT\]SERVO_PERIOD = -5 is out of range'),
    ('decimal comma', lambda d: replace(d / 'configs/sim/mill_mm.ini', 'MAX_LINEAR_VELOCITY = 200', 'MAX_LINEAR_VELOCITY = 200,5'),
     r"mill_mm\.ini:\d+:\d+: error: \[TRAJ\]MAX_LINEAR_VELOCITY = '200,5' is not a number"),
    ('missing HAL file', lambda d: replace(d / 'configs/sim/mill_mm.ini', 'spindle_sim.hal', 'spindle_simm.hal'),
     r"mill_mm\.ini:\d+:\d+: error: HAL file 'spindle_simm\.hal' is not found"),
    ('unknown pin', lambda d: append(d / 'configs/sim/spindle_sim.hal', 'net wrong joint.0.motor-pos-comd\n'),
     r"spindle_sim\.hal:\d+:\d+: error: .*joint\.0\.motor-pos-comd.*joint\.0\.motor-pos-cmd"),
    ('unknown module', lambda d: append(d / 'configs/sim/spindle_sim.hal', 'loadrt nosuchthing\n'),
     r"spindle_sim\.hal:\d+:\d+: error: .*nosuchthing"),
    ('G-code error in a subroutine', lambda d: (d / 'p.ngc').write_text('G21 G90 F600\no<w> sub\nG1 X1\nG1 X2 X3\no<w> endsub\no<w> call\nM2\n'),
     r'p\.ngc:4:\d+: error: .*\n.*G1 X2 X3(.|\n)*called from .*p\.ngc:6'),
    ('error in line 3 of a subroutine in a separate file',
     lambda d: ((d / 'nc_files/lib/badsub.ngc').write_text('o<badsub> sub\nG1 X1 F600\nG1 Q[1/0] X2\no<badsub> endsub\nM2\n'),
                (d / 'p.ngc').write_text('G21 G90\no<badsub> call\nM2\n')),
     r'badsub\.ngc:3:\d+: error: '),
    ('outside a soft limit', lambda d: (d / 'p.ngc').write_text('G21 G90\nG0 X1000\nM2\n'), r'limit'),
    ('missing program', lambda d: (d / 'p.ngc').unlink(), r"cannot open '.*p\.ngc'"),
    ('broken line of the tool table, and its tool is asked for',
     lambda d: (append(d / 'configs/sim/mill_mm.tbl', 'T77 P77 Dx\n'),
                (d / 'p.ngc').write_text('G21 G90\nT77 M6\nM2\n')),
     r'mill_mm\.tbl:\d+:\d+: warning: .*the line is skipped(.|\n)*error: .*77'),
]


def snapshot(folder):
    return {p: p.read_bytes() for p in (folder / 'configs/sim').iterdir() if p.suffix in ('.tbl', '.var')}


def leftovers(tag):
    found = []
    for entry in pathlib.Path('/proc').iterdir():
        if entry.name.isdigit():
            try:
                if f'MILLWRIGHT_INSTANCE={tag}'.encode() in (entry / 'environ').read_bytes():
                    found.append(entry.name)
            except OSError:
                pass
    return found


def main():
    millwright, root = sys.argv[1:3]
    failures = 0
    for number, (name, change, wanted) in enumerate(CASES):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            for part in ('configs', 'nc_files'):
                shutil.copytree(pathlib.Path(root) / part, folder / part, ignore=shutil.ignore_patterns('*.var'))
            (folder / 'configs/sim/mill_mm.var').write_text('5161\t1.0\n5220\t1.0\n')
            (folder / 'p.ngc').write_text(GOOD)
            change(folder)
            before = snapshot(folder)
            tag = f'wrong-{os.getpid()}-{number}'
            for mode in ([], ['--realtime', '--yes']):
                done = subprocess.run([millwright, 'run', 'configs/sim/mill_mm.ini', 'p.ngc', *mode], cwd=folder,
                                      env=dict(os.environ, MILLWRIGHT_INSTANCE=tag, LC_ALL='de_DE.UTF-8', LANGUAGE='en'),
                                      capture_output=True, text=True, timeout=60, check=False)
                problems = []
                if done.returncode != 1:
                    problems.append(f'exit status {done.returncode}, not 1')
                if not re.search(wanted, done.stderr):
                    problems.append(f'no message like {wanted}')
                if len(re.findall(r'error: ', done.stderr)) != 1:
                    problems.append('not exactly one error')
                if snapshot(folder) != before:
                    problems.append('tool table or parameter file touched')
                if leftovers(tag):
                    problems.append('something is left running')
                if problems:
                    failures += 1
                    print(f'FAIL {name} {mode}: {"; ".join(problems)}\n{done.stderr}{done.stdout}')
    print(f'{2 * len(CASES) - failures} passed, {failures} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
