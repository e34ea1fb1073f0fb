#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Failures of Python clients on another computer (F9): two clients at once, a server that stops answering and continues, a
machine that is restarted, a machine that ends while its server runs.

usage: remote_losses.py MILLWRIGHT HALCMD ROOT PYTHON_FOLDER
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from mill_by_hand import STEP_S
from nml_session import FOUND
from remote_clients import BEGIN, OPERATE, Computers

expect = FOUND.expect
LIMIT_S = 15  # for any action of a client while its server does not answer
# One of two clients: it counts in a parameter that only it uses; one of five commands must fail.
SHARE = BEGIN + """
who, count = sys.argv[2], 25
c.mode(linuxcnc.MODE_MDI)
must(c.wait_complete(20) == linuxcnc.RCS_DONE, 'MDI')
print('begins', flush=True)
sys.stdin.readline()
last = c.serial
for i in range(count):
    is_good = i % 5 != 4
    if is_good:
        c.mdi(f'#{100 + int(who)}=[#{100 + int(who)}+1]')
    else:
        c.spindleoverride(0.5, 7)  # there is no such spindle
    must(c.serial > last, 'its serial numbers rise')
    last = c.serial
    must(c.wait_complete(30) == (linuxcnc.RCS_DONE if is_good else linuxcnc.RCS_ERROR), f'line {i} has its own outcome')
s.poll()
must(s.task_state == linuxcnc.STATE_ON, 'the machine is on')
print('done', flush=True)
"""
# Loses its server, reports this, and finds it again.
LOSE = BEGIN + """
s.poll()
if c.mode(linuxcnc.MODE_MDI) or c.wait_complete(20) != linuxcnc.RCS_DONE:
    sys.exit('not in MDI')
print('polls', flush=True)
sys.stdin.readline()
began = time.monotonic()
try:
    c.mdi('G53 G0 X9')
    print('mdi', c.wait_complete(4))
except linuxcnc.error as error:
    print('mdi', error)
said = ''
while not said and time.monotonic() - began < 30:
    said = refused(s.poll)
    time.sleep(0.01)
print(f'{time.monotonic() - began:.1f}', said.replace(chr(10), ' '), flush=True)
began = time.monotonic()
said = refused(s.poll)
print(f'{time.monotonic() - began:.1f}', said.replace(chr(10), ' '), flush=True)
began = time.monotonic()
said = refused(lambda: c.mode(linuxcnc.MODE_MANUAL))
print(f'{time.monotonic() - began:.1f}', said.replace(chr(10), ' '), flush=True)
sys.stdin.readline()
end = time.monotonic() + 40
while refused(s.poll) and time.monotonic() < end:
    time.sleep(0.05)
s.poll()
c.mode(linuxcnc.MODE_MANUAL)
print('again', c.wait_complete(20), f'{s.position[0]:.3f}', c.serial, flush=True)
"""


class Two(Computers):
    def client(self, script, *words):
        return subprocess.Popen([sys.executable, '-c', script, *words], env=self.there, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                text=True)


def tell(client):
    client.stdin.write('\n')
    client.stdin.flush()


def two_clients(bench, path):
    with bench.client(SHARE, path, '1') as first, bench.client(SHARE, path, '2') as second:
        for client in (first, second):
            expect(client.stdout.readline() == 'begins\n', 'a client of two begins')
        for client in (first, second):
            tell(client)
        for client in (first, second):
            expect(client.stdout.read() == 'done\n' and client.wait(STEP_S) == 0, 'each of two clients has its own outcomes')
    done = bench.python(BEGIN + """
for who in (1, 2):
    c.mode(linuxcnc.MODE_MDI)
    c.wait_complete(20)
    c.mdi(f'G53 G0 X[#{100 + who}]')
    c.wait_complete(20)
    s.poll()
    print(f'{s.position[0]:.0f}')
""", path)
    expect(done.stdout.split() == ['20', '20'], 'the lines of both were executed, once each', done.stdout, done.stderr)


def wait_stopped(pid):
    deadline = time.monotonic() + STEP_S
    while time.monotonic() < deadline:
        states = [path.read_text().rpartition(')')[2].split()[0] for path in pathlib.Path(f'/proc/{pid}/task').glob('*/stat')]
        if all(state == 'T' for state in states):
            return
        time.sleep(0.01)
    expect(False, 'the server is stopped')


def silence(bench, path, server):
    """A server that does not answer: a command that its client has abandoned is not executed when the server continues."""
    before = bench.position()
    with bench.client(LOSE, path) as client:
        expect(client.stdout.readline() == 'polls\n', 'it polls')
        os.kill(server.pid, signal.SIGSTOP)
        try:
            wait_stopped(server.pid)
            tell(client)
            mdi = client.stdout.readline()
            expect(mdi.startswith('mdi') and mdi != 'mdi 1\n', 'a command without an answer is not done', mdi)
            for what in ('the first poll', 'a poll after it', 'a command'):
                took, _, said = client.stdout.readline().partition(' ')
                expect(float(took or 99) < LIMIT_S, f'{what} returns in time', took, said)
                expect(f'localhost:{bench.port}' in said, f'{what} names the server', said)
        finally:
            os.kill(server.pid, signal.SIGCONT)
        tell(client)
        again = client.stdout.readline().split()
        expect(again[:2] == ['again', '1'], 'it works again when its server answers', again)
    expect(bench.position() == before, 'a command that its client has abandoned is not executed later', before, bench.position())


def restart(bench, path, machine, server):
    """The machine and its server are ended and started again; running clients find them."""
    with bench.client(LOSE, path) as client:
        expect(client.stdout.readline() == 'polls\n', 'it polls')
        for process in (server, machine):
            process.terminate()
            process.wait(STEP_S)
        tell(client)
        client.stdout.readline()
        for what in ('the first poll', 'a poll after it', 'a command'):
            took, _, said = client.stdout.readline().partition(' ')
            expect(float(took or 99) < LIMIT_S and f'localhost:{bench.port}' in said, f'{what} without a machine is an error', took, said)
        machine = bench.start_machine()
        server = bench.begin('are up', 'nml', str(bench.folder / 'machine.nml'))
        tell(client)
        again = client.stdout.readline().split()
        expect(again[:2] == ['again', '1'], 'it operates the machine that was started again', again)
    done = bench.python(OPERATE, path)
    expect(done.stdout == 'operated\n', 'a new client operates it, too', done.stdout, done.stderr)
    return machine, server


def machine_alone_ends(bench, path, machine):
    """A machine that was killed: no client shows its last status as current."""
    with bench.client(LOSE, path) as client:
        expect(client.stdout.readline() == 'polls\n', 'it polls')
        machine.kill()
        machine.wait(STEP_S)
        tell(client)
        client.stdout.readline()
        for what in ('the first poll', 'a poll after it', 'a command'):
            took, _, said = client.stdout.readline().partition(' ')
            expect(float(took or 99) < LIMIT_S and said.strip(), f'{what} of a machine that was killed is an error', took, said)
        client.kill()


def main():
    with tempfile.TemporaryDirectory(prefix='mw_losses_') as folder:
        bench = Two(*sys.argv[1:5], '', pathlib.Path(folder))
        try:
            machine = bench.start_machine()
            path = bench.channels('client.nml', bench.port)
            server = bench.begin('are up', 'nml', str(bench.folder / 'machine.nml'))
            done = bench.python(OPERATE, path)
            expect(done.stdout == 'operated\n', 'a client operates it', done.stdout, done.stderr)
            two_clients(bench, path)
            silence(bench, path, server)
            machine, server = restart(bench, path, machine, server)
            machine_alone_ends(bench, path, machine)
        finally:
            bench.end_all()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
