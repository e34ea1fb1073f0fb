#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Sessions of a script that is the display of a small machine: single steps, spindle limits, reloaded tool tables. Each session
must give the facts in side_by_side/NAME.txt, which LinuxCNC 2.9 also gives except for lines that begin with "LinuxCNC ".

usage: side_by_side.py BIN_FOLDER [NAME...]     run on this build
       side_by_side.py --linuxcnc [NAME...]     run on the installed LinuxCNC 2.9 (alone, or in separate namespaces)
       side_by_side.py --print ...              print the facts, compare nothing
"""
import argparse
import difflib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent / 'side_by_side'
SESSION_S = 180
INI = """[EMC]
VERSION = 1.1
MACHINE = {name}
[DISPLAY]
DISPLAY = ./session.py
[RS274NGC]
PARAMETER_FILE = machine.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 4.0
SERVO_PERIOD = 1000000
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[HAL]
HALFILE = machine.hal
[TRAJ]
NO_FORCE_HOMING = 1
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 50
MAX_LINEAR_VELOCITY = 200
SPINDLES = 5
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.01
TOOL_TABLE = tools.tbl
RANDOM_TOOLCHANGER = {random}
[KINS]
KINEMATICS = trivkins coordinates=XYZ
JOINTS = 3
"""
AXIS = """[AXIS_{axis}]
MIN_LIMIT = -100
MAX_LIMIT = 100
MAX_VELOCITY = 200
MAX_ACCELERATION = 2000
[JOINT_{joint}]
TYPE = LINEAR
HOME = 0
MIN_LIMIT = -100
MAX_LIMIT = 100
MAX_VELOCITY = 200
MAX_ACCELERATION = 2000
FERROR = 1
MIN_FERROR = 1
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
HOME_SEQUENCE = 0
"""
# Spindle 0 has no limits.
SPINDLES = """[SPINDLE_1]
MIN_VELOCITY = 100
MAX_VELOCITY = 1000
MIN_REVERSE_VELOCITY = 80
MAX_REVERSE_VELOCITY = 500
[SPINDLE_2]
MIN_VELOCITY = 100
MAX_VELOCITY = 1000
[SPINDLE_3]
MAX_VELOCITY = 1000
MAX_REVERSE_VELOCITY = 0
[SPINDLE_4]
MIN_FORWARD_VELOCITY = 100
MAX_FORWARD_VELOCITY = 1000
"""
HAL = """loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS num_spindles=[TRAJ]SPINDLES
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net j0 joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net j1 joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net j2 joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
"""
TOOLS = 'T1 P1 Z11 D1\nT2 P2 Z12 D2\nT3 P3 Z13 D3\nT0 P0\n'
SESSIONS = {'single_step': 0, 'spindle_limits': 0, 'reload_tools': 1}


def write_machine(folder, name):
    axes = ''.join(AXIS.format(axis=axis, joint=joint) for joint, axis in enumerate('XYZ'))
    (folder / 'machine.ini').write_text(INI.format(name=name, random=SESSIONS[name]) + axes + SPINDLES, encoding='ascii')
    (folder / 'machine.hal').write_text(HAL, encoding='ascii')
    (folder / 'tools.tbl').write_text(TOOLS, encoding='ascii')
    shutil.copy(HERE / 'session.py', folder)
    (folder / 'session.py').chmod(0o755)


def facts_of(launcher, env, name):
    with tempfile.TemporaryDirectory(prefix='mw_side_') as temporary:
        folder = pathlib.Path(temporary)
        write_machine(folder, name)
        env = {**env, 'FACTS': str(folder / 'facts'), 'SESSION': name}
        try:
            done = subprocess.run([launcher, '-r', folder / 'machine.ini'], cwd=folder, env=env, capture_output=True, text=True, check=False,
                                  timeout=SESSION_S, stdin=subprocess.DEVNULL)
            said = done.stdout + done.stderr
        except subprocess.TimeoutExpired as late:
            said = f'longer than {SESSION_S} s: {late.stdout}'
        facts = folder / 'facts'
        return facts.read_text(encoding='utf-8').splitlines() if facts.exists() else [], said


def expected_of(name, is_theirs):
    """A line "LinuxCNC FACT" replaces the line before it on LinuxCNC."""
    facts = []
    for line in (HERE / f'{name}.txt').read_text(encoding='utf-8').splitlines():
        if not line.startswith('LinuxCNC '):
            facts.append(line)
        elif is_theirs:
            facts[-1] = line.removeprefix('LinuxCNC ')
    return facts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('words', nargs='*')
    parser.add_argument('--linuxcnc', action='store_true')
    parser.add_argument('--print', action='store_true')
    options = parser.parse_args()
    env = {key: value for key, value in os.environ.items() if key != 'DISPLAY'}
    env['LC_ALL'] = 'C'
    launcher, names = '/usr/bin/linuxcnc', options.words
    if not options.linuxcnc:
        programs = pathlib.Path(options.words[0]).resolve()
        launcher, names = programs / 'linuxcnc', options.words[1:]
        env['MILLWRIGHT_INSTANCE'] = f'side-{os.getpid()}'
        env['PATH'] = f"{programs}:{env['PATH']}"
        env['PYTHONPATH'] = str(programs.parent / 'lib/python')
    failures = 0
    for name in names or SESSIONS:
        facts, said = facts_of(launcher, env, name)
        if options.print:
            print('\n'.join(facts))
            print(said[-1500:], file=sys.stderr)
            failures += not facts
            continue
        differences = list(difflib.unified_diff(expected_of(name, options.linuxcnc), facts, 'expected', name, lineterm='', n=1))
        if differences:
            failures += 1
            print('\n'.join(differences), said[-3000:], sep='\n')
    sys.exit(1 if failures else 0)


if __name__ == '__main__':
    main()
