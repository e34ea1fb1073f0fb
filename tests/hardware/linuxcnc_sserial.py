#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Sends the same HAL commands for smart serial cards to our hm2_eth and to LinuxCNC's: the simulated cards must get the same
outputs, and the pins must show the same inputs.

usage: linuxcnc_sserial.py HM2_BOARD HALRUN (as root)
Exit status: 0 all agree, 1 something differs, 77 skipped, with the reason.
"""
import math
import pathlib
import re
import sys

import both_drivers
import linuxcnc_board

PHYSICS = '''motor x stepgen=0 steps_per_rev=200
remote 0 card=7i76
remote 1 card=7i84
switch 0 remote=0 motor=x below_rev=1
switch 5 remote=0 motor=x above_rev=1
switch 31 remote=0 motor=x above_rev=1 closed=low
switch 7 remote=1 motor=x above_rev=2
field 0 name=AnalogIn0 value=0x800
field 0 name=AnalogIn1 value=0xFFF
field 0 name=AnalogIn3 value=1
field 0 name=Enc0 motor=x counts_per_rev=100
field 0 name=Enc1 motor=x counts_per_rev=37
'''
CARD, OTHER = 'hm2_7i76e.0.7i76.0.0', 'hm2_7i76e.0.7i84.0.1'
START = '''
loadrt hostmot2
loadrt hm2_eth board_ip=192.168.1.121 config="num_encoders=0 num_stepgens=1 sserial_port_0=MODE0xxxxxx"
loadrt threads name1=servo period1=4000000
addf hm2_7i76e.0.read servo
addf hm2_7i76e.0.write servo
setp hm2_7i76e.0.watchdog.timeout_ns 100000000
setp hm2_7i76e.0.packet-error-limit 1000
setp hm2_7i76e.0.sserial.port-0.fault-inc 0
setp hm2_7i76e.0.stepgen.00.position-scale 200
setp hm2_7i76e.0.stepgen.00.maxvel 2
setp hm2_7i76e.0.stepgen.00.maxaccel 100
setp hm2_7i76e.0.stepgen.00.steplen 2000
setp hm2_7i76e.0.stepgen.00.stepspace 2000
start
loadusr -w sleep 0.5
'''
# Commands; after each step the outputs are compared.
STEPS = [
    [(CARD, 'output-03', 1), (CARD, 'output-15', 1), (CARD, 'spinout', 50), (CARD, 'spinena', 1), (OTHER, 'output-00', 1)],
    [(CARD, 'output-03', 0), (CARD, 'spinout', 33.3), (CARD, 'spindir', 1), (OTHER, 'output-15', 1)],
    [(CARD, 'spinout', 250), (CARD, 'spinena-invert', 1)],
    [(CARD, 'spinout', -20), (CARD, 'output-07-invert', 1), (OTHER, 'output-15-invert', 1)],
    [(CARD, 'spinout-scalemax', 3000), (CARD, 'spinout-maxlim', 2000), (CARD, 'spinout', 1234.5)],
    [(CARD, 'spinout', 2999), (CARD, 'spinena', 0)],
    [(CARD, 'spinout-minlim', 300), (CARD, 'spinout', 0)],
]
MOVES = (0.5, 1.5, 2.6, 0.25)
LAMP = 'hm2_7i76e.0.led.CR01'


def hal(mode):
    lines = [START.replace('MODE', mode)]
    for number, step in enumerate(STEPS):
        lines += [f'setp {card}.{pin} {value}' for card, pin, value in step]
        lines += ['loadusr -w sleep 0.3', f'setp {LAMP} {(number + 1) % 2}', 'loadusr -w sleep 0.1']
    lines += [f'setp {CARD}.analogin1-scalemax 10'] if mode != '0' else []
    lines += [f'setp {CARD}.enc1.scale 37'] if mode == '2' else []
    lines += ['setp hm2_7i76e.0.stepgen.00.enable 1']
    for move in MOVES:
        # The motor is not at a step edge when the inputs are read.
        lines += [f'setp hm2_7i76e.0.stepgen.00.position-cmd {move + 0.0025}', 'loadusr -w sleep 2', 'show pin hm2_7i76e.0.7i']
    return '\n'.join(lines + ['show param hm2_7i76e.0.7i', 'show pin hm2_7i76e.0.sserial', ''])


def outputs(log):
    """The words of the cards from the last exchange, at each change of the lamp."""
    words, taken, lamp, steps = {}, {}, '00000000', []
    for address, value in re.findall(r'W0 0x(5[A-F]\w\w|0200) 1x32 (\w+)', log):
        if address == '0200':
            if value != lamp:
                steps.append(taken)
            lamp = value
        elif address == '5A00' and int(value, 16) & 0xF000 == 0x1000:
            taken = {key: word for key, word in words.items() if key[:2] in ('5D', '5E', '5F')}
        else:
            words[address] = value
    return steps


def inputs(output):
    """Pins and parameters of the cards in the order in which they are shown."""
    return re.findall(r'^\s+\d+\s+(?:bit|float|s32|u32)\s+(?:IN|OUT|I/O|RW|RO)\s+(\S+)\s+(hm2_7i76e\.0\.7i\S+)', output, re.M)


def same(one, other):
    try:
        return math.isclose(float(one), float(other), rel_tol=1e-5, abs_tol=1e-6)
    except ValueError:
        return one == other


def compare(mode, theirs, ours):
    problems = []
    words = [outputs(log) for _, log in (theirs, ours)]
    if len(words[0]) != len(STEPS):
        problems.append(f'mode {mode}: {len(words[0])} steps of LinuxCNC, not {len(STEPS)}')
    for number, pair in enumerate(zip(*words)):
        for register in sorted(set(pair[0]) | set(pair[1])):
            one, other = (side.get(register, '00000000') for side in pair)
            if one != other:
                problems.append(f'mode {mode}, step {number}: register {register}: LinuxCNC {one}, Millwright {other}')
    pins = [inputs(output) for output, _ in (theirs, ours)]
    if len(pins[0]) != len(pins[1]) or len(words[0]) != len(words[1]):
        problems.append(f'mode {mode}: {len(pins[0])} and {len(pins[1])} pins, {len(words[0])} and {len(words[1])} steps')
    problems += [f'mode {mode}: {one[1]}: LinuxCNC {one[0]}, Millwright {other[1]} {other[0]}'
                 for one, other in zip(*pins) if one[1] != other[1] or not same(one[0], other[0])]
    for name, (output, _) in (('LinuxCNC', theirs), ('Millwright', ours)):
        if not re.search(r'0x00000003\s+hm2_7i76e\.0\.sserial\.port-0\.port_state$', output, re.M):
            problems.append(f'mode {mode}: smart serial of {name} does not run:\n{output[-1000:]}')
    return problems, len(pins[0]), sum(len(step) for step in words[0])


def main():
    reason = linuxcnc_board.reason_to_skip()
    if reason:
        print(f'skipped: {reason}')
        return linuxcnc_board.SKIPPED
    board, halrun = (str(pathlib.Path(word).resolve()) for word in sys.argv[1:3])
    status = 0
    for mode in '012':
        theirs, ours = (both_drivers.run(program, board, '7i76e', (PHYSICS, hal(mode))) for program in (both_drivers.LINUXCNC, halrun))
        problems, pins, words = compare(mode, theirs, ours)
        print('\n'.join(problems) or f'mode {mode}: {pins} values of pins and {words} words of outputs are the same')
        status = 1 if problems else status
    return status


if __name__ == '__main__':
    sys.exit(main())
