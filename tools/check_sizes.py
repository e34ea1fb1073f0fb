#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks SPDX lines, file sizes, function sizes and names of Python files.

usage: check_sizes.py ROOT; exit status 1 lists the findings. A Python file with the name of a standard module takes that
module's place for every program in its folder.
"""
import pathlib
import re
import subprocess
import sys

FILE_LIMIT = 500
FUNCTION_LIMIT = 80
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


def main():
    root = pathlib.Path(sys.argv[1])
    names = subprocess.run(['git', '-C', str(root), 'ls-files', '-co', '--exclude-standard'], capture_output=True,
                           text=True, check=True).stdout.split('\n')
    failures = 0
    checked = 0
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
        lines = text.count('\n')
        if lines > FILE_LIMIT:
            print(f'{name}:1: {lines} lines, at most {FILE_LIMIT}')
            failures += 1
        for start, length in long_functions(text):
            print(f'{name}:{start}: function of {length} lines, at most {FUNCTION_LIMIT}')
            failures += 1
    print(f'{checked} files checked, {failures} findings')
    return 1 if failures or checked == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
