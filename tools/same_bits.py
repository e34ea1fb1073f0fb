#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the behaviour of two builds byte by byte, for a refactoring that must not change it.

usage: same_bits.py BEFORE AFTER [--seeds N] [--programs N] [--corpus FOLDER ...] [--only PART ...]
BEFORE, AFTER: build folders. Both use the machines, programs and generators of this source tree.
  traces    every servo cycle of our programs on our machines, without and with jerk limits, and of CAM-style programs
  rs274     canon calls, errors and exit status of nc_files, of each .ngc below the corpus folders and of generated programs
  campaign  the log of traj_campaign over the first N seeds (needs -DMW_BENCH=ON in both builds)
"""
import argparse
import concurrent.futures
import contextlib
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'tools'))
sys.path.insert(0, str(ROOT / 'tests' / 'e2e'))
import cam_programs  # noqa: E402
import cam_runs  # noqa: E402
import estimates  # noqa: E402
import interp_programs  # noqa: E402
import make_surface  # noqa: E402

MACHINES = [('mill_mm', p) for p in ('pocket', 'contour', 'drilling', 'subroutines', 'engraving', 'surface')] + [
    ('mill_inch', 'inch_plate'), ('gantry_xyyz', 'contour'), ('mill_xyza', 'four_axis'), ('mill_xyzac', 'five_axis'),
    ('lathe', 'lathe_part')]
FIRST_PROGRAM = 7_000_000  # a seed that no other run uses


def digest(*parts):
    """Hash of bytes, which must not contain the path of a temporary folder."""
    whole = hashlib.sha256()
    for part in parts:
        whole.update(part + b'\0')
    return whole.hexdigest()


def trace(build, machine, program, is_smooth):
    """Output of one of our programs; the machine is a copy, so that both builds start without the files that it writes."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        shutil.copytree(ROOT / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var'))
        shutil.copytree(ROOT / 'nc_files', folder / 'nc_files')
        if program == 'surface':
            with (folder / 'nc_files' / 'surface.ngc').open('w') as out, contextlib.redirect_stdout(out):
                make_surface.main()
        ini = folder / 'configs' / 'sim' / f'{machine}.ini'
        if is_smooth:
            ini.write_text(estimates.with_jerk(ini.read_text()))
        done = subprocess.run([build / 'bin' / 'millwright', 'run', ini, folder / 'nc_files' / f'{program}.ngc', '--trace',
                               folder / 'trace.csv'], capture_output=True, check=False)
        rows = (folder / 'trace.csv').read_bytes() if (folder / 'trace.csv').exists() else b''
        return digest(str(done.returncode).encode(), rows), len(rows.splitlines())


def cam_trace(build, seed):
    program = cam_programs.make(seed)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary, 'run')
        verdict = cam_runs.run(str(build / 'bin' / 'millwright'), program, seed % 3 == 2, folder)
        rows = (folder / 'trace.csv').read_bytes() if (folder / 'trace.csv').exists() else b''
        return digest(verdict.encode(), rows), len(rows.splitlines())


def canon(build, program):
    """`program`: a file."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / 'three.ini').write_text('[EMC]\nVERSION = 1.1\n[TRAJ]\nSPINDLES = 3\n')
        try:
            done = subprocess.run([build / 'bin' / 'rs274', '-g', '-i', folder / 'three.ini', program], cwd=folder, timeout=30,
                                  stdin=subprocess.DEVNULL, capture_output=True, check=False, env={**os.environ, 'TZ': 'UTC'})
        except subprocess.TimeoutExpired:
            return 'does not end', 0
        place = temporary.encode()
        return digest(str(done.returncode).encode(), done.stdout.replace(place, b''),
                      done.stderr.replace(place, b'')), len(done.stdout.splitlines())


def campaign(build, seeds):
    with tempfile.TemporaryDirectory() as temporary:
        log = pathlib.Path(temporary, 'log')
        subprocess.run([build / 'campaign' / 'traj_campaign', '--first', '1', '--count', str(seeds), '--log', log, '--processes',
                        '2'], stdout=subprocess.DEVNULL, check=False)
        lines = [line for line in log.read_text().splitlines() if not line.startswith('#')]
        return dict((line.split()[0], (line, 1)) for line in lines)


def jobs_of(options, folder):
    """Name and work of each comparison; the work takes a build folder."""
    if 'traces' in options.only:
        for machine, program in MACHINES:
            for is_smooth in (False, True):
                yield (f'{machine} {program}{" with jerk limits" if is_smooth else ""}',
                       lambda build, m=machine, p=program, s=is_smooth: trace(build, m, p, s))
        for seed in range(1, 41):
            yield f'CAM program {seed}', lambda build, s=seed: cam_trace(build, s)
    if 'rs274' in options.only:
        files = sorted((ROOT / 'nc_files').rglob('*.ngc'))
        for corpus in options.corpus:
            files += sorted(f for kind in ('*.ngc', '*.nc', '*.tap') for f in pathlib.Path(corpus).rglob(kind))
        for i in range(options.programs):
            path = folder / f'{FIRST_PROGRAM + i}.ngc'
            path.write_text(interp_programs.Program(FIRST_PROGRAM + i).text())
            files.append(path)
        for path in files:
            yield f'rs274 {path}', lambda build, p=path: canon(build, p)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('before', type=pathlib.Path)
    parser.add_argument('after', type=pathlib.Path)
    parser.add_argument('--seeds', type=int, default=150)
    parser.add_argument('--programs', type=int, default=400)
    parser.add_argument('--corpus', nargs='*', default=[])
    parser.add_argument('--only', nargs='*', default=['traces', 'rs274', 'campaign'], choices=['traces', 'rs274', 'campaign'])
    options = parser.parse_args()
    before, after = options.before.resolve(), options.after.resolve()
    compared = differ = rows = 0
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(2) as pool:
        names, works = zip(*jobs_of(options, pathlib.Path(temporary)), strict=True) if set(options.only) - {'campaign'} else ((), ())
        results = pool.map(lambda work: (work(before), work(after)), works)
        for name, (old, new) in zip(names, results, strict=True):
            compared, rows = compared + 1, rows + new[1]
            if old != new:
                differ += 1
                print(f'{name}: differs ({old[1]} rows before, {new[1]} after)', flush=True)
        if 'campaign' in options.only:
            old, new = campaign(before, options.seeds), campaign(after, options.seeds)
            for seed in sorted(set(old) | set(new), key=int):
                compared += 1
                if old.get(seed) != new.get(seed):
                    differ += 1
                    print(f'campaign seed {seed}: {old.get(seed)} before, {new.get(seed)} after')
    print(f'{compared} compared, {rows} rows, {differ} differ')
    return 1 if differ or not compared else 0


if __name__ == '__main__':
    sys.exit(main())
