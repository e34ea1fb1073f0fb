#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the interpreter with an installed LinuxCNC: rs274 -g of both runs the same programs alternately, as an ordinary user.

  surface   500,000 lines of a 3D surface, three axes, three decimals
  loop      1.2 million statements of a while loop with trigonometry and parameters
  calls     200,000 calls of a subroutine with three arguments
  ten       10 million lines (--ten): peak memory of Millwright only

Prints the medians of user and system time, their ratio (LinuxCNC / Millwright), and the peak memory. Exit status 1: a ratio is
below 10, or the memory of `ten` exceeds 500 MB. Without LinuxCNC only Millwright is measured.
"""
import argparse
import math
import os
import pathlib
import pwd
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCE = '/usr/bin/rs274'
LEAST_RATIO = 10
MOST_MEGABYTES = 500


def surface(lines):
    yield 'G21 G90 G17 G94 F2000\nG0 Z5\n'
    columns = 1000
    for i in range(lines):
        row, column = divmod(i, columns)
        x = (column if row % 2 == 0 else columns - 1 - column) * 0.1
        y = row * 0.1
        yield f'G1 X{x:.3f} Y{y:.3f} Z{3 * math.sin(x * 0.2) * math.cos(y * 0.15):.3f}\n'
    yield 'M2\n'


def loop(turns):
    yield 'G21 G90 F1000\n#1 = 0\no100 while [#1 LT %d]\n' % turns
    yield '#2 = [#1 * 0.36]\n#3 = [50 * COS[#2]]\n#4 = [50 * SIN[#2] + SQRT[ABS[#3]]]\n#1 = [#1 + 1]\n'
    yield 'o100 endwhile\nG1 X#3 Y#4\nM2\n'


def calls(count):
    yield 'G21 G90 F1000\no<step> sub\n#<sum> = [#1 + #2 * #3]\no<step> endsub\n#5 = 0\n'
    yield 'o1 repeat [%d]\no<step> call [#5] [2] [3]\no1 endrepeat\nM2\n' % count


PROGRAMS = {'surface': lambda: surface(500000), 'loop': lambda: loop(200000), 'calls': lambda: calls(200000)}


def run(program, path, folder, user):
    """User and system time [s], peak memory [MB]."""
    def become():
        if user is not None:
            os.setgid(user.pw_gid)
            os.setuid(user.pw_uid)
    environment = {'PATH': os.environ['PATH'], 'HOME': str(folder)}
    with open(os.devnull, 'w') as out:
        process = subprocess.Popen([program, '-g', str(path)], cwd=folder, stdout=out, stderr=subprocess.DEVNULL,
                                   stdin=subprocess.DEVNULL, env=environment, preexec_fn=become)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f'{program} failed on {path.name} with status {process.returncode}')
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def measure(ours, reference, path, folder, options):
    times = {'ours': [], 'reference': []}
    memory = 0
    for _ in range(options.runs):
        for name, program, user in (('reference', reference, options.account), ('ours', ours, None)):
            if program is not None:
                seconds, megabytes = run(program, path, folder, user)
                times[name].append(seconds)
                memory = megabytes if name == 'ours' else memory
    return (statistics.median(times['ours']),
            statistics.median(times['reference']) if times['reference'] else None, memory)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--ours', default=str(ROOT / 'build/release/bin/rs274'))
    parser.add_argument('--runs', type=int, default=5)
    parser.add_argument('--ten', action='store_true', help='10 million lines, too')
    parser.add_argument('names', nargs='*', help='programs (default: all)')
    options = parser.parse_args()
    # LinuxCNC does not run as root.
    options.account = pwd.getpwnam('nobody') if os.getuid() == 0 else None
    reference = REFERENCE if pathlib.Path(REFERENCE).exists() else None
    folder = pathlib.Path(tempfile.mkdtemp(prefix='bench-interp-'))
    folder.chmod(0o777)
    isGood = True
    try:
        for name in options.names or PROGRAMS:
            path = folder / f'{name}.ngc'
            with open(path, 'w') as out:
                out.writelines(PROGRAMS[name]())
            ours, theirs, memory = measure(options.ours, reference, path, folder, options)
            text = f'{name:8} ours {ours:7.3f} s, peak {memory:6.1f} MB'
            if theirs is not None:
                text += f', reference {theirs:7.3f} s, ratio {theirs / ours:5.1f}'
                isGood = isGood and theirs >= LEAST_RATIO * ours
            print(text, flush=True)
        if options.ten:
            path = folder / 'ten.ngc'
            with open(path, 'w') as out:
                out.writelines(surface(10_000_000))
            seconds, memory = run(options.ours, path, folder, None)
            print(f'ten      ours {seconds:7.3f} s, peak {memory:6.1f} MB')
            isGood = isGood and memory < MOST_MEGABYTES
    finally:
        shutil.rmtree(folder)
    return 0 if isGood else 1


sys.exit(main())
