#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The order in which the kernel ends the programs of a machine when memory is exhausted: the realtime process last.

usage: memory.py BIN_FOLDER ROOT [NAME]
"""
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import run_attacks  # noqa: E402  pylint: disable=wrong-import-position


def score(process):
    return int(pathlib.Path(f'/proc/{process}/oom_score_adj').read_text(encoding='ascii'))


def may_lower():
    """Whether programs of this user may lower their value; the kernel requires CAP_SYS_RESOURCE, as root has."""
    return subprocess.run(['sh', '-c', 'echo -900 > /proc/self/oom_score_adj'], stderr=subprocess.DEVNULL, check=False).returncode == 0


def program_of(machine, word):
    """The process of this machine whose command line contains a word."""
    for folder in pathlib.Path('/proc').glob('[0-9]*'):
        try:
            if word in (folder / 'cmdline').read_bytes() and machine.env['MILLWRIGHT_INSTANCE'].encode() in (folder / 'environ').read_bytes():
                return int(folder.name)
        except OSError:
            continue
    return 0


def with_user_code(text):
    return text.replace('[RS274NGC]', '[RS274NGC]\nUSER_M_PATH = codes', 1)


def prepare_user_code(machine):
    code = machine.ini.parent / 'codes/M101'
    code.parent.mkdir()
    code.write_text('#!/bin/sh\nexec sleep 20\n', encoding='ascii')
    code.chmod(0o755)


def order(machine, found):
    session, realtime, task = score(os.getpid()), score(program_of(machine, b'millwright-rt')), score(machine.process.pid)
    found.expect(realtime == (-900 if may_lower() else session), 'millwright-rt is ended last', realtime)
    found.expect(task == session + 100, 'task before it', task)
    machine.cut('G21 G90\nG1 X3 F600\nM101\nM2\n')
    found.expect(machine.until(lambda: program_of(machine, b'sleep\x0020') != 0, 5), 'M101 runs')
    found.expect(machine.until(lambda: score(program_of(machine, b'sleep\x0020')) == session + 300, 2), 'M101 before task', score(program_of(machine, b'sleep\x0020')))


if __name__ == '__main__':
    run_attacks(__file__, {'order': order}, prepare_user_code, with_user_code)
