#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks the subjects of commits: imperative, at most 72 characters, one intent, no rows of requirements and no seeds.

usage: check_subjects.py ROOT            the commits since the one that added this file, without merges
       check_subjects.py --message FILE  the message in FILE: a commit-msg hook of Git
       check_subjects.py --self-test     subjects with and without faults
Exit status 1: a subject breaks a rule; 77: the checkout has no history.
"""
import pathlib
import re
import subprocess
import sys

LONGEST = 72
SKIPPED = 77
SELF = 'tools/check_subjects.py'
# First words that are imperatives although they have the ending of another form.
IMPERATIVES = {'feed', 'embed', 'need', 'speed', 'seed', 'shed', 'proceed', 'exceed', 'bring', 'ring', 'string', 'pass', 'bypass', 'press', 'process',
               'address', 'express', 'compress', 'suppress', 'access', 'cross', 'guess', 'miss', 'discuss', 'focus', 'bias'}
NO_VERBS = {'the', 'a', 'an', 'one', 'two', 'all', 'some', 'no', 'not', 'who', 'what', 'where', 'when', 'why', 'how', 'without', 'with', 'if',
            'in', 'on', 'at', 'of', 'from', 'to', 'for', 'by', 'as', 'now', 'nobody', 'documents', 'more', 'new', 'better', 'this', 'it', 'its', 'we'}
# Verbs that are not nouns, so that ", and VERB" is a second intent.
SECOND_VERBS = 'add|remove|delete|correct|describe|rename|rewrite|replace|reject|allow|keep|give|make|read|write|install|load|explain|judge|let|use|fix'
RULES = (
    (re.compile(r'^[^A-Z]'), 'begins with a capital letter'),
    (re.compile(r'\.$'), 'has no full stop at its end'),
    (re.compile(r'^\S+:'), 'is a sentence, without a topic before a colon'),
    (re.compile(rf';|, and (?:{SECOND_VERBS})\b'), 'has one intent: a second one is a second commit'),
    (re.compile(r'\((?:[A-K]\d{1,2})(?:, ?[A-K]\d{1,2})*\)|\brows? [A-K]\d{1,2}\b'), 'names no rows of the requirements'),
    (re.compile(r'\bseeds? (?:no\. )?\d|\b\d{6,}\b|\b(?=[0-9a-f]*\d)[0-9a-f]{7,40}\b', re.I), 'names no seed and no commit'),
)


def faults_of(subject):
    """The rules that a subject violates."""
    faults = [rule for pattern, rule in RULES if pattern.search(subject)]
    if len(subject) > LONGEST:
        faults.append(f'has at most {LONGEST} characters, not {len(subject)}')
    first = re.match(r"[A-Za-z'-]*", subject).group().lower()
    is_other_form = re.search(r'(?:ed|ing|[^su]s)$', first) and first not in IMPERATIVES
    if is_other_form or first in NO_VERBS:
        faults.append(f'begins with a verb in the imperative, not "{first}"')
    return faults


def report(named_subjects):
    """Prints the faults of (name, subject) pairs; returns the number of subjects with faults."""
    wrong = 0
    for name, subject in named_subjects:
        faults = faults_of(subject)
        wrong += bool(faults)
        for fault in faults:
            print(f'{name}: "{subject}": a subject {fault}')
    return wrong


def git(root, *words):
    return subprocess.run(['git', '-C', str(root), *words], capture_output=True, text=True, check=False)


def subjects_since_self(root):
    """(short hash, subject) of the commits that descend from the one that added this file, and of that one; None without history."""
    added = git(root, 'log', '--diff-filter=A', '--format=%H', '--', SELF)
    is_shallow = git(root, 'rev-parse', '--is-shallow-repository').stdout.strip() == 'true'
    if added.returncode != 0 or is_shallow or not added.stdout.split():
        return None
    first = added.stdout.split()[-1]
    log = git(root, 'log', '--no-merges', '--ancestry-path', '--format=%h\t%s', f'{first}..HEAD').stdout
    own = git(root, 'log', '-1', '--format=%h\t%s', first).stdout
    return [tuple(line.split('\t', 1)) for line in (log + own).splitlines()]


def self_test():
    good = ('Limit teleop jogs by joint jerk', 'Report E-stop, limits and homing in halui', 'Reject an unreached break in a repeat, and G76 with K of J or less',
            'Pass offsets to the planner', 'Feed the watchdog in each servo cycle', 'Read M19 R180 as LinuxCNC does', 'Bring sessions back to radius mode')
    wrong = ('Added jog limits', 'limit jogs', 'Limit jogs.', 'Planner: limit jogs', 'Limit jogs; rename pins', 'Load boards, and read their names',
             'Limit jogs (C5, C13)', 'Repair the plan of seed 4711', 'Repair the failure of 1526502', 'Documents: counts', 'Repair what 8d73a79f broke',
             'The planner limits jogs', 'Limits jogs', 'Limiting jogs', 'Limit the jogs of all joints and axes by the jerk that the INI file allows them')
    failures = [f'"{one}" is accepted' for one in wrong if not faults_of(one)] + [f'"{one}" is rejected: {faults_of(one)}' for one in good if faults_of(one)]
    print('\n'.join(failures) or f'{len(good)} subjects accepted, {len(wrong)} rejected')
    return 1 if failures else 0


def main():
    words = sys.argv[1:]
    if words == ['--self-test']:
        return self_test()
    if len(words) == 2 and words[0] == '--message':
        lines = [line for line in pathlib.Path(words[1]).read_text(encoding='utf-8').splitlines() if not line.startswith('#')]
        subject = lines[0] if lines else ''
        return 1 if not subject.startswith('Merge ') and report([('this commit', subject)]) else 0
    if len(words) == 1 and not words[0].startswith('-'):
        subjects = subjects_since_self(words[0])
        if subjects is None:
            print(f'no history here that has the commit that added {SELF}: nothing to check')
            return SKIPPED
        wrong = report(subjects)
        print(f'{len(subjects)} subjects, {wrong} with faults')
        return 1 if wrong else 0
    print(__doc__.strip(), file=sys.stderr)
    return 2


if __name__ == '__main__':
    sys.exit(main())
