#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares our plasmac with that of an installed LinuxCNC, cycle by cycle, over random histories.

Our core cuts on a simulated table (plasmac_history) and records every input of every cycle. The same inputs are sent by streamer
to LinuxCNC's plasmac in its halrun; sampler records its outputs. Prints the first cycle in which each output differs. Needs root
for separate IPC namespaces (unshare), and LinuxCNC.

usage: script/compare plasmac [--build FOLDER] [--jobs N] FIRST_SEED LAST_SEED
"""
import argparse
import concurrent.futures
import pathlib
import random
import re
import subprocess
import tempfile

PERIOD_S = 0.001
PINS_OF_STREAM = 20
LETTER = {'float': 'f', 'bit': 'b', 's32': 's'}
TABLE = {
    'units-per-mm': 1, 'gcode-scale': 1, 'homed': 1, 'machine-is-on': 1, 'axis-z-max-limit': 100,
    'axis-x-max-limit': 1000, 'axis-y-max-limit': 1000, 'axis-x-position': 50, 'axis-y-position': 50,
    'arc-ok-high': 200, 'arc-ok-low': 50, 'arc-voltage-scale': 1, 'cut-volts': 100, 'xy-feed-rate': 60000,
    'feed-override': 1, 'cornerlock-threshold': 90, 'program-is-idle': 1, 'scribe-arm-delay': .02,
    'scribe-on-delay': .01, 'torch-pulse-time': .03}
# Values of one of a history's settings. Delays are those that single and double precision count equally.
CHOICES = {
    'mode': (0, 0, 1, 2), 'resolution': (100, 100, 50, 200), 'pierce-delay': (0, .01, .02),
    'arc-fail-delay': (.02, .03), 'restart-delay': (.01, .02), 'arc-max-starts': (1, 2, 3),
    'arc-lost-delay': (.01, .02, .03), 'cut-height': (1.1, 1.5, 1.9), 'pierce-height': (2.5, 3.0, 4.2),
    'float-switch-travel': (.3, 1, 1.4), 'safe-height': (0, 10, 25, 60), 'probe-start-height': (10, 20),
    'probe-feed-rate': (30000, 60000, 48123), 'setup-feed-rate': (300000, 600000, 421337),
    'thc-feed-rate': (3000, 6000), 'pid-p-gain': (5, 10, 25), 'pid-i-gain': (0, 0, 100), 'pid-d-gain': (0, 0, .005),
    'thc-threshold': (.5, 1, 2), 'thc-delay': (0, .01, .02), 'thc-auto': (0, 1), 'use-auto-volts': (0, 0, 1),
    'thc-sample-counts': (5, 20), 'target-samples': (3, 6), 'cornerlock-enable': (0, 1), 'voidlock-enable': (0, 1),
    'voidlock-slope': (50, 500, 1500), 'voidlock-on-cycles': (1, 2, 3), 'voidlock-off-cycles': (3, 10),
    'pause-at-end': (0, 0, .01, .03), 'puddle-jump-height': (0, 60, 120), 'puddle-jump-delay': (0, .01, .02),
    'mesh-enable': (0, 0, 0, 1), 'ignore-arc-ok-1': (0, 0, 0, 1), 'torch-enable': (1, 1, 1, 0),
    'thc-enable': (1, 1, 1, 0), 'ohmic-probe-enable': (0, 0, 1), 'ohmic-probe-offset': (0, .2),
    'ohmic-max-attempts': (1, 2), 'skip-ihs-distance': (0, 0, 50), 'low-cut-volts': (0, 0, 60),
    'lowpass-frequency': (0, 0, 100), 'ok-sample-counts': (5, 10), 'cut-feed-rate': (3000, 6000),
    'max-offset': (2, 5), 'spotting-threshold': (0, 50), 'spotting-time': (10, 20), 'probe-final-speed': (5, 10)}


def disturbances(draw, begin, length, full_speed):
    """Events within a cut: the voltage, the speed, switches."""
    for _ in range(draw.randint(0, 8)):
        cycle = begin + draw.randint(100, length)
        kind = draw.random()
        if kind < .5:
            yield cycle, 'volts', round(100 + draw.uniform(-8, 8), 2)
        elif kind < .7:
            yield cycle, 'current-velocity', full_speed * draw.choice((1, .95, .8, .5))
        elif kind < .8:
            yield cycle, 'volts', draw.choice((0, 300, 40))
            yield cycle + draw.randint(1, 40), 'volts', 100
        elif kind < .9:
            yield cycle, 'thc-disable', 1
            yield cycle + draw.randint(1, 40), 'thc-disable', 0
        else:
            yield cycle, 'feed-reduction', draw.choice((60, 5, 0))


def interruption(draw, begin, length):
    """A pause with actions in it, or a breakaway; the last element is the cycle of the resume."""
    events = []
    start = begin + draw.randint(5, length - 20)
    resume = start + draw.randint(60, 120)
    if draw.random() < .3:
        events += [(start, 'breakaway', 1), (start + draw.randint(3, 40), 'breakaway', 0)]
        return events, resume + 20
    events.append((start, 'pause', 1))
    kind = draw.random()
    if kind < .3:
        events += [(start + 25, 'x-offset', draw.randint(-9000, 9000)), (start + 25, 'cut-recovery', 1),
                   (resume + 400, 'cut-recovery', 0)]
    elif kind < .5:
        events += [(start + 25, 'x-offset', draw.randint(-90000, 90000)), (start + 25, 'consumable-change', 1),
                   (resume - 20, 'consumable-change', 0)]
    elif kind < .7:
        events += [(start + 25, 'paused-motion-speed', draw.choice((.5, -.5))),
                   (start + 40, 'paused-motion-speed', 0)]
        resume += 30
    return events, resume


def history(seed):
    """The script of one history: one to three cuts and their disturbances."""
    draw = random.Random(seed)
    settings = {**TABLE, **{name: draw.choice(values) for name, values in CHOICES.items()}}
    full_speed = settings['cut-feed-rate'] / 60
    events = [(5, 'offsets-active', 1), (5, 'program-is-idle', 0), (5, 'program-is-running', 1)]
    cycle = 8
    for _ in range(draw.randint(1, 3)):
        begin = cycle + draw.randint(2, 20)
        length = draw.randint(250, 600)
        start = draw.choice(('cutting-start',) * 9 + ('spotting-start',))
        events += [(begin, start, 1), (begin + draw.randint(100, 250), 'arc-ok-in', 1),
                   (begin + draw.randint(120, 220), 'current-velocity', full_speed)]
        events += disturbances(draw, begin, length, full_speed)
        end = begin + length
        if draw.random() < .35:
            more, resume = interruption(draw, begin, length)
            events += more
            end = resume + draw.randint(250, 450)
        else:
            resume = end - 6
        events += [(resume, 'resume', 1), (end, start, 0), (end, 'current-velocity', 0), (end, 'arc-ok-in', 0)]
        cycle = end + draw.randint(20, 60)
    events.sort(key=lambda event: event[0])
    lines = [f'set {name} {value}' for name, value in settings.items()] + ['set program 1']
    lines += [f'at {at} {name} {value}' for at, name, value in events]
    return '\n'.join(lines + [f'cycles {cycle + 40}']) + '\n'


def pins_of_peer(folder):
    """(name, type) of the inputs and of the outputs of LinuxCNC's plasmac, sorted by name."""
    (folder / 'show.hal').write_text('loadrt plasmac\nshow pin plasmac\n')
    text = run_peer(folder, 'show.hal')
    pins = re.findall(r'^\s*\d+\s+(float|bit|s32)\s+(IN|OUT)\s+\S+\s+plasmac\.(\S+)', text, re.MULTILINE)
    pins = [(name, kind, direction) for kind, direction, name in pins if name != 'time']
    return ([pin[:2] for pin in pins if pin[2] == 'IN'], [pin[:2] for pin in pins if pin[2] == 'OUT'])


def run_peer(folder, file):
    folder.chmod(0o777)
    inner = f'cd {folder}; export HOME={folder}; timeout 60 /usr/bin/halrun -f {file} 2>&1'
    command = ['unshare', '--ipc', '--pid', '--fork', '--mount-proc', 'su', 'nobody', '-s', '/bin/bash', '-c', inner]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def groups(pins):
    return [pins[i:i + PINS_OF_STREAM] for i in range(0, len(pins), PINS_OF_STREAM)]


def peer_outputs(folder, rows, inputs, outputs):
    """The outputs of each cycle, or None if the stream was late in one."""
    cycles = len(rows)
    streams = groups([('cycle', 's32')] + inputs)
    samples = groups([('cycle', 's32')] + outputs)
    flat = [[str(number + 1)] + row for number, row in enumerate(rows)]
    column = 0
    for index, group in enumerate(streams):
        with open(folder / f'in{index}', 'w', encoding='ascii') as file:
            for row in flat:
                values = row[column:column + len(group)]
                file.write(' '.join(value if kind == 'float' else str(int(float(value)))
                                    for value, (_, kind) in zip(values, group)) + '\n')
        column += len(group)
    depth = str(cycles + 10)
    kinds = lambda group: ''.join(LETTER[kind] for _, kind in group)
    hal = ['loadrt plasmac', f'loadrt threads name1=t period1={round(PERIOD_S * 1e9)}']
    for name, parts in (('streamer', streams), ('sampler', samples)):
        hal.append(f'loadrt {name} depth={",".join([depth] * len(parts))} cfg={",".join(map(kinds, parts))}')
    hal += [f'addf streamer.{i} t' for i in range(len(streams))] + ['addf plasmac t']
    hal += [f'addf sampler.{i} t' for i in range(len(samples))]
    for i, group in enumerate(streams):
        for k, (name, _) in enumerate(group):
            target = 'sampler.0.pin.0' if name == 'cycle' else f'plasmac.{name}'
            hal.append(f'net i_{name} streamer.{i}.pin.{k} {target}')
    for i, group in enumerate(samples):
        hal += [f'net o_{name} plasmac.{name} sampler.{i}.pin.{k}' for k, (name, _) in enumerate(group)
                if name != 'cycle']
    hal += [f'loadusr -w halstreamer -c {i} {folder}/in{i}' for i in range(len(streams))]
    hal += ['start', f'loadusr -w sleep {cycles * PERIOD_S + 0.15:.3f}', 'stop']
    hal += [f'loadusr halsampler -c {i} -n {cycles} {folder}/out{i}' for i in range(len(samples))]
    hal.append(f'loadusr -w sleep {0.3 + cycles * 5e-5:.2f}')
    (folder / 'run.hal').write_text('\n'.join(hal) + '\n')
    run_peer(folder, 'run.hal')
    try:
        files = [(folder / f'out{i}').read_text().splitlines() for i in range(len(samples))]
    except FileNotFoundError:
        return None
    result = []
    for parts in zip(*files):
        values = ' '.join(parts).split()
        if len(values) != len(outputs) + 1 or int(values[0]) == len(result):
            continue
        if int(values[0]) != len(result) + 1:
            return None
        result.append([float(value) for value in values[1:]])
    return result if len(result) == cycles else None


def isAllowed(name, ours, peer):
    """Differences that are explained in docs/reference/compatibility.md; `ours` and `peer` are the outputs of one cycle."""
    state = int(peer['state-out'])
    # the lamps of the other program remain lit together, and after the cut
    if name in ('led-up', 'led-down'):
        return bool(peer['led-up'] and peer['led-down']) or int(ours['state-out']) not in (11, 12)
    if name == 'ohmic-enable':  # ours is off when the probing has ended
        return state in (0, 13, 14, 15, 16, 17, 21)
    if name == 'arc-voltage-out':  # third decimal of a filtered voltage
        return abs(ours[name] - peer[name]) < 0.0015
    if name == 'z-offset-counts' and state in (11, 12, 13, 14):  # single precision of the other program
        return abs(ours[name] - peer[name]) < 60
    return False


def compare(seed, program, inputs, outputs):
    """A line with `same`, or with the first difference of each output."""
    with tempfile.TemporaryDirectory(prefix='plasmac_') as name:
        folder = pathlib.Path(name)
        (folder / 'script').write_text(history(seed))
        subprocess.run([program, folder / 'script', folder / 'inputs', folder / 'ours'], check=True)
        rows = [line.split() for line in (folder / 'inputs').read_text().splitlines()]
        ours = [[float(value) for value in line.split()] for line in (folder / 'ours').read_text().splitlines()]
        for _ in range(3):
            peer = peer_outputs(folder, rows, inputs, outputs)
            if peer is not None:
                break
        else:
            return f'seed {seed}: no run'
    first = {}
    names = [pin for pin, _ in outputs]
    for cycle in range(1, len(ours)):  # the first cycle of the other program only sets up
        a, b = dict(zip(names, ours[cycle])), dict(zip(names, peer[cycle]))
        for pin in names:
            if pin not in first and abs(a[pin] - b[pin]) > 1.5e-6 * max(1, abs(b[pin])) and not isAllowed(pin, a, b):
                first[pin] = f'{pin}@{cycle} ours {a[pin]:g} peer {b[pin]:g} (state {a["state-out"]:g}/{b["state-out"]:g})'
    return f'seed {seed}: ' + ('; '.join(first.values()) or f'same in {len(ours)} cycles')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--build', default='build/release')
    parser.add_argument('--jobs', type=int, default=4)
    parser.add_argument('first', type=int)
    parser.add_argument('last', type=int)
    options = parser.parse_args()
    program = next(pathlib.Path(options.build).glob('**/plasmac_history'))
    with tempfile.TemporaryDirectory(prefix='plasmac_') as name:
        inputs, outputs = pins_of_peer(pathlib.Path(name))
    same = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        seeds = range(options.first, options.last + 1)
        for line in pool.map(lambda seed: compare(seed, program, inputs, outputs), seeds):
            same += ': same' in line
            print(line, flush=True)
    print(f'{same} of {len(seeds)} histories are the same')


if __name__ == '__main__':
    main()
