#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""haltcl, programs that it starts, and a shell with script/environment find our Tcl packages before others of the same name.

usage: tcl_packages.py BIN_FOLDER ROOT
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from mill_by_hand import STEP_S, Findings

FOUND = Findings()
expect = FOUND.expect
ASK = 'catch {package require NoSuchPackage}\nputs [package ifneeded Linuxcnc 1.0]\nputs [package ifneeded Hal 1.0]\n'


def main():
    programs, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    ours = str(programs.parent / 'lib')
    with tempfile.TemporaryDirectory(prefix='mw_tcl_') as name:
        folder = pathlib.Path(name)
        other = folder / 'others'
        other.mkdir()
        (other / 'pkgIndex.tcl').write_text('package ifneeded Linuxcnc 1.0 {error other}\npackage ifneeded Hal 1.0 {error other}\n')
        (folder / 'ask.tcl').write_text(ASK)
        (folder / 'child.tcl').write_text('puts [exec tclsh ask.tcl]\n')
        env = dict(os.environ, TCLLIBPATH=str(other), MILLWRIGHT_INSTANCE=f'tcl-{os.getpid()}')

        def run(*words):
            return subprocess.run([str(word) for word in words], cwd=folder, env=env, text=True, capture_output=True, check=False,
                                  stdin=subprocess.DEVNULL, timeout=STEP_S)

        tclsh = shutil.which('tclsh')
        asked = [('haltcl', run(programs / 'haltcl', 'ask.tcl'))]
        if tclsh is not None:
            before = run(tclsh, 'ask.tcl')
            expect('error other' in before.stdout, 'without our environment the other package is found', before)
            asked.append(('a program of haltcl', run(programs / 'haltcl', 'child.tcl')))
            asked.append(('script/environment', run('bash', '-c', f'. {root}/script/environment {programs.parent} && tclsh ask.tcl')))
        for what, done in asked:
            lines = done.stdout.splitlines()
            expect(len(lines) == 2 and all('error other' not in line and ours in os.path.normpath(line.split()[1]) for line in lines), f'{what} finds our packages', done)
        left = run(programs / 'halcmd', 'show', 'comp')
        expect('no realtime process is running' in left.stderr, 'haltcl ends the realtime process that it started and left empty', left)
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
