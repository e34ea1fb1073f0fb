#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests the selector of configurations: its display, its copies, its memory and its starts; linuxcnc_var and linuxcnc_check_ini.

usage: selector.py BIN_FOLDER ROOT
"""
import os
import pathlib
import pty
import select
import shutil
import subprocess
import sys
import tempfile
import time


class Bench:
    def __init__(self, programs, root, place):
        self.programs = programs
        self.home = pathlib.Path(place) / 'home'
        self.mine = pathlib.Path(place) / 'aux'
        shutil.copytree(root / 'configs/sim', self.mine / 'shop', ignore=shutil.ignore_patterns('*.var', '*.journal'))
        for ini in (self.mine / 'shop').glob('*.ini'):
            if ini.stem != 'mill_mm':
                ini.unlink()
        ini = self.mine / 'shop/mill_mm.ini'
        screen = self.mine / 'shop/screen.sh'
        screen.write_text('#!/bin/sh\necho "the screen of $2"\nexit 7\n')
        screen.chmod(0o755)
        ini.write_text(ini.read_text().replace('DISPLAY = millwright', 'DISPLAY = ./screen.sh').replace('../../nc_files', str(root / 'nc_files')))
        (self.mine / 'shop/part.inc').write_text('[EMC]\nMACHINE = part of others\n')
        (self.mine / 'shop/no_machine.ini').write_text('[EMC]\nMACHINE = part of others\n')
        self.home.mkdir()
        (self.home / '.linuxcncrc').write_text('[OTHER]\nKEPT = 1\n[PICKCONFIG]\nLAST_CONFIG = /gone.ini\nALSO = 2\n')
        self.env = {'HOME': str(self.home), 'PATH': f'{programs}:/usr/bin:/bin', 'MILLWRIGHT_INSTANCE': f'selector-{os.getpid()}',
                    'LINUXCNC_AUX_CONFIGS': f'/nowhere:{self.mine}'}
        self.failures = 0

    def expect(self, condition, what):
        if not condition:
            self.failures += 1
            print(f'FAIL {what}')

    def run(self, words, answers=''):
        return subprocess.run([self.programs / words[0], *words[1:]], env=self.env, cwd=self.home, input=answers, capture_output=True,
                              text=True, check=False, timeout=60)

    def at_terminal(self, words, answers):
        """(status, output) of a program at a separate terminal."""
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.home)
            os.execve(self.programs / words[0], words, self.env)
        os.write(terminal, answers.encode())
        output = b''
        end = time.monotonic() + 60
        while time.monotonic() < end:
            if not select.select([terminal], [], [], 0.5)[0]:
                continue
            try:
                part = os.read(terminal, 4096)
            except OSError:
                break
            if not part:
                break
            output += part
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        os.close(terminal)
        return status, output.decode(errors='replace')


def check_selector(bench, root):
    listed = bench.run(['millwright', 'select', '--list']).stdout.splitlines()
    bench.expect(str(bench.mine / 'shop/mill_mm.ini') in listed and str(root / 'configs/sim/corexy.ini') in listed, f'listed: {listed}')
    bench.expect(not any('no_machine' in line for line in listed), 'a part of others is no configuration')
    # A sample is copied once.
    shown = bench.run(['millwright', 'select', '--print'], 'corexy\n')
    copy = bench.home / 'millwright/configs/sim/corexy.ini'
    bench.expect(shown.returncode == 0 and shown.stdout.rstrip().endswith(str(copy)) and copy.is_file(), f'copied: {shown}')
    bench.expect((bench.home / 'millwright/nc_files/pocket.ngc').is_file(), 'programs of the sample')
    copy.write_text(copy.read_text() + '# mine\n')
    bench.run(['millwright', 'select', '--print'], 'samples\nnothing\n999\nq\n')
    again = bench.run(['millwright', 'select', '--print'], 'corexy\n')
    bench.expect(copy.read_text().endswith('# mine\n'), 'a copy is never overwritten')
    bench.expect('several names match' in again.stdout or str(copy) in again.stdout, f'chosen again: {again.stdout}')
    left = bench.run(['millwright', 'select', '--print'], 'q\n')
    bench.expect(left.returncode == 0 and '.ini\n' not in left.stdout.splitlines()[-1], f'left: {left}')
    # The launcher asks only at a terminal.
    bench.expect(bench.run(['linuxcnc']).returncode == 2, 'no question without a terminal')
    status, output = bench.at_terminal(['linuxcnc'], 'shop/mill_mm\n')
    ini = bench.mine / 'shop/mill_mm.ini'
    bench.expect(status == 7 and f'the screen of {ini}' in output, f'started: {status}\n{output}')
    kept = (bench.home / '.linuxcncrc').read_text()
    bench.expect(f'LAST_CONFIG = {ini}' in kept and 'KEPT = 1' in kept and 'ALSO = 2' in kept and '/gone' not in kept, f'remembered: {kept}')
    last = bench.run(['linuxcnc', '-l'])
    bench.expect(last.returncode == 7 and f'the screen of {ini}' in last.stdout, f'the last one: {last}')
    status, output = bench.at_terminal(['linuxcnc'], '\n')
    bench.expect(status == 7, f'ENTER is the last one: {status}\n{output}')


def check_small_programs(bench):
    everything = dict(line.split('=', 1) for line in bench.run(['linuxcnc_var', 'all']).stdout.splitlines())
    for name in ('LINUXCNCVERSION', 'LINUXCNC_AUX_GLADEVCP', 'LINUXCNC_AUX_EXAMPLES', 'REALTIME', 'RTS', 'HALLIB_DIR', 'PYTHON'):
        bench.expect(bench.run(['linuxcnc_var', name]).stdout.rstrip('\n') == everything.get(name), f'linuxcnc_var {name}')
    bench.expect((pathlib.Path(everything['HALLIB_DIR']) / 'core_sim.hal').is_file() and os.access(everything['REALTIME'], os.X_OK), 'places are there')
    unknown = bench.run(['linuxcnc_var', 'NOTHING'])
    bench.expect((unknown.returncode, unknown.stdout) == (1, 'UNKNOWN\n'), f'unknown: {unknown}')
    ini = bench.mine / 'shop/mill_mm.ini'
    good = bench.run(['linuxcnc_check_ini', str(ini)])
    bench.expect((good.returncode, good.stderr) == (0, ''), f'good: {good}')
    warned = bench.mine / 'shop/warned.ini'
    warned.write_text(ini.read_text().replace('HOME_LATCH_VEL = 5', 'HOME_LATCH_VEL = 55', 1))
    told = bench.run(['linuxcnc_check_ini', str(warned)])
    bench.expect(told.returncode == 0 and told.stderr.startswith(f'{warned}: warning: '), f'warned: {told}')
    bench.expect(bench.run(['linuxcnc_check_ini', '-e', str(warned)]).returncode == 1, 'strict')
    warned.write_text(ini.read_text().replace('JOINTS = 3', 'JOINTS = three'))
    told = bench.run(['linuxcnc_check_ini', str(warned)])
    bench.expect(told.returncode == 1 and f'{warned}: error: ' in told.stderr, f'an error: {told}')
    bench.expect(bench.run(['linuxcnc_check_ini', 'gone.ini']).returncode == 2, 'no file')
    bench.expect(bench.run(['linuxcnc_check_ini']).returncode == 2, 'no word')


def main():
    programs, root = map(pathlib.Path, sys.argv[1:3])
    with tempfile.TemporaryDirectory() as place:
        bench = Bench(programs, root, place)
        check_selector(bench, root)
        check_small_programs(bench)
    print(f'{bench.failures} failed')
    return 1 if bench.failures else 0


if __name__ == '__main__':
    sys.exit(main())
