#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Puts the pages of the books together for Sphinx.

usage: stage.py ROOT BUILD OUT
Copies docs/ of ROOT without the manual pages, adds to reference/ the pages that the build BUILD has generated (share/doc) and the list
of all messages, and the contents to each index.md: the pages that it links to, in that order. Prints the generated pages that BUILD does not have; a short
note is in their place.
"""
import os
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import check_links
import operator_messages

MESSAGES = 'reference/operator_messages.md'
LINK = re.compile(r'(?<!!)\[[^\]]*\]\(([^)#\s]+\.md)\)')


def contents_of(index, text):
    """The pages that an index links to in its own folder and below, without .md: each once, in order. A folder below with an index is that index."""
    pages = []
    for target in LINK.findall(text):
        path = os.path.normpath(target)
        is_of_other_index = '/' in path and not path.endswith('/index.md') and (index.parent / path).with_name('index.md').is_file()
        if not path.startswith('..') and path[:-3] not in pages and (index.parent / path).is_file() and not is_of_other_index:
            pages.append(path[:-3])
    return pages


def main():
    if len(sys.argv) != 4:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    root, build, out = (pathlib.Path(word) for word in sys.argv[1:])
    shutil.rmtree(out, ignore_errors=True)
    shutil.copytree(root / 'docs', out, ignore=shutil.ignore_patterns('man'))
    (out / MESSAGES).write_text(operator_messages.page(root), encoding='utf-8')
    for name, title in check_links.GENERATED.items():
        if name == MESSAGES:
            continue
        source = build / 'share/doc' / pathlib.Path(name).name
        if source.is_file():
            shutil.copy(source, out / name)
        else:
            print(f'{source} is missing: build the project first for the page "{title}"', file=sys.stderr)
            (out / name).write_text(f'# {title}\n\nThe build generates this page. Build the project, then build the books again.\n', encoding='utf-8')
    for index in sorted(out.rglob('index.md')):
        text = index.read_text(encoding='utf-8')
        pages = contents_of(index, text)
        index.write_text(text + '\n```{toctree}\n:hidden:\n' + '\n'.join(pages) + '\n```\n', encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main())
