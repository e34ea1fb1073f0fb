#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs a program twice on a simulated machine and compares the traces byte by byte.

usage: programs.py MILLWRIGHT INI PROGRAM

Checks: exit status 0, a summary with the main figures, a picture, a trace with the documented header and one row per servo cycle,
a certificate of motion within limits and tolerances, and identical bytes in the second run.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def run(millwright, ini, program, folder, name):
    trace, plot = folder / f'{name}.csv', folder / f'{name}.png'
    done = subprocess.run([millwright, 'run', str(ini), program, '--strict', '--trace', str(trace), '--plot', str(plot),
                           '--certificate', str(folder / f'{name}.json')], capture_output=True, text=True, check=False)
    return done, trace, plot


def expect(condition, what):
    if not condition:
        print(f'FAILED: {what}')
        sys.exit(1)


def main():
    millwright, ini, program = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        # A copy, so that parameter files are not changed and both runs start with the same values.
        for copy in ('one', 'two'):
            shutil.copytree(pathlib.Path(ini).parents[2], folder / copy, ignore=shutil.ignore_patterns('build', '.git', '*.var', '*.journal*'))
        place = pathlib.Path(ini).relative_to(pathlib.Path(ini).parents[2])
        first, trace, plot = run(millwright, folder / 'one' / place, program, folder, 'first')
        print(first.stdout, first.stderr)
        expect(first.returncode == 0, f'exit status {first.returncode}')
        for word in ('cycle time', 'cutting', 'rapid', 'blocks', 'peak velocity', 'peak acceleration', 'path deviation',
                     'warnings            0'):
            expect(word in first.stdout, f'the summary has no "{word}"')
        certificate = json.loads((folder / 'first.json').read_text())
        expect(certificate['within_limits'] and certificate['lost_samples'] == 0, 'the motion is within the limits')
        expect(certificate['within_tolerance'], 'the motion is within the tolerances')
        expect(plot.read_bytes()[:8] == b'\x89PNG\r\n\x1a\n', 'the picture is a PNG')
        with trace.open() as lines:
            header = lines.readline().strip()
            expect(re.fullmatch(r'time_ns,line(,axis\.[xyzabcuvw])+(,joint\.\d+)+', header), f'header {header}')
            rows = [line.split(',')[0] for line in lines]
        expect(len(rows) > 10, 'the trace has rows')
        expect(all(int(t) == i * 1000000 for i, t in enumerate(rows)), 'one row per servo cycle from program start')
        second, other, _ = run(millwright, folder / 'two' / place, program, folder, 'second')
        expect(second.returncode == 0, f'second run: exit status {second.returncode}')
        expect(trace.read_bytes() == other.read_bytes(), 'two runs give the same bytes')
    print('1 passed, 0 failed')


if __name__ == '__main__':
    main()
