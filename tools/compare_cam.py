#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs CAM-style programs (cam_programs.py) with LinuxCNC's rs274 and ours and compares the ends of all moves.

Moves are compared in order: type, end point, and for arcs the centre and the direction; the last printed digit may differ by one.
A program that either side rejects counts as different. With --run N, the first N programs also run in virtual time on machines
with their axes (tests/e2e/cam_runs.py), which does not need LinuxCNC. Exit status 1: something differs.
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

import cam_programs
import compare_interp
import interp_differences

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOVE = re.compile(r'(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED)\(')


def moves_of(calls):
    return [call for call in calls if MOVE.match(call)]


def difference(folder, number):
    """The difference of a program, or nothing."""
    ref_calls, ref_err, ref_status = compare_interp.read(folder, number, 'ref')
    our_calls, our_err, our_status = compare_interp.read(folder, number, 'our')
    if ref_status or our_status:
        return f'rejected: reference {compare_interp.error_of(ref_err)!r}, ours {compare_interp.error_of(our_err)!r}'
    theirs, ours = moves_of(ref_calls), moves_of(our_calls)
    for i, (a, b) in enumerate(zip(theirs, ours)):
        if not interp_differences.isSameCall(a, b):
            return f'move {i}:\n    reference: {a}\n    ours:      {b}'
    return '' if len(theirs) == len(ours) else f'{len(theirs)} moves, ours {len(ours)}'


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--programs', type=int, default=2000)
    parser.add_argument('--first', type=int, default=0, help='first seed')
    parser.add_argument('--ours', default=str(ROOT / 'build/release/bin/rs274'))
    parser.add_argument('--user', default='op', help='who runs LinuxCNC when this is root')
    parser.add_argument('--run', type=int, default=0, help='how many also run in virtual time')
    parser.add_argument('--jobs', type=int, default=2)
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.first + arguments.programs)
    kinds, failures, moves = collections.Counter(), 0, 0
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder).chmod(0o777)
        pathlib.Path(folder, 'three.ini').write_text('[TRAJ]\nCOORDINATES = X Y Z A B C\nLINEAR_UNITS = mm\n')
        for seed in seeds:
            program = cam_programs.make(seed)
            kinds[f'{program.kind} {program.axes}'] += 1
            pathlib.Path(folder, f'{seed}.ngc').write_text(program.text())
        compare_interp.run_all(folder, compare_interp.REFERENCE, 'ref', seeds, arguments.jobs, arguments.user)
        compare_interp.run_all(folder, arguments.ours, 'our', seeds, arguments.jobs)
        for seed in seeds:
            moves += len(moves_of(compare_interp.read(folder, seed, 'our')[0]))
            found = difference(folder, seed)
            if found:
                failures += 1
                print(f'program {seed}: {found}')
    print(', '.join(f'{count} {kind}' for kind, count in sorted(kinds.items())))
    print(f'{len(seeds)} programs, {moves} moves: {failures} differ')
    if arguments.run:
        done = subprocess.run([sys.executable, str(ROOT / 'tests/e2e/cam_runs.py'), str(ROOT / 'build/release/bin/millwright'),
                               str(ROOT), '--first', str(arguments.first), '--count', str(arguments.run)], check=False)
        failures += done.returncode
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
