#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Sends aborts from new clients, and measures how late the computer runs an ordinary process.

usage: stopper.py WEB_PORT RSH_PORT NML_PORT; each line of the standard input is a request, answered by a line of JSON:
python, web, rsh or nml (an abort by a new client of that type), lateness (all since the last request), quit.
"""
import json
import pathlib
import re
import socket
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'e2e'))
import linuxcnc  # noqa: E402  pylint: disable=wrong-import-position
from nml_session import Client as Nml  # noqa: E402  pylint: disable=wrong-import-position
from web_screen import Screen  # noqa: E402  pylint: disable=wrong-import-position

STEP_S = 0.002
LATE_S = 0.01
ANSWER_S = 5


class Lateness(threading.Thread):
    """[(time of waking, lateness)]."""

    def __init__(self):
        super().__init__(daemon=True)
        self.found = []

    def run(self):
        while True:
            begin = time.monotonic()
            time.sleep(STEP_S)
            end = time.monotonic()
            if end - begin - STEP_S > LATE_S:
                self.found.append((end, end - begin - STEP_S))

    def take(self):
        found, self.found = self.found, []
        return found


def by_python(_ports):
    command = linuxcnc.command()
    sent = time.monotonic()
    command.abort()  # returns when the status shows that task has carried it out
    answered = time.monotonic()
    answer = command.wait_complete(ANSWER_S)  # until the axes have stopped
    if answer not in (linuxcnc.RCS_DONE, linuxcnc.RCS_ERROR):
        return sent, f'none: {shown_by_python(command)}', answered
    return sent, 'done' if answer == linuxcnc.RCS_DONE else 'error', answered


def shown_by_python(command):
    """The state of a command that has no answer, from the status."""
    stat = linuxcnc.stat()
    stat.poll()
    names = ('echo_serial_number', 'state', 'task_state', 'task_mode', 'interp_state', 'exec_state', 'queue', 'inpos', 'current_line', 'file')
    return f'command {command.serial}: ' + ', '.join(f'{name} {getattr(stat, name)}' for name in names)


def by_web(ports):
    screen = Screen(ports[0])
    if not screen.until(lambda: screen.hello, ANSWER_S):
        return time.monotonic(), 'no greeting of the server', time.monotonic()
    sent = time.monotonic()
    number = screen.ask('AbortAll')
    answer = screen.outcome(number)
    answered = time.monotonic()
    is_open = screen.is_open
    screen.cut()
    unanswered = f'{screen.outcomes.get(number)}, open {is_open}, hello {screen.hello}, machine {screen.machine}, {len(screen.messages)} messages'
    return sent, {'DONE': 'done', 'FAILED': 'error', 'REFUSED': 'error'}.get(answer, unanswered), answered


def by_rsh(ports):
    with socket.create_connection(('127.0.0.1', ports[1]), ANSWER_S) as connection:
        file = connection.makefile('rw', newline='\r\n')
        file.write('hello EMC stopper 1.0\r\nset enable EMCTOO\r\nset echo off\r\nset verbose on\r\nset set_wait done\r\n')
        file.flush()
        while 'SET_WAIT' not in (line := file.readline().upper()):
            if not line:
                return time.monotonic(), 'closed', time.monotonic()
        sent = time.monotonic()
        file.write('set abort\r\n')
        file.flush()
        answer = file.readline()
        return sent, 'done' if re.search('ACK', answer) else 'error' if 'NAK' in answer else answer or 'closed', time.monotonic()


def by_nml(ports):
    client = Nml(ports[2])
    sent = time.monotonic()
    serial = client.send('EMC_TASK_ABORT_TYPE', 503)
    state = 'none'
    while state == 'none' and time.monotonic() - sent < ANSWER_S:
        status = client.status()
        echo = int(status['echo_serial_number'])
        if echo > serial:  # another client's command has followed
            state = 'done'
        elif echo == serial:
            state = {'DONE': 'done', 'ERROR': 'error'}.get(status['state'], 'none')
    client.socket.close()
    return sent, state, time.monotonic()


CLIENTS = {'python': by_python, 'web': by_web, 'rsh': by_rsh, 'nml': by_nml}


def main():
    ports = [int(word) for word in sys.argv[1:4]]
    lateness = Lateness()
    lateness.start()
    print(json.dumps('ready'), flush=True)
    for line in sys.stdin:
        request = line.strip()
        if request == 'quit':
            return
        if request == 'lateness':
            print(json.dumps(lateness.take()), flush=True)
            continue
        begin = time.monotonic()
        try:
            sent, result, answered = CLIENTS[request](ports)
        except Exception as error:  # pylint: disable=broad-exception-caught  # the judge reports any failure
            sent, result, answered = begin, f'{type(error).__name__}: {error}', time.monotonic()
        print(json.dumps({'kind': request, 'begin': begin, 'sent': sent, 'answered': answered, 'result': result}), flush=True)


if __name__ == '__main__':
    main()
