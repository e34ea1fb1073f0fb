#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests new machines of `millwright setup`: each type, simulated and stepper, in mm and inch, starts and runs its first program.

usage: first_steps.py MILLWRIGHT

Independent checks: limits and scales as Python reads the INI file, the path from the trace of the run, and the pulses at the pins
of the simulated port, counted by separate components.
"""
import configparser
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

KINDS = {'mill': 'XYZ', 'router': 'XYZ', 'gantry': 'XYYZ', 'lathe': 'XZ', 'foam': 'XYUV', 'plasma': 'XYZ', 'mill4': 'XYZA',
         'mill5': 'XYZAC'}
# Boards of each type of motor; a machine at the parallel port has software step generators, whose pulses are counted.
BOARDS = {'simulated': ('',), 'stepper': ('parport', '7i76e'), 'servo': ('7i97',)}
SWITCHES = ('none', 'home', 'home_and_limits')


class Bench:
    def __init__(self, millwright, folder):
        self.millwright, self.folder, self.failures = millwright, folder, 0

    def expect(self, condition, what, more=''):
        if not condition:
            self.failures += 1
            print(f'FAIL {what}\n{more}')

    def run(self, *words):
        return subprocess.run([self.millwright, *map(str, words)], capture_output=True, text=True, check=False, timeout=120,
                              cwd=self.folder)


def read_ini(path):
    ini = configparser.ConfigParser(strict=False, interpolation=None)
    ini.optionxform = str
    ini.read(path)
    return ini


def add_counters(folder, joints, pins):
    """Counts the rising edges of each step pin, up where its direction pin is low and down where it is high, from outside of the step generator."""
    lines = ['loadrt conv_s32_float names=' + ','.join(f'number-{i}' for i in range(joints)), 'loadrt updown names=' + ','.join(f'tally-{i}' for i in range(joints)),
             'loadrt and2 names=' + ','.join(f'is-up-{i},is-down-{i}' for i in range(joints)),
             'loadrt not names=' + ','.join(f'is-forward-{i}' for i in range(joints))]
    for i, (step, direction) in enumerate(pins):
        lines += [f'net step-{i} parport.0.pin-{step:02d}-out-fake => is-up-{i}.in0 is-down-{i}.in0',
                  f'net direction-{i} parport.0.pin-{direction:02d}-out-fake => is-down-{i}.in1 is-forward-{i}.in',
                  f'net forward-{i} is-forward-{i}.out => is-up-{i}.in1',
                  f'net up-{i} is-up-{i}.out => tally-{i}.countup',
                  f'net down-{i} is-down-{i}.out => tally-{i}.countdown',
                  f'net tally-{i} tally-{i}.count => number-{i}.in',
                  f'net number-{i} number-{i}.out => motion.analog-in-{i:02d}']
        for name in ('is-forward', 'is-up', 'is-down', 'tally', 'number'):
            lines.append(f'addf {name}-{i} base-thread')
    (folder / 'tally.hal').write_text('\n'.join(lines) + '\n')
    ini = folder / 'machine.ini'
    ini.write_text(ini.read_text().replace('HALUI = halui\n', 'HALUI = halui\nHALFILE = tally.hal\n'))
    program = folder / 'nc_files/first_program.ngc'
    asked = 'G4 P1\n' + ''.join(f'M66 E{i} L0\n(debug,steps #5399)\n' for i in range(joints))
    program.write_text(program.read_text().replace('M2\n', asked + 'M2\n'))


def check_way(bench, what, ini, trace, axes):
    """Every sample is within the limits, and each axis has moved through at least a fourth of its travel."""
    with trace.open() as lines:
        rows = list(csv.DictReader(lines))
    for letter in dict.fromkeys(axes):
        places = [float(row[f'axis.{letter.lower()}']) for row in rows]
        low, high = (float(ini[f'AXIS_{letter}'][key]) for key in ('MIN_LIMIT', 'MAX_LIMIT'))
        bench.expect(low <= min(places) and max(places) <= high, f'{what}: {letter} stays in {low} to {high}: {min(places)} to {max(places)}')
        bench.expect(max(places) - min(places) >= 0.07 * (high - low), f'{what}: {letter} moves: {min(places)} to {max(places)}')
    return rows[-1]


def check_pulses(bench, what, ini, last, output, joints):
    """From the motor position at the start to that at the end: its travel since homing, and the position at which it was homed."""
    counts = [int(number) for number in re.findall(r'steps (-?\d+)', output)]
    bench.expect(len(counts) == joints, f'{what}: {joints} counts', output)
    for joint, count in enumerate(counts):
        section = ini[f'JOINT_{joint}']
        wanted = (float(last[f'joint.{joint}']) - float(section['HOME_OFFSET'])) * float(section['STEP_SCALE'])
        bench.expect(abs(count - wanted) <= 2, f'{what}: motor {joint} has made {count} steps, not {wanted:.1f}')


def check_machine(bench, kind, drives, units, switches, board=''):
    what = f'{kind} {drives} {units} {switches} {board}'.strip()
    folder = bench.folder / what.replace(' ', '_')
    done = bench.run('setup', folder, f'kind={kind}', f'drives={drives}', f'units={units}', f'switches={switches}', '--no-check',
                     *([f'board={board}'] if board else []))
    bench.expect(done.returncode == 0, what, done.stdout + done.stderr)
    ini = read_ini(folder / 'machine.ini')
    axes = KINDS[kind]
    bench.expect(ini['KINS']['JOINTS'] == str(len(axes)) and ini['TRAJ']['COORDINATES'].replace(' ', '') == axes, f'{what}: joints')
    bench.expect(ini['TRAJ']['LINEAR_UNITS'] == units, f'{what}: unit')
    # A motor that homes without moving has counted nothing; a motor with a switch has moved to it.
    is_counted = board == 'parport' and switches == 'none'
    if is_counted:
        names = ['x', 'y', 'y2', 'z'] if kind == 'gantry' else list(axes.lower())
        answers = dict(line.split(' = ') for line in (folder / 'answers.txt').read_text().splitlines() if ' = ' in line)
        add_counters(folder, len(axes), [(int(answers[f'{name}.step_pin']), int(answers[f'{name}.dir_pin'])) for name in names])
    if not is_counted:
        doctor = bench.run('doctor', folder / 'machine.ini', '--strict', '--no-system', '--latency', '0')
        bench.expect(doctor.returncode == 0 and 'errors: 0, warnings: 0' in doctor.stderr, f'{what}: doctor', doctor.stdout + doctor.stderr)
    trace = folder / 'trace.csv'
    ran = bench.run('run', folder / 'machine.ini', folder / 'nc_files/first_program.ngc', '--strict', '--trace', trace)
    bench.expect(ran.returncode == 0 and 'warnings            0' in ran.stdout, f'{what} runs', ran.stdout + ran.stderr)
    if ran.returncode == 0:
        last = check_way(bench, what, ini, trace, axes)
        if is_counted:
            check_pulses(bench, what, ini, last, ran.stdout, len(axes))


def check_refusals(bench):
    folder = bench.folder / 'kept'
    folder.mkdir()
    (folder / 'mine.txt').write_text('mine')
    done = bench.run('setup', folder)
    bench.expect(done.returncode == 1 and 'exists already' in done.stderr and [p.name for p in folder.iterdir()] == ['mine.txt'],
                 'a folder with something in it is not touched', done.stderr)
    done = bench.run('setup', bench.folder / 'none', 'drives=stepper', 'x.microsteps=64', 'y.step_pin=2')
    bench.expect(done.returncode == 1 and 'x.speed: motor X would need' in done.stderr and 'y.step_pin: pin 2 is used' in done.stderr
                 and not (bench.folder / 'none').exists(), 'each fault is reported, and nothing is written', done.stderr)
    for word, place in (('bare', 'bare'), ('closed/', 'closed'), ('my first mill', 'my first mill'), ('./a/b/c', 'a/b/c')):
        done = bench.run('setup', word, '--no-check')
        bench.expect(done.returncode == 0 and (bench.folder / place / 'machine.ini').is_file(), f'setup {word}', done.stderr)
    done = bench.run('setup', 'her mill')
    bench.expect(done.returncode == 0 and f"linuxcnc '{bench.folder.resolve()}/her mill/machine.ini'" in done.stdout, 'a path with spaces is quoted', done.stdout)
    bench.expect(bench.run('setup').returncode == 2 and bench.run('setup', 'x', 'nonsense').returncode == 2, 'wrong usage')
    left = [path.name for path in bench.folder.iterdir() if path.name.startswith('.')]
    bench.expect(not left, f'nothing is left behind: {left}')


def check_by_command(bench):
    """Setup writes a machine and runs it; a second setup with the saved answers writes the same machine."""
    first = bench.folder / 'deep/shop/first'
    done = bench.run('setup', first, 'kind=router', 'drives=stepper', 'switches=home', 'switch.contacts=closed', 'x.max=500',
                     'y.way_per_turn=-10', 'name=Fräse 1')
    bench.expect(done.returncode == 0 and 'It runs' in done.stdout, 'made and tried', done.stdout + done.stderr)
    second = bench.folder / 'second'
    done = bench.run('setup', second, '--answers', first / 'answers.txt', '--no-check')
    files = sorted(path.relative_to(second) for path in second.rglob('*') if path.is_file())
    bench.expect(all((second / file).read_bytes() == (first / file).read_bytes() for file in files) and len(files) == 27,
                 'the kept answers give the same machine', f'{files} {done.stderr}')
    doctor = bench.run('doctor', second / 'machine.ini', '--no-system', '--latency', '0')
    bench.expect(doctor.returncode == 0 and 'errors: 0, warnings: 0' in doctor.stderr, 'doctor finds nothing', doctor.stdout + doctor.stderr)
    asked = bench.run('setup', '--questions', 'kind=foam')
    bench.expect(asked.returncode == 0 and 'foam.width = 500' in asked.stdout, 'questions', asked.stdout)


def main():
    with tempfile.TemporaryDirectory() as place:
        bench = Bench(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(place))
        number = 0
        for kind in KINDS:
            for drives, boards in BOARDS.items():
                for board in boards:
                    if kind == 'mill5' and board == 'parport':
                        continue
                    for units in ('mm', 'inch'):
                        check_machine(bench, kind, drives, units, SWITCHES[number % 3], board)
                        number += 1
                    if board == 'parport':
                        check_machine(bench, kind, drives, 'mm' if (number - 2) % 3 else 'inch', 'none', board)
        check_refusals(bench)
        check_by_command(bench)
    print(f'{bench.failures} failed')
    return 1 if bench.failures else 0


if __name__ == '__main__':
    sys.exit(main())
