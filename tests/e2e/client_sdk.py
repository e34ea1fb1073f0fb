#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Installs the client library into an empty folder and builds examples/nml_client with it, with pkg-config and with CMake,
outside the tree. Both programs send EMC_IO_GENERIC to another process.

usage: client_sdk.py BUILD SOURCE
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f'{" ".join(map(str, words))}: {done.stdout}{done.stderr}')
    return done.stdout


def exchange(program, config):
    """The receiver creates the channel, then the other process sends."""
    with subprocess.Popen([program, config, 'receive'], stdout=subprocess.PIPE, text=True) as receiver:
        first = receiver.stdout.readline()
        run(program, config, 'send', '3', '1.5')
        told, _ = receiver.communicate(timeout=30)
    if first != 'ready\n' or told != 'output 3 = 1.5\n' or receiver.returncode != 0:
        sys.exit(f'{program}: {first!r} {told!r}, status {receiver.returncode}')


def main():
    build, source = map(pathlib.Path, sys.argv[1:])
    with tempfile.TemporaryDirectory(prefix='mw_sdk_') as temporary:
        base = pathlib.Path(temporary)
        prefix, example = base / 'prefix', base / 'example'
        run('cmake', '--install', build, '--prefix', prefix, '--component', 'client_sdk')
        shutil.copytree(source / 'examples/nml_client', example)
        libdir = next(prefix.rglob('millwright-client.pc')).parent
        flags = run('pkg-config', '--cflags', '--libs', 'millwright-client', env={**os.environ, 'PKG_CONFIG_PATH': str(libdir)}).split()
        run('g++', '-O0', example / 'generic_output.cc', *flags, '-o', base / 'by_pkg_config')
        exchange(base / 'by_pkg_config', example / 'generic_output.nml')
        run('cmake', '-S', example, '-B', base / 'made', f'-DCMAKE_PREFIX_PATH={prefix}')
        run('cmake', '--build', base / 'made')
        exchange(base / 'made/generic_output', example / 'generic_output.nml')
    print('1 passed, 0 failed')


main()
