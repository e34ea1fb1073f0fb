#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that each example of docs/integrator/remap.md gives the output beside it (I1).

usage: remap_docs.py RS274 SOURCE_FOLDER [--update]    --update writes the actual output into the file: check the difference

In each section the fences `ini`, `python NAME` and `ngc NAME` are files, `program` is run, and `canon` is its output: calls, then
the lines of an error.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

START = 'G21 G17 G90 G94 F600\n'
FENCE = re.compile(r'```(\w+)(?: (\S+))?\n(.*?)```\n', re.S)


def run(rs274, folder, program):
    (folder / 'docs.ngc').write_text(START + program + 'M2\n')
    done = subprocess.run([rs274, '-g', '-i', 'docs.ini', 'docs.ngc'], cwd=folder, capture_output=True, text=True, check=False,
                          timeout=20)
    return ([re.sub(r'^ *\d+ N\S* +', '', line) for line in done.stdout.splitlines()],
            [line for line in done.stderr.splitlines() if line != 'executing'][-2:])


def outcome(rs274, folder, program):
    # without the calls of M2 and of the end
    before = len([call for call in run(rs274, folder, '')[0] if call]) - 8
    calls, errors = run(rs274, folder, program)
    calls = calls[before:]
    ends = [i for i, call in enumerate(calls) if call.startswith('SET_G5X_OFFSET(1,')]
    if not errors and ends:
        calls = calls[:ends[-1]]
    if errors and calls and calls[-1] == 'ON_RESET()':
        calls.pop()
    return ''.join(line + '\n' for line in calls + ['error: ' + line for line in errors])


def main():
    rs274, path = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]) / 'docs/integrator/remap.md'
    text = path.read_text()
    failed, count = 0, 0
    for section in re.split(r'^## ', text, flags=re.M)[1:]:
        with tempfile.TemporaryDirectory() as name:
            folder, program = pathlib.Path(name), None
            for kind, file, content in FENCE.findall(section):
                if kind == 'ini':
                    (folder / 'docs.ini').write_text(content)
                elif kind in ('python', 'ngc'):
                    (folder / file).write_text(content)
                elif kind == 'program':
                    program = content
                elif kind == 'canon':
                    count += 1
                    found = outcome(rs274, folder, program)
                    if found != content and '--update' in sys.argv:
                        text = text.replace(f'```program\n{program}```\n```canon\n{content}```',
                                            f'```program\n{program}```\n```canon\n{found}```')
                    elif found != content:
                        failed += 1
                        print(f'{section.splitlines()[0]}: this program\n{program}gives\n{found}and not\n{content}')
    if '--update' in sys.argv:
        path.write_text(text)
    print(f'{count} examples, {failed} failed')
    return 1 if failed or count == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
