#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests of shuttle with devices that are named pipes (B6, J4). usage: shuttle_test.py BIN_FOLDER"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BIN = pathlib.Path(sys.argv.pop()).resolve()
# Runs beside the program: writes reports into a pipe and reports the pins. A state that is not reached ends
# it with an error.
DRIVER = '''
import hal, os, sys, time
SHOWN = 'counts', 'spring-wheel-s32', 'spring-wheel-f'
def state(wheel=0):
    """(counts, spring wheel, spring wheel as a part, pressed buttons), and no button is both pressed and not."""
    pins = {one['NAME']: one['VALUE'] for one in hal.get_info_pins() if one['NAME'].startswith(f'shuttle.{wheel}.')}
    numbers = range(sum(name.endswith('-not') for name in pins))
    for n in numbers:
        assert pins[f'shuttle.{wheel}.button-{n}'] != pins[f'shuttle.{wheel}.button-{n}-not'], (n, pins)
    return (*(pins[f'shuttle.{wheel}.{name}'] for name in SHOWN), [n for n in numbers if pins[f'shuttle.{wheel}.button-{n}']])
def wait(wanted, wheel=0):
    end = time.monotonic() + 8
    def same(a, b): return a[0] == b[0] and a[1] == b[1] and abs(a[2] - b[1] / 7) < 1e-12 and a[3] == b[3]
    while not same(state(wheel), (wanted[0], wanted[1], 0, wanted[2])):
        if time.monotonic() > end:
            sys.exit(f'{state(wheel)}, not {wanted}')
        time.sleep(0.002)
def pipe(name='wheel'): return os.open(name, os.O_WRONLY)
def send(out, text): os.write(out, bytes.fromhex(text))
'''


class ShuttleTest(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory(prefix='mw_shuttle_')
        self.folder = pathlib.Path(self.place.name)
        for name in ('wheel', 'second'):
            os.mkfifo(self.folder / name)
        self.env = {**os.environ, 'MILLWRIGHT_INSTANCE': f'shuttle-{os.getpid()}', 'PATH': f'{BIN}:{os.environ["PATH"]}', 'LC_ALL': 'C',
                    'PYTHONPATH': str(BIN.parent / 'lib/python')}

    def tearDown(self):
        self.place.cleanup()

    def run_hal(self, lines, driver='', after=''):
        (self.folder / 'driver.py').write_text(DRIVER + driver)
        (self.folder / 'a.hal').write_text(lines + (f'loadusr -w {sys.executable} driver.py\n' if driver else '') + after)
        done = subprocess.run([BIN / 'halrun', '-s', 'a.hal'], cwd=self.folder, env=self.env, capture_output=True, text=True, timeout=50, check=False)
        return done.returncode, done.stdout, done.stderr

    def drive(self, driver, words='wheel=xpress', after=''):
        code, out, err = self.run_hal(f'loadusr -W shuttle {words}\n', driver, after)
        self.assertEqual(code, 0, out + err)
        return out, err

    def test_buttons_of_each_model(self):
        for model, low, high in (('xpress', [0, 1, 2, 3], [4]), ('pro', list(range(8)), [8, 9, 10, 11, 12]), ('pro2', list(range(8)), [8, 9, 10, 11, 12, 13, 14])):
            self.drive(f'out = pipe()\nwait((0, 0, []))\nsend(out, "000900ff00"); wait((0, 0, {low}))\nsend(out, "00090000ff"); wait((0, 0, {high}))\n'
                       f'send(out, "0009000000"); wait((0, 0, []))\nsend(out, "0009001000"); wait((0, 0, [{0 if model == "xpress" else 4}]))\n', f'wheel={model}')

    def test_wheels(self):
        # The first report contains the position of the jog wheel, whose counter has eight bits.
        self.drive('out = pipe()\nsend(out, "03fe000000"); wait((0, 3, []))\nsend(out, "f901000000"); wait((3, -7, []))\n'
                   'send(out, "07fb000000"); wait((-3, 7, []))\nfor n in range(200):\n    send(out, f"01{(0xfb + n) % 256:02x}000000")\nwait((196, 1, []))\n')

    def test_two_devices(self):
        self.drive('a, b = pipe(), pipe("second")\nsend(a, "0200000000"); send(b, "fe00000100"); wait((0, 2, [])); wait((0, -2, [0]), 1)\n'
                   'os.close(b); wait((0, 0, []), 1); wait((0, 2, []))\n', 'wheel=xpress second=pro')

    def test_a_device_that_goes_away_moves_nothing(self):
        _, err = self.drive('out = pipe()\nsend(out, "0005000000"); wait((0, 0, []))\nsend(out, "0709001000"); wait((4, 7, [0]))\nos.close(out); wait((4, 0, []))\n'
                            'out = pipe()\nsend(out, "0580002000"); wait((4, 5, [1]))\nsend(out, "0581000000"); wait((5, 5, []))\n')
        self.assertRegex(err, r'shuttle\.0 \(wheel\) is gone \(.*\): its spring wheel is in the middle, its buttons are released')
        self.assertIn('shuttle.0 (wheel) is back', err)

    def test_garbage_moves_nothing(self):
        # A wheel outside its range, a truncated report: the counts do not move or jump.
        for garbage in ('0809001000', '8009000000', '07ff'):
            _, err = self.drive('out = pipe()\nsend(out, "0005000000"); wait((0, 0, []))\nsend(out, "f907001000"); wait((2, -7, [0]))\n'
                                f'send(out, "{garbage}"); wait((2, 0, []))\nsend(out, "{garbage}")\ntime.sleep(0.05); wait((2, 0, []))\n'
                                'send(out, "0170000000"); wait((2, 1, []))\nsend(out, "0171000000"); wait((3, 1, []))\n')
            self.assertEqual(err.count('is no report of such a device'), 1, err)

    def test_the_end_of_the_program_moves_nothing(self):
        code, out, err = self.run_hal('loadusr -W shuttle wheel=xpress\nnet speed shuttle.0.spring-wheel-f\nnet on shuttle.0.button-0\n',
                                      'out = pipe()\nsend(out, "0705001000"); wait((0, 7, [0]))\nos.system("halcmd gets speed; halcmd unloadusr shuttle")\n',
                                      'gets speed\ngets on\n')
        self.assertEqual((code, out.split()), (0, ['1', '0', 'FALSE']), err)

    def test_what_is_wrong_is_said(self):
        (self.folder / 'file').write_text('')
        for words, text in (('missing', 'missing: No such file or directory'), ('file', 'file: Inappropriate ioctl for device: it is no hidraw device; file=pro2'),
                            ('file=pro3', 'file=pro3: No such file'), ('wheel=xpress missing', 'missing: No such file')):
            _, _, err = self.run_hal(f'loadusr -W shuttle {words}\n')
            self.assertIn(text, err)
        done = subprocess.run([BIN / 'shuttle', '--help'], env={**self.env, 'PYTHONPATH': ''}, capture_output=True, text=True, check=False, timeout=20)
        self.assertIn('usage: loadusr -W shuttle', done.stdout)


if __name__ == '__main__':
    unittest.main()
