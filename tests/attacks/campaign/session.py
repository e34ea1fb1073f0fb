#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine that runs seeds as long as it is intact. Prints a line of JSON for each seed, and one for the end of the machine.

usage: session.py BIN_FOLDER ROOT [--self-test] SEED...
"""
import dataclasses
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import threading
import time

import judges
import plan as plans
import self_test
import state_files
from attack_types import TABLE, Child, carry_out
from attacked_machine import MEMORY, AttackedMachine, temporary_names

AFTER_ATTACKS_S = 0.2  # for messages about the last attack
EXPECTED = re.compile(r'^(configs/.*\.(ini|inc|hal|tbl|var|var\.certificate\.json|bak|journal|tcl|ngc|py|md|png|xml|ui|txt)|configs/.*/[A-Z]*|configs/shop/start|config/.*|nc/(cut|pipe|loop|large|slow|slip)\.ngc|'
                      r'(out|web|rsh|nml)\.txt|m\.nml|[^/]*\.history)$')


class Here(threading.Thread):
    """An attack that runs in the process of the session."""

    def __init__(self, one, scene, rng, at):
        super().__init__(daemon=True)
        self.one, self.scene, self.rng, self.at, self.answer = one, scene, rng, at, None
        self.start()

    def run(self):
        time.sleep(max(0.0, self.at - time.monotonic()))
        self.answer = carry_out(self.one, self.scene, self.rng)

    def result(self, deadline):
        self.join(max(0.0, deadline - time.monotonic()))
        return self.answer


class Session:
    def __init__(self, programs, root, device, isSelfTest):
        self.before = set(temporary_names(f'campaign-{os.getpid()}'))
        self.isSelfTest, self.found = isSelfTest, {}
        self.machine = AttackedMachine(programs, root, 'campaign', device)
        self.machine.begin()
        parameters = self.machine.ini.parent / 'mill_mm.var'
        self.parameters, self.tools = parameters, parameters.with_suffix('.tbl')
        self.first_parameters = {line.split('\t')[0] for line in parameters.read_text().splitlines()} if parameters.is_file() else set()
        self.first_tools = self.tools.read_text()
        self.offsets, self.diameters = [0.0], [state_files.diameter(self.first_tools)]
        self.isWhole, self.isEnded, self.hasCut = True, False, True
        self.wasFolderAway = False

    def can(self, one):
        has = {'mount': bool(self.machine.device), 'cgroup': self.machine.hasGroup}
        return all(has[need] for need in one.needs)

    def begin_cut(self, plan, scene):
        """(path, time at which the axes start to move or None, reason if they do not)."""
        machine, linuxcnc = self.machine, self.machine.linuxcnc
        lines = ''.join(TABLE[name].run(scene, random.Random(seed)) for name, _, seed in plan.attacks if TABLE[name].isProgram)
        (machine.nc / 'cut.ngc').unlink(missing_ok=True)
        (machine.nc / 'cut.ngc').write_text(plan.program(lines))
        machine.stat.poll()
        path = [machine.stat.actual_position[:3], *plan.corners, plan.corners[0]]
        machine.messages.clear()
        self.observed = machine.observer.ask('mark')
        machine.stopper.ask('lateness')
        machine.command.mode(linuxcnc.MODE_AUTO)
        machine.command.wait_complete(5)
        machine.command.program_open(str(machine.nc / 'cut.ngc'))
        opened = machine.command.wait_complete(5)
        if opened == linuxcnc.RCS_DONE:
            self.offsets, self.diameters = self.offsets + [plan.offset], self.diameters + [2 * plan.offset]
            machine.command.auto(linuxcnc.AUTO_RUN, 1)
            end = time.monotonic() + 3
            while time.monotonic() < end:
                machine.stat.poll()
                machine.collect()
                if machine.stat.current_vel > 0:
                    return path, time.monotonic(), ''
                if machine.messages and machine.stat.interp_state == linuxcnc.INTERP_IDLE:
                    break
                time.sleep(0.005)
        machine.until(lambda: False, 0.1)
        return path, None, f'opened: {opened}; ' + '; '.join(text[:150] for text in machine.messages)

    def attack(self, plan, scene, begin):
        """Carries out the attacks and the abort. Returns the record of the run, without the observations."""
        self.wasFolderAway = self.wasFolderAway or any(name == 'files.removed_folder' for name, _, _ in plan.attacks)
        scene.deadline = begin + plans.ATTACKS_END_S
        running = []
        events = [judges.Event(name, begin, float('inf'), TABLE[name].causes) for name, _, _ in plan.attacks if TABLE[name].isProgram]
        for name, at, seed in plan.attacks:
            one = TABLE[name]
            if one.isProgram or not self.can(one):
                continue
            kind = Here if one.isHere else Child
            running.append(kind(one, dataclasses.replace(scene), random.Random(seed), begin + at))
            self.isWhole = self.isWhole and not (one.isLast or one.isEnd)
        notes = []

        def collect(attacks):
            for one in attacks:
                running.remove(one)
                result = one.result(scene.deadline + 3)
                if result is None:
                    notes.append(f'{one.one.name} did not end')
                    result = [begin, time.monotonic(), '']
                events.append(judges.Event(one.one.name, result[0], result[1], one.one.causes))
                if result[2]:
                    notes.append(f'{one.one.name}: {result[2]}')

        collect([one for one in running if one.one.stopsTask])
        abort = None
        if not any(one.one.isEnd for one in running):
            time.sleep(max(0.0, begin + plan.abort[1] - time.monotonic()))
            abort = self.machine.stopper.ask(plan.abort[0])
            time.sleep(0.4)
        collect(list(running))
        latest = max((event.end for event in events if event.end < float('inf')), default=begin)
        time.sleep(max(0.0, latest + AFTER_ATTACKS_S - time.monotonic()))
        return events, abort, notes

    def run(self, seed):
        """{'seed', 'what', 'failures', 'notes'}"""
        plan = plans.make(seed)
        machine = self.machine
        scene = machine.scene()
        path, begin, why = self.begin_cut(plan, scene)
        what = f'{", ".join(name for name, _, _ in plan.attacks)}; abort by {plan.abort[0]}'
        answer = {'seed': seed, 'what': what, 'notes': [], 'failures': []}
        self.hasCut = begin is not None
        if begin is None:
            causes = [TABLE[name].causes for name, _, _ in plan.attacks if TABLE[name].isProgram]
            if not any(cause and re.search(cause, text) for cause in causes for text in machine.messages):
                answer['failures'].append(f'begin: the machine does not cut ({why})')
                self.isWhole = False
            self.after(plan, answer, [])
            return answer
        events, abort, notes = self.attack(plan, scene, begin)
        answer['notes'] = notes
        if abort is not None:
            answer['abort_ms'] = round((abort['answered'] - abort['sent']) * 1000)
            notes.append(f'abort in {answer["abort_ms"]} ms')
        isEnding = any(event.name.startswith('end.') for event in events)
        gone, end_s = self.wait_end(events, scene) if isEnding else ({}, None)
        observed = machine.observer.ask('take')
        record = judges.Record(path, begin, observed['samples'], events, observed['python'], observed['web'], abort,
                               machine.stopper.ask('lateness'), isEnding, gone, end_s, machine.servers['web'].poll() is None)
        if self.isSelfTest:
            self.found.update(self_test.of_record(record))
        answer['failures'] += judges.of_run(record)
        if end_s is not None:
            notes.append(f'end in {end_s:.2f} s')
        if judges.early_stops(record):
            notes.append('stopped by an attack')
        if isEnding:
            self.isEnded = True
        else:
            self.after(plan, answer, events)
        return answer

    def wait_end(self, events, scene):
        """Waits for the end caused by an attack: the reports that clients receive, and its duration."""
        machine = self.machine
        begin = next(event.begin for event in events if event.name.startswith('end.'))
        parts = [scene.processes[name] for name in ('task', 'realtime', 'rsh', 'nml') if scene.processes[name]]
        end_s = machine.wait_end(begin, parts)
        time.sleep(0.2)
        observed = machine.observer.ask('take')
        text = machine.terminal.text.decode(errors='replace')
        return {'python': observed['python_gone'], 'web': any(state == 'gone' for _, state in observed['web_gone']) or machine.servers['web'].poll() is not None, 'terminal': text}, end_s

    def after(self, plan, answer, events):
        """Checks servers and files after a run; the machine is on and idle again."""
        machine, failures = self.machine, answer['failures']
        if machine.process.poll() is not None:
            failures.append(f'process: millwright start has ended with status {machine.process.returncode}: {machine.terminal.text[-300:].decode(errors="replace")}')
            self.isWhole = False
            return
        self.check_servers({server for name, _, _ in plan.attacks for server in TABLE[name].kills}, failures)
        self.check_files(failures)
        self.recover(failures)

    def check_servers(self, killed, failures):
        """Restarts servers that have ended; an attack must have killed them."""
        machine = self.machine
        for server, process in machine.servers.items():
            if process.poll() is None:
                continue
            if server not in killed:
                failures.append(f'process: the server {server} has ended with status {process.returncode}: {machine.output_of(server)[-300:]}')
            machine.begin_server(server)
            if server == 'web':
                time.sleep(0.6)  # until the observer is connected again

    def check_files(self, failures):
        for path, content in self.machine.files.items():
            if not path.is_file() or path.read_bytes() != content:
                failures.append(f'file: {path.name} has changed')
        if self.parameters.exists() or self.first_parameters:
            failures += state_files.of_parameters(self.parameters, self.first_parameters, self.offsets)
        failures += state_files.of_tools(self.tools, self.first_tools, self.diameters)
        if any(text.startswith('file:') for text in failures):
            self.isWhole = False
            return
        if self.parameters.exists():
            self.offsets = state_files.since(self.offsets, state_files.offset_of(self.parameters))
        self.diameters = state_files.since(self.diameters, state_files.diameter(self.tools.read_text()))

    def recover(self, failures):
        """Aborts and switches the machine on, as an operator does."""
        machine, linuxcnc = self.machine, self.machine.linuxcnc
        machine.command.abort()
        machine.command.wait_complete(2)
        for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
            machine.stat.poll()
            if machine.stat.task_state != linuxcnc.STATE_ON:
                machine.command.state(state)
                machine.command.wait_complete(2)
        ready = machine.until(lambda: machine.stat.task_state == linuxcnc.STATE_ON and machine.stat.interp_state == linuxcnc.INTERP_IDLE and
                              all(machine.stat.homed[:3]) and machine.stat.current_vel == 0, 2)
        if not ready:
            stat = machine.stat
            failures.append(f'recover: the machine cannot be used again: state {stat.task_state}, interpreter {stat.interp_state}, homed {stat.homed[:3]}: '
                            + '; '.join(text[:100] for text in machine.messages[-3:]))
            self.isWhole = False

    def end(self):
        """Failures at the end of the machine."""
        machine, failures = self.machine, []
        if self.isSelfTest:
            self.found.update(self_test.of_files(self))
            machine.servers['rsh'].kill()
            machine.servers['rsh'].wait()
            self.check_servers((), failures)
            self_test.spoil_end(machine)
        if self.isEnded:
            machine.end_all()
            failures += self.start_again()
        else:
            took = machine.end_all()
            if took is None or took > judges.END_S:
                failures.append(f'end: SIGTERM ends the processes {"in %.2f s" % took if took else "never"}: {processes(machine)}')
            if machine.process.poll() != 0:
                failures.append(f'end: millwright start ends with status {machine.process.poll()}: {machine.terminal.text[-300:].decode(errors="replace")}')
        failures += self.left_behind()
        if not self.isEnded and self.hasCut:
            self.offsets, self.diameters = self.offsets[-1:], self.diameters[-1:]
        self.check_files(failures)
        return failures

    def start_again(self):
        """After a machine was killed, the next start of this instance works and leaves no files."""
        machine = self.machine
        again = subprocess.Popen([machine.programs / 'millwright', 'start', machine.ini, '--no-display'], env=machine.env, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        text, rest = '', ''
        while line := again.stdout.readline():
            text += line
            if 'is running: instance' in line:
                break
        if 'is running: instance' in text:  # servers that were killed leave files, which their next start removes
            for server in machine.servers:
                machine.begin_server(server)
            machine.servers['web'].terminate()
        again.terminate()
        try:
            rest, _ = again.communicate(timeout=5)
        except subprocess.TimeoutExpired:
            again.kill()
            return ['end: a start after the end of the machine does not end: ' + text]
        machine.wait_end(time.monotonic())
        return [] if 'is running: instance' in text and again.returncode == 0 else [f'end: a start after the end of the machine fails: {text}{rest}']

    def left_behind(self):
        machine = self.machine
        left = [f'process {name} {number}' for number, name in processes(machine).items()]
        left += sorted(set(temporary_names(machine.instance)) - self.before)
        left += [str(path.relative_to(machine.folder)) for path in machine.folder.rglob('*')
                 if not path.is_dir() and not EXPECTED.match(str(path.relative_to(machine.folder)))]
        if self.wasFolderAway:  # a file that was written during this time cannot be removed under its name
            left = [name for name in left if not re.search(r'\.(var|tbl|bak|journal|json)\.\w{6}$', name)]
        left += [str(path) for path in machine.temporary.iterdir()]
        if machine.hasGroup and (MEMORY / machine.cgroup / 'cgroup.procs').read_text().split():
            left.append('processes of the cgroup')
        return [f'left: {name}' for name in left]


def processes(machine):
    from attacked_machine import processes_of  # pylint: disable=import-outside-toplevel
    return processes_of(machine.instance, 'machine')


def main():
    programs, root, *seeds = sys.argv[1:]
    isSelfTest = seeds[0] == '--self-test'
    session = Session(programs, root, os.environ.pop('MW_ATTACK_DEVICE', ''), isSelfTest)
    try:
        for seed in seeds[isSelfTest:]:
            print(json.dumps(session.run(int(seed))), flush=True)
            if not session.isWhole:
                break
        print(json.dumps({'end': session.end(), 'found': session.found}), flush=True)
    finally:
        session.machine.kill_all()
        session.machine.clean()


if __name__ == '__main__':
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
    main()
