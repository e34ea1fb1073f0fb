#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests `millwright nml` with a machine of `millwright start` from across a network (F9): a client written only from
docs/reference/nml.md switches on, homes and moves; invalid messages do not affect other clients; if one process is killed, the
others continue.

usage: nml_session.py MILLWRIGHT HALCMD ROOT
"""
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

from mill_by_hand import STEP_S, Findings, Mill

FOUND = Findings()
expect = FOUND.expect
WRITE, READ, PEEK = 2, 3, 4
DONE, NOTHING, REFUSED = 1, 2, 3
COMMAND, STATUS, ERRORS = 1, 2, 3

CHANNELS = """B emcCommand SHMEM localhost 8192 0 0 1 16 {key}1 TCP={port} disp queue confirm_write serial
B emcError SHMEM localhost 8192 0 0 3 16 {key}3 TCP={port} disp queue
B emcStatus SHMEM localhost 120000 0 0 2 16 {key}2 TCP={port} disp
P emc emcCommand LOCAL localhost RW 0 1.0 0 0
P emc emcStatus LOCAL localhost W 0 1.0 0 0
P emc emcError LOCAL localhost W 0 1.0 0 0
P emcsvr emcCommand LOCAL localhost W 1 1.0 1 2
P emcsvr emcStatus LOCAL localhost R 1 1.0 1 2
P emcsvr emcError LOCAL localhost R 1 1.0 1 2
"""


class Client:
    """Speaks the protocol of docs/reference/nml.md."""

    def __init__(self, port, host='127.0.0.1'):
        self.socket = socket.create_connection((host, port), STEP_S)
        self.requests = 0

    def receive(self, size):
        data = b''
        while len(data) < size:
            more = self.socket.recv(size - len(data))
            if not more:
                raise ConnectionError('closed')
            data += more
        return data

    def ask(self, operation, buffer, data=b'', number=0, time_ms=1000):
        self.requests += 1
        self.socket.sendall(struct.pack('>3sBBBHIIQiI', b'MWN', 1, operation, 0, 0, buffer, self.requests, number, time_ms,
                                        len(data)) + data)
        _, _, _, status, _, _, request, number, _, size = struct.unpack('>3sBBBHIIQiI', self.receive(32))
        return status, number, self.receive(size).decode(), request == self.requests

    def send(self, name, number, **fields):
        """Sends a command and returns its serial number."""
        lines = [f'{name} {number}', 'serial_number=0'] + [f'{key}={value}' for key, value in fields.items()]
        status, serial, text, isMine = self.ask(WRITE, COMMAND, ('\n'.join(lines) + '\n').encode())
        expect(status == DONE and isMine, f'{name} is taken', text)
        return serial

    def status(self):
        status, _, text, _ = self.ask(PEEK, STATUS)
        lines = text.splitlines()
        expect(status == DONE and lines[0] == 'EMC_STAT_TYPE 1999', 'the status is there', text[:200])
        return dict(line.split('=', 1) for line in lines[1:])

    def do(self, name, number, **fields):
        """The final state of the command."""
        serial = str(self.send(name, number, **fields))
        deadline = time.monotonic() + STEP_S
        while time.monotonic() < deadline:
            status = self.status()
            if status['echo_serial_number'] == serial and status['state'] != 'EXECUTING':
                return status['state'], status['reason']
        return 'NEVER', ''


class Bench(Mill):
    def __init__(self, millwright, halcmd, root, folder):
        super().__init__(millwright, halcmd, root, folder, 'nml')
        with socket.socket() as free:
            free.bind(('127.0.0.1', 0))
            self.port = free.getsockname()[1]
        self.write('m.nml', CHANNELS.format(port=self.port, key=100))
        self.started = []

    def begin(self, what, *words):
        """Waits until the machine reports that it is running."""
        path = self.folder / f'{len(self.started)}.out'
        with path.open('w', encoding='utf-8') as file:
            process = subprocess.Popen([self.millwright, *words], env=self.env, stdin=subprocess.DEVNULL, stdout=file,
                                       stderr=subprocess.STDOUT)
        self.started.append(process)
        deadline = time.monotonic() + STEP_S
        while what not in path.read_text() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        expect(what in path.read_text(), f'{words[0]} says "{what}"', path.read_text())
        return process

    def start_machine(self):
        """Returns the process when the machine has started."""
        return self.begin('is running: instance', 'start', str(self.ini), '--no-display')

    def end_all(self):
        for process in reversed(self.started):
            if process.poll() is None:
                process.terminate()
            try:
                process.wait(STEP_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def operate(client):
    expect(client.do('EMC_TASK_SET_STATE_TYPE', 505, state='ESTOP_RESET') == ('DONE', '""'), 'e-stop reset')
    expect(client.do('EMC_TASK_SET_STATE_TYPE', 505, state='ON') == ('DONE', '""'), 'on')
    expect(client.do('EMC_TASK_SET_MODE_TYPE', 504, mode='MANUAL') == ('DONE', '""'), 'manual')
    if client.status()['trajectory.all_homed'] != '1':
        expect(client.do('EMC_JOINT_HOME_TYPE', 123, joint=-1) == ('DONE', '""'), 'homing ends')
    expect(client.status()['trajectory.all_homed'] == '1', 'all are homed')
    expect(client.do('EMC_TASK_SET_MODE_TYPE', 504, mode='MDI') == ('DONE', '""'), 'MDI')
    expect(client.do('EMC_TASK_PLAN_EXECUTE_TYPE', 509, line='"G53 G0 X7.5"') == ('DONE', '""'), 'a line is done')
    expect(client.status()['trajectory.position_cmd[0]'] == '7.5', 'the machine is where it was sent to')


def refusals(client):
    state, reason = client.do('EMC_JOG_STOP_TYPE', 136, is_joint=1, index=99)
    expect(state == 'ERROR' and 'index is 99' in reason, 'a value out of range is rejected with its reason', reason)
    status, _, text, _ = client.ask(READ, ERRORS)
    expect(status == DONE and 'index is 99' in text, 'and the operator gets a message', text)
    status, _, text, _ = client.ask(WRITE, COMMAND, b'EMC_NO_SUCH_TYPE 4711\n')
    expect(status == REFUSED and '4711' in text, 'bytes that are not a message are rejected', text)
    status, _, text, _ = client.ask(PEEK, COMMAND)
    expect(status == REFUSED and 'may not read' in text, 'emcsvr may only write commands', text)


def deaths(bench, client, channels, machine):
    with socket.create_connection(('127.0.0.1', bench.port), STEP_S) as other:
        other.sendall(b'GET / HTTP/1.1\r\nHost: x\r\n\r\n' * 4)
    expect(client.do('EMC_NULL_TYPE', 21) == ('DONE', '""'), 'invalid data of one client do not affect others')
    os.kill(channels.pid, signal.SIGKILL)
    channels.wait()
    expect(machine.poll() is None and bench.position() == 7.5, 'the machine continues without its channels')
    again = bench.begin('are up', 'nml', str(bench.folder / 'm.nml'))
    second = Client(bench.port)
    expect(second.do('EMC_TASK_PLAN_EXECUTE_TYPE', 509, line='"G53 G0 X1"') == ('DONE', '""'), 'and takes new ones')
    machine.terminate()
    machine.wait(STEP_S)
    expect(again.wait(STEP_S) == 1, 'the channels end with the machine')


def main():
    millwright, halcmd, root = sys.argv[1:4]
    with tempfile.TemporaryDirectory(prefix='mw_nml_') as folder:
        bench = Bench(millwright, halcmd, root, pathlib.Path(folder))
        try:
            machine = bench.start_machine()
            channels = bench.begin('are up', 'nml', str(bench.folder / 'm.nml'))
            client = Client(bench.port)
            operate(client)
            refusals(client)
            deaths(bench, client, channels, machine)
        finally:
            bench.end_all()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
