#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Executes docs/integrator/hal/tutorial.md literally. usage: tutorial.py BIN SOURCE_DIR

Files are those of the page. Lines after "halcmd:" are sent to one halrun; lines after "$" run while it waits. Only `--install` is
replaced by `--compile`, so that nothing remains in the build folder.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

INTERACTIVE = ('halrun', 'millwright hal')
TIMEOUT_S = 30


def steps_of(page):
    """('file', name, text), ('halcmd', line) and ('shell', line) in the page's order."""
    steps = []
    name, lines = None, []
    for line in page.splitlines() + ['end']:
        code = line[4:] if line.startswith('    ') else None
        if name and (code is not None or not line):
            lines.append(code or '')
            continue
        if name and lines and any(lines):
            steps.append(('file', name, '\n'.join(lines).strip() + '\n'))
            name, lines = None, []
        match = re.match(r'Write `([^`]+)`', line)
        if match:
            name = match.group(1)
        elif code and code.startswith('halcmd: '):
            steps.append(('halcmd', code[len('halcmd: '):]))
        elif code and code.startswith('$ '):
            steps.append(('shell', code[2:]))
    # A command directly after a file's text belongs to the file's block in the page's layout; it is separated
    # from the text.
    out = []
    for step in steps:
        if step[0] != 'file':
            out.append(step)
            continue
        text, commands = [], []
        for line in step[2].splitlines():
            (commands if line.startswith(('$ ', 'halcmd: ')) else text).append(line)
        out.append(('file', step[1], '\n'.join(text).strip() + '\n'))
        out += [('shell', c[2:]) if c.startswith('$ ') else ('halcmd', c[8:]) for c in commands]
    return out


class Session:
    """One halrun that reads lines; a line is done when the echo after it is returned."""

    def __init__(self, env, folder):
        self.process = subprocess.Popen(['halrun', '-I'], env=env, cwd=folder, stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1)
        self.count = 0

    def run(self, line):
        self.count += 1
        mark = f'done-{self.count}'
        self.process.stdin.write(f'{line}\nprint {mark}\n')
        self.process.stdin.flush()
        said = []
        while mark not in (said[-1] if said else ''):
            text = self.process.stdout.readline()
            if not text:
                raise SystemExit(f'halrun ended at "{line}": {"".join(said)}')
            said.append(text)
        return ''.join(said[:-1])


def main():
    bin_folder, source = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
    steps = steps_of((source / 'docs/integrator/hal/tutorial.md').read_text(encoding='utf-8'))
    assert sum(step[0] == 'file' for step in steps) == 2 and len(steps) > 25, steps
    with tempfile.TemporaryDirectory() as folder:
        env = dict(os.environ, PATH=f'{bin_folder}:/usr/local/bin:/usr/bin:/bin', MILLWRIGHT_MODULE_PATH=folder,
                   MILLWRIGHT_INSTANCE=f'tutorial{os.getpid()}', XDG_RUNTIME_DIR=folder, PAGER='cat', MANPAGER='cat')
        session = Session(env, folder)
        for step in steps:
            if step[0] == 'file':
                pathlib.Path(folder, step[1]).write_text(step[2], encoding='utf-8')
            elif step[0] == 'halcmd' and step[1] != 'exit':
                said = session.run(step[1])
                assert not re.search(r':\d+:', said), f'{step[1]}: {said}'
            elif step[0] == 'shell' and step[1] not in INTERACTIVE:
                words = shlex.split(step[1].replace('--install', '--compile'))
                done = subprocess.run(words, env=env, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT_S,
                                      check=False)
                assert done.returncode == 0, f'{step[1]}: {done.stdout}{done.stderr}'
        session.process.stdin.close()
        assert session.process.wait(TIMEOUT_S) == 0
        for name in ('wave.png', 'wave.csv', 'ramp.png', 'hal.svg', 'tutorial.hal', 'gain.so', 'ramp.so'):
            assert pathlib.Path(folder, name).stat().st_size > 0, name
        # "halrun -I tutorial.hal brings it back"
        again = subprocess.run(['halrun', '-I', 'tutorial.hal'], env=env, cwd=folder, input='getp gain.0.factor\n',
                               capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
        assert again.returncode == 0 and '3' in again.stdout, again
    print(f'{len(steps)} steps')


if __name__ == '__main__':
    start = time.monotonic()
    main()
    print(f'{time.monotonic() - start:.1f} s')
