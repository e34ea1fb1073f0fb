#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Pipes, devices and endless files instead of programs, logs and a machine's files cause an error at once, and the machine
continues to cut.

usage: files.py BIN_FOLDER ROOT
"""
import os
import pathlib
import re
import resource
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from rig import ABORT_S, END_S, Machine  # noqa: E402  pylint: disable=wrong-import-position

START_S = 20
MEMORY = 1 << 30
FOUND = Findings()
expect = FOUND.expect


def programs_and_logs(machine):
    """While the machine is running: paths that are not files are rejected, and an abort is answered."""
    os.mkfifo(machine.folder / 'pipe.ngc')
    for path in ('/dev/zero', '/dev/ptmx', '/dev/stdin', machine.folder / 'pipe.ngc', machine.folder):
        begin = time.monotonic()
        answer = machine.open(path)
        machine.until(lambda: False, 0.1)
        expect(answer == machine.linuxcnc.RCS_ERROR and time.monotonic() - begin < 1, f'{path} is rejected at once: {answer}', *machine.messages[-1:])
        expect(any('not a file' in text for text in machine.messages), f'a message has the reason for rejecting {path}', *machine.messages[-2:])
        machine.messages.clear()
    subroutine = machine.folder / 'configs/sim/endless.ngc'
    os.mkfifo(subroutine)
    pipe = machine.folder / 'pipe.ngc'
    for line in (f'(LOGOPEN,{pipe})', '(LOGAPPEND,/dev/ptmx)', f'(PROBEOPEN {pipe})', 'o<endless> call'):
        expect(machine.run(f'G21 G90 G61 F600\nG1 X5\n{line}\nG1 X0\nM2\n'), f'{line} ends')
        expect(machine.stat.task_state == machine.linuxcnc.STATE_ON and machine.messages, f'{line}: the machine stays on, with a message', *machine.messages)
    took = machine.abort_s()
    expect(took < ABORT_S, f'an abort is answered in {took:.3f} s')


def begun(words, env):
    """(exit status, output) of a command with 1 GB of memory; the status is None if the command did not end."""
    try:
        done = subprocess.run(words, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=START_S,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))
        return done.returncode, done.stdout + done.stderr
    except subprocess.TimeoutExpired as late:
        return None, str(late.stdout)


def files_of_a_machine(machine):
    """Each file that the INI file names, and the INI file itself, is replaced by a pipe or a device."""
    ini = machine.ini.read_text()
    pipe = machine.folder / 'pipe.ngc'
    spoiled = machine.ini.with_name('spoiled.ini')
    for key in ('TOOL_TABLE', 'PARAMETER_FILE', 'HALFILE'):
        for place in (pipe, '/dev/zero'):
            text, count = re.subn(rf'^{key} *=.*$', f'{key} = {place}', ini, count=1, flags=re.MULTILINE)
            assert count == 1, key
            spoiled.write_text(text)
            for command in ('start', 'doctor'):
                words = [machine.programs / 'millwright', command, spoiled] + (['--no-display'] if command == 'start' else [])
                status, output = begun(words, machine.env)
                expect(status not in (None, 0) and status > 0 and 'not a file' in output, f'{command} with {key} = {place}: status {status}', output[-300:])
    for place in (pipe, '/dev/zero'):
        for command in ('start', 'doctor'):
            status, output = begun([machine.programs / 'millwright', command, place], machine.env)
            expect(status not in (None, 0) and status > 0 and 'not a file' in output, f'{command} {place}: status {status}', output[-300:])


def main():
    machine = Machine(sys.argv[1], sys.argv[2], 'files')
    try:
        machine.start()
        programs_and_logs(machine)
        took = machine.end_s()
        expect(took < END_S and machine.process.returncode == 0, f'SIGTERM ends it in {took:.1f} s, status {machine.process.returncode}', machine.text()[-300:])
        files_of_a_machine(machine)
    finally:
        machine.clean()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
