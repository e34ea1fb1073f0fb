#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that each example of docs/user/gcode gives the output beside it, and that every code of the interpreter has an entry
(I1).

usage: gcode_docs.py RS274 SOURCE_FOLDER [--update]    --update writes the actual output into the files: check the difference
"""
import pathlib
import re
import subprocess
import sys
import tempfile

START = 'G21 G17 G90 G94 F600\n'
INI = '''[TRAJ]
LINEAR_UNITS = mm
COORDINATES = X Y Z A B C U V W
SPINDLES = 1
[EXAMPLE]
HEIGHT = 7.5
[RS274NGC]
SUBROUTINE_PATH = .
'''
MM = 1 / 25.4  # rs274 reads tool tables in inches
TOOLS = (f'T1 P1 Z{20 * MM:.9f} D{6 * MM:.9f}\nT2 P2 Z{35.5 * MM:.9f} D{10 * MM:.9f}\n'
         f'T3 P3 X{12 * MM:.9f} Z{5 * MM:.9f} D{0.8 * MM:.9f} I85 J5 Q2\n')
BLOCK = re.compile(r'```ngc( whole)?\n(.*?)```\n```(canon|error)\n(.*?)```\n', re.S)


class Runner:
    def __init__(self, rs274, folder):
        self.rs274, self.folder = rs274, folder
        (folder / 'docs.ini').write_text(INI)
        (folder / 'docs.tbl').write_text(TOOLS)
        self.before = self.calls('M2\n')[0]
        self.before = self.before[:len(self.before) - self.end_length(self.before)]

    def calls(self, text):
        """(canonical calls without numbers, lines of standard error)"""
        (self.folder / 'docs.ngc').write_text(START + text)
        (self.folder / 'docs.var').write_text('')
        done = subprocess.run([self.rs274, '-g', '-i', 'docs.ini', '-t', 'docs.tbl', '-v', 'docs.var', 'docs.ngc'],
                              cwd=self.folder, capture_output=True, text=True, check=False, timeout=20)
        calls = [re.sub(r'^ *\d+ N\S* +', '', line) for line in done.stdout.splitlines()]
        return calls, [line for line in done.stderr.splitlines() if line != 'executing']

    @staticmethod
    def end_length(calls):
        """The number of calls that M2 makes."""
        starts = [i for i, call in enumerate(calls) if call.startswith('SET_G5X_OFFSET(1,')]
        return len(calls) - starts[-1] if starts and 'PROGRAM_END()' in calls else 0

    def example(self, text, is_whole, kind):
        ends = re.search(r'^M(2|30)$', text, re.M) is not None
        calls, errors = self.calls(text if ends else text + 'M2\n')
        if kind == 'error':
            return errors[-2] + '\n' if len(errors) >= 2 else 'no error\n'
        if errors:
            return 'error: ' + errors[-2] + '\n'
        calls = calls[len(self.before):]
        return ''.join(call + '\n' for call in (calls if is_whole else calls[:len(calls) - self.end_length(calls)]))


def codes_of(source):
    """All codes of the interpreter's table, as they are written."""
    table = (source / 'src/gcode/interpreter/codes/codes.cc').read_text()
    return {letter + number + ('.' + tenth if tenth else '')
            for letter, number, tenth in re.findall(r'\brow\(([GM])\((\d+)(?:, (\d))?\),', table)}


def main():
    rs274, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    update = '--update' in sys.argv[3:]
    failed, count, documented = 0, 0, set()
    with tempfile.TemporaryDirectory() as name:
        runner = Runner(rs274, pathlib.Path(name))
        for path in sorted((source / 'docs/user/gcode').glob('*.md')):
            text = path.read_text()
            for heading in re.findall(r'^## (.*)$', text, re.M):
                documented.update(re.findall(r'[GM]\d+(?:\.\d)?', heading))

            def replace(match):
                nonlocal failed, count
                count += 1
                found = runner.example(match[2], match[1] is not None, match[3])
                if found != match[4] and not update:
                    failed += 1
                    print(f'{path.name}: this example\n{match[2]}gives\n{found}and not\n{match[4]}')
                return match[0].replace(f'```{match[3]}\n{match[4]}', f'```{match[3]}\n{found}')

            changed = BLOCK.sub(replace, text)
            if update and changed != text:
                path.write_text(changed)
    missing = sorted(codes_of(source) - documented)
    if missing or count == 0:
        failed += 1
        print('codes without an entry in docs/user/gcode:', ' '.join(missing))
    print(f'{count} examples, {failed} failed')
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
