# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs tests of HAL and machines in LinuxCNC's test format: each test is a folder.

A folder is a test when it has test.hal (run by halrun -f), test.sh (by bash) or test (by itself). It is run in that folder;
standard output goes to the file result, errors to stderr. It passes when its exit status is 0 and the
program checkresult, called with the path of result, ends with status 0. Without checkresult, result must equal the file
expected. A test with neither file fails. A file skip disables a test, unless it is a program that ends with status 0.
A test with a file xfail is expected to fail; if it passes, that is a failure.

A sampler that loses samples writes "overrun": the computer was too slow. Such a test is repeated, ten times at most.
"""
import argparse
import os
import pathlib
import signal
import subprocess
import sys
import time

from .language import Parser

PROGRAMS = {'test.hal': ('halrun', '-f'), 'test.sh': ('bash', '-x'), 'test': ()}
MOST_OVERRUNS = 10


def is_program(path):
    return path.is_file() and os.access(path, os.X_OK)


def find_tests(folders):
    tests = []
    for folder in folders:
        for path, names, files in os.walk(folder):
            names.sort()
            place = pathlib.Path(path)
            # A program called `test` counts as a test only beside a file `expected` or `checkresult`, because other
            # folders have such programs too.
            is_judged = 'expected' in files or 'checkresult' in files
            if any(name in files and (is_judged or name != 'test') for name in PROGRAMS):
                tests.append(place)
    return tests


def is_skipped(test, environment):
    skip = test / 'skip'
    if not skip.exists():
        return False
    return not is_program(skip) or subprocess.run([skip.absolute()], cwd=test, env=environment, stdin=subprocess.DEVNULL,
                                                   check=False).returncode != 0


def run_words(words, test, environment, patience_s):
    """The exit status; None if the program did not end. Its child processes end with it."""
    with open(test / 'result', 'wb') as result, open(test / 'stderr', 'wb') as errors:
        process = subprocess.Popen(words, cwd=test, env=environment, stdin=subprocess.DEVNULL, stdout=result, stderr=errors,
                                   start_new_session=True)
        try:
            return process.wait(patience_s)
        except subprocess.TimeoutExpired:
            return None
        finally:
            for number in (signal.SIGTERM, signal.SIGKILL):
                try:
                    os.killpg(process.pid, number)
                    process.wait(2)
                except (ProcessLookupError, subprocess.TimeoutExpired):
                    pass


def check(test, environment):
    """Why the result is wrong; empty if it is correct."""
    checkresult = test / 'checkresult'
    if checkresult.exists():
        words = [str(checkresult.absolute())] if is_program(checkresult) else ['bash', str(checkresult.absolute())]
        status = subprocess.run([*words, str((test / 'result').absolute())], cwd=test, env=environment, stdin=subprocess.DEVNULL,
                                check=False).returncode
        return '' if status == 0 else f'checkresult ends with status {status}'
    if not (test / 'expected').exists():
        return 'there is neither expected nor checkresult to judge it by'
    same = (test / 'result').read_bytes() == (test / 'expected').read_bytes()
    return '' if same else 'result is not what is expected'


def has_overrun(test, name):
    """The sampler marks lost samples with a line that contains only this word; other programs may print the word."""
    return name == 'test.hal' and b'overrun' in (test / 'result').read_bytes().splitlines()


def run_test(test, environment, patience_s):
    """Why the test fails; empty if it passes."""
    name = next(name for name in PROGRAMS if (test / name).exists())
    program = PROGRAMS[name]
    words = [*program, name] if program else [str((test / name).absolute())]
    for count in range(1, MOST_OVERRUNS + 1):
        status = run_words(words, test, environment, patience_s)
        if status is None:
            return f'did not end in {patience_s:g} s'
        if not has_overrun(test, name):
            return check(test, environment) if status == 0 else f'ends with status {status}'
        print(f'{test}: overrun detected in sampler, run {count}', flush=True)
    return f'{MOST_OVERRUNS} overruns detected, giving up'


def show_end(count, failed):
    print(f'{count["run"]} tests run, {count["passed"]} successful, {len(failed)} failed + {count["xfail"]} expected, '
          f'{count["skipped"]} skipped')
    for test in failed:
        print(f'  {test}')


def main(arguments, programs):
    """`programs`: folder of halrun and other programs that tests call; it is searched first."""
    parser = Parser(prog='runtests', description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folders', nargs='*', default=['.'], help='folder to search for tests (default: the current folder)')
    parser.add_argument('-n', action='store_true', help='only list the tests that would run')
    parser.add_argument('-s', action='store_true', help='stop at the first failed test')
    parser.add_argument('-v', action='store_true', help='show output and errors of failed tests')
    parser.add_argument('--patience', type=float, default=120, metavar='S', help='time limit for each test (120)')
    options = parser.parse_args(arguments)
    environment = dict(os.environ, PATH=f'{programs}:{os.environ.get("PATH", os.defpath)}')
    environment.setdefault('MILLWRIGHT_INSTANCE', f'runtests-{os.getpid()}')
    count = dict.fromkeys(('run', 'passed', 'xfail', 'skipped'), 0)
    failed = []
    for test in find_tests(options.folders):
        if is_skipped(test, environment):
            count['skipped'] += 1
            print(f'skipped: {test}')
            continue
        if options.n:
            print(test)
            continue
        begin = time.monotonic()
        count['run'] += 1
        why = run_test(test, environment, options.patience)
        is_xfail = (test / 'xfail').exists()
        if is_xfail and why:
            count['xfail'] += 1
            print(f'failed as expected: {test}: {why}', flush=True)
            continue
        if is_xfail:
            why = 'passes, but the file xfail says that it fails'
        count['passed'] += not why
        print(f'{"FAILED" if why else "passed"}: {test} ({time.monotonic() - begin:.1f} s){": " + why if why else ""}', flush=True)
        if why:
            failed.append(test)
            if options.v:
                print((test / 'result').read_text(errors='replace') + (test / 'stderr').read_text(errors='replace'))
            if options.s:
                break
    if not options.n:
        show_end(count, failed)
    return 1 if failed else 0
