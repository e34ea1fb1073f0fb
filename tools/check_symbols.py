#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that realtime code calls nothing that allocates, locks, blocks or throws.

usage: check_symbols.py ALLOWED FILE...
ALLOWED lists the undefined symbols that realtime archives and components may have, one glob per line ('#' comments); 'NAME.so:
glob' permits it for that file only. Symbols that another FILE defines are permitted. Exit status 1 lists the others with the
object that needs them.
"""
import fnmatch
import pathlib
import re
import subprocess
import sys

IGNORED = ('_ITM_*', '__gmon_start__', '__cxa_finalize*', '_GLOBAL_OFFSET_TABLE_', '__dso_handle', '__tls_get_addr*',
           '__stack_chk_fail*')


def symbols_of(path):
    """Yields (member, kind, name) of an archive or shared object."""
    dynamic = ['-D'] if path.suffix == '.so' else []
    out = subprocess.run(['nm', '-A', *dynamic, str(path)], capture_output=True, text=True, check=True).stdout
    for line in out.splitlines():
        match = re.match(r'(.*?):\s*(?:[0-9a-f]+)?\s*([A-Za-z])\s(\S+)$', line)
        if match:
            yield match[1].split('/')[-1], match[2], match[3].split('@')[0]


def readable(names):
    """C++ names in readable form."""
    out = subprocess.run(['c++filt'], input='\n'.join(names), capture_output=True, text=True, check=True).stdout
    return dict(zip(names, out.splitlines()))


def main():
    allowed, of_file = [], {}
    for line in pathlib.Path(sys.argv[1]).read_text(encoding='utf-8').splitlines():
        pattern = line.split('#')[0].strip()
        file, colon, of_one = pattern.partition(': ')
        if colon:
            of_file.setdefault(file, []).append(of_one)
        elif pattern:
            allowed.append(pattern)
    isAllowed = re.compile('|'.join(fnmatch.translate(p) for p in [*allowed, *IGNORED])).match
    defined, wanted = set(), {}
    for name in sys.argv[2:]:
        for member, kind, symbol in symbols_of(pathlib.Path(name)):
            # Weak undefined symbols (w, v) may remain undefined, because the caller links them.
            if kind in 'Uwv' and any(fnmatch.fnmatchcase(symbol, one) for one in of_file.get(member.split(':')[0], ())):
                continue
            if kind in 'Uwv':
                wanted.setdefault(symbol, set()).add(member)
            else:
                defined.add(symbol)
    bad = sorted(s for s in wanted if s not in defined and not isAllowed(s))
    names = readable(bad) if bad else {}
    for symbol in bad:
        places = sorted(wanted[symbol])
        print(f'{names[symbol]}: wanted by {", ".join(places[:3])}{" ..." if len(places) > 3 else ""}')
    if bad:
        print(f'{len(bad)} symbols that realtime code may not use (allowed ones: {sys.argv[1]})')
    return 1 if bad else 0


sys.exit(main())
