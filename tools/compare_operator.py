#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the behaviour for operators of this build and of an installed LinuxCNC 2.9, as black boxes: the same random sessions
on both.

usage: compare_operator.py [--prefix DIR] [--user NAME] [--machine NAME] [--first N] [--count N] [--each N] [--jobs N]
                           [--cache DIR] [--acts JSON] [--show]

Both start simulated machines (MACHINES) in separate namespaces, with operator_session.py as their display. It sends commands by
Python, halui and linuxcncrsh, and writes the status after each act. Fields that differ must be in operator_differences.INTENDED,
whose texts are rows of docs/reference/compatibility.md; other differences are failures. Seeds are distributed over the machines;
--each: sessions per start of a machine; --cache stores LinuxCNC's results. Needs root and the user NAME (default cnc).
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import operator_differences

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / 'docs/reference/compatibility.md'
# name: (letters of the joints, lines of [KINS], of [EMCIO], of [TRAJ], spindles)
MACHINES = {
    'mill': ('XYZ', 'KINEMATICS = trivkins coordinates=XYZ', '', '', 1),
    'lathe': ('XZ', 'KINEMATICS = trivkins coordinates=XZ', '', '', 1),
    'xyza': ('XYZA', 'KINEMATICS = trivkins coordinates=XYZA', '', '', 1),
    'gantry': ('XYYZ', 'KINEMATICS = trivkins coordinates=XYYZ kinstype=BOTH', '', '', 1),
    'random': ('XYZ', 'KINEMATICS = trivkins coordinates=XYZ', 'RANDOM_TOOLCHANGER = 1\n', '', 1),
    'two_spindles': ('XYZ', 'KINEMATICS = trivkins coordinates=XYZ', '', 'SPINDLES = 2\n', 2),
}


def ini_of(name):
    letters, kinematics, emcio, traj, _ = MACHINES[name]
    axes = ''.join(sorted(set(letters), key='XYZABC'.index))
    angular = 'ABC'
    text = f"""[EMC]
VERSION = 1.1
MACHINE = {name}
[DISPLAY]
DISPLAY = ./operator_session.py
MAX_FEED_OVERRIDE = 2
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
CYCLE_TIME = 0.020
TOOL_TABLE = tool.tbl
{emcio}[HAL]
HALFILE = m.hal
HALUI = halui
[TRAJ]
COORDINATES = {' '.join(letters)}
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 20
MAX_LINEAR_VELOCITY = 100
{traj}[KINS]
{kinematics}
JOINTS = {len(letters)}
"""
    for axis in axes:
        text += f'[AXIS_{axis}]\nMIN_LIMIT = -200\nMAX_LIMIT = 200\nMAX_VELOCITY = 100\nMAX_ACCELERATION = 2000\n'
    for number, letter in enumerate(letters):
        kind = 'ANGULAR' if letter in angular else 'LINEAR'
        text += (f'[JOINT_{number}]\nTYPE = {kind}\nMIN_LIMIT = -200\nMAX_LIMIT = 200\nMAX_VELOCITY = 100\nMAX_ACCELERATION = 2000\n'
                 'FERROR = 5\nMIN_FERROR = 5\nHOME_SEQUENCE = 0\n')
    return text


def hal_of(name):
    letters, _, _, _, spindles = MACHINES[name]
    kinematics = MACHINES[name][1].split('=', 1)[1].strip()
    text = f"""loadrt {kinematics}
loadrt motmod servo_period_nsec=1000000 num_joints={len(letters)} num_spindles={spindles}
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net tool-prep-loop iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net tool-change-loop iocontrol.0.tool-change => iocontrol.0.tool-changed
"""
    for number in range(len(letters)):
        text += f'net j{number} joint.{number}.motor-pos-cmd => joint.{number}.motor-pos-fb\n'
    for number in range(spindles):
        text += f'setp spindle.{number}.at-speed 1\n'
    return text


TABLE = 'T1 P1 Z0 D3\nT2 P2 Z4.5 D6\nT3 P3 Z-2 D1\n'


def start(prefix, folder, name, first, count, acts, user, display='operator_session.py'):
    """A process that runs the sessions; its results are in folder/out."""
    machine = folder / 'machine'
    (folder / 'home/linuxcnc/nc_files').mkdir(parents=True)
    machine.mkdir()
    (machine / 'm.ini').write_text(ini_of(name).replace('operator_session.py', display), encoding='ascii')
    (machine / 'm.hal').write_text(hal_of(name), encoding='ascii')
    (machine / 'tool.tbl').write_text(TABLE, encoding='ascii')
    shutil.copy(ROOT / 'tools' / display, machine)
    subprocess.run(['chown', '-R', f'{user}:', str(folder)], check=True)
    os.chmod(folder, 0o755)
    path = '/usr/local/bin:/usr/bin:/bin'
    env = {'PATH': path if prefix is None else f'{prefix}/bin:{path}', 'HOME': str(folder / 'home'), 'USER': user, 'LANG': 'C.UTF-8',
           'OPERATOR_SEEDS': f'{first}:{count}', 'OPERATOR_OUT': str(folder / 'out'), 'OPERATOR_MACHINE': name, 'OPERATOR_ACTS': acts}
    if prefix is not None:
        env['PYTHONPATH'] = f'{prefix}/lib/python'
    inner = ('export PATH=$PATH:/usr/sbin:/sbin; ip link set lo up; mount -t tmpfs -o mode=1777 none /dev/shm; mount -t tmpfs -o mode=1777 none /run/lock 2>/dev/null; '
             f'mount -t tmpfs -o mode=1777 none /tmp; cd {machine}; exec /usr/sbin/runuser -u {user} -- env HOME={folder}/home linuxcnc -r m.ini </dev/null')
    log = open(folder / 'log', 'w', encoding='utf-8')
    return subprocess.Popen(['timeout', '-s', 'KILL', str(60 + 45 * count), 'unshare', '-i', '-n', '-p', '-m', '-f', '--kill-child',
                             '--mount-proc', 'bash', '-c', inner], stdout=log, stderr=log, env=env)


def rows_of(folder):
    out = folder / 'out'
    return [json.loads(line) for line in out.read_text(encoding='ascii').splitlines()] if out.exists() else []


def run_both(name, first, count, options):
    """Rows of both systems, or a text with the reason why there are none."""
    session = hashlib.sha256((ROOT / 'tools/operator_session.py').read_bytes()).hexdigest()[:8]
    key = pathlib.Path(options.cache) / f'{name}_{first}_{count}_{session}.jsonl' if options.cache and not options.acts else None
    with tempfile.TemporaryDirectory(dir='/var/tmp', prefix='operator') as temporary:
        base = pathlib.Path(temporary)
        os.chmod(base, 0o755)
        sides = {'ours': options.prefix}
        if key is None or not key.exists():
            sides['theirs'] = None
        running = {}
        for side, prefix in sides.items():
            (base / side).mkdir()
            running[side] = start(prefix, base / side, name, first, count, options.acts, options.user)
        for process in running.values():
            process.wait()
        rows = {side: rows_of(base / side) for side in sides}
        for side in [side for side in sides if not rows[side]]:  # LinuxCNC's modules do not always load
            shutil.rmtree(base / side)
            (base / side).mkdir()
            start(sides[side], base / side, name, first, count, options.acts, options.user).wait()
            rows[side] = rows_of(base / side)
        for side, got in rows.items():
            if not got:
                return f'{name}: {side} wrote nothing: ' + (base / side / 'log').read_text(encoding='utf-8')[-600:]
        if key is not None and 'theirs' in rows:
            key.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(base / 'theirs/out', key)
        if 'theirs' not in rows:
            rows['theirs'] = [json.loads(line) for line in key.read_text(encoding='ascii').splitlines()]
        return rows['ours'], rows['theirs']


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--prefix', default=str(ROOT / 'build/release'))
    parser.add_argument('--user', default='cnc')
    parser.add_argument('--machine', choices=sorted(MACHINES))
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--count', type=int, default=12)
    parser.add_argument('--each', type=int, default=5)
    parser.add_argument('--jobs', type=int, default=4)
    parser.add_argument('--cache', default='')
    parser.add_argument('--acts', default='')
    parser.add_argument('--show', action='store_true', help='print each difference, not the first of its field alone')
    options = parser.parse_args()
    page = PAGE.read_text(encoding='utf-8')
    missing = [text for text, _, _ in operator_differences.INTENDED if text not in page]
    if missing:
        sys.exit('not in docs/reference/compatibility.md: ' + '; '.join(missing))
    names = [options.machine] if options.machine else list(MACHINES)
    parts = []
    for i, first in enumerate(range(options.first, options.first + options.count, options.each)):
        parts.append((names[i % len(names)], first, min(options.each, options.first + options.count - first)))
    fields, sessions, failed = collections.Counter(), 0, 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for part, result in zip(parts, pool.map(lambda p: run_both(*p, options), parts)):
            if isinstance(result, str):
                print(result)
                failed += 1
                continue
            sessions += part[2]
            for act, field, ours, theirs in operator_differences.unexplained(*result):
                fields[field] += 1
                if options.show or fields[field] <= 3:
                    print(f'{part[0]} {act}: {field} ours {ours} LinuxCNC {theirs}', flush=True)
    print(f'{sessions} sessions; ' + (', '.join(f'{field} {n}' for field, n in fields.most_common()) or 'no differences'))
    sys.exit(1 if fields or failed else 0)


if __name__ == '__main__':
    main()
