#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests mb2hal with a Modbus device that is written from the protocol specification, over TCP and over RTU on a pseudo-terminal.

usage: mb2hal.py BIN_FOLDER [MB2HAL]       MB2HAL: another program of that name, for comparison
"""
import os
import pathlib
import pty
import random
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import tty

from modbus_slave import FAILED, expect, serve_rtu, serve_tcp


class Device:
    """Coils, inputs and registers of one slave; answers requests of the function codes that mb2hal knows."""

    def __init__(self):
        self.coils, self.inputs = [0] * 100, [i % 3 == 0 for i in range(100)]
        self.holding, self.given = [0] * 100, [i * 700 % 65536 for i in range(100)]
        self.requests, self.is_silent, self.refuses = [], False, 0

    def answer(self, slave, request):
        if slave != 7 or self.is_silent:
            return None
        code, first, count = request[0], *struct.unpack('>HH', request[1:5])
        self.requests.append(code)
        if self.refuses or first + (count if code in (1, 2, 3, 4, 15, 16) else 1) > 100:
            return bytes([code | 0x80, self.refuses or 2])
        if code in (1, 2):
            bits = (self.coils if code == 1 else self.inputs)[first:first + count]
            data = [sum(bit << k for k, bit in enumerate(map(int, bits[i:i + 8]))) for i in range(0, count, 8)]
            return bytes([code, len(data), *data])
        if code in (3, 4):
            words = (self.holding if code == 3 else self.given)[first:first + count]
            return bytes([code, 2 * count]) + struct.pack(f'>{count}H', *words)
        if code == 5:
            self.coils[first] = int(count == 0xff00)
        elif code == 6:
            self.holding[first] = count
        elif code == 15:
            for i in range(count):
                self.coils[first + i] = request[6 + i // 8] >> i % 8 & 1
        else:
            self.holding[first:first + count] = struct.unpack(f'>{count}H', request[6:6 + 2 * count])
        return request[:5]


TRANSACTIONS = '''
MB_SLAVE_ID=7
MB_TX_CODE=fnct_01_read_coils
FIRST_ELEMENT=0
NELEMENTS=10
HAL_TX_NAME=coils
MB_RESPONSE_TIMEOUT_MS=200
DEBUG=1
[TRANSACTION_01]
MB_TX_CODE=fnct_02_read_discrete_inputs
FIRST_ELEMENT=3
NELEMENTS=11
[TRANSACTION_02]
MB_TX_CODE=fnct_04_read_input_registers
FIRST_ELEMENT=80
PIN_NAMES=speed,torque,volts
HAL_TX_NAME=given
[TRANSACTION_03]
MB_TX_CODE=fnct_03_read_holding_registers
FIRST_ELEMENT=20
NELEMENTS=4
HAL_TX_NAME=back
[TRANSACTION_04]
MB_TX_CODE=fnct_16_write_multiple_registers
FIRST_ELEMENT=20
NELEMENTS=3
HAL_TX_NAME=set
[TRANSACTION_05]
MB_TX_CODE=fnct_06_write_single_register
FIRST_ELEMENT=23
NELEMENTS=1
HAL_TX_NAME=one
[TRANSACTION_06]
MB_TX_CODE=fnct_15_write_multiple_coils
FIRST_ELEMENT=0
NELEMENTS=9
HAL_TX_NAME=out
[TRANSACTION_07]
MB_TX_CODE=fnct_05_write_single_coil
FIRST_ELEMENT=9
NELEMENTS=1
HAL_TX_NAME=last
'''
class Hal:
    """A HAL with the component inside a `with` statement."""

    def __init__(self, programs, folder, program, link):
        self.programs, self.folder = programs, folder
        (folder / 'mb.ini').write_text('[MB2HAL_INIT]\nVERSION=1.1\nTOTAL_TRANSACTIONS=8\n[TRANSACTION_00]\n' + link + TRANSACTIONS)
        (folder / 'mb.hal').write_text(f'loadusr -W {program} config=mb.ini\n')
        self.env = {**os.environ, 'MILLWRIGHT_INSTANCE': f'mb2hal-{os.getpid()}', 'LD_LIBRARY_PATH': f'{programs.parent}/lib/millwright', 'LC_ALL': 'C'}

    def __enter__(self):
        subprocess.run([self.programs / 'realtime', 'start'], env=self.env, check=True, timeout=30)
        with open(self.folder / 'said', 'w') as said:
            done = subprocess.run([self.programs / 'halcmd', '-f', 'mb.hal'], cwd=self.folder, env=self.env, stdout=said, stderr=said, stdin=subprocess.DEVNULL,
                                  check=False, timeout=40)
        expect(done.returncode == 0, 'it gets ready', self.said())
        return self

    def __exit__(self, *_):
        done = subprocess.run([self.programs / 'halrun', '-U'], env=self.env, check=False, capture_output=True, text=True, timeout=30)
        expect(done.returncode == 0, 'it ends with HAL', done.stderr)

    def said(self):
        return (self.folder / 'said').read_text()

    def get(self, *names):
        words = [self.programs / 'halcmd', '-s', '-f', '/dev/stdin']
        done = subprocess.run(words, env=self.env, input=''.join(f'getp mb2hal.{name}\n' for name in names), capture_output=True, text=True, check=False, timeout=30)
        return done.stdout.split()

    def set(self, **pins):
        lines = ''.join(f'setp mb2hal.{name} {value}\n' for name, value in pins.items())
        done = subprocess.run([self.programs / 'halcmd', '-f', '/dev/stdin'], env=self.env, input=lines, capture_output=True, text=True, check=False, timeout=30)
        expect(done.returncode == 0, 'pins are set', done.stderr)

    def until(self, what, holds):
        end = time.monotonic() + 20
        while time.monotonic() < end:
            if holds():
                return
            time.sleep(0.03)
        expect(False, what, self.said()[-500:])


def check(programs, folder, program, link, device, seed):
    rng = random.Random(seed)
    with Hal(programs, folder, program, link) as hal:
        hal.until('inputs are read', lambda: hal.get(*(f'01.{i:02}.bit' for i in range(11))) == ['TRUE' if device.inputs[3 + i] else 'FALSE' for i in range(11)])
        hal.until('registers are read by name', lambda: hal.get('given.speed.int', 'given.torque.float', 'given.volts.int') == [str(device.given[80 + i]) for i in range(3)])
        expect(hal.get('01.00.bit-inv') == ['FALSE'], 'the inverse of a bit')
        for _ in range(3):
            words = [rng.randrange(65536) for _ in range(4)]
            bits = [rng.randrange(2) for _ in range(10)]
            hal.set(**{f'set.{i:02}.float': words[i] - 5 for i in range(3)}, **{f'set.{i:02}.int': 5 for i in range(3)}, **{'one.00.int': words[3]},
                    **{f'out.{i:02}.bit': bits[i] for i in range(9)}, **{'last.00.bit': bits[9]})
            hal.until('registers are written', lambda w=words: device.holding[20:24] == w)
            hal.until('coils are written', lambda b=bits: device.coils[:10] == b)
            hal.until('what is written is read back', lambda w=words: hal.get(*(f'back.{i:02}.int' for i in range(4))) == [str(word) for word in w])
            hal.until('coils are read back', lambda b=bits: hal.get(*(f'coils.{i:02}.bit' for i in range(10))) == ['TRUE' if bit else 'FALSE' for bit in b])
        hal.set(**{'set.00.float': 70000, 'set.01.float': -3.5, 'set.01.int': 0, 'set.02.float': 2.9, 'set.02.int': 0})
        # LinuxCNC's mb2hal turns 70000 into 4464; only that case differs.
        hal.until('registers are limited, negative ones have a sign', lambda: device.holding[20:23] == [65535, 65533, 2])
        hal.set(**{'set.00.int': -32768, 'set.00.float': -40000})
        hal.until('and limited, too', lambda: device.holding[20] == 32768)
        before = hal.get('given.speed.int')
        device.is_silent = True
        hal.until('a device that is silent is counted', lambda: int(hal.get('given.num_errors')[0]) > 0 and int(hal.get('set.num_errors')[0]) > 0)
        expect(hal.get('given.speed.int') == before, 'what was read last stays')
        device.is_silent = False
        device.given[80] = 4711
        hal.until('it is read again when it answers', lambda: hal.get('given.speed.int') == ['4711'])
        device.refuses = 3
        counted = int(hal.get('one.num_errors')[0])
        hal.until('an error answer is counted', lambda: int(hal.get('one.num_errors')[0]) > counted)
        device.refuses = 0
        hal.set(**{'one.00.int': 99})
        hal.until('it is written again', lambda: device.holding[23] == 99)
        expect(sum('slave 7' in line for line in hal.said().splitlines()) < 60, 'a lasting error is reported once', hal.said())


def check_wrong_files(programs, folder):
    for text, wanted in (('[MB2HAL_INIT]\nTOTAL_TRANSACTIONS=1\n', 'section [TRANSACTION_00] is missing'),
                         ('[MB2HAL_INIT]\nTOTAL_TRANSACTIONS=1\n[TRANSACTION_00]\nLINK_TYPE=radio\n', 'LINK_TYPE = radio: tcp or serial is expected'),
                         ('[MB2HAL_INIT]\nTOTAL_TRANSACTIONS=1\n[TRANSACTION_00]\nLINK_TYPE=tcp\nTCP_IP=127.0.0.1\nMB_SLAVE_ID=1\nMB_TX_CODE=fnct_09\nFIRST_ELEMENT=0\nNELEMENTS=1\n', '7:12: error'),
                         ('[MB2HAL_INIT]\nTOTAL_TRANSACTIONS=1\n[TRANSACTION_00]\nLINK_TYPE=tcp\nTCP_IP=::1\nMB_SLAVE_ID=1\nMB_TX_CODE=fnct_03_read_holding_registers\nFIRST_ELEMENT=65535\nNELEMENTS=2\n', 'up to address 65535'),
                         ('[MB2HAL_INIT]\nTOTAL_TRANSACTIONS=0\n', 'TOTAL_TRANSACTIONS = 0')):
        (folder / 'bad.ini').write_text(text)
        done = subprocess.run([programs / 'mb2hal', 'config=bad.ini'], cwd=folder, capture_output=True, text=True, check=False, timeout=20)
        expect(done.returncode == 1 and wanted in done.stderr, wanted, done.returncode, done.stderr)


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    program = sys.argv[2] if len(sys.argv) > 2 else programs / 'mb2hal'
    with tempfile.TemporaryDirectory(prefix='mw_mb2hal_') as name:
        folder = pathlib.Path(name)
        device = Device()
        with socket.create_server(('127.0.0.1', 0)) as listener:
            threading.Thread(target=serve_tcp, args=(device, listener), daemon=True).start()
            check(programs, folder, program, f'LINK_TYPE=tcp\nTCP_IP=127.0.0.1\nTCP_PORT={listener.getsockname()[1]}', device, 1)
        device = Device()
        line, other = pty.openpty()
        tty.setraw(other)
        threading.Thread(target=serve_rtu, args=(device, line), daemon=True).start()
        check(programs, folder, program, f'LINK_TYPE=serial\nSERIAL_PORT={os.ttyname(other)}\nSERIAL_BAUD=115200\nSERIAL_BITS=8\nSERIAL_PARITY=none\nSERIAL_STOP=1\nSERIAL_DELAY_MS=1', device, 2)
        if len(sys.argv) == 2:
            check_wrong_files(programs, folder)
    print(f'{len(FAILED)} failed')
    return 1 if FAILED else 0


if __name__ == '__main__':
    sys.exit(main())
