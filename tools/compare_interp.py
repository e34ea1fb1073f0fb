#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs generated programs with LinuxCNC's rs274 and ours and compares canon calls and failures.

The last printed digit of a number may differ by one, and -0 equals 0. Not compared: texts of messages, and actions of a failing
block before it failed. Intended differences are recognised (interp_differences.py), counted by class and explained in
docs/reference/compatibility.md. Exit status 1: other differences, which are listed.
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

import interp_differences
import interp_programs

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCE = '/usr/bin/rs274'
USER = 'nobody'
COUNTER = re.compile(r'^ *\d+ N\S+\s+')
INI = '[EMC]\nVERSION = 1.1\n[TRAJ]\nSPINDLES = 3\n'
# Every second program runs with an INI that has three spindles.
LOOP = '''cd {folder} || exit 1
mkdir -p work-{tag}-{job}; cd work-{tag}-{job}
i={first}
while [ $i -lt {last} ]; do
  if [ $((i % 2)) = 1 ]; then ini='-i ../three.ini'; else ini=; fi
  timeout 10 {program} -g $ini ../$i.ngc >../$i.{tag}.out 2>../$i.{tag}.err </dev/null
  echo $? >../$i.{tag}.status
  i=$((i+1))
done
'''

# Calls that only LinuxCNC 2.9 prints; the newer version, from which the conformance cases come, does not.
DROPPED = ('START_CHANGE()',)
CHANGE_TOOL = re.compile(r'CHANGE_TOOL\(\d+\)')


def run_all(folder, program, tag, seeds, jobs, user=None):
    """All programs, in `jobs` parallel loops of the shell."""
    words = ['runuser', '-u', user, '--'] if user and os.geteuid() == 0 else []
    loops = []
    for job in range(jobs):
        first = seeds.start + len(seeds) * job // jobs
        last = seeds.start + len(seeds) * (job + 1) // jobs
        script = LOOP.format(folder=folder, program=program, tag=tag, first=first, last=last, job=job)
        loops.append(subprocess.Popen([*words, 'env', f'HOME={folder}/work-{tag}-{job}', 'nice', '-n', '5', 'bash', '-c', script]))
    for loop in loops:
        loop.wait()


def read(folder, number, tag):
    base = pathlib.Path(folder, f'{number}.{tag}')
    lines = base.with_suffix(f'.{tag}.out').read_text(errors='replace').splitlines()
    calls = [CHANGE_TOOL.sub('CHANGE_TOOL()', COUNTER.sub('', line)) for line in lines]
    calls = [call for call in calls if call not in DROPPED]
    while calls and calls[-1] == 'ON_RESET()':
        calls.pop()
    return (calls, base.with_suffix(f'.{tag}.err').read_text(errors='replace').splitlines(),
            int(base.with_suffix(f'.{tag}.status').read_text() or 99))


def error_of(lines):
    """The last two lines: the message and the block."""
    return ' | '.join(line.strip() for line in lines[-2:])


def compare(folder, number, program):
    """None if equal, otherwise (names of the classes that explain it or None, text to print)."""
    ref_calls, ref_err, ref_status = read(folder, number, 'ref')
    our_calls, our_err, our_status = read(folder, number, 'our')
    names = []
    if ref_status >= 124:
        return ['LinuxCNC crashes or does not end'], ''
    if our_status and not ref_status or ref_err[-1:] != our_err[-1:]:
        for text, name in interp_differences.STRICTER.items():
            if our_status and text in '\n'.join(our_err):
                names.append(name)
                ref_status = our_status
        for text, (needed, name) in interp_differences.STRICTER_WITH.items():
            if our_status and text in '\n'.join(our_err) and re.search(needed, program, re.I):
                names.append(name)
                ref_status = our_status
    if 'G7X error' in error_of(ref_err) and 'profile of g7' in '\n'.join(our_err) and our_status:
        names.append('a lathe cycle that is rejected has made no move')
        ref_calls = ref_calls[:len(our_calls)]
    elif 'G7X error' in error_of(ref_err) and len(our_calls) > len(ref_calls):
        names.append('a lathe profile that only LinuxCNC rejects')
        our_calls, our_status, our_err = our_calls[:len(ref_calls)], ref_status, ref_err
    if ref_status and interp_differences.isOtherSpindle(program, error_of(ref_err)) and len(ref_calls) < len(our_calls):
        names.append('G33 and G76 without $ after G96 or G97 $n')
        our_calls, our_status = our_calls[:len(ref_calls)], ref_status
    hasFailed = bool(ref_status and our_status)
    if hasFailed and not names and [line.strip() for line in ref_err[-1:]] != [line.strip() for line in our_err[-1:]]:
        return None, f'program {number} fails in other blocks: {error_of(ref_err)} / {error_of(our_err)}'
    pair = interp_differences.Pair(program, list(ref_calls), list(our_calls))
    used = interp_differences.explain(pair, hasFailed)
    if used is not None and (ref_status == 0) == (our_status == 0):
        names += [interp_differences.name_of(one) for one in used]
        return (names, '') if names else None
    ref_calls, our_calls = pair.reference, pair.ours
    at = next((i for i, (a, b) in enumerate(zip(ref_calls, our_calls)) if not interp_differences.isSameCall(a, b)),
              min(len(ref_calls), len(our_calls)))
    shown = (f'program {number}, call {at} after {ref_calls[at - 1] if at else ""}\n'
             f'    reference: {(ref_calls + ["(end)"])[at]}  {error_of(ref_err) if ref_status else ""}\n'
             f'    ours:      {(our_calls + ["(end)"])[at]}  {error_of(our_err) if our_status else ""}')
    return None, shown


def report(folder, seeds):
    kinds, unexplained, different, failed = collections.Counter(), [], 0, 0
    for number in seeds:
        program = pathlib.Path(folder, f'{number}.ngc').read_text()
        failed += read(folder, number, 'ref')[2] != 0
        found = compare(folder, number, program)
        if found is None:
            continue
        different += 1
        if found[0] is None:
            unexplained.append(found[1])
        else:
            kinds.update(found[0])
    for name, count in kinds.most_common():
        print(f'{count:6d}  explained: {name}')
    for shown in unexplained:
        print(f'unexplained: {shown}')
    print(f'{len(seeds)} programs, seeds {seeds.start} to {seeds.stop - 1} ({failed} rejected by LinuxCNC): '
          f'{different} differ, {len(unexplained)} unexplained')
    return 1 if unexplained else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--programs', type=int, default=2000)
    parser.add_argument('--first', type=int, default=0, help='first seed')
    parser.add_argument('--ours', default=str(ROOT / 'build/release/bin/rs274'))
    parser.add_argument('--keep', help='folder for programs and outputs (default: a temporary one)')
    parser.add_argument('--jobs', type=int, default=2, help='programs that run at the same time')
    options = parser.parse_args()
    folder = os.path.abspath(options.keep) if options.keep else tempfile.mkdtemp(prefix='interp-')
    pathlib.Path(folder).mkdir(exist_ok=True)
    os.chmod(folder, 0o777)
    seeds = range(options.first, options.first + options.programs)
    pathlib.Path(folder, 'three.ini').write_text(INI)
    for number in seeds:
        pathlib.Path(folder, f'{number}.ngc').write_text(interp_programs.Program(number).text())
    run_all(folder, REFERENCE, 'ref', seeds, options.jobs, USER)
    run_all(folder, shlex.quote(os.path.abspath(options.ours)), 'our', seeds, options.jobs)
    status = report(folder, seeds)
    if not options.keep:
        shutil.rmtree(folder)
    return status


if __name__ == '__main__':
    sys.exit(main())
