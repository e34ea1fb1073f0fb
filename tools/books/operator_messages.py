#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of all messages to people, from the texts in the sources (tools/texts.py) and their translations in po/.

usage: operator_messages.py ROOT            prints the page
       operator_messages.py ROOT --check    exit status 1: a message has no row, or a row has a text that no source has or an empty cell, or there are two rows for a text
       operator_messages.py ROOT --missing  prints the messages without a row, as rows for the tables

Cause and remedy of a message are written in a table "message | cause | remedy": the frequent ones in
docs/user/when_something_goes_wrong.md, the others in tools/books/messages/AREA.md. A text that a person never sees alone, such as the
hint or the reason of a message, is in a table "text | part of"; the page leaves out "help of PROGRAM". In the first of these files "as above" repeats the cell above it. A message is written as the page
shows it, with the mark … for each value; | is written \\|.
"""
import difflib
import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import texts

PAGE = 'docs/user/when_something_goes_wrong.md'
TABLES = 'tools/books/messages'
# Folder of the page. Links in cells are relative to the file of their table.
FOLDER = 'docs/reference'
LINK = re.compile(r'\]\((?!https?:)([^)#]+)')
# Title, name of the file in TABLES, folders whose texts it lists. Programs in Python have help texts only in the catalogue, and are not listed.
AREAS = (
    ('Commissioning', 'commissioning', ('src/machine/commissioning',)),
    ('Motion and homing', 'motion', ('src/motion', 'src/kinematics')),
    ('Task: programs, MDI, tools', 'task', ('src/machine/io', 'src/machine/journal', 'src/machine/task', 'src/machine/config', 'src/machine/certificate', 'src/machine/tools', 'src/machine/assembly', 'src/messages')),
    ('G-code', 'gcode', ('src/gcode',)),
    ('HAL', 'hal', ('src/hal/core', 'src/hal/capi', 'src/hal/host', 'src/hal/script', 'drivers')),
    ('INI files', 'ini', ('src/base/ini',)),
    ('Start and end of the machine', 'start', ('programs/start', 'src/runtime', 'src/base/diagnostics')),
    ('Programs: run, check, doctor, screen, setup', 'programs', ('programs/doctor', 'programs/run', 'programs/screen', 'programs/setup', 'src/clients/screen', 'src/base/options')),
    ('halcompile and HAL tools', 'hal_tools', ('src/hal/halcompile', 'src/hal/tools')),
    ('Drives and servers of remote clients', 'servers', ('programs/mains', 'programs/remote', 'programs/publish', 'programs/shop', 'src/clients/offers', 'src/clients/publish', 'src/clients/screen/files/offered_programs.cc', 'src/clients/shop')),
)
HOLE = '…'
# Clients search for its words, so it is in no catalogue (texts.NEVER).
NOT_TRANSLATED = {'joint {} on limit switch error': 'src/motion/interface/texts.cc'}
MESSAGE_TABLE = ('message', 'cause', 'remedy')
PART_TABLE = ('text', 'part of')
# Only in PAGE: the rows of the other files may change their order.
AS_ABOVE = 'as above'


def shown(text):
    """A key of the catalogue as people see it, with a mark for each value; as a cell of a table."""
    return re.sub(r'([|<>*_\[\]`\\])', r'\\\1', plain(text))


def plain(text):
    """A key of the catalogue in one line, with a mark for each value."""
    return re.sub(r'(\{\})+', HOLE, text.replace('\n', ' ')).strip()


class Row:
    """A row of a table: its position, the text of its first cell, and the other cells."""

    def __init__(self, file, number, text, cells):
        self.file, self.number, self.text, self.cells = file, number, text, cells

    def shown_cells(self):
        """The other cells with links that are relative to the page."""
        def moved(link):
            return '](' + os.path.relpath(os.path.join(os.path.dirname(self.file), link[1]), FOLDER)
        return [LINK.sub(moved, cell) for cell in self.cells]

    def is_message(self):
        return len(self.cells) == len(MESSAGE_TABLE) - 1

    def is_help(self):
        return not self.is_message() and self.cells[0].startswith('help of ')


def rows_of(root, file):
    """The rows of the tables of a file whose heads are MESSAGE_TABLE or PART_TABLE."""
    head, before = (), ()
    for number, line in enumerate((root / file).read_text(encoding='utf-8').splitlines(), 1):
        if not line.startswith('|'):
            head, before = (), ()
            continue
        cells = tuple(cell.strip() for cell in re.split(r'(?<!\\)\|', line.strip()[1:-1]))
        if head == ():
            head = cells
        elif head in (MESSAGE_TABLE, PART_TABLE) and not re.fullmatch(r'[|:-]+', line):
            before = tuple(old if cell == AS_ABOVE and file == PAGE else cell for cell, old in zip(cells[1:], before or cells[1:]))
            yield Row(file, number, cells[0].replace('\\|', '|'), before)


def all_rows(root):
    files = [PAGE, *(f'{TABLES}/{name}.md' for _, name, _ in AREAS if (root / TABLES / f'{name}.md').is_file())]
    return [row for file in files for row in rows_of(root, file)]


def messages_of(root, folders):
    found = NOT_TRANSLATED | texts.texts(root)
    return sorted((key for key, name in found.items() if name.startswith(folders) and not key.startswith('usage')), key=shown)


def table(head, rows):
    return [f'| {" | ".join(head)} |', '|---' * len(head) + '|', *(f'| {" | ".join(row)} |' for row in rows), ''] if rows else []


def page(root):
    german, spanish = (texts.read_po(root / 'po' / f'{language}.po') for language in ('de', 'es'))
    lines = ['# Operator messages', '', f'This page lists the messages to operators with causes and remedies. Generated from the sources and from `po/`. `{HOLE}` is a number, name or letter.',
             '[When something goes wrong](../user/when_something_goes_wrong.md) describes the frequent ones. A text under *Parts of messages* appears only in other messages.']
    rows = {row.text: row for row in all_rows(root)}
    for title, _, folders in AREAS:
        keys = [key for key in messages_of(root, folders) if plain(key) not in rows or not rows[plain(key)].is_help()]
        explained = [(shown(key), rows[plain(key)]) for key in keys if plain(key) in rows]
        parts = table(PART_TABLE, [(text, *row.shown_cells()) for text, row in explained if not row.is_message()])
        lines += ['', f'## {title}', '', *table(MESSAGE_TABLE, [(text, *row.shown_cells()) for text, row in explained if row.is_message()])]
        lines += ['### Parts of messages', '', *parts] if parts else []
        lines += ['### Translations', '', *table(('message', 'Deutsch', 'español'), [(shown(key), shown(german.get(key, '')), shown(spanish.get(key, ''))) for key in keys])]
    return '\n'.join(lines).rstrip() + '\n'


def missing(root):
    """[(file, message)] of the messages that have no row."""
    have = {row.text for row in all_rows(root)}
    return [(f'{TABLES}/{name}.md', plain(key)) for _, name, folders in AREAS for key in messages_of(root, folders) if plain(key) not in have]


def check(root):
    """Messages without a row, rows whose text no source has, each with the nearest text, rows with the same text, and rows with an empty cell."""
    known = {plain(key) for key in NOT_TRANSLATED | texts.texts(root)}
    seen, problems = {}, []
    for row in all_rows(root):
        place = f'{row.file}:{row.number}'
        if row.text not in known:
            nearest = difflib.get_close_matches(row.text, known, 1, 0)
            problems.append(f'{place}: no source has the message "{row.text}"; nearest: "{nearest[0] if nearest else ""}"')
        if row.text in seen:
            problems.append(f'{place}: "{row.text}" has a row in {seen[row.text]}')
        if not all(row.cells) or AS_ABOVE in row.cells:
            problems.append(f'{place}: a cell has no text')
        seen.setdefault(row.text, place)
    for problem in problems:
        print(problem)
    without = missing(root)
    for file, text in without:
        print(f'{file}: no row for the message "{text}"')
    print(f'{len(seen)} rows; {len(without)} messages have no row')
    return 1 if problems or without else 0


def main():
    words = sys.argv[1:]
    root = pathlib.Path(words[0]) if words else None
    if len(words) == 1:
        sys.stdout.write(page(root))
        return 0
    if len(words) == 2 and words[1] == '--check':
        return check(root)
    if len(words) == 2 and words[1] == '--missing':
        for file, text in missing(root):
            print(f'{file}: | {text.replace("|", chr(92) + "|")} | | |')
        return 0
    print(__doc__.strip(), file=sys.stderr)
    return 2


if __name__ == '__main__':
    sys.exit(main())
