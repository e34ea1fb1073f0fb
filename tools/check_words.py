#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Counts phrases that are not plain English in all prose: pages, comments, messages, texts of the screen.

usage: check_words.py ROOT [--by-file] [--show N] [--write]
tools/words.txt contains the phrases and the maximum number of occurrences. Exit status 1: the tree has more occurrences, or 50
fewer (--write corrects the number, which may only decrease).
  --by-file  the files with the most occurrences
  --show N   N random occurrences with their phrase
"""
import collections
import pathlib
import random
import re
import subprocess
import sys

CODE = ('.cc', '.hh', '.c', '.h', '.ts', '.svelte')
HASH = ('.py', '.cmake', '.sh', '.txt')
NOT_OURS = re.compile(r'package-lock|/corpus/|legacy_messages|^tools/words\.txt$|^LICENSE$|^nc_files/|^po/|^configs/|\.svg$|i18n/(de|es)\.ts$')
COMMENT = re.compile(r'//+[/!<]*\s?(.*)$')
STRING = re.compile(r'"((?:[^"\\]|\\.)*)"|\'((?:[^\'\\]|\\.)*)\'|`((?:[^`\\]|\\.)*)`')
WORDS_IN_TEXT = 3
# The first cell of the tables in this folder repeats a text of the sources, which is counted there.
TABLES_OF_MESSAGES = 'tools/books/messages'
REPEATED_CELL = re.compile(r'^\| .*? \| ')
SLACK = 50


def prose_of(path, text):
    """(line number, prose) of each line with prose."""
    suffix = path.suffix
    is_fenced = False
    has_repeated = path.parent.match(TABLES_OF_MESSAGES)
    for number, line in enumerate(text.splitlines(), 1):
        line = REPEATED_CELL.sub('', line) if has_repeated else line
        if suffix in ('.md', '.scd'):
            if line.lstrip().startswith('```'):
                is_fenced = not is_fenced
            elif not is_fenced and not line.startswith('    ') and re.search(r'[A-Za-z]{2,} [A-Za-z]{2,}', line):
                yield number, re.sub(r'`[^`]*`', '', line)
            continue
        found = []
        if suffix in CODE:
            match = COMMENT.search(line)
            if match:
                found.append(match.group(1))
                line = line[:match.start()]
            elif line.lstrip().startswith('*'):
                found.append(line)
            found += [text for groups in STRING.findall(line) for text in groups if len(re.findall(r'[A-Za-z]{2,}', text)) >= WORDS_IN_TEXT and ' ' in text]
        elif suffix in HASH or not suffix:
            match = re.search(r'(?:^|\s)#\s?(.*)$', line)
            if match and not line.startswith('#!'):
                found.append(match.group(1))
                line = line[:match.start()]
            found += [text for groups in STRING.findall(line) for text in groups if len(re.findall(r'[A-Za-z]{2,}', text)) >= WORDS_IN_TEXT and ' ' in text]
        if found and any(re.search('[A-Za-z]{2,}', text) for text in found):
            yield number, ' '.join(found)


def files_of(root):
    names = subprocess.run(['git', '-C', str(root), 'ls-files', '-co', '--exclude-standard'], capture_output=True, text=True,
                           check=True).stdout.splitlines()
    for name in names:
        path = root / name
        if (path.suffix in CODE + HASH + ('.md', '.scd') or not path.suffix) and path.is_file() and not NOT_OURS.search(name):
            yield name, path


def places(root, phrases):
    """(lines of prose, [(file, line, phrase, better word)])."""
    lines, found = 0, []
    for name, path in files_of(root):
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            continue
        for number, prose in prose_of(path, text):
            lines += 1
            for phrase, better in phrases:
                found += [(name, number, match.group(), better, prose.strip()) for match in phrase.finditer(prose)]
    return lines, found


def main():
    root = pathlib.Path(sys.argv[1])
    table = root / 'tools' / 'words.txt'
    text = table.read_text()
    highest = int(re.search(r'^places: (\d+)$', text, re.M).group(1))
    phrases = [(re.compile(row.split('\t')[0], re.I), row.split('\t')[1]) for row in text.splitlines() if '\t' in row and not row.startswith('#')]
    lines, found = places(root, phrases)
    if '--by-file' in sys.argv:
        for name, count in collections.Counter(one[0] for one in found).most_common(60):
            print(f'{count:5} {name}')
    if '--show' in sys.argv:
        for name, number, phrase, better, prose in random.sample(found, min(len(found), int(sys.argv[sys.argv.index('--show') + 1]))):
            print(f'{name}:{number}: "{phrase}", better: {better}: {prose[:150]}')
    print(f'{len(found)} places in {lines} lines of prose: {1000 * len(found) / max(lines, 1):.1f} per 1,000 lines; highest: {highest}')
    if '--write' in sys.argv and len(found) < highest:
        table.write_text(text.replace(f'places: {highest}', f'places: {len(found)}'))
        return 0
    if len(found) > highest:
        print('more places than before: --show 20 names some; tools/words.txt has the better words')
        return 1
    if len(found) + SLACK <= highest:
        print('fewer places than before: check_words.py ROOT --write notes it')
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
