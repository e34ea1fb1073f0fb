#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The sample configuration with a simulated Mesa board starts, homes to its switches, cuts, stops safely when the board is lost,
and ends.

usage: simulated_board.py BIN_FOLDER ROOT [BOARD ...] (all samples without a name)
"""
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile

from parport_configurations import MOVE_S, START_S, Machine

PROGRAM = 'G21 G90 G64\nF1200\nG1 X30 Y10\nG1 X5 Y25 Z-5\nG2 X5 Y5 J-10\nM2\n'
LONG = 'G21 G90\nF600\nG1 X200\nM2\n'


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(('127.0.0.1', 0))
        return one.getsockname()[1]


def run(machine, linuxcnc, folder, text):
    command, stat = linuxcnc.command(), linuxcnc.stat()
    (folder / 'program.ngc').write_text(text)
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete(5)
    command.program_open(str(folder / 'program.ngc'))
    command.wait_complete(5)
    command.auto(linuxcnc.AUTO_RUN, 0)

    def status(name):
        stat.poll()
        return getattr(stat, name)
    return status if machine.until(lambda: status('interp_state') != linuxcnc.INTERP_IDLE, 5) else None


def drive(machine, folder, board):
    if not machine.until(lambda: 'is running: instance' in machine.text() or machine.process.poll() is not None, START_S) or 'is running: instance' not in machine.text():
        return 'it does not start: ' + machine.text()[-1500:]
    import linuxcnc  # pylint: disable=import-outside-toplevel
    command, stat, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
    for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
        command.state(state)
        command.wait_complete(5)

    def status(name):
        stat.poll()
        return getattr(stat, name)

    if status('task_state') != linuxcnc.STATE_ON:
        return f'it cannot be switched on: {errors.poll()}'
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete(5)
    command.teleop_enable(0)
    command.wait_complete(5)
    command.home(-1)
    if not machine.until(lambda: all(status('homed')[:3]), MOVE_S):
        return f'it cannot be homed: {errors.poll()}, homed {status("homed")[:3]}'
    if not run(machine, linuxcnc, folder, PROGRAM) or not machine.until(lambda: status('interp_state') == linuxcnc.INTERP_IDLE, MOVE_S):
        return f'the program does not end: {errors.poll()}'
    error = errors.poll()
    if error:
        return f'an error: {error}'
    # The home switches are 2 mm from the zero points, so lost steps would be visible here.
    names = [f'encoder.{joint:02}.position' if board == '7i97' else f'stepgen.{joint:02}.position-fb' for joint in range(3)]
    positions = [float(machine.hal('getp', f'hm2_{board}.0.{name}')) for name in names]
    wanted = [float(machine.hal('getp', f'joint.{joint}.motor-pos-cmd')) for joint in range(3)]
    if any(abs(one - other) > 0.02 for one, other in zip(positions, wanted)):
        return f'the motors are at {positions}, not at {wanted}'
    # The board is lost in the middle of a cut: the machine stops and reports the reason.
    if not run(machine, linuxcnc, folder, LONG):
        return f'the long program does not run: {errors.poll()}'
    machine.until(lambda: status('current_vel') > 1, 5)
    subprocess.run(['pkill', '-KILL', '-f', f'hm2-board --listen 127.0.0.1:{machine.port}'], check=False)
    if not machine.until(lambda: status('task_state') != linuxcnc.STATE_ON, 2):
        return 'the machine stays on without its board'
    if not machine.until(lambda: machine.hal('getp', f'hm2_{board}.0.io_error').strip() == 'TRUE', 2):
        return 'io_error is not set'
    return '' if 'has not answered' in machine.text() or 'cannot be' in machine.text() else 'no message names the board: ' + machine.text()[-800:]


def run_sample(programs, root, board):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copytree(root / 'configs' / 'mesa', folder / 'configs' / 'mesa')
        mesa, port = folder / 'configs' / 'mesa', free_port()
        ini = mesa / f'{board}.ini'
        # Limits for a computer without realtime, on which cycles are late.
        text = ini.read_text().replace('BOARD_IP = 127.0.0.1', f'BOARD_IP = 127.0.0.1:{port}')
        ini.write_text(text)
        for file in (ini, mesa / 'stepper_mill.inc'):
            file.write_text(re.sub(r'MIN_FERROR = 0\.\d', 'MIN_FERROR = 10', file.read_text()).replace('\nFERROR = 1\n', '\nFERROR = 10\n'))
        hal = mesa / 'board.hal'
        hal.write_text(hal.read_text().replace('timeout_ns 20000000', 'timeout_ns 400000000') + f'setp hm2_{board}.0.packet-error-limit 200\n')
        machine = Machine(programs, ini, folder)
        machine.port = port
        try:
            problem = drive(machine, folder, board)
        finally:
            status = machine.end()
            subprocess.run(['pkill', '-KILL', '-f', f'hm2-board --listen 127.0.0.1:{port}'], check=False)
        problem = problem or ('' if status == 0 else f'it ends with status {status}: {machine.text()[-1500:]}')
    print(f'{board}: {problem or "passed"}', flush=True)
    return problem


def main():
    programs, root = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    boards = sys.argv[3:] or sorted(path.stem for path in (root / 'configs' / 'mesa').glob('*.ini'))
    # One process for each, because the Python module is bound to one machine.
    if len(boards) == 1:
        return 1 if run_sample(programs, root, boards[0]) else 0
    return max(subprocess.run([sys.executable, __file__, programs, root, board], check=False).returncode for board in boards)


if __name__ == '__main__':
    sys.exit(main())
