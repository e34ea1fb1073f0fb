#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests `millwright ui` with a machine of `millwright start`, as a browser uses it (J3): switch on, home, jog, stop, load, path,
run, abort, messages. If either side is killed, the other side reports it and continues.

usage: web_screen.py MILLWRIGHT HALCMD ROOT
"""
import base64
import http.client
import json
import os
import pathlib
import re
import select
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


def wait_until(condition, seconds=STEP_S):
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(0.02)
    return False


class Screen:
    """The socket of a browser: a WebSocket client, and the status combined from its messages."""

    def __init__(self, port, origin=None):
        self.socket = socket.create_connection(('127.0.0.1', port), STEP_S)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f'GET /api/socket HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: {origin or f"http://127.0.0.1:{port}"}\r\n'
                             f'Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n'
                             f'Sec-WebSocket-Key: {key}\r\n\r\n').encode())
        self.bytes = b''
        while b'\r\n\r\n' not in self.bytes:
            more = self.socket.recv(65536)
            if not more:
                break
            self.bytes += more
        self.head, _, self.bytes = self.bytes.partition(b'\r\n\r\n')
        self.status, self.outcomes, self.messages, self.machine, self.hello = {}, {}, [], None, None
        self.last_id, self.is_open, self.last_ping = 0, b' 101 ' in self.head, time.monotonic()

    def send(self, value):
        text, mask = json.dumps(value).encode(), os.urandom(4)
        size = bytes([0x80 | len(text)]) if len(text) < 126 else b'\xfe' + struct.pack('>H', len(text))
        self.socket.sendall(b'\x81' + size + mask + bytes(c ^ mask[i % 4] for i, c in enumerate(text)))

    def ask(self, message, **fields):
        self.last_id += 1
        self.send({'id': self.last_id, 'command': {'message': message, **fields}, 'sent': time.monotonic() * 1000})
        return self.last_id

    def outcome(self, number):
        """The final state of a command; a text if it has not ended."""
        self.until(lambda: self.outcomes.get(number, {}).get('progress') in ('DONE', 'REFUSED', 'FAILED'))
        return self.outcomes.get(number, {}).get('progress', 'no outcome')

    def do(self, message, **fields):
        return self.outcome(self.ask(message, **fields))

    def until(self, condition, seconds=STEP_S):
        deadline = time.monotonic() + seconds
        while self.is_open and not condition() and time.monotonic() < deadline:
            self.listen(0.05)
        return condition()

    def listen(self, seconds):
        if time.monotonic() - self.last_ping > 1:
            self.last_ping = time.monotonic()
            self.send({'ping': self.last_ping})
        if select.select([self.socket], [], [], seconds)[0]:
            more = self.socket.recv(1 << 20)
            self.is_open = bool(more)
            self.bytes += more
        while (text := self.frame()) is not None:
            self.take(json.loads(text))

    def frame(self):
        if len(self.bytes) < 2:
            return None
        size, start = self.bytes[1] & 127, 2
        if size >= 126:
            width = 2 if size == 126 else 8
            if len(self.bytes) < 2 + width:
                return None
            size, start = int.from_bytes(self.bytes[2:2 + width], 'big'), 2 + width
        if len(self.bytes) < start + size:
            return None
        text, self.bytes = self.bytes[start:start + size], self.bytes[start + size:]
        return text

    def take(self, told):
        if 'status' in told:
            self.status = told['status'] if told.get('full') else merged(self.status, told['status'])
        elif 'outcome' in told:
            self.outcomes[told['outcome']['id']] = told['outcome']
        elif 'message' in told:
            self.messages.append(told['message'])
        elif 'machine' in told:
            self.machine = told['machine']
        elif 'hello' in told:
            self.hello = told['hello']

    def joint(self, index=0):
        return self.status['joints'][index]

    def cut(self):
        """Disconnects without a message, as when a cable is pulled or the page is killed."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        self.socket.close()
        self.is_open = False


def merged(old, new):
    for key, value in new.items():
        place = int(key) if isinstance(old, list) else key
        old[place] = merged(old[place], value) if isinstance(value, dict) else value
    return old


class Bench(Mill):
    def __init__(self, millwright, halcmd, root, folder):
        super().__init__(millwright, halcmd, root, folder, 'web')
        programs = folder / 'programs'
        programs.mkdir()
        text = self.ini.read_text()
        changed = text.replace('PROGRAM_PREFIX = ../../nc_files', f'PROGRAM_PREFIX = {programs}')
        assert changed != text
        self.ini.write_text(changed)
        self.programs, self.files, self.started = programs, [], []

    def begin(self, *words):
        path = self.folder / f'{len(self.files)}.out'
        self.files.append(path)
        with path.open('w', encoding='utf-8') as file:
            process = subprocess.Popen([self.millwright, *words], env=self.env, stdin=subprocess.DEVNULL, stdout=file,
                                       stderr=subprocess.STDOUT)
        self.started.append(process)
        return process, path

    def machine(self):
        process, path = self.begin('start', str(self.ini), '--no-display')
        expect(wait_until(lambda: 'is running: instance' in path.read_text() or process.poll() is not None) and process.poll() is None,
               'the machine comes up', path.read_text())
        return process

    def server(self, *words):
        process, path = self.begin('ui', str(self.ini), '--port', '0', *words)
        expect(wait_until(lambda: 'http://' in path.read_text() or process.poll() is not None), 'the server comes up', path.read_text())
        return process, int(re.search(r'http://127\.0\.0\.1:(\d+)/', path.read_text()).group(1))

    def remote_port(self):
        """Starts a server with --listen and returns its data."""
        expect(wait_until(lambda: 'for other computers' in self.files[-1].read_text()), 'other computers have a way in')
        return int(re.search(r'for other computers.*https://127\.0\.0\.1:(\d+)/', self.files[-1].read_text()).group(1))

    def end_all(self):
        for process in self.started:
            if process.poll() is None:
                process.terminate()
        for process in self.started:
            try:
                process.wait(STEP_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def http_ask(port, method, path, body=None, headers=None):
    connection = http.client.HTTPConnection('127.0.0.1', port, timeout=STEP_S)
    connection.request(method, path, body, headers or {})
    answer = connection.getresponse()
    return answer.status, answer.read()


def before_the_machine(port):
    screen = Screen(port)
    expect(screen.until(lambda: screen.machine == 'gone'), 'a screen without a machine gets a message')
    expect(screen.do('SetState', state='ON') == 'REFUSED', 'and its commands are rejected')
    return screen


def switch_on_and_home(screen):
    expect(screen.until(lambda: screen.machine == 'up' and 'task' in screen.status), 'the start of the machine is reported')
    expect(screen.status['task']['state'] == 'ESTOP', 'it is in e-stop')
    expect(screen.do('SetState', state='ESTOP_RESET') == 'DONE', 'e-stop reset')
    expect(screen.do('SetState', state='ON') == 'DONE', 'on')
    expect(screen.until(lambda: screen.status['task']['state'] == 'ON'), 'and the status shows it')
    expect(screen.do('HomeJoint', joint=-1) == 'DONE', 'homing ends', screen.outcomes, screen.messages)
    expect(screen.until(lambda: screen.status['trajectory']['all_homed']), 'all are homed')


def jog(screen, velocity, has_lease):
    """Without leases, only a jog that ends by itself is accepted."""
    if has_lease:
        return screen.ask('JogContinuous', is_joint=True, index=0, velocity=velocity, lease_ms=5000)
    return screen.ask('JogIncrement', is_joint=True, index=0, velocity=abs(velocity), distance=20 * velocity)


def jog_and_cut(port, screen, has_lease):
    expect(screen.do('SetMode', mode='MANUAL') == 'DONE' and screen.do('SetTeleop', teleop=False) == 'DONE', 'joint mode')
    begin = screen.joint()['pos_cmd']
    endless = screen.ask('JogContinuous', is_joint=True, index=0, velocity=10.0)
    expect(screen.outcome(endless) == 'REFUSED' and 'lease' in screen.outcomes[endless].get('reason', ''),
           'a jog without a lease is rejected', screen.outcomes.get(endless))
    screen.until(lambda: False, 0.2)
    expect(screen.joint()['pos_cmd'] == begin, 'and nothing moves')
    number = jog(screen, 10.0, has_lease)
    expect(screen.until(lambda: screen.joint()['pos_cmd'] > begin + 0.5), 'a jog moves', screen.outcomes.get(number))
    expect(screen.do('JogStop', is_joint=True, index=0) == 'DONE', 'a stop stops')
    expect(screen.until(lambda: screen.joint()['vel_cmd'] == 0), 'and it is stopped')
    expect(screen.joint()['pos_cmd'] < begin + 190, 'where it was stopped', screen.joint())

    other = Screen(port)
    other.until(lambda: 'joints' in other.status)
    begin = other.joint()['pos_cmd']
    jog(other, -10.0, has_lease)
    expect(other.until(lambda: other.joint()['pos_cmd'] < begin - 0.5), 'another screen jogs')
    expect(screen.until(lambda: screen.joint()['vel_cmd'] != 0), 'as the first one sees')
    other.cut()
    expect(screen.until(lambda: screen.joint()['vel_cmd'] == 0, 2), 'a jog ends with its connection', screen.joint())
    where = screen.joint()['pos_cmd']
    screen.until(lambda: False, 0.3)
    expect(screen.joint()['pos_cmd'] == where, 'and stays where it is')


def programs(port, screen, bench):
    text = b'G21 G90 G61 F600\nG1 X5\nG2 X15 I5\nM2\n'
    for at in range(0, len(text), 16):
        status, body = http_ask(port, 'PUT', f'/api/files/part.ngc?offset={at}&size={len(text)}', text[at:at + 16])
        expect(status == 200, 'a piece is taken', body)
    expect((bench.programs / 'part.ngc').read_bytes() == text, 'the program lies in the folder')
    status, body = http_ask(port, 'GET', '/api/files')
    expect(status == 200 and [f['name'] for f in json.loads(body)['files']] == ['part.ngc'], 'and is listed', body)
    status, body = http_ask(port, 'GET', '/api/path?file=part.ngc')
    kinds, at, counts = [], 0, None
    while at < len(body):
        kind, size = struct.unpack_from('<II', body, at)
        kinds.append(kind)
        counts = struct.unpack_from('<II', body, at + 8) if kind == 3 else counts
        at += 8 + size
    expect(status == 200 and kinds == [5, 1, 2, 3] and counts[1] > 10, 'its path is reported', kinds, counts)

    expect(screen.do('SetMode', mode='AUTO') == 'DONE', 'auto')
    expect(screen.do('OpenProgram', path=str(bench.programs / 'part.ngc')) == 'DONE', 'opens', screen.outcomes)
    run = screen.ask('RunProgram')
    expect(screen.until(lambda: screen.outcomes.get(run, {}).get('progress') == 'STARTED', 5), 'a run is reported as started')
    expect(screen.until(lambda: screen.status['task']['motion_line'] >= 2), 'the line is reported')
    expect(screen.outcome(run) == 'DONE', 'and its end', screen.outcomes.get(run))
    expect(screen.until(lambda: abs(screen.joint()['pos_cmd'] - 15) < 1e-6, 2), 'at its place', screen.joint()['pos_cmd'])
    run = screen.ask('RunProgram')
    screen.until(lambda: screen.joint()['vel_cmd'] != 0)
    expect(screen.do('AbortAll') == 'DONE', 'abort')
    expect(screen.until(lambda: screen.joint()['vel_cmd'] == 0), 'stopped')
    expect(screen.do('SetMode', mode='MDI') == 'DONE' and screen.do('Mdi', line='G0 X') in ('FAILED', 'REFUSED'), 'a bad line fails')
    expect(screen.until(lambda: screen.messages), 'with a message')


def end_while_jogging(bench, server, port, has_lease):
    """A server that ends normally also ends the jogs of its screens."""
    screen = Screen(port)
    expect(screen.until(lambda: 'joints' in screen.status) and screen.do('SetMode', mode='MANUAL') == 'DONE' and
           screen.do('SetTeleop', teleop=False) == 'DONE', 'joint mode again')
    begin = screen.joint()['pos_cmd']
    jog(screen, -10.0, has_lease)
    expect(screen.until(lambda: screen.joint()['pos_cmd'] < begin - 0.5), 'jogs again')
    server.terminate()
    expect(server.wait(STEP_S) == 0, 'the server ends in order')
    server, port = bench.server()
    screen = Screen(port)
    expect(screen.until(lambda: 'joints' in screen.status and screen.joint()['vel_cmd'] == 0, 3), 'its jog has ended', screen.status.get('joints'))
    expect(screen.joint()['pos_cmd'] > begin - 150, 'during the move', screen.joint())
    return screen, server, port


def who_is_killed(bench, screen, server, port):
    """The server is killed; the machine continues."""
    begin = screen.joint()['pos_cmd']
    screen.do('SetMode', mode='MANUAL')
    server.kill()
    server.wait()
    expect(screen.until(lambda: not screen.is_open, 5), 'a screen sees that the server is gone')
    server, port = bench.server()
    again = Screen(port)
    expect(again.until(lambda: 'joints' in again.status) and again.status['task']['state'] == 'ON',
           'the machine continues without the server')
    expect(abs(again.joint()['pos_cmd'] - begin) < 50, 'where it was')
    return again, server, port


def strangers(port):
    status, _ = http_ask(port, 'GET', '/api/machine', headers={'Host': 'evil.example'})
    expect(status == 403, 'another name is rejected')
    status, _ = http_ask(port, 'GET', '/api/machine', headers={'Origin': 'http://evil.example'})
    expect(status == 403, 'another page is rejected')
    expect(not Screen(port, 'http://evil.example').is_open, 'its socket too')
    status, body = http_ask(port, 'GET', '/api/machine')
    facts = json.loads(body)
    expect(status == 200 and facts['axes'] == 'XYZ' and facts['joints'] == 3, 'the machine is reported', body)
    status, body = http_ask(port, 'GET', '/metrics')
    expect(status == 200 and b'millwright_machine_up 1' in body, 'and figures', body)


def check(bench):
    server, port = bench.server()
    screen = before_the_machine(port)
    machine = bench.machine()
    switch_on_and_home(screen)
    schema = json.loads(http_ask(port, 'GET', '/api/schema')[1])
    command = next(c for c in schema['commands'] if c['name'] == 'JogContinuous')
    has_lease = any(f['name'] == 'lease_ms' for f in command['fields'])
    jog_and_cut(port, screen, has_lease)
    programs(port, screen, bench)
    strangers(port)
    screen, server, port = who_is_killed(bench, screen, server, port)
    screen, server, port = end_while_jogging(bench, server, port, has_lease)
    machine.terminate()
    expect(screen.until(lambda: screen.machine == 'gone', 5), 'a screen gets a message that the machine has ended')
    second = bench.machine()
    expect(screen.until(lambda: screen.machine == 'up'), 'and that it is back')
    expect(screen.until(lambda: screen.status.get('task', {}).get('state') == 'ESTOP'), 'in e-stop')
    server.send_signal(signal.SIGTERM)
    expect(server.wait(STEP_S) == 0 and second.poll() is None, 'the server ends in order, the machine stays')
    second.terminate()
    expect(second.wait(STEP_S) == 0, 'the machine ends in order')
    as_its_display(bench)


def as_its_display(bench):
    text = bench.ini.read_text()
    bench.ini.write_text(text.replace('DISPLAY = millwright', 'DISPLAY = millwright --port 0'))
    process, path = bench.begin('start', str(bench.ini))
    expect(wait_until(lambda: 'http://' in path.read_text() or process.poll() is not None), 'DISPLAY = millwright starts it', path.read_text())
    screen = Screen(int(re.search(r'http://127\.0\.0\.1:(\d+)/', path.read_text()).group(1)))
    expect(screen.until(lambda: 'task' in screen.status), 'and it shows the machine')
    process.terminate()
    expect(process.wait(STEP_S) == 0, 'both end together')
    expect(screen.until(lambda: not screen.is_open, 5), 'and the screen sees it')


def main():
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(sys.argv[1], sys.argv[2], sys.argv[3], pathlib.Path(folder))
        try:
            check(bench)
        finally:
            bench.end_all()
        for path in bench.files if FOUND.failures else ():
            print(f'--- {path.name}\n{path.read_text()}')
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
