#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests that each HAL file of our library does on a small machine what its header states.

usage: hallib.py MILLWRIGHT ROOT
"""
import pathlib
import re
import subprocess
import sys
import tempfile

HEAD = '''[EMC]
VERSION = 1.1
MACHINE = library
[TASK]
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = m.var
[EMCMOT]
EMCMOT = motmod {motmod}
SERVO_PERIOD = 1000000
[HAL]
HALUI = halui
{files}
[TRAJ]
COORDINATES = {coordinates}
LINEAR_UNITS = mm
MAX_LINEAR_VELOCITY = 100
[EMCIO]
TOOL_TABLE = m.tbl
[KINS]
KINEMATICS = {kinematics}
JOINTS = {joints}
'''
JOINT = '''[JOINT_{j}]
TYPE = LINEAR
MAX_VELOCITY = 100
MAX_ACCELERATION = 1000
MIN_LIMIT = {low}
MAX_LIMIT = 200
FERROR = 5
MIN_FERROR = 1
HOME = {home}
HOME_OFFSET = {home}
HOME_SEARCH_VEL = {search}
HOME_LATCH_VEL = {latch}
HOME_SEQUENCE = {sequence}
{servo}'''
AXIS = '''[AXIS_{l}]
MIN_LIMIT = {low}
MAX_LIMIT = 200
MAX_VELOCITY = 100
MAX_ACCELERATION = 1000
'''


class Library:
    def __init__(self, millwright):
        self.millwright = millwright
        self.failures = 0

    def run(self, what, files, program, expected, **given):
        """Files of [HAL], a program, and a pattern that the output must contain (or must not contain)."""
        settings = dict(coordinates='XYZ', kinematics='trivkins', joints=3, motmod='', search=0, latch=0, sequence=0, home=0, low=-200, extra='', hal='', servo='')
        settings.update(given)
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place)
            (folder / 'tail.hal').write_text(settings['hal'])
            lines = '\n'.join(f'HALFILE = {name}' for name in (*files, 'tail.hal'))
            text = HEAD.format(files=lines, **settings)
            text += ''.join(JOINT.format(j=j, **settings) for j in range(settings['joints']))
            text += ''.join(AXIS.format(l=letter, **settings) for letter in sorted(set(settings['coordinates']))) + settings['extra']
            (folder / 'm.ini').write_text(text)
            (folder / 'm.tbl').write_text('T1 P1 Z0 D6\n')
            (folder / 'p.ngc').write_text(program + '\nM2\n')
            done = subprocess.run([self.millwright, 'run', 'm.ini', 'p.ngc'], cwd=folder, capture_output=True, text=True, check=False, timeout=120)
            found = done.stdout + done.stderr
            good = done.returncode == 0 and re.search(expected, found)
        if good:
            print(f'ok   {what}')
        else:
            self.failures += 1
            print(f'FAIL {what}: status {done.returncode}, no "{expected}" in\n{found}')


# The test checks (DEBUG, ...) of a program.
MOVE = 'G21 G90\nG1 F3000 X20 Y10 Z5\nG0 X0 Y0 Z0'


def main():
    library = Library(sys.argv[1])
    gantry = dict(coordinates='XYYZ', kinematics='trivkins coordinates=XYYZ kinstype=BOTH', joints=4)
    library.run('gantrysim with its home switches', ['LIB:gantrysim.hal', 'LIB:simulated-gantry-home.hal'], MOVE, 'cycle time',
                search=20, latch=2, sequence=-1, **gantry)
    library.run('simulated_limits let a machine move', ['LIB:core_sim.hal', 'LIB:simulated_limits.hal'],
                'G90 G1 F3000 X20\nM66 P0 L0\n(DEBUG, under #<_hal[limits_x.under]> over #<_hal[limits_x.over]>)', 'under 0.*over 0')
    servo = 'PGAIN = 50\nIGAIN = 0\nDGAIN = 0\nBIAS = 0\nFF0 = 0\nFF1 = 1\nFF2 = 0\nDEADBAND = 0\n'
    library.run('servo_sim follows', ['LIB:servo_sim.hal'], MOVE, 'cycle time', servo=servo)
    # Steps of simulated motors on the pins of a simulated port.
    stepper = dict(motmod='\nBASE_PERIOD = 50000', servo='SCALE = 100\nSTEPGEN_MAXACCEL = 1200\n',
                   hal='loadrt hal_parport backend=simulated cfg="0x378 out"\naddf parport.0.write base-thread\nnet Xdir => parport.0.pin-02-out\n'
                       'net Xstep => parport.0.pin-03-out\nnet estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n'
                       'loadrt updown\naddf updown.0 base-thread\nnet steps parport.0.pin-03-out-fake => updown.0.countup\n')
    library.run('core_stepper makes steps', ['LIB:core_stepper.hal'],
                'G21 G90\nG1 F1200 X20\nM66 P0 L0\n(DEBUG, steps #<_hal[updown.0.count]> at #<_hal[stepgen.0.position-fb]>)',
                r'steps (1999|2000|2001)\.0+ at (19\.99|20\.0)', **stepper)
    constraints = ['LIB:core_sim.hal', 'LIB:check_xyz_constraints.hal']
    told = '\nM66 P0 L0\n(DEBUG, broken #<_hal[was_broken.out]>)'
    library.run('check_xyz_constraints: kept', constraints, 'G21 G90 G64 P0.1\nG1 F3000 X20 Y10 Z5\nX0 Y20\nG2 X0 Y10 J-5\nG0 X0 Y0 Z0' + told, 'broken 0')
    library.run('check_xyz_constraints: broken', constraints, 'G21 G90 G1 F3000 X20' + told, 'broken 1', hal='setp check_xvel.max 20\n')
    offsets = '[MOVEOFF_0]\nMAX_LIMIT = 7\nMIN_LIMIT = -7\nMAX_VELOCITY = 50\nMAX_ACCELERATION = 500\n[MOVEOFF]\nEPSILON = 0.002\n'
    external = 'setp mv.power-on 1\nsetp mv.apply-offsets 1\nsets external_enable 1\nsets external_offset_0 {offset}\n'
    moveoff = dict(extra=offsets)
    library.run('hookup_moveoff adds an offset', ['LIB:core_sim.hal', 'LIB:hookup_moveoff.tcl', 'LIB:moveoff_external.hal'],
                MOVE + '\nG4 P1\nM66 P0 L0\n(DEBUG, offset #<_hal[mv.offset-current-0]> epsilon #<_hal[mv.epsilon]> y #<_hal[mv.offset-max-1]>)',
                r'offset 3\.0+ epsilon 0\.002.* y 200', hal=external.format(offset=3), **moveoff)
    library.run('hookup_moveoff keeps its limits', ['LIB:basic_sim.tcl', 'LIB:hookup_moveoff.tcl', 'LIB:moveoff_external.hal'],
                MOVE + '\nG4 P1\nM66 P0 L0\n(DEBUG, offset #<_hal[mv.offset-current-0]>)', r'offset 7\.0', hal=external.format(offset=30), **moveoff)
    library.run('wheeljogpins', ['LIB:core_sim.hal', 'LIB:wheeljogpins.tcl 0.25'],
                '(DEBUG, scale #<_hal[joint.1.jog-scale]> and #<_hal[axis.z.jog-scale]> enabled #<_hal[axis.x.jog-enable]>)',
                r'scale 0\.25.* and 0\.25.* enabled 1')
    library.run('halcheck', ['LIB:core_sim.hal', 'LIB:halcheck.tcl nopopup'], MOVE,
                r'halcheck: 0 functions without addf(.|\n)*halcheck: \d+ signals with no inputs: .*Xacc')
    library.run('var_show', ['LIB:core_sim.hal', 'LIB:var_show.tcl'], MOVE, r'\[KINS\]JOINTS = 3(.|\n)*INI_FILE_NAME = ')
    library.run('locking_indexer', ['LIB:basic_sim.tcl', 'LIB:locking_indexer.hal'], 'G0 B90', 'cycle time',
                motmod='unlock_joints_mask=0x10', coordinates='XYZAB', kinematics='trivkins coordinates=XYZAB', joints=5)
    library.run('tripodsim', ['LIB:tripodsim.hal'], 'G21 G91\nG1 F600 X0.05 Y0.05\n', 'cycle time', kinematics='tripodkins', home=1.2)
    for name, kinematics, home in (('sim_ldelta', 'lineardeltakins', 0), ('sim_rdelta', 'rotarydeltakins', 1)):
        library.run(name, [f'LIB:{name}.hal'], '(DEBUG, here #<_x>)', 'cycle time', coordinates='XYZA', kinematics=kinematics, joints=4, home=home, low=-900)
    print(f'{library.failures} failed')
    return 1 if library.failures else 0


if __name__ == '__main__':
    sys.exit(main())
