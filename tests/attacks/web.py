#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Clients of `millwright ui` that never read, disconnect, request endless work, or belong to another user.

usage: web.py BIN_FOLDER ROOT
"""
import json
import os
import pathlib
import re
import resource
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from rig import END_S, Machine  # noqa: E402  pylint: disable=wrong-import-position

NOBODY = 65534
MIB = 1 << 20
LARGE = 240 * MIB
FOUND = Findings()
expect = FOUND.expect


class Screen:
    """A server of screens, without a machine."""

    def __init__(self, machine):
        self.machine = machine
        self.process = subprocess.Popen([machine.programs / 'millwright', 'ui', machine.ini, '--port', '0'], env=machine.env, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, text=True)
        self.port = int(re.search(r'127\.0\.0\.1:(\d+)', self.process.stdout.readline()).group(1))

    def connect(self):
        return socket.create_connection(('127.0.0.1', self.port), timeout=20)

    def send(self, target, more='', method='GET', body=''):
        """A connection that has sent a request."""
        peer = self.connect()
        peer.sendall(f'{method} {target} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nContent-Length: {len(body)}\r\n{more}Connection: close\r\n\r\n{body}'.encode())
        return peer

    def ask(self, target, more='', method='GET', body=''):
        """(status, body)"""
        with self.send(target, more, method, body) as peer:
            answer = b''.join(iter(lambda: peer.recv(MIB), b''))
        head, _, rest = answer.partition(b'\r\n\r\n')
        return int(head.split(b' ')[1]) if head else 0, rest

    def first_line(self, peer):
        peer.settimeout(20)
        return peer.recv(64).split(b'\r')[0].decode()

    def memory(self):
        status = pathlib.Path(f'/proc/{self.process.pid}/status').read_text()
        return int(re.search(r'VmRSS:\s+(\d+)', status).group(1)) * 1024

    def cpu_s(self):
        fields = pathlib.Path(f'/proc/{self.process.pid}/stat').read_text().rsplit(')', 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')

    def end_s(self):
        begin = time.monotonic()
        self.process.terminate()
        try:
            self.process.wait(END_S + 8)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return float('inf')
        return time.monotonic() - begin

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()


def never_read(screen, programs):
    """Row 5."""
    score = int(pathlib.Path(f'/proc/{screen.process.pid}/oom_score_adj').read_text())
    expect(score == 500, f'the kernel ends the server before the machine when memory is gone: oom_score_adj {score}')
    with (programs / 'large.ngc').open('wb') as file:
        file.truncate(LARGE)
    before = screen.memory()
    silent = [screen.send('/api/files/large.ngc') for _ in range(14)]
    time.sleep(3)
    grown = screen.memory() - before
    expect(grown < 64 * MIB, f'14 clients that never read a program of {LARGE // MIB} MiB: {grown // MIB} MiB more')
    for peer in silent:
        peer.close()
    status, body = screen.ask('/api/files/large.ngc')
    expect(status == 200 and len(body) == LARGE, f'the program comes whole to a client that reads: {status}, {len(body)} bytes')


def two_hosts(screen):
    """Row 24."""
    status, _ = screen.ask('/api/machine', f'Host: 127.0.0.1:{screen.port}\r\n')
    expect(status == 400, f'two headers Host: {status}')


def endless_work(screen, programs):
    """Rows 14 and 23."""
    (programs / 'slip.ngc').write_text('G21 G90 F100\nG1 X1000000000000000\nM2\n')
    (programs / 'slow.ngc').write_text('G21 G90 F1000\no1 repeat [100000]\nG1 X1 Y0.3\nG1 X0 Y0\no1 endrepeat\nM2\n')
    attacks = ['/api/times?file=slow.ngc&feed=0.001'] * 4
    peers = [screen.send(target) for target in attacks]
    time.sleep(1)
    for peer in peers:
        peer.close()
    time.sleep(1)
    before = screen.cpu_s()
    time.sleep(2)
    used = screen.cpu_s() - before
    expect(used < 0.5, f'2 s after the clients have hung up the server uses {used:.2f} s of processor time')
    begin = time.monotonic()
    status, body = screen.ask('/api/times?file=slip.ngc')
    expect(status != 429, 'clients that have hung up leave no work behind')
    expect(status == 200 and time.monotonic() - begin < 10, f'the slip alone ends: {status} after {time.monotonic() - begin:.1f} s', body[-200:])
    peers = [screen.send(target) for target in attacks]
    time.sleep(1)
    took = screen.end_s()
    expect(took < END_S, f'SIGTERM ends the server in {took:.2f} s while it computes')
    for peer in peers:
        peer.close()


def uploads(machine, programs):
    """Row 17."""
    screen = Screen(machine)
    status, _ = screen.ask('/api/files/part.ngc?offset=0&size=100', method='PUT', body='G0 X1\n')
    expect(status == 200 and list(programs.glob('.part.ngc.*')), f'an upload begins: {status}')
    screen.kill()
    screen = Screen(machine)
    screen.ask('/api/machine')
    left = [path.name for path in programs.glob('.part.ngc.*')]
    expect(not left, f'nothing is left of an upload after the next start: {left}')
    return screen


def few_descriptors(screen):
    """Row 15."""
    used = len(os.listdir(f'/proc/{screen.process.pid}/fd'))
    old = resource.prlimit(screen.process.pid, resource.RLIMIT_NOFILE)
    resource.prlimit(screen.process.pid, resource.RLIMIT_NOFILE, (used + 40, old[1]))
    peers = [screen.send('/api/files/large.ngc') for _ in range(24)]
    lines = [screen.first_line(peer) for peer in peers]
    expect(any(' 503 ' in line for line in lines), f'files leave a reserve: {sorted(set(lines))}')
    begin = time.monotonic()
    status, _ = screen.ask('/api/machine')
    expect(status == 200 and time.monotonic() - begin < 2, f'a new screen finds a connection: {status} after {time.monotonic() - begin:.1f} s')
    for peer in peers:
        peer.close()
    resource.prlimit(screen.process.pid, resource.RLIMIT_NOFILE, old)


def foreign(screen, token):
    """Another user reaches only the permitted parts."""
    plain = {f'{method} {target}': screen.ask(target, '', method, body)[0] for method, target, body in (
        ('GET', '/api/machine', ''), ('GET', '/api/files', ''), ('GET', '/api/files/large.ngc', ''), ('GET', '/api/path?file=slip.ngc', ''),
        ('PUT', '/api/files/evil.ngc', 'M2'), ('DELETE', '/api/files/slip.ngc', ''), ('GET', '/api/hal?glob=*', ''),
        ('PUT', '/api/hal/x', '{"value": "1"}'))}
    wrong, _ = screen.ask('/api/login', method='POST', body=json.dumps({'token': 'x' * 64}))
    with screen.send('/api/login', method='POST', body=json.dumps({'token': token})) as peer:
        answer = peer.makefile('rb').read().decode()
    cookie = re.search(r'^Set-Cookie: ([^;]*)', answer, re.MULTILINE)
    kept = cookie.group(1) if cookie else 'none=none'
    return {'plain': plain, 'wrong': wrong, 'bearer': screen.ask('/api/files', f'Authorization: Bearer {token}\r\n')[0],
            'cookie': screen.ask('/api/files', f'Cookie: {kept}\r\n')[0], 'is_token_in_cookie': token in kept}


def as_nobody(call):
    """The result of `call` in a process of another user."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.setgroups([])
            os.setgid(NOBODY)
            os.setuid(NOBODY)
            os.write(writer, json.dumps(call()).encode())
        finally:
            os._exit(0)
    os.close(writer)
    with open(reader, encoding='utf-8') as answer:
        text = answer.read()
    os.waitpid(child, 0)
    return json.loads(text or '{}')


def other_user(screen, machine):
    """Row 21."""
    expect(screen.ask('/api/files')[0] == 200, 'the user of the server needs no token')
    if os.geteuid() != 0:
        return
    tokens = machine.folder / '.config/millwright/screen/tokens'
    found = re.search(r'^operate (\S+)', tokens.read_text() if tokens.exists() else '', re.MULTILINE)
    token = found.group(1) if found else 'none'
    answers = as_nobody(lambda: foreign(screen, token))
    plain = answers.get('plain', {})
    expect(plain.pop('GET /api/machine', 0) == 200, f'another user sees status: {answers}')
    expect(set(plain.values()) == {403}, f'and nothing more: {plain}')
    expect(answers.get('wrong') == 403, f'a wrong token is rejected: {answers}')
    expect(answers.get('bearer') == 200 and answers.get('cookie') == 200, f'a token opens what its role may: {answers}')
    expect(answers.get('is_token_in_cookie') is False, 'the cookie is not the token')


def main():
    machine = Machine(sys.argv[1], sys.argv[2], 'web',
                      lambda ini: re.sub(r'^PROGRAM_PREFIX *=.*$', 'PROGRAM_PREFIX = ../../programs', ini, flags=re.MULTILINE))
    os.environ.pop('XDG_CONFIG_HOME', None)
    machine.env.pop('XDG_CONFIG_HOME', None)
    programs = machine.folder / 'programs'
    programs.mkdir()
    screen = None
    try:
        screen = Screen(machine)
        two_hosts(screen)
        never_read(screen, programs)
        endless_work(screen, programs)
        screen = uploads(machine, programs)
        other_user(screen, machine)
        few_descriptors(screen)
        took = screen.end_s()
        expect(took < END_S and screen.process.returncode == 0, f'SIGTERM ends the server in {took:.2f} s: {screen.process.returncode}')
    finally:
        if screen is not None and screen.process.poll() is None:
            screen.kill()
        machine.clean()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
