#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The display of a small simulated machine: it runs the session $SESSION and writes its observations to the file $FACTS, one fact per
line. It runs on Millwright and on LinuxCNC 2.9 (see ../side_by_side.py).
"""
import os
import pathlib
import time

import hal
import linuxcnc

STAT, COMMAND, ERRORS = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
HERE = pathlib.Path.cwd()
LIMIT_S = 20
FACTS = []


def fact(what, *values):
    FACTS.append(what + ': ' + ' '.join(str(value) for value in values))


def until(what, condition):
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        STAT.poll()
        if condition():
            return
        time.sleep(0.005)
    fact('TOO LONG', what)


def act(method, *arguments):
    method(*arguments)
    return {linuxcnc.RCS_DONE: 'done', linuxcnc.RCS_ERROR: 'error'}.get(COMMAND.wait_complete(LIMIT_S), 'too long')


def mdi(line):
    return act(COMMAND.mdi, line)


def errors():
    """The number of messages since the last call."""
    count = 0
    while ERRORS.poll() is not None:
        count += 1
    return count


def number(value):
    return f'{round(value, 3) + 0.0:g}'


def switch_on(mode):
    act(COMMAND.state, linuxcnc.STATE_ESTOP_RESET)
    act(COMMAND.state, linuxcnc.STATE_ON)
    act(COMMAND.home, -1)
    until('homed', lambda: all(STAT.homed[:STAT.joints]))
    act(COMMAND.mode, mode)


# Single step: AUTO_STEP from idle to the end of a program, one block a step.
STEPPED = """G21 G90 G64
#31=3
(a comment alone)
G1 X2 F6000
G4 P0.1
M3 S200
o100 sub
  G91 G1 Y1
  G90
o100 endsub
o100 call
o101 while [#31 GT 1]
  #31=[#31-1]
  G0 Z#31
o101 endwhile
M5
M2
"""


def single_step():
    switch_on(linuxcnc.MODE_AUTO)
    (HERE / 'stepped.ngc').write_text(STEPPED, encoding='ascii')
    act(COMMAND.program_open, str(HERE / 'stepped.ngc'))
    moves, modes = [], set()
    for step in range(60):
        COMMAND.auto(linuxcnc.AUTO_STEP)
        COMMAND.wait_complete(LIMIT_S)
        until('the step ends', lambda: STAT.interp_state == linuxcnc.INTERP_IDLE or
              (STAT.paused and STAT.inpos and STAT.delay_left == 0 and
               STAT.interp_state in (linuxcnc.INTERP_PAUSED, linuxcnc.INTERP_WAITING)))
        time.sleep(0.05)
        STAT.poll()
        position = ' '.join(number(value) for value in STAT.position[:3])
        if not moves or moves[-1] != position:
            moves.append(position)
        if STAT.interp_state == linuxcnc.INTERP_IDLE:
            break
        modes.add((STAT.paused, STAT.task_mode == linuxcnc.MODE_AUTO, STAT.inpos))
    fact('positions', ', '.join(moves))
    fact('between steps: paused, AUTO, in position', *sorted(modes))
    fact('after the last step', STAT.interp_state == linuxcnc.INTERP_IDLE, 'paused', bool(STAT.paused), 'spindle', STAT.spindle[0]['direction'])
    fact('steps of the program', step + 1)
    fact('MDI after it', act(COMMAND.mode, linuxcnc.MODE_MDI), mdi('G0 X0 Y0 Z0'))
    fact('messages', errors())


# Speeds of spindles within the limits of the INI file.
def speeds(spindle):
    """The values of a spindle in HAL and in the status."""
    time.sleep(0.05)
    STAT.poll()
    pins = [hal.get_value(f'spindle.{spindle}.{name}') for name in ('speed-out', 'speed-out-abs', 'forward', 'reverse')]
    return number(pins[0]), number(pins[1]), 'forward' if pins[2] else '-', 'reverse' if pins[3] else '-', number(STAT.spindle[spindle]['speed'])


def spindle_limits():
    switch_on(linuxcnc.MODE_MDI)
    for spindle in range(5):
        where = f'spindle {spindle}'
        for code in ('M3', 'M4'):
            for speed in (0, 50, 300, 5000):
                fact(f'{where} {code} S{speed}', mdi(f'{code} ${spindle} S{speed}'), *speeds(spindle))
            act(COMMAND.spindleoverride, 2.0, spindle)
            mdi(f'S600 ${spindle}')
            fact(f'{where} {code} S600 at 200 %', *speeds(spindle))
            act(COMMAND.spindleoverride, 0.1, spindle)
            fact(f'{where} {code} S600 at 10 %', *speeds(spindle))
            mdi(f'M51 P0 ${spindle}')
            fact(f'{where} {code} S600 at 10 %, M51 P0', *speeds(spindle))
            mdi(f'M51 P1 ${spindle}')
            act(COMMAND.spindleoverride, 1.0, spindle)
            mdi(f'M5 ${spindle}')
            fact(f'{where} {code}, M5', *speeds(spindle))
        act(COMMAND.mode, linuxcnc.MODE_MANUAL)
        for direction, speed in ((linuxcnc.SPINDLE_FORWARD, 20), (linuxcnc.SPINDLE_FORWARD, 4000), (linuxcnc.SPINDLE_REVERSE, 20),
                                 (linuxcnc.SPINDLE_REVERSE, 4000)):
            act(COMMAND.spindle, direction, speed, spindle)
            fact(f'{where} by hand {direction} {speed}', *speeds(spindle))
        act(COMMAND.spindle, linuxcnc.SPINDLE_OFF, spindle)
        act(COMMAND.mode, linuxcnc.MODE_MDI)
        fact(f'{where} M3 S-300', mdi(f'M3 ${spindle} S-300'), *speeds(spindle))
        mdi(f'M5 ${spindle}')
    errors()


# load_tool_table with a random tool changer, with a tool in the spindle.
def tools():
    STAT.poll()
    table = ', '.join(f'T{tool.id}' + (f'(Z{number(tool.zoffset)} D{number(tool.diameter)})' if tool.id > 0 else '')
                      for tool in STAT.tool_table if tool.id >= 0)
    return (f'spindle T{STAT.tool_in_spindle} prepared {STAT.pocket_prepped} from {STAT.tool_from_pocket} offset {number(STAT.tool_offset[2])}', '|', table)


def reload_tools():
    table = HERE / 'tools.tbl'
    switch_on(linuxcnc.MODE_MDI)
    fact('at the start', *tools())
    fact('reload', act(COMMAND.load_tool_table), *tools())
    for line in ('T1 M6', 'G43', 'T2'):
        fact(line, mdi(line), *tools())
    fact('reload with T1 in the spindle and T2 prepared', act(COMMAND.load_tool_table), *tools())
    text = table.read_text(encoding='ascii')
    table.write_text(text.replace('Z+11.000000', 'Z+14.5').replace('Z11', 'Z14.5'), encoding='ascii')
    fact('reload after an edit of the tool in the spindle', act(COMMAND.load_tool_table), *tools())
    fact('M6', mdi('M6'), *tools())
    fact('G43', mdi('G43'), *tools())
    fact('reload with T2 in the spindle', act(COMMAND.load_tool_table), *tools())
    fact('G10 L1', mdi('G10 L1 P2 Z25'), *tools())
    fact('reload', act(COMMAND.load_tool_table), *tools())
    fact('M61 Q3', mdi('M61 Q3'), *tools())
    fact('reload', act(COMMAND.load_tool_table), *tools())
    fact('T0 M6', mdi('T0 M6'), *tools())
    fact('reload', act(COMMAND.load_tool_table), *tools())
    for line in ('T2 M6', 'M61 Q0', 'M61 Q1'):
        fact(line, mdi(line), *tools())
    for line in sorted(table.read_text(encoding='ascii').splitlines()):
        words = line.split(';')[0].split()
        fact('tools.tbl', *sorted(f'{word[0]}{number(float(word[1:]))}' for word in words))
    fact('messages', errors())


def main():
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        try:
            STAT.poll()
            if STAT.joints > 0 and STAT.task_state > 0:
                break
        except linuxcnc.error:
            pass
        time.sleep(0.05)
    component = hal.component('session')
    component.ready()
    try:
        globals()[os.environ['SESSION']]()
    finally:
        pathlib.Path(os.environ['FACTS']).write_text('\n'.join(FACTS) + '\n', encoding='utf-8')


main()
