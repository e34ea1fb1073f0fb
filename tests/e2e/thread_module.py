#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The example module that creates threads, built by halcompile: motion runs in its servo-thread as in motion's own thread, its
second thread runs in parallel, and a servo-thread with another period is rejected.

usage: thread_module.py BIN_FOLDER SOURCE_FOLDER
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROGRAM = 'G21 G90 G1 X10 F3000\nG4 P0.5\n(debug,counted #<_hal[userthreads.cycles]>)\nG1 X0\nM2\n'
PLAIN = PROGRAM.replace('(debug,counted #<_hal[userthreads.cycles]>)\n', '')


def main():
    programs, source = (pathlib.Path(word) for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        shutil.copytree(source / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var', '*.journal*'))
        machine = folder / 'configs/sim'
        built = subprocess.run([programs / 'halcompile', '--compile', '-o', folder / 'userthreads.so',
                                source / 'examples/threads/userthreads.comp'], capture_output=True, text=True, check=False, timeout=60)
        assert built.returncode == 0, built.stdout + built.stderr

        def run(program, before=''):
            text = (machine / 'mill_mm.ini').read_text().replace('[RS274NGC]\n', '[RS274NGC]\nHAL_PIN_VARS = 1\n')
            (machine / 'before.hal').write_text(before)
            (machine / 'case.ini').write_text(text.replace('[HAL]\n', '[HAL]\nHALFILE = before.hal\n'))
            (folder / 'part.ngc').write_text(program)
            (folder / 'trace.csv').unlink(missing_ok=True)
            done = subprocess.run([programs / 'millwright', 'run', machine / 'case.ini', folder / 'part.ngc', '--trace', folder / 'trace.csv'],
                                  env=dict(os.environ, MILLWRIGHT_MODULE_PATH=str(folder)), capture_output=True, text=True,
                                  check=False, timeout=60)
            trace = folder / 'trace.csv'
            return done.returncode, done.stdout + done.stderr, trace.read_bytes() if trace.exists() else b''

        own = run(PLAIN)
        assert own[0] == 0, own[1]
        made = 'loadrt userthreads io_period_ns=5000000\naddf userthreads.count io-thread\n'
        theirs = run(PROGRAM, made)
        assert theirs[0] == 0, theirs[1]
        counted = re.search(r'counted (\d+)', theirs[1])
        assert counted, theirs[1]
        # Homing and the moves take place after half a second at 5 ms.
        assert 100 <= int(counted[1]) < 2000, counted[0]
        assert run(PLAIN, made)[2] == own[2], 'motion differs in a thread of the same period'
        other = run(PLAIN, 'loadrt userthreads servo_period_ns=2000000\n')
        assert other[0] != 0 and 'has a period of 2000000 ns, motion wants 1000000 ns' in other[1], other[1]
    print(f'io-thread {counted[0]}; the same trace as in motmod\'s own thread')


if __name__ == '__main__':
    main()
