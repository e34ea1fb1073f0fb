#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that no class has more than 40 member functions or 30 data members; those of nested classes count for the outer class.

usage: check_classes.py ROOT [--list N]; exit status 1 lists classes that are too large. --list: the N largest classes.
Constructors count. `= default`, `= delete` and constants (static constexpr) do not.
"""
import argparse
import pathlib
import re
import subprocess
import sys

FUNCTION_LIMIT = 40
DATA_LIMIT = 30
# Classes over the limits: the permitted numbers of functions and data members, with the reason. A class that
# has become small enough must not be in this list.
OVERLOADS = 'one overload for each alternative of a closed variant'
PINS = 'the pins of a module, one member each'
SETTINGS = 'plain values without behaviour, one for each key or field'
EXCEPTIONS = {
    'Bldc': (12, 41, PINS),
    'Carousel': (13, 41, PINS),
    'Pid': (5, 44, PINS),
    'Settings': (0, 33, SETTINGS),
    'Status': (0, 46, SETTINGS),
    'Recorder': (42, 5, OVERLOADS),
}

HEAD = re.compile(r'^(?:template\s*<.*>\s*)?(?:class|struct|union)\s+(?:alignas\s*\([^)]*\)\s*)?(?:\[\[\w+\]\]\s*)?'
                  r'(?P<name>[\w:]+)(?:\s+final)?\s*(?::[^:].*)?$', re.DOTALL)


def code_of(text):
    """Removes comments, texts and preprocessor lines; the line numbers do not change."""
    text = re.sub(r'/\*.*?\*/', lambda m: '\n' * m.group().count('\n'), text, flags=re.DOTALL)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)
    text = re.sub(r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", "' '", text)
    text = re.sub(r'//[^\n]*', '', text)
    return re.sub(r'^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', lambda m: '\n' * m.group().count('\n'), text, flags=re.MULTILINE)


def matching(code, start):
    """Position of the brace that closes the brace at `start`."""
    depth = 0
    for i in range(start, len(code)):
        depth += {'{': 1, '}': -1}.get(code[i], 0)
        if depth == 0:
            return i
    return len(code)


def without_angles(text):
    """Removes template arguments: in a declaration, '<' after a name opens them."""
    before = None
    while before != text:
        before = text
        text = re.sub(r'(?<=[\w>])\s*<[^<>]*>', '', text)
    return text


class Counts:
    def __init__(self):
        self.functions = self.data = 0

    def add(self, other):
        self.functions += other.functions
        self.data += other.data


def count_member(text, counts):
    """`text`: one declaration up to its ';' or its body."""
    text = text.strip()
    text = re.sub(r'^(?:(?:public|private|protected)\s*:\s*)+', '', text)
    while text.startswith('template'):
        text = re.sub(r'^template\s*<[^<>]*(?:<[^<>]*>[^<>]*)*>\s*', '', text, count=1)
        if text.startswith('template'):
            return
    text = re.sub(r'^\[\[\w+\]\]\s*', '', text)
    if not text or re.match(r'(using|friend|static_assert|typedef|enum|class|struct|union|extern)\b', text):
        return
    if re.search(r'=\s*(default|delete)$', text):
        return
    flat = without_angles(re.sub(r'\{[^{}]*\}', '', text))
    flat = re.sub(r'\balignas\s*\([^)]*\)', '', flat)
    bracket, equal = flat.find('('), flat.find('=')
    if bracket >= 0 and (equal < 0 or bracket < equal or 'operator' in flat[:bracket]):
        counts.functions += 1
    elif 'constexpr' not in flat:
        depth, declarators = 0, 1
        for char in flat:
            depth += {'(': 1, '[': 1, '{': 1, ')': -1, ']': -1, '}': -1}.get(char, 0)
            declarators += char == ',' and depth == 0
        counts.data += declarators


def scan(code, begin, end, line_of, found, owner=None, prefix=''):
    """Reads the declarations between two positions; `owner` collects the members of the class around them."""
    start = i = begin
    while i < end:
        char = code[i]
        if char == ';':
            if owner is not None:
                count_member(code[start:i], owner)
            start = i + 1
        elif char == '{':
            close = matching(code, i)
            head = re.sub(r'^\s*(?:(?:public|private|protected)\s*:\s*)+', '', code[start:i]).strip()
            match = HEAD.match(head)
            if match and not head.startswith('enum'):
                counts = Counts()
                name = prefix + match['name']
                scan(code, i + 1, close, line_of, found, counts, name + '::')
                found.append((name, line_of(i), counts))
                if owner is not None:
                    owner.add(counts)
                start = code.find(';', close) + 1
                if owner is not None and code[close + 1:start - 1].strip():
                    count_member('int ' + code[close + 1:start - 1], owner)  # struct {...} name;
                i = start - 1
            elif re.match(r'(inline\s+)?namespace\b|extern\s*""$', head):
                scan(code, i + 1, close, line_of, found, None, prefix)
                start, i = close + 1, close
            else:
                flat = without_angles(head)
                isBody = owner is not None and '(' in flat and not re.search(r'=\s*$', flat) and not head.startswith('enum')
                i = close
                if isBody or owner is None:
                    if owner is not None and not re.match(r'\s*\{', code[close + 1:]):
                        count_member(head, owner)
                    start = close + 1
        i += 1


def classes_of(path):
    code = code_of(path.read_text())
    found = []
    scan(code, 0, len(code), lambda place: code.count('\n', 0, place) + 1, found)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('root', type=pathlib.Path)
    parser.add_argument('--list', type=int, default=0)
    options = parser.parse_args()
    names = subprocess.run(['git', '-C', str(options.root), 'ls-files', '-co', '--exclude-standard'], capture_output=True,
                           text=True, check=True).stdout.split('\n')
    everything, failures = [], 0
    unused = set(EXCEPTIONS)
    for name in names:
        path = options.root / name
        if path.suffix not in ('.hh', '.cc') or not path.is_file():
            continue
        for label, line, counts in classes_of(path):
            everything.append((counts.functions, counts.data, label, name, line))
            if counts.functions <= FUNCTION_LIMIT and counts.data <= DATA_LIMIT:
                continue
            unused.discard(label)
            functions, data, _ = EXCEPTIONS.get(label, (FUNCTION_LIMIT, DATA_LIMIT, ''))
            if counts.functions > functions or counts.data > data:
                failures += 1
                print(f'{name}:{line}: {label} has {counts.functions} functions (at most {functions}) and '
                      f'{counts.data} data members (at most {data})')
    for label in sorted(unused):
        failures += 1
        print(f'tools/check_classes.py: {label} is small enough now: it needs no exception')
    for functions, data, label, name, line in sorted(everything, reverse=True)[:options.list]:
        print(f'{functions:4} functions {data:4} data  {label}  {name}:{line}')
    print(f'{len(everything)} classes checked, {failures} findings')
    return 1 if failures or not everything else 0


if __name__ == '__main__':
    sys.exit(main())
