#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine that was killed must not prevent the next start by any user; the message about a running machine names it.

usage: instances.py BIN_FOLDER ROOT
"""
import os
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from rig import Machine  # noqa: E402  pylint: disable=wrong-import-position

NOBODY = 65534
PYTHON = '/usr/bin/python3'  # other users may run it too
UP_S = 20
FOUND = Findings()
expect = FOUND.expect


def begun(machine, name, **more):
    """Starts the same instance again and returns its output: 'is running: instance', or the last line."""
    out = machine.folder / name
    with out.open('w') as file:
        process = subprocess.Popen([machine.programs / 'millwright', 'start', machine.ini, '--no-display'], env=dict(machine.env, **more.pop('env', {})),
                                   stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, **more)
    end = time.monotonic() + UP_S
    while 'is running: instance' not in out.read_text() and process.poll() is None and time.monotonic() < end:
        time.sleep(0.05)
    return process, out.read_text()


def second_start(machine, user):
    """A second start while the machine is running."""
    process, text = begun(machine, 'second.txt', **user)
    process.kill()
    process.wait()
    expect('is running: instance' not in text and 'MILLWRIGHT_INSTANCE' in text, 'a second start is rejected, and the message says what to do', text)
    if user:
        expect(f'process {machine.process.pid}' in text and 'of user' in text, 'and the process and its user', text)


def isRealtimeAlive(machine):
    name = f"MILLWRIGHT_INSTANCE={machine.env['MILLWRIGHT_INSTANCE']}".encode()
    for folder in pathlib.Path('/proc').glob('[0-9]*'):
        try:
            if (folder / 'comm').read_text().strip() == 'millwright-rt' and name in (folder / 'environ').read_bytes().split(b'\0'):
                return True
        except OSError:
            pass
    return False


def after_kill(machine, user, what):
    machine.process.send_signal(signal.SIGKILL)
    machine.process.wait()
    end = time.monotonic() + 5
    while isRealtimeAlive(machine) and time.monotonic() < end:  # it ends by itself
        time.sleep(0.1)
    process, text = begun(machine, f'{what}.txt', **user)
    expect('is running: instance' in text, f'after SIGKILL {what} starts the same instance', text)
    if 'is running: instance' in text:
        words = [PYTHON, '-c', 'import linuxcnc; s = linuxcnc.stat(); s.poll(); print(s.task_state)']
        found = subprocess.run(words, env=machine.env, capture_output=True, text=True, check=False, timeout=30,
                               **{key: value for key, value in user.items() if key != 'env'})
        expect(found.returncode == 0, f'clients of {what} find it', found.stderr)
    process.terminate()
    process.wait(10)


def main():
    machine = Machine(sys.argv[1], sys.argv[2], 'instances')
    nobody = {'user': NOBODY, 'group': NOBODY, 'extra_groups': [], 'env': {'XDG_RUNTIME_DIR': ''}}
    try:
        machine.start()
        second_start(machine, {})
        isReadable = os.geteuid() == 0 and subprocess.run([machine.programs / 'millwright', '--help'], user=NOBODY, group=NOBODY, extra_groups=[],
                                                          check=False, capture_output=True).returncode == 0
        if isReadable:
            for path in [machine.folder, *machine.folder.rglob('*')]:
                path.chmod(0o777 if path.is_dir() else 0o666)
            second_start(machine, nobody)
        after_kill(machine, {}, 'the same user')
        if isReadable:
            machine.start()
            after_kill(machine, nobody, 'another user')
        else:
            print('not tested: another user: needs root, and programs that all users may read')
        for path in pathlib.Path('/dev/shm').glob(f"*{machine.env['MILLWRIGHT_INSTANCE']}*"):
            path.unlink()
    finally:
        machine.clean()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
