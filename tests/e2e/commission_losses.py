#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The commissioning steps run in real time with a simulated board. The program, the operator or the reader is lost during a
motion (A7): the drive must be off afterwards. usage: commission_losses.py MILLWRIGHT HALCMD"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

millwright, halcmd = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
failures = 0


def expect(condition, what, more=''):
    global failures
    if not condition:
        failures += 1
        print(f'FAIL {what} {more}')


class Steps:
    def __init__(self, folder, instance):
        self.env = {**os.environ, 'MILLWRIGHT_INSTANCE': instance}
        self.process = subprocess.Popen([millwright, 'commission', 'check', folder, '--all', '--messages'], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True, bufsize=1, env=self.env)
        self.number = -1

    def act(self, name):
        self.process.stdin.write(json.dumps({'number': self.number, 'act': name}) + '\n')
        self.process.stdin.flush()

    def reach_motion(self):
        for line in self.process.stdout:
            state = json.loads(line)
            self.number = state['number']
            if state['state'] != 'running':
                return False
            if state['prompt']['ask'] == 'confirm':
                self.act('confirm')
            if state['prompt']['ask'] == 'hold':
                return True
        return False

    def hold_for(self, seconds):
        for _ in range(int(seconds / 0.05)):
            self.act('hold')
            time.sleep(0.05)

    def pin(self, name):
        """Nothing: the realtime process has ended."""
        done = subprocess.run([halcmd, 'getp', name], capture_output=True, text=True, check=False, env=self.env, timeout=10)
        return done.stdout.strip() if done.returncode == 0 else None

    def isDriveOn(self):
        return self.pin('stepgen.0.enable') == 'TRUE'


def close_input(steps):
    steps.process.stdin.close()
    steps.process.wait(timeout=10)


def hang(steps):
    steps.process.send_signal(signal.SIGSTOP)
    time.sleep(0.5)


def kill(steps):
    steps.process.kill()
    steps.process.wait(timeout=10)
    time.sleep(1)


def terminate(steps):
    steps.process.terminate()
    steps.process.wait(timeout=10)


with tempfile.TemporaryDirectory() as place:
    folder = pathlib.Path(place) / 'lathe'
    subprocess.run([millwright, 'commission', 'write', folder, 'kind=lathe', 'drives=stepper', 'board=parport', 'pin.estop=0'], check=True, capture_output=True)
    # The thread of a busy test computer may be late, so the steps before the first motion run in virtual
    # time.
    subprocess.run([millwright, 'commission', 'check', folder, '--simulate', '--fast'], input='confirm\n', text=True, check=False, capture_output=True, timeout=120)
    for number, lose in enumerate((close_input, hang, kill, terminate)):
        steps = Steps(folder, f'commission-losses-{os.getpid()}-{number}')
        try:
            expect(steps.reach_motion(), f'{lose.__name__}: a motion')
            before = float(steps.pin('joint.0.pos-fb') or 'nan')
            steps.hold_for(0.6)
            expect(float(steps.pin('joint.0.pos-fb') or 'nan') > before + 0.1, f'{lose.__name__}: the button moves the axis')
            steps.hold_for(0.1)
            expect(steps.isDriveOn(), f'{lose.__name__}: the drive is on')
            lose(steps)
            expect(not steps.isDriveOn(), f'{lose.__name__}: the drive is off')
            stopped = steps.pin('joint.0.pos-fb')
            time.sleep(0.5)
            expect(steps.pin('joint.0.pos-fb') == stopped, f'{lose.__name__}: nothing moves')
        finally:
            if steps.process.poll() is None:
                steps.process.send_signal(signal.SIGCONT)
                steps.process.terminate()
                steps.process.wait(timeout=10)
print(f'{failures} failed')
sys.exit(1 if failures else 0)
