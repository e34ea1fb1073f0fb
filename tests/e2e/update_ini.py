#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Files from before the separation of joints and axes work after update_ini, and the originals are kept.

usage: update_ini.py BIN_FOLDER ROOT
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

AXIS = '''
[AXIS_{number}]
TYPE = LINEAR
MAX_VELOCITY = {speed}   # mm/s
MAX_ACCELERATION = 1000
MIN_LIMIT = -201
MAX_LIMIT = 201
FERROR = 1
MIN_FERROR = 0.1
HOME = 0
HOME_OFFSET = 0
HOME_SEARCH_VEL = 0
HOME_SEQUENCE = {sequence}
'''
INI = '''# A mill of long ago.
[EMC]
VERSION = $Revision$
MACHINE = old
[DISPLAY]
DISPLAY = axis
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = old.var
[EMCMOT]
EMCMOT = motmod
SERVO_PERIOD = 1000000
[HAL]
HALFILE = old.hal
HALUI = halui
[TRAJ]
# the axes
AXES = 3
COORDINATES = {coordinates}
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_VELOCITY = 20
MAX_VELOCITY = 150 # along the path
MAX_ACCELERATION = 1000
[EMCIO]
TOOL_TABLE = old.tbl
'''
# {z}: the number of the last axis.
HAL = '''loadrt trivkins
loadrt motmod servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[TRAJ]AXES
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x axis.0.motor-pos-cmd => axis.0.motor-pos-fb # of X, axis.0
{y}
net z axis.{z}.motor-pos-cmd => axis.{z}.motor-pos-fb
net wheel-x axis.0.jog-enable
setp axis.{z}.jog-scale 0.01
net speed motion.spindle-speed-out
net on motion.spindle-on
net jog-speed halui.jog-speed
net forward halui.spindle.forward
net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
'''
MACHINES = {
    'mill': ('X Y Z', (0, 1, 2), ('KINEMATICS = trivkins', 'JOINTS = 3', '[JOINT_2]', '[AXIS_Y]')),
    'lathe': ('X Z', (0, 2), ('KINEMATICS = trivkins coordinates=XZ', 'JOINTS = 2', '[JOINT_1]', '[AXIS_Z]')),
    'lathe with a separate Y': ('X Z', (0, 1, 2), ('KINEMATICS = trivkins coordinates=XYZ', 'JOINTS = 3', '[JOINT_2]', '[AXIS_Z]')),
}
NEW_HAL = ('loadrt [KINS]KINEMATICS', 'num_joints=[KINS]JOINTS', 'joint.0.motor-pos-cmd => joint.0.motor-pos-fb # of X, axis.0', 'axis.x.jog-enable',
           'setp axis.z.jog-scale 0.01', 'spindle.0.speed-out', 'spindle.0.on', 'halui.joint.jog-speed', 'halui.spindle.0.forward')
NEW_INI = ('VERSION = 1.1', 'DEFAULT_LINEAR_VELOCITY = 20', '# along the path\nMAX_LINEAR_VELOCITY = 150\n', '# the axes', '# A mill of long ago.')


def main():
    programs, root = map(pathlib.Path, sys.argv[1:3])
    failures = []

    def expect(condition, what):
        if not condition:
            failures.append(what)
            print(f'FAIL {what}')

    def run(words, folder, answer=''):
        return subprocess.run([programs / words[0], *words[1:]], cwd=folder, capture_output=True, text=True, check=False, input=answer, timeout=120)

    for name, (coordinates, numbers, expected) in MACHINES.items():
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place)
            ini, hal = folder / 'old.ini', folder / 'old.hal'
            ini.write_text(INI.format(coordinates=coordinates) + ''.join(
                AXIS.format(number=n, speed=100 + n, sequence=-1 if n == 1 else 0) for n in numbers))
            hal.write_text(HAL.format(z=numbers[-1], y='net y axis.1.motor-pos-cmd => axis.1.motor-pos-fb' if 1 in numbers else ''))
            (folder / 'old.tbl').write_text('T1 P1 Z0 D6\n')
            before = {path.name: path.read_text() for path in (ini, hal)}
            for words in (['linuxcnc', '-r', 'old.ini'], ['millwright', 'doctor', 'old.ini', '--latency', '0', '--no-system']):
                stopped = run(words, folder)
                first = (stopped.stderr if words[0] == 'linuxcnc' else stopped.stdout).splitlines()[:1]
                expect(stopped.returncode == 1 and first and 'update_ini' in first[0], f'{name}: {words[0]} names update_ini: {stopped}')
            refused = run(['update_ini', '-d', 'old.ini'], folder, 'n\n')
            expect(refused.returncode == 42 and ini.read_text() == before['old.ini'], f'{name}: the user answers no: {refused}')
            done = run(['update_ini', 'old.ini'], folder)
            expect(done.returncode == 0, f'{name}: {done}')
            for text in (*expected, *NEW_INI):
                expect(text in ini.read_text(), f'{name}: no "{text}" in\n{ini.read_text()}')
            for text in NEW_HAL:
                expect(text in hal.read_text(), f'{name}: no "{text}" in\n{hal.read_text()}')
            for old, text in before.items():
                expect((folder / 'old.old' / old).read_text() == text, f'{name}: {old} as it was')
            found = run(['millwright', 'doctor', 'old.ini', '--latency', '0', '--no-system'], folder)
            expect(found.returncode == 0, f'{name}: {found.stdout}')
            (folder / 'part.ngc').write_text('G21 G90 F600\nM3 S100\nG1 X5 Z-3\nG0 X0\nM2\n')
            ran = run(['millwright', 'run', 'old.ini', 'part.ngc'], folder)
            expect(ran.returncode == 0 and 'cycle time' in ran.stdout, f'{name}: {ran.stdout}{ran.stderr}')
            after = ini.read_text()
            again = run(['update_ini', 'old.ini'], folder)
            expect(again.returncode == 0 and 'already' in again.stdout and ini.read_text() == after, f'{name}: a second time: {again}')
            # Existing copies are never lost.
            ini.write_text(before['old.ini'])
            lost = run(['update_ini', 'old.ini'], folder)
            expect(lost.returncode == 1 and ini.read_text() == before['old.ini'], f'{name}: over copies: {lost}')
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        shutil.copy(root / 'configs/sim/mill_mm.ini', folder)
        expect('already' in run(['update_ini', 'mill_mm.ini'], folder).stdout, 'a file of today')
        (folder / 'no.ini').write_text('[EMC]\nMACHINE = x\n')
        expect(run(['update_ini', 'no.ini'], folder).returncode == 1, 'no axes')
        expect(run(['update_ini', 'gone.ini'], folder).returncode == 1, 'no file')
        expect(run(['update_ini'], folder).returncode == 2, 'no word')
    print(f'{len(failures)} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
