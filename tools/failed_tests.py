#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Prints why tests failed, from the logs of ctest: for each failed test its name and the lines with the reason.

usage: failed_tests.py FOLDER         FOLDER: Testing/Temporary of a build folder; prints nothing if no test failed
       failed_tests.py --self-test    runs ctest with tests that fail
The reason: for vitest each FAIL line with message and position, for GoogleTest each failed assertion, otherwise the end of the
output.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

MOST_LINES = 60
MOST_REASONS = 12  # further failed tests are only named
MOST_NAMES = 8
LONGEST_LINE = 200
LAST_LINES = 15
LONGEST_FAILURE = 12
COLOUR = re.compile(r'\x1b\[[0-9;]*m')
# A test in LastTest.log. The line before it says why ctest did not run the test.
ENTRY = re.compile(r'(?:^(?P<before>[^\s-].*)\n)?^(?P<number>\d+/\d+) Testing: (?P<name>.*)\n(?P=number) Test: (?P=name)\nCommand: (?s:.*?)\n'
                   r'Output:\n-+\n(?P<output>(?s:.*?))<end of output>\nTest time = +(?P<time>\S+) sec\n-+\n(?P<result>(?s:.*?))^"(?P=name)" end time:', re.M)
VITEST_FAIL = re.compile(r' *FAIL  \S')
VITEST_END = re.compile(r'⎯{5}')
VITEST_SOURCE = re.compile(r' *\d+\|( |$)| +\| +\^')
# printed before the summary, which is missing from a run that is ended by force
VITEST_EARLY = re.compile(r' +[×→] ')
GTEST_FAILURE = re.compile(r'\S.*: Failure$')
GTEST_END = re.compile(r'\[[ A-Z-]{10}\]|$')


def shortened(lines, most):
    """At most this number of lines; the last one is kept."""
    if len(lines) <= most:
        return lines
    return [*lines[:most - 2], f'({len(lines) - most + 1} lines more)', lines[-1]]


def failures_of(lines, begin, end, dropped=None):
    """The lines from each match of `begin` to a match of `end`."""
    found = []
    failure = None
    for line in [*lines, None]:
        if failure is not None and (line is None or end.match(line)):
            found += shortened(failure, LONGEST_FAILURE)
            failure = None
        if failure is None and line is not None and begin.match(line):
            failure = []
        if failure is not None and line and not (dropped and dropped.match(line)):
            failure.append(line)
    return found


def reason_of(test):
    lines = [COLOUR.sub('', line)[:LONGEST_LINE].rstrip() for line in test['output'].splitlines()]
    found = (failures_of(lines, VITEST_FAIL, VITEST_END, VITEST_SOURCE) or failures_of(lines, GTEST_FAILURE, GTEST_END)
             or [line for line in lines if VITEST_EARLY.match(line)] or [line for line in lines if line][-LAST_LINES:])
    # ctest's own reason, such as a required text that is not in the output.
    result = [line for line in test['result'].splitlines() if line and not re.fullmatch(r'Test (Failed\.|Passed\.|Fail Reason:)', line)]
    return found + result or [test['before'] or 'no output']


def report(folder):
    """The lines about the failed tests of the last run whose logs are in a folder."""
    failed_log = folder / 'LastTestsFailed.log'
    if not failed_log.exists():
        return []
    names = [line.split(':', 1)[1] for line in failed_log.read_text(encoding='utf-8').splitlines() if ':' in line]
    log = folder / 'LastTest.log'
    text = log.read_text(encoding='utf-8', errors='replace') if log.exists() else ''
    tests = {entry['name']: entry.groupdict() for entry in ENTRY.finditer(text)}
    titles = [f'-- {name}, {tests[name]["time"]} s' if name in tests else f'-- {name}' for name in names[:MOST_REASONS]]
    reasons = [reason_of(tests[name]) if name in tests else ['not in LastTest.log'] for name in names[:MOST_REASONS]]
    # The lines that short reasons do not use are available to long ones.
    left = MOST_LINES - len(titles) - MOST_NAMES
    shares = {}
    for number, i in enumerate(sorted(range(len(reasons)), key=lambda one: len(reasons[one]))):
        shares[i] = min(len(reasons[i]), left // (len(reasons) - number))
        left -= shares[i]
    lines = ['== failed tests']
    for i, (title, reason) in enumerate(zip(titles, reasons)):
        lines += [title, *shortened(reason, shares[i])]
    others = names[MOST_REASONS:]
    if others:
        lines.append(f'-- {len(others)} more: {" ".join(others)}'[:MOST_NAMES * LONGEST_LINE])
    return lines


VITEST_OUTPUT = r'''
   × gates > opens 3ms
     → expected 1 to be 2
 FAIL  tests/a.test.ts > gates > opens
 FAIL  tests/a.test.ts > gates > closes
\033[31mAssertionError: expected 1 to be 2 // Object.is equality\033[39m

- 2
+ 1

 ❯ untilText tests/rig.ts:10:5
     10|   code();
       |   ^
     11|
 ❯ tests/a.test.ts:12:5
⎯⎯⎯⎯⎯⎯⎯⎯⎯⎯[1/2]⎯

 FAIL  tests/b.test.ts > closes
Error: state is Off, not On
 ❯ tests/b.test.ts:7:3
⎯⎯⎯⎯⎯⎯⎯⎯⎯⎯[2/2]⎯
 Test Files  2 failed
'''
GTEST_OUTPUT = r'''
[ RUN      ] Jog.Stops
src/jog_test.cc:41: Failure
Expected equality of these values:
  1
  2

[  FAILED  ] Jog.Stops (0 ms)
'''
# The command of a test, and the lines of its reason; none for a test that passes.
SELF_TESTS = {
    'good': ('true', None),
    'vitest': (f"printf '{VITEST_OUTPUT}'; exit 1",
               [' FAIL  tests/a.test.ts > gates > opens', ' FAIL  tests/a.test.ts > gates > closes',
                'AssertionError: expected 1 to be 2 // Object.is equality', '- 2', '+ 1', ' ❯ untilText tests/rig.ts:10:5', ' ❯ tests/a.test.ts:12:5',
                ' FAIL  tests/b.test.ts > closes', 'Error: state is Off, not On', ' ❯ tests/b.test.ts:7:3']),
    'vitest_ended': (r"printf '   × opens 3ms\n     → expected 1\n   ✓ closes\n'; exit 1", ['   × opens 3ms', '     → expected 1']),
    'gtest': (f"printf '{GTEST_OUTPUT}'; exit 1", ['src/jog_test.cc:41: Failure', 'Expected equality of these values:', '  1', '  2']),
    'lines': ('for i in $(seq 100); do echo line $i; done; exit 1', [f'line {i}' for i in range(86, 101)]),
    'other_bytes': (r"printf '\377\n1/2 Testing: x\n<end of output>\n'; exit 1", ['\ufffd', '1/2 Testing: x', '<end of output>']),
    'silent': ('exit 1', ['no output']),
}


def run_ctest(folder, commands):
    """The report on a run of these commands by name, with ctest, from a file as CMake writes it."""
    def quoted(text):
        return '"' + re.sub(r'([\\"$])', r'\\\1', text) + '"'
    tests = [f'add_test({name} sh -c {quoted(command)})\n' for name, command in commands.items()]
    (folder / 'CTestTestfile.cmake').write_text(''.join(tests), encoding='utf-8')
    logs = folder / 'Testing/Temporary'
    for log in logs.glob('*.log'):
        log.unlink()
    subprocess.run(['ctest', '--parallel', '2'], cwd=folder, capture_output=True, check=False)
    return report(logs)


def self_test():
    faults = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for name, (command, wanted) in SELF_TESTS.items():
            title, *lines = run_ctest(folder, {'good': 'true', name: command})[1:] or [None]
            if (lines or None) != wanted or (wanted and not re.fullmatch(rf'-- {name}, [\d.]+ s', title)):
                faults.append(f'{name}: {title}: {lines}, not {wanted}')
        many = run_ctest(folder, {f'part_{i}': 'seq 50; exit 1' for i in range(40)})
        if len(many) > MOST_LINES or not all(any(f'part_{i}' in line for line in many) for i in range(40)):
            faults.append(f'of 40 failed tests: {len(many)} lines: {many}')
    print('\n'.join(faults) or f'{len(SELF_TESTS)} tests reported as they ended')
    return 1 if faults else 0


def main():
    words = sys.argv[1:]
    if words == ['--self-test']:
        return self_test()
    if len(words) != 1 or words[0].startswith('-'):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    for line in report(pathlib.Path(words[0])):
        print(line)
    return 0


if __name__ == '__main__':
    sys.exit(main())
