#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""An installation in a separate folder works with an empty environment: run in both clocks, halrun, halcompile, Python.

usage: installed.py CMAKE BUILD_FOLDER SOURCE_FOLDER
"""
import os
import pathlib
import subprocess
import sys
import tempfile

COMPONENT = '''component twice "twice the input";
pin in float in;
pin out float out;
function _;
license "GPL";
;;
FUNCTION(_) { out = 2 * in; }
'''
HAL = '''loadrt threads name1=slow period1=1000000
loadrt twice
addf twice.0 slow
setp twice.0.in 21
start
loadusr -w sleep 0.2
getp twice.0.out
'''
PYTHON = 'import hal\nc = hal.component("probe")\nc.newpin("x", hal.HAL_FLOAT, hal.HAL_OUT)\nc.ready()\nc["x"] = 4\nprint(c["x"])\n'


def main():
    cmake, build, source = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        prefix = folder / 'prefix'
        subprocess.run([cmake, '--install', build, '--prefix', prefix], check=True, stdout=subprocess.DEVNULL)
        home = folder / 'home'
        home.mkdir()
        (home / 'twice.comp').write_text(COMPONENT)
        (home / 'twice.hal').write_text(HAL)
        (home / 'pins.py').write_text(PYTHON)
        (home / 'python.hal').write_text('loadusr -w python3 pins.py\n')
        env = {'HOME': str(home), 'PATH': '/usr/bin:/bin', 'MILLWRIGHT_INSTANCE': f'installed-{os.getpid()}'}
        share = prefix / 'share/millwright'
        failures = []

        def run(what, words, text):
            done = subprocess.run([prefix / 'bin' / words[0], *words[1:]], env=env, cwd=home, capture_output=True, text=True,
                                  stdin=subprocess.DEVNULL, check=False, timeout=120)
            if done.returncode != 0 or text not in done.stdout + done.stderr:
                failures.append(what)
                print(f'FAIL {what}: status {done.returncode}\n{done.stdout}{done.stderr}')

        part = home / 'part.ngc'
        part.write_text('G21 G90 F1200\nG1 X5 Y5\nM2\n')
        ini = str(share / 'configs/sim/mill_mm.ini')
        run('run in virtual time', ['millwright', 'run', ini, str(share / 'nc_files/drilling.ngc')], 'cycle time')
        run('run in real time', ['millwright', 'run', ini, str(part), '--realtime', '--yes'], 'cycle time')
        run('check', ['millwright', 'check', str(share / 'nc_files/lathe_part.ngc'), '--ini', str(share / 'configs/sim/lathe.ini')],
            'of the machine')
        run('halcompile', ['halcompile', '--install', 'twice.comp'], 'installed ')
        run('halrun with the new component', ['halrun', 'twice.hal'], '42')
        run('Python', ['halrun', 'python.hal'], '4')
        sourced = subprocess.run(['bash', '-c', f'. {source}/script/environment {prefix} && millwright --version && halrun -h && '
                                  'complete -p millwright && python3 -c "import hal" && manpath 2>/dev/null'], env=env, cwd=home,
                                 capture_output=True, text=True, check=False, timeout=60)
        if sourced.returncode != 0 or 'complete -F' not in sourced.stdout:
            failures.append('script/environment')
            print(f'FAIL script/environment: status {sourced.returncode}\n{sourced.stdout}{sourced.stderr}')
        for page in ('share/man/man1/millwright.1', 'share/bash-completion/completions/millwright', 'share/doc/millwright/README.md',
                     'share/doc/millwright/user/gcode/motion.md'):
            if not (prefix / page).is_file():
                failures.append(page)
                print(f'FAIL {page} is not installed')
    print(f'{len(failures)} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
