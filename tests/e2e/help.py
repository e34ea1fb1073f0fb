#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests that each program and each command of millwright answers --help on standard output with status 0, and that the completion
knows all options.

usage: help.py BIN_FOLDER ROOT
"""
import pathlib
import re
import subprocess
import sys

COMMANDS = ('run', 'start', 'ui', 'doctor', 'select', 'setup', 'check', 'format', 'explain', 'hal', 'hal watch', 'hal capture', 'hal graph', 'hal latency')


def main():
    folder, root = map(pathlib.Path, sys.argv[1:3])
    asked = [[program.name] for program in sorted(folder.iterdir()) if not program.name.endswith('_test') and program.is_file()]
    asked += [['millwright', *command.split()] for command in COMMANDS]
    failures = 0
    completion = (root / 'programs/mains/completion/millwright').read_text()
    for words in asked:
        done = subprocess.run([folder / words[0], *words[1:], '--help'], capture_output=True, text=True, check=False,
                              stdin=subprocess.DEVNULL, timeout=20)
        missing = []
        if words[0] == 'millwright' and len(words) == 2:
            missing = [option for option in re.findall(r'^ +(--[a-z-]+)', done.stdout, re.M) if option not in completion]
        named = words[0] in done.stdout or words[0].replace('-', ' ') in done.stdout  # millwright-shop is started as millwright shop
        if done.returncode != 0 or not named or done.stderr or missing:
            failures += 1
            print(f'FAIL {" ".join(words)} --help: status {done.returncode}; completion lacks {missing}\n{done.stdout}{done.stderr}')
    print(f'{len(asked) - failures} passed, {failures} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
