#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A display that measures the unit of each pin, argument and field for a speed, length, angle, time or ratio.

It uses only Python's linuxcnc and hal, so it measures LinuxCNC in the same way. The machine unit is the inch, so that it differs
from a millimetre. It writes one JSON object: name to [dimension, factor], with the factor to machine units, seconds, degrees,
rev/min or a plain ratio; or a text if the name does not exist.
"""
import json
import os
import re
import socket
import subprocess
import sys
import time

import hal
import linuxcnc

S, C, E = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
FOUND = {}
PROBES = []
ONLY = os.environ.get('UNITS_ONLY', '')


def probe(*names):
    def keep(function):
        PROBES.append((names, function))
        return function
    return keep


def generic(name):
    """Converts joint.0.vel-cmd to joint.N.vel-cmd, and axis.x.jog-scale to axis.L.jog-scale."""
    name = re.sub(r'\b(joint|spindle|ini)\.\d+\.', r'\1.N.', name)
    name = re.sub(r'\b(axis|ini)\.[a-z]\.', r'\1.L.', name)
    return re.sub(r'\b(tooloffset|length_offset)\.[a-z]$', r'\1.L', name)


def found(name, dimension, factor):
    FOUND[generic(name)] = [dimension, factor]


def get(pin):
    return hal.get_value(pin)


def put(pin, value):
    hal.set_p(pin, str(value))


def wait(condition, seconds=5.0):
    end = time.time() + seconds
    while time.time() < end:
        S.poll()
        if condition():
            return True
        time.sleep(0.005)
    return False


def steady(read, seconds=3.0):
    """A value of `read` that is stable for some time and not zero."""
    end, last, same = time.time() + seconds, None, 0
    while time.time() < end:
        value = read()
        same = same + 1 if last is not None and value != 0 and abs(value - last) < 1e-6 * abs(value) else 0
        last = value
        if same >= 8:
            return value
        time.sleep(0.01)
    raise RuntimeError(f'not steady: {last}')


def machine_time():
    """Seconds of the servo thread, which do not depend on the load of the computer."""
    return get('clock.out')


def at_once(read, clock=machine_time):
    """(time, value) read together: repeated if more than 4 ms have passed in between."""
    for _ in range(1000):
        before = clock()
        value = read()
        if clock() - before < 0.004:
            return before, value
    raise RuntimeError('this program is never given 4 ms together')


def mode(wanted):
    C.mode(wanted)
    C.wait_complete(5)
    if wanted == linuxcnc.MODE_MANUAL:
        return
    wait(lambda: S.task_mode == wanted)


def teleop(is_on):
    mode(linuxcnc.MODE_MANUAL)
    C.teleop_enable(1 if is_on else 0)
    C.wait_complete(5)
    wait(lambda: S.motion_mode == (linuxcnc.TRAJ_MODE_TELEOP if is_on else linuxcnc.TRAJ_MODE_FREE))


def mdi(line, seconds=20):
    mode(linuxcnc.MODE_MDI)
    C.mdi(line)
    if seconds:
        C.wait_complete(seconds)
        wait(lambda: S.interp_state == linuxcnc.INTERP_IDLE and S.inpos, seconds)


def still():
    time.sleep(0.1)
    wait(lambda: S.inpos and get('joint.0.vel-cmd') == 0 and get('joint.3.vel-cmd') == 0, 10)


def back(line='G53 G0 X0 Y0 Z0 A0'):
    still()
    mdi('G20 G90 G94')
    mdi(line)


def while_true(pin, read):
    put(pin, 1)
    try:
        return steady(read)
    finally:
        put(pin, 0)
        still()


def press(pin):
    put(pin, 1)
    time.sleep(0.15)
    put(pin, 0)
    time.sleep(0.15)


# ---- halui
SPEED = 60.0


@probe('halui.axis.jog-speed', 'halui.axis.x.increment', 'halui.axis.x.analog')
def halui_axis():
    teleop(True)
    put('halui.axis.jog-speed', SPEED)
    put('halui.axis.x.select', 1)
    time.sleep(0.1)
    put('halui.axis.x.select', 0)
    x, a = (lambda: get('joint.0.vel-cmd')), (lambda: get('joint.3.vel-cmd'))
    found('halui.axis.jog-speed', 'speed', while_true('halui.axis.x.plus', x) / SPEED)
    found('halui.axis.jog-speed (minus)', 'speed', -while_true('halui.axis.x.minus', x) / SPEED)
    found('halui.axis.jog-speed (selected)', 'speed', while_true('halui.axis.selected.plus', x) / SPEED)
    found('halui.axis.jog-speed (rotary)', 'turn', while_true('halui.axis.a.plus', a) / SPEED)
    put('halui.axis.x.analog', 0.5)
    found('halui.axis.x.analog', 'ratio', steady(x) / FOUND['halui.axis.jog-speed'][1] / SPEED / 0.5)
    put('halui.axis.x.analog', 0)
    still()
    teleop(True)
    start = get('joint.0.pos-cmd')
    put('halui.axis.x.increment', 1.5)
    found('halui.axis.jog-speed (increment)', 'speed', while_true('halui.axis.x.increment-plus', x) / SPEED)
    found('halui.axis.x.increment', 'length', (get('joint.0.pos-cmd') - start) / 1.5)
    back()


@probe('halui.joint.jog-speed', 'halui.joint.0.increment', 'halui.joint.0.analog')
def halui_joint():
    teleop(False)
    put('halui.joint.jog-speed', SPEED)
    x, a = (lambda: get('joint.0.vel-cmd')), (lambda: get('joint.3.vel-cmd'))
    put('halui.joint.0.select', 1)
    time.sleep(0.1)
    put('halui.joint.0.select', 0)
    found('halui.joint.jog-speed', 'speed', while_true('halui.joint.0.plus', x) / SPEED)
    found('halui.joint.jog-speed (minus)', 'speed', -while_true('halui.joint.0.minus', x) / SPEED)
    found('halui.joint.jog-speed (selected)', 'speed', while_true('halui.joint.selected.plus', x) / SPEED)
    found('halui.joint.jog-speed (rotary)', 'turn', while_true('halui.joint.3.plus', a) / SPEED)
    put('halui.joint.0.analog', 0.5)
    found('halui.joint.0.analog', 'ratio', steady(x) / FOUND['halui.joint.jog-speed'][1] / SPEED / 0.5)
    put('halui.joint.0.analog', 0)
    still()
    start = get('joint.0.pos-cmd')
    put('halui.joint.0.increment', 1.5)
    found('halui.joint.jog-speed (increment)', 'speed', while_true('halui.joint.0.increment-plus', x) / SPEED)
    found('halui.joint.0.increment', 'length', (get('joint.0.pos-cmd') - start) / 1.5)
    teleop(True)
    back()


def dial(name, read, scale, dimension):
    start = read()
    put(f'halui.{name}.scale', scale)
    press(f'halui.{name}.decrease')
    wait(lambda: abs(read() - start) > 1e-9)
    found(f'halui.{name}.scale', dimension, (start - read()) / scale)
    time.sleep(0.2)
    found(f'halui.{name}.value', dimension, read() / get(f'halui.{name}.value'))
    if name.startswith('spindle'):
        return  # LinuxCNC 2.9 does not count here
    put(f'halui.{name}.count-enable', 1)
    time.sleep(0.2)
    start = read()
    put(f'halui.{name}.counts', -2)
    wait(lambda: abs(read() - start) > 1.5 * scale, 2)
    found(f'halui.{name}.counts', dimension, (start - read()) / (2 * scale))
    put(f'halui.{name}.count-enable', 0)


@probe('halui.feed-override', 'halui.rapid-override', 'halui.spindle.0.override', 'halui.max-velocity')
def halui_dials():
    def poll(read):
        def polled():
            S.poll()
            return read()
        return polled
    dial('feed-override', poll(lambda: S.feedrate), 0.125, 'ratio')
    dial('rapid-override', poll(lambda: S.rapidrate), 0.125, 'ratio')
    dial('spindle.0.override', poll(lambda: S.spindle[0]['override']), 0.125, 'ratio')
    dial('max-velocity', poll(lambda: S.max_velocity), 0.5, 'speed')
    C.feedrate(1)
    C.rapidrate(1)
    C.spindleoverride(1)
    C.maxvel(4)


@probe('halui.axis.x.pos-commanded', 'halui.axis.x.pos-feedback', 'halui.axis.x.pos-relative')
def halui_positions():
    mdi('G20 G0 X2')
    time.sleep(0.3)
    for name in ('halui.axis.x.pos-commanded', 'halui.axis.x.pos-feedback', 'halui.axis.x.pos-relative', 'axis.x.pos-cmd',
                 'joint.0.pos-cmd', 'joint.0.pos-fb', 'joint.0.coarse-pos-cmd'):
        found(name, 'length', 2 / get(name))
    zero = get('joint.0.motor-offset')
    found('joint.0.motor-pos-cmd', 'length', 2 / (get('joint.0.motor-pos-cmd') - zero - get('joint.0.backlash-filt')))
    found('joint.0.motor-pos-fb', 'length', 2 / (get('joint.0.motor-pos-fb') - zero - get('joint.0.backlash-filt')))
    found('joint.0.motor-offset', 'length', (0.125 - 0.375 - 0.125) / zero if zero else 0)
    found('joint.0.f-error-lim', 'length', 0.25 / get('joint.0.f-error-lim'))
    put('lag.in1', 0.125)
    time.sleep(0.1)
    found('joint.1.f-error', 'length', 0.125 / abs(get('joint.1.f-error')))
    put('lag.in1', 0)
    mdi('G21')
    time.sleep(0.3)
    found('halui.axis.x.pos-relative (G21)', 'length', 2 / get('halui.axis.x.pos-relative'))
    mdi('G20 G10 L2 P1 R90')
    mdi('G10 L2 P1 R0')
    found('halui.machine.units-per-mm', 'ratio', get('halui.machine.units-per-mm') * 25.4)
    back()


@probe('halui.tool.diameter', 'halui.tool.length_offset.z')
def halui_tool():
    mdi('G20 G10 L1 P1 Z1.5 R0.125')
    mdi('T1 M6')
    mdi('G43')
    time.sleep(0.3)
    found('halui.tool.diameter', 'length', 0.25 / get('halui.tool.diameter'))
    found('halui.tool.length_offset.z', 'length', 1.5 / get('halui.tool.length_offset.z'))
    found('motion.tooloffset.z', 'length', 1.5 / get('motion.tooloffset.z'))
    S.poll()
    found('stat.tool_offset', 'length', 1.5 / S.tool_offset[2])
    found('stat.tool_table diameter', 'length', 0.25 / S.tool_table[0].diameter)
    found('stat.tool_table zoffset', 'length', 1.5 / S.tool_table[0].zoffset)
    mdi('G49')
    mdi('M61 Q0')
    back()


@probe('halui.spindle.0.increase', 'spindle.0', 'stat.spindle')
def spindle():
    mdi('S600')
    mdi('M3')
    time.sleep(0.3)
    S.poll()
    rpm = 600.0
    found('spindle.0.speed-out', 'rotation', rpm / get('spindle.0.speed-out'))
    found('spindle.0.speed-out-abs', 'rotation', rpm / get('spindle.0.speed-out-abs'))
    found('spindle.0.speed-out-rps', 'rotation', rpm / get('spindle.0.speed-out-rps'))
    found('spindle.0.speed-out-rps-abs', 'rotation', rpm / get('spindle.0.speed-out-rps-abs'))
    found('spindle.0.speed-cmd-rps', 'rotation', rpm / get('spindle.0.speed-cmd-rps'))
    found('stat.spindle speed', 'rotation', rpm / S.spindle[0]['speed'])
    found('stat.settings[2]', 'rotation', rpm / S.settings[2])
    press('halui.spindle.0.increase')
    wait(lambda: get('spindle.0.speed-out') != rpm)
    found('halui.spindle.0.increase (100)', 'rotation', (get('spindle.0.speed-out') - rpm) / 100)
    C.spindle(linuxcnc.SPINDLE_FORWARD, 300.0, 0)
    wait(lambda: get('spindle.0.speed-out') < 400)
    found('command.spindle', 'rotation', get('spindle.0.speed-out') / 300)
    C.spindleoverride(0.5)
    wait(lambda: get('spindle.0.speed-out') < 200)
    found('command.spindleoverride', 'ratio', get('spindle.0.speed-out') / 300 / 0.5)
    wait(lambda: S.spindle[0]['override'] != 1)
    found('stat.spindle override', 'ratio', 0.5 / S.spindle[0]['override'])
    C.spindleoverride(1)
    mdi('M5')
    put('spindle.0.speed-in', 2.0)
    back()
    mdi('G20 G95 F0.25')
    mdi('M3 S600')
    mdi('G1 X3', 0)
    found('spindle.0.speed-in', 'rotation', steady(lambda: get('joint.0.vel-cmd')) / (0.25 * 2.0) * 60)
    still()
    mdi('G94')
    mdi('M5')
    put('spindle.0.is-oriented', 1)
    mdi('M19 R45')
    wait(lambda: get('spindle.0.orient-angle') != 0)
    found('spindle.0.orient-angle', 'angle', 45 / get('spindle.0.orient-angle'))
    mdi('M5')
    back()


@probe('motion.current-vel', 'stat.current_vel')
def path():
    mdi('G20 G90 G94 F90')
    mdi('G1 X8', 0)
    wait(lambda: get('joint.0.vel-cmd') != 0)
    v = steady(lambda: get('joint.0.vel-cmd'))
    t0, x0 = at_once(lambda: get('joint.0.pos-cmd'))
    time.sleep(1.0)
    t1, x1 = at_once(lambda: get('joint.0.pos-cmd'))
    found('joint.0.vel-cmd', 'speed', (x1 - x0) / (t1 - t0) / v)
    for pin in ('motion.current-vel', 'motion.requested-vel', 'motion.feed-upm', 'motion.feed-inches-per-minute',
                'motion.feed-inches-per-second', 'motion.feed-mm-per-minute', 'motion.feed-mm-per-second'):
        found(pin, 'speed', v / get(pin))
    S.poll()
    to_go = 8 - S.position[0]
    found('stat.distance_to_go', 'length', to_go / S.distance_to_go)
    found('stat.dtg', 'length', to_go / S.dtg[0])
    found('motion.distance-to-go', 'length', (8 - get('joint.0.pos-cmd')) / get('motion.distance-to-go'))
    found('stat.current_vel', 'speed', v / S.current_vel)
    found('stat.joint velocity', 'speed', v / S.joint[0]['velocity'])
    found('stat.settings[1]', 'speed', 1.5 / S.settings[1])
    found('stat.position', 'length', get('joint.0.pos-cmd') / S.position[0])
    found('stat.actual_position', 'length', get('joint.0.pos-cmd') / S.actual_position[0])
    found('stat.joint output', 'length', get('joint.0.pos-cmd') / S.joint[0]['output'])
    C.feedrate(0.5)
    wait(lambda: abs(get('joint.0.vel-cmd') - v / 2) < v / 20)
    found('command.feedrate', 'ratio', steady(lambda: get('joint.0.vel-cmd')) / v / 0.5)
    S.poll()
    found('stat.feedrate', 'ratio', 0.5 / S.feedrate)
    C.feedrate(1)
    still()
    mdi('G0 X0', 0)
    wait(lambda: get('joint.0.vel-cmd') != 0)
    v = steady(lambda: get('joint.0.vel-cmd'))
    C.rapidrate(0.25)
    wait(lambda: abs(get('joint.0.vel-cmd') - v / 4) < abs(v) / 20)
    wait(lambda: S.rapidrate != 1)
    found('command.rapidrate', 'ratio', steady(lambda: get('joint.0.vel-cmd')) / v / 0.25)
    S.poll()
    found('stat.rapidrate', 'ratio', 0.25 / S.rapidrate)
    C.rapidrate(1)
    still()
    mdi('M52 P1')
    put('motion.adaptive-feed', 0.5)
    mdi('G1 X4', 0)
    wait(lambda: get('joint.0.vel-cmd') != 0)
    found('motion.adaptive-feed', 'ratio', steady(lambda: get('joint.0.vel-cmd')) / 1.5 / 0.5)
    put('motion.adaptive-feed', 1)
    still()
    mdi('M52 P0')
    back()
    mdi('G21')
    mdi('F1270')
    S.poll()
    found('stat.settings[1] (G21)', 'speed', 1270 / 25.4 / 60 / S.settings[1])
    mdi('G1 X50', 0)
    wait(lambda: get('joint.0.vel-cmd') != 0)
    found('motion.feed-upm (G21)', 'speed', steady(lambda: get('joint.0.vel-cmd')) / get('motion.feed-upm'))
    still()
    mdi('G20')
    mdi('F60')
    back()


@probe('command.jog', 'command.maxvel')
def jogs():
    v = lambda: get('joint.0.vel-cmd')
    teleop(True)
    C.jog(linuxcnc.JOG_CONTINUOUS, 0, 0, 1.5)
    found('command.jog velocity (axis)', 'speed', steady(v) / 1.5)
    for pin in ('axis.x.teleop-vel-cmd', 'axis.x.teleop-vel-lim'):
        found(pin, 'speed', 1.5 / get(pin))
    S.poll()
    found('stat.axis velocity', 'speed', 1.5 / S.axis[0]['velocity'])
    C.jog(linuxcnc.JOG_STOP, 0, 0)
    still()
    start = get('joint.0.pos-cmd')
    C.jog(linuxcnc.JOG_INCREMENT, 0, 0, 1.5, 1.25)
    found('command.jog velocity (increment)', 'speed', steady(v) / 1.5)
    still()
    found('command.jog distance', 'length', (get('joint.0.pos-cmd') - start) / 1.25)
    found('axis.x.teleop-pos-cmd', 'length', get('joint.0.pos-cmd') / get('axis.x.teleop-pos-cmd'))
    C.jog(linuxcnc.JOG_CONTINUOUS, 0, 3, 5.0)
    found('command.jog velocity (rotary)', 'turn', steady(lambda: get('joint.3.vel-cmd')) / 5)
    C.jog(linuxcnc.JOG_STOP, 0, 3)
    still()
    C.maxvel(0.75)
    C.wait_complete(3)
    S.poll()
    found('stat.max_velocity', 'speed', 0.75 / S.max_velocity)
    C.jog(linuxcnc.JOG_CONTINUOUS, 0, 0, 1.5)
    time.sleep(0.3)
    C.jog(linuxcnc.JOG_STOP, 0, 0)
    still()
    mdi('G53 G0 X0', 0)
    wait(lambda: v() != 0)
    found('command.maxvel', 'speed', abs(steady(v)) / 0.75)
    still()
    C.maxvel(4)
    teleop(False)
    C.jog(linuxcnc.JOG_CONTINUOUS, 1, 0, 1.5)
    found('command.jog velocity (joint)', 'speed', steady(v) / 1.5)
    found('joint.0.free-vel-lim', 'speed', 1.5 / get('joint.0.free-vel-lim'))
    C.jog(linuxcnc.JOG_STOP, 1, 0)
    still()
    teleop(True)
    back()


@probe('stat.delay_left', 'command.wait_complete')
def times():
    mdi('G4 P2', 0)
    wait(lambda: S.delay_left > 0)

    def left():
        S.poll()
        return S.delay_left

    start, first = at_once(left, time.monotonic)
    time.sleep(0.7)
    end, last = at_once(left, time.monotonic)
    found('stat.delay_left', 'time', (end - start) / (first - last))
    start = time.time()
    C.wait_complete(0.4)
    found('command.wait_complete', 'time', min(time.time() - start, 3) / 0.4)
    wait(lambda: S.interp_state == linuxcnc.INTERP_IDLE)
    found('stat.cycle_time', 'time', 0.001 / S.cycle_time)


@probe('stat.rotation_xy', 'stat settings')
def settings():
    mdi('G20 G10 L2 P1 X2 R30')
    S.poll()
    found('stat.rotation_xy', 'angle', 30 / S.rotation_xy)
    found('stat.g5x_offset', 'length', 2 / S.g5x_offset[0])
    mdi('G10 L2 P1 X0 R0')
    mdi('G20 G0 A90')
    S.poll()
    found('stat.position (rotary)', 'angle', 90 / S.position[3])
    mdi('G20 G0 A0')
    S.poll()
    found('stat.linear_units', 'ratio', S.linear_units * 25.4)
    found('stat.angular_units', 'ratio', S.angular_units)
    found('stat.max_acceleration', 'acceleration', 40.0 / S.max_acceleration)
    found('stat.joint max_position_limit', 'length', 10.5 / S.joint[0]['max_position_limit'])
    found('stat.joint max_ferror', 'length', 0.5 / S.joint[0]['max_ferror'])
    found('stat.joint min_ferror', 'length', 0.25 / S.joint[0]['min_ferror'])
    found('stat.joint backlash', 'length', 0.001 / S.joint[0]['backlash'])
    found('stat.joint units', 'ratio', S.joint[0]['units'] * 25.4)
    found('stat.axis max_position_limit', 'length', 10.0 / S.axis[0]['max_position_limit'])


INI = {'ini.0.max_velocity': ('speed', 4.0), 'ini.0.max_acceleration': ('acceleration', 40.0), 'ini.0.backlash': ('length', 0.001),
       'ini.0.ferror': ('length', 0.5), 'ini.0.min_ferror': ('length', 0.25), 'ini.0.min_limit': ('length', -10.5),
       'ini.0.max_limit': ('length', 10.5), 'ini.x.max_velocity': ('speed', 4.0), 'ini.x.max_acceleration': ('acceleration', 40.0),
       'ini.x.min_limit': ('length', -10.0), 'ini.x.max_limit': ('length', 10.0), 'ini.a.max_velocity': ('turn', 30.0),
       'ini.traj_max_velocity': ('speed', 4.0), 'ini.traj_default_velocity': ('speed', 1.0),
       'ini.traj_max_acceleration': ('acceleration', 40.0), 'ini.traj_default_acceleration': ('acceleration', 40.0),
       'ini.0.home': ('length', 0.125), 'ini.0.home_offset': ('length', 0.375)}


@probe('ini.')
def ini():
    for name, (dimension, value) in INI.items():
        found(f'{name} (rotary)' if dimension == 'turn' else name, dimension, value / get(name))
    teleop(True)
    put('ini.x.max_velocity', 0.5)
    time.sleep(0.3)
    C.jog(linuxcnc.JOG_CONTINUOUS, 0, 0, 3.0)
    found('ini.x.max_velocity (bound)', 'speed', steady(lambda: get('joint.0.vel-cmd')) / 0.5)
    C.jog(linuxcnc.JOG_STOP, 0, 0)
    put('ini.x.max_velocity', 4)
    time.sleep(0.3)
    still()
    back()


@probe('axis.x.jog-scale')
def wheels():
    for of, index in (('axis.x', True), ('joint.0', False)):
        teleop(index)
        put(f'{of}.jog-scale', 0.01)
        put(f'{of}.jog-enable', 1)
        time.sleep(0.1)
        start = get('joint.0.pos-cmd')
        put(f'{of}.jog-counts', 50)
        time.sleep(0.3)
        still()
        found(f'{of}.jog-scale', 'length', (get('joint.0.pos-cmd') - start) / 0.5)
        put(f'{of}.jog-accel-fraction', 0.25)
        put(f'{of}.jog-counts', 400)
        times, acceleration, end = {}, 0.0, time.time() + 2
        while time.time() < end and 1.2 not in times:
            instant, velocity = at_once(lambda: get('joint.0.vel-cmd'))
            for speed in (0.2, 1.2):
                if speed not in times and velocity >= speed:
                    times[speed] = (instant, velocity)
            acceleration = max(acceleration, get('joint.0.acc-cmd'))
        (t0, v0), (t1, v1) = times[0.2], times[1.2]
        found(f'{of}.jog-accel-fraction', 'ratio', (v1 - v0) / (t1 - t0) / (40 * 0.25))
        if index:
            found('joint.0.acc-cmd', 'acceleration', 10 / acceleration)
        still()
        put(f'{of}.jog-enable', 0)
        put(f'{of}.jog-accel-fraction', 1)
        teleop(True)
        back()


@probe('halui.axis.jog-deadband', 'halui.joint.jog-deadband')
def deadbands():
    for group, stick, is_teleop in (('halui.axis', 'halui.axis.x.analog', True), ('halui.joint', 'halui.joint.0.analog', False)):
        teleop(is_teleop)
        put(f'{group}.jog-speed', SPEED)
        moves = []
        for deadband in (0.6, 0.4):
            put(f'{group}.jog-deadband', deadband)
            time.sleep(0.1)
            put(stick, 0.5)
            time.sleep(0.3)
            moves.append(get('joint.0.vel-cmd') != 0)
            put(stick, 0)
            still()
        put(f'{group}.jog-deadband', 0.2)
        found(f'{group}.jog-deadband', 'ratio', 1 if moves == [False, True] else 0)
    teleop(True)
    back()


class Line:
    """A text client."""

    def __init__(self, port):
        end = time.time() + 15
        while True:
            try:
                self.socket = socket.create_connection(('127.0.0.1', port), 3)
                break
            except OSError:
                if time.time() > end:
                    raise
                time.sleep(0.1)
        self.socket.settimeout(0.5)

    def ask(self, text):
        self.socket.sendall(text.encode() + b'\r\n')
        time.sleep(0.25)
        answer, end = '', time.time() + 3
        while time.time() < end:
            try:
                answer += self.socket.recv(4096).decode()
            except socket.timeout:
                pass
            if not text.startswith('get') or len(answer.split('\n')) > 2:
                break  # LinuxCNC 2.9 repeats the line before the answer
        return answer


def tail(text):
    """The last number of an answer."""
    words = [w for w in text.replace('%', ' ').split() if w.replace('.', '').replace('-', '').isdigit()]
    if not words:
        raise RuntimeError(f'no number in {text!r}')
    return float(words[-1])


@probe('linuxcncrsh')
def rsh():
    with subprocess.Popen(['linuxcncrsh', '--port', '15007', '--', '-ini', os.environ['INI_FILE_NAME']], stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        try:
            line = Line(15007)
            for text in ('hello EMC x 1.0', 'set enable EMCTOO', 'set set_wait received'):
                line.ask(text)
            teleop(False)
            v = lambda: get('joint.0.vel-cmd')
            line.ask(f'set jog 0 {SPEED}')
            found('linuxcncrsh jog', 'speed', steady(v) / SPEED)
            line.ask(f'set jog_stop 0')
            still()
            start = get('joint.0.pos-cmd')
            line.ask(f'set jog_incr 0 {SPEED} 1.5')
            found('linuxcncrsh jog_incr', 'speed', steady(v) / SPEED)
            still()
            found('linuxcncrsh jog_incr distance', 'length', (get('joint.0.pos-cmd') - start) / 1.5)
            line.ask('set feed_override 50')
            S.poll()
            found('linuxcncrsh feed_override', 'ratio', S.feedrate / 50)
            found('linuxcncrsh get feed_override', 'ratio', S.feedrate / tail(line.ask('get feed_override')))
            C.spindleoverride(0.5)
            C.wait_complete(3)
            S.poll()
            found('linuxcncrsh get spindle_override', 'ratio', 0.5 / tail(line.ask('get spindle_override 0')))
            found('linuxcncrsh get abs_cmd_pos', 'length', get('joint.0.pos-cmd') / tail(line.ask('get abs_cmd_pos X')))
            found('linuxcncrsh get joint_pos', 'length', get('joint.0.pos-cmd') / tail(line.ask('get joint_pos 0')))
            line.ask('set spindle_override 25')
            if wait(lambda: S.spindle[0]['override'] != 0.5, 1):  # LinuxCNC 2.9 has no effect here
                found('linuxcncrsh spindle_override', 'ratio', S.spindle[0]['override'] / 25)
            C.feedrate(1)
            C.spindleoverride(1)
        finally:
            server.kill()
    back()


TCL = """package require Linuxcnc
emc_init -ini $env(INI_FILE_NAME)
proc say {args} {puts [join $args " "]; flush stdout}
while {[gets stdin line] >= 0} { if {[catch {say [eval $line]} why]} {say error: $why} }
"""


@probe('Tcl')
def tcl():
    with open('units.tcl', 'w', encoding='utf-8') as file:
        file.write('load /usr/lib/tcltk/linuxcnc/linuxcnc.so\n' + TCL.split('\n', 1)[1]
                   if os.environ.get('UNITS_PEER') else TCL)
    with subprocess.Popen(['tclsh', 'units.tcl'], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                          stderr=subprocess.STDOUT) as shell:
        def ask(text):
            shell.stdin.write(text + '\n')
            shell.stdin.flush()
            return shell.stdout.readline().strip()
        teleop(True)
        v = lambda: get('joint.0.vel-cmd')
        ask('emc_update')
        ask('emc_set_wait received')
        ask(f'emc_jog 0 0 {SPEED}')
        found('Tcl emc_jog', 'speed', steady(v) / SPEED)
        ask('emc_jog_stop 0 0')
        still()
        start = get('joint.0.pos-cmd')
        ask(f'emc_jog_incr 0 0 {SPEED} 1.5')
        found('Tcl emc_jog_incr', 'speed', steady(v) / SPEED)
        still()
        found('Tcl emc_jog_incr distance', 'length', (get('joint.0.pos-cmd') - start) / 1.5)
        for name, read in (('emc_feed_override', lambda: S.feedrate), ('emc_rapid_override', lambda: S.rapidrate),
                           ('emc_spindle_override', lambda: S.spindle[0]['override'])):
            ask(f'{name} 50')
            time.sleep(0.3)
            S.poll()
            found(f'Tcl {name}', 'ratio', read() / 50)
            found(f'Tcl {name} (get)', 'ratio', read() / tail(ask(name)))
        found('Tcl emc_abs_cmd_pos', 'length', get('joint.0.pos-cmd') / tail(ask('emc_abs_cmd_pos X')))
        found('Tcl emc_joint_pos', 'length', get('joint.0.pos-cmd') / tail(ask('emc_joint_pos 0')))
        C.feedrate(1)
        C.rapidrate(1)
        C.spindleoverride(1)
        shell.kill()
    back()


@probe('schedrmt')
def schedule():
    with open('units.ngc', 'w', encoding='utf-8') as file:
        file.write('G20 G90 F60\nM3 S600\nG1 X2\nM2\n')
    with subprocess.Popen(['schedrmt', '--port', '15008', '--', '-ini', os.environ['INI_FILE_NAME']], stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        try:
            line = Line(15008)
            line.ask('hello EMC x 1.0')
            line.ask('set enable EMCTOO')
            line.ask(f'set pgmadd 1 1 0 0 0 0 {os.getcwd()}/units.ngc 50 25 0')
            line.ask('set qmode run')
            if wait(lambda: abs(S.feedrate - 1) > 0.01, 6):
                time.sleep(0.5)
                S.poll()
                found('schedrmt pgmadd feed override', 'ratio', S.feedrate / 50)
                found('schedrmt pgmadd spindle override', 'ratio', S.spindle[0]['override'] / 25)
            line.ask('set qmode stop')
        finally:
            server.kill()
    C.abort()
    C.wait_complete(3)
    C.feedrate(1)
    C.spindleoverride(1)
    back()


@probe('axis.y.eoffset')
def offsets():
    teleop(True)
    put('axis.y.eoffset-scale', 0.125)
    put('axis.y.eoffset-enable', 1)
    time.sleep(0.1)
    put('axis.y.eoffset-counts', 4)
    time.sleep(1.5)
    found('axis.y.eoffset-request', 'length', 0.5 / get('axis.y.eoffset-request'))
    found('axis.y.eoffset', 'length', 0.5 / get('axis.y.eoffset'))
    found('axis.y.eoffset-scale', 'length', get('joint.1.pos-cmd') / 0.5)
    put('axis.y.eoffset-clear', 1)
    time.sleep(1.5)
    put('axis.y.eoffset-clear', 0)
    put('axis.y.eoffset-enable', 0)
    time.sleep(0.2)


def float_pins():
    """Pins of the type float of motion, halui and ini."""
    names = {generic(pin['NAME']) for pin in hal.get_info_pins() if pin['TYPE'] == hal.HAL_FLOAT}
    ours = {name for name in names if re.match(r'(halui|motion|joint|axis|spindle|ini)\.', name)}
    return {name.replace('-', '_') if name.startswith('ini.') else name for name in ours}


def main():
    component = hal.component('units')  # HAL answers as long as it exists
    component.ready()
    for _ in range(100):
        try:
            S.poll()
            if S.joints:
                break
        except linuxcnc.error:
            pass
        time.sleep(0.1)
    C.state(linuxcnc.STATE_ESTOP_RESET)
    C.wait_complete(3)
    C.state(linuxcnc.STATE_ON)
    C.wait_complete(3)
    C.home(-1)
    C.wait_complete(5)
    wait(lambda: all(S.homed[:4]), 10)
    back()
    for names, function in PROBES:
        if ONLY and not any(one in name for name in names for one in ONLY.split(',')):
            continue
        try:
            function()
        except Exception as error:  # pylint: disable=broad-except
            FOUND[f'{function.__name__} failed'] = f'{type(error).__name__}: {error} line {error.__traceback__.tb_next and error.__traceback__.tb_next.tb_lineno}'
            while (message := E.poll()) is not None:
                FOUND[f'{function.__name__} failed'] += f'; {message[1]}'
            C.abort()
            C.wait_complete(3)
            C.state(linuxcnc.STATE_ON)
            C.wait_complete(3)
    FOUND['pins'] = sorted(float_pins())
    with open(os.environ['UNITS_OUT'], 'w', encoding='utf-8') as file:
        json.dump(FOUND, file, indent=1)


if __name__ == '__main__':
    main()
    sys.exit(0)
