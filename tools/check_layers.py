#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that includes point downwards only. usage: check_layers.py ROOT; exit status 1 lists what does not."""
import pathlib
import re
import sys

LAYER = {
    'base': 0, 'geom': 0, 'diag': 0, 'options': 0, 'language': 0,
    'rtapi': 1, 'config': 1, 'msgs': 1, 'picture': 1, 'comp': 1, 'setup': 1,
    'hal': 2, 'mailbox': 2,
    'kins': 3, 'traj': 3, 'homing': 3, 'interp': 3, 'tool': 3, 'journal': 3, 'client': 3, 'hal_lang': 3,
    'motion': 4, 'pyhost': 4, 'hal_tools': 4, 'gcode': 4, 'nml': 4, 'modbus': 4,
    'task': 5, 'io': 5,
    'machine': 6, 'ui': 6, 'python': 6, 'doctor': 6,
    'app': 7,
    'cli': 8,
}
# Equal layers that may be used, user -> used.
ALLOWED_EQUAL = {('geom', 'base'), ('diag', 'base'), ('options', 'base'), ('language', 'base'), ('options', 'language'), ('interp', 'tool'), ('task', 'io'), ('machine', 'ui'), ('doctor', 'machine')}
# Domain libraries know neither HAL nor NML.
FORBIDDEN = {(user, used) for user in ('kins', 'traj', 'homing', 'interp', 'tool', 'journal') for used in ('hal', 'hal_lang', 'nml')}
# Inside a folder: sub-folders in the order in which they may use each other.
INNER = {'motion': ['api', 'core', 'rt'],
         'traj': ['geometry', 'exec', 'timing', 'trial'],
         'interp': ['text', 'ast', 'canon', 'eval', 'scripts', 'codes', 'flow'],
         'task': ['link', 'sequencer', 'states', 'run'],
         'hal': ['api', 'sdk', 'core', 'host'],
         'hal_lang': ['lang', 'tcl'],
         'hal_tools': ['stream', 'view', 'programs'],
         'nml': ['config', 'message', 'buffer', 'net', 'bridge', 'remote']}
# Folders beside src: what of src, and of each other, they may include. What is not here is left alone.
BESIDE = {'components': {'hal', 'hal_tools', 'kins', 'traj', 'motion', 'io', 'rtapi', 'base', 'geom', 'components', 'sim'},
          'sim': {'hal', 'base', 'geom', 'sim'},
          'testing': {'base', 'geom', 'hal', 'kins', 'traj', 'motion', 'testing'}}
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


def problem_beside(folder, target):
    if len(target) > 1 and target[0] not in BESIDE[folder] and (target[0] in LAYER or target[0] in BESIDE):
        return f'{folder} may not use {target[0]}'
    return None


def sources(root, folder):
    """Sources and headers of a folder, without those of tests."""
    for path in sorted((root / folder).rglob('*')):
        if path.suffix in ('.cc', '.hh', '.h', '.c') and 'test' not in path.relative_to(root).parts[:-1]:
            yield path


def main():
    top = pathlib.Path(sys.argv[1])
    root = top / 'src'
    failures = 0
    checked = 0
    for folder in sorted(path.name for path in root.iterdir() if path.is_dir()):
        if folder not in LAYER:
            print(f'src/{folder} has no layer')
            failures += 1
    for folder in BESIDE:
        for path in sources(top, folder):
            checked += 1
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                why = match and problem_beside(folder, tuple(match.group(1).split('/')))
                if why:
                    print(f'{path}:{number}: {match.group(1)}: {why}')
                    failures += 1
    for path in sources(root, '.'):
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
