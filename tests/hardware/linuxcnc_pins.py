#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the pins and parameters of our hm2_eth with those of LinuxCNC's on the same simulated boards: name, type, direction.

usage: linuxcnc_pins.py HM2_BOARD HALRUN (as root)
Prints the differences. Exit status: 0 none except our own pins, 1 others, 77 skipped, with the reason.
"""
import pathlib
import re
import sys

import both_drivers
import linuxcnc_board

# Model, its name in HAL, smart serial cards, config=.
CASES = [('7i76e', '7i76e', 'remote 0 card=7i76\nremote 1 card=7i84\n', f'num_encoders=1 num_stepgens=5 sserial_port_0={mode}0xxxxxx')
         for mode in '012'] + [
    ('7i76e', '7i76e', '# no cards\n', 'num_encoders=1 num_stepgens=5'),
    ('7i76e', '7i76e', 'remote 0 card=7i76\nremote 1 card=7i84\n', 'sserial_port_0=x0xxxxxx'),
    ('7i80', '7i80', 'remote 0 card=7i77\nremote 3 card=7i84\n', ''),
]
HAL = '''
loadrt hostmot2
loadrt hm2_eth board_ip=192.168.1.121 config="CONFIG"
loadrt threads name1=servo period1=4000000
show pin hm2_BOARD.0
show param hm2_BOARD.0
'''
ROW = re.compile(r'^\s+\d+\s+(bit|float|s32|u32)\s+(IN|OUT|I/O|RW|RO)\s+\S+\s+(hm2\S+)', re.M)
# On a busy computer LinuxCNC's driver sometimes waits too long for an answer and does not load.
ATTEMPTS = 3
# Times of functions; pins that only ours has.
LEFT_OUT = re.compile(r'\.tmax|\.packets-|\.0\.debug|\.sserial\.port-\d\.fault$')


def rows_of(halrun, board, case):
    model, name, physics, config = case
    texts = physics, HAL.replace('CONFIG', config).replace('BOARD', name)
    for _ in range(ATTEMPTS):
        output, _ = both_drivers.run(halrun, board, model, texts)
        if ROW.search(output):
            break
    else:
        print(f'{halrun} does not load:\n{output[-1500:]}')
    return {(match[3], match[1], match[2]) for match in ROW.finditer(output) if not LEFT_OUT.search(match[3])}


def main():
    reason = linuxcnc_board.reason_to_skip()
    if reason:
        print(f'skipped: {reason}')
        return linuxcnc_board.SKIPPED
    board, halrun = (str(pathlib.Path(word).resolve()) for word in sys.argv[1:3])
    status = 0
    for case in CASES:
        theirs, ours = rows_of(both_drivers.LINUXCNC, board, case), rows_of(halrun, board, case)
        print(f'{case[0]} {case[3]}: {len(theirs & ours)} pins and parameters are the same')
        for what, rows in (('only LinuxCNC', theirs - ours), ('only Millwright', ours - theirs)):
            for row in sorted(rows):
                print(f'{what}: {" ".join(row)}')
        status = 1 if theirs != ours or not ours else status
    return status


if __name__ == '__main__':
    sys.exit(main())
