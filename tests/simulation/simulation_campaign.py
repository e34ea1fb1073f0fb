#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the material simulation of the screen (web/src/lib/simulation) with a judge on random programs.

usage: simulation_campaign.py RS274 [--first S] [--count N] [--log FILE] [--self-test] [--keep FOLDER]
A run with an existing log skips the seeds in it. Exit status 1: a program differs, or the comparison misses a planted difference
of the self-test.
"""
import argparse
import collections
import json
import pathlib
import subprocess
import sys
import tempfile

import stock_judge
import stock_programs

WEB = pathlib.Path(__file__).resolve().parents[2] / 'web'
SHARE = 0.01
LEAST_MM3 = 20.0
"""A part of this volume is within the error of the walls of a single small cut."""
CERTAIN_MM, POSSIBLE_MM = 0.2, 0.001


def bundle(folder):
    """The library with its entry point for node, as one file."""
    target = folder / 'bridge.mjs'
    subprocess.run([WEB / 'node_modules/.bin/esbuild', WEB / 'tests/simulation/bridge.ts', '--bundle', '--platform=node', '--format=esm',
                    f'--outfile={target}', '--log-level=warning'], check=True, cwd=WEB)
    return target


class Library:
    """The library in one node process: input is a job, output its result."""

    def __init__(self, path):
        self.process = subprocess.Popen(['node', path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def run(self, canon, job):
        self.process.stdin.write(json.dumps({**job, 'canon': canon}) + '\n')
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError('the library has ended')
        return json.loads(answer)

    def end(self):
        self.process.stdin.close()
        self.process.wait()


def canon_of(rs274, text, folder):
    path = folder / 'program.ngc'
    path.write_text(text)
    run = subprocess.run([rs274, '-g', path], capture_output=True, text=True, timeout=60, cwd=folder)
    if run.returncode != 0 or 'PROGRAM_END' not in run.stdout:
        raise RuntimeError(f'rs274: {run.stderr or run.stdout[-300:]}')
    return run.stdout


def differences(verdict, result):
    """Differences between the library and the judge."""
    texts = []
    error = abs(result['removed_mm3'] - verdict.removed)
    if error > SHARE * max(verdict.removed, LEAST_MM3):
        texts.append(f'volume {result["removed_mm3"]:.2f} mm3, judge {verdict.removed:.2f} mm3')
    found = {(one['line'], kind) for one in result['findings'] for kind in one['kinds']}
    for key, depth in verdict.certain.items():
        if depth > CERTAIN_MM and key not in found:
            texts.append(f'line {key[0]}: {key[1]} not found, judge {depth:.3f} mm')
    for key in sorted(found):
        if verdict.possible.get(key, -1) <= POSSIBLE_MM:
            texts.append(f'line {key[0]}: {key[1]} invented')
    if len({one['line'] for one in result['findings']}) != len(result['findings']):
        texts.append('a line is in the list twice')
    return texts


def run_seed(seed, rs274, library, folder):
    text, job, planted = stock_programs.make(seed)
    canon = canon_of(rs274, text, folder)
    result = library.run(canon, job)
    verdict = stock_judge.judge(canon, job)
    found = {(one['line'], kind) for one in result['findings'] for kind in one['kinds']}
    share = abs(result['removed_mm3'] - verdict.removed) / max(verdict.removed, LEAST_MM3)
    certain = {key for key, depth in verdict.certain.items() if depth > CERTAIN_MM}
    return {'seed': seed, 'faults': differences(verdict, result), 'error': share, 'removed_mm3': verdict.removed,
            'planted': len(planted), 'certain': len(certain), 'planted_certain': len([one for one in planted if tuple(one) in certain]),
            'found': len(found), 'kinds': collections.Counter(kind for _, kind in certain), 'text': text}


def self_test(rs274, library, folder):
    """A faulty library must be detected: one with a tool that is too large, and one with changed lists of findings."""
    failures = 0
    for seed in range(1, 7):
        text, job, _ = stock_programs.make(seed)
        canon = canon_of(rs274, text, folder)
        verdict = stock_judge.judge(canon, job)
        result = library.run(canon, job)
        wrong = json.loads(json.dumps(job))
        for tool in wrong['tools'].values():
            tool['diameter_mm'] *= 1.05
        changed = [library.run(canon, wrong), {**result, 'removed_mm3': result['removed_mm3'] * 1.02 + 1},
                   {**result, 'findings': result['findings'] + [{'line': 1, 'kinds': ['rapid']}]}]
        if any(depth > CERTAIN_MM for depth in verdict.certain.values()):
            changed.append({**result, 'findings': result['findings'][1:]})
        missed = [i for i, one in enumerate(changed) if not differences(verdict, one)]
        failures += len(missed)
        print(f'seed {seed}: {len(changed)} changed results, {len(missed)} not noticed {missed}')
    return failures


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument('rs274', type=pathlib.Path)
    words.add_argument('--first', type=int, default=1)
    words.add_argument('--count', type=int, default=12)
    words.add_argument('--log', type=pathlib.Path)
    words.add_argument('--self-test', action='store_true')
    words.add_argument('--keep', type=pathlib.Path, help='folder for programs that differ')
    options = words.parse_args()
    rs274 = options.rs274.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        library = Library(bundle(folder))
        try:
            if options.self_test:
                return 1 if self_test(rs274, library, folder) else 0
            return campaign(options, rs274, library, folder)
        finally:
            library.end()


def campaign(options, rs274, library, folder):
    done = {}
    if options.log is not None and options.log.exists():
        done = {one['seed']: one for one in map(json.loads, options.log.read_text().splitlines())}
    results = []
    for seed in range(options.first, options.first + options.count):
        one = done.get(seed)
        if one is None:
            one = run_seed(seed, rs274, library, folder)
            if one['faults'] and options.keep is not None:
                options.keep.mkdir(parents=True, exist_ok=True)
                (options.keep / f'{seed}.ngc').write_text(one['text'])
            del one['text']
            if options.log is not None:
                with options.log.open('a') as log:
                    log.write(json.dumps(one) + '\n')
        results.append(one)
        for fault in one['faults']:
            print(f'seed {seed}: {fault}', flush=True)
    total = {key: sum(one[key] for one in results) for key in ('planted', 'planted_certain', 'certain', 'found')}
    worst = max(results, key=lambda one: one['error'])
    print(f'{len(results)} programs, {sum(bool(one["faults"]) for one in results)} with differences; largest error of volume '
          f'{100 * worst["error"]:.2f} percent (seed {worst["seed"]}); planted {total["planted"]}, of them collisions by the judge '
          f'{total["planted_certain"]}; collisions by the judge {total["certain"]}, found {total["found"]}')
    return 1 if any(one['faults'] for one in results) else 0


if __name__ == '__main__':
    sys.exit(main())
