#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests of hal_input with devices that are named pipes, instead of the package evdev.
usage: hal_input_test.py BIN_FOLDER"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BIN = pathlib.Path(sys.argv.pop())
# The calls of hal_input to evdev 1.6, on pipes: a line "type code value" is an event, "gone" is the end of
# the device.
EVDEV = '''
import collections, errno, os, pathlib
FOLDER = pathlib.Path(os.environ['FAKE_DEVICES'])
Info = collections.namedtuple('DeviceInfo', 'bustype vendor product version')
Abs = collections.namedtuple('AbsInfo', 'value min max fuzz flat resolution')
Event = collections.namedtuple('InputEvent', 'type code value')
class ecodes:
    EV_SYN, EV_KEY, EV_REL, EV_ABS, EV_LED, SYN_DROPPED = 0, 1, 2, 3, 17, 3
    KEY = {1: 'KEY_ESC', 0x71: ['KEY_MIN_INTERESTING', 'KEY_MUTE']}
    BTN = {0x110: ['BTN_LEFT', 'BTN_MOUSE'], 0x120: ['BTN_JOYSTICK', 'BTN_TRIGGER'], 0x130: ['BTN_A', 'BTN_GAMEPAD', 'BTN_SOUTH']}
    ABS, REL, LED = {0: 'ABS_X', 0x10: 'ABS_HAT0X'}, {8: 'REL_WHEEL'}, {0: 'LED_NUML'}
def list_devices():
    return sorted(str(path) for path in FOLDER.glob('event*'))
class InputDevice:
    def __init__(self, path):
        if not os.path.exists(path):
            raise OSError(errno.ENOENT, 'No such file or directory')
        self.path, self.name, self.phys, self.info, self.rest = path, 'Dual Pad', 'usb-1/input0', Info(3, 0x46d, 0xc216, 0x110), ''
        self.fd = os.open(path, os.O_RDWR | os.O_NONBLOCK)
    def fileno(self):
        return self.fd
    def capabilities(self, absinfo):
        return {1: [1, 0x110, 0x120, 0x130, 0x3f0], 2: [8], 3: [(0, self.absinfo(0))], 17: [0]}
    def absinfo(self, code):
        return Abs(128, 0, 256, 4, 16, 0)
    def active_keys(self):
        return [0x130]
    def grab(self):
        (FOLDER / 'grabbed').touch()
    def close(self):
        os.close(self.fd)
    def set_led(self, code, value):
        (FOLDER / 'lamp').write_text(f'{code} {value}')
    def read_one(self):
        while chr(10) not in self.rest:
            try:
                self.rest += os.read(self.fd, 4096).decode()
            except BlockingIOError:
                return None
        line, _, self.rest = self.rest.partition(chr(10))
        if line == 'gone':
            os.unlink(self.path)
            raise OSError(errno.ENODEV, 'No such device')
        return Event(*map(int, line.split()))
'''


class HalInputTest(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)
        (self.folder / 'evdev.py').write_text(EVDEV)
        os.mkfifo(self.folder / 'event3')
        self.env = {**os.environ, 'MILLWRIGHT_INSTANCE': f'hal-input-{os.getpid()}', 'PATH': f'{BIN}:{os.environ["PATH"]}', 'LC_ALL': 'C',
                    'FAKE_DEVICES': str(self.folder), 'PYTHONPATH': f'{self.folder}:{BIN.parent / "lib/python"}'}

    def tearDown(self):
        self.place.cleanup()

    def run_hal(self, lines):
        path = self.folder / 'a.hal'
        path.write_text(lines)
        done = subprocess.run([BIN / 'halrun', '-s', path], env=self.env, capture_output=True, text=True, timeout=50, check=False)
        return done.stdout, done.stderr

    def send(self, text, *more):
        """A HAL command that sends events to the device and waits until a pin is TRUE."""
        name = self.folder / f'send{len(list(self.folder.glob("send*")))}.sh'
        pin, value = more
        name.write_text(f"printf '{text}' > {self.folder}/event3\nfor i in $(seq 400); do [ \"$(halcmd getp {pin})\" = {value} ] && exit 0; sleep 0.01; done\n"
                        f"echo {pin} is $(halcmd getp {pin}), not {value}\nexit 1\n")
        return f'loadusr -w sh {name}\n'

    def values(self, lines, *pins):
        out, err = self.run_hal(lines + ''.join(f'getp {pin}\n' for pin in pins))
        self.assertEqual(len(out.splitlines()), len(pins), out + err)
        return out.splitlines()

    def test_names_and_the_state_at_the_start(self):
        out, err = self.run_hal('loadusr -W hal_input Dual\nshow pin input\nshow param input\n')
        names = {line.split()[-1 if 'Pin' in line else 4]: line.split() for line in out.splitlines() if 'input.0' in line}
        for name in ('key-esc', 'key-esc-not', 'btn-left', 'btn-trigger', 'btn-a', 'btn-a-not', 'key-0x3f0', 'abs-x-counts', 'abs-x-position', 'rel-wheel-counts',
                     'rel-wheel-position', 'rel-wheel-reset', 'led-numl', 'abs-x-scale', 'abs-x-offset', 'abs-x-fuzz', 'abs-x-flat', 'abs-x-min', 'abs-x-max',
                     'rel-wheel-scale', 'rel-wheel-absolute', 'rel-wheel-precision', 'rel-wheel-last', 'led-numl-invert'):
            self.assertIn('input.0.' + name, names, out + err)
        self.assertEqual([names['input.0.' + name][3] for name in ('btn-a', 'btn-a-not', 'btn-left', 'btn-left-not', 'abs-x-counts', 'abs-x-scale')],
                         ['TRUE', 'FALSE', 'FALSE', 'TRUE', '128', '128'])

    def test_events(self):
        load = 'loadusr -W hal_input "Vendor=046d Product=c216"\n'
        self.assertEqual(self.values(load + self.send(r'1 272 1\n2 8 3\n2 8 -1\n3 0 192\n', 'input.0.abs-x-counts', 192), 'input.0.btn-left', 'input.0.btn-left-not',
                                     'input.0.rel-wheel-counts', 'input.0.abs-x-position'), ['TRUE', 'FALSE', '2', '0.5'])
        # Within the flat range the axis is centred; a change below the fuzz is ignored.
        self.assertEqual(self.values(load + self.send(r'3 0 192\n3 0 195\n1 1 1\n', 'input.0.key-esc', 'TRUE'), 'input.0.abs-x-counts'), ['192'])
        self.assertEqual(self.values(load + self.send(r'3 0 192\n3 0 140\n1 1 1\n', 'input.0.key-esc', 'TRUE'), 'input.0.abs-x-counts'), ['128'])

    def test_wheels(self):
        load = 'loadusr -W hal_input -R event\nsetp input.0.rel-wheel-scale 2\n'.replace('event', 'usb-*/input0')
        self.assertEqual(self.values(load + 'setp input.0.rel-wheel-precision 8\n' + self.send(r'2 8 255\n2 8 255\n', 'input.0.rel-wheel-counts', -2),
                                     'input.0.rel-wheel-position', 'input.0.rel-wheel-last'), ['-1', '-1'])
        self.assertEqual(self.values(load + 'setp input.0.rel-wheel-absolute 1\n' + self.send(r'2 8 4\n2 8 4\n2 8 5\n', 'input.0.rel-wheel-last', 5),
                                     'input.0.rel-wheel-counts'), ['9'])
        self.assertEqual(self.values(load + 'setp input.0.rel-wheel-reset 1\n' + self.send(r'2 8 4\n', 'input.0.rel-wheel-last', 4),
                                     'input.0.rel-wheel-counts'), ['0'])

    def test_lamps_and_exclusive_devices(self):
        wait = self.folder / 'wait.sh'
        wait.write_text('for i in $(seq 400); do [ "$(cat lamp)" = "0 1" ] && exit 0; sleep 0.01; done; exit 1\n')
        out, err = self.run_hal(f'loadusr -W hal_input +Dual:0\nsetp input.0.led-numl 1\nloadusr -w sh {wait}\n'.replace(str(wait), f'-c "cd {self.folder}; sh wait.sh"'))
        self.assertEqual((self.folder / 'lamp').read_text(), '0 1', out + err)
        self.assertTrue((self.folder / 'grabbed').exists())

    def test_a_device_that_goes_away_lets_go(self):
        out, err = self.run_hal('loadusr -W hal_input Dual\n' + self.send(r'1 272 1\n3 0 256\n', 'input.0.btn-left', 'TRUE')
                                + self.send(r'gone\n', 'input.0.btn-left', 'FALSE') + 'getp input.0.abs-x-position\ngetp input.0.btn-left-not\n')
        self.assertEqual(out.split(), ['0', 'TRUE'], err)
        self.assertIn("hal_input: 'Dual' is gone", err)

    def test_what_is_wrong_is_said(self):
        for words, text in (('Nothing', "no input device for 'Nothing': 0 of the devices that can be read match; others: Dual Pad"),
                            ('Dual:1', "'Dual:1': 1 of the devices"), ('77', '/dev/input/event77: No such file'), ('', 'no device is named'), ('-Q Dual', "unknown option '-Q'")):
            _, err = self.run_hal(f'loadusr -W hal_input {words}\n')
            self.assertIn(text, err)
            self.assertIn('before its component', err)

    def test_evdev_has_what_is_called(self):
        check = ('import sys, evdev, inspect\nd = evdev.InputDevice\nfor n in "fileno capabilities absinfo active_keys grab close set_led read_one".split():\n'
                 '    assert callable(getattr(d, n)), n\nassert "absinfo" in inspect.signature(d.capabilities).parameters\n'
                 'e = evdev.ecodes\nassert e.ABS[0] == "ABS_X" and "BTN_LEFT" in e.BTN[0x110] and e.SYN_DROPPED == 3 and e.KEY[1] == "KEY_ESC"\n')
        done = subprocess.run([sys.executable, '-c', check], capture_output=True, text=True, check=False, timeout=20)
        if 'No module named' in done.stderr:
            self.skipTest('python3-evdev is not installed')
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == '__main__':
    unittest.main()
