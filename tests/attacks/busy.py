#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests a computer that is busy with other programs: the threads of task run before them; programs that task starts and long
scripts do not.

usage: busy.py BIN_FOLDER ROOT [NAME]
"""
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import prepare_python, run_attacks, with_python  # noqa: E402  pylint: disable=wrong-import-position

BUSY = 10  # programs
TRIES = 3
STOLEN_S = 0.1
LONG = 'import os\nwhile not os.path.exists({!r}): pass'


def stolen_s():
    """Time that the host of a virtual machine has given to others. Then even the highest-priority thread is late."""
    return int(pathlib.Path('/proc/stat').read_text().split(maxsplit=9)[8]) / os.sysconf('SC_CLK_TCK')


def may_raise():
    """Whether this user may raise the priority of threads above the threads of other programs."""
    before = os.sched_getscheduler(0)
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
        os.sched_setscheduler(0, before, os.sched_param(0))
    except PermissionError:
        return False
    return True


def policies(process):
    """Scheduling policy of each thread of a process, without the flag for its children."""
    return [os.sched_getscheduler(int(thread.name)) & ~os.SCHED_RESET_ON_FORK for thread in pathlib.Path(f'/proc/{process}/task').iterdir()]


def threads(machine, found):
    first = machine.process.pid
    expected = 2 if may_raise() else 0
    found.expect(machine.until(lambda: policies(first).count(os.SCHED_RR) == expected, 5), f'{expected} threads of task run before others', policies(first))
    started = [int(folder.name) for folder in pathlib.Path('/proc').glob('[0-9]*') if is_started_by(machine, folder)]
    found.expect(len(started) > 0, 'task has started programs')
    for process in started:  # in millwright-rt, the thread that watches task has the priority of task
        most = 1 if b'millwright-rt' in pathlib.Path(f'/proc/{process}/cmdline').read_bytes() else 0
        found.expect(policies(process).count(os.SCHED_RR) == min(most, expected), f'priorities of process {process}', policies(process))


def is_started_by(machine, folder):
    try:
        return int(folder.name) not in (machine.process.pid, os.getpid()) and machine.env['MILLWRIGHT_INSTANCE'].encode() in (folder / 'environ').read_bytes()
    except OSError:
        return False


def script(machine, found):
    """A long script runs with the priority of other programs, and task has its own priority again afterwards."""
    expected = 2 if may_raise() else 0
    first = machine.process.pid
    seen = machine.folder / 'seen'
    (machine.folder / 'long.py').write_text(LONG.format(str(seen)))
    machine.cut(f'G21 G90 G64 F300\nM3 S500\nG1 X100\n;py,exec(open("{machine.folder}/long.py").read())\nG1 X0\nM2\n')
    found.expect(machine.until(lambda: policies(first).count(os.SCHED_RR) == min(expected, 1), 5), 'the script is ordinary', policies(first))
    seen.touch()
    found.expect(machine.until(lambda: policies(first).count(os.SCHED_RR) == expected, 8), 'task runs before others again', policies(first))
    found.expect(machine.cuts_on(0.5), 'it cuts', machine.messages)


def switch_on(machine):
    machine.abort_s()
    for state in (machine.linuxcnc.STATE_ESTOP_RESET, machine.linuxcnc.STATE_ON):
        machine.command.state(state)
        machine.command.wait_complete(5)


def load(machine, found):
    if not may_raise():
        print('this user may not raise priorities: nothing to judge')
        return
    busy = [subprocess.Popen(['sh', '-c', 'while :; do :; done']) for _ in range(BUSY)]
    try:
        for _ in range(TRIES):
            machine.messages.clear()
            before = stolen_s()
            machine.cut()
            cuts = machine.cuts_on(4)
            late = [text for text in machine.messages if 'did not run' in text]
            if (cuts and not late) or stolen_s() - before < STOLEN_S:
                break
            switch_on(machine)
        found.expect(cuts, f'it cuts on beside {BUSY} busy programs', machine.messages)
        found.expect(not late, f'nothing was late; the host took {stolen_s() - before:.2f} s of the processors', machine.messages)
    finally:
        for one in busy:
            one.kill()
            one.wait()


if __name__ == '__main__':
    run_attacks(__file__, {'threads': threads, 'script': script, 'load': load}, prepare_python, with_python)
