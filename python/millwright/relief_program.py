# SPDX-License-Identifier: GPL-2.0-or-later
"""image-to-gcode: options and stored settings, pictures, and the lines of the program.

X0 Y0 is the centre of the lower left pixel, Z0 the top of the stock.
"""
import argparse
import json
import math
import os
import pathlib
import sys

from .language import Parser
from .whole_file import write_whole

NAME = 'image-to-gcode'
MM_PER_INCH = 25.4
MOST_PIXELS = 64_000_000
# (option, type or choices, default of LinuxCNC's program in inches, whether it is a length, help)
OPTIONS = (
    ('units', ('in', 'mm'), 'in', False, 'G20 or G21, and the unit of lengths here'),
    ('invert', bool, False, False, 'white is low, black is high'),
    ('normalize', bool, False, False, 'stretch the brightness: darkest pixel black, lightest pixel white'),
    ('expand', ('none', 'white', 'black'), 'none', False, 'add a border of the tool width around the image'),
    ('tolerance', float, 0.001, True, 'path tolerance: half for the lines, half for blending (G64)'),
    ('pixel-size', float, 0.006, True, 'distance between pixels'),
    ('feed', float, 12.0, True, 'feed rate, per minute'),
    ('plunge-feed', float, 12.0, True, 'plunge feed rate, per minute'),
    ('spindle', float, 1000.0, False, 'spindle speed, rpm'),
    ('pattern', ('rows', 'columns', 'rows-columns', 'columns-rows'), 'rows', False, 'scan pattern'),
    ('direction', ('positive', 'negative', 'alternating', 'up', 'down'), 'positive', False, 'scan direction; up: from low to high'),
    ('depth', float, 0.25, True, 'depth of the lowest pixel below the top of the stock'),
    ('step-over', int, 8, False, 'step-over between scans, in pixels'),
    ('tool-diameter', float, 0.0625, True, 'diameter of the cutting part'),
    ('safety-height', float, 0.012, True, 'height of moves above the top of the stock'),
    ('tool', ('ball', 'flat', 'vee30', 'vee45', 'vee60'), 'ball', False, 'tool shape; veeN: flanks at N degrees'),
    ('lace', ('none', 'secondary', 'full'), 'none', False, 'lace bounding: skip flat parts in the second direction; full: also steep parts in the first'),
    ('contact-angle', float, 45.0, False, 'minimum angle of steep parts for --lace, degrees'),
    ('roughing-offset', float, 0.0, True, 'roughing allowance above the surface (0: no roughing)'),
    ('roughing-depth', float, 0.25, True, 'depth of a roughing layer'),
)
ABOVE_ZERO = ('pixel-size', 'feed', 'plunge-feed', 'depth', 'step-over', 'tool-diameter', 'safety-height', 'roughing-depth')


class Wrong(Exception):
    """For the operator."""


def key_of(option):
    return option.replace('-', '_')


def defaults(units):
    return {key_of(option): value * MM_PER_INCH if length and units == 'mm' else value for option, _, value, length, _ in OPTIONS}


def settings_path():
    base = os.environ.get('XDG_CONFIG_HOME') or os.path.join(os.path.expanduser('~'), '.config')
    return pathlib.Path(base, 'millwright', 'image-to-gcode.json')


def remembered(path):
    """The settings stored in the file; {} if it does not exist."""
    try:
        kept = json.loads(path.read_text())
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise Wrong(f'{path}: {error}; --forget leaves it aside') from None
    kinds = {key_of(option): kind for option, kind, *_ in OPTIONS}
    for key, value in kept.items() if isinstance(kept, dict) else [('', kept)]:
        kind = kinds.get(key)
        good = value in kind if isinstance(kind, tuple) else isinstance(value, kind) if kind in (bool, int) else (
            kind is float and isinstance(value, (int, float)) and not isinstance(value, bool))
        if not good or (kind is int and isinstance(value, bool)):
            raise Wrong(f'{path}: "{key}": {json.dumps(value)} is no setting; --forget leaves it aside')
    return kept


def remember(path, settings):
    """Writes the file completely or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, json.dumps({key_of(option): getattr(settings, key_of(option)) for option, *_ in OPTIONS}, indent=1) + '\n')


def parse(words):
    parser = Parser(prog=NAME, description='Converts an image into a milling program. The brightness of a pixel is its height.')
    parser.add_argument('image', metavar='IMAGE', help='PNG, GIF, JPEG or another that Pillow reads')
    for option, kind, _, _, words_of_help in OPTIONS:
        if kind is bool:
            parser.add_argument(f'--{option}', action=argparse.BooleanOptionalAction, default=None, help=words_of_help)
        elif isinstance(kind, tuple):
            parser.add_argument(f'--{option}', choices=kind, help=words_of_help)
        else:
            parser.add_argument(f'--{option}', type=kind, metavar='N', help=words_of_help)
    parser.add_argument('--remember', action='store_true', help='remember these settings for later calls')
    parser.add_argument('--forget', action='store_true', help='ignore the remembered settings')
    parser.add_argument('-o', '--output', metavar='FILE', help='output file (default: standard output)')
    return parser.parse_args(words)


def complete(given):
    """All settings: options, then stored settings, then defaults."""
    kept = {} if given.forget else remembered(settings_path())
    units = given.units or kept.get('units') or 'in'
    if kept.get('units', units) != units:
        scale = MM_PER_INCH if units == 'mm' else 1 / MM_PER_INCH
        lengths = {key_of(option) for option, _, _, length, _ in OPTIONS if length}
        kept = {key: value * scale if key in lengths else value for key, value in kept.items()}
    chosen = {**defaults(units), **kept, **{key: value for key, value in vars(given).items() if value is not None}, 'units': units}
    settings = argparse.Namespace(**chosen, from_memory=bool(kept))
    for option, kind, *_ in OPTIONS:
        value = getattr(settings, key_of(option))
        if kind in (float, int) and (not math.isfinite(value) or value < 0 or (value == 0 and option in ABOVE_ZERO)):
            raise Wrong(f'--{option} {value}: a number above zero is needed')
    if not 0 < settings.contact_angle < 90:
        raise Wrong(f'--contact-angle {settings.contact_angle}: between 0 and 90 degrees')
    return settings


def read_heights(np, settings):
    """(heights, pixels of the border)."""
    from PIL import Image
    Image.MAX_IMAGE_PIXELS = MOST_PIXELS
    try:
        with Image.open(settings.image) as picture:
            if picture.width * picture.height > MOST_PIXELS:
                raise Wrong(f'{settings.image}: {picture.width} x {picture.height} pixels are more than {MOST_PIXELS}')
            if 'A' in picture.getbands() or 'transparency' in picture.info:
                say(f'{settings.image}: what is transparent is taken by its colour')
            deep = picture.mode.startswith('I')
            gray = np.asarray(picture.convert('I') if deep else picture.convert('L'), dtype=float) / (65535.0 if deep else 255.0)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise Wrong(f'{settings.image}: {getattr(error, "strerror", None) or error}') from None
    gray = np.clip(gray[::-1], 0.0, 1.0)
    if settings.normalize:
        low, high = gray.min(), gray.max()
        if low == high:
            raise Wrong(f'{settings.image}: all pixels are the same, which --normalize cannot spread')
        gray = (gray - low) / (high - low)
    border = 0
    if settings.expand != 'none':
        border = math.ceil(settings.tool_diameter / settings.pixel_size)
        gray = np.pad(gray, border, constant_values=1.0 if settings.expand == 'white' else 0.0)
    if settings.invert:
        gray = 1.0 - gray
    if min(gray.shape) < 2:
        raise Wrong(f'{settings.image}: a picture of at least 2 x 2 pixels is needed')
    return (gray - 1.0) * settings.depth, border


class Program:
    """Writes lines of G-code; omits unchanged words."""

    def __init__(self, settings):
        self.set, self.lines, self.digits = settings, [], 5 if settings.units == 'in' else 4
        self.now = {}

    def number(self, value):
        text = f'{value:.{self.digits}f}'
        return text[1:] if text.startswith('-') and not float(text) else text

    def move(self, code, feed=None, **to):
        words = [(letter, self.number(to[letter])) for letter in 'XYZ' if letter in to]
        words = [letter + text for letter, text in words if self.now.get(letter) != text]
        if not words:
            return
        if feed is not None and self.now.get('F') != feed:
            words.append(f'F{self.number(feed)}')
            self.now['F'] = feed
        self.now.update({word[0]: word[1:] for word in words if word[0] in 'XYZ'})
        if self.now.get('G') != code:
            words.insert(0, code)
            self.now['G'] = code
        self.lines.append(' '.join(words))

    def begin(self):
        one = self.set
        shown = ' '.join(f'{option}={getattr(one, key_of(option))}' for option, *_ in OPTIONS)
        # Parentheses would end the comment.
        name = ''.join(char if char.isprintable() and char not in '()' else '_' for char in os.path.basename(one.image))
        self.lines += [f'({NAME}: {name})', *(f'({line})' for line in wrap(shown)), 'G20' if one.units == 'in' else 'G21', 'G17 G40 G80 G90 G94',
                       f'G64 P{self.number(one.tolerance / 2)}' if float(self.number(one.tolerance / 2)) else 'G61']
        self.move('G0', Z=one.safety_height)
        self.lines += [f'S{one.spindle:g} M3', 'G4 P3']

    def cut(self, axis, row_units, points, over):
        """One run of points. over: height of the approach from the previous position; None: the safety height."""
        def at(place):
            return {'X': place, 'Y': row_units} if axis == 0 else {'X': row_units, 'Y': place}
        one = self.set
        if over is None:
            self.move('G0', Z=one.safety_height)
            self.move('G0', **at(points[0][0]))
        else:
            self.move('G1', one.feed, Z=over)
            self.move('G1', one.feed, **at(points[0][0]))
        self.move('G1', one.plunge_feed, Z=points[0][1])
        for place, z in points[1:]:
            self.move('G1', one.feed, Z=z, **at(place))

    def end(self):
        self.move('G0', Z=self.set.safety_height)
        self.lines += ['M5', 'M2']


def wrap(text, width=100):
    lines = ['']
    for word in text.split():
        if lines[-1] and len(lines[-1]) + len(word) + 1 > width:
            lines.append('')
        lines[-1] += (' ' if lines[-1] else '') + word
    return lines


def levels(settings):
    """(lower limit, distance above the surface) of each pass: layers of roughing, then the surface."""
    if settings.roughing_offset <= 0:
        return [(-math.inf, 0.0)]
    count = math.ceil(settings.depth / settings.roughing_depth - 1e-9)
    return [(-settings.roughing_depth * (n + 1), settings.roughing_offset) for n in range(count)] + [(-math.inf, 0.0)]


def mill(np, heights, settings, border, progress):
    from .relief import Relief
    relief, program = Relief(np, heights, settings, border, progress), Program(settings)
    program.begin()
    for floor, raised in levels(settings):
        for order, axis in enumerate(relief.passes()):
            last = None  # row and position of the tool in the stock
            for row, points in relief.cuts(order, axis, floor, raised):
                if raised and all(z >= 0 for _, z in points):
                    continue  # above the stock
                over = None
                if last and settings.direction == 'alternating' and abs(row - last[0]) <= settings.step_over and abs(last[1] - points[0][0]) < 1e-9:
                    over = max(relief.over(axis, last[0], row, points[0][0]) + raised, last[2], points[0][1], floor)
                program.cut(axis, (row - border) * settings.pixel_size, points, over if over is None or over < settings.safety_height else None)
                last = row, *points[-1]
    program.end()
    return program.lines


def say(text):
    print(f'{NAME}: {text}', file=sys.stderr, flush=True)


def main(words):
    given = parse(words)
    try:
        import numpy as np
        import PIL  # noqa: F401
    except ImportError as error:
        say(f'the Python package {error.name} is missing: install python3-pil and python3-numpy')
        return 1
    shown = [-1]

    def progress(part):
        percent = int(part * 100)
        if percent != shown[0]:
            shown[0] = percent
            print(f'FILTER_PROGRESS={percent}', file=sys.stderr, flush=True)
    try:
        settings = complete(given)
        heights, border = read_heights(np, settings)
        if settings.step_over * settings.pixel_size > settings.tool_diameter:
            say(f'scans are {settings.step_over * settings.pixel_size:g} {settings.units} apart, more than the tool is wide: stock stays between them')
        if settings.from_memory:
            say(f'settings of {settings_path()}')
        lines = mill(np, heights, settings, border, progress)
        if given.remember:
            remember(settings_path(), settings)
        text = '\n'.join(lines) + '\n'
        if given.output:
            write_whole(pathlib.Path(given.output), text)
        else:
            sys.stdout.write(text)
            sys.stdout.flush()
    except Wrong as error:
        say(str(error))
        return 1
    except OSError as error:
        say(f'{error.filename or "output"}: {error.strerror}')
        return 1
    return 0
