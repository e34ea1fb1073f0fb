#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Sample configurations of LinuxCNC for parallel ports start unmodified on simulated ports, home, run a program and end.

usage: parport_configurations.py BIN_FOLDER [SAMPLES] [CONFIGURATION.ini...]
SAMPLES is the folder of sample configurations of an installed LinuxCNC; without it the check is skipped (status 77).
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SAMPLES = pathlib.Path('/usr/share/doc/linuxcnc/examples/sample-configs')
CONFIGURATIONS = ('by_interface/parport/stepper/stepper_mm.ini', 'by_interface/parport/gecko/Gecko_540B4/Gecko_540B4.ini',
                  'by_machine/sherline/Sherline3Axis/Sherline3Axis_mm.ini')
PROGRAM = 'G21 G90 G64\nF120\nG1 X2 Y1\nG1 X0.5 Y0.25 Z-0.5\nG3 X0 Y0 I-0.25 J-0.125\nM2\n'
START_S, MOVE_S = 20, 60


class Machine:
    def __init__(self, programs, ini, folder):
        self.programs, self.ini, self.output = programs, ini, folder / 'start.txt'
        self.env = {**os.environ, 'MILLWRIGHT_PARPORT': 'simulated', 'MILLWRIGHT_INSTANCE': f'parport_{os.getpid()}',
                    'INI_FILE_NAME': str(ini), 'HOME': str(folder), 'PATH': f'{programs}:{os.environ["PATH"]}'}
        os.environ.update(self.env)
        self.process = subprocess.Popen([programs / 'millwright', 'start', ini, '--no-display'], env=self.env, cwd=ini.parent, stdin=subprocess.DEVNULL,
                                        stdout=self.output.open('w'), stderr=subprocess.STDOUT)

    def text(self):
        return self.output.read_text(errors='replace')

    def until(self, condition, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return True
            time.sleep(0.02)
        return False

    def hal(self, *words):
        return subprocess.run([self.programs / 'halcmd', *words], env=self.env, capture_output=True, text=True, check=False).stdout

    def end(self):
        self.process.terminate()
        try:
            return self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return 'it had to be killed'


def drive(machine, program):
    """Operates the machine; returns the fault, or ''."""
    if not machine.until(lambda: 'is running: instance' in machine.text() or machine.process.poll() is not None, START_S) or 'is running: instance' not in machine.text():
        return 'it does not start: ' + machine.text()[-1500:]
    import linuxcnc  # pylint: disable=import-outside-toplevel
    command, stat, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()

    def status(name):
        stat.poll()
        return getattr(stat, name)

    command.state(linuxcnc.STATE_ESTOP_RESET)
    command.wait_complete(5)
    command.state(linuxcnc.STATE_ON)
    command.wait_complete(5)
    if status('task_state') != linuxcnc.STATE_ON:
        return f'it cannot be switched on: {errors.poll()}'
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete(5)
    command.teleop_enable(0)
    command.wait_complete(5)
    for joint in range(status('joints')):
        command.home(joint)
        if not machine.until(lambda one=joint: status('homed')[one], MOVE_S):
            return f'joint {joint} cannot be homed: {errors.poll()}'
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete(5)
    command.program_open(str(program))
    command.wait_complete(5)
    command.auto(linuxcnc.AUTO_RUN, 0)
    if not machine.until(lambda: status('interp_state') != linuxcnc.INTERP_IDLE, 5):
        return f'the program does not run: {errors.poll()}'
    if not machine.until(lambda: status('interp_state') == linuxcnc.INTERP_IDLE, MOVE_S):
        return 'the program does not end'
    error = errors.poll()
    if error:
        return f'an error: {error}'
    # The pins of the port have changed, so the count of stepgen is the path.
    position = [float(machine.hal('getp', f'stepgen.{joint}.position-fb')) for joint in range(2)]
    wanted = [status('joint_actual_position')[joint] for joint in range(2)]
    if any(abs(one - other) > 0.01 for one, other in zip(position, wanted)):
        return f'stepgen is at {position}, the joints are at {wanted}'
    return '' if 'parport.0' in machine.hal('show', 'pin') else 'there is no port'


def check(programs, source):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        configuration = folder / 'configuration'
        shutil.copytree(source.parent, configuration)
        (folder / 'program.ngc').write_text(PROGRAM)
        machine = Machine(programs, configuration / source.name, folder)
        try:
            problem = drive(machine, folder / 'program.ngc')
        finally:
            status = machine.end()
        return problem or ('' if status == 0 else f'it ends with status {status}: {machine.text()[-1500:]}')


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    samples = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else SAMPLES
    if not samples.is_dir():
        print(f'skipped: no sample configurations of LinuxCNC in {samples}')
        return 77
    failed = 0
    for name in sys.argv[3:] or CONFIGURATIONS:
        problem = check(programs, samples / name)
        print(f'{name}: {problem or "passed"}', flush=True)
        failed += bool(problem)
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
