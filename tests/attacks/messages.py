#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Messages of programs that clients cannot read as they are.

usage: messages.py BIN_FOLDER ROOT [NAME]
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import run_attacks  # noqa: E402  pylint: disable=wrong-import-position


def encoding(machine, found):
    """A message whose bytes are no UTF-8: readers get it with the wrong bytes replaced."""
    path = machine.folder / 'latin.ngc'
    path.write_bytes(b'(MSG, \x85 gr\xfc\xdfe)\nM2\n')
    machine.open(path)
    machine.command.auto(machine.linuxcnc.AUTO_RUN, 1)
    told = machine.until(lambda: any('\ufffd gr\ufffd\ufffde' in text for text in machine.messages), 5)
    found.expect(told, 'the message of the program', machine.messages)


if __name__ == '__main__':
    run_attacks(__file__, {'encoding': encoding})
