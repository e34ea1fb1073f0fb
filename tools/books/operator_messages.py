#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of all messages to people, from the texts in the sources (tools/texts.py) and their translations in po/.

usage: operator_messages.py ROOT          prints the page
       operator_messages.py ROOT --check  exit status 1: docs/user/when_something_goes_wrong.md has a message that no source has
"""
import difflib
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import texts

PAGE = 'docs/user/when_something_goes_wrong.md'
# Title: folders whose texts it lists. Help texts, and programs other than the machine, are not listed.
AREAS = (
    ('Motion and homing', ('src/motion', 'src/kinematics')),
    ('Task: programs, MDI, tools', ('src/machine', 'src/messages')),
    ('G-code', ('src/gcode',)),
    ('HAL', ('src/hal/core', 'src/hal/host', 'src/hal/script', 'drivers')),
    ('INI files', ('src/base/ini',)),
    ('Start and end of the machine', ('programs/start', 'src/runtime', 'src/base/diagnostics')),
)
# Shorter texts are parts of other messages.
WORDS_OF_A_MESSAGE = 4
HOLE = '…'
# Clients look for its words, so it is in no catalogue (texts.NEVER).
NOT_TRANSLATED = ('joint … on limit switch error',)


def shown(text):
    """A key of the catalogue as people see it, with the mark for each value; as a cell of a table."""
    return re.sub(r'([|<>*_\[\]`\\])', r'\\\1', plain(text))


def plain(text):
    """A key of the catalogue in one line, with the mark for each value."""
    return re.sub(r'(\{\})+', HOLE, text.replace('\n', ' ')).strip()


def remedies_of(text):
    """{message: (cause, remedy)} of the tables of PAGE. "As above" becomes the text of the row before."""
    found = {}
    before = ('', '')
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip('| ').split(' | ')]
        if line.startswith('| ') and len(cells) == 3 and cells[0] not in ('message', 'symptom'):
            before = tuple(old if cell == 'as above' else cell for cell, old in zip(cells[1:], before))
            found[cells[0]] = before
    return found


def messages_of(root, folders):
    found = texts.texts(root)
    keys = [key for key, name in found.items() if name.startswith(folders)]
    return sorted((key for key in keys if len(re.findall(r'[A-Za-z]{2,}', key)) >= WORDS_OF_A_MESSAGE and not key.startswith('usage')), key=shown)


def page(root):
    german, spanish = (texts.read_po(root / 'po' / f'{language}.po') for language in ('de', 'es'))
    lines = ['# Operator messages', '', f'Generated from the sources and from `po/`. `{HOLE}` is a number, name or letter. Messages say what happened and what to do;',
             '[When something goes wrong](../user/when_something_goes_wrong.md) has more about the common ones. Some texts are parts of a longer message.']
    remedies = remedies_of((root / PAGE).read_text(encoding='utf-8'))
    for title, folders in AREAS:
        lines += ['', f'## {title}', '']
        explained = [(shown(key), *remedies[plain(key)]) for key in messages_of(root, folders) if plain(key) in remedies]
        if explained:
            lines += ['| message | cause | remedy |', '|---|---|---|', *(f'| {" | ".join(row)} |' for row in explained), '']
        lines += ['| message | Deutsch | español |', '|---|---|---|']
        lines += [f'| {shown(key)} | {shown(german.get(key, ""))} | {shown(spanish.get(key, ""))} |' for key in messages_of(root, folders)]
    return '\n'.join(lines) + '\n'


def check(root):
    """Messages in the first column of PAGE that are no texts of the sources, each with the nearest one."""
    known = {plain(key) for key in texts.texts(root)}
    known.update(NOT_TRANSLATED)
    wrong = 0
    is_message = False
    for number, line in enumerate((root / PAGE).read_text(encoding='utf-8').splitlines(), 1):
        cells = line.split(' | ')
        if line.startswith('| '):
            first = cells[0][2:]
            if first in ('message', 'symptom'):
                is_message = first == 'message'
            elif is_message and first not in known:
                wrong += 1
                nearest = difflib.get_close_matches(first, known, 1, 0)
                print(f'{PAGE}:{number}: no source has the message "{first}"; nearest: "{nearest[0] if nearest else ""}"')
    return 1 if wrong else 0


def main():
    words = sys.argv[1:]
    if len(words) == 1:
        sys.stdout.write(page(pathlib.Path(words[0])))
        return 0
    if len(words) == 2 and words[1] == '--check':
        return check(pathlib.Path(words[0]))
    print(__doc__.strip(), file=sys.stderr)
    return 2


if __name__ == '__main__':
    sys.exit(main())
