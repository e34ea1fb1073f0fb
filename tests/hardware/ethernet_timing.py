#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures cycle times with one and with two boards over virtual Ethernet links at 1 kHz.

usage: ethernet_timing.py BIN [--seconds N] [--limit N] [--cases one,two,loss,delay] (as root)
Each board has a separate network namespace; driver and boards have SCHED_FIFO. The times are from the record of cycles, which
doctor also reads.
Prints a table; exit status 0 done, 77 skipped with the reason.
"""
import argparse
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
HEADER = struct.Struct('<II48s48sqIB3xq')
CYCLE = struct.Struct('<qqqqIiHHHBx')
CYCLES = 10_000
STOPPING_FAULTS = (1, 2)
OUTCOMES = ('done', 'no answer', 'send failed', 'receive failed', 'wrong size', 'write lost', 'other board')


def run(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True)


class Links:
    """Namespace DRIVER with a link to each of the namespaces BOARD0, BOARD1."""

    def __init__(self, count):
        self.names = [f'mwt{os.getpid()}d'] + [f'mwt{os.getpid()}b{i}' for i in range(count)]
        for name in self.names:
            run('ip', 'netns', 'add', name)
            run('ip', '-n', name, 'link', 'set', 'lo', 'up')
        for i in range(count):
            a, b = f'mwa{i}', f'mwb{i}'
            run('ip', '-n', self.names[0], 'link', 'add', a, 'type', 'veth', 'peer', 'name', b, 'netns', self.names[1 + i])
            # The driver makes a fixed ARP entry of the address in the board's EEPROM.
            run('ip', '-n', self.names[1 + i], 'link', 'set', b, 'address', '00:60:1B:16:00:01')
            for name, link, last in ((self.names[0], a, 1), (self.names[1 + i], b, 121)):
                run('ip', '-n', name, 'address', 'add', f'192.168.{10 + i}.{last}/24', 'dev', link)
                run('ip', '-n', name, 'link', 'set', link, 'up')

    def command(self, i, *words):
        return ['ip', 'netns', 'exec', self.names[i], *words]

    def remove(self):
        for name in self.names:
            subprocess.run(['ip', 'netns', 'delete', name], capture_output=True)


def hal_file(count, seconds, limit):
    addresses = ','.join(f'192.168.{10 + i}.121' for i in range(count))
    config = ','.join(['num_encoders=1 num_stepgens=5'] * count)
    lines = ['loadrt hostmot2', f'loadrt hm2_eth board_ip={addresses} config="{config}" firewall=none', 'loadrt threads name1=servo period1=1000000']
    boards = [f'hm2_7i76e.{i}' for i in range(count)]
    if count > 1:
        lines += [f'addf {board}.read-request servo' for board in boards]
    lines += [f'addf {board}.read servo' for board in boards] + [f'addf {board}.write servo' for board in boards]
    for board in boards:
        lines += [f'setp {board}.packet-error-limit {limit}', f'setp {board}.watchdog.timeout_ns 100000000']
        for i in range(5):
            lines += [f'setp {board}.stepgen.0{i}.position-scale 200', f'setp {board}.stepgen.0{i}.steplen 2000', f'setp {board}.stepgen.0{i}.stepspace 2000',
                      f'setp {board}.stepgen.0{i}.control-type 1', f'setp {board}.stepgen.0{i}.maxaccel 100', f'setp {board}.stepgen.0{i}.velocity-cmd {i + 1}',
                      f'setp {board}.stepgen.0{i}.enable 1']
    lines += ['start', f'loadusr -w sleep {seconds}', 'show param *io_error', 'show pin *packet*', 'show pin servo.time', 'stop']
    return '\n'.join(lines) + '\n'


def read_cycles(board):
    data = pathlib.Path(f'/dev/shm/millwright-cycles.{os.getuid()}.{board}').read_bytes()
    header = HEADER.unpack_from(data)
    if header[0] != 0x4D574359 or header[1] != 1:
        sys.exit('the record of cycles has another layout than this script')
    # After a stop, the ring contains the cycles before it.
    stopped = header[6] in STOPPING_FAULTS
    ring = header[5] if not stopped else 1 - header[5]
    first = HEADER.size + ring * (CYCLES * CYCLE.size + 8)
    count = struct.unpack_from('<Q', data, first + CYCLES * CYCLE.size)[0]
    return [CYCLE.unpack_from(data, first + (i % CYCLES) * CYCLE.size) for i in range(max(0, count - CYCLES), max(0, count - 1))], stopped


def at(values, part):
    values = sorted(values)
    return values[min(len(values) - 1, int(part * len(values)))] / 1000 if values else float('nan')


def measure(options, count, faults):
    binaries, seconds = options.binaries, options.seconds
    links = Links(count)
    boards = []
    with tempfile.TemporaryDirectory() as folder:
        try:
            for i in range(count):
                words = [f'{binaries}/hm2-board', '--listen', f'192.168.{10 + i}.121', '--model', '7i76e']
                if faults:
                    path = pathlib.Path(folder) / 'faults.txt'
                    path.write_text(faults)
                    words += ['--faults', str(path)]
                boards.append(subprocess.Popen(links.command(1 + i, 'chrt', '-f', '60', *words), stdout=subprocess.PIPE))
                boards[-1].stdout.readline()
            hal = pathlib.Path(folder) / 'timing.hal'
            hal.write_text(hal_file(count, seconds, options.limit))
            done = subprocess.run(links.command(0, f'{binaries}/halrun', '-f', str(hal)), capture_output=True, text=True, timeout=seconds + 60)
            if done.returncode != 0:
                sys.exit(f'halrun: {done.stdout}{done.stderr}')
            read = [read_cycles(f'hm2_7i76e.{i}') for i in range(count)]
            cycles, stopped = [one for one, _ in read], any(stop for _, stop in read)
        finally:
            for board in boards:
                board.kill()
                board.wait()
            links.remove()
    # Time from the first request to the last write of a thread cycle.
    busy = [max(one[3] for one in together) - min(one[0] for one in together) for together in zip(*cycles) if all(one[3] for one in together)]
    answer = [one[2] - one[1] for one in cycles[0] if one[2]]
    late = [b[0] - a[0] - 1_000_000 for a, b in zip(cycles[0], cycles[0][1:])]
    counts = {name: sum(one[9] == i for one in cycles[0]) for i, name in enumerate(OUTCOMES) if i}
    return busy, answer, late, {name: n for name, n in counts.items() if n}, stopped


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('binaries')
    parser.add_argument('--seconds', type=int, default=10)
    parser.add_argument('--limit', type=int, default=1000000, help='packet-error-limit; 10 is the default of the driver')
    parser.add_argument('--cases', default='one,two,loss 0.1 %,loss 1 %,loss 5 %,duplicates 5 %,delay 0.5 ms')
    options = parser.parse_args()
    if os.geteuid() != 0:
        print('skipped: network namespaces need root')
        return SKIPPED
    faults = {'one': '', 'two': '', 'loss 0.1 %': 'to_board loss=0.001\nto_host loss=0.001\n', 'loss 1 %': 'to_board loss=0.01\nto_host loss=0.01\n',
              'loss 5 %': 'to_board loss=0.05\nto_host loss=0.05\n', 'duplicates 5 %': 'to_board duplicate=0.05\nto_host duplicate=0.05\n',
              'delay 0.5 ms': 'to_host delay_us=500\n'}
    print(f'{"case":16} {"read to write: p50":>19} {"p99":>7} {"p99.9":>7} {"max us":>8} | {"answer p50":>10} {"p99.9":>7} | {"thread late p99.9":>17} | of the last 10 s')
    medians = {}
    for case in options.cases.split(','):
        busy, answer, late, counts, stopped = measure(options, 2 if case == 'two' else 1, faults[case])
        medians[case] = at(busy, 0.5)
        print(f'{case:16} {at(busy, 0.5):19.0f} {at(busy, 0.99):7.0f} {at(busy, 0.999):7.0f} {at(busy, 1):8.0f} | {at(answer, 0.5):10.0f} {at(answer, 0.999):7.0f} '
              f'| {at(late, 0.999):17.0f} | {counts or "no failure"}{" STOPPED" if stopped else ""}')
    if 'one' in medians and 'two' in medians:
        print(f'two boards take {medians["two"] / medians["one"]:.2f} times one')
    return 0


if __name__ == '__main__':
    sys.exit(main())
