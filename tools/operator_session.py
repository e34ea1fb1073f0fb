#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The display of a simulated machine that acts as a random operator; compare_operator.py starts it.

Environment: OPERATOR_SEEDS "first:count", OPERATOR_OUT a file, OPERATOR_MACHINE its name, OPERATOR_ACTS a JSON list of acts
instead of random ones. After each act, when the status is stable, one line of JSON is written: seed, number, act, result of
wait_complete(), the status, whether a message was received. It uses only public interfaces: the Python module linuxcnc, pins of
halui by halcmd, linuxcncrsh by TCP.
"""
import json
import os
import pathlib
import random
import socket
import subprocess
import sys
import time

import linuxcnc

STAT, COMMAND, ERRORS = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
HERE = pathlib.Path.cwd()
MACHINE = os.environ['OPERATOR_MACHINE']
RSH_PORT = 5007

# name: (text, lines with a move of at least a second, at which a program can be stopped)
PROGRAMS = {
    'moves': ('G21 G90 G64\nG0 X1\nG1 X3 F3000\nG1 X0\nM2\n', ()),
    'modal': ('G21 G90 G17 G54\nG55 F3000\nG1 X2\nG91\nG1 X1\nG90 G54\nM8\nG1 X0\nM9\nM2\n', ()),
    'ahead': ('G21 G90 G54 F3000\nG1 X0\nG1 X20 F300\nG10 L2 P1 X5\nG92 X1\nG43.1 Z2\nG91\nG20\nM64 P0\nM8\nS700\n#31=7\nG1 X1 F10\nM2\n', (3,)),
    'ahead2': ('G21 G90 F3000\nG1 X0\nS400 M3\nG55 G1 X20 F200\nG56 G61\nM7\nS900 F99\nG1 X0\nM2\n', (4,)),
    'spin': ('G21 G90\nM3 S400\nG1 X2 F3000\nM4 S300\nG1 X0\nM5\nM2\n', ()),
    'stop': ('G21 G90 F3000\nG1 X2\nM0\nG1 X4\nM1\nG1 X0\nM2\n', ()),
    'blocks': ('G21 G90 F3000\nG1 X1\n/G1 X5\n/G1 X6\nG1 X0\nM2\n', ()),
    'loop': ('#1=0\no100 repeat [3]\nG1 X[#1] F3000\n#1=[#1+1]\no100 endrepeat\nG1 X0\nM2\n', ()),
    'sub': ('o<s> sub\nG1 X#1\n#1=9\no<s> endsub\nG21 G90 F3000\n#1=4\no<s> call [2]\nG1 X[#1/4]\nM2\n', ()),
    'insub': ('o<s> sub\nG91\nG1 X20 F300\nG90\no<s> endsub\nG21 G90 F3000\nG1 X0\no<s> call\nF50\nM2\n', (3,)),
    'dwell': ('G21 G90\nG1 X1 F3000\nG4 P0.3\nG1 X0\nM2\n', ()),
    'bad': ('G21 G90\nG1 X1 F3000\nG1 X2 Q\nG1 X0\nM2\n', ()),
    'out': ('G21 G90\nM62 P0\nG1 X1 F3000\nM63 P0\nM68 E0 Q2.5\nG1 X0\nM67 E0 Q0\nM2\n', ()),
    'tool': ('G21 G90\nT2 M6 G43\nG1 X1 F3000\nT1 M6\nG49\nG1 X0\nM2\n', ()),
    'end30': ('G20 G91 F600 S100\nG1 X0.1\nM30\n', ()),
    'percent': ('%\nG21 G90\nG1 X1 F3000\n%\n', ()),
}
MDI = ['G0 X0', 'G1 X2 F3000', 'G91 G1 X0.5 F1800', 'G90', 'G55', 'G54', 'G10 L2 P1 X0.5', 'G10 L20 P1 X0', 'G10 L2 P1 X0 Z0 R0',
       'G92 X1', 'G92.1', 'G92.2', 'G92.3', 'M3 S500', 'M5', 'M4 S250', 'M7', 'M8', 'M9', 'T1 M6', 'T2 M6', 'T0 M6', 'G43', 'G49', 'G20',
       'G21', 'F800', 'S600', 'M48', 'M49', 'M50 P0', 'M50 P1', 'M51 P1', 'M52 P0', 'M53 P0', 'M53 P1', 'M62 P1', 'M63 P1', 'M64 P0', 'M65 P0',
       'M68 E0 Q1', 'G4 P0.2', 'G95 F0.1', 'G94', 'G93', 'G61', 'G61.1', 'G64', 'G64 P0.1', 'G18', 'G17', 'G28', 'G30', 'X', 'G1 X1000',
       'G40', '(MSG, hello)', '#5=3', 'G0 X#5', 'G52 X1', 'G52 X0', 'G53 G0 X0', 'G98', 'G99', 'G7', 'G8', 'G80', 'G91.1', 'G90.1',
       'M61 Q1', 'M0', 'G96 D1000 S100', 'G97 S0', 'M6', 'T1', 'G10 L1 P1 Z3', 'G43 H2']


def poll():
    for _ in range(100):
        try:
            STAT.poll()
            return
        except linuxcnc.error:
            time.sleep(0.05)


def rounded(values, digits=4):
    return [round(value, digits) + 0.0 for value in values]


def picture():
    poll()
    s = STAT
    spindles = [dict(direction=n['direction'], speed=round(n['speed'], 2), override=round(n['override'], 3), on=int(n['enabled']),
                     override_on=int(n['override_enabled'])) for n in s.spindle[:s.spindles]]
    return dict(mode=s.task_mode, state=s.task_state, interp=s.interp_state, exec=s.exec_state, paused=int(bool(s.paused)),
                task_paused=int(s.task_paused), position=rounded(s.position[:4]), g5x=s.g5x_index, g5x_offset=rounded(s.g5x_offset[:4]),
                g92=rounded(s.g92_offset[:4]), tool_offset=rounded(s.tool_offset[:3]), rotation=round(s.rotation_xy, 3),
                gcodes=list(s.gcodes[1:]), mcodes=list(s.mcodes[1:]), F=round(s.settings[1], 4), S=round(s.settings[2], 4),
                P=round(s.settings[3], 4), spindles=spindles, flood=s.flood, mist=s.mist, tool=s.tool_in_spindle,
                prepared=s.pocket_prepped, feed=round(s.feedrate, 3), rapid=round(s.rapidrate, 3), block_delete=int(s.block_delete),
                optional_stop=int(s.optional_stop), homed=list(s.homed[:s.joints]), motion_mode=s.motion_mode,
                feed_override_on=int(s.feed_override_enabled), feed_hold=int(s.feed_hold_enabled),
                adaptive=int(s.adaptive_feed_enabled), motion_line=s.motion_line, read_line=s.read_line,
                file=os.path.basename(s.file), queue=s.queue, in_position=int(s.inpos), rcs=s.state, enabled=int(s.enabled),
                analog=round(s.aout[0], 3), digital=list(s.dout[:2]), units=s.program_units, dwell=round(s.delay_left, 1),
                max_velocity=round(s.max_velocity, 3), error_code=s.interpreter_errcode)


def settle(limit=6.0):
    end, last, same = time.monotonic() + limit, None, 0
    while time.monotonic() < end:
        shown = picture()
        key = json.dumps(shown)
        same = same + 1 if key == last else 0
        last = key
        if same >= 6:
            return shown
        time.sleep(0.03)
    shown['unsettled'] = 1
    return shown


def messages():
    """Pairs of kind and text received since the last call."""
    found = []
    while True:
        message = ERRORS.poll()
        if not message:
            return found
        found.append(message)


def mode(wanted):
    COMMAND.mode(wanted)
    COMMAND.wait_complete(3)


def halui(pin):
    for value in ('1', '0'):
        subprocess.run(['halcmd', 'setp', 'halui.' + pin, value], capture_output=True, check=False)
        time.sleep(0.12)


class Rsh:
    """linuxcncrsh, started at the first request."""

    def __init__(self):
        self.socket = None

    def tell(self, *lines):
        if self.socket is None:
            ini = sys.argv[sys.argv.index('-ini') + 1] if '-ini' in sys.argv else os.environ['INI_FILE_NAME']
            subprocess.Popen(['linuxcncrsh', '--', '-ini', ini], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            for _ in range(100):
                try:
                    self.socket = socket.create_connection(('127.0.0.1', RSH_PORT), timeout=2)
                    break
                except OSError:
                    time.sleep(0.05)
            self.socket.sendall(b'hello EMC operator 1.0\r\nset enable EMCTOO\r\nset wait_mode received\r\n')
            time.sleep(0.2)
        for line in lines:
            self.socket.sendall(line.encode() + b'\r\n')
            time.sleep(0.15)


RSH = Rsh()


def random_act(r):
    k = r.random()
    if k < 0.34:
        return ['mdi', r.choice(MDI)]
    if k < 0.50:
        return ['run', r.choice(sorted(n for n, p in PROGRAMS.items() if not p[1]))]
    if k < 0.62:
        return [r.choice(['stop', 'stop', 'pause']), r.choice(sorted(n for n, p in PROGRAMS.items() if p[1])),
                r.choice(['abort', 'abort', 'off', 'estop', 'halui', 'rsh'])]
    if k < 0.66:
        return ['step', r.choice(['moves', 'loop', 'sub', 'dwell', 'stop', 'tool', 'out']), r.choice(['python', 'halui', 'rsh'])]
    if k < 0.70:
        return [r.choice(['resume', 'abort', 'pause_now'])]
    if k < 0.75:
        return ['mode', r.choice([1, 2, 3])]
    if k < 0.80:
        return ['jog', r.choice([-1, 1, 0.5])]
    if k < 0.84:
        return ['state', r.choice([linuxcnc.STATE_ESTOP, linuxcnc.STATE_OFF])]
    if k < 0.92:
        return [r.choice(['feed', 'rapid', 'spindle_override']), r.choice([0.5, 1.0])]
    if k < 0.96:
        return [r.choice(['block_delete', 'optional_stop']), r.choice([0, 1])]
    return [r.choice(['flood', 'mist', 'spindle', 'table', 'max_velocity', 'halui_flood', 'halui_mist', 'rsh_flood', 'unhome'])]


def open_program(name):
    poll()
    if STAT.interp_state != linuxcnc.INTERP_IDLE:
        COMMAND.abort()
        COMMAND.wait_complete(3)
    mode(linuxcnc.MODE_AUTO)
    COMMAND.program_open(str(HERE / f's_{name}.ngc'))
    COMMAND.wait_complete(3)


def wait_for_line(line):
    """Waits until the move of that line has progressed well."""
    end = time.monotonic() + 5
    while time.monotonic() < end:
        poll()
        if STAT.motion_line == line and STAT.position[0] > 2 and STAT.current_vel > 1:
            time.sleep(0.2)
            return
        time.sleep(0.005)


def stop(how):
    if how == 'abort':
        COMMAND.abort()
    elif how == 'halui':
        halui('abort')
    elif how == 'rsh':
        RSH.tell('set abort')
    else:
        COMMAND.state(linuxcnc.STATE_OFF if how == 'off' else linuxcnc.STATE_ESTOP)


def switch_on():
    COMMAND.state(linuxcnc.STATE_ESTOP_RESET)
    COMMAND.wait_complete(3)
    COMMAND.state(linuxcnc.STATE_ON)
    COMMAND.wait_complete(3)


def home_all():
    mode(linuxcnc.MODE_MANUAL)
    COMMAND.teleop_enable(0)
    COMMAND.wait_complete(3)
    COMMAND.home(-1)
    end = time.monotonic() + 5
    poll()
    while not all(STAT.homed[:STAT.joints]) and time.monotonic() < end:
        time.sleep(0.05)
        poll()


def do(act):
    k = act[0]
    if k == 'mdi':
        mode(linuxcnc.MODE_MDI)
        COMMAND.mdi(act[1])
    elif k == 'run':
        open_program(act[1])
        COMMAND.auto(linuxcnc.AUTO_RUN, 0)
        time.sleep(0.3)
    elif k in ('stop', 'pause'):
        open_program(act[1])
        COMMAND.auto(linuxcnc.AUTO_RUN, 0)
        wait_for_line(PROGRAMS[act[1]][1][0])
        if k == 'pause':
            COMMAND.auto(linuxcnc.AUTO_PAUSE)
            time.sleep(0.5)
            return 0
        stop(act[2])
    elif k == 'step':
        open_program(act[1])
        for _ in range(40):
            {'python': lambda: COMMAND.auto(linuxcnc.AUTO_STEP), 'halui': lambda: halui('program.step'),
             'rsh': lambda: RSH.tell('set step')}[act[2]]()
            time.sleep(0.25)
            poll()
            if STAT.interp_state == linuxcnc.INTERP_IDLE:
                break
        mode(linuxcnc.MODE_MDI)  # LinuxCNC leaves the pause of a stepped program when the mode changes
    elif k == 'resume':
        COMMAND.auto(linuxcnc.AUTO_RESUME)
    elif k == 'pause_now':
        COMMAND.auto(linuxcnc.AUTO_PAUSE)
    elif k == 'abort':
        COMMAND.abort()
    elif k == 'mode':
        COMMAND.mode(act[1])
    elif k == 'jog':
        mode(linuxcnc.MODE_MANUAL)
        COMMAND.teleop_enable(1)
        COMMAND.wait_complete(3)
        COMMAND.jog(linuxcnc.JOG_INCREMENT, 0, 0, 30.0, act[1])
    elif k == 'state':
        COMMAND.state(act[1])
        COMMAND.wait_complete(3)
        time.sleep(0.2)
        switch_on()
    elif k == 'feed':
        COMMAND.feedrate(act[1])
    elif k == 'rapid':
        COMMAND.rapidrate(act[1])
    elif k == 'spindle_override':
        COMMAND.spindleoverride(act[1])
    elif k == 'block_delete':
        COMMAND.set_block_delete(act[1])
    elif k == 'optional_stop':
        COMMAND.set_optional_stop(act[1])
    elif k == 'flood':
        COMMAND.flood(linuxcnc.FLOOD_ON)
    elif k == 'mist':
        COMMAND.mist(linuxcnc.MIST_ON)
    elif k == 'spindle':
        COMMAND.spindle(linuxcnc.SPINDLE_FORWARD, 350)
    elif k == 'table':
        COMMAND.load_tool_table()
    elif k == 'max_velocity':
        COMMAND.maxvel(50.0)
    elif k == 'halui_flood':
        halui('flood.on')
    elif k == 'halui_mist':
        halui('mist.on')
    elif k == 'rsh_flood':
        RSH.tell('set flood on')
    elif k == 'unhome':
        mode(linuxcnc.MODE_MANUAL)
        COMMAND.teleop_enable(0)
        COMMAND.wait_complete(3)
        COMMAND.unhome(-1)
        COMMAND.wait_complete(3)
        home_all()
    return COMMAND.wait_complete(3.0)


RESET = ['G21 G90 G94 G17 G40 G49 G64 G97 G80 G91.1 G99 G8 M5 M9 M48', 'M52 P0', 'M53 P1', 'G54 G92.1', 'G10 L2 P1 X0 Z0 R0', 'G10 L2 P2 X0 Z0',
         'G10 L2 P3 X0 Z0', 'G10 L1 P1 Z0', 'M65 P0', 'M65 P1', 'M68 E0 Q0', '#5=0 #31=0', 'F1000', 'S0', 'T0 M6', 'G53 G0 X0 Z0', 'G10 L2 P1 X0']


def reset():
    COMMAND.abort()
    COMMAND.wait_complete(3)
    switch_on()
    poll()
    if not all(STAT.homed[:STAT.joints]):
        home_all()
    COMMAND.feedrate(1.0)
    COMMAND.rapidrate(1.0)
    COMMAND.spindleoverride(1.0)
    COMMAND.set_block_delete(0)
    COMMAND.set_optional_stop(0)
    COMMAND.maxvel(100.0)
    mode(linuxcnc.MODE_MDI)
    for line in RESET:
        COMMAND.mdi(line)
        COMMAND.wait_complete(5)
    mode(linuxcnc.MODE_MANUAL)
    settle()
    messages()


# Acts after which the systems may differ on purpose (operator_differences.INTENDED) or by timing, in a state
# that later acts use.
UNSURE = ('stop', 'pause', 'abort', 'pause_now', 'resume', 'state')


def is_unsure(row, was_idle):
    has_failed = any(kind in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR) for kind, _ in row['messages'])
    return row['act'][0] in UNSURE or has_failed or (row['act'][0] == 'mode' and not was_idle)


def after_stop():
    """Moves the machine to a position and to modes that both systems know."""
    poll()
    if STAT.task_state != linuxcnc.STATE_ON:
        switch_on()
    COMMAND.abort()
    COMMAND.wait_complete(3)
    mode(linuxcnc.MODE_MDI)
    for line in ('G90 G21 G94 G17 G49 G97 G80 G99 G8 M5 M9', 'F1000 S0', 'G54 G92.1 G64', 'G10 L2 P1 X0', 'G53 G0 X0'):
        COMMAND.mdi(line)
        COMMAND.wait_complete(5)


def main():
    for name, (text, _) in PROGRAMS.items():
        (HERE / f's_{name}.ngc').write_text(text, encoding='ascii')
    end = time.monotonic() + 20
    while time.monotonic() < end:
        try:
            STAT.poll()
            if STAT.joints > 0 and STAT.task_state > 0:
                break
        except linuxcnc.error:
            pass
        time.sleep(0.1)
    switch_on()
    home_all()
    first, count = map(int, os.environ['OPERATOR_SEEDS'].split(':'))
    given = json.loads(os.environ['OPERATOR_ACTS']) if os.environ.get('OPERATOR_ACTS') else None
    with open(os.environ['OPERATOR_OUT'], 'a', encoding='ascii') as out:
        for seed in range(first, first + count):
            r = random.Random(f'{MACHINE} {seed}')
            reset()
            acts = given or [random_act(r) for _ in range(7)]
            rows = [(['start'], lambda: 0)] + [(act, None) for act in acts]
            for number, (act, work) in enumerate(rows):
                poll()
                was_idle = STAT.interp_state == linuxcnc.INTERP_IDLE
                try:
                    ended = work() if work else do(act)
                except (linuxcnc.error, ValueError, TypeError, OSError) as error:
                    ended = type(error).__name__
                row = dict(seed=seed, n=number, act=act, ret=ended, shown=settle(), messages=messages())
                out.write(json.dumps(row) + '\n')
                out.flush()
                if is_unsure(row, was_idle):
                    after_stop()
                    row = dict(seed=seed, n=number + 0.5, act=['after', *act], ret=0, shown=settle(), messages=messages())
                    out.write(json.dumps(row) + '\n')
                    out.flush()


main()
