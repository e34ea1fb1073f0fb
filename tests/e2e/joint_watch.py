#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Reports the X position of a running machine with the servo thread's time, for judges of jogs: a late servo thread must not be
mistaken for a jog that continues. Uses neither the screen, the server nor motion.

The machine's HAL file loads SERVO_CLOCK. As a program (joint_watch.py LIBRARY): a line "servo-s position monotonic-s" for each
sample, until standard input ends.
"""
import os
import sys
import threading
import time

SAMPLE_S = 0.002
SERVO_CLOCK = 'loadrt integ\naddf integ.0 servo-thread\nsetp integ.0.in 1\nnet servo-s integ.0.out\n'


class Watch(threading.Thread):
    """Samples of the joint position and time. The stream of halsampler would be exact; here HAL pins are read."""

    def __init__(self, library, env):
        super().__init__(daemon=True)
        sys.path.insert(0, str(library))
        os.environ.update(env)
        import hal  # programs of the build, for the instance of the machine
        self.component = hal.component(f'watch{os.getpid()}')
        self.pin = self.component.newpin('position', hal.HAL_FLOAT, hal.HAL_IN)
        self.component.newpin('servo-s', hal.HAL_FLOAT, hal.HAL_IN)
        self.component.ready()
        hal.connect(f'watch{os.getpid()}.position', 'Xpos')
        hal.connect(f'watch{os.getpid()}.servo-s', 'servo-s')
        self.samples, self.is_on = [], True

    def run(self):
        while self.is_on:
            self.samples.append((self.component['servo-s'], self.component['position'], time.monotonic()))
            time.sleep(SAMPLE_S)

    def servo_time(self, when):
        """Position at a time of the computer's clock, interpolated between the previous and next samples, which may be far apart
        on a busy computer."""
        before = max((one for one in self.samples if one[2] <= when), key=lambda one: one[2], default=None)
        after = min((one for one in self.samples if one[2] > when), key=lambda one: one[2], default=None)
        if before is None or after is None:
            return None
        return before[0] + (after[0] - before[0]) * (when - before[2]) / (after[2] - before[2])

    def since(self, start):
        return [one for one in self.samples if one[2] >= start]


def last_motion(samples):
    """Time of the last motion in the samples."""
    moved = [b[0] for a, b in zip(samples, samples[1:]) if abs(b[1] - a[1]) > 1e-7]
    return moved[-1] if moved else None


def begin_of_braking(samples, speed):
    """First sample after which the joint remains below its speed."""
    fast = [b[0] for a, b in zip(samples, samples[1:]) if b[0] > a[0] and abs(b[1] - a[1]) / (b[0] - a[0]) > 0.9 * speed]
    return fast[-1] if fast else None


def stands_still(samples, begin, end):
    """The longest time without motion between two times. [s]"""
    longest, since = 0.0, None
    for a, b in zip(samples, samples[1:]):
        if begin < a[0] and b[0] < end and abs(b[1] - a[1]) < 1e-7:
            since = a[0] if since is None else since
            longest = max(longest, b[0] - since)
        else:
            since = None
    return longest


def main():
    watch = Watch(sys.argv[1], {})
    watch.start()
    threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
    told = 0
    while True:
        time.sleep(0.02)
        for sample in watch.samples[told:]:
            print('%.6f %.9f %.6f' % sample)
            told += 1
        sys.stdout.flush()


if __name__ == '__main__':
    main()
