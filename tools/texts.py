#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The texts that people read, out of the sources, and their translations in po/.

usage: texts.py --list              the texts, one a line, as keys of the catalogues
       texts.py --check             exit status 1 lists what is missing, stale or damaged in po/LANGUAGE.po
       texts.py --json LANGUAGE     {text: translation}, as the operator's screen reads it
       texts.py --update LANGUAGE   rewrites po/LANGUAGE.po: keeps what fits, adds what is missing without a translation

A text is a string literal with more than one word in a folder of FOLDERS. What is put in at run time is {} in a key,
whether the source has fmt's {:.3f} or "a" + name + "b". Nothing in the sources marks a text: what is none stands below.
"""
import ast
import json
import pathlib
import re
import sys

FOLDERS = ('src/base/ini', 'src/base/options', 'src/runtime', 'src/messages/client', 'src/messages/mailbox', 'src/hal/core', 'src/hal/capi', 'src/hal/host',
           'src/hal/halcompile', 'src/hal/script', 'src/hal/tools', 'src/kinematics', 'src/gcode/syntax', 'src/gcode/interpreter', 'src/gcode/tools',
           'src/gcode/analysis/commands.cc', 'src/gcode/analysis/program_check.cc', 'src/gcode/analysis/time_estimate.cc', 'src/motion', 'src/machine/io', 'src/machine/journal', 'src/machine/commissioning', 'src/machine/task', 'src/machine/config',
           'src/machine/certificate', 'src/machine/tools', 'src/machine/assembly', 'src/clients/publish/assembly/link_section.cc', 'src/clients/publish/assembly/settings.cc', 'src/clients/publish/sparkplug', 'src/clients/publish/offers', 'src/clients/offers', 'src/clients/screen/files/offered_programs.cc', 'src/clients/shop',
           'src/clients/screen/access/remote_access.cc', 'src/clients/screen/assembly', 'src/clients/screen/facts/tabs.cc', 'src/clients/screen/files/filter.cc',
           'src/clients/screen/hal/dialog_facts.cc', 'src/clients/screen/hal/postgui.cc', 'src/clients/screen/path/path_readers.cc', 'programs', 'drivers/modbus', 'drivers/mesa/board/hm2_board.cc', 'drivers/mesa/ethernet/cycle_report.cc')
# Programs that print for other programs: people read only their help.
HELP_OF = ('programs/setup/var_command.cc', 'src/base/ini/inivalue.cc')
HELP = re.compile(r'usage: ')
# Standard output of HAL commands is for programs (docs/user/languages.md): what these calls of a session take, and tables, files and figures.
FOR_PROGRAMS = {'src/hal/script': ('info', 'data', 'note')}
TABLES = re.compile(r'HAL_LOCK_|^active/recycled|^HAL (memory|locking) status|^HAL components that died|^  current lock|^  used/total|^\{\}(Component Pins|Exported Functions|Loaded HAL Components|Realtime Threads|ID   |Owner |Type |     Period)'
                    r'|Aliases$|^Original Name$|^(\{\})?# (param|pin|real|unconn)|^#loadrt |^alias (pin|param) |^twopass:|^pass0:|^Sourcing |^found \{\}$|^loadusr \{\}$|^  \{\} \(process|^  \{\} (->|\[)|^digraph |^signal \{\}$|^HAL capture, '
                    r'|^(jitter|last|max|min|period|sdev) ns$|^outside of the bins|intervals by deviation|^\{\}: period|^deviation from the period|^no realtime: |^realtime priority and locked|^is (not )?running$|^the realtime process of instance .%s'
                    r'|^(comp|pin)\||^\[(\w+\|){2}|^SIGNAL bit|^(latency-|millwright-rt |millwright hal \w+ ).*\[options\]$|^millwright hal ?$|^millwright-rt: \{\}$|^loadusr -W|^\.comp, |^import ast|^( (?!and |of )[\w.-]+)+ $|^fnct_01|^. (of component|crashed)|^Complete names|%s|^NML channels are up|^millwright (nml|format|explain) (FILE|\[)|^millwright (nml|publish|shop): |^MTConnect agent of |^Shop page: |^Node Control/|^Device Control/|^Store/Dropped|^DEADBAND = |^millwright shop( \{\})?$|; charset=utf-8|^Content-Type: ')
# Statements for a database.
SQL = re.compile(r'^(BEGIN; |; )?(SELECT|INSERT INTO|WITH \w+ AS \(|SET \w+ = )')
# Texts of manual pages, reference pages and `explain`, and output that other programs read.
NOT_SHOWN = re.compile(r'/(test|bench|logger|canon)/|keys\.hh$|pin_tables\.hh$|motion/interface/parameters\.hh$|states_page\.cc$'
                       r'|codes/codes\.cc$|programs/run/summary\.cc$|programs/run/certificate_report\.cc$|programs/run/time_report\.cc$|programs/run/recorder\.cc$|programs/run/plot\.cc$'
                       r'|base/ini/ini(value|var|_strict|_escape|_script)\.cc$|programs/setup/var_command\.cc$|command_classes\.hh$|/kinematics/\w+\.hh$|machine/config/ini_keys\.cc$'
                       r'|/hal/capi/\w+\.cc$|halcompile/emit_(c|main|man)\.cc$|runtime/log\.cc$|reference_pages\.cc$|view/watch_model\.cc$')
# Clients search for these words (docs/reference/compatibility.md), canon comments are rs274's output, and the
# compiler reads the rest.
NEVER = re.compile(r'on limit switch error|^interpreter: |^each command is of one class$|^A machine is already running|^Machine configuration file is'
                   r'|^; life of tools|^# What was answered|^there is no module $|^the planner of a module$|^(exec|port) \{\}$|^millwright \w+ [^a-z]*(\.ini|\.ngc|options|help)|^\{\} \[options\]|^(un)?loadrt |^(addf|setp) \S+ \S+$|^net \S+ \S+ => |^echo |^-- -ini|^10? (in|mm), |^--connectpw and')
LANGUAGES = ('de', 'es')
TOKEN = re.compile(r'''//[^\n]*|/\*.*?\*/|R"(\w*)\((.*?)\)\1"|"((?:[^"\\\n]|\\.)*)"|'(?:[^'\\\n]|\\.)+'|->|\w+|\s+|.''', re.S)
ESCAPE = {'n': '\n', 't': '\t', '"': '"', '\\': '\\', "'": "'", 'r': '\r', '0': '\0', 'a': '\a'}
HOLE = re.compile(r'\{[^{}]*\}')


def tokens(source):
    source = re.sub(r'^[ \t]*#[ \t]*include[^\n]*|static_assert\([^;]*;', '', source, flags=re.M)
    for match in TOKEN.finditer(source):
        token = match.group()
        if token.isspace() or token.startswith(('//', '/*')):
            continue
        if match.group(3) is not None and token[0] == '"':
            yield '"', re.sub(r'\\(x[0-9a-fA-F]{1,2}|[0-7]{3}|.)', unescape, match.group(3))
        elif match.group(2) is not None:
            yield '"', match.group(2)
        else:
            yield token, None


def unescape(match):
    what = match.group(1)
    if what[0] == 'x':
        return chr(int(what[1:], 16))
    if len(what) == 3 and what.isdigit():
        return chr(int(what, 8))
    return ESCAPE.get(what, what)


def end_of_operand(seq, at):
    """The end of an added part of a text: the next + , ; or closing bracket of the same depth."""
    depth = 0
    while at < len(seq):
        token = seq[at][0]
        if token in '([{':
            depth += 1
        elif token in ')]}':
            if depth == 0:
                return at
            depth -= 1
        elif depth == 0 and token in ('+', ',', ';', '?', ':', '<', '>', '"') and not (token == ':' and near_colon(seq, at)):
            return at
        at += 1
    return at


def near_colon(seq, at):
    return seq[at - 1][0] == ':' or (at + 1 < len(seq) and seq[at + 1][0] == ':')


def whole_text(seq, at):
    """The text that begins at a literal, with the other literals that are parts of it."""
    parts = set()
    text = ('{}' if at > 0 and seq[at - 1][0] == '+' or (at > 1 and seq[at - 1][0] == '=' and seq[at - 2][0] == '+') else '') + seq[at][1]
    is_wrapped = at > 0 and seq[at - 1][0] == '('
    at += 1
    while at < len(seq):
        if seq[at][0] == '"':
            text += seq[at][1]
            parts.add(at)
            at += 1
        elif seq[at][0] == ')' and at + 1 < len(seq) and seq[at + 1][0] == '+' and is_wrapped:
            at += 1  # std::string("...") + name
        elif seq[at][0] == '+' and at + 1 < len(seq):
            if seq[at + 1][0] == '"':
                at += 1
                continue
            at = end_of_operand(seq, at + 1)
            text += '{}'
        else:
            break
    return text, parts


def key_of(text):
    """The text in the form of the catalogues: fmt's fields are {}, {{ is {."""
    text = text.replace('{{', '\1').replace('}}', '\2')
    text = re.sub(r'(\{\})+', '{}', HOLE.sub('{}', text)).replace('\033[K', '').strip('\r\n')
    return text.replace('\1', '{').replace('\2', '}')


def is_text(key):
    words = re.findall(r"[A-Za-z][a-z']+", HOLE.sub(' ', key))
    return (len(words) >= 2 and ' ' in key.strip() or re.fullmatch(r'[A-Za-z]{3,} \{\}|(an?|the) [a-z]{3,}', key)) and not re.fullmatch(r'[A-Z0-9_ {}:=.,*/\[\]-]+', key)


def texts(root):
    found = {}
    for folder in FOLDERS:
        place = root / folder
        for path in sorted(place.rglob('*')) if place.is_dir() else [place]:
            name = str(path.relative_to(root))
            if path.suffix not in ('.cc', '.hh') or NOT_SHOWN.search(name):
                continue
            seq, done = list(tokens(path.read_text())), set()
            calls = []
            for at, token in enumerate(seq):
                if token[0] in ('(', '{', '['):
                    calls.append(seq[at - 1][0] if at > 0 and token[0] == '(' else '')
                elif token[0] in (')', '}', ']') and calls:
                    calls.pop()
                if token[0] != '"' or at in done or any(call in FOR_PROGRAMS.get(folder, ()) for call in calls):
                    continue
                text, parts = whole_text(seq, at)
                done |= parts
                key = key_of(text)
                if is_text(key) and not any(pattern.search(key) for pattern in (NEVER, TABLES, SQL)):
                    found.setdefault(key, name)
    for name in HELP_OF:
        seq = list(tokens((root / name).read_text()))
        for at, (kind, text) in enumerate(seq):
            if kind == '"' and HELP.match(text):
                found.setdefault(key_of(whole_text(seq, at)[0]), name)
    found.setdefault('usage:', 'src/base/options/command_line.cc')
    found.update({word: 'src/base/diagnostics/sink.cc' for word in ('error', 'warning', 'note')})
    found.setdefault('called from {}', 'src/base/diagnostics/sink.cc')
    for kind in ('component', 'pin', 'parameter', 'signal', 'function', 'thread', 'alias'):
        for what in (f"there is no {kind} '{{}}'", f"there is {'an' if kind == 'alias' else 'a'} {kind} '{{}}' already", f"{kind} name '{{}}' has {{}} characters, 1 to {{}} are allowed"):
            found[what] = 'src/hal/core/detail/names.cc'
    # Texts of one word, or of words that programs read elsewhere.
    for what in ("program '{}' {}", "pin '{}'", 'TRUE, FALSE, 1 or 0', '0 to 5', 'Commands:', 'a {} takes {}'):
        found[what] = 'src/hal/script/commands.cc'
    # Composed without heap memory, because a signal handler does it.
    for what in ("function '{}' of component '{}' crashed in thread '{}'", "module '{}' crashed while it was loaded", "module '{}' crashed while it was unloaded", 'the planner of a module crashed'):
        found[what] = 'src/hal/core/crash_report.cc'
    for text, name in python_texts(root).items():
        found.setdefault(text, name)
    return found


def python_texts(root):
    """Help of programs in Python: arguments help and description, USAGE, OPTIONS and ARGPARSE, and docstrings that are shown."""
    found = {}
    for path in sorted([*(root / 'python/programs').iterdir(), *(root / 'python/millwright').glob('*.py')]):
        tree = ast.parse(path.read_text())
        nodes = [node.value for node in tree.body if isinstance(node, ast.Assign) and getattr(node.targets[0], 'id', '') in ('USAGE', 'OPTIONS', 'ARGPARSE')]
        for call in ast.walk(tree):
            if isinstance(call, ast.Call) and path.name != 'language.py':
                nodes += [given.value for given in call.keywords if given.arg in ('help', 'description')]
                nodes += call.args if getattr(call.func, 'id', '') == 'shown' else []
        for node in nodes:
            for part in ast.walk(node):
                text = ast.get_docstring(tree, clean=False) if getattr(part, 'id', '') == '__doc__' else getattr(part, 'value', None)
                if isinstance(text, str) and (is_text(text) or path.name == 'language.py'):
                    found.setdefault(text.strip(), str(path.relative_to(root)))
    return found


def quote(text):
    return '"' + text.replace('\\', '\\\\').replace('"', '\\"').replace('\n', '\\n').replace('\t', '\\t').replace('\033', '\\033').replace('\r', '\\r') + '"'


def read_po(path):
    """{key: translation} of a catalogue whose strings have one line each or continue in the next ones."""
    entries, key, into = {}, None, None
    for line in path.read_text().splitlines() if path.exists() else ():
        word = re.match(r'(msgid|msgstr)?\s*"(.*)"$', line)
        if word is None:
            continue
        text = re.sub(r'\\(033|.)', lambda m: '\033' if m.group(1) == '033' else unescape(m), word.group(2))
        if word.group(1) == 'msgid':
            key, into = text, 'key'
        elif word.group(1) == 'msgstr':
            entries[key], into = text, 'text'
        elif into == 'key':
            key += text
        else:
            entries[key] += text
    return entries


def write_po(path, language, found, entries):
    lines = ['# SPDX-License-Identifier: GPL-2.0-or-later', '# Made by tools/texts.py; the translations are written by hand.',
             'msgid ""', 'msgstr ""', '"Project-Id-Version: millwright\\n"', '"PO-Revision-Date: 2026-11-24 00:00+0000\\n"',
             '"Last-Translator: the authors of Millwright\\n"', f'"Language-Team: {language}\\n"', f'"Language: {language}\\n"', '"MIME-Version: 1.0\\n"',
             '"Content-Type: text/plain; charset=UTF-8\\n"', '"Content-Transfer-Encoding: 8bit\\n"']
    for key, name in sorted(found.items(), key=lambda item: (item[1], item[0])):
        lines += ['', f'#: {name}', 'msgid ' + quote(key), 'msgstr ' + quote(entries.get(key, ''))]
    path.write_text('\n'.join(lines) + '\n')


def holes_of(text):
    """The number of uses of each field; {} counts up."""
    found, count = [], 0
    for hole in re.findall(r'\{(\d*)\}', text):
        found.append(int(hole) if hole else count)
        count += not hole
    return found


def damaged(key, text):
    """The fault of a translation, or None."""
    if not text:
        return 'has no translation'
    asked = key.count('{}')
    if sorted(set(holes_of(text))) != list(range(asked)):
        return f'{asked} values are put into the text, other ones into its translation'
    for side in ('^\\s*', '\\s*$'):
        if re.search(side, key).group() != re.search(side, text).group():
            return 'blanks at its ends differ'
    lost = [word for word in re.findall(r'\[[A-Z0-9_]+\]\w*|--[a-z-]+|[a-z]+\.\w+\.[\w.-]+', HOLE.sub('', key)) if word not in text]
    return f'{lost[0]} is not in the translation' if lost else None


def check(root):
    found, problems = texts(root), []
    for language in LANGUAGES:
        entries = read_po(root / 'po' / f'{language}.po')
        entries.pop('', None)
        for key, name in found.items():
            problem = damaged(key, entries.get(key, ''))
            if problem is not None:
                problems.append(f'{name}: {language}: {problem}: {quote(key)}')
        problems += [f'po/{language}.po: no source has this text: {quote(key)}' for key in entries if key not in found]
    for problem in problems:
        print(problem)
    return 1 if problems or not found else 0


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    words = sys.argv[1:]
    if words == ['--list']:
        for key, name in sorted(texts(root).items(), key=lambda item: (item[1], item[0])):
            print(f'{name}\t{quote(key)}')
        return 0
    if words == ['--check']:
        return check(root)
    if len(words) == 2 and words[0] == '--json':
        entries = read_po(root / 'po' / f'{words[1]}.po')
        entries.pop('', None)
        json.dump({key: text for key, text in entries.items() if text}, sys.stdout, ensure_ascii=False, indent=0)
        return 0
    if len(words) == 2 and words[0] == '--update':
        path = root / 'po' / f'{words[1]}.po'
        write_po(path, words[1], texts(root), read_po(path))
        return 0
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == '__main__':
    sys.exit(main())
