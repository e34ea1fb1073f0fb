#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that includes point downwards only. usage: check_layers.py ROOT; exit status 1 lists what does not."""
import pathlib
import re
import sys

LAYER = {
    'base': 0, 'geom': 0, 'diag': 0,
    'rtapi': 1, 'config': 1, 'msgs': 1, 'picture': 1,
    'hal': 2, 'nml': 2,
    'kins': 3, 'traj': 3, 'homing': 3, 'interp': 3, 'tool': 3,
    'motion': 4, 'pyhost': 4,
    'task': 5, 'io': 5,
    'machine': 6, 'ui': 6, 'python': 6,
    'app': 7,
    'cli': 8,
}
# Equal layers that may be used, user -> used.
ALLOWED_EQUAL = {('geom', 'base'), ('diag', 'base'), ('interp', 'tool'), ('task', 'io'), ('nml', 'hal'), ('machine', 'ui')}
# Domain libraries know neither HAL nor NML.
FORBIDDEN = {(user, used) for user in ('kins', 'traj', 'homing', 'interp', 'tool') for used in ('hal', 'nml')}
# Inside a folder: sub-folders in the order in which they may use each other.
INNER = {'motion': ['api', 'core', 'rt'],
         'hal': ['api', 'sdk', 'halcompile', 'core', 'host', 'lang', 'tcl', 'stream_tools', 'view']}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')


def are_parts_mixed(source, target):
    """Parts of the motion controller are folders of their own and know no other."""
    are_parts = len(source) > 3 and len(target) > 3 and source[:2] == target[:2] == ('motion', 'core')
    return are_parts and source[2] != target[2]


def problem(path, source, target):
    user, used = source[0], target[0]
    if used not in LAYER or user not in LAYER:
        return None
    if user == used:
        order = INNER.get(user, [])
        inner_user = source[1] if len(source) > 2 else None
        inner_used = target[1] if len(target) > 2 else None
        if inner_user in order and inner_used in order and order.index(inner_used) > order.index(inner_user):
            return f'{user}/{inner_user} may not use {used}/{inner_used}'
        if are_parts_mixed(source, target):
            return f'the part {source[2]} may not know the part {target[2]}'
        return None
    if (user, used) in FORBIDDEN:
        return f'{user} may not know {used}'
    if LAYER[used] > LAYER[user]:
        return f'{user} (layer {LAYER[user]}) may not use {used} (layer {LAYER[used]})'
    if LAYER[used] == LAYER[user] and (user, used) not in ALLOWED_EQUAL:
        return f'{user} and {used} are on the same layer'
    return None


def main():
    root = pathlib.Path(sys.argv[1]) / 'src'
    failures = 0
    checked = 0
    for path in sorted(root.rglob('*')):
        if path.suffix not in ('.cc', '.hh', '.h', '.c') or 'test' in path.relative_to(root).parts[:-1]:
            continue
        checked += 1
        source = path.relative_to(root).parts
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            name = match.group(1)
            why = 'includes are rooted at src/' if name.startswith(('.', '/')) else problem(path, source, tuple(name.split('/')))
            if why:
                print(f'{path}:{number}: {name}: {why}')
                failures += 1
    print(f'{checked} files checked, {failures} wrong includes')
    return 1 if failures or checked == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
