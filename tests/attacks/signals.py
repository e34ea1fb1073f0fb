#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""SIGTERM, SIGHUP and SIGINT during a cut: the axes stop before the spindle switches off, and the machine ends in time.

usage: signals.py BIN_FOLDER ROOT [TERM|HUP|INT]
"""
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from rig import END_S, Machine  # noqa: E402  pylint: disable=wrong-import-position

FAST = 'G21 G90 G64 F6000\nM3 S500\nM8\nG4 P0.2\no1 repeat [2000]\nG1 X100\nG1 X0\no1 endrepeat\nM2\n'


def attack(programs, root, name):
    found = Findings()
    machine = Machine(programs, root, f'signals-{name.lower()}')
    try:
        machine.start()
        import hal  # pylint: disable=import-outside-toplevel
        machine.cut(FAST)
        found.expect(machine.until(lambda: abs(hal.get_value('joint.0.vel-cmd')) > 50 and hal.get_value('spindle.0.on'), 10), 'it cuts at speed')
        machine.process.send_signal(getattr(signal, f'SIG{name}'))
        begin, moving_without_spindle = time.monotonic(), 0.0
        while machine.process.poll() is None and time.monotonic() - begin < END_S:
            try:
                spindle_on, speed = hal.get_value('spindle.0.on'), abs(hal.get_value('joint.0.vel-cmd'))
            # pylint: disable=broad-exception-caught  # hal may end with the machine in any call
            except Exception:
                break
            if not spindle_on:
                moving_without_spindle = max(moving_without_spindle, speed)
            time.sleep(0.0005)
        found.expect(moving_without_spindle < 0.5, f'SIG{name}: the axes move at {moving_without_spindle:.1f} mm/s after the spindle went off')
        try:
            machine.process.wait(END_S)
        except subprocess.TimeoutExpired:
            pass
        took = time.monotonic() - begin
        found.expect(machine.process.poll() == 0 and took < END_S, f'SIG{name} ends it in {took:.1f} s, status {machine.process.poll()}', machine.text()[-300:])
    finally:
        machine.clean()
    return found.status()


def main():
    if len(sys.argv) > 3:
        return attack(*sys.argv[1:4])
    return max(subprocess.run([sys.executable, __file__, *sys.argv[1:3], name], check=False).returncode for name in ('TERM', 'HUP', 'INT'))


if __name__ == '__main__':
    sys.exit(main())
