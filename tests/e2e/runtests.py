#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests runtests: it passes correct tests, fails tests that are wrong or do not end, and counts them.

usage: runtests.py BIN_FOLDER
"""
import pathlib
import subprocess
import sys
import tempfile

GOOD = 'loadrt and2\nsetp and2.0.in0 1\ngetp and2.0.in0\n'
TESTS = {
    'hal': ({'test.hal': GOOD, 'expected': 'TRUE\n'}, 'passed'),
    'wrong': ({'test.hal': GOOD, 'expected': 'FALSE\n'}, 'FAILED'),
    'shell': ({'test.sh': 'echo $((20 + 1))\n', 'expected': '21\n'}, 'passed'),
    'status': ({'test.sh': 'echo 21; exit 3\n', 'expected': '21\n'}, 'FAILED'),
    'program': ({'test': '#!/bin/sh\necho 5\n', 'checkresult': '#!/bin/sh\ngrep -q 5 "$1"\n'}, 'passed'),
    'checked': ({'test': '#!/bin/sh\necho 5\n', 'checkresult': '#!/bin/sh\ngrep -q 6 "$1"\n'}, 'FAILED'),
    'endless': ({'test.sh': 'sleep 1000\n', 'expected': ''}, 'FAILED'),
    'unjudged': ({'test.hal': GOOD}, 'FAILED'),
    'lost': ({'test.hal': 'loadusr -w echo overrun\n', 'expected': 'overrun\n'}, 'FAILED'),
    'spoken': ({'test.sh': 'echo overrun\n', 'expected': 'overrun\n'}, 'passed'),
    'foreseen': ({'test.sh': 'echo 1\n', 'expected': '2\n', 'xfail': ''}, 'failed as expected'),
    'mended': ({'test.sh': 'echo 1\n', 'expected': '1\n', 'xfail': ''}, 'FAILED'),
    'left': ({'test.sh': 'exit 1\n', 'expected': '', 'skip': ''}, 'skipped'),
    'taken': ({'test.sh': 'echo 1\n', 'expected': '1\n', 'skip': '#!/bin/sh\nexit 0\n'}, 'passed'),
}


def main():
    program = pathlib.Path(sys.argv[1]) / 'runtests'
    failures = 0
    with tempfile.TemporaryDirectory() as place:
        for name, (files, _) in TESTS.items():
            folder = pathlib.Path(place) / 'some' / name
            folder.mkdir(parents=True)
            for file, text in files.items():
                (folder / file).write_text(text)
                (folder / file).chmod(0o755 if text.startswith('#!') else 0o644)
        env = {'PATH': '/usr/bin:/bin', 'HOME': place}  # the program finds its own programs without it
        done = subprocess.run([program, '--patience', '5', place], env=env, capture_output=True, text=True, check=False, timeout=120)
        for name, (_, expected) in TESTS.items():
            if f'{expected}: {place}/some/{name}' not in done.stdout:
                failures += 1
                print(f'FAIL {name} is not {expected}')
        if done.returncode != 1 or '13 tests run, 5 successful, 7 failed + 1 expected, 1 skipped' not in done.stdout:
            failures += 1
        if done.stdout.count('some/lost: overrun detected in sampler') != 10 or '10 overruns detected, giving up' not in done.stdout:
            failures += 1
        if failures:
            print(done.stdout + done.stderr)
    print(f'{failures} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
