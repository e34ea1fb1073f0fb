#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The display of a simulated machine that writes every attribute of linuxcnc.stat in several states; see compare_stat.py.

Environment: OPERATOR_OUT a file. One line of JSON for each state: its name, the attributes.
"""
import json
import os
import pathlib
import time

import linuxcnc

STAT, COMMAND = linuxcnc.stat(), linuxcnc.command()
HERE = pathlib.Path.cwd()
PROGRAM = 'G21 G90 F3000\nG1 X0\nM8 S400 M3\nG1 X20 F300\nM0\nG4 P3\nG1 X0 F3000\nM2\n'


def shown(value):
    """The value as JSON, with rounded numbers and without classes of sequences."""
    if isinstance(value, float):
        return round(value, 4) + 0.0
    if isinstance(value, (tuple, list)):
        return [shown(one) for one in value]
    if isinstance(value, dict):
        return {key: shown(one) for key, one in value.items()}
    return value if isinstance(value, (int, str, bool, type(None))) else str(value)


def write(out, state):
    STAT.poll()
    names = [name for name in dir(STAT) if not name.startswith('_') and not callable(getattr(STAT, name))]
    out.write(json.dumps([state, {name: shown(getattr(STAT, name)) for name in names},
                          {name: type(getattr(STAT, name)).__name__ for name in names}]) + '\n')
    out.flush()


def wait_until(condition, limit=10.0):
    end = time.monotonic() + limit
    while time.monotonic() < end:
        STAT.poll()
        if condition():
            return
        time.sleep(0.01)


def ask(method, *arguments):
    method(*arguments)
    COMMAND.wait_complete(3)


def main():
    for _ in range(200):
        try:
            STAT.poll()
            if STAT.joints > 0 and STAT.task_state > 0:
                break
        except linuxcnc.error:
            pass
        time.sleep(0.1)
    time.sleep(1)
    (HERE / 'stat.ngc').write_text(PROGRAM, encoding='ascii')
    with open(os.environ['OPERATOR_OUT'], 'w', encoding='ascii') as out:
        write(out, 'emergency stop')
        ask(COMMAND.state, linuxcnc.STATE_ESTOP_RESET)
        write(out, 'off')
        ask(COMMAND.state, linuxcnc.STATE_ON)
        ask(COMMAND.home, -1)
        time.sleep(1)
        write(out, 'homed')
        ask(COMMAND.mode, linuxcnc.MODE_MDI)
        for line in ('G10 L2 P1 X1', 'G92 Y1', 'T1 M6 G43', 'M64 P0', 'M68 E0 Q1.5', 'G0 X1'):
            ask(COMMAND.mdi, line)
        time.sleep(0.3)
        write(out, 'MDI')
        ask(COMMAND.mode, linuxcnc.MODE_AUTO)
        ask(COMMAND.program_open, str(HERE / 'stat.ngc'))
        COMMAND.auto(linuxcnc.AUTO_RUN, 0)
        wait_until(lambda: STAT.motion_line == 4 and STAT.position[0] > 3)
        write(out, 'running')
        COMMAND.auto(linuxcnc.AUTO_PAUSE)
        time.sleep(0.7)
        write(out, 'paused')
        COMMAND.auto(linuxcnc.AUTO_RESUME)
        wait_until(lambda: STAT.interp_state == linuxcnc.INTERP_PAUSED)
        time.sleep(0.3)
        write(out, 'M0')
        COMMAND.auto(linuxcnc.AUTO_RESUME)
        wait_until(lambda: STAT.delay_left > 0)
        write(out, 'dwell')
        wait_until(lambda: STAT.interp_state == linuxcnc.INTERP_IDLE)
        time.sleep(0.5)
        write(out, 'ended')


main()
