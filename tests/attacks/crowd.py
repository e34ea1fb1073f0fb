#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Row 15: new clients can stop the machine while all entries of the mailbox are occupied, and while no descriptors are free.

usage: crowd.py BIN_FOLDER ROOT [NAME]
"""
import os
import pathlib
import resource
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import ABORT_S, run_attacks  # noqa: E402  pylint: disable=wrong-import-position
from web import Screen as Server  # noqa: E402  pylint: disable=wrong-import-position
from web_screen import Screen  # noqa: E402  pylint: disable=wrong-import-position

CLIENTS = 32
LEFT = 40


def fill(machine, found):
    """Starts Python clients until the machine accepts no more."""
    clients = [machine.command]
    while len(clients) <= CLIENTS + 1:
        try:
            client = machine.linuxcnc.command()
            client.debug(0)  # the client occupies its entry with the first command
            clients.append(client)
        except machine.linuxcnc.error:
            break
    found.expect(20 < len(clients) <= CLIENTS, f'the machine accepts {len(clients)} clients of Python')
    return clients


def answered_s(screen, message, **fields):
    """Time until a command is answered with DONE."""
    begin = time.monotonic()
    outcome = screen.do(message, **fields)
    return time.monotonic() - begin if outcome == 'DONE' else float('inf')


def stops(machine, found, server, when):
    """A new screen aborts and sets the emergency stop; each is answered in time and takes effect."""
    screen = Screen(server.port)
    found.expect(screen.until(lambda: bool(screen.status), 5), f'{when}: a new screen shows the machine', screen.head)
    found.expect((screen.hello or {}).get('client') == 0, f'{when}: no place is left for the screen', screen.hello)
    took = answered_s(screen, 'AbortAll')
    found.expect(took < ABORT_S, f'{when}: Abort of a new screen is answered in {took:.3f} s', screen.outcomes)
    screen = Screen(server.port)
    screen.until(lambda: bool(screen.status), 5)
    took = answered_s(screen, 'SetState', state='ESTOP')
    found.expect(took < ABORT_S, f'{when}: Emergency stop of a new screen is answered in {took:.3f} s', screen.outcomes)
    found.expect(machine.until(lambda: machine.stat.task_state == machine.linuxcnc.STATE_ESTOP, 2), f'{when}: the machine is in emergency stop')


def clients(machine, found):
    """All entries of the mailbox are occupied, before and after the server of the screens is started."""
    machine.cut()
    crowd = fill(machine, found)
    server = Server(machine)
    try:
        stops(machine, found, server, f'with {len(crowd)} clients')
    finally:
        server.kill()


def descriptors(machine, found):
    """The server of the screens has 40 free descriptors, and requests occupy them."""
    machine.cut()
    crowd = fill(machine, found)
    server = Server(machine)
    peers = []
    try:
        server.ask('/api/machine')
        used = len(os.listdir(f'/proc/{server.process.pid}/fd'))
        _, most = resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE)
        resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (used + LEFT, most))
        peers = [server.send('/api/files/cut.ngc') for _ in range(24)]
        stops(machine, found, server, f'with {len(crowd)} clients and {LEFT} descriptors')
    finally:
        for peer in peers:
            peer.close()
        server.kill()


def process(machine, found):
    """A new client in another process aborts while task runs out of descriptors and one entry is free."""
    machine.cut()
    used = len(os.listdir(f'/proc/{machine.process.pid}/fd'))
    _, most = resource.prlimit(machine.process.pid, resource.RLIMIT_NOFILE)
    resource.prlimit(machine.process.pid, resource.RLIMIT_NOFILE, (used + LEFT, most))
    crowd = fill(machine, found)
    del crowd[1:4]
    machine.until(lambda: False, 0.3)  # task releases the entries
    text = ('import time, linuxcnc\nc = linuxcnc.command()\nbegin = time.monotonic()\nc.abort()\nanswer = c.wait_complete(2)\n'
            'print(time.monotonic() - begin if answer == linuxcnc.RCS_DONE else "inf")')
    run = subprocess.run([sys.executable, '-c', text], env=machine.env, capture_output=True, text=True, timeout=30, check=False)
    took = float(run.stdout or 'inf')
    found.expect(took < ABORT_S, f'Abort of a new client is answered in {took:.3f} s', run.stderr)
    found.expect(machine.until(lambda: machine.stat.interp_state == machine.linuxcnc.INTERP_IDLE, 2), 'the program has ended')


if __name__ == '__main__':
    run_attacks(__file__, {'clients': clients, 'descriptors': descriptors, 'process': process})
