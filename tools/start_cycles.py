#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Starts and stops a simulated machine repeatedly, in many ways, and checks what remains.

usage: start_cycles.py --bin DIR --kind virtual|realtime [--cycles N] [--record FILE] [--seed N]

virtual: `millwright run` in virtual time; realtime: `linuxcnc -r` with a script as the display, in real time.
Each cycle ends in one of the WAYS, in turn. After each one, no new process, shared memory, socket, lock or file may exist. Needs
root: each cycle has separate pid, mount, IPC and network namespaces with separate /tmp and /dev/shm, so that everything that
remains is ours. The record (a line of JSON per cycle) is continued. Exit status 1: a cycle has failed.
"""
import argparse
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
WAYS = {
    'virtual': ('end', 'TERM', 'INT', 'KILL', 'refused', 'full_disk'),
    'realtime': ('end', 'TERM', 'INT', 'KILL', 'kill_realtime', 'kill_display', 'kill_program', 'full_disk', 'display_fails', 'refused'),
}
# The expected exit status: 0, another number, or any.
STATUS = {'end': 0, 'refused': 1, 'display_fails': 7}
PATIENCE_S = 40
PROGRAM = 'G21 G90 G17\nM3 S500\nG1 X5 Y5 F3000\nG2 X10 Y0 I2.5 J-2.5\nG0 X0 Y0\nM5\nM2\n'
DISPLAY = '''#!/usr/bin/env python3
import sys, time
import linuxcnc
stat, command = linuxcnc.stat(), linuxcnc.command()
for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
    command.state(state)
    command.wait_complete()
stat.poll()
assert stat.task_state == linuxcnc.STATE_ON, stat.task_state
open('up', 'w').write('up')
if sys.argv[-1] == 'fails':
    sys.exit(7)
if sys.argv[-1] == 'stays':
    time.sleep(60)
'''


class Cycle:
    """One start and stop in the namespaces that main() has created."""

    def __init__(self, programs, kind, way, rng):
        self.programs, self.kind, self.way, self.rng = programs, kind, way, rng
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='cycle_', dir='/var/tmp/cycles'))
        self.env = {**os.environ, 'PATH': f'{programs}:/usr/bin:/bin', 'LC_ALL': 'C', 'HOME': str(self.folder),
                    'PYTHONPATH': str(programs.parent / 'lib/python')}
        self.problems = []

    def prepare(self):
        shutil.copytree(ROOT / 'configs', self.folder / 'configs', ignore=shutil.ignore_patterns('*.var'))
        self.ini = self.folder / 'configs/sim/mill_mm.ini'
        stays = {'end': 'ends', 'display_fails': 'fails', 'refused': 'ends'}.get(self.way, 'stays')
        text = self.ini.read_text().replace('DISPLAY = millwright\n', f'DISPLAY = ./display.py {stays}\n')
        if self.kind == 'realtime':
            text += '\n[APPLICATIONS]\nAPP = sleep 50\n'
        if self.way == 'refused':
            text = text.replace('COORDINATES =', 'COORDINATES = XYQ #')
        self.ini.write_text(text)
        script = self.ini.parent / 'display.py'
        script.write_text(DISPLAY)
        script.chmod(0o755)
        self.program = self.ini.parent / 'cycle.ngc'
        self.program.write_text(PROGRAM if self.way in ('end', 'refused', 'full_disk') else PROGRAM.replace('M2', 'G4 P100000\nM2'))

    def words(self):
        if self.kind == 'virtual':
            return [self.programs / 'millwright', 'run', self.ini, self.program, '--no-check']
        return [self.programs / 'linuxcnc', '-r', self.ini]

    def child(self, name):
        for path in pathlib.Path('/proc').glob('[0-9]*'):
            try:
                words = (path / 'cmdline').read_bytes().split(b'\0')
            except OSError:
                continue
            if any(name in word.decode(errors='replace') for word in words[:2]):
                return int(path.name)
        return None

    def wait_until_up(self, process):
        end = time.monotonic() + PATIENCE_S
        if self.kind == 'virtual':
            time.sleep(self.rng.uniform(0, 0.4))  # at any time of the start or of the run
            return
        while process.poll() is None and time.monotonic() < end and not (self.ini.parent / 'up').exists():
            time.sleep(0.01)
        if process.poll() is None and not (self.ini.parent / 'up').exists():
            self.problems.append('not up in time')

    def end(self, process):
        signals = {'TERM': signal.SIGTERM, 'INT': signal.SIGINT, 'KILL': signal.SIGKILL}
        if self.way in signals:
            process.send_signal(signals[self.way])
        names = {'kill_realtime': 'millwright-rt', 'kill_display': 'display.py', 'kill_program': 'sleep'}
        if self.way in names:
            pid = self.child(names[self.way])
            if pid is None:
                self.problems.append(f'no process {names[self.way]}')
            else:
                os.kill(pid, signal.SIGKILL)
            if self.way == 'kill_program':
                time.sleep(0.1)
                if process.poll() is not None:
                    self.problems.append('the machine ended with a program beside it')
                process.terminate()

    def run(self):
        self.prepare()
        if self.way == 'full_disk':
            # The configuration's folder has no space for parameters, journal and tool table.
            small = self.folder / 'small'
            small.mkdir()
            subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=1m', 'none', str(small)], check=True)
            shutil.copytree(self.folder / 'configs', small / 'configs')
            self.ini, self.program = small / 'configs/sim/mill_mm.ini', small / 'configs/sim/cycle.ngc'
            self.ini.write_text(self.ini.read_text().replace(' stays', ' ends'))
            fill = os.open(small / 'fill', os.O_WRONLY | os.O_CREAT)
            try:
                while os.write(fill, b'x' * 4096):
                    pass
            except OSError:  # full
                pass
            os.close(fill)
        before = time.monotonic()
        output = pathlib.Path('/var/tmp/cycles/output')
        with open(output, 'wb') as out, subprocess.Popen([str(word) for word in self.words()], env=self.env, stdin=subprocess.DEVNULL, stdout=out,
                                                         stderr=subprocess.STDOUT, cwd=self.folder, start_new_session=True) as process:
            if self.way not in ('end', 'refused', 'full_disk', 'display_fails'):
                self.wait_until_up(process)
                self.end(process)
            try:
                status = process.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                self.problems.append('does not end')
                process.kill()
                status = None
        took = time.monotonic() - before
        wanted = STATUS.get(self.way)
        if wanted is not None and status != wanted:
            self.problems.append(f'status {status}, not {wanted}: {output.read_text(errors="replace")[-400:]}')
        self.look_for_remains()
        if self.way == 'full_disk':
            subprocess.run(['umount', str(self.folder / 'small')], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)
        return took, status

    def look_for_remains(self):
        end = time.monotonic() + 10  # a part that has lost the other parts ends by itself
        while True:
            left = remains()
            if not left or time.monotonic() > end:
                break
            time.sleep(0.05)
        if self.way == 'KILL' and left and not left[0].startswith('process'):
            # A killed process cannot clean up, so the next one does.
            again = Cycle(self.programs, self.kind, 'end', self.rng)
            again.run()
            self.problems += again.problems
            left = remains()
        self.problems += [f'left: {what}' for what in left]


def remains():
    """Remaining objects that need no machine."""
    left = []
    me = os.getpid()
    for path in pathlib.Path('/proc').glob('[0-9]*'):
        if int(path.name) in (1, me):
            continue
        try:
            state = (path / 'stat').read_text().rsplit(')', 1)[1].split()[0]
            if state != 'Z':
                left.append(f'process {path.name} ' + (path / 'cmdline').read_bytes().replace(b'\0', b' ').decode(errors='replace')[:100])
        except OSError:
            pass
    left += [f'shared memory {path.name}' for path in pathlib.Path('/dev/shm').rglob('*')]
    # The folder of a user's instances is created once; its contents belong to machines.
    left += [f'file {path}' for path in pathlib.Path('/tmp').rglob('*') if not (path.is_dir() and path.parent == pathlib.Path('/tmp'))]
    left += [f'socket {line.split()[-1]}' for line in pathlib.Path('/proc/net/unix').read_text().splitlines()[1:] if 'illwright' in line]
    left += [f'System V memory {line}' for line in pathlib.Path('/proc/sysvipc/shm').read_text().splitlines()[1:]]
    return left


def one(options):
    """Runs within the namespaces."""
    # If a shell has started this program in the background, it ignores the interrupt, and so do its children
    # until they have a handler.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    pathlib.Path('/var/tmp/cycles').mkdir(exist_ok=True)
    rng = random.Random(options.seed * 1000003 + options.one)
    way = WAYS[options.kind][options.one % len(WAYS[options.kind])]
    cycle = Cycle(options.bin.resolve(), options.kind, way, rng)
    took, status = cycle.run()
    print(json.dumps({'cycle': options.one, 'way': way, 'took_s': round(took, 3), 'status': status, 'problems': cycle.problems}))
    return 1 if cycle.problems else 0


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument('--bin', type=pathlib.Path, required=True)
    words.add_argument('--kind', choices=WAYS, required=True)
    words.add_argument('--cycles', type=int)
    words.add_argument('--record', type=pathlib.Path)
    words.add_argument('--seed', type=int, default=1)
    words.add_argument('--one', type=int, help=argparse.SUPPRESS)
    options = words.parse_args()
    if options.one is not None:
        return one(options)
    cycles = options.cycles or {'virtual': 2000, 'realtime': 300}[options.kind]
    done = []
    if options.record is not None and options.record.exists():
        done = [json.loads(line) for line in options.record.read_text().splitlines()]
    for number in range(len(done), cycles):
        inner = ('mount -t tmpfs -o mode=1777 none /dev/shm && mount -t tmpfs -o mode=1777 none /tmp && mount -t tmpfs none /var/tmp '
                 '&& ip link set lo up; exec "$@"')
        made = subprocess.run(['unshare', '-p', '-m', '-i', '-n', '-f', '--kill-child', '--mount-proc', 'sh', '-c', inner, 'sh', sys.executable, __file__,
                               '--bin', str(options.bin.resolve()), '--kind', options.kind, '--seed', str(options.seed), '--one', str(number)],
                              capture_output=True, text=True, check=False, timeout=5 * PATIENCE_S)
        line = made.stdout.strip().splitlines()[-1:] or [json.dumps({'cycle': number, 'way': '?', 'problems': [made.stderr[-400:]]})]
        done.append(json.loads(line[0]))
        if options.record is not None:
            with open(options.record, 'a', encoding='utf-8') as record:
                record.write(line[0] + '\n')
        if done[-1]['problems']:
            print(f"cycle {number} ({done[-1]['way']}): {done[-1]['problems']}", flush=True)
    bad = [one_ for one_ in done if one_['problems']]
    print(f'{options.kind}: {len(done)} cycles, {len(bad)} failed')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
