#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Python in G-code that sleeps, never ends, or tries to end the process: stops are executed, the machine stays up, and SIGTERM
ends it.

usage: scripts.py BIN_FOLDER ROOT [NAME]
"""
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import ABORT_S, END_S, run_attacks, with_python  # noqa: E402  pylint: disable=wrong-import-position

LONG = 6.0


def prepare(machine):
    (machine.ini.parent / 'toplevel.py').write_text('import oword\n')
    (machine.ini.parent / 'oword.py').write_text('def forever(self):\n    while True:\n        pass\n')


def cut_then(machine, python):
    """Cuts a line of 20 s, followed by `python`."""
    machine.cut(f'G21 G90 G64 F300\nM3 S500\nG1 X100\n;py,{python}\nG1 X0\nM2\n')


def sleep(machine, found):
    cut_then(machine, f'import time; time.sleep({LONG})')
    busy = machine.until(lambda: any('the interpreter has been busy' in text for text in machine.messages), 10)
    found.expect(busy and machine.stat.current_vel > 0 and machine.cuts_on(0.5), 'it cuts on while a script sleeps', machine.messages)
    took = machine.abort_s()
    found.expect(took < ABORT_S, f'an abort while a script sleeps is answered in {took * 1000:.0f} ms')
    found.expect(machine.until(lambda: machine.stat.current_vel == 0, 1), 'the axes stop')
    found.expect(machine.until(lambda: machine.stat.interp_state == machine.linuxcnc.INTERP_IDLE, LONG + 2), 'the interpreter comes back')
    found.expect(machine.stat.task_state == machine.linuxcnc.STATE_ON, 'the machine stays on', machine.messages)
    found.expect(machine.run('G21 G90\nG0 X1\nM2\n') and abs(machine.stat.actual_position[0] - 1) < 0.01, 'the next program runs', machine.messages)
    took = machine.end_s()
    found.expect(took < END_S, f'SIGTERM ends it in {took:.1f} s')


def estop(machine, found):
    cut_then(machine, f'import time; time.sleep({LONG})')
    machine.until(lambda: False, 0.5)
    begin = time.monotonic()
    machine.command.state(machine.linuxcnc.STATE_ESTOP)
    machine.command.wait_complete()
    took = time.monotonic() - begin
    found.expect(took < ABORT_S, f'an emergency stop while a script sleeps is answered in {took * 1000:.0f} ms')
    found.expect(machine.until(lambda: not machine.stat.enabled and not machine.stat.spindle[0]['enabled'], 1), 'the drives and the spindle are off')


def end(machine, found):
    cut_then(machine, 'while True: pass')
    found.expect(machine.until(lambda: any('the interpreter has been busy' in text for text in machine.messages), 10), 'the operator gets a message', machine.messages)
    took = machine.end_s()
    found.expect(took < END_S, f'SIGTERM ends a machine with an endless script in {took:.1f} s', machine.text())


def endless(machine, found):
    machine.command.mode(machine.linuxcnc.MODE_MDI)
    machine.command.wait_complete()
    for line, place in ((';py,while True: pass', ';py,:1'), ('o<forever> call', 'oword.py:')):
        machine.messages.clear()
        machine.command.mdi(line)
        machine.until(lambda: False, 0.3)
        took = machine.abort_s()
        found.expect(took < ABORT_S, f'an abort of {line} is answered in {took * 1000:.0f} ms')
        named = machine.until(lambda: any('ended the script' in text and place in text for text in machine.messages), 2)
        found.expect(named, f'{line} ends with a message that names {place}', machine.messages)
        machine.command.mdi('G0 X1' if 'py' in line else 'G0 X2')
        found.expect(machine.command.wait_complete(10) == machine.linuxcnc.RCS_DONE, f'the machine takes the next line after {line}', machine.messages)
    machine.messages.clear()
    machine.command.mdi(';py,import time; time.sleep(3)')
    machine.until(lambda: False, 0.3)
    machine.command.abort()
    told = machine.until(lambda: any('outside of Python' in text and ';py,:1' in text for text in machine.messages), 2.5)
    found.expect(told, 'a message says where it waits', machine.messages)
    machine.until(lambda: False, 2)
    machine.command.mdi('G0 X1')
    found.expect(machine.command.wait_complete(10) == machine.linuxcnc.RCS_DONE, 'the machine takes the next line after time.sleep', machine.messages)


def leave(machine, found):
    for call in ('_exit(0)', 'abort()'):
        found.expect(machine.run(f';py,import os; os.{call}\nM2\n'), f'os.{call} ends the program')
        found.expect(machine.process.poll() is None and any('would end the machine' in text for text in machine.messages), f'os.{call} is an error', machine.messages)
    found.expect(machine.run(';py,import os; os.fork() or os._exit(0)\nM2\n') and not machine.messages, 'a child of a script ends', machine.messages)
    took = machine.end_s()
    found.expect(took < END_S, f'SIGTERM ends it in {took:.1f} s')


if __name__ == '__main__':
    run_attacks(__file__, {'sleep': sleep, 'estop': estop, 'end': end, 'endless': endless, 'leave': leave},
                prepare, with_python)
