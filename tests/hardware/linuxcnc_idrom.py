#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The 15 faulty firmware descriptions of hm2_test: LinuxCNC's hostmot2 and ours report the same errors, line by line.

usage: linuxcnc_idrom.py HALRUN (not as root: LinuxCNC's halrun rejects root)
Exit status: 0 all agree, 1 something differs, 77 skipped, with the reason. Pattern 12 has pins without an IO port: LinuxCNC
reports this and loads the board, ours rejects it.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
LINUXCNC = '/usr/bin/halrun'
PATTERNS, LOADED_BY_LINUXCNC = range(15), 12
END = 'hm2_test.0: hm2_test fails HM2 registration'


def errors(halrun, folder, pattern):
    """Lines of the driver in the error output."""
    hal = pathlib.Path(folder) / 'test.hal'
    hal.write_text(f'loadrt hostmot2\nloadrt hm2_test test_pattern={pattern}\n')
    done = subprocess.run([halrun, '-f', str(hal)], cwd=folder, capture_output=True, text=True, timeout=60, check=False,
                          env=dict(os.environ, MILLWRIGHT_INSTANCE=f'idrom{os.getpid()}'))
    # The last lines come from the program that loads modules.
    lines = [line for line in done.stderr.splitlines() if line.startswith('hm2')]
    return [line for line in lines if 'rtapi_app_main' not in line and 'not loaded' not in line]


def main():
    halrun = sys.argv[1]
    if shutil.which(LINUXCNC) is None:
        print(f'skipped: {LINUXCNC} is not installed')
        return SKIPPED
    if os.geteuid() == 0:
        print('skipped: LinuxCNC runs as an ordinary user only')
        return SKIPPED
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for pattern in PATTERNS:
            theirs, ours = errors(LINUXCNC, folder, pattern), errors(halrun, folder, pattern)
            wanted = theirs + [END] if pattern == LOADED_BY_LINUXCNC else theirs
            if not theirs or ours != wanted:
                failed += 1
                print(f'pattern {pattern}: LinuxCNC\n  ' + '\n  '.join(theirs) + '\nMillwright\n  ' + '\n  '.join(ours))
    print(f'{len(PATTERNS)} patterns, {failed} differ')
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
