# SPDX-License-Identifier: GPL-2.0-or-later
"""Converts INI files from before joints and axes (version 1.1), and the HAL files that they name.

The names are described in LinuxCNC's manual "Updating LinuxCNC". Lines that need no change are kept, with comments and order.
"""
import os
import pathlib
import re
import shutil
import sys

from .language import shown
from .whole_file import write_whole

LETTERS = 'XYZABCUVW'
VERSION = '1.1'
TRAJ_NAMES = {
    'MAX_VELOCITY': 'MAX_LINEAR_VELOCITY', 'DEFAULT_VELOCITY': 'DEFAULT_LINEAR_VELOCITY',
    'MAX_ACCELERATION': 'MAX_LINEAR_ACCELERATION', 'DEFAULT_ACCELERATION': 'DEFAULT_LINEAR_ACCELERATION',
    'MAX_LINEAR_ACCEL': 'MAX_LINEAR_ACCELERATION', 'DEFAULT_LINEAR_ACCEL': 'DEFAULT_LINEAR_ACCELERATION',
}
# Keys of an axis in the new form; a joint keeps them too.
AXIS_KEYS = ('MIN_LIMIT', 'MAX_LIMIT', 'MAX_VELOCITY', 'MAX_ACCELERATION')
PLAIN_KINEMATICS = ('trivkins', 'gentrivkins', 'gantrykins')
USAGE = """usage: update_ini [-f] [-d] MACHINE.ini

Converts an INI file from before LinuxCNC 2.8, and the HAL files that it names, to joints and axes.

  -d  ask before anything is changed
  -f  keep no copies of the old files

exit status: 0 done, or nothing to do; 1 failed; 2 wrong usage; 42 cancelled by the user
"""


class Refused(Exception):
    """Reason why the files are not changed."""


class Setting:
    """A line KEY = VALUE of an INI file."""
    form = re.compile(r'(\s*)([A-Za-z_][\w.]*)(\s*=\s*)(.*?)(\s*)$')

    def __init__(self, line):
        found = self.form.match(line)
        self.key = found[2] if found else None
        self.value = found[4] if found else None

    def number(self):
        """The value without a trailing comment; None if it is not a number."""
        try:
            return float(re.split(r'\s*[#;]', self.value)[0])
        except (TypeError, ValueError):
            return None


def sections_of(lines):
    """[(name or None, [line, ...])]: lines before the first section have no name."""
    sections = [(None, [])]
    for line in lines:
        head = re.match(r'\s*\[(\w+)\]', line)
        if head:
            sections.append((head[1], [line]))
        else:
            sections[-1][1].append(line)
    return sections


def values_of(lines):
    values = {}
    section = None
    for line in lines:
        head = re.match(r'\s*\[(\w+)\]', line)
        if head:
            section = head[1]
            continue
        setting = Setting(line)
        if setting.key and not line.lstrip().startswith(('#', ';')):
            values.setdefault((section, setting.key), []).append(setting.value)
    return values


class Machine:
    """The joint that each numbered axis of the old file becomes, and the letter that it moves."""

    def __init__(self, values, hal_text):
        coordinates = ''.join(values.get(('TRAJ', 'COORDINATES'), ['XYZ'])[0].split('#')[0].split()).upper()
        sections = {section for section, _ in values}
        self.numbers = sorted(int(name[5:]) for name in sections if name and re.fullmatch(r'AXIS_\d', name))
        if not self.numbers:
            raise Refused('there is no section [AXIS_0], [AXIS_1] ...: this is no file of the old form')
        loaded = re.search(r'^\s*loadrt\s+(\w*kins\w*)([^\n#]*)', hal_text, re.M)
        self.kinematics = loaded[1] if loaded else 'trivkins'
        self.advice = []
        words = loaded[2].split() if loaded else []
        letters = next((word.split('=', 1)[1].upper() for word in words if word.lower().startswith('coordinates=')), '')
        if self.kinematics not in PLAIN_KINEMATICS:
            # The axes of a robot's joints are not known: the numbers are kept.
            self.joint_of = {number: number for number in self.numbers}
            self.letter_of = {number: LETTERS[number] for number in self.numbers if LETTERS[number] in coordinates}
            self.words = ' '.join([self.kinematics, *words])
            self.advice.append(f'{self.kinematics}: check the limits of [AXIS_*]: they are limits of the axes now, not of the joints')
        elif letters:
            self.joint_of = {number: number for number in self.numbers}
            self.letter_of = {number: letters[number] for number in self.numbers if number < len(letters)}
            both = ' kinstype=BOTH' if self.kinematics == 'gantrykins' or len(set(letters)) < len(letters) else ''
            self.words = f'trivkins coordinates={letters}{both}'
        else:
            self.letter_of = {number: LETTERS[number] for number in self.numbers}
            self.joint_of = {number: joint for joint, number in enumerate(self.numbers)}
            order = ''.join(self.letter_of[number] for number in self.numbers)
            self.words = 'trivkins' if order == LETTERS[:len(order)] else f'trivkins coordinates={order}'
            unused = [letter for letter in order if letter not in coordinates]
            if unused:
                self.words = f'trivkins coordinates={order}'
                self.advice.append(f'axis {", ".join(unused)} has a joint, and [TRAJ]COORDINATES does not name it: home that '
                                   'joint too, or take it out of [KINS] and the HAL files')
        if len(set(letters)) < len(letters):
            self.advice.append('two joints move one axis: give both the same negative HOME_SEQUENCE')
        self.joints = len(self.numbers)


def new_ini(lines, machine):
    sections = sections_of(lines)
    names = [name for name, _ in sections]
    out = []
    done_letters = set(names)
    for name, body in sections:
        number = re.fullmatch(r'AXIS_(\d)', name or '')
        if name == 'EMC':
            out += new_version(body)
        elif name == 'TRAJ':
            out += new_traj(body)
            if 'KINS' not in names:
                out += ['[KINS]', f'KINEMATICS = {machine.words}', f'JOINTS = {machine.joints}', '']
        elif number:
            out += new_axis(body, int(number[1]), machine, done_letters)
        else:
            out += body
    if 'EMC' not in names:
        out = ['[EMC]', f'VERSION = {VERSION}', ''] + out
    return out


def new_version(body):
    kept = [line for line in body if Setting(line).key != 'VERSION' or line.lstrip().startswith('#')]
    return [kept[0], f'VERSION = {VERSION}', *kept[1:]]


def new_traj(body):
    out = []
    for line in body:
        setting = Setting(line)
        if line.lstrip().startswith(('#', ';')) or setting.key is None:
            out.append(line)
        elif setting.key == 'AXES':
            continue  # [KINS]JOINTS
        else:
            out += plain(line.replace(setting.key, TRAJ_NAMES.get(setting.key, setting.key), 1))
    return out


def plain(line):
    """A comment after a number gets a separate line."""
    setting = Setting(line)
    parts = re.split(r'\s*([#;].*)', setting.value or '', maxsplit=1)
    if len(parts) < 3 or setting.number() is None:
        return [line]
    return [parts[1], line[:line.index(parts[1])].rstrip()]


def new_axis(body, number, machine, done_letters):
    """[JOINT_m] with all settings, after [AXIS_l] with those of the axis."""
    joint = [f'[JOINT_{machine.joint_of[number]}]']
    axis = {}
    for line in body[1:]:
        setting = Setting(line)
        isComment = line.lstrip().startswith(('#', ';'))
        if not isComment and setting.key == 'HOME_SEQUENCE' and setting.number() == -1:
            continue  # means "none" no longer
        joint += [line] if isComment or setting.key is None else plain(line)
        if not isComment and setting.key in AXIS_KEYS:
            axis.setdefault(setting.key, re.split(r'\s*[#;]', setting.value)[0])
    letter = machine.letter_of.get(number)
    section = f'AXIS_{letter}'
    if letter is None or section in done_letters:
        return joint
    done_letters.add(section)
    return [f'[{section}]', *(f'{key} = {axis[key]}' for key in AXIS_KEYS if key in axis), '', *joint]


JOG_PIN = re.compile(r'\baxis\.(\d)\.(jog-(?:enable|scale|counts|vel-mode|accel-fraction))\b')


def new_hal_line(line, machine):
    """The lines that replace a line of a HAL file."""
    code, hash_sign, comment = line.partition('#')
    joint = lambda number: str(machine.joint_of.get(int(number), int(number)))
    code = re.sub(r'\bloadrt\s+(?:%s)\b.*' % '|'.join(PLAIN_KINEMATICS), 'loadrt [KINS]KINEMATICS', code)
    code = code.replace('[TRAJ]AXES', '[KINS]JOINTS').replace('[TRAJ](AXES)', '[KINS](JOINTS)')
    for old, new in TRAJ_NAMES.items():
        code = re.sub(r'\[TRAJ\]\(?%s\b\)?' % old, f'[TRAJ]{new}', code)
    code = re.sub(r'\[AXIS_(\d)\]', lambda found: f'[JOINT_{joint(found[1])}]', code)
    more = []
    jog = JOG_PIN.search(code)
    letter = machine.letter_of.get(int(jog[1])) if jog else None
    if jog and letter:
        # A wheel moves the joint before homing and the axis after it.
        pin = f'axis.{letter.lower()}.{jog[2]}'
        if code.split()[0] == 'net':
            code = code.rstrip() + f' {pin}' + (' ' if hash_sign else '')
        elif code.split()[0] == 'setp':
            more = [JOG_PIN.sub(pin, code).rstrip()]
        else:
            machine.advice.append(f'wheels also need the pin {pin}')
    code = re.sub(r'\baxis\.(\d)\.', lambda found: f'joint.{joint(found[1])}.', code)
    code = re.sub(r'\bmotion\.spindle-', 'spindle.0.', code)
    code = re.sub(r'\bhalui\.spindle\.(?!\d)', 'halui.spindle.0.', code)
    code = re.sub(r'\bhalui\.spindle-override\.', 'halui.spindle.0.override.', code)
    code = re.sub(r'\bhalui\.jog-(speed|deadband)\b', r'halui.joint.jog-\1', code)
    code = re.sub(r'\bhalui\.jog\.(\d|selected)\.', lambda found: f'halui.joint.{found[1] if found[1] == "selected" else joint(found[1])}.', code)
    code = code.replace('halui.joint.selected.is_homed', 'halui.joint.selected.is-homed')
    code = code.replace('halui.joint.selected.on-soft-limit', 'halui.joint.selected.on-soft-min-limit')
    return [code + hash_sign + comment, *more]


def hal_files(ini, values, advice):
    """HAL files of the configuration's own folder; lines that cannot be converted are reported."""
    files = []
    for key in ('HALFILE', 'POSTGUI_HALFILE', 'SHUTDOWN'):
        for value in values.get(('HAL', key), []):
            name = value.split()[0] if value.split() else ''
            path = ini.parent / name
            if name.endswith('.tcl'):
                advice.append(f'{name} is a program: change its pins and sections by hand')
            elif name and not name.startswith('LIB:') and path.is_file() and path not in files:
                files.append(path)
    return files


def read(path):
    return path.read_text(encoding='utf-8', errors='surrogateescape')


def isOld(values):
    version = values.get(('EMC', 'VERSION'), [''])[0].split('#')[0].strip()
    try:
        return float(version) < float(VERSION)
    except ValueError:
        return True


def update(ini, isKept):
    lines = read(ini).splitlines()
    values = values_of(lines)
    advice = []
    files = hal_files(ini, values, advice)
    texts = {path: read(path) for path in files}
    machine = Machine(values, '\n'.join(texts.values()))
    changed = {path: '\n'.join(line for old in text.splitlines() for line in new_hal_line(old, machine)) + '\n'
               for path, text in texts.items()}
    changed[ini] = '\n'.join(new_ini(lines, machine)) + '\n'  # written last, because its version shows that the conversion is complete
    if isKept:
        keep = ini.with_suffix('.old')
        if keep.exists():
            raise Refused(f'{keep} is there already: files as they were would be lost')
        keep.mkdir()
        for path in changed:
            place = keep / os.path.relpath(path, ini.parent)
            if place.resolve().is_relative_to(keep.resolve()):
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, place)
            else:
                raise Refused(f'{path} is not in the folder of the INI file')
        print(f'as they were: {keep}')
    for path, text in changed.items():
        write_whole(path, text, 'surrogateescape')
        print(f'changed: {path}')
    for text in [*advice, *machine.advice]:
        print(f'check: {text}')


def main(words):
    options = [word for word in words if word in ('-d', '-f')]
    rest = [word for word in words if word not in ('-d', '-f')]
    if rest in (['-h'], ['--help']):
        print(shown(USAGE), end='')
        return 0
    if len(rest) != 1 or rest[0].startswith('-'):
        print(shown(USAGE), end='', file=sys.stderr)
        return 2
    ini = pathlib.Path(rest[0]).absolute()
    try:
        if not isOld(values_of(read(ini).splitlines())):
            print(f'{ini} has version {VERSION} already')
            return 0
        if '-d' in options:
            print(f'{ini} is of before joints and axes. Change it and its HAL files? [y/N] ', end='', flush=True)
            if not sys.stdin.readline().strip().lower().startswith('y'):
                return 42
        update(ini, '-f' not in options)
    except (OSError, Refused) as error:
        print(f'update_ini: {error}', file=sys.stderr)
        return 1
    return 0
