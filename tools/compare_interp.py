#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs generated programs through LinuxCNC's rs274 and ours and compares canon calls and whether they fail.

The last printed digit of a number may differ by one, and -0 is 0. Texts of messages are not compared, nor what a failing
block has done before it failed. The differences are listed by the calls at which the two part; any makes the exit status
1. Those that are meant are described in docs/compatibility.md.
"""
import argparse
import collections
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import interp_programs

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCE = '/usr/bin/rs274'
USER = 'nobody'
MOVE_WITH_N = re.compile(r'N\S+\s+(STRAIGHT_|ARC_)')
MINUS_ZERO = re.compile(r'-0(?![.\d])')
NUMBER = re.compile(r'-?\d+\.\d+')
LOOP = '''cd {folder} || exit 1
mkdir -p work; cd work
i={first}
while [ $i -lt {last} ]; do
  rm -f ./*
  timeout 10 {program} -g ../$i.ngc >../$i.{tag}.out 2>../$i.{tag}.err </dev/null
  echo $? >../$i.{tag}.status
  i=$((i+1))
done
'''

# Calls that only LinuxCNC 2.9 prints; the newer version, whose outputs the conformance cases hold, does not.
DROPPED = ('START_CHANGE()',)
CHANGE_TOOL = re.compile(r'CHANGE_TOOL\(\d+\)')

# What ours refuses and the reference does not; docs/compatibility.md says why.
STRICTER = ('Concave corner cannot be reached', 'M6 needs a tool', 'The feed is per revolution',
            'The first G5 of a series', 'G64 must not be negative')


def run_all(folder, program, tag, first, last, user=None):
    script = LOOP.format(folder=folder, program=program, tag=tag, first=first, last=last)
    words = ['runuser', '-u', user, '--'] if user and os.geteuid() == 0 else []
    subprocess.run([*words, 'env', f'HOME={folder}', 'bash', '-c', script], check=True)


def isSameNumber(a, b):
    if len(a.split('.')[1]) != len(b.split('.')[1]):
        return False
    digits = len(a.split('.')[1])
    return abs(round(float(a) * 10**digits) - round(float(b) * 10**digits)) <= 1


def isSameLine(a, b):
    if a == b:
        return True
    # Which N is printed with a move that compensation held back, and the sign of an integer 0, do not matter.
    a, b = MOVE_WITH_N.sub(r'N..... \1', a), MOVE_WITH_N.sub(r'N..... \1', b)
    a, b = MINUS_ZERO.sub('0', a), MINUS_ZERO.sub('0', b)
    a, b = a[6:] if a[:5].strip().isdigit() else a, b[6:] if b[:5].strip().isdigit() else b
    numbers_a, numbers_b = NUMBER.findall(a), NUMBER.findall(b)
    return NUMBER.sub('#', a) == NUMBER.sub('#', b) and all(map(isSameNumber, numbers_a, numbers_b))


def first_difference(reference, ours):
    """Index of the first line that differs, or None."""
    for i in range(max(len(reference), len(ours))):
        if i >= len(reference) or i >= len(ours) or not isSameLine(reference[i], ours[i]):
            return i
    return None


def read(folder, number, tag):
    base = pathlib.Path(folder, f'{number}.{tag}')
    lines = base.with_suffix(f'.{tag}.out').read_text(errors='replace').splitlines()
    lines = [CHANGE_TOOL.sub('CHANGE_TOOL()', line) for line in lines if not line.endswith(DROPPED)]
    return (lines,
            base.with_suffix(f'.{tag}.err').read_text(errors='replace').splitlines(),
            int(base.with_suffix(f'.{tag}.status').read_text() or 99))


def key_of(reference, ours, at):
    """A short name for what differs, for counting."""
    def call(lines, i):
        if i >= len(lines):
            return 'end'
        match = re.search(r'([A-Z][A-Z0-9_.]+)\(', lines[i])
        return match.group(1) if match else 'text'
    return f'{call(reference, at)} / {call(ours, at)}'


def without_end(lines):
    """Without the ON_RESETs that a failed program ends with."""
    while lines and lines[-1].endswith('ON_RESET()'):
        lines = lines[:-1]
    return lines


def compare(folder, number):
    ref_out, ref_err, ref_status = read(folder, number, 'ref')
    our_out, our_err, our_status = read(folder, number, 'our')
    # A block that fails changes nothing here; there, what came before the failure has been done.
    if ref_status and our_status and ref_err[-1:] == our_err[-1:]:
        ref_out, our_out = without_end(ref_out), without_end(our_out)
        ref_out = ref_out[:len(our_out)]
    if our_status and any(text in '\n'.join(our_err) for text in STRICTER):
        our_out = without_end(our_out)
        ref_out, ref_status = ref_out[:len(our_out)], our_status
    at = first_difference(ref_out, our_out)
    if at is None and (ref_status == 0) == (our_status == 0):
        return None
    if at is None:
        key = f'status {ref_status} / {our_status}'
        at = len(ref_out)
    else:
        key = key_of(ref_out, our_out, at)
    ref_says = ' | '.join(ref_err[1:3]) if ref_status else ''
    our_says = ' | '.join(our_err[1:6]) if our_status else ''
    return (key, ref_out[at] if at < len(ref_out) else '(end)', our_out[at] if at < len(our_out) else '(end)',
            ref_says, our_says, ref_out[at - 1] if at else '')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--programs', type=int, default=2000)
    parser.add_argument('--first', type=int, default=0, help='first seed')
    parser.add_argument('--ours', default=str(ROOT / 'build/release/bin/rs274'))
    parser.add_argument('--keep', help='folder for programs and outputs (default: a temporary one)')
    parser.add_argument('--show', type=int, default=3, help='examples of each kind of difference')
    options = parser.parse_args()
    folder = options.keep or tempfile.mkdtemp(prefix='interp-')
    pathlib.Path(folder).mkdir(exist_ok=True)
    os.chmod(folder, 0o777)
    last = options.first + options.programs
    for number in range(options.first, last):
        pathlib.Path(folder, f'{number}.ngc').write_text(interp_programs.Program(number).text())
    run_all(folder, REFERENCE, 'ref', options.first, last, USER)
    shutil.rmtree(pathlib.Path(folder, 'work'))
    run_all(folder, shlex.quote(options.ours), 'our', options.first, last)
    kinds = collections.defaultdict(list)
    failed = 0
    for number in range(options.first, last):
        failed += read(folder, number, 'ref')[2] != 0
        found = compare(folder, number)
        if found:
            kinds[found[0]].append((number, found))
    different = sum(map(len, kinds.values()))
    for key, examples in sorted(kinds.items(), key=lambda item: -len(item[1])):
        print(f'{len(examples):5d} {key}')
        for number, (_, ref, our, ref_says, our_says, before) in examples[:options.show]:
            print(f'      program {number}, after {before}\n        reference: {ref}  {ref_says}\n        ours:      {our}  {our_says}')
    print(f'{options.programs} programs ({failed} of them refused by the reference), {different} differ')
    if not options.keep:
        shutil.rmtree(folder)
    return 1 if different else 0


if __name__ == '__main__':
    sys.exit(main())
