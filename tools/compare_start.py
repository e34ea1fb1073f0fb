#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures start and status of our launcher and of an installed LinuxCNC, alternately, with one configuration.

usage: compare_start.py [--bin DIR] [--config INI] [--runs N] [--user NAME]

Start: from the launcher's exec to the end of the first command of a script that is the display (reset of the emergency stop).
stat.poll(): mean of 5000 calls while the machine is stopped. Each run has separate namespaces (pid, mount, IPC, network) and an
ordinary user; this needs root. Figures depend on the load of the computer, so both run alternately and the median counts.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

CONFIG = '/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis/axis_mm.ini'
DISPLAY = '''#!/usr/bin/python3
import json, os, time
import linuxcnc
stat, command = linuxcnc.stat(), linuxcnc.command()
while True:
    try:
        stat.poll()
        if stat.task_state == linuxcnc.STATE_ESTOP:
            command.state(linuxcnc.STATE_ESTOP_RESET)
            command.wait_complete()
            stat.poll()
        if stat.task_state == linuxcnc.STATE_ESTOP_RESET:
            break
    except (linuxcnc.error, SystemError):
        time.sleep(0.005)
        stat = linuxcnc.stat()
ready = time.time() - float(os.environ['STARTED_AT'])
polls = 5000
begin = time.perf_counter()
for _ in range(polls):
    stat.poll()
each = (time.perf_counter() - begin) / polls
json.dump({'ready_s': ready, 'poll_us': each * 1e6}, open(os.environ['FIGURES'], 'w'))
'''


def measure(launcher, config, options, more):
    """{'ready_s', 'poll_us'} of one start."""
    with tempfile.TemporaryDirectory(prefix='mw_start_', dir='/var/tmp') as name:
        folder = pathlib.Path(name)
        shutil.copytree(config.parent, folder / 'config', symlinks=False, ignore_dangling_symlinks=True)
        ini = folder / 'config' / config.name
        lines = [line for line in ini.read_text().splitlines() if not line.startswith(('POSTGUI', 'INTRO', 'OPEN_FILE'))]
        ini.write_text('\n'.join('DISPLAY = ./figures.py' if line.startswith('DISPLAY') else line for line in lines) + '\n')
        script = ini.parent / 'figures.py'
        script.write_text(DISPLAY)
        script.chmod(0o755)
        shutil.chown(folder, options.user)
        for path in folder.rglob('*'):
            shutil.chown(path, options.user)
        inner = ('mount -t tmpfs -o mode=1777 none /dev/shm && mount -t tmpfs -o mode=1777 none /tmp && ip link set lo up; '
                 'exec setpriv --reuid "$0" --regid $(id -g "$0") --clear-groups "$@"')
        env = {'PATH': '/usr/bin:/bin', 'HOME': name, 'LC_ALL': 'C', 'FIGURES': str(folder / 'figures.json'), **more}
        env['STARTED_AT'] = str(time.time())
        done = subprocess.run(['unshare', '-p', '-m', '-i', '-n', '-f', '--kill-child', '--mount-proc', 'sh', '-c', inner, options.user, launcher, '-r', str(ini)],
                              env=env, cwd=folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, timeout=90)
        figures = folder / 'figures.json'
        if not figures.exists():
            raise SystemExit(f'{launcher}: status {done.returncode}\n{done.stdout[-600:]}{done.stderr[-1200:]}')
        return json.loads(figures.read_text())


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument('--bin', type=pathlib.Path, default=pathlib.Path('build/release/bin'))
    words.add_argument('--config', type=pathlib.Path, default=pathlib.Path(CONFIG))
    words.add_argument('--runs', type=int, default=10)
    words.add_argument('--user', default='nobody')
    options = words.parse_args()
    ours = options.bin.resolve()
    kinds = {'Millwright': (str(ours / 'linuxcnc'), {'PATH': f'{ours}:/usr/bin:/bin', 'MILLWRIGHT_HALLIB': '/usr/share/linuxcnc/hallib'}),
             'LinuxCNC': ('/usr/bin/linuxcnc', {})}
    figures = {name: [] for name in kinds}
    for _ in range(options.runs):
        for name, (launcher, more) in kinds.items():
            figures[name].append(measure(launcher, options.config, options, more))
    print(f'{"":12}{"ready [s]":>12}{"least":>9}{"most":>9}{"poll [us]":>12}{"least":>9}{"most":>9}   load {os.getloadavg()[0]:.1f}')
    for name, runs in figures.items():
        print(f'{name:12}', end='')
        for key, form in (('ready_s', '.3f'), ('poll_us', '.2f')):
            values = [run[key] for run in runs]
            print(f'{statistics.median(values):12{form}}{min(values):9{form}}{max(values):9{form}}', end='')
        print()
    medians = {name: {key: statistics.median(run[key] for run in runs) for key in runs[0]} for name, runs in figures.items()}
    for key in ('ready_s', 'poll_us'):
        print(f'{key}: {medians["Millwright"][key] / medians["LinuxCNC"][key]:.3f} of LinuxCNC\'s')
    return 0


if __name__ == '__main__':
    sys.exit(main())
