#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The independent observer of an attacked machine: the motor position of every servo cycle by a HAL sampler, the messages of a Python
client and those of a screen, each with the time of the monotonic clock.

usage: observer.py WEB_PORT; one request in each line of the standard input, one line of JSON for each answer:
mark (forget what was recorded), take (all since the mark), quit.
"""
import json
import os
import pathlib
import select
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'e2e'))
import linuxcnc  # noqa: E402  pylint: disable=wrong-import-position
from web_screen import Screen  # noqa: E402  pylint: disable=wrong-import-position

PERIOD_S = 0.01
CYCLE_S = 0.001


def sample(writer):
    """Runs in a separate process, because a HAL component may end with HAL. Prints one line for each reading of the sampler:
    [time, records]."""
    import hal  # pylint: disable=import-outside-toplevel
    component = hal.component(f'observer{os.getpid()}')
    stream = hal.stream(component, hal.sampler_base, 'fffb')
    component.ready()
    parent = os.getppid()
    while os.getppid() == parent:
        time.sleep(PERIOD_S)
        records = []
        while (record := stream.read()) is not None:
            records.append((stream.sampleno, *record))
        if records:
            os.write(writer, json.dumps([time.monotonic(), records]).encode() + b'\n')
    component.exit()


class Positions:
    """What the sampler recorded: batches of (time of reading, first number, records)."""

    def __init__(self):
        self.reader, writer = os.pipe()
        self.child = os.fork()
        if self.child == 0:
            try:
                sample(writer)
            finally:
                os._exit(0)
        os.close(writer)
        self.batches, self.isGone, self.rest = [], False, b''

    def read(self):
        while not self.isGone and select.select([self.reader], [], [], 0)[0]:
            more = os.read(self.reader, 1 << 16)
            self.isGone = not more
            *lines, self.rest = (self.rest + more).split(b'\n')
            self.batches += [json.loads(line) for line in lines]

    def samples(self):
        """[(time, x, y, z, enabled)]: the time of a record is at most that of its reading, and at most that of a later record minus the cycles between them."""
        found, latest, following = [], float('inf'), 0
        for read, records in reversed(self.batches):
            for number, x, y, z, enabled in reversed(records):
                latest = min(latest - (following - number) * CYCLE_S, read) if following else read
                following = number
                found.append((latest, x, y, z, enabled))
        found.reverse()
        return found


class WebMessages(threading.Thread):
    """A screen that tries to reconnect while its server is not running."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port, self.messages, self.mark, self.gone = port, [], time.monotonic(), []

    def run(self):
        while True:
            try:
                self.follow(Screen(self.port))
            except Exception:  # pylint: disable=broad-exception-caught  # the server is killed, stopped, flooded
                pass
            time.sleep(0.1)

    def follow(self, screen):
        state = None
        while screen.is_open:
            screen.listen(0.05)
            taken, screen.messages = screen.messages, []
            screen.outcomes.clear()
            for message in taken:
                when = time.monotonic() - message.get('age_ms', 0) / 1000
                if when >= self.mark:
                    self.messages.append((when, message['text']))
            if screen.machine != state:
                state = screen.machine
                self.gone.append((time.monotonic(), state))


class PythonMessages:
    def __init__(self):
        self.stat, self.errors = linuxcnc.stat(), linuxcnc.error_channel()
        self.messages, self.state, self.gone = [], {}, ''

    def read(self):
        try:
            while message := self.errors.poll():
                self.messages.append((time.monotonic(), message[1]))
            self.stat.poll()
        except linuxcnc.error as error:
            self.gone = str(error)
            return
        stat = self.stat
        self.gone = ''
        self.state = {'is_on': stat.task_state == linuxcnc.STATE_ON, 'is_idle': stat.interp_state == linuxcnc.INTERP_IDLE,
                      'velocity': stat.current_vel, 'enabled': stat.enabled, 'file': stat.file}


def main():
    positions = Positions()
    web, python = WebMessages(int(sys.argv[1])), PythonMessages()
    web.start()
    rest, last_status = b'', 0.0
    print(json.dumps('ready'), flush=True)
    while True:
        if select.select([0], [], [], 2 * PERIOD_S)[0]:
            more = os.read(0, 65536)
            if not more:
                return
            *requests, rest = (rest + more).split(b'\n')
        else:
            requests = []
        positions.read()
        if requests or time.monotonic() - last_status > 2 * PERIOD_S:
            last_status = time.monotonic()
            python.read()
        for request in requests:
            if request == b'quit':
                print(json.dumps('bye'), flush=True)
                return
            if request == b'mark':
                positions.batches, python.messages, web.messages, web.gone = [], [], [], []
                web.mark = time.monotonic()
            print(json.dumps({'time': time.monotonic(), 'samples': positions.samples() if request == b'take' else [],
                              'is_hal_gone': positions.isGone, 'state': python.state, 'python_gone': python.gone,
                              'python': python.messages, 'web': web.messages, 'web_gone': web.gone}), flush=True)


if __name__ == '__main__':
    main()
