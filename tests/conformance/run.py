#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the external conformance cases with the programs of the build.

usage: run.py BIN ONLY KNOWN

BIN is the folder of programs, ONLY the part of the cases (rs274 or halrun), KNOWN a file with the ids of cases that do not pass
yet, one per line. A case that fails and is not in KNOWN is an error, and so is a case of KNOWN that passes: the list may only
shrink. The cases are in $MILLWRIGHT_CONFORMANCE, or in ../shared/conformance beside the checkout. Without cases the exit status
is 77 (skipped).
"""
import os
import pathlib
import subprocess
import sys

SKIPPED = 77


def main():
    bin_dir, only, known_file = sys.argv[1:4]
    root = pathlib.Path(__file__).resolve().parents[2]
    cases = pathlib.Path(os.environ.get('MILLWRIGHT_CONFORMANCE', root.parent / 'shared' / 'conformance'))
    if not (cases / 'run').exists():
        print(f'skipped: no conformance cases in {cases}')
        return SKIPPED
    lines = pathlib.Path(known_file).read_text().splitlines()
    known = {line.strip() for line in lines if line.strip() and not line.startswith('#')}
    done = subprocess.run([sys.executable, str(cases / 'run'), '--bin', bin_dir, '--only', only, '--verbose'],
                          env=dict(os.environ, MILLWRIGHT_INSTANCE=f'conformance-{os.getpid()}'),
                          capture_output=True, text=True, check=False)
    passed, failed = set(), set()
    for line in done.stdout.splitlines():
        if line.startswith('ok   '):
            passed.add(line[5:].strip())
        elif line.startswith('FAIL '):
            failed.add(line[5:].split(': ')[0].strip())
    worse, better, gone = failed - known, known & passed, known - passed - failed
    if worse:
        print(done.stdout)
    for name in sorted(worse):
        print(f'{name}: fails')
    for name in sorted(better):
        print(f'{name}: passes now; take it out of {known_file}')
    for name in sorted(gone):
        print(f'{name}: listed in {known_file} but there is no such case')
    print(f'{len(passed)} passed, {len(failed)} failed ({len(known)} known)')
    return 1 if worse or better or gone or not passed else 0


if __name__ == '__main__':
    sys.exit(main())
