#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compiles and loads the example components of an installed LinuxCNC's HAL manual.

The examples are read from the PDF of its documentation package into a temporary folder, compiled unmodified with our halcompile,
and loaded with our halrun. usage: compare_halcompile.py [--bin FOLDER] [--manual PDF] [--keep]
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

CHAPTER = re.compile(r'^\d+\.\d+ HAL Component Generator$')
NEXT_CHAPTER = re.compile(r'^\d+\.\d+ HALTCL Files$')
HEADING = re.compile(r'^\d+(\.\d+){2,} ')
PAGE = re.compile(r'^LinuxCNC V\d.*\d+ / \d+$')
COMPONENT = re.compile(r'^component (\w+)')
PROSE = re.compile(r'^(•|[A-Z][a-z]* [a-z])')
FRAME = '''#include "rtapi.h"
#include "rtapi_app.h"
#include "rtapi_math.h"
#include "kinematics.h"
#include "hal.h"
MODULE_LICENSE("GPL");
static const double Bx = 100;
static int comp_id;
KINS_NOT_SWITCHABLE
KINEMATICS_TYPE kinematicsType(void) { return KINEMATICS_BOTH; }
int kinematicsForward(const double *joints, EmcPose *pos, const KINEMATICS_FORWARD_FLAGS *fflags,
                      KINEMATICS_INVERSE_FLAGS *iflags) {
%s
}
int kinematicsInverse(const EmcPose *pos, double *joints, const KINEMATICS_INVERSE_FLAGS *iflags,
                      KINEMATICS_FORWARD_FLAGS *fflags) {
%s
}
EXPORT_SYMBOL(kinematicsType);
EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);
int rtapi_app_main(void) { comp_id = hal_init("bipod"); return comp_id < 0 ? comp_id : hal_ready(comp_id); }
void rtapi_app_exit(void) { hal_exit(comp_id); }
'''


def manual_lines(pdf):
    text = subprocess.run(['pdftotext', '-layout', str(pdf), '-'], capture_output=True, text=True, check=True).stdout
    for typographic, plain in (('\u201d', '"'), ('\u201c', '"'), ('\u2019', "'"), ('\u2018', "'"), ('\f', '')):
        text = text.replace(typographic, plain)
    return [line.rstrip() for line in text.splitlines() if not PAGE.match(line.rstrip())]


def chapter(lines):
    starts = [i for i, line in enumerate(lines) if CHAPTER.match(line)]
    ends = [i for i, line in enumerate(lines) if NEXT_CHAPTER.match(line)]
    return lines[starts[-1]:ends[-1]] if starts and ends else []


def unindented(lines):
    margin = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return [line[margin:] for line in lines]


def examples(lines):
    """(name, text, whether a ;; had to be added) of each component in the chapter."""
    at = 0
    while at < len(lines):
        head = COMPONENT.match(lines[at])
        if not head or not lines[at].endswith(';'):
            at += 1
            continue
        block, has_code, depth = [], False, 0
        while at < len(lines) and not HEADING.match(lines[at]):
            line = lines[at]
            is_in_text = '\n'.join(block).count('"""') % 2 == 1
            if block and depth == 0 and not is_in_text and PROSE.match(line):
                break
            has_code = has_code or line == ';;'
            if has_code:
                depth += line.count('{') - line.count('}')
            block.append(line)
            at += 1
        text = '\n'.join(block).strip() + '\n'
        yield head.group(1), text if has_code else text + 'license "GPL";\n;;\n', not has_code


def kinematics(lines):
    """The two functions of the kinematics chapter in a frame, or None."""
    def body(marker):
        for i, line in enumerate(lines):
            if line.strip().lower().endswith(marker):
                found = []
                for code in lines[i + 1:]:
                    if code.strip():
                        found.append(code)
                    if code.strip() == 'return 0;':
                        return '\n'.join(found)
        return None
    forward, inverse = body('translated to actual code:'), None
    rest = [i for i, line in enumerate(lines) if 'or translated to actual code' in line.lower()]
    if rest:
        lines = lines[rest[0] - 1:]
        inverse = body('translated to actual code:')
    return FRAME % (forward, inverse) if forward and inverse else None


def run(words, **more):
    return subprocess.run(words, capture_output=True, text=True, check=False, timeout=60, **more)


def try_one(binaries, folder, source, is_program):
    """'', or the error."""
    name = source.stem
    words = [str(binaries / 'halcompile'), '--compile', str(source)]
    done = run(words)
    if done.returncode != 0:
        return 'does not compile: ' + done.stderr.strip()
    hal = folder / f'{name}.hal'
    hal.write_text(f'loadusr -W {folder / name}\nshow pin\n' if is_program else f'loadrt {name}\nshow pin\n')
    done = run([str(binaries / 'halrun'), str(hal)], env={**os.environ, 'MILLWRIGHT_MODULE_PATH': str(folder),
                                                        'MILLWRIGHT_INSTANCE': f'compare{os.getpid()}'})
    return '' if done.returncode == 0 else 'does not load: ' + done.stderr.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--bin', default='build/dev/bin', type=pathlib.Path)
    parser.add_argument('--manual', default='/usr/share/doc/linuxcnc/LinuxCNC_Documentation.pdf', type=pathlib.Path)
    parser.add_argument('--keep', action='store_true', help='keep the temporary folder')
    options = parser.parse_args()
    if not options.manual.exists():
        print(f'{options.manual} is not there: install the package linuxcnc-doc-en')
        return 77
    lines = manual_lines(options.manual)
    folder = pathlib.Path(tempfile.mkdtemp(prefix='compare_halcompile_'))
    binaries = options.bin.resolve()
    failures = 0
    found = list(examples(chapter(lines)))
    bipod = kinematics(lines)
    sources = []
    for name, text, is_completed in found:
        path = folder / f'{name}.comp'
        path.write_text(text)
        sources.append((path, bool(re.search(r'^option userspace', text, re.M)), is_completed))
    if bipod:
        path = folder / 'bipod.c'
        path.write_text(bipod)
        sources.append((path, False, True))
    for path, is_program, is_completed in sources:
        problem = try_one(binaries, folder, path, is_program)
        failures += 1 if problem else 0
        print(f'{path.name:16} {"completed" if is_completed else "as it is":10} {problem or "compiles and loads"}')
    print(f'{len(sources)} examples, {failures} failures')
    if options.keep:
        print(f'they are in {folder}')
    else:
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()
    return 1 if failures or not found else 0


if __name__ == '__main__':
    sys.exit(main())
