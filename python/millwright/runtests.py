# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs tests of HAL and machines that are folders, in the form of LinuxCNC's.

A folder is a test when it has test.hal (run by halrun -f), test.sh (by bash) or test (by itself). It is run in that folder;
standard output goes to the file result, errors to stderr. It passes when its status is 0 and, where there is checkresult, that
program's is 0 (with the path of result as its word), else where result is what the file expected has. A file skip keeps a
test from being run: unless it is a program that ends with status 0.
"""
import argparse
import os
import pathlib
import signal
import subprocess
import sys
import time

PROGRAMS = {'test.hal': ('halrun', '-f'), 'test.sh': ('bash', '-x'), 'test': ()}


def is_program(path):
    return path.is_file() and os.access(path, os.X_OK)


def find_tests(folders):
    tests = []
    for folder in folders:
        for path, names, files in os.walk(folder):
            names.sort()
            place = pathlib.Path(path)
            if any(name in files for name in PROGRAMS) and ('expected' in files or 'checkresult' in files):
                tests.append(place)
    return tests


def is_skipped(test, environment):
    skip = test / 'skip'
    if not skip.exists():
        return False
    return not is_program(skip) or subprocess.run([skip.absolute()], cwd=test, env=environment, stdin=subprocess.DEVNULL,
                                                   check=False).returncode != 0


def run_words(words, test, environment, patience_s):
    """The exit status; None when it did not end. What it has started ends with it."""
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
    """Why the result is wrong; empty when it is right."""
    checkresult = test / 'checkresult'
    if checkresult.exists():
        words = [str(checkresult.absolute())] if is_program(checkresult) else ['bash', str(checkresult.absolute())]
        status = subprocess.run([*words, str((test / 'result').absolute())], cwd=test, env=environment, stdin=subprocess.DEVNULL,
                                check=False).returncode
        return '' if status == 0 else f'checkresult ends with status {status}'
    same = (test / 'result').read_bytes() == (test / 'expected').read_bytes()
    return '' if same else 'result is not what is expected'


def run_test(test, environment, patience_s):
    name = next(name for name in PROGRAMS if (test / name).exists())
    program = PROGRAMS[name]
    words = [*program, name] if program else [str((test / name).absolute())]
    status = run_words(words, test, environment, patience_s)
    if status is None:
        return f'did not end in {patience_s:g} s'
    return check(test, environment) if status == 0 else f'ends with status {status}'


def main(arguments):
    parser = argparse.ArgumentParser(prog='runtests', description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folders', nargs='*', default=['.'], help='looked through for tests; default: where you are')
    parser.add_argument('-n', action='store_true', help='only tell which would be run')
    parser.add_argument('-s', action='store_true', help='stop at the first that fails')
    parser.add_argument('-v', action='store_true', help='show output and errors of those that fail')
    parser.add_argument('--patience', type=float, default=120, metavar='S', help='so long each may take (120)')
    options = parser.parse_args(arguments)
    environment = dict(os.environ)
    environment.setdefault('MILLWRIGHT_INSTANCE', f'runtests-{os.getpid()}')
    count = {'passed': 0, 'failed': 0, 'skipped': 0}
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
        why = run_test(test, environment, options.patience)
        count['failed' if why else 'passed'] += 1
        print(f'{"FAILED" if why else "passed"}: {test} ({time.monotonic() - begin:.1f} s){": " + why if why else ""}', flush=True)
        if why:
            failed.append(test)
            if options.v:
                print((test / 'result').read_text(errors='replace') + (test / 'stderr').read_text(errors='replace'))
            if options.s:
                break
    if not options.n:
        print(f'{count["passed"]} passed, {count["failed"]} failed, {count["skipped"]} skipped')
    for test in failed:
        print(f'  {test}')
    return 1 if failed else 0
