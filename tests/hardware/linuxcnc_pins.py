#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the pins and parameters of our hm2_eth with those of LinuxCNC's, on the same simulated 7I76E: name, type, direction.

usage: linuxcnc_pins.py HM2_BOARD HALRUN (as root)
Prints the differences. Exit status: 0 there are none but smart serial (which ours does not serve yet) and our own pins, 1 there are others,
77 skipped, with the reason.
"""
import pathlib
import re
import sys
import tempfile

import linuxcnc_board

HAL = '''
loadrt hostmot2
loadrt hm2_eth board_ip=192.168.1.121 config="num_encoders=1 num_stepgens=5"
loadrt threads name1=servo period1=4000000
show pin hm2_7i76e.0
show param hm2_7i76e.0
'''
ROW = re.compile(r'^\s+\d+\s+(bit|float|s32|u32)\s+(IN|OUT|I/O|RW|RO)\s+\S+\s+(hm2\S+)', re.M)
# Smart serial, also the pins that it takes from GPIO; times of functions; counters that only ours has.
LEFT_OUT = re.compile(r'\.(7i76|7i84|sserial)\.|\.tmax|gpio\.01[0-3]\.|\.packets-|\.0\.debug')


def rows_of(halrun, board):
    linuxcnc_board.HALRUN = halrun
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o777)  # the driver of LinuxCNC runs as another user
        output, _ = linuxcnc_board.run(board, folder, '7i76e', linuxcnc_board.PHYSICS, HAL)
    return {(match[3], match[1], match[2]) for match in ROW.finditer(output) if not LEFT_OUT.search(match[3])}


def main():
    reason = linuxcnc_board.reason_to_skip()
    if reason:
        print(f'skipped: {reason}')
        return linuxcnc_board.SKIPPED
    board, halrun = (str(pathlib.Path(word).resolve()) for word in sys.argv[1:3])
    theirs, ours = rows_of('/usr/bin/halrun', board), rows_of(halrun, board)
    for what, rows in (('only LinuxCNC', theirs - ours), ('only Millwright', ours - theirs)):
        for row in sorted(rows):
            print(f'{what}: {" ".join(row)}')
    print(f'{len(theirs & ours)} are the same')
    return 1 if theirs != ours or not ours else 0


if __name__ == '__main__':
    sys.exit(main())
