#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The planner module example, built by halcompile, drives a machine in virtual time. Modules that request too much stop the path
within the limits and are reported; modules without planner functions are rejected.

usage: planner_module.py BIN_FOLDER SOURCE_FOLDER
"""
import csv
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = 'G21 G90 G64 P0.05\nG1 X40 F3000\nY30\nX0\nG2 X10 Y20 I10 J0\nG1 X0 Y0\nM2\n'
PERIOD_S = 0.001
# Faulty modules, and their error messages.
WRONG = {
    'fasttp': ('phases[1].speed = phases[0].speed;', 'phases[1].speed = phases[0].speed = 2 * s->speed_cap;', 'times the maximum speed'),
    'hardtp': ('    up = up < s->length', '    up = 1e-6;\n    up = up < s->length', 'times the maximum acceleration'),
    'shorttp': ('phases[1].length = s->length - up - down;', 'phases[1].length = 0;', 'does not reach the end'),
    'nantp': ('phases[2].speed = sqrt(end2);', 'phases[2].speed = 0.0 / (end2 - end2);', 'not a number'),
    'nonetp': ('return 3;', 'return 0;', 'returned no speed'),
}


def speeds(trace):
    """Maximum speed and acceleration of X and Y, and the number of cycles."""
    with open(trace, encoding='utf-8') as file:
        rows = [(float(row['axis.x']), float(row['axis.y'])) for row in csv.DictReader(file)]
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(rows, rows[1:])]
    fastest = max((math.hypot(*step) for step in steps), default=0) / PERIOD_S
    hardest = max((max(abs(b[i] - a[i]) for i in (0, 1)) for a, b in zip(steps, steps[1:])), default=0) / PERIOD_S ** 2
    return fastest, hardest, sum(1 for step in steps if step != (0, 0))


def main():
    programs, source = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    failures, count = [], 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        shutil.copytree(source / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var', '*.journal*'))
        machine = folder / 'configs/sim'
        (folder / 'part.ngc').write_text(PROGRAM)
        example = (source / 'examples/planner/easytp.comp').read_text()

        def build(name, text):
            (folder / f'{name}.comp').write_text(text.replace('easytp', name))
            done = subprocess.run([programs / 'halcompile', '--compile', '-o', folder / f'{name}.so', folder / f'{name}.comp'],
                                  capture_output=True, text=True, check=False, timeout=60)
            if done.returncode != 0:
                failures.append(f'halcompile {name}: {done.stdout}{done.stderr}')

        def run(what, tpmod, status, texts, words=(), hal=''):
            nonlocal count
            count += 1
            text = (machine / 'mill_mm.ini').read_text()
            text = text.replace('[TRAJ]\n', f'[TRAJ]\nTPMOD = {tpmod}\n', 1) if tpmod else text
            (machine / 'share.hal').write_text(hal)
            (machine / 'case.ini').write_text(text.replace('HALFILE = spindle_sim.hal\n',
                                                           'HALFILE = spindle_sim.hal\nHALFILE = share.hal\n'))
            trace = folder / 'trace.csv'
            trace.unlink(missing_ok=True)
            done = subprocess.run([programs / 'millwright', 'run', machine / 'case.ini', folder / 'part.ngc', '--trace', trace, *words],
                                  capture_output=True, env=dict(os.environ, MILLWRIGHT_MODULE_PATH=str(folder)), cwd=folder,
                                  text=True, check=False, timeout=60)
            said = done.stdout + done.stderr
            missing = [text for text in texts if text not in said]
            if (done.returncode == 0) != (status == 0) or missing:
                failures.append(f'{what}: status {done.returncode}, missing {missing}:\n{said}')
            return trace

        build('easytp', example)
        ours = speeds(run('without one', 'tpmod', 0, ['cycle time']))
        whole = speeds(run('the example, whole', 'easytp', 0, ['cycle time']))
        share = 'setp easytp.speed-share 0.4\nsetp easytp.acceleration-share 0.2\n'
        slow = speeds(run('the example with shares', 'easytp', 0, ['cycle time'], hal=share))
        run('by the command line', '', 0, ['cycle time'], ['--tpmod', 'easytp'])
        run('the command line goes before the file', 'nosuch', 0, ['cycle time'], ['--tpmod', 'easytp'])
        if whole[0] > ours[0] * 1.0001 or whole[1] > ours[1] * 1.001 or whole[2] > 1.1 * ours[2]:
            failures.append(f'whole {whole} is not as ours {ours}')
        if not 0.38 * ours[0] < slow[0] < 0.401 * ours[0] or slow[2] < 1.5 * ours[2]:
            failures.append(f'with shares {slow}, ours {ours}')
        for name, (old, new, told) in WRONG.items():
            assert old in example, old
            build(name, example.replace(old, new))
            stopped = run(f'{name} is stopped', name, 1, [told, 'the planner module', '(line 2)'])
            if stopped.exists():
                wrong = speeds(stopped)
                if wrong[0] > ours[0] * 1.0001 or wrong[1] > ours[1] * 1.001:
                    failures.append(f'{name}: {wrong}, ours {ours}')
        build('halftp', example.replace('EXPORT_SYMBOL(mw_tp_plan);', '').replace('int mw_tp_plan(', 'static int mw_plan_it('))
        build('stilltp', example.replace('if (pins == NULL)', 'if (1)'))
        run('one that lacks a function', 'halftp', 1, ['case.ini:', 'halftp is no planner module, it lacks mw_tp_plan'])
        run('one that cannot start', 'stilltp', 1, ['mw_tp_init answers -12'])
        run('one that is something else', 'ddt', 1, ['case.ini:', 'ddt is no planner module, it lacks mw_tp_init'])
        run('one that is not there', 'nosuch', 1, ['case.ini:', "there is no module 'nosuch.so'"])
    for failure in failures:
        print(failure)
    print(f'{count} runs, {len(failures)} failures; ours {ours}, with shares {slow}')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
