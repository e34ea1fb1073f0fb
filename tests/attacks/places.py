#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine whose folder cannot be written reports this when it starts. Needs an ordinary user, because root can write everywhere.

usage: places.py BIN_FOLDER ROOT
"""
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from rig import Machine  # noqa: E402  pylint: disable=wrong-import-position

NOBODY = 65534


def main():
    if os.geteuid() == 0:
        return subprocess.run([sys.executable, *sys.argv], user=NOBODY, group=NOBODY, extra_groups=[], check=False).returncode
    found = Findings()
    machine = Machine(sys.argv[1], sys.argv[2], 'places')
    try:
        machine.ini.parent.chmod(0o555)
        machine.start()
        machine.until(lambda: False, 0.2)
        for name in ('.var', '.tbl'):
            expected = [text for text in machine.messages if 'are not saved' in text and name in text]
            found.expect(expected, f'a message says that {name} is not saved', *machine.messages)
            found.expect(f'{name} are not saved' in machine.text(), f'the terminal reports it for {name}', machine.text()[-300:])
        machine.process.terminate()
        machine.process.wait(5)
    finally:
        machine.ini.parent.chmod(0o755)
        machine.clean()
    return found.status()


if __name__ == '__main__':
    sys.exit(main())
