#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs gs2_vfd and vfdb_vfd with drives that this file simulates: registers on a pseudo-terminal, with a motor.

usage: drives.py BIN_FOLDER
"""
import collections
import os
import pathlib
import pty
import struct
import subprocess
import sys
import tempfile
import threading
import time
import tty

from modbus_slave import FAILED, expect, serve_rtu


class Drive:
    """Registers; the frequency follows the last command, and each change of a command is recorded in `told`."""

    def __init__(self, speed):
        self.registers, self.told, self.speed, self.is_silent, self.follows = collections.defaultdict(int), [], speed, False, True

    def answer(self, slave, request):
        if slave != 1 or self.is_silent:
            return None
        code, first, count = request[0], *struct.unpack('>HH', request[1:5])
        if code == 6:
            if first not in self.registers or self.registers[first] != count:
                self.told.append((first, count))
            self.registers[first] = count
            return request[:5]
        self.move()
        words = [self.registers.get(first + i, 0) for i in range(count)]
        return bytes([code, 2 * count]) + struct.pack(f'>{count}H', *words)

    def move(self):
        if self.follows:
            self.registers[0x2103] = self.registers.get(self.speed, 0) if self.runs() else 0

    def count(self, what):
        return self.told.count(what)


class Gs2(Drive):
    def __init__(self):
        super().__init__(0x91a)
        self.registers.update({0x2100: 3, 0x2101: 163, 0x2104: 12, 0x2105: 3210, 0x2106: 2300, 0x2107: 1730, 0x2108: 400, 0x2109: 0, 0x210a: 87, 0x210b: 105, 0x210c: 121})

    def runs(self):
        return self.registers.get(0x91b) == 1


class Vfdb(Drive):
    def __init__(self):
        super().__init__(0x2001)
        self.registers.update({0x100: 8000, 0x2100: 4, 0x2101: 11, 0x2104: 41, 0x2106: 61, 0x210b: 111, 0x210c: 120})

    def runs(self):
        return self.registers.get(0x2000, 0) & 3 == 2


class Hal:
    """A HAL with the component inside a `with` statement."""

    def __init__(self, programs, folder, drive, program, words):
        self.programs, self.folder = programs, folder
        line, self.other = pty.openpty()
        tty.setraw(self.other)
        threading.Thread(target=serve_rtu, args=(drive, line), daemon=True).start()
        device = os.ttyname(self.other)
        (folder / 'drive.ini').write_text(f'[VFD-B]\nDEVICE = {device}\nBAUD = 9600\nPARITY = None\nMOTOR_HZ = 50\nMOTOR_RPM = 1410\n')
        (folder / 'drive.hal').write_text(f'loadusr -Wn spindle {programs}/{program} -n spindle {words.replace("DEVICE", device)}\nsetp spindle.loop-time 0.02\n')
        self.env = {**os.environ, 'MILLWRIGHT_INSTANCE': f'drives-{os.getpid()}', 'LC_ALL': 'C'}

    def __enter__(self):
        subprocess.run([self.programs / 'realtime', 'start'], env=self.env, check=True, timeout=30)
        with open(self.folder / 'said', 'w') as said:
            done = subprocess.run([self.programs / 'halcmd', '-f', 'drive.hal'], cwd=self.folder, env=self.env, stdout=said, stderr=said, stdin=subprocess.DEVNULL,
                                  check=False, timeout=40)
        expect(done.returncode == 0, 'it gets ready', self.said())
        return self

    def __exit__(self, *_):
        done = subprocess.run([self.programs / 'halrun', '-U'], env=self.env, check=False, capture_output=True, text=True, timeout=30)
        expect(done.returncode == 0, 'it ends with HAL', done.stderr)

    def said(self):
        return (self.folder / 'said').read_text()

    def run(self, lines):
        return subprocess.run([self.programs / 'halcmd', '-s', '-f', '/dev/stdin'], env=self.env, input=lines, capture_output=True, text=True, check=False, timeout=30)

    def get(self, *names):
        return self.run(''.join(f'getp spindle.{name}\n' for name in names)).stdout.split()

    def set(self, **pins):
        done = self.run(''.join(f'setp spindle.{name.replace("_", "-")} {value}\n' for name, value in pins.items()))
        expect(done.returncode == 0, 'pins are set', done.stderr)

    def until(self, what, holds):
        end = time.monotonic() + 20
        while time.monotonic() < end:
            if holds():
                return
            time.sleep(0.03)
        expect(False, what, self.said()[-500:])

    def is_at_speed(self):
        return self.get('at-speed') == ['TRUE']


def check_gs2(programs, folder):
    drive = Gs2()
    with Hal(programs, folder, drive, 'gs2_vfd', '-d DEVICE -p none -r 9600 -A 20 -D 5 -R') as hal:
        hal.until('it is found', lambda: hal.get('initialized') == ['TRUE'])
        # The first writes of LinuxCNC's program; the spindle is stopped.
        expect(drive.told[:7] == [(0x101, 200), (0x100, 0), (0x102, 50), (0x605, 1), (0x91a, 0), (0x91b, 0), (0x91e, 0)], 'its settings', drive.told)
        values = hal.get('status-1', 'status-2', 'output-current', 'DC-bus-volts', 'output-voltage', 'motor-RPM', 'scale-frequency', 'power-factor', 'load-percentage',
                         'firmware-revision', 'is-stopped', 'at-speed')
        expect(values == ['3', '163', '1.2', '321', '230', '1730', '40', '87', '10.5', '121', 'TRUE', 'FALSE'], 'its state', values)
        hal.set(speed_command=865, spindle_on=1)
        hal.until('it is at speed', hal.is_at_speed)
        # The direction before it runs; half of the motor's speed is half of its frequency, 30.0 Hz.
        expect(drive.told[-3:] == [(0x91a, 300), (0x91c, 0), (0x91b, 1)], 'it runs forward', drive.told)
        expect(hal.get('frequency-out', 'is-stopped') == ['30', 'FALSE'], 'its frequency')
        drive.follows = False
        hal.set(speed_command=-900)
        hal.until('the new speed is written, without a sign', lambda: drive.registers[0x91a] == 312)
        hal.until('it is not at speed yet', lambda: not hal.is_at_speed())
        drive.follows = True
        hal.until('and then it is', hal.is_at_speed)
        hal.set(spindle_fwd=0)
        hal.until('the direction is written', lambda: drive.registers[0x91c] == 1)
        hal.set(spindle_on=0)
        hal.until('it stops', lambda: drive.registers[0x91b] == 0 and hal.get('is-stopped', 'at-speed') == ['TRUE', 'FALSE'])
        hal.set(spindle_fwd=1, err_reset=1)
        hal.until('errors are reset', lambda: drive.registers[0x91e] == 1)
        expect(drive.registers[0x91c] == 1, 'a direction is for a spindle that is to run')
        hal.set(spindle_on=1, speed_command=1e9)
        hal.until('a speed is never another one', lambda: drive.registers[0x91a] == 65535)
        hal.set(speed_command=865, enable=0)
        hal.until('a drive that is not enabled is stopped', lambda: drive.registers[0x91b] == 0 and hal.get('initialized') == ['FALSE'])
        told = len(drive.told)
        hal.set(enable=1)
        hal.until('it is begun again', lambda: hal.get('initialized') == ['TRUE'])
        time.sleep(0.2)
        expect((0x91b, 1) not in drive.told[told:], 'it does not start by itself')
        hal.set(spindle_on=0)
        time.sleep(0.1)
        hal.set(spindle_on=1)
        hal.until('it starts again', hal.is_at_speed)
        drive.is_silent = True
        hal.until('no answer is no speed, and counted', lambda: not hal.is_at_speed() and int(hal.get('error-count')[0]) > 0)
        hal.until('it is lost', lambda: int(hal.get('error-count')[0]) > 12)
        drive.registers[0x91b], drive.is_silent, told = 0, False, len(drive.told)
        hal.until('it is back', lambda: hal.get('initialized') == ['TRUE'])
        time.sleep(0.2)
        expect((0x91b, 1) not in drive.told[told:], 'a drive that was off does not start by itself')
        expect(hal.said().count('Connection timed out') == 1 and hal.said().count('answers again') == 1, 'it is reported once', hal.said())
        hal.set(spindle_on=0)
        time.sleep(0.1)
        hal.set(spindle_on=1)
        hal.until('it runs', lambda: drive.registers[0x91b] == 1)
    expect(drive.registers[0x91b] == 0, 'it is stopped when the component has ended')


def check_vfdb(programs, folder):
    drive = Vfdb()
    with Hal(programs, folder, drive, 'vfdb_vfd', '-I drive.ini') as hal:
        hal.until('it is found', lambda: hal.get('modbus-ok') == ['TRUE'])
        values = hal.get('error-code', 'status', 'frequency-limit', 'max-rpm', 'motor-RPM', 'motor-RPS', 'output-current', 'output-voltage', 'inverter-load-percentage',
                         'is-stopped', 'rpm-limit', 'nameplate-HZ')
        expect(values == ['4', '11', '80', '2256', '120', '2', '4.1', '6.1', '111', 'TRUE', '1410', '50'], 'its state', values)
        expect(drive.registers[0x2000] == 0, 'it is not taken before enable')
        hal.set(enable=1, speed_command=705)
        hal.until('it is used, and is stopped', lambda: drive.registers[0x2000] == 17 and drive.registers[0x2001] == 2500)
        for command, speed, word, hz in ((705, 0, 18, 2500), (-705, 0, 34, 2500), (99999, 0, 18, 5000)):
            hal.set(spindle_on=1, speed_command=command)
            hal.until(f'{command} rpm', lambda w=word, h=hz: drive.registers[0x2000] == w and drive.registers[0x2001] == h and hal.is_at_speed())
        hal.set(speed_command=-705, jog_mode=1)
        hal.until('it jogs', lambda: drive.registers[0x2000] == 35 and not hal.is_at_speed())
        hal.set(jog_mode=0, spindle_on=0)
        hal.until('it stops', lambda: drive.registers[0x2000] == 17)
        hal.set(spindle_on=1)
        hal.until('it runs', hal.is_at_speed)
        drive.is_silent = True
        hal.until('no answer', lambda: hal.get('modbus-ok', 'at-speed') == ['FALSE', 'FALSE'] and int(hal.get('error-count')[0]) > 12)
        drive.registers[0x2000], drive.is_silent = 0, False
        hal.until('it is back, and does not start by itself', lambda: drive.registers[0x2000] == 17)
        hal.set(spindle_on=0)
        time.sleep(0.1)
        hal.set(spindle_on=1)
        hal.until('it runs again', hal.is_at_speed)
        hal.set(enable=0)
        hal.until('it is released', lambda: drive.registers[0x2000] == 0)
        hal.set(enable=1)
        hal.until('and taken', hal.is_at_speed)
    expect(drive.registers[0x2000] == 0 and drive.told[-2:] == [(0x2000, 1), (0x2000, 0)], 'it is stopped and released when the component has ended', drive.told[-3:])


def check_wrong_words(programs, folder):
    (folder / 'bad.ini').write_text('[VFD-B]\nBAUD = fast\nPARITY = some\n')
    for words, status, text in ((['gs2_vfd', '--parity', 'some'], 2, 'use even, odd or none'), (['gs2_vfd', '--nmae', 'x'], 2, '--name'),
                                (['vfdb_vfd', '-I', 'bad.ini'], 1, 'bad.ini:2:'), (['vfdb_vfd', '-I', 'bad.ini'], 1, 'use Even, Odd or None'),
                                (['vfdb_vfd', '-I', 'bad.ini', '-S', 'OTHER'], 1, 'no section [OTHER]'), (['vfdb_vfd', '-I', 'none.ini'], 1, 'none.ini')):
        done = subprocess.run([programs / words[0], *words[1:]], cwd=folder, capture_output=True, text=True, check=False, timeout=20)
        expect(done.returncode == status and text in done.stderr, words, done.returncode, done.stderr)


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix='mw_drives_') as name:
        folder = pathlib.Path(name)
        check_gs2(programs, folder)
        check_vfdb(programs, folder)
        check_wrong_words(programs, folder)
    print(f'{len(FAILED)} failed')
    return 1 if FAILED else 0


if __name__ == '__main__':
    sys.exit(main())
