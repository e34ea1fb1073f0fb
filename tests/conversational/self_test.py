#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that the judge of the campaign detects faults: a good program is changed, and the judge must reject it.

usage: self_test.py --rs274 FILE [--count N]
"""
import argparse
import re
import sys
import tempfile

import campaign
import cases
import lathe_cases

CUT = re.compile(r'^G1 .*', re.M)


def code_of(program):
    return program[:program.index(';@')]


def deeper(program, v):
    return re.sub(r'Z(-?[\d.]+)', lambda m: f'Z{float(m.group(1)) - (0.1 if float(m.group(1)) < v["top"] else 0):.4f}', program)


def shallower(program, v):
    bottom = min(float(z) for z in re.findall(r'Z(-?[\d.]+)', code_of(program).replace('G53 G0 Z0', '')))
    return re.sub(r'(?<!G53 G0 )Z(-?[\d.]+)', lambda m: f'Z{float(m.group(1)) + (0.05 if abs(float(m.group(1)) - bottom) < 1e-6 else 0):.4f}', program)


def rapid_in_cut(program, v):
    return re.sub(r'^G1 (X[^Z\n]*)$', r'G0 \1', program, flags=re.M)


def shifted(program, v):
    return re.sub(r'X(-?[\d.]+)', lambda m: f'X{float(m.group(1)) + 0.1:.4f}', program)


def without_spindle(program, v):
    return re.sub(r'^S([\d.]+) M3$', r'S\1 M5', program, flags=re.M)


def plunged(program, v):
    """Changes the first move into the material to a straight plunge."""
    lines, isDone = [], False
    for line in program.splitlines():
        found = re.match(r'G[13] .*?Z(-?[\d.]+)', line)
        if found and not isDone and float(found.group(1)) < v['top'] - 0.2:
            lines.append(f'G1 Z{found.group(1)} F100')
            isDone = True
        lines.append(line)
    return '\n'.join(lines) + '\n'


def shifted_z(program, v):
    return re.sub(r'(?<=[0-9 ])Z(-?[\d.]+)', lambda m: f'Z{float(m.group(1)) - 0.1:.4f}', program)


def smaller_x(program, v):
    return re.sub(r'^(G[0123].*)X(-?[\d.]+)', lambda m: f'{m.group(1)}X{float(m.group(2)) - 0.2:.4f}', program, flags=re.M)


def rapid_turned(program, v):
    return re.sub(r'^G1 (Z[^\n ]*) F.*$', r'G0 \1', program, flags=re.M)


def stopped_spindle(program, v):
    return re.sub(r'^(G9[67] .*) M3$', r'\1 M5', program, flags=re.M)


# The changes that must be detected for each type of operation.
CHANGES = {
    deeper: ['face', 'rect_pocket', 'round_pocket', 'slot', 'rect_boss', 'round_boss', 'drill', 'tap', 'bore', 'engrave', 'contour', 'thread_mill'],
    shallower: ['face', 'rect_pocket', 'round_pocket', 'slot', 'rect_boss', 'round_boss', 'drill', 'tap', 'bore', 'engrave', 'contour', 'thread_mill'],
    rapid_in_cut: ['rect_pocket', 'slot', 'rect_boss', 'engrave'],
    shifted: ['rect_pocket', 'round_pocket', 'slot', 'rect_boss', 'round_boss', 'drill', 'bore', 'contour', 'thread_mill'],
    without_spindle: ['face', 'rect_pocket', 'round_pocket', 'slot', 'rect_boss', 'round_boss', 'drill', 'bore', 'engrave', 'contour'],
    plunged: ['rect_pocket', 'round_pocket', 'slot', 'contour'],
    shifted_z: ['turn', 'lathe_bore', 'lathe_face', 'groove', 'part_off', 'chamfer', 'radius'],
    smaller_x: ['turn', 'lathe_bore', 'groove', 'chamfer', 'radius'],
    rapid_turned: ['turn', 'lathe_bore'],
    stopped_spindle: ['turn', 'lathe_bore', 'lathe_face', 'groove', 'part_off', 'chamfer', 'radius'],
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--rs274', required=True)
    parser.add_argument('--count', type=int, default=60)
    words = parser.parse_args()
    both = [maker.make(seed) for maker in (cases, lathe_cases) for seed in range(1, words.count + 1)]
    made = [case for case in both if case['mode'] == 'good' and len(case['job']['steps']) == 1 and case['job']['unit'] == 'mm']
    tried = missed = 0
    for case, answer in zip(made, campaign.answers_of(made)):
        step = answer['job']['steps'][0]
        if answer['program'] is None:
            continue
        for change, kinds in CHANGES.items():
            v = step['values']
            isFree = change is plunged and v.get('entry') == 'plunge' or change is shifted and step['type'] == 'thread_mill' and v['diameter'] < 0.5
            if step['type'] not in kinds or isFree:
                continue
            changed = change(answer['program'], v)
            if changed == answer['program']:
                continue
            tried += 1
            with tempfile.TemporaryDirectory(prefix='mw-forms-') as folder:
                found, _ = campaign.check_program(case, {**answer, 'program': changed}, words.rs274, folder)
            if not found:
                missed += 1
                print(f'seed {case["seed"]}: {step["type"]}: the judge accepts a program that is {change.__name__}')
    print(f'{tried} changed programs, {missed} accepted')
    sys.exit(1 if missed or tried < 20 else 0)


if __name__ == '__main__':
    main()
