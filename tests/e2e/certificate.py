#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""`millwright run --certificate`: the file and the table agree with the commanded motion of a run.

usage: certificate.py MILLWRIGHT SOURCE_FOLDER
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HEAD = 'G21 G17 G90 G40 G49 G80 G94\n'


def expect(condition, what, context=''):
    if not condition:
        print(f'FAILED: {what}\n{context}')
        sys.exit(1)


class Mill:
    """Runs programs on a copy of the simulated mill."""

    def __init__(self, millwright, source, folder):
        self.millwright, self.folder = millwright, folder
        shutil.copytree(source / 'configs' / 'sim', folder / 'sim', ignore=shutil.ignore_patterns('*.var', '*.journal*'))
        self.ini = folder / 'sim' / 'mill_mm.ini'

    def run(self, name, text, *options, file=None):
        program = self.folder / f'{name}.ngc'
        program.write_text(HEAD + text)
        file = file or self.folder / f'{name}.json'
        done = subprocess.run([self.millwright, 'run', str(self.ini), str(program), '--no-estimate', '--certificate', str(file), *options],
                              capture_output=True, text=True, check=False, timeout=100)
        return done, json.loads(file.read_text()) if file.is_file() else None


def coordinate(certificate, kind, name):
    return next(one for one in certificate['limits'] if one['type'] == kind and one['name'] == name)


def check_line(mill):
    """A long rapid uses the full velocity and acceleration; line 4 of the file."""
    done, found = mill.run('line', 'G64 P0.01\nG53 G1 Y10 F600\nG53 G0 X120\nG53 G1 X110 F600\nM2\n')
    expect(done.returncode == 0, 'the program runs', done)
    expect(found['format'] == 'millwright motion certificate' and found['version'] == 1, 'format and version', found)
    expect(found['finished'] and found['clock'] == 'virtual' and found['length_unit'] == 'mm', 'what was run', found)
    expect(found['lost_samples'] == 0 and found['samples'] > 100 and found['servo_period_s'] == 0.001, 'samples', found)
    expect(found['within_limits'] and found['within_tolerance'], 'all is within', found)
    for kind, name in (('axis', 'X'), ('joint', '0')):
        x = coordinate(found, kind, name)
        for quantity, field in (('velocity', 'per_s'), ('acceleration', 'per_s2')):
            one = x[quantity]
            expect(abs(one['ratio'] - 1) < 1e-5 and one['line'] == 4, f'{kind} {name} takes all of its {quantity}', x)
            expect(abs(one[f'largest_{field}'] / one[f'limit_{field}'] - one['ratio']) < 1e-12, 'the ratio is of both', x)
            expect(one['file'].endswith('line.ngc') and 0 < one['time_s'] < found['cycle_time_s'], 'place and time', x)
        expect(x['unit'] == 'mm' and x['jerk']['ratio'] is None and x['jerk']['limit_per_s3'] is None, 'no limit of jerk', x)
    expect(coordinate(found, 'norm', 'XYZ')['velocity']['ratio'] <= 1 + 1e-6, 'the norm is there', found)
    table = re.search(r'axis X +(100\.000|99\.99\d) % line 4 +(100\.000|99\.99\d) % line 4 +no limit', done.stdout)
    expect(table, 'the table has the same figures', done.stdout)
    expect('EXCEEDED' not in done.stdout and 'path deviation' in done.stdout, 'nothing is exceeded', done.stdout)


def check_corner(mill):
    """A corner uses nearly all of P; a corner in G61 uses nothing."""
    done, found = mill.run('corner', 'G61\nG53 G1 X0 Y0 Z60 F6000\nG64 P0.05\nG53 G1 X40\nG53 G1 Y40\nG61\nG53 G1 X0\nG53 G1 Y0\nM2\n')
    expect(done.returncode == 0, 'the program runs', done)
    largest = found['deviation']['largest_ratio']
    expect(0.045 < largest['linear'] <= 0.05 and 0.9 < largest['ratio'] <= 1, 'the corner is rounded within P', largest)
    expect(largest['line'] == 5 and largest['tolerance'] == 0.05, 'line and tolerance of the corner', largest)
    expect(abs(largest['position']['X'] - 40) < 0.1 and abs(largest['position']['Y']) < 0.1, 'position of the corner', largest)
    exact = found['deviation']['exact_path']
    expect(exact is None or exact['linear'] < 1e-6, 'G61 is exact', exact)
    expect(found['within_tolerance'], 'the run is within the tolerance', found['deviation'])
    expect(re.search(r'path deviation +0\.0(4[5-9]|50)\d* mm at line 5 X40\.000 Y0\.000', done.stdout), 'the table has it', done.stdout)


def check_no_tolerance(mill):
    done, found = mill.run('free', 'G61\nG53 G1 X0 Y0 Z60 F6000\nG64\nG53 G1 X40\nG53 G1 Y40\nM2\n')
    largest = found['deviation']['largest']
    expect(done.returncode == 0 and largest['tolerance'] is None and largest['ratio'] is None, 'G64 alone has no tolerance', largest)
    expect(largest['linear'] > 0.5 and found['deviation']['largest_ratio'] is None, 'and its deviation is known', found['deviation'])


def check_ends(mill):
    """A run that stops is certified up to the stop; a file that cannot be written is an error."""
    old = mill.folder / 'stopped.json'
    old.write_text('{"old": true}')
    done, found = mill.run('stopped', 'G64 P0.01\nG53 G1 X20 F3000\nG53 G1 X2000\nM2\n', '--no-check')
    expect(done.returncode == 1 and found.get('finished') is False, 'a run that stops is not finished', (done, found))
    done, _ = mill.run('nowhere', 'G53 G1 X20 F3000\nM2\n', file=mill.folder / 'no' / 'where.json')
    expect(done.returncode == 1 and 'where.json' in done.stderr, 'a file that cannot be written is an error', done)
    expect(not list(mill.folder.glob('*.tmp*')), 'no file is left')


def main():
    millwright, source = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as temporary:
        mill = Mill(millwright, source, pathlib.Path(temporary))
        for check in (check_line, check_corner, check_no_tolerance, check_ends):
            check(mill)
    print('4 passed, 0 failed')


if __name__ == '__main__':
    main()
