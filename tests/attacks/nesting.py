#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests each program that reads files with ten megabytes of each nesting construct and 1 GB of memory: an error with file and
line.

usage: nesting.py BIN_FOLDER [NAME...]   NAME: only these cases
"""
import concurrent.futures
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

N = 10_000_000
MEMORY = 1_000_000 * 1024   # ulimit -v 1000000
CASE_S = 20
OUTPUT_BYTES = 20_000       # limit of the output that a person sees for such a file
LINE = 900_000              # below the longest line of G-code, so that the expression itself is read


def counted(line, count):
    """Each line with a different number."""
    return ''.join(line.replace('@', str(i)) for i in range(1, count))


EXPRESSIONS = {
    'brackets': lambda n: '#1=' + '[' * (n // 2) + '1' + ']' * (n // 2),
    'operators': lambda n: '#1=[1' + '+1' * (n // 2) + ']',
    'powers': lambda n: '#1=[2' + '**2' * (n // 3) + ']',
    'minus': lambda n: '#1=[' + '-' * n + '1]',
    'hashes': lambda n: '#' * n + '1=1',
    'functions': lambda n: '#1=' + 'ABS[' * (n // 5) + '1' + ']' * (n // 5),
    'name': lambda n: '#<' * (n // 2) + 'a>=1',
    'arguments': lambda n: 'o1 call ' + '[1] ' * (n // 4),
    'comment': lambda n: '(' * n,
    'words': lambda n: 'X1 ' * (n // 3),
    'number': lambda n: 'G1 X' + '1' * n + 'z',
    'letters': lambda n: 'o<' + 'a' * n + '> call',
    'message': lambda n: '(debug,' + '#<a>' * (n // 4) + ') G9999',
}

PROGRAMS = {
    'if': counted('o@ if [0]\n', 600_000),
    'if_true': counted('o@ if [1]\n', 600_000) + 'G9999\n',
    'elseif': 'o1 if [0]\n' + 'o1 elseif [0]\n' * 700_000,
    'while': counted('o@ while [1]\n', 500_000),
    'do': counted('o@ do\n', 700_000),
    'repeat': counted('o@ repeat [2]\n', 500_000),
    'sub': counted('o@ sub\n', 700_000),
    'call': 'o1 sub\no1 call\no1 endsub\n' + 'o1 call\n' * 1_000_000 + 'M2\n',
    'call_in_turns': 'o1 sub\no2 call\no1 endsub\no2 sub\no1 call\no2 endsub\n' + 'o1 call\n' * 1_000_000 + 'M2\n',
    'm98': 'M98 P1\n' * 1_400_000 + 'O1\nM98 P1\nM99\n',
    'named': counted('#<_name_@>=1\n', 600_000) + 'G9999\n',
    'lines': 'G9999\n' * (N // 6),
}

COMPONENT = 'component {0} "x";license "GPL";pin in bit a{1};function _;\n;;\n{2}\n'
COMPONENTS = {
    'parens': ('', 'FUNCTION(_){ x = ' + '(' * (N // 2) + '1' + ')' * (N // 2) + ';'),
    'braces': ('', 'FUNCTION(_)' + '{' * N),
    'if': (' if ' + '(' * (N // 2) + '1' + ')' * (N // 2), 'FUNCTION(_){}'),
    'default': ('=' + '(' * (N // 2) + '1' + ')' * (N // 2), 'FUNCTION(_){}'),
    'name': ('x' * N, 'FUNCTION(_){}'),
    'text': (' "' + 'x' * N, 'FUNCTION(_){}'),
    'signs': ('', 'FUNCTION(_){ x = ' + '-' * N + '1; }'),
    'declarations': (';bad' * (N // 4), 'FUNCTION(_){}'),
    'pins': (''.join(f';pin in bit a{i}' for i in range(500_000)) + ';pin in bot b', 'FUNCTION(_){}'),
}

HAL = {
    'brackets': 'setp a ' + '[' * N + '\n',
    'sections': 'setp a ' + '[A' * (N // 2) + ']' * (N // 2) + '\n',
    'dollars': 'setp a ' + '$(' * (N // 2) + '\n',
    'quote': 'setp a "' + 'x' * N + '\n',
    'words': 'setp ' + 'a ' * (N // 2) + '\n',
    'continued': 'setp \\\n' * (N // 7),
    'source': 'source {file}\n',
    'lines': 'setp a\n' * (N // 7),
}

INI = {
    'include': '#INCLUDE {file}\n',
    'section': '[' * N + '\n',
    'sections': '[A\n' * (N // 3),
    'value': '[A]\nB = ' + 'x' * N + '\n',
    'continued': '[A]\nB = \\\n' + 'x \\\n' * (N // 4),
    'keys': '[A]\n' + '= b\n' * (N // 4),
}

TOOLS = {
    'word': 'T1 P1 D' + '1' * N + 'x\n',
    'words': 'T1 P1 ' + 'D1 ' * (N // 3) + '\n',
    'lines': 'T1 Px\n' * (N // 6),
}
PARAMETERS = {'word': '5161 ' + '1' * N + 'x\n', 'lines': '5161 x\n' * (N // 7)}
PYTHON = {
    'parens': ';py,x=' + '(' * LINE,
    'minus': ';py,x=' + '-' * LINE + '1',
    'lists': ';py,x=' + '[' * LINE,
    'powers': ';py,x=1' + '**1' * (LINE // 3),
    'attributes': ';py,x=a' + '.a' * (LINE // 2),
    'lambdas': ';py,x=' + 'lambda:' * (LINE // 7),
}
TCL = {
    'brackets': 'set a ' + '[' * N + '\n',
    'closed': 'set a ' + '[set b ' * (N // 8) + '1' + ']' * (N // 8) + '\n',
    'braces': 'set a ' + '{' * N + '\n',
    'expressions': 'set a [expr ' + '(' * (N // 2) + '1' + ')' * (N // 2) + ']\nnot_a_command\n',
    'minus': 'set a [expr ' + '-' * N + '1]\nnot_a_command\n',
    'variables': 'set a ' + '$a(' * (N // 3) + '\n',
    'source': 'source {file}\n',
    'calls': 'proc a {} { a }\na\n',
}


def cases(programs):
    """(name, file name, contents, command, position of the error): `command` receives the file."""
    rs274 = [programs / 'rs274', '-g']
    for name, make in EXPRESSIONS.items():
        yield f'rs274.{name}.long', 'a.ngc', make(N) + '\nM2\n', rs274, r'a\.ngc:1\b'
        yield f'rs274.{name}', 'a.ngc', ('(first)\n' + make(LINE) + '\n') + 'G9999\nM2\n', rs274, r'a\.ngc:[23]\b'
    for name, text in PROGRAMS.items():
        yield f'rs274.{name}', 'a.ngc', text, rs274, r'a\.ngc:\d+'
    for name, text in PYTHON.items():
        yield f'python.{name}', 'a.ngc', '(first)\n' + text + '\nM2\n', [programs / 'rs274', '-i', '../python.ini', '-g'], r'a\.ngc:2\b'
    for name, text in TOOLS.items():
        yield f'tools.{name}', 'a.tbl', text, [programs / 'rs274', '-g', '../sound.ngc', '-t'], r'a\.tbl:1\b'
    for name, text in PARAMETERS.items():
        yield f'parameters.{name}', 'a.var', text, [programs / 'rs274', '-g', '../sound.ngc', '-v'], r'a\.var:1\b'
    for name, text in INI.items():
        yield f'ini.{name}', 'a.ini', text.replace('{file}', 'a.ini'), [programs / 'millwright', 'doctor', '--latency', '0'], r'a\.ini:\d+.*error'
    for name, (pin, body) in COMPONENTS.items():
        yield f'comp.{name}', 'a.comp', COMPONENT.format('a', pin, body), [programs / 'halcompile', '--compile'], r'a\.comp:\d+'
    for name, text in HAL.items():
        yield f'hal.{name}', 'a.hal', text.replace('{file}', 'a.hal'), [programs / 'halrun', '-f'], r'a\.hal:1:'
    for name, text in TCL.items():
        yield f'tcl.{name}', 'a.tcl', text.replace('{file}', 'a.tcl'), [programs / 'haltcl'], r'a\.tcl"? ?:?(line )?\d'


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def finding(root, case):
    """(fault of the case, empty if none; a line about the used time and memory)."""
    name, file, text, command, place = case
    folder = root / name
    folder.mkdir()
    (folder / file).write_text(text)
    begin = time.monotonic()
    errors, out = (folder / 'errors.txt').open('w+', errors='replace'), (folder / 'out.txt').open('w+', errors='replace')
    with errors, out:
        process = subprocess.Popen([*map(str, command), file], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=errors,
                                   env=dict(os.environ, MILLWRIGHT_INSTANCE=f"nesting-{os.getpid()}-{name.replace('.', '-')}"),
                                   preexec_fn=limited, start_new_session=True)
        try:
            process.wait(CASE_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        took = time.monotonic() - begin
        out.seek(0)
        errors.seek(0)
        output = errors.read(OUTPUT_BYTES + 1) + out.read(OUTPUT_BYTES + 1)
    shutil.rmtree(folder)
    facts = f'{name}: status {process.returncode}, {took:.2f} s'
    if process.returncode <= 0 or process.returncode > 127:
        return f'ends with status {process.returncode} instead of an error: {output[-300:]}', facts
    if len(output) > OUTPUT_BYTES:
        return f'prints more than {OUTPUT_BYTES} characters', facts
    if re.search(place, output) is None:
        return f'no error has the place {place}: {output[:600]}', facts
    return '', facts


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    wanted = sys.argv[2:]
    status = 0
    with tempfile.TemporaryDirectory(prefix='mw_nesting_') as name, concurrent.futures.ThreadPoolExecutor(2) as pool:
        root = pathlib.Path(name)
        os.environ.update(LANG='C.UTF-8', HOME=name)
        (root / 'sound.ngc').write_text('T1 M6\nG43\nM2\n')
        (root / 'python.ini').write_text('[PYTHON]\nTOPLEVEL = top.py\n')
        (root / 'top.py').write_text('')
        some = [case for case in cases(programs) if not wanted or any(case[0].startswith(one) for one in wanted)]
        for wrong, facts in pool.map(lambda case: finding(root, case), some):
            print(('FAILED ' if wrong else 'passed ') + facts + (f'\n       {wrong}' if wrong else ''), flush=True)
            status = max(status, 1 if wrong else 0)
    return status


if __name__ == '__main__':
    sys.exit(main())
