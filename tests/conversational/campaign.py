#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Random forms of conversational programming: the interpreter must accept the programs, they must cut the described shape without
danger, and impossible values must be rejected at their field.

usage: campaign.py --rs274 FILE [--machine mill|lathe] [--first S] [--count N] [--keep FOLDER] [--processes P]
Exit status 1: a form failed; each failure prints its seed. --keep writes the programs of failures.
"""
import argparse
import collections
import json
import multiprocessing
import pathlib
import subprocess
import sys
import tempfile

import canon
import cases
import judge
import lathe_cases
import lathe_judge

HERE = pathlib.Path(__file__).resolve().parent
MAKER = HERE.parent.parent / 'web/tests/conversational/make_programs.mjs'
PIECE = 250


def answers_of(made):
    """Answers of the forms; null: a number was not entered."""
    lines = ''.join(json.dumps({key: case[key] for key in ('job', 'facts', 'dxf')}) + '\n' for case in made)
    done = subprocess.run(['node', str(MAKER)], input=lines, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode != 0:
        sys.exit(f'{MAKER}: {done.stderr}')
    return [json.loads(line) for line in done.stdout.splitlines()]


def faults_of(answer):
    steps = [f'{i}.{field}: {fault["key"]}' for i, one in enumerate(answer['stepFaults']) for field, fault in one.items()]
    return [f'job.{field}: {fault["key"]}' for field, fault in answer['jobFaults'].items()] + steps


# Contours that are too narrow for the tool, or too close to each other, are rejected correctly.
RIGHTLY = {'fault.tight', 'fault.no_room', 'fault.gouge', 'fault.no_entry'}


def check_planted(case, answer):
    expect = case['expect']
    if answer['program'] is not None:
        return [f'accepted although {expect}']
    where = answer['jobFaults'] if 'job' in expect else answer['stepFaults'][0]
    wanted = [expect['job']] if 'job' in expect else expect['fields']
    return [] if any(name in where for name in wanted) else [f'rejected elsewhere: {expect}: {faults_of(answer)}']


def check_program(case, answer, rs274, folder):
    job = answer['job']
    tools = {one['number']: one['diameter'] for one in case['facts']['tools']}
    canon.write_tables(folder, tools)
    run = canon.run(rs274, folder, answer['program'], job['unit'])
    if run.error:
        return [f'interpreter: {run.error}'], {}
    found = []
    if run.units != job['unit'] or run.system != cases.SYSTEMS.index(job['system']) + 1:
        found.append(f'units {run.units}, system {run.system}')
    if run.spindle != 0 or run.coolant != 'off':
        found.append(f'at the end: spindle {run.spindle}, coolant {run.coolant}')
    figures = {}
    for i, step in enumerate(job['steps']):
        moves = [move for move in run.moves if move.step == i + 1]
        pitches = {k: v for k, v in run.pitches.items() if run.moves[k].step == i + 1}
        shape = case['shapes'].get(str(i))
        if job['machine'] == 'lathe':
            faults, more = lathe_judge.judge_operation(step['type'], step['values'], moves, job['unit'])
        else:
            faults, more = judge.judge_operation(step['type'], step['values'], moves, job['unit'], shape, pitches)
        found += [f'{step["type"]}: {text}' for text in faults]
        figures.update(more)
    if job['machine'] == 'lathe':
        return found, figures
    top = max(step['values']['top'] + step['values']['clearance'] for step in job['steps'])
    if run.moves and run.moves[-1].end[2] < min(top, job['safe']) - 1e-6:
        found.append(f'ends at Z {run.moves[-1].end[2]}')
    return found, figures


def check(task):
    case, answer, rs274 = task
    with tempfile.TemporaryDirectory(prefix='mw-forms-') as folder:
        if case['mode'] == 'planted':
            return case['seed'], 'planted', check_planted(case, answer), {}
        if answer['program'] is None:
            told = {text.split(': ')[1] for text in faults_of(answer)}
            isRight = case['mode'] == 'wild' or told <= RIGHTLY
            return case['seed'], 'rejected', [] if isRight else [f'good values are rejected: {faults_of(answer)}'], {}
        try:
            found, figures = check_program(case, answer, rs274, folder)
        except subprocess.TimeoutExpired:
            found, figures = ['the interpreter did not end within 120 s'], {}
        return case['seed'], 'judged', found, figures


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--rs274', required=True)
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--count', type=int, default=100)
    parser.add_argument('--processes', type=int, default=1)
    parser.add_argument('--machine', choices=('mill', 'lathe'), default='mill')
    parser.add_argument('--keep')
    return parser.parse_args()


def main():
    words = arguments()
    totals, by_kind = collections.Counter(failures=0), collections.Counter()
    with multiprocessing.Pool(words.processes) as pool:
        for first in range(words.first, words.first + words.count, PIECE):
            made = [(cases if words.machine == 'mill' else lathe_cases).make(seed) for seed in range(first, min(first + PIECE, words.first + words.count))]
            answers = answers_of(made)
            for (seed, result, found, figures), case, answer in zip(pool.imap(check, [(c, a, words.rs274) for c, a in zip(made, answers)]), made, answers):
                totals[result] += 1
                totals['too long to cut'] += 'isTooLong' in figures
                if result == 'judged':
                    by_kind.update(step['type'] for step in case['job']['steps'])
                if found:
                    totals['failures'] += 1
                    print(f'seed {seed} ({case["mode"]}, {", ".join(s["type"] for s in case["job"]["steps"])}): {"; ".join(found)}', flush=True)
                    if words.keep:
                        pathlib.Path(words.keep).mkdir(parents=True, exist_ok=True)
                        (pathlib.Path(words.keep) / f'{seed}.ngc').write_text(answer['program'] or json.dumps(answer), encoding='utf-8')
    print(', '.join(f'{count} {name}' for name, count in sorted(totals.items()) if count or name == 'failures') or 'nothing')
    print('operations judged: ' + ', '.join(f'{name} {count}' for name, count in sorted(by_kind.items())))
    isFewer = totals['judged'] + totals['planted'] < words.count // 2
    sys.exit(1 if totals['failures'] or isFewer else 0)


if __name__ == '__main__':
    main()
