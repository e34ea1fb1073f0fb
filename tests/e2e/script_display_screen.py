#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The display of script_display.py: the check to run is the last or second last word."""
import os
import pathlib
import signal
import sys
import time

import linuxcnc

INSTANCE = f"MILLWRIGHT_INSTANCE={os.environ['MILLWRIGHT_INSTANCE']}".encode()
s, c, e = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()

# Every attribute with its type, or the type and length of a tuple.
ATTRIBUTES = {
    int: 'echo_serial_number state task_mode task_state exec_state interp_state call_level read_line motion_line '
         'current_line program_units interpreter_errcode task_paused input_timeout queued_mdi_commands joints '
         'num_extrajoints spindles axis_mask motion_mode queue active_queue motion_id probe_val kinematics_type '
         'motion_type pocket_prepped tool_in_spindle tool_from_pocket mist flood lube lube_level estop debug g5x_index '
         'heartbeat taskbeat',
    float: 'rotation_xy delay_left linear_units angular_units cycle_time feedrate rapidrate velocity acceleration '
           'max_velocity max_acceleration distance_to_go current_vel',
    bool: 'optional_stop block_delete enabled inpos queue_full paused single_stepping probe_tripped probing '
          'feed_override_enabled adaptive_feed_enabled feed_hold_enabled',
    str: 'file command ini_filename',
}
TUPLES = {
    (float, 9): 'g5x_offset g92_offset tool_offset position actual_position dtg probed_position',
    (float, 16): 'joint_position joint_actual_position',
    (int, 16): 'homed limit',
    (float, 64): 'ain aout',
    (int, 64): 'din dout misc_error',
    (int, 17): 'gcodes',
    (int, 10): 'mcodes',
    (float, 5): 'settings',
    (dict, 16): 'joint',
    (dict, 9): 'axis',
    (dict, 8): 'spindle',
}
JOINT = {
    float: 'units backlash min_position_limit max_position_limit max_ferror min_ferror ferror_current ferror_highmark '
           'output input velocity',
    int: 'jointType inpos homing homed fault enabled min_soft_limit max_soft_limit min_hard_limit max_hard_limit '
         'override_limits',
}
AXIS = {float: 'velocity min_position_limit max_position_limit'}
SPINDLE = {int: 'brake direction enabled orient_state orient_fault', float: 'speed override',
           bool: 'override_enabled homed'}


def check_keys(found, table):
    expected = {name: kind for kind, names in table.items() for name in names.split()}
    assert set(found) == set(expected), set(found) ^ set(expected)
    for name, kind in expected.items():
        assert type(found[name]) is kind, (name, found[name])


def wait_for(condition, what):
    end = time.monotonic() + 10
    while time.monotonic() < end:
        s.poll()
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError(f'{what}: {s.task_state=} {s.task_mode=} {s.interp_state=} {s.state=} {s.position=}')


def status():
    assert s.joints == 0 and s.tool_table == () and s.position == (0.0,) * 9, 'nothing before the first poll'
    s.poll()
    names = {'tool_table'}
    for kind, words in ATTRIBUTES.items():
        for name in words.split():
            names.add(name)
            assert type(getattr(s, name)) is kind, (name, getattr(s, name))
    for (kind, count), words in TUPLES.items():
        for name in words.split():
            names.add(name)
            value = getattr(s, name)
            assert type(value) is tuple and len(value) == count and all(type(v) is kind for v in value), (name, value)
    public = {name for name in dir(s) if not name.startswith('_')} - {'poll', 'toolinfo'}
    assert public == names, public ^ names
    for table, rows in ((JOINT, s.joint), (AXIS, s.axis), (SPINDLE, s.spindle)):
        for row in rows:
            check_keys(row, table)
    try:
        s.axis_mask = 1
        raise SystemExit('attributes can be set')
    except AttributeError:
        pass
    assert (s.joints, s.axis_mask, s.spindles, s.kinematics_type) == (3, 7, 1, linuxcnc.KINEMATICS_IDENTITY)
    assert (s.linear_units, s.angular_units, s.cycle_time) == (1.0, 1.0, 0.001)
    assert s.max_velocity == 200 and s.max_acceleration == 1500 and s.program_units == 2
    limits = [joint['max_position_limit'] for joint in s.joint[:4]]
    assert limits == [251.0, 201.0, 101.0, 1.0], limits
    assert s.ini_filename == os.environ['INI_FILE_NAME'] and os.path.isdir(os.environ['CONFIG_DIR'])
    assert s.g5x_index == 1 and s.g5x_offset[0] == 0.5, 'the active offset before any program has run'
    tool = s.tool_table[1]
    assert tool.id == tool[0] and len(tool) == 14 and tool.diameter == s.toolinfo(tool.id)['diameter']
    for number in (0, 98765):
        try:
            s.toolinfo(number)
            raise SystemExit('there is no such tool')
        except ValueError:
            pass


def words():
    for name in ('HALCMD', 'REALTIME', 'HALLIB_DIR', 'HALLIB_PATH', 'LINUXCNC_HOME', 'LINUXCNCVERSION', 'NMLFILE',
                 'TRAJ_COORDINATES', 'KINS_KINEMATICS'):
        assert os.environ.get(name), name
    assert sys.argv[1] == '-ini' and sys.argv[2] == os.environ['INI_FILE_NAME'] and sys.argv[3] == 'first', sys.argv
    assert os.getcwd() == os.environ['CONFIG_DIR']
    for call in (lambda: c.mode(9), lambda: c.state(0), lambda: c.mdi('G1 X1 ' * 60)):
        try:
            call()
            raise SystemExit('that cannot be')
        except ValueError:
            pass
    for call in (lambda: c.jog(linuxcnc.JOG_CONTINUOUS, 1, 0), lambda: c.jog(linuxcnc.JOG_STOP, 1, 0, 5.0)):
        try:
            call()
            raise SystemExit('too few or too many words')
        except TypeError:
            pass
    try:
        c.auto(linuxcnc.AUTO_RUN)
        raise SystemExit('no line')
    except linuxcnc.error:
        pass
    assert issubclass(linuxcnc.error, RuntimeError) and os.path.exists(linuxcnc.nmlfile)
    assert c.serial == 0 and c.wait_complete() == linuxcnc.RCS_DONE, 'nothing was sent'
    for text, kind in (('oh', linuxcnc.OPERATOR_ERROR), ('well', linuxcnc.OPERATOR_TEXT), ('so', linuxcnc.OPERATOR_DISPLAY)):
        send = {linuxcnc.OPERATOR_ERROR: c.error_msg, linuxcnc.OPERATOR_TEXT: c.text_msg,
                linuxcnc.OPERATOR_DISPLAY: c.display_msg}[kind]
        assert send(text) is None and c.wait_complete() == linuxcnc.RCS_DONE
        found = e.poll()
        while found is not None and found != (kind, text):
            found = e.poll()
        assert found == (kind, text), (kind, text)
    second = linuxcnc.error_channel()
    c.text_msg('for all')
    assert (e.poll(), second.poll()) == ((12, 'for all'), (12, 'for all')), 'each reader gets each message'
    s.poll()
    assert s.echo_serial_number == c.serial, 'one count'


def ready():
    c.state(linuxcnc.STATE_ESTOP_RESET)
    assert c.wait_complete() == linuxcnc.RCS_DONE
    c.state(linuxcnc.STATE_ON)
    assert c.wait_complete() == linuxcnc.RCS_DONE
    s.poll()
    assert s.task_state == linuxcnc.STATE_ON and s.enabled and s.state == linuxcnc.RCS_DONE
    c.home(-1)
    assert c.wait_complete(20) == linuxcnc.RCS_DONE
    s.poll()
    assert s.homed[:4] == (1, 1, 1, 0)


def commands():
    s.poll()
    c.mode(linuxcnc.MODE_MANUAL)
    c.home(0)
    assert c.wait_complete() == linuxcnc.RCS_ERROR, 'off'
    s.poll()
    assert s.state == linuxcnc.RCS_ERROR and e.poll() is not None, 'a rejection is reported'
    ready()
    c.teleop_enable(0)  # a homed machine is in teleop mode
    c.wait_complete()
    c.jog(linuxcnc.JOG_INCREMENT, 1, 0, 50, 2)
    assert c.serial > 0
    wait_for(lambda: s.joint_position[0] == 2, 'a joint has jogged')
    c.teleop_enable(1)
    assert c.wait_complete() == linuxcnc.RCS_DONE
    s.poll()
    assert s.motion_mode == linuxcnc.TRAJ_MODE_TELEOP
    c.jog(linuxcnc.JOG_CONTINUOUS, 0, 1, -20)
    wait_for(lambda: s.position[1] < -1, 'an axis jogs')
    c.jog(linuxcnc.JOG_STOP, 0, 1)
    wait_for(lambda: s.inpos, 'and stops')
    c.mode(linuxcnc.MODE_MDI)
    assert c.wait_complete() == linuxcnc.RCS_DONE
    c.mdi('G0 X3 Y4')
    assert c.wait_complete() == linuxcnc.RCS_DONE
    s.poll()
    assert s.position[:2] == (3.5, 4.0) and s.state == linuxcnc.RCS_DONE, s.position
    c.mdi('G1 X30 F60')
    assert c.wait_complete(0.2) == -1, 'it takes longer'
    s.poll()
    assert (s.state, s.interp_state != linuxcnc.INTERP_IDLE, s.motion_type) == (linuxcnc.RCS_EXEC, True, 2)
    c.abort()
    wait_for(lambda: s.inpos and s.interp_state == linuxcnc.INTERP_IDLE and s.position[0] < 30, 'an abort')
    c.mdi('G1 X1 no such word')
    assert c.wait_complete() == linuxcnc.RCS_ERROR
    c.mdi('M3 S500')
    c.wait_complete()
    wait_for(lambda: s.spindle[0]['speed'] == 500 and s.spindle[0]['direction'] == 1, 'the spindle turns')
    for act, name, value in ((lambda: c.feedrate(0.5), 'feedrate', 0.5), (lambda: c.feedrate(-3), 'feedrate', 0.0),
                             (lambda: c.rapidrate(0.25), 'rapidrate', 0.25), (lambda: c.maxvel(12), 'max_velocity', 12.0),
                             (lambda: c.set_optional_stop(0), 'optional_stop', False),
                             (lambda: c.set_block_delete(0), 'block_delete', False),
                             (lambda: c.flood(1), 'flood', 1), (lambda: c.mist(1), 'mist', 1)):
        act()
        wait_for(lambda name=name, value=value: getattr(s, name) == value, f'{name} is {value}')
    c.spindleoverride(0.8)
    wait_for(lambda: s.spindle[0]['override'] == 0.8, 'the override of the spindle')
    c.set_digital_output(3, 1)
    wait_for(lambda: s.dout[3] == 1, 'a digital output')
    c.set_analog_output(2, 1.5)
    wait_for(lambda: s.aout[2] == 1.5, 'an analog output')
    c.state(linuxcnc.STATE_ESTOP)
    wait_for(lambda: s.task_state == linuxcnc.STATE_ESTOP and s.estop == 1 and s.flood == 0, 'emergency stop')


def program():
    with open('short.ngc', 'w', encoding='utf-8') as file:
        file.write('G21 G90 F3000\nG1 X5\n(MSG, hello)\nM0\nG1 X10\nG4 P0.2\nM2\n')
    ready()
    c.mode(linuxcnc.MODE_AUTO)
    c.wait_complete()
    before = c.serial
    c.program_open('short.ngc')
    assert c.serial == before + 2
    s.poll()
    assert s.file.endswith('short.ngc')
    c.auto(linuxcnc.AUTO_RUN, 0)
    wait_for(lambda: s.task_paused == 1 and s.position[0] == 5.5, 'M0')
    assert s.interp_state == linuxcnc.INTERP_PAUSED and s.state == linuxcnc.RCS_EXEC
    messages = []
    while (message := e.poll()) is not None:
        messages.append(message)
    assert (linuxcnc.OPERATOR_DISPLAY, ' hello') in messages, messages
    c.auto(linuxcnc.AUTO_RESUME)
    wait_for(lambda: s.delay_left > 0 and s.exec_state == linuxcnc.EXEC_WAITING_FOR_DELAY, 'the dwell')
    wait_for(lambda: s.interp_state == linuxcnc.INTERP_IDLE and s.state == linuxcnc.RCS_DONE, 'the end')
    assert s.position[0] == 10.5
    logger = linuxcnc.positionlogger(s, *[(10 * i, 0, 0, 255) for i in range(6)], 'XYZ')
    import threading
    thread = threading.Thread(target=logger.start, args=(0.002,))
    thread.start()
    c.mode(linuxcnc.MODE_MDI)
    c.mdi('G1 X20 F6000')
    c.mdi('G1 Y20 F6000') if c.wait_complete() == linuxcnc.RCS_DONE else None
    c.wait_complete()
    time.sleep(0.05)
    logger.stop()
    thread.join()
    rows, count, is_xyuv = logger.points()
    assert count == logger.npts >= 3 and len(rows) == 32 * count and not is_xyuv, count
    assert logger.last(0)[:2] == (20.5, 20.0) and logger.get_colors()[2] == (20, 0, 0, 255)
    logger.clear()
    assert logger.npts == 0 and logger.last() is None


def files():
    import hal
    s.poll()
    wait_for(lambda: os.path.exists('app.txt') and open('app.txt', encoding='utf-8').read().strip() == os.environ['CONFIG_DIR'],
             'the application')
    assert 'by-command' in [signal_['NAME'] for signal_ in hal.get_info_signals()]


def main():
    what = sys.argv[4]
    if what == 'exit':
        sys.exit(int(sys.argv[5]))
    if what == 'killed':
        os.kill(os.getpid(), signal.SIGKILL)
    if what == 'kill-launcher':
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # a display that does not end
        os.kill(os.getppid(), signal.SIGTERM)
        time.sleep(60)
    if what == 'kill-realtime':
        for path in pathlib.Path('/proc').glob('[0-9]*/environ'):
            if (path.parent / 'comm').read_text().startswith('millwright-rt') and INSTANCE in path.read_bytes():
                os.kill(int(path.parent.name), signal.SIGKILL)
        time.sleep(60)
    if what == 'wait':
        with open('waiting.txt', 'w', encoding='utf-8'):
            time.sleep(60)
    globals()[what]()


if __name__ == '__main__':
    main()
