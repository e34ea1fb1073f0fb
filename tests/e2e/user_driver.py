#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Drivers for the canonical devices are built outside the tree by halcompile and loaded (B2).

usage: user_driver.py BIN_FOLDER SOURCE_FOLDER
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

programs, source = map(pathlib.Path, sys.argv[1:3])


def run(*command, cwd):
    """The output of the command; ends the test when the command fails."""
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=100, check=False,
                          env={**os.environ, 'MILLWRIGHT_INSTANCE': f'user-driver-{os.getpid()}',
                               'MILLWRIGHT_MODULE_PATH': str(cwd)})
    if done.returncode != 0:
        sys.exit(f'{command}:\n{done.stdout}{done.stderr}')
    return done.stdout


def driver_of_page():
    """The driver that docs/integrator/hal/drivers.md shows."""
    text = (source / 'docs/integrator/hal/drivers.md').read_text()
    shown = re.search(r'^    #include <millwright/canonical.hh>\n(.*?)MW_COMPONENT\(.*?\n', text, re.M | re.S).group(0)
    return re.sub('^    ', '', shown, flags=re.M)


with tempfile.TemporaryDirectory() as folder:
    base = pathlib.Path(folder)
    (base / 'board.cc').write_text('// SPDX-License-Identifier: GPL-2.0-or-later\n' + driver_of_page())
    (base / 'loop_board.cc').write_text((source / 'examples/driver/loop_board.cc').read_text())
    for name in ('board', 'loop_board'):
        run(programs / 'halcompile', '--compile', f'{name}.cc', cwd=base)
        if not (base / f'{name}.so').exists():
            sys.exit(f'halcompile made no {name}.so')
    (base / 'test.hal').write_text(
        'loadrt loop_board\nloadrt board\nshow pin loop-board.0.digin*\nshow pin board.0.*\n')
    shown = run(programs / 'halrun', 'test.hal', cwd=base)
    for pin in ('loop-board.0.digin-00.in-not', 'board.0.digin-00.in', 'board.0.digout-00.out'):
        if pin not in shown:
            sys.exit(f'{pin} is missing in:\n{shown}')
