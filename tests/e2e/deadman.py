#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks jogs with a lease: a client of `millwright ui` jogs and is disconnected, silent or killed at a random time. The joint
must decelerate within 110 ms of the last renewal that the machine received, and stop; other jogs must not stutter.

joint_watch.py reports the motion.

usage: deadman.py MILLWRIGHT HALCMD ROOT [--cuts N] [--seed S] [--slack-ms MS] [--log FILE]
slack: additional time for a busy computer. log: a line of JSON for each cut. An interrupted campaign continues after the last
line.
"""
import argparse
import json
import multiprocessing
import os
import pathlib
import random
import signal
import sys
import tempfile
import time

from joint_watch import SERVO_CLOCK, Watch, begin_of_braking, last_motion, stands_still
from mill_by_hand import Findings
from web_screen import Bench, Screen, switch_on_and_home

LEASE_MS, RENEWAL_S = 100, 0.030
BOUND_S = 0.110
SPEED = 20.0  # mm/s; the mill of the tests brakes from it in 14 ms
STUTTER_S = 0.010
FOUND = Findings()


def jogger(port, sign, pipe, style):
    """A separate process: renews until it receives the command that ends it, and reports the time of its last renewal."""
    screen = Screen(port)
    screen.until(lambda: 'joints' in screen.status)
    fields = {'is_joint': False, 'index': 0, 'velocity': sign * SPEED, 'lease_ms': LEASE_MS}
    screen.ask('JogContinuous', **fields)
    last = time.monotonic()
    pipe.send(('begun', last))
    while not pipe.poll(max(0.0, last + RENEWAL_S - time.monotonic())):
        screen.ask('JogContinuous', is_renewal=True, **fields)
        last = time.monotonic()
    end = pipe.recv()
    # the process may be waiting for the answer to its last renewal, which starts the lease
    if style == 'silent':
        number = screen.last_id
        screen.until(lambda: number in screen.outcomes, 0.09)
        last = time.monotonic()
    pipe.send(('last', last))
    if style == 'cut':
        screen.cut()
    if style == 'stop':
        screen.ask('JogStop', is_joint=False, index=0)
        last = time.monotonic()
    if end == 'silent' or style == 'killed':
        time.sleep(10)  # connected and silent, or killed in this time


def one_cut(watch, port, chance, number, slack):
    style = chance.choice(['cut', 'silent', 'killed', 'stop'])
    sign = -1 if watch.component['position'] > 0 else 1
    duration = chance.uniform(0.1, 0.45)
    mine, theirs = multiprocessing.Pipe()
    process = multiprocessing.Process(target=jogger, args=(port, sign, theirs, style), daemon=True)
    process.start()
    if not mine.poll(10):
        FOUND.expect(False, f'cut {number}: a jog begins')
        process.kill()
        return None
    begun = mine.recv()[1]
    time.sleep(duration)
    mine.send(style)
    last = mine.recv()[1] if mine.poll(5) else None
    if style == 'killed':
        os.kill(process.pid, signal.SIGKILL)
    FOUND.expect(last is not None, f'cut {number}: the client reports its last renewal')
    time.sleep(0.35)
    samples = watch.since(begun)
    process.kill()
    process.join()
    braking, end = begin_of_braking(samples, SPEED), last_motion(samples)
    begun, last = watch.servo_time(begun), watch.servo_time(last) if last is not None else None
    FOUND.expect(braking is not None and end is not None, f'cut {number} ({style}): it has jogged at its speed')
    if braking is None or end is None or last is None or begun is None:
        return None
    FOUND.expect(braking - last <= BOUND_S + slack, f'cut {number} ({style}): decelerates {1000 * (braking - last):.1f} ms after the last renewal')
    FOUND.expect(end <= last + BOUND_S + 0.05 + slack, f'cut {number} ({style}): runs on until {1000 * (end - last):.1f} ms')
    still = stands_still(samples, begun + 0.08, last - 0.01)
    FOUND.expect(still < STUTTER_S + slack, f'cut {number} ({style}): does not move for {1000 * still:.0f} ms in the middle of the jog')
    return style, braking - last


def still_on(port):
    screen = Screen(port)
    screen.until(lambda: 'task' in screen.status)
    is_on = screen.status['task']['state'] == 'ON'
    if not is_on:
        print(screen.messages[-3:])
    screen.cut()
    return is_on


def read_log(path):
    """The cuts of an earlier run, by their number."""
    lines = path.read_text().splitlines() if path is not None and path.exists() else []
    return {line['number']: line for line in map(json.loads, lines)}


def judge(bench, cuts, seed, slack, log):
    with (bench.ini.parent / 'by_hand.hal').open('a') as file:
        file.write(SERVO_CLOCK)
    server, port = bench.server()
    bench.machine()
    screen = Screen(port)
    switch_on_and_home(screen)
    FOUND.expect(screen.do('SetMode', mode='MANUAL') == 'DONE' and screen.do('SetTeleop', teleop=True) == 'DONE', 'axes are jogged')
    screen.cut()
    watch = Watch(pathlib.Path(bench.millwright).parent.parent / 'lib/python', bench.env)
    watch.start()
    done, told = read_log(log), {}
    for line in done.values():
        if line['style'] is not None:
            told.setdefault(line['style'], []).append(line['delay_s'])
    for number in range(cuts):
        if number in done:
            continue
        watch.samples = watch.samples[-1:]  # a motion that starts at once is seen only in a later sample
        found = len(FOUND.failures)
        result = one_cut(watch, port, random.Random(f'{seed} {number}'), number, slack)
        if log is not None:
            with log.open('a') as file:
                style, delay = result if result is not None else (None, None)
                print(json.dumps({'number': number, 'seed': seed, 'style': style, 'delay_s': delay, 'failures': FOUND.failures[found:]}), file=file)
        if result is not None:
            told.setdefault(result[0], []).append(result[1])
        elif not still_on(port):
            FOUND.expect(False, f'cut {number}: the machine is on no more')
            break
    watch.is_on = False
    watch.join()
    earlier = [failure for line in done.values() for failure in line['failures']]
    FOUND.expect(not earlier, f'{len(earlier)} findings of before', *earlier[:20])
    FOUND.expect(sum(map(len, told.values())) >= 0.98 * cuts, 'nearly all cuts could be judged', told.keys())
    for style, delays in sorted(told.items()):
        delays.sort()
        print(f'{style}: {len(delays)} cuts, at its speed until {1000 * delays[0]:.0f} to {1000 * delays[-1]:.0f} ms after the last renewal, '
              f'median {1000 * delays[len(delays) // 2]:.0f}')
    server.terminate()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('millwright')
    parser.add_argument('halcmd')
    parser.add_argument('root')
    parser.add_argument('--cuts', type=int, default=24)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--slack-ms', type=float, default=0)
    parser.add_argument('--log', type=pathlib.Path)
    options = parser.parse_args()
    multiprocessing.set_start_method('fork')
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.millwright, options.halcmd, options.root, pathlib.Path(folder))
        try:
            judge(bench, options.cuts, options.seed, options.slack_ms / 1000, options.log)
        finally:
            bench.end_all()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
