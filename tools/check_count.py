#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that the README states the number of components in the tree. usage: check_count.py README COUNT"""
import pathlib
import re
import sys


def main():
    page, count = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    named = [int(number) for number in re.findall(r'^\| components \| (\d+) components;', page.read_text(), re.MULTILINE)]
    if named == [count]:
        return 0
    print(f'{page}: the line "| components | N components;" says {named}, but the build makes {count} component modules')
    return 1


if __name__ == '__main__':
    sys.exit(main())
