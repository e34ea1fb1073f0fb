#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares HAL with an installed LinuxCNC: both run the same work alternately, as an ordinary user.

  dispatch   run time per function of a thread with 300 and2, from the thread's pin .time (median of 800 reads):
             calls and their timing. LinuxCNC counts ticks of the processor's time stamp counter, Millwright nanoseconds;
             ticks are converted with the rate in /proc/cpuinfo
  nets       `halcmd -f` of 3,000 net lines, elapsed
  read       `halcmd getp`, elapsed per call, one process each
  reads      the same 3,000 times in one `halcmd -f`
  start      `halrun` of a file that loads and starts a thread: start and stop of the realtime process, elapsed

Prints the medians, their ratio (Millwright / LinuxCNC) and the target. Exit status 1: a target is missed.
Without LinuxCNC only Millwright is measured.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGETS = {'dispatch': 0.7, 'nets': 0.3, 'read': None, 'reads': None, 'start': 0.5}
UNITS = {'dispatch': 'ns', 'nets': 'ms', 'read': 'ms', 'reads': 'ms', 'start': 'ms'}
FUNCTIONS = 300
NETS = 3000
CALLS = 20


def elapsed(command):
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return (time.perf_counter() - begin) * 1e3


def clock_mhz():
    """Rate of the processor's time stamp counter."""
    for line in pathlib.Path('/proc/cpuinfo').read_text().splitlines():
        if line.startswith('cpu MHz'):
            return float(line.split(':')[1])
    return 1000.0


def thread_time():
    """Median run time of the thread over some hundred periods."""
    pathlib.Path('times.hal').write_text('getp t.time\n' * 100)
    times = []
    for _ in range(8):
        done = subprocess.run(['halcmd', '-f', 'times.hal'], check=True, capture_output=True, text=True)
        times += [int(line) for line in done.stdout.split()]
        time.sleep(0.05)
    return statistics.median(times)


def inside(what):
    """Runs in `halrun` (loadusr -w): measures and writes the figures to a file."""
    figures = {}
    if what == 'dispatch':
        figures['thread_time'] = thread_time()
    else:
        figures['nets'] = elapsed(['halcmd', '-f', 'nets.hal'])
        figures['reads'] = elapsed(['halcmd', '-f', 'reads.hal'])
        figures['read'] = sum(elapsed(['halcmd', 'getp', 'and2.7.out']) for _ in range(CALLS)) / CALLS
    pathlib.Path('figures.json').write_text(json.dumps(figures))
    return 0


def one_run(counts_ticks):
    """Runs all measurements with the programs on PATH, in the working folder, and prints them."""
    me = os.path.abspath(__file__)
    figures = {}
    pins = [f'and2.{i}.{pin}' for i in range(NETS // 4) for pin in ('in0', 'in1', 'out', 'time')]
    pathlib.Path('nets.hal').write_text(''.join(f'net signal-{i} {pin}\n' for i, pin in enumerate(pins)))
    pathlib.Path('reads.hal').write_text('getp and2.7.out\n' * NETS)
    pathlib.Path('start.hal').write_text('loadrt threads name1=t period1=1000000\nstart\n')
    figures['start'] = elapsed(['halrun', 'start.hal'])
    pathlib.Path('nets_run.hal').write_text(
        f'loadrt and2 count={NETS // 4}\nloadusr -w python3 {me} --inside nets\n')
    subprocess.run(['halrun', 'nets_run.hal'], check=True, stdin=subprocess.DEVNULL)
    figures.update(json.loads(pathlib.Path('figures.json').read_text()))
    adds = ''.join(f'addf and2.{i} t\n' for i in range(FUNCTIONS))
    pathlib.Path('dispatch.hal').write_text(
        f'loadrt threads name1=t period1=200000\nloadrt and2 count={FUNCTIONS}\n{adds}start\n'
        f'loadusr -w python3 {me} --inside dispatch\n')
    subprocess.run(['halrun', 'dispatch.hal'], check=True, stdin=subprocess.DEVNULL)
    thread_time = json.loads(pathlib.Path('figures.json').read_text())['thread_time']
    figures['dispatch'] = thread_time / FUNCTIONS * (1000 / clock_mhz() if counts_ticks else 1)
    print(json.dumps(figures))
    return 0


def measure(path, user, counts_ticks):
    with tempfile.TemporaryDirectory(prefix='bench-hal-') as folder:
        os.chmod(folder, 0o777)
        command = ['env', f'PATH={path}:/usr/bin:/bin:/usr/sbin:/sbin', f'HOME={folder}', 'MILLWRIGHT_INSTANCE=bench',
                   f'XDG_RUNTIME_DIR={folder}', sys.executable if not user else '/usr/bin/python3',
                   os.path.join(folder, 'hal.py'), '--one-run']
        command += ['--ticks'] if counts_ticks else []
        shutil.copy(__file__, os.path.join(folder, 'hal.py'))
        if user:
            # A separate namespace, because LinuxCNC has one realtime process and one shared memory per machine.
            command = ['unshare', '--ipc', '--pid', '--fork', '--mount-proc', '--kill-child', 'runuser', '-u', user,
                       '--', *command]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)
        if done.returncode != 0:
            sys.exit(f'bench: {path}: {done.stdout[-500:]}{done.stderr[-1500:]}')
        return json.loads(done.stdout.splitlines()[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--bin', default=str(ROOT / 'build/release/bin'), help='folder of our programs')
    parser.add_argument('--reference', default='/usr/bin', help='folder of LinuxCNC\'s programs')
    parser.add_argument('--user', default='nobody', help='ordinary user when run by root')
    parser.add_argument('--runs', type=int, default=5)
    parser.add_argument('--one-run', action='store_true', help=argparse.SUPPRESS)
    parser.add_argument('--ticks', action='store_true', help=argparse.SUPPRESS)
    parser.add_argument('--inside', help=argparse.SUPPRESS)
    o = parser.parse_args()
    if o.inside:
        return inside(o.inside)
    if o.one_run:
        return one_run(o.ticks)
    user = o.user if os.geteuid() == 0 else None
    sides = {'ours': o.bin}
    if shutil.which('halrun', path=o.reference):
        sides = {'reference': o.reference, 'ours': o.bin}
    results = {side: [] for side in sides}
    for _ in range(o.runs):
        for side, path in sides.items():
            results[side].append(measure(path, user, side == 'reference'))
    is_good = True
    print(f'{"":10}' + ''.join(f'{side:>14}' for side in sides) + f'{"ratio":>9}{"aim":>7}   medians of {o.runs} runs')
    for name, aim in TARGETS.items():
        medians = {side: statistics.median(r[name] for r in results[side]) for side in sides}
        line = f'{name:10}' + ''.join(f'{medians[side]:>11.2f} {UNITS[name]}' for side in sides)
        if 'reference' in sides:
            ratio = medians['ours'] / medians['reference']
            is_good = is_good and (aim is None or ratio <= aim)
            line += f'{ratio:>9.2f}{aim if aim else "":>7}' + ('   MISSED' if aim and ratio > aim else '')
        print(line)
    return 0 if is_good else 1


if __name__ == '__main__':
    sys.exit(main())
