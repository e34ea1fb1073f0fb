#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares our hm2_eth with LinuxCNC's on a memory board with every small module: pins, and registers after each change of a pin.

usage: linuxcnc_modules.py HALRUN (as root)
Exit status: 0 only the differences of the table DIFFERENT, 1 others, 77 skipped, with the reason.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import linuxcnc_board

FOLDER = pathlib.Path(__file__).parent
CONFIG = ('stepgen_width=6 enable_raw ssi_chan_0=error%1bposition%24ge '
          'biss_chan_0=position%24mex%2pfld%3funs%5usig%6s fanuc_chan_0=AA64')
# Pins and values that are set one after the other; ";" separates several values of one step.
STEPS = '''
oneshot.00.enable1 1
oneshot.00.enable2 1
oneshot.00.reset1 1
oneshot.00.retriggerable2 1
oneshot.00.swtrigger1 1
oneshot.00.trigger_on_fall2 1
oneshot.00.trigger_on_rise1 1
oneshot.00.trigger_select1 5
oneshot.00.width1 2.5
oneshot.00.filter1 0.05
oneshot.00.rate 1
oneshot.00.dpll_timer_number 1
rcpwmgen.00.offset 1.5
rcpwmgen.00.scale 90; rcpwmgen.00.width 45
rcpwmgen.00.width -135
rcpwmgen.rate 1000
3pwmgen.00.enable 1
3pwmgen.00.A-value 1
3pwmgen.00.A-value 0.5; 3pwmgen.00.B-value -0.5; 3pwmgen.00.C-value 0.25
3pwmgen.00.A-value 5
3pwmgen.00.fault-invert 1
3pwmgen.00.sample-time 1
3pwmgen.00.deadtime 1000
inmux.00.input-03-slow 1
inmux.00.enc1_4xmode 1
inmux.00.fast_scans 100; inmux.00.slow_scans 5000
xy2mod.00.enable 1
xy2mod.00.posx-cmd 0.5
xy2mod.00.posx-cmd -1
xy2mod.00.posy-cmd 1; xy2mod.00.posy-scale 4
xy2mod.00.velx-cmd 100
xy2mod.00.accx-cmd 1000
xy2mod.00.controlx 7
xy2mod.00.commandx 0x1234; xy2mod.00.commandy 0x5678
xy2mod.00.commandmodex 1
xy2mod.00.18bitmodey 1
xy2mod.00.enable 0
xy2mod.read-timer-number 1
xy2mod.write-timer-number 4
ssi.00.frequency-khz 1000
ssi.00.timer-number 4
biss.00.frequency-khz 4000
biss.00.timer-number 2
resolver.excitation-khz 5
resolver.excitation-khz 2.5
stepgen.00.swap_step_dir 1
'''.strip().split('\n')
# Registers that differ on purpose, with the reason from drivers/mesa/hostmot2/README.md.
DIFFERENT = {
    0x1700: 'Fanuc is set up', 0x1900: 'Fanuc is set up', 0x1800: 'timer-number is 1', 0x4C00: 'timer-number is 1', 0x6B00: 'timer-number is 1',
    0x4800: 'dead time is rounded up', 0x4804: 'dead time is rounded up', 0x2200: 'read back before it is written', 0x2204: 'read back before it is written',
    0x2800: 'written at the start', 0x2804: 'written at the start', 0x5600: 'written by its user only', 0x5700: 'cleared at the start',
    0x9900: 'written at the start'}
# Ports, watchdog, lamps and phase-locked loop, which other tests compare.
OTHER = re.compile('1[0-4]..|0[CDE]..|7...|02..')
PIN = re.compile(r'^\s+\d+\s+(bit|float|s32|u32)\s+(IN|OUT|I/O|RW|RO)\s+\S+\s+hm2_7i80\.0\.(\S+)', re.M)
# Not compared: times of functions, our counters, names that LinuxCNC's list truncates, and an input that both drivers
# reset and that is I/O here.
OTHER_PIN = re.compile(r'\.tmax|raw\.write_strobe|\.time$|^packet|debug|io_error|data-incomplete|phase-.-inverted|refpdm')
MARK = 0xFF00
PREFIX = 'hm2_7i80.0.'


def hal_file():
    lines = ['loadrt hostmot2', f'loadrt hm2_eth board_ip={linuxcnc_board.IP} config="{CONFIG}"', 'loadrt threads name1=servo period1=4000000',
             f'addf {PREFIX}read servo', f'addf {PREFIX}write servo', f'setp {PREFIX}watchdog.timeout_ns 1000000000',
             f'setp {PREFIX}packet-error-limit 100000', f'show pin {PREFIX}', f'show param {PREFIX}', 'start', 'loadusr -w sleep 0.2']
    for number, step in enumerate(STEPS):
        lines += [f'setp {PREFIX}raw.write_address {MARK}', f'setp {PREFIX}raw.write_data {number + 1}', f'setp {PREFIX}raw.write_strobe 1',
                  'loadusr -w sleep 0.05', *(f'setp {PREFIX}{one.strip()}' for one in step.split(';')), 'loadusr -w sleep 0.05']
    return '\n'.join([*lines, 'stop', ''])


def run(halrun, folder):
    """Output and log of a driver."""
    (folder / 'test.hal').write_text(hal_file())
    with linuxcnc_board.Network() as network:
        board = subprocess.Popen(['ip', 'netns', 'exec', network.board, sys.executable, FOLDER / 'memory_board.py', linuxcnc_board.IP, folder / 'log'],
                                 stdout=subprocess.PIPE, text=True)
        board.stdout.readline()
        environment = dict(os.environ, RTAPI_UID='65534', RTAPI_FIFO_PATH=str(folder / 'fifo'), MILLWRIGHT_INSTANCE=f'modules{os.getpid()}')
        done = subprocess.run(['ip', 'netns', 'exec', network.host, 'unshare', '-i', '-p', '-m', '-f', '--mount-proc', '--kill-child', '--', halrun, '-f',
                               folder / 'test.hal'], env=environment, capture_output=True, text=True, timeout=120)
        board.terminate()
        board.wait()
    return done.stdout + done.stderr, (folder / 'log').read_text()


def states(log):
    """The registers after each step."""
    registers, found, step = {}, {}, 0
    for line in log.splitlines():
        address, value = (int(word, 16) for word in line.split())
        if address == MARK:
            found[step] = dict(registers)
            step = value
        elif not OTHER.fullmatch(f'{address:04X}'):
            registers[address] = value
    found[step] = dict(registers)
    return found


def main():
    reason = linuxcnc_board.reason_to_skip()
    if reason:
        print(f'skipped: {reason}')
        return linuxcnc_board.SKIPPED
    pins, registers = [], []
    for halrun in ('/usr/bin/halrun', str(pathlib.Path(sys.argv[1]).resolve())):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            folder.chmod(0o777)  # the driver of LinuxCNC runs as another user
            output, log = run(halrun, folder)
        if not PIN.search(output):
            print(f'{halrun} has not loaded the driver:\n{output[-2000:]}')
            return 1
        pins.append({(row[3], row[1], row[2]) for row in PIN.finditer(output) if not OTHER_PIN.search(row[3])})
        registers.append(states(log))
    problems = [f'only {whose}: {" ".join(row)}' for whose, rows in (('LinuxCNC', pins[0] - pins[1]), ('Millwright', pins[1] - pins[0]))
                for row in sorted(rows)]
    compared = 0
    for step, theirs in registers[0].items():
        ours = registers[1].get(step, {})
        for address in sorted((theirs.keys() | ours.keys()) - DIFFERENT.keys()):
            compared += 1
            if theirs.get(address) != ours.get(address):
                problems.append(f'{STEPS[step - 1] if step else "start"}: register {address:04X}: LinuxCNC {theirs.get(address)}, Millwright {ours.get(address)}')
    print('\n'.join(problems))
    print(f'{len(pins[0] & pins[1])} pins and {compared} values of registers in {len(registers[0])} states, {len(problems)} differences')
    return 1 if problems or not pins[1] or len(registers[1]) != len(STEPS) + 1 else 0


if __name__ == '__main__':
    sys.exit(main())
