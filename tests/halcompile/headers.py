#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Each C header of the interface compiles alone, as C and C++, for modules and for programs. usage: headers.py FOLDER"""
import pathlib
import subprocess
import sys


def main():
    folder = pathlib.Path(sys.argv[1])
    headers = sorted(folder.glob('*.h')) + sorted(folder.glob('asm/*.h'))
    failures = 0
    for header in headers:
        for language in ('c', 'c++'):
            for side in ('-DULAPI', '-DRTAPI'):
                command = ['g++' if language == 'c++' else 'gcc', '-x', language, side, '-fsyntax-only', '-Wall', '-Wextra',
                           '-Werror', f'-I{folder}', '-']
                if language == 'c++':
                    command.insert(1, '-std=c++11')
                text = f'#include "{header.relative_to(folder)}"\n' * 2
                done = subprocess.run(command, input=text, text=True, capture_output=True, check=False)
                if done.returncode != 0:
                    failures += 1
                    print(f'{header.name} as {language} with {side}:\n{done.stderr}')
    print(f'{len(headers)} headers, {failures} failures')
    return 1 if failures or not headers else 0


if __name__ == '__main__':
    sys.exit(main())
