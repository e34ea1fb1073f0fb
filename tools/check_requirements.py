#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Maintains the column "tests" of docs/developer/requirements.md: the test programs that cover each row.

usage: check_requirements.py ROOT [--write]
A test names its rows in CMake: mw_test(NAME ... ROWS C10 ...) or, if it is not a GoogleTest program, a label (row-C10). Exit
status 1: a test names a row that does not exist, the column is outdated (--write corrects it), or a row has neither a test nor a
reason under "state".
"""
import collections
import pathlib
import re
import subprocess
import sys

NAMED = re.compile(r'\bmw_(?:machine_)?test\((\w+)\s[^()]*?\bROWS((?:\s+[A-K]\d{1,2})+)')
LABELLED = re.compile(r'set_tests_properties\((\S+)[^)]*?LABELS\s+"?([^")]*row-[^")]*)')
ROW = re.compile(r'^\| ([A-K]\d{1,2}) \| (.*?) \| (.*?) \| (.*?) \|$')


def tests_by_row(root):
    names = subprocess.run(['git', '-C', str(root), 'ls-files', '*CMakeLists.txt'], capture_output=True, text=True,
                           check=True).stdout.split()
    rows = collections.defaultdict(collections.Counter)
    for name in names:
        text = (root / name).read_text()
        for program, tags in NAMED.findall(text):
            for tag in tags.split():
                rows[tag][program] += 1
        for test, labels in LABELLED.findall(text):
            for tag in re.findall(r'row-([A-K]\d{1,2})', labels):
                rows[tag][test] += 1
    return rows


def column(counts):
    return ', '.join(sorted(counts))


def main():
    root = pathlib.Path(sys.argv[1])
    page = root / 'docs/developer/requirements.md'
    rows = tests_by_row(root)
    failures, seen, lines = 0, set(), []
    for number, line in enumerate(page.read_text().splitlines(), 1):
        match = ROW.match(line)
        if match:
            tag, what, state, tests = match.groups()
            seen.add(tag)
            wanted = column(rows[tag]) or '-'
            if wanted == '-' and state == 'complete':
                failures += 1
                print(f'docs/developer/requirements.md:{number}: {tag} is called complete and no test names it')
            if tests != wanted and '--write' not in sys.argv:
                failures += 1
                print(f'docs/developer/requirements.md:{number}: {tag}: the tests are now: {wanted} (--write puts it right)')
            line = f'| {tag} | {what} | {state} | {wanted} |'
        lines.append(line)
    for tag in sorted(set(rows) - seen):
        if rows[tag]:
            failures += 1
            print(f'{tag} is named by {column(rows[tag])} and is no row of docs/developer/requirements.md')
    if '--write' in sys.argv:
        page.write_text('\n'.join(lines) + '\n')
    print(f'{len(seen)} rows checked, {failures} findings')
    return 1 if failures or not seen else 0


if __name__ == '__main__':
    sys.exit(main())
