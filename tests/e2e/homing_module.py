#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The homing module example, built by halcompile, homes a machine in virtual time. Modules without homing functions are rejected.

usage: homing_module.py BIN_FOLDER SOURCE_FOLDER
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROGRAM = 'G21 G90 G0 X10 Y5\nG1 X20 F600\nM2\n'
# The slide of joint 0 is at its hard stop when the motor is at -12.
STOP = ('loadrt comp names=stop\naddf stop servo-thread\nsetp stop.in1 -12\n'
        'net Xpos => stop.in0\nnet x-blocked stop.out => stallhome.0.blocked\n')


def main():
    programs, source = (pathlib.Path(word) for word in sys.argv[1:3])
    failures, count = [], 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        shutil.copytree(source / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var', '*.journal*'))
        machine = folder / 'configs/sim'
        environment = dict(os.environ, MILLWRIGHT_MODULE_PATH=str(folder))
        (machine / 'part.ngc').write_text(PROGRAM)

        def build(name, text):
            (folder / f'{name}.comp').write_text(text.replace('stallhome', name))
            done = subprocess.run([programs / 'halcompile', '--compile', '-o', folder / f'{name}.so', folder / f'{name}.comp'],
                                  capture_output=True, text=True, check=False, timeout=60)
            if done.returncode != 0:
                failures.append(f'halcompile {name}: {done.stdout}{done.stderr}')

        example = (source / 'examples/homing/stallhome.comp').read_text()
        build('stallhome', example)
        build('halfhome', example.replace('EXPORT_SYMBOL(do_homing);', '').replace('bool do_homing(void)', 'static bool do_it(void)'))
        build('wildhome', example.replace('#define RANGES 1.5', '#define RANGES 1e9').replace(
            'move(j, joints[j].pos_cmd + way, velocity)', 'move(j, joints[j].pos_cmd + way, 1e9)'))
        build('nanhome', example.replace('move(j, joints[j].pos_cmd + way, velocity)', 'move(j, 0.0 / (way - way), velocity)'))
        build('stillhome', example.replace('if (pins == NULL ||', 'if (1 ||'))

        def run(what, homemod, status, texts, words=(), hal=STOP, values=None):
            nonlocal count
            count += 1
            name = words[1] if words else homemod
            ini = machine / 'case.ini'
            text = (source / 'configs/sim/mill_mm.ini').read_text()
            text = text.replace('EMCMOT = motmod', f'HOMEMOD = {homemod}\nEMCMOT = motmod' if homemod else 'EMCMOT = motmod', 1)
            text = re.sub(r'(HOME_SEARCH_VEL|HOME_LATCH_VEL) = .*', r'\1 = 0', text)
            head, joint = text.split('[JOINT_0]\n')
            keys = {'HOME_SEARCH_VEL': '-10', 'HOME_LATCH_VEL': '1', 'HOME_OFFSET': '-5', 'HOME': '0', **(values or {})}
            first, *others = joint.split('\n[', 1)
            lines = [line for line in first.splitlines() if line.split('=')[0].strip() not in keys]
            first = '\n'.join(lines + [f'{key} = {value}' for key, value in keys.items()])
            ini.write_text(head + '[JOINT_0]\n' + '\n['.join([first, *others]))
            (machine / 'stop.hal').write_text(hal.replace('stallhome', name))
            ini.write_text(ini.read_text().replace('HALFILE = spindle_sim.hal\n',
                                                   'HALFILE = spindle_sim.hal\nHALFILE = stop.hal\n'))
            done = subprocess.run([programs / 'millwright', 'run', ini, machine / 'part.ngc', *words],
                                  capture_output=True, env=environment, cwd=folder, text=True, check=False, timeout=60)
            said = done.stdout + done.stderr
            missing = [text for text in texts if text not in said]
            if (done.returncode == 0) != (status == 0) or missing:
                failures.append(f'{what}: status {done.returncode}, missing {missing}:\n{said}')

        run('the example homes', 'stallhome', 0, ['cycle time'])
        run('by the command line', '', 0, ['cycle time'], ['--homemod', 'stallhome'])
        run('the command line goes before the file', 'nosuch', 0, ['cycle time'], ['--homemod', 'stallhome'])
        run('excessive requests are limited', 'wildhome', 0,
            ['the homing module commanded more than the limits of joint 0 allow', 'cycle time'])
        run('one that commands a value that is no number', 'nanhome', 1, ['not a finite number'])
        run('one that cannot start', 'stillhome', 1, ['homing_init answers -1'])
        run('one that lacks a function', 'halfhome', 1,
            ['case.ini:', 'halfhome is no homing module, it lacks do_homing'], hal='')
        run('one that is something else', 'ddt', 1, ['case.ini:', 'ddt is no homing module, it lacks homeMotFunctions'], hal='')
        run('one that is not there', 'nosuch', 1, ['case.ini:', "there is no module 'nosuch.so'"], hal='')
        run('ours by its name', 'homemod', 0, ['cycle time'], hal='', values={'HOME_SEARCH_VEL': '0', 'HOME_LATCH_VEL': '0'})
    for failure in failures:
        print('FAILED', failure)
    print(f'{count} cases, {len(failures)} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
