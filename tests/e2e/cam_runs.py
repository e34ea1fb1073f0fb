#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs CAM programs to their end in virtual time on machines with only the axes that they need.

usage: cam_runs.py MILLWRIGHT SOURCE_FOLDER [--first SEED] [--count N] [--log FILE]
Each program of tools/cam_programs.py runs on a machine with its axes (X Z, X Y, X Y Z, X Y Z A, X Y Z A C; inch or mm). It must
end at its last programmed position, with the active tool offset, and without a warning.
The log has one line per program with its number and verdict. A run with the same log continues after the last line.
"""
import argparse
import contextlib
import pathlib
import shutil
import subprocess
import sys
import tempfile

PRINTED = 2e-6  # resolution of the trace, and rounding of a program in inches
OFFSETS = {1: {'Z': 10.0}, 2: {'Z': 20.5}}
LATHE_OFFSETS = {1: {'X': 3.0, 'Z': 10.0}, 2: {'X': 4.5, 'Z': 12.0}}


def hal_text(joints):
    loops = ''.join(f'net joint-{i} joint.{i}.motor-pos-cmd => joint.{i}.motor-pos-fb\n' for i in range(joints))
    return ('loadrt [KINS]KINEMATICS\n'
            'loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS\n'
            'addf motion-command-handler servo-thread\naddf motion-controller servo-thread\n'
            'net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n'
            'net tool-prep-loop iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n'
            'net tool-change-loop iocontrol.0.tool-change => iocontrol.0.tool-changed\n' + loops)


def ini_text(axes, scale):
    """`scale`: machine units per mm."""
    def limits(rate, is_joint, letter):
        size = 1.0 if letter in 'AC' else scale
        lines = [f'MAX_VELOCITY = {rate * size}', f'MAX_ACCELERATION = {8 * rate * size}', f'MIN_LIMIT = {-9999 * size}',
                 f'MAX_LIMIT = {9999 * size}']
        if is_joint:
            lines += [f'TYPE = {"ANGULAR" if letter in "AC" else "LINEAR"}', f'FERROR = {size}', f'MIN_FERROR = {0.1 * size}',
                      'HOME = 0', 'HOME_OFFSET = 0', 'HOME_SEARCH_VEL = 0', 'HOME_LATCH_VEL = 0', 'HOME_SEQUENCE = 0']
        return '\n'.join(lines) + '\n'
    text = (f'[EMC]\nVERSION = 1.1\nMACHINE = {axes}\n[TASK]\nTASK = milltask\nCYCLE_TIME = 0.001\n'
            '[RS274NGC]\nPARAMETER_FILE = machine.var\n[EMCMOT]\nEMCMOT = motmod\nSERVO_PERIOD = 1000000\n'
            '[EMCIO]\nTOOL_TABLE = machine.tbl\n[HAL]\nHALFILE = machine.hal\n'
            f'[TRAJ]\nCOORDINATES = {" ".join(axes)}\nLINEAR_UNITS = {"mm" if scale == 1.0 else "inch"}\nANGULAR_UNITS = degree\n'
            f'DEFAULT_LINEAR_VELOCITY = {50 * scale}\nMAX_LINEAR_VELOCITY = {300 * scale}\nMAX_LINEAR_ACCELERATION = {3000 * scale}\n'
            f'[KINS]\nKINEMATICS = trivkins coordinates={axes}\nJOINTS = {len(axes)}\n')
    for i, letter in enumerate(axes):
        text += f'[AXIS_{letter}]\n' + limits(300, False, letter) + f'[JOINT_{i}]\n' + limits(300, True, letter)
    return text


def run(millwright, program, is_inch, folder):
    """The fault, or an empty text."""
    scale = 1 / 25.4 if is_inch else 1.0
    offsets = LATHE_OFFSETS if program.kind == 'lathe' else OFFSETS
    folder.mkdir()
    (folder / 'machine.ini').write_text(ini_text(program.axes, scale))
    (folder / 'machine.hal').write_text(hal_text(len(program.axes)))
    (folder / 'machine.tbl').write_text(''.join(
        f'T{tool} P{tool} D{0.5 * scale} ' + ' '.join(f'{letter}{value * scale:.9f}' for letter, value in lengths.items()) + '\n'
        for tool, lengths in offsets.items()))
    (folder / 'program.ngc').write_text(program.text())
    done = subprocess.run([millwright, 'run', 'machine.ini', 'program.ngc', '--trace', 'trace.csv', '--no-estimate'], cwd=folder,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return f'exit status {done.returncode}: {done.stderr.strip()[:300]}'
    rows = (folder / 'trace.csv').read_text().splitlines()
    last = dict(zip(rows[0].split(','), rows[-1].split(',')))
    for letter, value in program.expected_end().items():
        offset = offsets.get(program.offset_tool, {}).get(letter, 0.0)
        size = 1.0 if letter in 'AC' else scale
        got = float(last[f'axis.{letter.lower()}'])
        if abs(got - (value + offset) * size) > PRINTED:
            return f'{letter} ends at {got}, not at {(value + offset) * size}'
    return ''


def verdicts_of(log):
    """Seed -> fault (empty when it passed), for the programs in a log."""
    if log is None or not log.exists():
        return {}
    lines = [line.split('\t') for line in log.read_text().splitlines() if not line.startswith('#')]
    return {int(seed): fault for seed, verdict, _, fault in lines if verdict in ('passed', 'FAILED')}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('millwright', type=pathlib.Path)
    parser.add_argument('source', type=pathlib.Path)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--count', type=int, default=20)
    parser.add_argument('--log', type=pathlib.Path)
    arguments = parser.parse_args()
    sys.path.insert(0, str(arguments.source / 'tools'))
    import cam_programs  # pylint: disable=import-outside-toplevel
    seeds = range(arguments.first, arguments.first + arguments.count)
    known = {seed: fault for seed, fault in verdicts_of(arguments.log).items() if seed in seeds}
    failures = {seed: fault for seed, fault in known.items() if fault}
    with contextlib.ExitStack() as open_now:
        scratch = open_now.enter_context(tempfile.TemporaryDirectory())
        log = open_now.enter_context(arguments.log.open('a', encoding='utf-8', buffering=1)) if arguments.log else None
        for seed in seeds:
            if seed in known:
                continue
            program = cam_programs.make(seed)
            folder = pathlib.Path(scratch, str(seed))
            fault = run(arguments.millwright.resolve(), program, seed % 3 == 2, folder)
            shutil.rmtree(folder)
            name = f'{program.kind} {program.axes}'
            if log:
                log.write(f'{seed}\t{"FAILED" if fault else "passed"}\t{name}\t{" ".join(fault.split())}\n')
            if fault:
                failures[seed] = fault
                print(f'FAILED: program {seed} ({name}): {fault}', flush=True)
    print(f'{arguments.count - len(failures)} passed, {len(failures)} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
