#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A program written with python/tooldb answers the machine's lines. Arguments: the source folder."""
import subprocess
import sys
import os

PROGRAM = '''
import sys
from tooldb import tooldb_tools, tooldb_callbacks, tooldb_loop
log = open(sys.argv[1], 'w')
def get(number):
    if number == 9:
        raise KeyError('no nine')
    return f'T{number} P{number + 100} Z0.5'
def put(number, line):
    log.write(f'put {number} {line}\\n')
def load(number, line):
    log.write(f'load {number} {line}\\n')
    if number == 2:
        tooldb_tools([1, 9])
def unload(number, line):
    raise RuntimeError('not\\nnow')
tooldb_tools([1, 2])
tooldb_callbacks(get, put, load, unload)
tooldb_loop()
log.close()
'''

ASKED = 'g\np T1   P101 Z0.7 d2\nl T1   P0  \nu T0   P0  \nz what\n\nl Tx\nl T2 P0\ng\n'
ANSWERED = '''v2.1
T1 P101 Z0.5
T2 P102 Z0.5
FINI (get_cmd)
FINI (update recvd) T1   P101 Z0.7 d2
FINI (update recvd) T1   P0
NAK cmd=u: RuntimeError:not now <u T0   P0>
NAK unknown cmd <z what>
NAK empty_line <>
NAK cmd=l: ValueError:invalid literal for int() with base 10: 'X' <l Tx>
FINI (update recvd) T2 P0
T1 P101 Z0.5
NAK cmd=g: KeyError:'no nine' <g>
'''
LOGGED = 'put 1 T1   P101 Z0.7 D2\nload 1 T1   P0\nload 2 T2 P0\n'


def main():
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, 'database.py')
        log = os.path.join(folder, 'log')
        with open(program, 'w', encoding='utf-8') as file:
            file.write(PROGRAM)
        environment = dict(os.environ, PYTHONPATH=os.path.join(sys.argv[1], 'python'))
        ended = subprocess.run([sys.executable, program, log], input=ASKED, capture_output=True, text=True,
                               timeout=60, env=environment, check=False)
        assert ended.stdout == ANSWERED, ended.stdout + ended.stderr
        assert ended.returncode == 0, ended.stderr
        with open(log, encoding='utf-8') as file:
            logged = file.read()
        assert logged == LOGGED, logged
    return 0


if __name__ == '__main__':
    sys.exit(main())
