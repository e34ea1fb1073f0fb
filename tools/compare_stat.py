#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares every attribute of linuxcnc.stat of this build and of an installed LinuxCNC 2.9, in ten states of a simulated mill.

usage: compare_stat.py [--prefix DIR] [--user NAME] [--table]

Attributes that differ must be rows of "linuxcnc.stat, field by field" in docs/reference/compatibility.md; other differences are
failures. --table prints those rows. TIMED attributes depend on the time; only their types are compared. Needs root.
"""
import argparse
import json
import os
import pathlib
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import compare_operator  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
TIMED = {'echo_serial_number', 'heartbeat', 'taskbeat', 'position', 'actual_position', 'joint_position', 'joint_actual_position', 'dtg',
         'distance_to_go', 'current_vel', 'delay_left', 'ini_filename', 'file', 'joint', 'axis'}


def states_of(prefix, user):
    with tempfile.TemporaryDirectory(dir='/var/tmp', prefix='stat') as temporary:
        folder = pathlib.Path(temporary) / 'side'
        folder.mkdir()
        os.chmod(temporary, 0o755)
        compare_operator.start(prefix, folder, 'mill', 1, 1, '', user, 'stat_session.py').wait()
        out = folder / 'out'
        if not out.exists():
            sys.exit('nothing was written: ' + (folder / 'log').read_text(encoding='utf-8')[-800:])
        return [json.loads(line) for line in out.read_text(encoding='ascii').splitlines()]


def parts(name, ours, theirs):
    """(name or name[key], ours, theirs) of each difference."""
    if isinstance(ours, list) and isinstance(theirs, list) and len(ours) == len(theirs):
        for i, (x, y) in enumerate(zip(ours, theirs)):
            yield from parts(f'{name}[{i}]', x, y)
    elif isinstance(ours, dict) and isinstance(theirs, dict):
        for key in sorted(ours.keys() | theirs.keys()):
            yield from parts(f"{name}['{key}']", ours.get(key, 'none'), theirs.get(key, 'none'))
    elif ours != theirs or isinstance(ours, bool) != isinstance(theirs, bool):
        yield name, ours, theirs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--prefix', default=str(ROOT / 'build/release'))
    parser.add_argument('--user', default='cnc')
    parser.add_argument('--table', action='store_true')
    options = parser.parse_args()
    ours, theirs = states_of(options.prefix, options.user), states_of(None, options.user)
    rows = {}
    for (state, a, a_types), (_, b, b_types) in zip(ours, theirs):
        for name in sorted(a.keys() | b.keys()):
            if name not in a or name not in b:
                rows.setdefault(name, ('', 'there' if name in b else 'missing', 'there' if name in a else 'missing'))
            elif a_types[name] != b_types[name]:
                rows.setdefault(name, ('', b_types[name], a_types[name]))
            elif name not in TIMED:
                for part, x, y in parts(name, a[name], b[name]):
                    rows.setdefault(re.sub(r'^(spindle|tool_table)\[\d+\]', r'\1[n]', part), (state, y, x))
    page = (ROOT / 'docs/reference/compatibility.md').read_text(encoding='utf-8')
    failures = 0
    for name, (state, y, x) in sorted(rows.items()):
        if options.table:
            print(f'| `{name}` | {state} | {y} | {x} | |')
        elif f'| `{name}` |' not in page:
            failures += 1
            print(f'{name} ({state}): LinuxCNC {y}, ours {x}')
    print(f'{len(ours)} states, {len(ours[0][1])} attributes, {len(rows)} differ, {failures} of them not in the page')
    sys.exit(1 if failures else 0)


if __name__ == '__main__':
    main()
