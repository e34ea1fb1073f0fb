#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""An NML client on another computer (F9): a network namespace that a pair of virtual Ethernet devices connects to that of the
machine. A program with the client library finds the machine with a configuration that names a remote host. A client written only
from docs/reference/nml.md does the same over a plain socket. Access is impossible if the file names localhost, or without
`millwright nml`. Pulling the cable does not stop the machine.

Everything runs in a user namespace, so that the network of this computer is not changed. If the kernel does not permit this, the
test prints the reason and ends with 77.

usage: nml_network.py MILLWRIGHT HALCMD ROOT COMMAND_CLIENT
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from mill_by_hand import STEP_S
from nml_session import FOUND, Bench, Client, operate, refusals

HERE, THERE = '10.213.7.1', '10.213.7.2'
expect = FOUND.expect

CHANNELS = """B emcCommand SHMEM {host} 8192 0 0 1 16 {key}1 TCP={port} {encoding} queue confirm_write serial
B emcError SHMEM {host} 8192 0 0 3 16 {key}3 TCP={port} {encoding} queue
B emcStatus SHMEM {host} 120000 0 0 2 16 {key}2 TCP={port} {encoding}
P emc emcCommand LOCAL localhost RW 0 1.0 0 0
P emc emcStatus LOCAL localhost W 0 1.0 0 0
P emc emcError LOCAL localhost W 0 1.0 0 0
P emcsvr emcCommand LOCAL localhost W 1 1.0 1 2
P emcsvr emcStatus LOCAL localhost R 1 1.0 1 2
P emcsvr emcError LOCAL localhost R 1 1.0 1 2
P xemc emcCommand REMOTE {host} W 0 10.0 0 10
P xemc emcStatus REMOTE {host} R 0 10.0 0 10
P xemc emcError REMOTE {host} R 0 10.0 0 10
"""


def run(*words):
    return subprocess.run(words, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)


def why_not():
    """The reason why no namespaces can be created; None if they can."""
    for program in ('ip', 'unshare', 'nsenter'):
        if shutil.which(program) is None:
            return f'there is no program {program}'
    tried = run('unshare', '--user', '--map-root-user', '--net', 'sh', '-c',
                'ip link set lo up && ip link add mw0 type veth peer name mw1')
    return None if tried.returncode == 0 else 'network namespaces are not allowed here: ' + tried.stderr.strip()


class Elsewhere:
    """Another computer: a network namespace, and a cable to it."""

    def __init__(self):
        self.keeper = subprocess.Popen(['unshare', '--net', 'sh', '-c', 'echo up; exec cat'], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, text=True)
        self.keeper.stdout.readline()
        for words in (('ip', 'link', 'set', 'lo', 'up'),
                      ('ip', 'link', 'add', 'mw0', 'type', 'veth', 'peer', 'name', 'mw1', 'netns', str(self.keeper.pid)),
                      ('ip', 'addr', 'add', HERE + '/24', 'dev', 'mw0'), ('ip', 'link', 'set', 'mw0', 'up'),
                      self.there('ip', 'link', 'set', 'lo', 'up'), self.there('ip', 'addr', 'add', THERE + '/24', 'dev', 'mw1'),
                      self.there('ip', 'link', 'set', 'mw1', 'up')):
            done = run(*words)
            expect(done.returncode == 0, ' '.join(words), done.stderr)
        assert os.readlink('/proc/self/ns/net') != os.readlink(f'/proc/{self.keeper.pid}/ns/net')

    def there(self, *words):
        """The command that runs a program there."""
        return ('nsenter', '--target', str(self.keeper.pid), '--net', *words)

    def end(self):
        self.keeper.stdin.close()
        self.keeper.wait()


class NetworkBench(Bench):
    def config(self, name, host, encoding, key):
        self.write(name, CHANNELS.format(host=host, port=self.port, encoding=encoding, key=key))
        return str(self.folder / name)

    def stop(self, process):
        process.terminate()
        process.wait(STEP_S)


def can_connect(host, port):
    """Path of this program, for 'connect HOST PORT'."""
    try:
        socket.create_connection((host, port), 2).close()
    except OSError:
        return False
    return True


def refused_ways(bench, elsewhere):
    this = [sys.executable, __file__, 'connect', HERE, str(bench.port)]
    expect(run(*elsewhere.there(*this)).returncode == 1, 'a machine alone listens at no network')
    channels = bench.begin('are up', 'nml', bench.config('home.nml', 'localhost', 'xdr', 300))
    expect(can_connect('127.0.0.1', bench.port), 'localhost is there for this computer')
    expect(run(*elsewhere.there(*this)).returncode == 1, 'and for no other one')
    bench.stop(channels)


def by_library(bench, elsewhere, command_client, encoding, key):
    """Uses a configuration that names a remote host."""
    path = bench.config(f'{encoding}.nml', HERE, encoding, key)
    channels = bench.begin('are up', 'nml', path)
    said = pathlib.Path(bench.folder / f'{len(bench.started) - 1}.out').read_text()
    expect('any computer that reaches ' + HERE in said, 'access from other computers is reported', said)
    done = run(*elsewhere.there(command_client, '--nml', path, '--count', '20'))
    expect(done.returncode == 0 and 'homed true, at X7.5' in done.stdout, f'{encoding}: it operates the machine', done.stdout, done.stderr)
    print(f'{encoding} over the network,', ', '.join(done.stdout.splitlines()[1:]))
    expect(bench.position() == 7.5, 'the machine is where it was sent to', bench.position())
    return channels


def by_socket(bench, elsewhere):
    """A client that was written from docs/reference/nml.md only."""
    done = run(*elsewhere.there(sys.executable, __file__, 'operate', HERE, str(bench.port)))
    expect(done.returncode == 0, 'a client of the documented protocol operates it', done.stdout, done.stderr)


def pulled_cable(bench, elsewhere, machine):
    """Stops in the middle of a move of 2 s."""
    with subprocess.Popen(elsewhere.there(sys.executable, __file__, 'move', HERE, str(bench.port)), stdout=subprocess.PIPE,
                          text=True) as mover:
        expect(mover.stdout.readline() == 'moves\n', 'it moves')
        run('ip', 'link', 'set', 'mw0', 'down')
        deadline = time.monotonic() + STEP_S
        while bench.position() != 27.5 and time.monotonic() < deadline:
            time.sleep(0.05)
        expect(bench.position() == 27.5 and machine.poll() is None, 'the move that was taken is done', bench.position())
        mover.send_signal(signal.SIGKILL)
    run('ip', 'link', 'set', 'mw0', 'up')
    by_socket(bench, elsewhere)


def inside(millwright, halcmd, root, command_client):
    elsewhere = Elsewhere()
    with tempfile.TemporaryDirectory(prefix='mw_net_') as folder:
        bench = NetworkBench(millwright, halcmd, root, pathlib.Path(folder))
        try:
            machine = bench.start_machine()
            refused_ways(bench, elsewhere)
            for number, encoding in enumerate(('xdr', 'ascii', 'disp')):
                channels = by_library(bench, elsewhere, command_client, encoding, 310 + number)
                if encoding != 'disp':
                    bench.stop(channels)
            by_socket(bench, elsewhere)
            pulled_cable(bench, elsewhere, machine)
        finally:
            bench.end_all()
            elsewhere.end()
    return FOUND.status()


def act_there(what, host, port):
    client = Client(port, host)
    if what == 'operate':
        operate(client)
        refusals(client)
    else:
        client.send('EMC_TASK_PLAN_EXECUTE_TYPE', 509, line='"G53 G1 X27.5 F600"')
        while client.status()['trajectory.position_cmd[0]'] == '7.5':
            pass
        print('moves', flush=True)
        time.sleep(STEP_S)
    return FOUND.status()


def main():
    if sys.argv[1] == 'connect':
        return 0 if can_connect(sys.argv[2], int(sys.argv[3])) else 1
    if sys.argv[1] in ('operate', 'move'):
        return act_there(sys.argv[1], sys.argv[2], int(sys.argv[3]))
    if sys.argv[1] == 'inside':
        return inside(*sys.argv[2:6])
    reason = why_not()
    if reason is not None:
        print('skipped:', reason)
        return 77
    return subprocess.run(['unshare', '--user', '--map-root-user', '--net', sys.executable, __file__, 'inside', *sys.argv[1:5]],
                          check=False).returncode


if __name__ == '__main__':
    sys.exit(main())
