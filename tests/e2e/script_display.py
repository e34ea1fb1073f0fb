#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A script as the display of a machine started by `linuxcnc -r`: it reads every attribute, sends commands and ends the machine,
whose exit status is that of the script (J1, J2).

usage: script_display.py LINUXCNC HALCMD ROOT
"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from mill_by_hand import STEP_S, Findings, Mill

FOUND = Findings()
expect = FOUND.expect
SCREEN = pathlib.Path(__file__).with_name('script_display_screen.py')


class Launched(Mill):
    """The simulated mill with a script as its display."""

    def __init__(self, linuxcnc, halcmd, root, folder):
        super().__init__(linuxcnc, halcmd, root, folder, 'script')
        shutil.copy(SCREEN, self.ini.parent / 'screen.py')
        (self.ini.parent / 'screen.py').chmod(0o755)
        # A configuration without by_hand.hal changes its tools at once.
        text = self.ini.read_text().replace('HALFILE = by_hand.hal\n', '')
        self.plain = text.replace('DISPLAY = millwright\n', 'DISPLAY = ./screen.py first\n')
        expect(self.plain != text, 'the configuration names a display')
        # G54 differs from the machine's zero
        (self.ini.parent / 'mill_mm.var').write_text('5220\t1.0\n5221\t0.5\n')

    def launch(self, *words, extra='', ini=None, timeout=STEP_S):
        """(status, output) of the launcher."""
        path = ini or self.ini
        path.write_text(self.plain + extra)
        with subprocess.Popen([self.millwright, '-r', str(path), *words], env=self.env, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
            try:
                return process.wait(timeout), process.stdout.read()
            except subprocess.TimeoutExpired:
                process.terminate()
                return 'too long', process.communicate()[0]

    def leftovers(self):
        """Parts of the instance that still exist."""
        return [path for path in pathlib.Path('/dev/shm').glob(f"*{self.env['MILLWRIGHT_INSTANCE']}*")]


def check_screen(mill):
    for name in ('status', 'words', 'commands', 'program'):
        status, output = mill.launch(name)
        expect(status == 0, f'a script that checks {name}', status, output)
        expect('Machine configuration file is' in output, 'the launcher names the file', output)


def check_ends(mill):
    status, output = mill.launch('exit', '7')
    expect(status == 7, 'the exit status is that of the display', status, output)
    status, output = mill.launch('killed')
    expect(status == 128 + signal.SIGKILL, 'a display that is killed ends the machine', status, output)
    status, output = mill.launch('kill-launcher')
    expect(status == 0, 'a signal ends all in order', status, output)
    status, output = mill.launch('kill-realtime')
    expect(status == 1, 'a part that dies ends all, and is an error', status, output)
    expect(not mill.leftovers(), 'nothing is left behind', mill.leftovers())


def check_files(mill):
    marks = mill.ini.parent
    (marks / 'end.hal').write_text('print ending\n')
    extra = ('[HAL]\nSHUTDOWN = end.hal\nHALCMD = newsig by-command float\n'
             '[APPLICATIONS]\nDELAY = 0.05\nAPP = sh -c "echo $CONFIG_DIR > app.txt; exec sleep 60"\n')
    status, output = mill.launch('files', extra=extra)
    expect(status == 0, 'commands, applications and the last file', status, output)
    expect('ending' in output, 'the last file is run', output)
    status, output = mill.launch('status', extra='[HAL]\nHALFILE = wrong.hal\n')
    expect(status == 1, 'a missing file is an error', status, output)
    (marks / 'wrong.hal').write_text('net nothing no-such-pin\n')
    status, output = mill.launch('status', extra='[HAL]\nHALFILE = wrong.hal\n')
    expect(status == 1, 'and one that fails', status, output)


def check_second(mill):
    mill.ini.write_text(mill.plain)
    with subprocess.Popen([mill.millwright, '-r', str(mill.ini), 'wait'], env=mill.env, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as first:
        end = time.monotonic() + STEP_S
        while not (mill.ini.parent / 'waiting.txt').exists() and time.monotonic() < end:
            time.sleep(0.05)
        status, output = mill.launch('status')
        expect(status == 1 and 'already running' in output, 'a second start is rejected', status, output)
        first.terminate()
        expect(first.wait(STEP_S) == 0, 'the first one continues, and ends by a signal', first.stdout.read())


def main(linuxcnc, halcmd, root):
    with tempfile.TemporaryDirectory() as folder:
        mill = Launched(linuxcnc, halcmd, root, pathlib.Path(folder))
        check_screen(mill)
        check_files(mill)
        check_second(mill)
        check_ends(mill)
    return FOUND.status()


if __name__ == '__main__':
    os.environ.pop('DISPLAY', None)
    sys.exit(main(*sys.argv[1:]))
