# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that the files of a machine are complete: each has its old or its new content."""
import re

VALUE = re.compile(r'^\d+\t-?\d+\.\d+$')
DIAMETER = re.compile(r'(?<=^T5 P5 D)[0-9.]+', re.MULTILINE)
G59_X = '5321'


def of_parameters(path, first, known):
    """Checks that the text has all numbers of the beginning, and that G59 has one of the known values."""
    if not path.is_file():
        return [f'file: {path.name} is no file any more']
    text = path.read_text()
    lines = text.splitlines()
    if not text.endswith('\n') or not all(VALUE.match(line) for line in lines):
        return [f'file: {path.name} is cut: {len(text)} bytes, ends with {text[-40:]!r}']
    values = dict(line.split('\t') for line in lines)
    lacking = first - set(values)
    if lacking:
        return [f'file: {path.name} lacks {len(lacking)} parameters, as {min(lacking)}']
    if not any(abs(float(values[G59_X]) - value) < 1e-5 for value in known):
        return [f'file: {path.name} has G59 X{values[G59_X]}, neither the old nor the new value of {sorted(known)}']
    return []


def of_tools(path, first, known):
    """Checks that all lines are unchanged; the diameter of T5 is one of the known values."""
    if not path.is_file():
        return [f'file: {path.name} is no file any more']
    text = path.read_text()
    plain = tool_words(text)
    if plain != tool_words(first):
        return [f'file: {path.name} is neither old nor new: {len(text)} bytes, ends with {text[-40:]!r}']
    value = diameter(text)
    if not any(abs(value - one) < 1e-5 for one in known):
        return [f'file: {path.name} has T5 D{value}, neither the old nor the new value of {sorted(known)}']
    return []


def since(known, seen):
    """Values that a file may have at the next check: the current one, and all that were set after it. A run may have been unable
    to write its value, but the file never has an older one."""
    last = max((at for at, value in enumerate(known) if abs(value - seen) < 1e-5), default=0)
    return known[last:]


def offset_of(path):
    """G59 X of a complete parameter file."""
    return float(dict(line.split('\t') for line in path.read_text().splitlines())[G59_X])


def diameter(text):
    found = re.search(r'^T5 .*?D\+?([0-9.]+)', text, re.MULTILINE)
    return float(found.group(1)) if found else float('nan')


def tool_words(text):
    """{tool: its words as numbers}, without the diameter of T5."""
    found = {}
    for line in text.splitlines():
        words = {word[0]: float(word[1:]) for word in line.split(';')[0].split()}
        if words.get('T') == 5:
            words.pop('D', None)
        found[words.get('T')] = (tuple(sorted(words.items())), line.partition(';')[2].strip())
    return found
