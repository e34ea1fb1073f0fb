#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the answers of linuxcncrsh with those of an installed LinuxCNC 2.9, as black boxes.

usage: compare_rsh.py [--bin DIR] [--user NAME] [--show]

Both start a machine of three joints, with linuxcncrsh as its display (ours with --dialect 2.9). Each line is sent after the
answer to the previous line. Answers are compared including their line ends. A line that differs must have a reason in REASONS
below. If run as root, LinuxCNC runs as NAME (op) in separate namespaces.
"""
import argparse
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PORT = 5137
REASONS = [  # (pattern of the line, reason why ours answers differently)
    (r'get ini |get wait$|get update$|get set_timeout$', 'there the reference answers with what is left of an earlier answer'),
    (r'help', 'texts of our own'),
    (r'get tool_offset', 'the reference prints the length as a whole number that it is not'),
    (r'get comm_prot|set comm_prot', 'the manual takes every version up to 1.1'),
    (r'get teleop_enable # after jog', 'the reference stays in joint mode where a jog was asked for in MDI mode, and only there'),
    (r'get time$', 'the time'),
    (r'get program_codes', 'without a parameter file LinuxCNC reports G92.2; 2.10 and Millwright report nothing'),
    (r'get lube', 'LinuxCNC reports lubrication before it is switched on'),
    (r'get error # unhomed', 'the message of a rejected command has the remedy'),
    (r'get joint_pos # jog', 'the position of a jog depends on the time'),
]
INI = """[EMC]
VERSION = 1.1
MACHINE = rsh
[DISPLAY]
DISPLAY = %(display)s
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = sim.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.100
TOOL_TABLE = tool.tbl
[HAL]
HALFILE = m.hal
[TRAJ]
COORDINATES = XYZ
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 20
MAX_LINEAR_VELOCITY = 100
[KINS]
KINEMATICS = trivkins coordinates=XYZ
JOINTS = 3
""" + ''.join(f"""[AXIS_{letter}]
MIN_LIMIT = -100
MAX_LIMIT = 100
MAX_VELOCITY = 100
MAX_ACCELERATION = 1000
[JOINT_{number}]
TYPE = LINEAR
MIN_LIMIT = -100
MAX_LIMIT = 100
MAX_VELOCITY = 100
MAX_ACCELERATION = 1000
FERROR = 1
MIN_FERROR = 1
HOME_SEQUENCE = 0
""" for number, letter in enumerate('XYZ'))
HAL = """loadrt trivkins coordinates=XYZ
loadrt motmod servo_period_nsec=1000000 num_joints=3
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net a joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net b joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net c joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net e iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net p iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net t iocontrol.0.tool-change => iocontrol.0.tool-changed
"""
# A number is a pause in seconds; the word after # is a key of REASONS.
LINES = """get plat;set echo on;hello BAD x 1;hello;hello EMC x 1.0;get echo;set echo off;get enable;set mode mdi;set verbose on
set mode mdi;set enable WRONG;set enable EMCTOO;get bogus;set bogus 1;set mode bogus;set mode;bogus;get;set;help;help get
get debug;get ini DISPLAY DISPLAY;get set_wait;get timeout;get set_timeout;get update;get error;get operator_display
get operator_text;get time;get estop;set estop off;1;get estop;set machine on;1;get machine;get mode;get mist;set mist on;0.2
get mist;set mist off;set flood bogus;get flood;set flood on;0.2;get flood;set flood off;get lube;get lube_level;get brake 0
get spindle 0;get tool;get tool_offset;get feed_override;set feed_override 50;0.2;get feed_override;set feed_override 100
get spindle_override 0;get abs_cmd_pos;get abs_cmd_pos 1;get abs_act_pos;get rel_cmd_pos;get rel_act_pos;get joint_pos
get joint_pos 0;get joint_pos 7;get pos_offset X;get pos_offset;get joint_limit;get joint_limit 1;get joint_fault;get joint_homed
get joint_homed 1;get program;get program_line;get program_status;get program_codes;get joint_type;get joint_units
get joint_type 1;get program_units;get program_linear_units;get program_angular_units;get user_linear_units
get user_angular_units;get display_linear_units;get display_angular_units;get linear_unit_conversion;get angular_unit_conversion
get probe_value;get probe_tripped;get teleop_enable;get kinematics_type;get override_limits;get optional_stop
set spindle forward;0.3;get spindle 0;set spindle increase;0.2;get spindle 0;set spindle off;0.2;set spindle reverse;0.3
get spindle 0;set spindle off;0.3;get spindle 0;set mdi g0x1;0.2;get error # unhomed;get error;set mode manual;set jog 0 60;0.3
get joint_pos # jog;set jog_stop 0;set jog 7 1;0.2;get error # unhomed;get error;set jog x 1;set jog_stop x;get error
set home 0;0.5;set home 1;0.5;set home 2;2;get joint_homed;get teleop_enable;set jog 0 1;get error;set jog x 60;0.2;set jog_stop x
0.5;set jog_stop 0;set teleop_enable off;0.3;get teleop_enable;set step;0.3;get error;set mode mdi;0.5;get mode;get teleop_enable
set mdi s200;0.3;set spindle forward;0.3;get spindle 0;set spindle off;0.3;set jog 0 60;0.3;get error;set mdi g0 x5 y1;2
get abs_cmd_pos;get rel_cmd_pos 0;get joint_pos;set mdi g10 l2 p1 x1;0.5;get rel_cmd_pos;get pos_offset X;get pos_offset
set mdi (debug,hello);0.5;get operator_display;get operator_display;set linear_unit_conversion inch;get linear_unit_conversion
get display_linear_units;get abs_cmd_pos 0;get abs_cmd_pos;get rel_act_pos;get joint_pos 0;set linear_unit_conversion auto;set mode manual;1.5;get teleop_enable # after jog
set set_wait done;get set_wait;set mist on;set mist off;set set_wait received;set timeout 1.5;get timeout;set set_timeout 1
set optional_stop 0;0.3;get optional_stop;set probe_clear;set abort;set task_plan_init;get config;get comm_mode
set spindle_override 0 70;0.3;get spindle_override 0;get bogus;set verbose off;set mode bogus;get bogus;set bogus;set mist off
set enable off;set mode mdi;set enable EMCTOO;set estop on;0.5;get estop;get machine;shutdown"""


# Lines without an answer.
SILENT = {'bogus', 'set verbose off', 'set mist off', 'set enable off', 'set enable EMCTOO', 'set estop on'}


def lines():
    return [line.strip() for row in LINES.splitlines() for line in row.split(';')]


def connect(process):
    end = time.monotonic() + 20
    while time.monotonic() < end and process.poll() is None:
        try:
            return socket.create_connection(('127.0.0.1', PORT))
        except OSError:
            time.sleep(0.2)
    raise SystemExit('it does not listen')


def talk(process):
    """(line, answer) of each line."""
    connection = connect(process)
    time.sleep(1)  # it listens before it can answer
    told = []
    for line in lines():
        if re.fullmatch(r'[0-9.]+', line):
            time.sleep(float(line))
            continue
        answer = b''
        # Most lines have an answer; a missing answer does not delay the other lines for long.
        connection.settimeout(0.5 if line in SILENT else 5)
        try:
            connection.sendall(line.split(' #')[0].encode() + b'\r\n')
            while piece := connection.recv(65536):
                answer += piece
                connection.settimeout(0.1)
            answer += b'<END>'
        except TimeoutError:
            pass
        except OSError as error:
            answer += str(error).encode()
        told.append((line, answer.decode('latin1')))
    return told


def run(command, display, user):
    with tempfile.TemporaryDirectory(prefix='rsh', dir='/var/tmp') as name:
        folder = pathlib.Path(name)
        for file, text in (('m.ini', INI % {'display': display}), ('m.hal', HAL), ('tool.tbl', 'T1 P1 Z1 D2\n')):
            (folder / file).write_text(text)
        words = command + ['-r', 'm.ini']
        environment = dict(os.environ, HOME=name)
        environment.pop('DISPLAY', None)
        if user and os.geteuid() == 0:
            subprocess.run(['chown', '-R', user, name], check=True)
            words = ['runuser', '-u', user, '--', *words]
        with subprocess.Popen(words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, start_new_session=True) as process:
            try:
                told = talk(process)
                process.wait(timeout=30)
            except subprocess.TimeoutExpired:
                print(f'{words[0]} does not end after {told[-1]}')
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, 15)
        return told


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--bin', default=str(ROOT / 'build/release/bin'))
    parser.add_argument('--user', default='op')
    parser.add_argument('--show', action='store_true', help='every line with both answers')
    options = parser.parse_args()
    ours = run([f'{options.bin}/linuxcnc'], f'{options.bin}/linuxcncrsh -p {PORT} --dialect 2.9', '')
    reference = run(['/usr/bin/linuxcnc'], f'linuxcncrsh -p {PORT}', options.user)
    equal = explained = 0
    bad = []
    for (line, own), (_, other) in zip(ours, reference):
        reason = next((why for pattern, why in REASONS if re.match(pattern, line)), None)
        if options.show:
            print(f'{line}\n  ours      {own!r}\n  reference {other!r}')
        if own == other:
            equal += 1
        elif reason is not None:
            explained += 1
        else:
            bad.append((line, own, other))
    for line, own, other in bad:
        print(f'{line}\n  ours      {own!r}\n  reference {other!r}')
    print(f'{equal} lines alike, {explained} differ for a reason, {len(bad)} without one')
    return 1 if bad or len(ours) != len(reference) else 0


if __name__ == '__main__':
    sys.exit(main())
