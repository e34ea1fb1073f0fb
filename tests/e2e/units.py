#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that each pin, argument and field for a speed, length, angle, time or ratio has the unit of docs/reference/units.md.

units_screen.py measures the units by the behaviour of the machine; docs/reference/units.md contains the same measurement of
LinuxCNC. The page must contain every pin of type float of halui, motion and ini.

usage: units.py BIN_FOLDER ROOT
       units.py --there OUT ROOT   compares the LinuxCNC column with the output of units_screen.py as the display of LinuxCNC
                                   (UNITS_OUT=OUT UNITS_PEER=1, linuxcnc -r units.ini)
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from mill_by_hand import Findings

LIMIT_S = 240
TOLERANCE = 0.05  # measured in real time on a busy computer
MM = 1 / 25.4     # of the machine's unit, the inch
UNITS = {
    'speed': {'unit/s': 1, 'unit/min': 1 / 60, 'mm/s': MM, 'mm/min': MM / 60, 'inch/s': 1, 'inch/min': 1 / 60},
    'turn': {'degree/s': 1, 'degree/min': 1 / 60},
    'acceleration': {'unit/s2': 1, 'mm/s2': MM},
    'length': {'unit': 1, 'mm': MM},
    'rotation': {'rev/min': 1, 'rev/s': 60},
    'angle': {'degree': 1, 'rad': 57.2957795, 'rev': 360},
    'time': {'s': 1, 'ms': 1e-3, 'ns': 1e-9},
    'ratio': {'ratio': 1, '%': 0.01},
}
FOUND = Findings()
expect = FOUND.expect


def unit_of(dimension, factor):
    """The names of the units that match a measured factor."""
    return [name for name, value in UNITS[dimension].items() if abs(factor / value - 1) < TOLERANCE]


def read_page(path):
    """{name: (unit of LinuxCNC, unit of Millwright)} of the tables of docs/reference/units.md."""
    rows = {}
    for line in path.read_text(encoding='utf-8').splitlines():
        cells = [cell.strip() for cell in line.strip('|').split('|')]
        if line.startswith('| `'):
            for name in re.findall(r'`([^`]+)`', cells[0]):
                assert name not in rows, f'{name} is in {path} twice'
                rows[name] = (cells[1], cells[2])
    return rows


def measure(programs, root, folder):
    for file in (root / 'tests/e2e/units_machine').iterdir():
        shutil.copy(file, folder)
    screen = folder / 'units_screen.py'
    shutil.copy(root / 'tests/e2e/units_screen.py', screen)
    screen.chmod(0o755)
    env = dict(os.environ, MILLWRIGHT_INSTANCE=f'units-{os.getpid()}', UNITS_OUT=str(folder / 'out.json'), PATH=f"{programs}:{os.environ['PATH']}",
               PYTHONPATH=str(programs.parent / 'lib/python'), HOME=str(folder))
    done = subprocess.run([programs / 'linuxcnc', '-r', 'units.ini'], cwd=folder, env=env, text=True, stdin=subprocess.DEVNULL,
                          capture_output=True, check=False, timeout=LIMIT_S)
    out = folder / 'out.json'
    expect(done.returncode == 0 and out.exists(), 'the machine runs', done.stdout, done.stderr)
    return json.loads(out.read_text()) if out.exists() else {}


def check_there(path, page):
    for name, value in json.loads(path.read_text()).items():
        if name != 'pins':
            expect(not isinstance(value, str) and page.get(name, ('',))[0] in unit_of(*value), f'{name}: {value}, and docs/reference/units.md has {page.get(name)}')
    return FOUND.status()


def main():
    if sys.argv[1] == '--there':
        return check_there(pathlib.Path(sys.argv[2]), read_page(pathlib.Path(sys.argv[3]) / 'docs/reference/units.md'))
    programs, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    page = read_page(root / 'docs/reference/units.md')
    with tempfile.TemporaryDirectory(prefix='mw_units_') as name:
        found = measure(programs, root, pathlib.Path(name))
    pins = found.pop('pins', [])
    for name, value in found.items():
        if isinstance(value, str):
            expect(False, f'{name}: {value}')
            continue
        here = page.get(name, ('', ''))[1]
        expect(here in unit_of(*value), f'{name} is {value[1]:.6g}, that is {" or ".join(unit_of(*value)) or "no unit"}, and docs/reference/units.md has "{here}"')
    measured = set(found)
    for name, (_, here) in page.items():
        expect(name in measured or here.startswith('('), f'{name} is in docs/reference/units.md and not measured')
    known = {re.sub(r' \(.*', '', name) for name in page}
    for name in pins:
        expect(name in known, f'the pin {name} is not in docs/reference/units.md')
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
