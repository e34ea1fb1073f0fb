#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks SPDX lines, sizes of classes, functions and parameter lists, and names of Python files.

usage: check_sizes.py ROOT [--list LINES]; exit status 1 lists the findings. --list: the classes of at least LINES lines.
The size of a class is its declaration and its member functions in all files, so that cutting it into files does not make it
smaller. Aim for 400 lines. A file of free functions or of tests has the same limit. A Python file with the name of a standard
module takes that module's place for every program in its folder.
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

import check_classes

LIMIT = 800
FUNCTION_LIMIT = 80
PARAMETER_LIMIT = 5
# Classes over the limit: the permitted lines, with the reason. A class that has become smaller needs its new size here.
LARGE_CLASSES = {
    'mw::campaign::Session': (1040, 'the judge of a whole session: one method for each type of act'),
}
# Functions with more parameters than the limit: file without suffix, name. New ones are not permitted.
OF_FOREIGN_HEADERS = {
    ('drivers/mesa/hostmot2/hal/serial_api', 'hm2_pktuart_setup'),
    ('drivers/mesa/hostmot2/hal/serial_api', 'hm2_bspi_setup_chan'),
    ('src/clients/python/linuxcnc/command_methods', 'set_tool'),
    ('src/gcode/python_host/canon_module', 'pose_of'),
    ('src/hal/capi/io', 'rtapi_spawn_as_root'),
    ('src/hal/capi/io', 'rtapi_spawnp_as_root'),
}
LONG_LISTS = OF_FOREIGN_HEADERS | {
    ('components/test/limit3_test', 'input_at'),
    ('drivers/mesa/hostmot2/test/sserial_values_test', 'record'),
    ('programs/run/start_check', 'check_before_start'),
    ('src/base/ini/ini_key', 'ini_number'),
    ('src/base/ini/ini_key', 'ini_whole'),
    ('src/base/options/command_line', 'number'),
    ('src/clients/publish/sparkplug/edge_node', 'EdgeNode'),
    ('src/clients/publish/table', 'item'),
    ('src/clients/screen/server/detail/session', 'Session'),
    ('src/gcode/interpreter/codes/block_reader', 'compute_setting'),
    ('src/gcode/interpreter/codes/comp/compensation', 'join'),
    ('src/gcode/interpreter/codes/comp/compensation', 'send_arc'),
    ('src/gcode/interpreter/codes/lathe/lathe_offset', 'join'),
    ('src/gcode/interpreter/codes/moves/moves', 'check_pitch'),
    ('src/kinematics/jacobian', 'joints_by_pose'),
    ('src/kinematics/jacobian', 'pose_by_joints'),
    ('src/machine/config/spindle_config', 'read_limit'),
    ('src/machine/task/sequencer/sequencer', 'Sequencer'),
    ('src/machine/task/states/operating_mode', 'begin'),
    ('src/runtime/format', 'put_digits'),
    ('src/runtime/format', 'put_field'),
    ('src/trajectory/follow/spindle_pursuit', 'jerk'),
    ('src/trajectory/profile/acceleration_cells', 'make'),
    ('tests/power_cut/judge', 'cut_short'),
    ('tests/support/stock/mill_path', 'worst_leftover'),
}
SOURCES = {'.cc', '.hh', '.c', '.h'}
SPDX_NEEDED = SOURCES | {'.py', '.cmake', '.hal', '.ini'}


def strip(line):
    """The line without strings, characters and line comments, so that braces count."""
    line = re.sub(r'"(\\.|[^"\\])*"', '""', line)
    line = re.sub(r"'(\\.|[^'\\])+'", "' '", line)
    return re.sub(r'//.*', '', line)


def long_functions(text):
    """Yields (first line, length) of bodies that open on a line ending in '{' with ')' before it, outside other bodies."""
    stack = []
    for number, raw in enumerate(text.splitlines(), 1):
        line = strip(raw)
        for i, char in enumerate(line):
            if char == '{':
                before = line[:i].rstrip()
                isFunction = before.endswith((')', 'const', 'noexcept', 'override')) or (before == '' and i == 0)
                stack.append((number, isFunction))
            elif char == '}' and stack:
                start, isFunction = stack.pop()
                isOutermost = not any(f for _, f in stack)
                if isFunction and isOutermost and number - start + 1 > FUNCTION_LIMIT:
                    yield start, number - start + 1


NAMESPACE = re.compile(r'^namespace (mw[\w:]*) \{', re.MULTILINE)
CLASS = re.compile(r'\b(?:class|struct)\s+(?:alignas\s*\([^)]*\)\s*)?(?:\[\[\w+\]\]\s*)?(?P<name>[\w:]+)(?:\s+final)?\s*'
                   r'(?::[^:;{][^;{]*)?\{')
MEMBER = re.compile(r'^(?![ #}/])(?:[^\n;{}]|\n(?!\n))*?\b(?P<owner>(?:\w+::)+)~?(?:\w+|operator\S*)\s*\(', re.MULTILINE)


def class_sizes(codes):
    """Lines of each class over all files: {(namespace, name): (header, lines)}. `codes`: {file: code without comments}."""
    sizes = {}
    spaces = {name: NAMESPACE.search(code) for name, code in codes.items()}
    spaces = {name: found.group(1) if found else '' for name, found in spaces.items()}
    for name, code in codes.items():
        for match in CLASS.finditer(code):
            key = spaces[name], match['name']
            lines = code.count('\n', match.start(), check_classes.matching(code, match.end() - 1)) + 1
            if lines > sizes.get(key, ('', 0))[1]:
                sizes[key] = name, lines
    members = collections.Counter()
    for name, code in codes.items():
        for match in MEMBER.finditer(code):
            parts = match['owner'][:-2].split('::')
            owners = [(spaces[name], '::'.join(parts[first:])) for first in range(len(parts))]
            owner = next((one for one in owners if one in sizes), None)
            body = code.find('{', match.end())
            if owner and body >= 0 and ';' not in code[match.end():body]:
                members[owner] += code.count('\n', match.start(), check_classes.matching(code, body)) + 1
    return {key: (name, lines + members[key]) for key, (name, lines) in sizes.items()}


FUNCTION = re.compile(r'^[ ]*(?:\[\[\w+\]\] )?(?:(?:static|inline|constexpr|explicit|virtual|friend|extern "")\s+)*'
                      r'(?:[\w:<>,&*\s]+?[&*\s])?(?:[\w:]+::)?(?P<name>~?\w+)\((?P<parameters>[^;{}()]*(?:\([^()]*\)[^;{}()]*)*)\)\s*'
                      r'(?:const|noexcept|override|final|->\s*[\w:<>]+|\s)*(?:[;{]|: |= )', re.MULTILINE)
PARAMETER = re.compile(r'(const |unsigned |struct |enum )*[\w:]+(\s*(const|[*&]|\.\.\.))*\s*(\[\[\w+\]\])?\s*\w*(\[[^\]]*\])*\s*(=.*)?')


def long_parameter_lists(code):
    """Yields (line, name, count) of the declarations with more parameters than the limit."""
    for match in FUNCTION.finditer(code):
        if re.match(r'\s*(return|else)\b', match.group()) or match['name'] in ('if', 'for', 'while', 'switch', 'sizeof', 'catch'):
            continue
        flat = re.sub(r'\{[^{}]*\}', '', match['parameters'])
        for inner in (r'<[^<>]*>', r'\([^()]*\)'):
            for _ in range(4):
                flat = re.sub(inner, '', flat)
        parameters = [one.strip() for one in flat.split(',')]
        declared = all(PARAMETER.fullmatch(one) and (re.search(r'[ *&]', one) or one in ('int', 'double', 'bool', 'float'))
                       for one in parameters)
        if declared and len(parameters) > PARAMETER_LIMIT:
            yield code.count('\n', 0, match.start('name')) + 1, match['name'], len(parameters)


def check_classes_and_parameters(codes, listed):
    """Prints the findings; returns their number. `listed`: prints the classes of at least that many lines; 0: none."""
    failures = 0
    sizes = {f'{space}::{name}': found for (space, name), found in class_sizes(codes).items()}
    for label, (name, lines) in sorted(sizes.items(), key=lambda one: -one[1][1]):
        limit = LARGE_CLASSES.get(label, (LIMIT,))[0]
        if lines > limit:
            failures += 1
            print(f'{name}:1: {label} has {lines} lines in all its files, at most {limit}')
        elif listed and lines >= listed:
            print(f'{lines:5}  {label}  {name}')
    for label in LARGE_CLASSES:
        if sizes.get(label, ('', 0))[1] <= LIMIT:
            failures += 1
            print(f'tools/check_sizes.py: {label} is small enough now: it needs no exception')
    unused = set(LONG_LISTS)
    for name, code in codes.items():
        for line, function, count in long_parameter_lists(code):
            key = name.rsplit('.', 1)[0], function
            unused.discard(key)
            if key not in LONG_LISTS:
                failures += 1
                print(f'{name}:{line}: {function} has {count} parameters, at most {PARAMETER_LIMIT}')
    for name, function in sorted(unused):
        failures += 1
        print(f'tools/check_sizes.py: {name}: {function} needs no exception')
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('root', type=pathlib.Path)
    parser.add_argument('--list', type=int, default=0)
    options = parser.parse_args()
    root = options.root
    names = subprocess.run(['git', '-C', str(root), 'ls-files', '-co', '--exclude-standard'], capture_output=True,
                           text=True, check=True).stdout.split('\n')
    failures = 0
    checked = 0
    codes = {}
    for name in names:
        path = root / name
        needs_spdx = path.suffix in SPDX_NEEDED or path.name == 'CMakeLists.txt' or name.startswith('script/')
        if not name or not path.is_file() or not needs_spdx:
            continue
        text = path.read_text()
        checked += 1
        if 'SPDX-License-Identifier: GPL-2.0-or-later' not in '\n'.join(text.splitlines()[:5]):
            print(f'{name}:1: no SPDX line')
            failures += 1
        if path.suffix == '.py' and path.stem in sys.stdlib_module_names:
            print(f'{name}:1: a standard module of Python has this name')
            failures += 1
        if path.suffix not in SOURCES:
            continue
        if path.suffix in ('.cc', '.hh'):
            codes[name] = check_classes.code_of(text)
        lines = text.count('\n')
        if lines > LIMIT:
            print(f'{name}:1: {lines} lines, at most {LIMIT}')
            failures += 1
        for start, length in long_functions(text):
            print(f'{name}:{start}: function of {length} lines, at most {FUNCTION_LIMIT}')
            failures += 1
    failures += check_classes_and_parameters(codes, options.list)
    print(f'{checked} files checked, {failures} findings')
    return 1 if failures or checked == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
