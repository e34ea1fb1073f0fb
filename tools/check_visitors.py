#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that no visitor over a closed variant has a default. usage: check_visitors.py ROOT; exit status 1 lists them.

An overload for `auto` among other overloads silently accepts alternatives that are added to the variant later. A single generic
lambda, which treats all alternatives equally, and a constrained one (`const OneOf<A, B> auto &`) are permitted.
"""
import pathlib
import re
import subprocess
import sys

OVERLOADS = re.compile(r'\b[Oo]verloaded\s*\{')
DEFAULT = re.compile(r'\[[^\[\]]*\]\s*(?:<[^<>]*>\s*)?\(\s*(?:const\s+)?auto\b|\(\s*\.\.\.\s*\)')


def block_from(text, start):
    """The text between the brace at `start` and its closing brace."""
    depth = 0
    for i in range(start, len(text)):
        depth += {'{': 1, '}': -1}.get(text[i], 0)
        if depth == 0:
            return text[start + 1:i]
    return text[start + 1:]


def main():
    root = pathlib.Path(sys.argv[1])
    names = subprocess.run(['git', '-C', str(root), 'ls-files', '-co', '--exclude-standard', '*.cc', '*.hh'], capture_output=True,
                           text=True, check=True).stdout.split()
    found = checked = 0
    for name in names:
        path = root / name
        if not path.is_file():
            continue
        text = re.sub(r'//[^\n]*', '', path.read_text())
        for match in OVERLOADS.finditer(text):
            checked += 1
            block = block_from(text, match.end() - 1)
            default = DEFAULT.search(block)
            if default:
                found += 1
                line = text.count('\n', 0, match.end() + default.start()) + 1
                print(f'{name}:{line}: this visitor takes what no other overload does: name the alternatives')
    print(f'{checked} visitors checked, {found} with a default')
    return 1 if found or checked == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
