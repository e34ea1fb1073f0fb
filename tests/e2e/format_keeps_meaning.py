#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""millwright format does not change the canon output of any program, and changes nothing the second time.

usage: format_keeps_meaning.py RS274 MILLWRIGHT SOURCE_FOLDER [NUMBER_OF_PROGRAMS [FOLDER_OF_CASES ...]]
Programs: generated from seeds, those of nc_files, and all of further folders. Each is compared with its formatted version.
"""
import pathlib
import subprocess
import sys
import tempfile

RS274, MILLWRIGHT, SOURCE = sys.argv[1:4]
COUNT = int(sys.argv[4]) if len(sys.argv) > 4 else 150
FIRST_SEED = 70000
sys.path.insert(0, str(pathlib.Path(SOURCE, 'tools')))
import interp_programs  # noqa: E402


def output(program, folder):
    done = subprocess.run([RS274, '-g', str(program)], cwd=folder, capture_output=True, timeout=60, check=False)
    # Messages quote the block, which is formatted differently, so only the position is compared.
    return done.stdout, done.returncode, done.stderr.splitlines()[-2:-1]


def formatted(path):
    return subprocess.run([MILLWRIGHT, 'format', str(path)], capture_output=True, check=True).stdout


def main():
    failures = changed = 0
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        programs = []
        for seed in range(FIRST_SEED, FIRST_SEED + COUNT):
            path = scratch / f'seed{seed}.ngc'
            path.write_text(interp_programs.Program(seed).text())
            programs.append(path)
        folders = [pathlib.Path(SOURCE, 'nc_files')] + [pathlib.Path(name) for name in sys.argv[5:]]
        for folder in folders:
            programs += sorted(folder.rglob('*.ngc'))
        for number, program in enumerate(programs):
            made = formatted(program)
            copy = scratch / f'formatted{number}.ngc'
            copy.write_bytes(made)
            if formatted(copy) != made:
                print(f'{program}: formatting twice is not the same')
                failures += 1
            changed += made != program.read_bytes()
            if output(program, program.parent) != output(copy, program.parent):
                print(f'{program}: formatting changes what it does')
                failures += 1
    print(f'{len(programs)} programs, {changed} of them written differently, {failures} failures')
    return 1 if failures or changed < COUNT // 2 else 0


sys.exit(main())
