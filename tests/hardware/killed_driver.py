#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The outputs of a simulated board switch off within its watchdog time when its driver is killed, suspended, ended or unloaded.

usage: killed_driver.py BIN [--count N] [--seed S] [--margin-ms MS]
The realtime process of a HAL file that moves a motor receives a signal at a random time. Then this script queries the board with
its own packets for the time at which its pins became inputs. Exit status 0: within the watchdog time plus a margin (10 ms) for
the processes of this computer, and the outputs stay off until an operator clears the watchdog.
"""
import argparse
import os
import pathlib
import random
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

WATCHDOG_MS = 20
READ_REGISTERS = 0x4200  # address follows, 32 bit, space 0
INCREMENT = 0x80
DIRECTION, STATUS = 0x1100, 0x0D00


class Board:
    """The registers that an independent client reads from the board."""

    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(1)
        self.socket.connect(('127.0.0.1', port))

    def read(self, address, count=1):
        self.socket.send(struct.pack('<HH', READ_REGISTERS | INCREMENT | count, address))
        return struct.unpack(f'<{count}I', self.socket.recv(1500))

    def has_outputs(self):
        return any(self.read(DIRECTION, 3))


def hal_file(port):
    return f'''
loadrt hostmot2
loadrt hm2_eth board_ip=127.0.0.1:{port} config="num_stepgens=3"
loadrt threads name1=servo period1=1000000
addf hm2_7i76e.0.read servo
addf hm2_7i76e.0.write servo
setp hm2_7i76e.0.watchdog.timeout_ns {WATCHDOG_MS}000000
setp hm2_7i76e.0.packet-error-limit 100000
setp hm2_7i76e.0.stepgen.00.position-scale 200
setp hm2_7i76e.0.stepgen.00.steplen 2000
setp hm2_7i76e.0.stepgen.00.stepspace 2000
setp hm2_7i76e.0.stepgen.00.control-type 1
setp hm2_7i76e.0.stepgen.00.maxaccel 100
setp hm2_7i76e.0.stepgen.00.velocity-cmd 3
setp hm2_7i76e.0.stepgen.00.enable 1
start
loadusr -w sleep 600
'''


def realtime_process(instance):
    """The process millwright-rt of a HAL instance."""
    wanted = ['--instance', instance]
    for path in pathlib.Path('/proc').glob('[0-9]*/cmdline'):
        try:
            words = path.read_text().split('\0')
        except OSError:
            continue
        if words[0].endswith('millwright-rt') and words[1:3] == wanted:
            return int(path.parent.name)
    return None


def wait_for(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            sys.exit(f'FAILED: {what}')
        time.sleep(0.0005)
    return time.monotonic()


def one_kill(options, port, kind, rng):
    board = Board(port)
    with tempfile.NamedTemporaryFile('w', suffix='.hal') as hal:
        hal.write(hal_file(port))
        hal.flush()
        instance = f'killed-{os.getpid()}'
        driver = subprocess.Popen([f'{options.binaries}/halrun', '-f', hal.name], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
                                  env=dict(os.environ, MILLWRIGHT_INSTANCE=instance))
        try:
            wait_for(board.has_outputs, 10, f'{kind}: the outputs are never on')
            time.sleep(rng.uniform(0, 0.3))
            pid = realtime_process(instance)
            if pid is None:
                sys.exit(f'FAILED: {kind}: no realtime process')
            begin = time.monotonic()
            if kind == 'ended':
                driver.send_signal(signal.SIGINT)
            else:
                os.kill(pid, signal.SIGSTOP if kind == 'suspended' else signal.SIGKILL)
            seconds = 5 if kind == 'ended' else 1
            took_ms = 1000 * (wait_for(lambda: not board.has_outputs(), seconds, f'{kind}: the outputs stay on') - begin)
            if kind != 'ended' and took_ms > WATCHDOG_MS + options.margin_ms:
                sys.exit(f'FAILED: {kind}: the outputs were on for {took_ms:.1f} ms')
            if kind == 'suspended':
                time.sleep(rng.uniform(0.05, 3))
                os.kill(pid, signal.SIGCONT)
            for _ in range(50):
                if board.has_outputs() or board.read(STATUS)[0] != 1:
                    sys.exit(f'FAILED: {kind}: the outputs came on again without an operator')
                time.sleep(0.004)
        finally:
            driver.send_signal(signal.SIGINT)
            try:
                driver.communicate(timeout=15)
            except subprocess.TimeoutExpired:
                os.killpg(driver.pid, signal.SIGKILL)
                sys.exit(f'FAILED: {kind}: halrun does not end')
    return took_ms


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('binaries')
    parser.add_argument('--count', type=int, default=9)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--margin-ms', type=float, default=10)
    options = parser.parse_args()
    rng = random.Random(options.seed)
    slowest = {}
    for i in range(options.count):
        kind = ('killed', 'suspended', 'ended')[i % 3]
        port = rng.randrange(20000, 60000)
        board = subprocess.Popen([f'{options.binaries}/hm2-board', '--listen', f'127.0.0.1:{port}', '--model', '7i76e'], stdout=subprocess.PIPE, text=True)
        try:
            if not board.stdout.readline().startswith('hm2-board: '):
                continue  # another program uses this port
            slowest[kind] = max(slowest.get(kind, 0), one_kill(options, port, kind, rng))
        finally:
            board.kill()
            board.wait()
    print('outputs off after at most ' + ', '.join(f'{ms:.1f} ms ({kind})' for kind, ms in slowest.items()) + f'; watchdog {WATCHDOG_MS} ms')


if __name__ == '__main__':
    main()
