#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The machine continues to cut, answers and ends, whatever happens to the terminal, pipe or output file of `millwright start`.

usage: output.py BIN_FOLDER ROOT [gone|unread|stopped|full]
"""
import os
import pathlib
import pty
import subprocess
import sys
import termios

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from rig import ABORT_S, END_S, Machine  # noqa: E402  pylint: disable=wrong-import-position

KINDS = ('gone', 'unread', 'stopped', 'full')
# More messages than the pipe and the relay can hold; M66 prevents the interpreter from reading them faster
# than a client.
MESSAGE = '(MSG,' + 'part 1234 at the middle of the plate ' * 6 + ')\n'
MANY = f'G21 G90 G61 F600\nM3 S500\no1 repeat [3000]\n{MESSAGE}M66 P0 L0\no1 endrepeat\no2 repeat [100]\nG1 X10\nG1 X0\no2 endrepeat\nM2\n'


def places(kind):
    """The target of the output, and the attack on it after the machine has started."""
    if kind == 'full':
        return os.open('/dev/full', os.O_WRONLY), lambda: None
    if kind == 'stopped':
        _, terminal = pty.openpty()
        return terminal, lambda: termios.tcflow(terminal, termios.TCOOFF)
    reader, writer = os.pipe()
    return writer, (lambda: os.close(reader)) if kind == 'gone' else (lambda: None)


def attack(programs, root, kind):
    found = Findings()
    machine = Machine(programs, root, f'output-{kind}')
    try:
        output, spoil = places(kind)
        machine.start(stdout=output, stderr=output)
        spoil()
        machine.cut(MANY)
        found.expect(machine.cuts_on(3), f'{kind}: the machine cuts on', *machine.messages[-2:])
        found.expect(machine.until(lambda: any('output of this program is lost' in text for text in machine.messages), 10),
                     f'{kind}: a message says that output is lost', *machine.messages[-2:])
        took = machine.abort_s()
        found.expect(took < ABORT_S, f'{kind}: an abort is answered in {took:.3f} s')
        took = machine.end_s()
        found.expect(took < END_S and machine.process.returncode == 0, f'{kind}: SIGTERM ends it in {took:.1f} s, status {machine.process.returncode}')
    finally:
        machine.clean()
    return found.status()


def main():
    if len(sys.argv) > 3:
        return attack(sys.argv[1], sys.argv[2], sys.argv[3])
    # Each process can use linuxcnc with only one instance.
    return max(subprocess.run([sys.executable, __file__, *sys.argv[1:3], kind], check=False).returncode for kind in KINDS)


if __name__ == '__main__':
    sys.exit(main())
