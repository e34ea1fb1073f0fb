#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Load on the server of the operator's screen (J3): five screens, a long upload, and unknown clients at the port for other
computers. Measures how long a change takes to reach every screen, the server's share of a core, and a jog during an upload: it
must not stop, and its renewals must not be delayed.

usage: screen_load.py MILLWRIGHT HALCMD ROOT [SECONDS] [UPLOAD_MB]
The figures depend on the computer and its other load. The test fails only if a jog stops.
"""
import multiprocessing
import os
import pathlib
import socket
import ssl
import statistics
import sys
import tempfile
import threading
import time

from web_screen import FOUND, Bench, Screen, expect, http_ask, switch_on_and_home

SCREENS, RENEWAL_S, LEASE_MS, SPEED = 5, 0.03, 100, 3.0
PIECE = 1 << 20


class Listener(threading.Thread):
    """A screen that logs when it receives a value."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.screen, self.seen, self.is_over = Screen(port), {}, False
        self.start()

    def run(self):
        while not self.is_over and self.screen.is_open:
            self.screen.listen(0.05)
            feed = self.screen.status.get('overrides', {}).get('feed')
            if feed is not None and feed not in self.seen:
                self.seen[feed] = time.monotonic()


def cpu_s(pid):
    words = pathlib.Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf('SC_CLK_TCK')


def latency(port, server, program, seconds):
    """Time from the command that changes the status to the arrival of the status, which is more than the delay of the status alone."""
    listeners = [Listener(port) for _ in range(SCREENS)]
    asker = Screen(port)
    expect(asker.until(lambda: 'overrides' in asker.status), 'the sixth receives the status')
    expect(asker.do('SetMode', mode='AUTO') == 'DONE' and asker.do('OpenProgram', path=str(program)) == 'DONE', 'a program is open')
    asker.ask('RunProgram')
    used, begin, took = cpu_s(server.pid), time.monotonic(), []
    number = 0
    while time.monotonic() - begin < seconds:
        number += 1
        feed = 0.5 + number / 1000
        sent = time.monotonic()
        expect(asker.do('SetFeedOverride', factor=feed) == 'DONE', 'an override is set')
        asker.until(lambda: all(feed in one.seen for one in listeners), 2)
        took += [one.seen[feed] - sent for one in listeners if feed in one.seen]
        asker.until(lambda: False, 0.05 + (number % 7) / 100)  # spread over the period of 20 Hz
    share = (cpu_s(server.pid) - used) / (time.monotonic() - begin)
    expect(asker.status['task']['interp_state'] != 'IDLE', 'the program runs')
    asker.do('AbortAll')
    for one in listeners:
        one.is_over = True
    expect(len(took) > SCREENS, 'changes arrive')
    took.sort()
    print(f'{SCREENS} screens at 20 Hz, a program runs: a change reaches them after {1000 * statistics.median(took):.0f} ms in the median, '
          f'{1000 * took[int(0.95 * len(took))]:.0f} ms for 95 of 100 ({len(took)} times); the server has {100 * share:.1f} % of a core')


class Jog(threading.Thread):
    """A pressed button: renewals every 30 ms, and the delay of each."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.screen, self.waits, self.refused, self.stops, self.is_over = Screen(port), [], [], 0, False

    def run(self):
        screen = self.screen
        screen.until(lambda: 'joints' in screen.status)
        screen.do('SetMode', mode='MANUAL')
        screen.do('SetTeleop', teleop=False)
        words = {'is_joint': True, 'index': 0, 'velocity': SPEED, 'lease_ms': LEASE_MS}
        screen.do('JogContinuous', **words)
        begun, due, sent = time.monotonic(), time.monotonic(), {}
        while not self.is_over:
            due += RENEWAL_S
            sent[screen.ask('JogContinuous', **words, is_renewal=True)] = time.monotonic()
            while (left := due - time.monotonic()) > 0:
                screen.listen(left)
                self.take(sent)
            is_up_to_speed = time.monotonic() - begun > 0.5
            self.stops += is_up_to_speed and abs(screen.joint()['vel_cmd']) < 0.5 * SPEED
        screen.do('JogStop', is_joint=True, index=0)

    def take(self, sent):
        for number in [one for one in sent if self.screen.outcomes.get(one, {}).get('progress') in ('DONE', 'REFUSED', 'FAILED')]:
            outcome = self.screen.outcomes.pop(number)
            self.waits.append(time.monotonic() - sent.pop(number))
            if outcome['progress'] != 'DONE':
                self.refused.append(outcome)


def figures(waits):
    waits = sorted(waits)
    return f'median {1000 * statistics.median(waits):.1f} ms, 99 of 100 {1000 * waits[int(0.99 * len(waits))]:.1f} ms, longest {1000 * waits[-1]:.1f} ms'


def jog_during(port, act):
    jog = Jog(port)
    jog.start()
    time.sleep(1)
    begin = time.monotonic()
    act()
    took = time.monotonic() - begin
    jog.is_over = True
    jog.join()
    return jog, took


def upload(port, megabytes):
    line = b'G1 X10.1234 Y20.5678 F1000 (as long as lines of programs are, more or less)\n'
    piece = (line * (PIECE // len(line) + 1))[:PIECE]
    size = megabytes * PIECE
    for at in range(0, size, PIECE):
        status, answer = http_ask(port, 'PUT', f'/api/files/large.ngc?offset={at}&size={size}', piece)
        if status != 200:
            expect(False, 'a piece is taken', status, answer)
            return
    status, _ = http_ask(port, 'DELETE', '/api/files/large.ngc')
    expect(status == 200, 'the upload is a program')


class Strangers:
    """Unknown clients at the port for other computers, in a separate process: as many as get a slot stay silent, others send no
    TLS greeting, the rest repeat the greeting and have no token."""

    SILENT, GARBAGE = 60, b'GET / HTTP/1.1\r\n\r\n' + bytes(range(256)) * 8

    def __init__(self, port, seconds):
        self.port, self.end, self.greetings = port, time.monotonic() + seconds, 0

    def connect(self):
        return socket.create_connection(('127.0.0.1', self.port), 2)

    def keep_silent(self):
        held = [self.connect() for _ in range(self.SILENT)]
        time.sleep(max(0.0, self.end - time.monotonic()))
        for one in held:
            one.close()

    def each(self, act):
        while time.monotonic() < self.end:
            try:
                with self.connect() as one:
                    act(one)
            except OSError:
                time.sleep(0.002)  # rejected

    def babble(self, one):
        one.sendall(self.GARBAGE)
        time.sleep(0.02)

    def greet(self, one):
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        with context.wrap_socket(one):
            self.greetings += 1

    def run(self, told):
        os.nice(5)
        acts = [lambda: self.each(self.babble), lambda: self.each(self.greet), lambda: self.each(self.greet)]
        threads = [threading.Thread(target=act) for act in acts]
        for one in threads:
            one.start()
        time.sleep(max(0.0, (self.end - time.monotonic()) / 2))
        self.keep_silent()
        for one in threads:
            one.join()
        told.send(self.greetings)


def strangers_come(port, seconds):
    """The number of times that one of them completed a TLS greeting."""
    mine, theirs = multiprocessing.Pipe()
    process = multiprocessing.Process(target=Strangers(port, seconds).run, args=(theirs,), daemon=True)
    process.start()
    greetings = mine.recv() if mine.poll(seconds + 30) else 0
    process.join()
    return greetings


def memory_mb(pid):
    return int(pathlib.Path(f'/proc/{pid}/smaps_rollup').read_text().split('Pss:')[1].split()[0]) / 1024


def among_strangers(port, remote_port, server, seconds):
    before, used, greetings = memory_mb(server.pid), cpu_s(server.pid), []
    jog, took = jog_during(port, lambda: greetings.append(strangers_come(remote_port, seconds)))
    share = (cpu_s(server.pid) - used) / took
    print(f'renewals among strangers, {greetings[0]} of them greeted in {took:.1f} s: {figures(jog.waits)}; {jog.stops} samples of a stopped joint; '
          f'the server has {100 * share:.1f} % of a core, {before:.1f} MB before and {memory_mb(server.pid):.1f} MB after')
    expect(greetings[0] > 0, 'strangers are heard')
    expect(not jog.refused, 'the jog continues among strangers', jog.refused[:2])
    expect(memory_mb(server.pid) < before + 20, 'what strangers bring is not kept', before, memory_mb(server.pid))


def main():
    millwright, halcmd, root = sys.argv[1:4]
    seconds = float(sys.argv[4]) if len(sys.argv) > 4 else 5
    megabytes = int(sys.argv[5]) if len(sys.argv) > 5 else 200
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(millwright, halcmd, root, pathlib.Path(folder))
        try:
            bench.env['XDG_CONFIG_HOME'] = folder
            bench.machine()
            server, port = bench.server('--listen', '127.0.0.1:0')
            remote_port = bench.remote_port()
            first = Screen(port)
            switch_on_and_home(first)
            first.cut()
            program = bench.programs / 'round.ngc'
            program.write_text('G21 G90 G64 F2000\no1 repeat [100000]\nG1 X20 Y0\nX20 Y20 Z5\nX0 Y0 Z0\no1 endrepeat\nM2\n')
            latency(port, server, program, seconds)
            alone, _ = jog_during(port, lambda: time.sleep(seconds))
            print(f'renewals of a jog, nothing else: {figures(alone.waits)}; {alone.stops} samples of a stopped joint')
            for size in (20, megabytes):
                jog, took = jog_during(port, lambda size=size: upload(port, size))
                print(f'renewals during an upload of {size} MB in {took:.1f} s: {figures(jog.waits)}; {jog.stops} samples of a stopped joint')
                expect(not jog.refused, 'the jog continues during the upload', size, jog.refused[:2])
            among_strangers(port, remote_port, server, 2 * seconds)
        finally:
            bench.end_all()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
