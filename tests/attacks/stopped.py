#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A process of a machine that cuts is stopped by SIGSTOP and continued: axes, spindle and coolant stop; a stop is reported as
done only if it was executed; and a message names the process.

usage: stopped.py BIN_FOLDER ROOT [NAME]
"""
import os
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import ABORT_S, run_attacks  # noqa: E402  pylint: disable=wrong-import-position


def realtime_process(machine):
    instance = machine.env['MILLWRIGHT_INSTANCE']
    for folder in pathlib.Path('/proc').glob('[0-9]*'):
        try:
            words = (folder / 'cmdline').read_bytes().split(b'\0')
        except OSError:
            continue
        if words[0].endswith(b'millwright-rt') and instance.encode() in b' '.join(words):
            return int(folder.name)
    raise AssertionError('no millwright-rt of this instance')


def realtime(machine, found):
    machine.cut()
    process = realtime_process(machine)
    os.kill(process, signal.SIGSTOP)
    try:
        told = machine.until(lambda: any('has not responded' in text for text in machine.messages), 1)
        found.expect(told, 'task reports that motion does not run', machine.messages)
        begin = time.monotonic()
        machine.command.abort()
        answer = machine.command.wait_complete(2)
        took = time.monotonic() - begin
        found.expect(answer == machine.linuxcnc.RCS_ERROR and took < ABORT_S, f'an abort that is not executed: answer {answer} after {took:.3f} s')
        found.expect(machine.until(lambda: any('does not answer' in text for text in machine.messages), 0.5), 'a message reports that it is not executed', machine.messages)
    finally:
        os.kill(process, signal.SIGCONT)
    found.expect(machine.until(lambda: any('did not run for' in text and ', while axes moved' in text for text in machine.messages), 2), 'motion reports its gap', machine.messages)
    found.expect(machine.until(lambda: not machine.stat.enabled, 1), 'the drives are off')


DEAF = """import hal, signal, time
h = hal.component('deaf')
h.ready()
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print('ready', flush=True)
time.sleep(60)
"""


def killed(machine, found):
    """The realtime process is killed. A HAL program that does not end delays the end, but not the message."""
    program = subprocess.Popen([sys.executable, '-c', DEAF], env=machine.env, stdout=subprocess.PIPE, text=True)
    try:
        assert program.stdout.readline() == 'ready\n'
        machine.cut()
        machine.messages.clear()
        os.kill(realtime_process(machine), signal.SIGKILL)
        told = machine.until(lambda: any('has ended: it was killed' in text for text in machine.messages), 1)
        found.expect(told, 'clients read at once that the realtime process was killed', machine.messages)
        end = time.monotonic() + 0.5
        while 'has ended: it was killed' not in machine.text() and time.monotonic() < end:
            time.sleep(0.01)
        found.expect('has ended: it was killed' in machine.text(), 'the terminal shows it at once', machine.text()[-300:])
    finally:
        program.kill()
        program.wait()
    found.expect(machine.process.wait(10) == 1, 'the machine ends with status 1')
    found.expect(machine.text().count('has ended: it was killed') == 1, 'and reports it once', machine.text()[-600:])


def fast(machine, found):
    """Axes whose braking takes longer than an abort may take to be answered."""
    machine.cut('G21 G90\no1 repeat [20]\nG0 X240\nG0 X0\no1 endrepeat\nM2\n')
    found.expect(machine.until(lambda: machine.stat.current_vel > 190, 5), 'it moves fast', machine.stat.current_vel)
    took = machine.abort_s()
    found.expect(took < ABORT_S, f'an abort of a fast move is answered in {took:.3f} s')
    machine.stat.poll()
    found.expect(machine.stat.current_vel == 0, 'wait_complete() has waited until the axes rest', machine.stat.current_vel)


def task(machine, found):
    import hal  # pylint: disable=import-outside-toplevel
    machine.cut()
    found.expect(hal.get_value('iocontrol.0.coolant-flood'), 'coolant runs')
    machine.process.send_signal(signal.SIGSTOP)
    try:
        time.sleep(1.2)
        found.expect(not hal.get_value('motion.motion-enabled') and not hal.get_value('spindle.0.on'), 'motion and spindle are off')
        found.expect(not hal.get_value('iocontrol.0.coolant-flood'), 'coolant is off')
    finally:
        machine.process.send_signal(signal.SIGCONT)
    found.expect(machine.until(lambda: any('the task process (millwright start) did not run' in text for text in machine.messages), 2), 'motion reports it', machine.messages)
    found.expect(machine.until(lambda: any('task (millwright start) did not run for 1.' in text and 'it was stopped' in text for text in machine.messages), 1), 'task reports why', machine.messages)
    found.expect(machine.until(lambda: machine.stat.task_state != machine.linuxcnc.STATE_ON, 0.2), f'the machine stays off: state {machine.stat.task_state}')
    found.expect(not hal.get_value('iocontrol.0.coolant-flood'), 'coolant stays off')


if __name__ == '__main__':
    run_attacks(__file__, {'realtime': realtime, 'killed': killed, 'fast': fast, 'task': task})
