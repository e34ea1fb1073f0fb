#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks the links between pages and the files that pages and sources name. Uses no network.

usage: check_links.py ROOT
Findings, each with file and line (exit status 1):
  - a link of a page to a file, folder or heading that does not exist
  - a file of the tree that a page names in `backquotes` and that does not exist
  - a page or picture docs/... that any text file names and that does not exist
  - a page of docs/ that the index.md of its folder does not link to
Pages that the build generates count as files (GENERATED).
"""
import os
import pathlib
import re
import subprocess
import sys

# Page in docs/: title. The program reference_pages writes them to share/doc of the build, tools/books the last one.
GENERATED = {
    'reference/ini.md': 'Keys of INI files',
    'reference/messages.md': 'Messages',
    'reference/nml_messages.md': 'NML messages',
    'reference/published.md': 'Published values',
    'reference/states.md': 'Commands and states',
    'reference/operator_messages.md': 'Operator messages',
}
LINK = re.compile(r'\[(?:[^\[\]]|`[^`]*`)*\]\(([^)\s]+)\)')
NAMED = re.compile(r'`((?:bench|cmake|components|configs|docs|drivers|examples|nc_files|packaging|po|programs|python|script|src|tests|tools|web)/[\w./-]*[\w-])`')
PAGE = re.compile(r'(?<![\w/.-])docs/[\w./-]+\.(?:md|svg|png|scd)\b')
PLACEHOLDER = re.compile(r'NAME')
HEADING = re.compile(r'^#{1,6} (.*?)\s*$')
NOT_READ = ('.svg', '.png')
# Texts in which docs/... is an example or a path of another project.
NOT_OURS = re.compile(r'^(tests/halcompile/corpus/|web/package-lock\.json$|LICENSE$)')


def anchor_of(heading):
    """The anchor of a heading as GitHub and MyST create it."""
    text = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading.replace('`', '')).strip().lower()
    return re.sub(r'[^\w\- ]', '', text).replace(' ', '-')


def lines_outside_fences(text):
    """(line number, line) of the prose of a page: without fenced and indented blocks."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith('```'):
            fenced = not fenced
        elif not fenced and not line.startswith('    '):
            yield number, line


class Tree:
    """The files of the tree and the headings of its pages."""

    def __init__(self, root):
        self.root = root
        listed = subprocess.run(['git', '-C', str(root), 'ls-files', '-co', '--exclude-standard'], capture_output=True, text=True, check=True)
        self.files = [name for name in listed.stdout.splitlines() if (root / name).is_file()]
        self.names = set(self.files) | {'docs/' + name for name in GENERATED}
        self.folders = {str(parent) for name in self.names for parent in pathlib.PurePath(name).parents}
        # A class is referred to by its header without the suffix.
        self.stems = {os.path.splitext(name)[0] for name in self.names}
        self.anchors = {}

    def has(self, name):
        return name in self.names or name in self.folders

    def has_anchor(self, page, anchor):
        if page not in self.anchors:
            text = (self.root / page).read_text(encoding='utf-8') if (self.root / page).is_file() else ''
            found = (HEADING.match(line) for _, line in lines_outside_fences(text))
            self.anchors[page] = {anchor_of(match[1]) for match in found if match}
        return anchor in self.anchors[page]


def links_of(tree, name, text):
    """Findings in the links and names of a page."""
    for number, line in lines_outside_fences(text):
        for target in LINK.findall(re.sub(r'`[^`]*`', '', line)):
            if re.match(r'[a-z]+:', target):
                continue
            path, _, anchor = target.partition('#')
            page = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
            if not tree.has(page):
                yield number, f'{target} does not exist'
            elif anchor and page[5:] not in GENERATED and not tree.has_anchor(page, anchor):
                yield number, f'{page} has no heading #{anchor}'
        for named in NAMED.findall(line):
            if not (tree.has(named) or tree.has(os.path.join(os.path.dirname(name), named)) or named in tree.stems or PLACEHOLDER.search(named)):
                yield number, f'{named} does not exist'


def pages_named(tree, text):
    """Findings in the pages and pictures that any text names."""
    for number, line in enumerate(text.splitlines(), 1):
        for named in PAGE.findall(line):
            if not tree.has(named):
                yield number, f'{named} does not exist'


def not_in_an_index(tree):
    """Pages that the index of their folder, or of the folder above, does not link to."""
    for name in sorted(tree.names):
        if not name.startswith('docs/') or not name.endswith('.md') or name in ('docs/index.md',):
            continue
        folder = os.path.dirname(name)
        if name.endswith('/index.md') or folder + '/index.md' not in tree.names:
            folder = os.path.dirname(folder)
        index = folder + '/index.md'
        text = (tree.root / index).read_text(encoding='utf-8') if index in tree.names else ''
        if f']({os.path.relpath(name, folder)})' not in text:
            yield name, f'{index} does not link to this page'


def main():
    if len(sys.argv) != 2:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    tree = Tree(pathlib.Path(sys.argv[1]))
    findings, pages = [], 0
    for name in tree.files:
        if name.endswith(NOT_READ) or NOT_OURS.search(name):
            continue
        try:
            text = (tree.root / name).read_text(encoding='utf-8')
        except UnicodeDecodeError:
            continue
        if name.endswith('.md'):
            pages += 1
            findings += [f'{name}:{number}: {what}' for number, what in links_of(tree, name, text)]
        findings += [f'{name}:{number}: {what}' for number, what in pages_named(tree, text)]
    findings += [f'{name}: {what}' for name, what in not_in_an_index(tree)]
    for finding in dict.fromkeys(findings):
        print(finding)
    print(f'{pages} pages checked, {len(set(findings))} findings')
    return 1 if findings else 0


if __name__ == '__main__':
    sys.exit(main())
