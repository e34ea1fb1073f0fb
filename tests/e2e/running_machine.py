#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""`millwright start` runs a machine; `millwright run --realtime` is its client (D3, E1).

When any process is killed or stopped, the machine must be safe and the work must continue.

usage: running_machine.py MILLWRIGHT HALCMD ROOT
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from mill_by_hand import STEP_S, Findings, Mill

SHORT = 'G21 G90 G61 F3000\nG1 X{0}\nG10 L2 P1 Y{0}\nG10 L2 P1 Y0\n#5161 = {0}\nM2\n'
LONG = 'G21 G90 G61 F300\nM3 S500\nM8\nG1 X100\nG1 X0\nM2\n'
FOUND = Findings()
expect = FOUND.expect


class Program:
    """A program whose output is written to a file that can be read while it runs."""

    def __init__(self, folder, env, *words):
        self.path = folder / f'{time.monotonic_ns()}.out'
        self.file = self.path.open('w', encoding='utf-8')
        self.process = subprocess.Popen(words, env=env, stdin=subprocess.DEVNULL, stdout=self.file, stderr=subprocess.STDOUT)

    @property
    def text(self):
        return self.path.read_text(encoding='utf-8', errors='replace')

    def wait_for(self, piece):
        return wait_until(lambda: piece in self.text or self.process.poll() is not None) and piece in self.text

    def end(self):
        try:
            return self.process.wait(STEP_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return 'it had to be killed'


def wait_until(condition):
    deadline = time.monotonic() + STEP_S
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(0.05)
    return False


class Bench(Mill):
    """The mill with programs, and calls of `millwright`."""

    def __init__(self, millwright, halcmd, root, folder):
        super().__init__(millwright, halcmd, root, folder, 'running')
        self.write('long.ngc', LONG)
        self.write('tools.ngc', 'G21 G90 G61 F1200\nT1 M6\nG1 X2\nM2\n')
        for x in (3, 5):
            self.write(f'short{x}.ngc', SHORT.format(x))

    def start(self, *more):
        return Program(self.folder, self.env, self.millwright, 'start', str(self.ini), *more)

    def up(self, *more):
        machine = self.start('--no-display', *more)
        expect(machine.wait_for('is running: instance'), 'the machine comes up', machine.text)
        expect((self.ini.parent / 'mill_mm.var').exists(), 'its parameter file is there for screens that read it')
        return machine

    def run(self, program, *more, ini=None):
        return Program(self.folder, self.env, self.millwright, 'run', str(ini or self.ini), str(self.folder / program),
                       '--realtime', '--yes', *more)

    def stands(self):
        """The machine stops and switches spindle and coolant off."""
        rest = wait_until(lambda: self.pin('spindle.0.on') == 'FALSE' and self.pin('iocontrol.0.coolant-flood') == 'FALSE')
        time.sleep(0.4)
        here = self.position()
        time.sleep(0.4)
        return rest and here == self.position()

    def is_down(self):
        """Nothing of the instance remains: HAL has ended, and another machine can start."""
        return wait_until(lambda: subprocess.run([self.halcmd, 'show', 'comp'], env=self.env, capture_output=True,
                                                 check=False).returncode != 0)


def certified(bench, machine, program):
    """The certificate of motion of the last program, when it exists for this program."""
    file = bench.ini.parent / 'mill_mm.var.certificate.json'

    def read():
        found = json.loads(file.read_text()) if file.exists() else {}
        return found if found.get('program', '').endswith(program) else None
    expect(wait_until(lambda: read() is not None), f'{program} is certified', machine.text)
    return read() or {}


def one_after_the_other(bench):
    machine = bench.up()
    expect(bench.pin('motion.motion-enabled') == 'FALSE', 'comes up in emergency stop')
    first = bench.run('short3.ngc')
    expect(first.end() == 0 and 'cycle time' in first.text, 'the first program runs', first.text)
    expect(abs(bench.position() - 3) < 1e-6 and bench.pin('motion.motion-enabled') == 'TRUE', 'the machine stays on, where it is')
    found = certified(bench, machine, 'short3.ngc')
    expect(found['finished'] and found['clock'] == 'realtime' and found['within_limits'] and found['within_tolerance'], 'its motion is certified', found)
    moved = next(one for one in found['limits'] if one['name'] == 'X')['velocity']
    expect(found['lost_samples'] == 0 and abs(moved['largest_per_s'] - 50) < 1 and moved['line'] == 2, 'with its feed and line', found)
    expect(wait_until(lambda: 'short3.ngc: motion certified' in machine.text), 'and the terminal has a line of it', machine.text)
    homing = bench.pin('joint.0.homed')
    second = bench.run('short5.ngc')
    expect(second.end() == 0 and abs(bench.position() - 5) < 1e-6, 'the second runs on the same machine', second.text)
    expect(homing == 'TRUE' and machine.process.poll() is None, 'and leaves it up', machine.text)

    again = bench.start('--no-display')
    expect(again.end() == 1 and 'already running' in again.text and str(bench.ini) in again.text, 'a second start is rejected', again.text)
    other = bench.ini.parent / 'gantry_xyyz.ini'
    wrong = bench.run('short3.ngc', ini=other)
    expect(wrong.end() == 1 and 'was started from' in wrong.text, 'another INI is rejected', wrong.text)
    trace = bench.run('short3.ngc', '--trace', str(bench.folder / 't.csv'))
    expect(trace.end() == 1 and '--trace needs' in trace.text, 'options that need a separate machine are rejected', trace.text)
    simulated = subprocess.run([bench.millwright, 'run', str(bench.ini), str(bench.folder / 'short3.ngc')], env=bench.env,
                               capture_output=True, text=True, check=False, timeout=STEP_S)
    expect(simulated.returncode == 0 and abs(bench.position() - 5) < 1e-6, 'a simulation leaves it alone', simulated.stderr)

    tools = bench.run('tools.ngc')
    expect(tools.wait_for('load tool 1'), 'the client receives the tool number', tools.text)
    time.sleep(0.5)
    expect(tools.process.poll() is None, 'and waits')
    bench.set_pin('hal_manualtoolchange.change_button', '1')
    expect(tools.end() == 0, 'until it is changed', tools.text)
    bench.set_pin('hal_manualtoolchange.change_button', '0')
    return machine


def clients_and_signals(bench, machine):
    running = bench.run('long.ngc')
    expect(wait_until(lambda: bench.pin('spindle.0.on') == 'TRUE'), 'the long program runs', running.text)
    second = bench.run('short3.ngc')
    expect(second.end() == 1 and 'already running a program' in second.text, 'a second client is rejected meanwhile', second.text)
    expect(running.process.poll() is None and bench.pin('spindle.0.on') == 'TRUE', 'and the first continues')
    os.kill(running.process.pid, signal.SIGTERM)
    expect(running.end() == 1 and 'stopped by SIGTERM' in running.text, 'a stop of the client ends its program', running.text)
    expect(bench.stands() and bench.pin('motion.motion-enabled') == 'TRUE', 'the machine is stopped, and stays on')
    found = certified(bench, machine, 'long.ngc')
    expect(found['finished'] is False and found['within_tolerance'], 'its motion is certified up to the stop', found)
    expect(machine.process.poll() is None, 'and up', machine.text)

    running = bench.run('long.ngc')
    expect(wait_until(lambda: bench.pin('spindle.0.on') == 'TRUE'), 'runs again', running.text)
    begin = time.monotonic()
    running.process.kill()
    running.process.wait()
    expect(wait_until(lambda: bench.pin('spindle.0.on') == 'FALSE') and time.monotonic() - begin < 5 and bench.stands(),
           'the program of a client that is killed is aborted', machine.text)
    expect('has disconnected: its work was aborted' in machine.text, 'and that is said', machine.text)
    after = bench.run('short3.ngc')
    expect(after.end() == 0 and abs(bench.position() - 3) < 1e-6, 'the next client has the machine', after.text)

    running = bench.run('long.ngc')
    expect(wait_until(lambda: bench.pin('spindle.0.on') == 'TRUE'), 'runs', running.text)
    os.kill(machine.process.pid, signal.SIGTERM)
    expect(machine.end() == 0 and 'stopped by SIGTERM' in machine.text, 'SIGTERM ends the machine in order', machine.text)
    expect(running.end() == 1, 'and the run of its client', running.text)
    expect(bench.is_down(), 'nothing is left')
    saved = (bench.ini.parent / 'mill_mm.var').read_text()
    expect(any(line.split()[:1] == ['5161'] and float(line.split()[1]) == 3 for line in saved.splitlines()),
           'parameters are saved', saved)


def killed_machine(bench):
    machine = bench.up()
    running = bench.run('long.ngc')
    expect(wait_until(lambda: bench.pin('spindle.0.on') == 'TRUE'), 'runs', running.text)
    machine.process.kill()
    machine.process.wait()
    expect(running.end() == 1 and 'no longer running' in running.text, 'its client says that the machine has ended', running.text)
    expect(bench.is_down(), 'the realtime process has ended')
    machine = bench.up()
    after = bench.run('short3.ngc')
    expect(after.end() == 0, 'the next machine starts and runs', after.text)
    os.kill(machine.process.pid, signal.SIGINT)
    expect(machine.end() == 0, 'SIGINT ends it', machine.text)

    alone = bench.run('long.ngc')
    expect(wait_until(lambda: bench.pin('spindle.0.on') == 'TRUE'), 'a machine for one program', alone.text)
    other = bench.run('short3.ngc')
    expect(other.end() == 1 and 'its own machine' in other.text, 'is not shared', other.text)
    started = bench.start('--no-display')
    expect(started.end() == 1 and 'already running' in started.text, 'nor is its instance', started.text)
    os.kill(alone.process.pid, signal.SIGTERM)
    expect(alone.end() == 1 and bench.is_down(), 'it ends', alone.text)


def displays(bench):
    said = bench.folder / 'said.txt'
    display = bench.ini.parent / 'show.sh'
    display.write_text(f'#!/bin/sh\necho "$0 $*; $INI_FILE_NAME; $CONFIG_DIR; $PWD" > {said}\nread line < wish\nexit $line\n')
    display.chmod(0o755)
    os.mkfifo(bench.ini.parent / 'wish')
    plain = bench.ini.read_text()

    def show(name):
        bench.ini.write_text('\n'.join(f'DISPLAY = {name}' if line.startswith('DISPLAY =') else line
                                       for line in plain.splitlines()) + '\n')

    show('no-such-display')
    missing = bench.start()
    expect(missing.end() == 1 and 'no-such-display' in missing.text and '--no-display' in missing.text,
           'a missing display is rejected', missing.text)
    show('show.sh one two')
    for status in ('0', '3'):
        machine = bench.start()
        expect(machine.wait_for('is running: instance'), 'up with its display', machine.text)
        expect(wait_until(lambda: said.exists() and said.read_text()), 'the display runs')
        expect(said.read_text() == f'{display} -ini {bench.ini} one two; {bench.ini}; {display.parent}; {display.parent}\n',
               'with its words and environment', said.read_text())
        expect(machine.process.poll() is None and bench.pin('motion.motion-enabled') == 'FALSE', 'the machine runs while the display runs')
        (bench.ini.parent / 'wish').write_text(status + '\n')
        expect(machine.end() == int(status), f'and ends with it and its status ({status})', machine.text)
        expect(bench.is_down(), 'nothing is left')
        said.unlink()
    machine = bench.start()
    expect(wait_until(lambda: said.exists() and said.read_text()), 'the display runs again', machine.text)
    os.kill(machine.process.pid, signal.SIGHUP)
    expect(machine.end() == 0, 'a signal ends machine and display', machine.text)
    asleep = subprocess.run(['pgrep', '-f', str(display)], capture_output=True, check=False)
    expect(asleep.returncode != 0, 'no display is left')


def main():
    millwright, halcmd, root = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as temporary:
        bench = Bench(millwright, halcmd, root, pathlib.Path(temporary).resolve())
        machine = None
        try:
            machine = one_after_the_other(bench)
            clients_and_signals(bench, machine)
            killed_machine(bench)
            displays(bench)
        finally:
            if machine is not None and machine.process.poll() is None:
                machine.process.terminate()
                machine.end()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
