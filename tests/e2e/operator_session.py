#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A person at the terminal of `millwright run --realtime`, as a pseudo-terminal: it asks before the start, keys answer, and stops
remain effective (D3).

usage: operator_session.py MILLWRIGHT HALCMD ROOT
"""
import os
import pathlib
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import time

from mill_by_hand import STEP_S, Findings, Mill

TOOLS = 'G21 G90 G61 F1200\nT1 M6\nG1 X2\nM0\nG1 X4\nM2\n'
LONG = 'G21 G90 G61 F600\nG1 X100\nG1 X0\nM2\n'
FOUND = Findings()


class Terminal:
    """millwright run on a separate pseudo terminal."""

    def __init__(self, command, env):
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.execve(command[0], command, env)
        self.text = ''

    def read(self, seconds):
        if select.select([self.fd], [], [], seconds)[0]:
            try:
                self.text += os.read(self.fd, 65536).decode(errors='replace')
                return True
            except OSError:
                return False
        return True

    def wait_for(self, pattern, start=0):
        deadline = time.monotonic() + STEP_S
        while time.monotonic() < deadline:
            if re.search(pattern, self.text[start:]):
                return True
            if not self.read(0.05):
                break
        return re.search(pattern, self.text[start:]) is not None

    def stays_without(self, pattern, seconds, start):
        """The pattern does not appear within the time, so a stop remains effective."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            self.read(0.05)
        return re.search(pattern, self.text[start:]) is None

    def key(self, key):
        os.write(self.fd, key.encode())

    def end(self):
        """The exit status; the signal as a negative number."""
        deadline = time.monotonic() + STEP_S
        while time.monotonic() < deadline:
            self.read(0.02)
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid == self.pid:
                while select.select([self.fd], [], [], 0)[0] and self.read(0):
                    pass
                os.close(self.fd)
                return os.waitstatus_to_exitcode(status)
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        os.close(self.fd)
        return 'it had to be killed'


def expect(condition, what, terminal=None):
    FOUND.expect(condition, what, *([terminal.text] if terminal else []))


def main():
    millwright, halcmd, root = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as temporary:
        mill = Mill(millwright, halcmd, root, pathlib.Path(temporary), 'operator')
        folder, env, ini, position = mill.folder, mill.env, str(mill.ini), mill.position
        mill.write('tools.ngc', TOOLS)
        mill.write('long.ngc', LONG)

        def start(program, *more):
            return Terminal([millwright, 'run', ini, str(folder / program), '--realtime', *more], env)

        one = start('tools.ngc')
        expect(one.wait_for(r'\[y/n\]'), 'asks before it starts', one)
        one.key('n')
        expect(one.end() == 1 and 'not started' in one.text, 'no is an answer', one)

        one = start('tools.ngc')
        one.wait_for(r'\[y/n\]')
        one.key('y')
        expect(one.wait_for('load tool 1'), 'requests the tool', one)
        here = len(one.text)
        expect(one.stays_without('program stop', 1.0, here), 'waits for the person with the tool', one)
        one.key('t')
        expect(one.wait_for('program stop at line 4'), 'M0 stops', one)
        expect(abs(position() - 2.0) < 1e-6, 'stops at M0')
        here = len(one.text)
        expect(one.stays_without('cycle time', 1.0, here) and abs(position() - 2.0) < 1e-6, 'M0 holds', one)
        one.key('r')
        expect(one.end() == 0 and 'cycle time' in one.text, 'r continues to the end', one)

        one = start('long.ngc', '--yes')
        expect(one.wait_for(r'line 2 of 4 \(50 %\)  X[1-9]'), 'shows line, share and position', one)
        one.key('h')
        expect(one.wait_for('held'), 'h holds', one)
        time.sleep(0.3)
        before = position()
        time.sleep(0.5)
        expect(position() == before, 'a paused program is stopped')
        here = len(one.text)
        one.key('r')
        expect(one.wait_for('runs', here), 'r goes on', one)
        one.key('a')
        expect(one.end() == 1 and 'aborted' in one.text, 'a aborts', one)

        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGINT):
            one = start('long.ngc', '--yes')
            expect(one.wait_for(r'X[1-9]'), 'runs', one)
            os.kill(one.pid, number)
            expect(one.end() == 1 and f'stopped by {number.name}' in one.text, f'{number.name} stops in order', one)

        # The program is checked before the start, which takes up to 5 s.
        mill.write('endless.ngc', 'G21 G90 F600\no1 while [1]\nG1 X10\nG1 X0\no1 endwhile\nM2\n')
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGINT):
            one = start('endless.ngc', '--yes')
            expect(one.wait_for('reading'), 'shows how far it has read', one)
            os.kill(one.pid, number)
            expect(one.end() == 1 and 'before the start' in one.text, f'{number.name} stops the look ahead', one)

        alone = subprocess.run([millwright, 'run', ini, str(folder / 'long.ngc'), '--realtime'], env=env, text=True,
                               stdin=subprocess.DEVNULL, capture_output=True, check=False, timeout=STEP_S)
        expect(alone.returncode == 1 and '--yes' in alone.stderr, f'rejected without a terminal: {alone.stderr}')

        held = subprocess.Popen([millwright, 'run', ini, str(folder / 'tools.ngc'), '--realtime', '--yes', '--patience', '1'],
                                env=env, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        time.sleep(3.0)
        expect(held.poll() is None, 'without a terminal a tool change waits for its pin without a time limit')
        expect(mill.set_pin('hal_manualtoolchange.change_button', '1'), 'the button is there')
        time.sleep(2.0)
        expect(held.poll() is None and abs(position() - 2.0) < 1e-6, 'and M0 for halui.program.resume')
        expect(mill.set_pin('halui.program.resume', '1'), 'the pin of halui is there')
        said, _ = held.communicate(timeout=STEP_S)
        expect(held.returncode == 0 and 'halui.program.resume' in said, f'the pin continues: {said}')
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
