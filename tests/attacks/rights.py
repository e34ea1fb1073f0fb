#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests the rights of each role: each row of the table in docs/integrator/security.md is tried at a running machine by a client of each column. The result
counts: a file that is written, a program that is open, an axis that has moved.

usage: rights.py BIN_FOLDER ROOT
"""
import http.client
import json
import os
import pathlib
import re
import socket
import stat
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from nml_session import CHANNELS, Client as Nml  # noqa: E402  pylint: disable=wrong-import-position
from rig import Machine  # noqa: E402  pylint: disable=wrong-import-position
from web_screen import Screen  # noqa: E402  pylint: disable=wrong-import-position

NOBODY = 65534
PYTHON = '/usr/bin/python3'  # other users may run it too
FOUND = Findings()
expect = FOUND.expect


def edit(text):
    filters = '[FILTER]\nPROGRAM_EXTENSION = .py Python\npy = python3\n'
    return f'{text}\n{filters}\n[PYTHON]\nTOPLEVEL = top.py\n'


class Web:
    """A browser of a server whose visitors all have one role."""

    def __init__(self, bench, role):
        out = bench.begin('http://', 'ui', bench.machine.ini, '--port', '0', '--listen', '127.0.0.1:0', '--unprotected', role)
        ports = [int(port) for port in re.findall(r'http://127\.0\.0\.1:(\d+)', out)]
        assert len(ports) == 2, out
        self.port, self.role, self.last = ports[1], role, None

    def screen(self):
        """Opens a new connection, because the server closes connections that are silent for 5 s."""
        if self.last is not None:
            self.last.socket.close()
        self.last = Screen(self.port)
        self.last.until(lambda: self.last.status)
        assert self.last.hello['role'] == self.role, self.last.hello
        return self.last

    def ask(self, method, path, body=None):
        connection = http.client.HTTPConnection('127.0.0.1', self.port, timeout=10)
        connection.request(method, path, body)
        answer = connection.getresponse()
        return answer.status, answer.read()

    def status(self):
        return bool(self.screen().status)

    def stop(self):
        self.screen().do('AbortAll')

    def mdi(self, line):
        self.screen().do('Mdi', line=line)

    def open(self, path):
        self.screen().do('OpenProgram', path=str(path))

    def run(self):
        self.screen().do('RunProgram')

    def add(self, name, text):
        self.ask('PUT', f'/api/files/{name}', text)

    def hal(self, name, value):
        self.ask('PUT', f'/api/hal/{name}', json.dumps({'value': value}))


class Python:
    """A program of the user who owns the machine."""

    def __init__(self, bench):
        self.machine = bench.machine
        self.halcmd = bench.machine.programs / 'halcmd'

    def status(self):
        self.machine.stat.poll()
        return True

    def stop(self):
        self.machine.command.abort()
        self.machine.command.wait_complete(5)

    def mdi(self, line):
        self.machine.command.mdi(line)
        self.machine.command.wait_complete(5)

    def open(self, path):
        self.machine.command.program_open(str(path))
        self.machine.command.wait_complete(5)

    def run(self):
        self.machine.command.auto(self.machine.linuxcnc.AUTO_RUN, 1)
        self.machine.command.wait_complete(5)

    def add(self, name, text):
        (self.machine.folder / 'nc_files' / name).write_text(text)

    def hal(self, name, value):
        subprocess.run([self.halcmd, 'setp', name, value], env=self.machine.env, check=False, capture_output=True)


class Rsh:
    """A connection of linuxcncrsh with its passwords."""

    def __init__(self, bench):
        out = bench.begin('ort', 'linuxcncrsh', '--port', '0', program=bench.machine.programs / 'linuxcncrsh')
        self.socket = socket.create_connection(('127.0.0.1', int(re.findall(r'(\d{4,})', out)[-1])), 10)
        self.file = self.socket.makefile('rw', newline='\r\n')
        self.say('hello EMC test 1.0', 'set enable EMCTOO', 'set timeout 5', 'set verbose on')

    def say(self, *lines):
        for line in lines:
            self.file.write(line + '\r\n')
            self.file.flush()
        time.sleep(0.3)

    def status(self):
        self.say('get machine')
        self.socket.settimeout(5)
        return b'MACHINE ON' in self.socket.recv(65536).upper()

    def stop(self):
        self.say('set abort')

    def mdi(self, line):
        self.say(f'set mdi {line}')

    def open(self, path):
        self.say(f'set open {path}')

    def run(self):
        self.say('set run')


class OverNml:
    """A client of `millwright nml` over TCP."""

    def __init__(self, bench):
        with socket.socket() as free:
            free.bind(('127.0.0.1', 0))
            port = free.getsockname()[1]
        file = bench.machine.write('m.nml', CHANNELS.format(port=port, key=100))
        bench.begin('are up', 'nml', file)
        self.client = Nml(port)

    def status(self):
        return bool(self.client.status())

    def stop(self):
        self.client.do('EMC_TASK_ABORT_TYPE', 503)

    def mdi(self, line):
        self.client.do('EMC_TASK_PLAN_EXECUTE_TYPE', 509, line=json.dumps(line))

    def open(self, path):
        self.client.do('EMC_TASK_PLAN_OPEN_TYPE', 506, path=json.dumps(str(path)))

    def run(self):
        self.client.do('EMC_TASK_PLAN_RUN_TYPE', 507, from_line=0)


class OtherUser:
    """A program of another local user that has all the names needed to find the machine."""

    def __init__(self, bench):
        self.bench = bench
        self.halcmd = bench.machine.programs / 'halcmd'

    def do(self, code):
        words = f'import linuxcnc; c, s = linuxcnc.command(), linuxcnc.stat(); {code}; c.wait_complete(2)'
        return self.bench.as_nobody([PYTHON, '-c', words]).returncode == 0

    def status(self):
        return self.do('s.poll()')

    def stop(self):
        self.do('c.abort()')

    def mdi(self, line):
        self.do(f'c.mdi({line!r})')

    def open(self, path):
        self.do(f'c.program_open({str(path)!r})')

    def run(self):
        self.do('c.auto(linuxcnc.AUTO_RUN, 1)')

    def add(self, name, text):
        self.bench.as_nobody([PYTHON, '-c', f'open({str(self.bench.machine.folder / "nc_files" / name)!r}, "w").write({text!r})'])

    def hal(self, name, value):
        self.bench.as_nobody([self.halcmd, 'setp', name, value])


class Bench:
    def __init__(self, machine):
        self.machine = machine
        self.started = []
        self.count = 0

    def begin(self, what, *words, program=None):
        """The output of a program after its start."""
        out = self.machine.folder / f'{len(self.started)}.out'
        with out.open('w') as file:
            process = subprocess.Popen([program or self.machine.programs / 'millwright', *(words if program is None else words[1:])],
                                       env=self.machine.env, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT)
        self.started.append(process)
        end = time.monotonic() + 20
        while what not in out.read_text() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        time.sleep(0.3)
        assert what in out.read_text(), out.read_text()
        return out.read_text()

    def as_nobody(self, words):
        return subprocess.run(words, env=self.machine.env, check=False, capture_output=True, user=NOBODY, group=NOBODY, extra_groups=[], timeout=30)

    def fresh(self, folder, name):
        """A path without a file."""
        self.count += 1
        return self.machine.folder / folder / f'{self.count}_{name}'

    def mode(self, mode):
        self.machine.command.abort()
        self.machine.command.wait_complete(5)
        self.machine.command.mode(mode)
        self.machine.command.wait_complete(5)
        self.machine.until(lambda: self.machine.stat.interp_state == self.machine.linuxcnc.INTERP_IDLE, 5)

    # One function for each row of the table: whether the client of the column succeeded.
    def status(self, client):
        return client.status()

    def stops(self, client):
        machine = self.machine
        self.mode(machine.linuxcnc.MODE_MDI)
        machine.command.mdi('G4 P20')
        assert machine.until(lambda: machine.stat.interp_state != machine.linuxcnc.INTERP_IDLE, 5)
        client.stop()
        return machine.until(lambda: machine.stat.interp_state == machine.linuxcnc.INTERP_IDLE, 2)

    def moves(self, client):
        machine = self.machine
        self.mode(machine.linuxcnc.MODE_MDI)
        self.count += 1
        x = 1 + self.count % 40
        client.mdi(f'G21 G90 G53 G0 X{x}')
        return machine.until(lambda: abs(machine.stat.position[0] - x) < 1e-3, 2)

    def opens(self, client, folder):
        self.mode(self.machine.linuxcnc.MODE_AUTO)
        path = self.fresh(folder, 'part.ngc')
        path.write_text('(root:secret) G21\nM2\n')
        client.open(path)
        return self.machine.until(lambda: self.machine.stat.file == str(path), 1)

    def opens_program(self, client):
        return self.opens(client, 'nc_files')

    def opens_other(self, client):
        return self.opens(client, 'configs')

    def logs(self, client, folder):
        self.mode(self.machine.linuxcnc.MODE_MDI)
        path = self.fresh(folder, 'log.txt')
        client.mdi(f'(LOGOPEN,{path})')
        return self.machine.until(path.exists, 1)

    def logs_there(self, client):
        return self.logs(client, 'nc_files')

    def logs_elsewhere(self, client):
        return self.logs(client, 'configs')

    def python(self, client):
        self.mode(self.machine.linuxcnc.MODE_MDI)
        path = self.fresh('.', 'python.txt')
        client.mdi(f";py,open('{path}', 'w')")
        by_line = self.machine.until(path.exists, 1)
        program = self.fresh('nc_files', 'python.ngc')
        program.write_text(f";py,open('{path}', 'w')\nM2\n")
        self.mode(self.machine.linuxcnc.MODE_AUTO)
        client.open(program)
        client.run()
        by_program = self.machine.until(path.exists, 1)
        expect(by_line == by_program, f'{type(client).__name__}: Python by a line and by a program alike')
        return by_line or by_program

    def adds(self, client):
        if not hasattr(client, 'add'):
            return None
        path = self.fresh('nc_files', 'made.py')
        client.add(path.name, 'print("M2")\n')
        return path.exists()

    def sets_hal(self, client):
        if not hasattr(client, 'hal'):
            return None
        self.count += 1
        client.hal('motion.analog-in-00', f'0.{self.count:03}1')
        value = subprocess.run([self.machine.programs / 'halcmd', 'getp', 'motion.analog-in-00'], env=self.machine.env, check=False,
                               capture_output=True, text=True).stdout
        return value.strip().startswith(f'0.{self.count:03}')

    def end(self):
        for process in reversed(self.started):
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


ROWS = {
    'read status and messages': Bench.status,
    'stop: abort, emergency stop, machine off, pause': Bench.stops,
    'jog, home, MDI, run programs, overrides, tool table': Bench.moves,
    'open a program of the program folder': Bench.opens_program,
    'open any other file': Bench.opens_other,
    'write a log of a program into the program folder': Bench.logs_there,
    'write a log into any other file': Bench.logs_elsewhere,
    'run Python by a line that begins with `;py,`': Bench.python,
    'add a file that a program of [FILTER] runs': Bench.adds,
    'set values of HAL': Bench.sets_hal,
}
COLUMNS = {
    'view': lambda bench: Web(bench, 'view'),
    'operate': lambda bench: Web(bench, 'operate'),
    'configure': lambda bench: Web(bench, 'configure'),
    "machine's user": Python,
    'linuxcncrsh, schedrmt': Rsh,
    'NML over TCP': OverNml,
    'other local user': OtherUser,
}


def table(root):
    """{(row, column): 'yes', 'no' or '-'} of docs/integrator/security.md."""
    text = (root / 'docs/integrator/security.md').read_text().split('## Who may do what')[1]
    lines = [[cell.strip() for cell in line.strip('|\n').split('|')] for line in text.splitlines() if line.startswith('|')]
    head, rows = lines[0], lines[2:]
    return {(row[0], column): cell for row in rows if len(row) == len(head) for column, cell in zip(head[1:], row[1:])}


def check_table(bench, root):
    said = table(root)
    expect({row for row, _ in said} == set(ROWS) and {column for _, column in said} == set(COLUMNS), 'the table has the rows and columns that are tested',
           {row for row, _ in said} ^ set(ROWS), {column for _, column in said} ^ set(COLUMNS))
    isRoot = os.geteuid() == 0
    for column, make in COLUMNS.items():
        if column == 'other local user' and (not isRoot or bench.as_nobody([PYTHON, '-c', 'import linuxcnc']).returncode != 0):
            print(f'not tested: {column}: needs root, and programs that all users may read')
            continue
        client = make(bench)
        for row, can in ROWS.items():
            answer = {True: 'yes', False: 'no', None: '-'}[can(bench, client)]
            bench.machine.collect()
            expect(answer == said.get((row, column)), f'{column}: {row}: {answer}, the table says {said.get((row, column))}', *bench.machine.messages[-2:])
            expect(column in ('configure', "machine's user") or not any('root:secret' in text for text in bench.machine.messages),
                   f'{column}: no line of a file outside is shown')
            bench.machine.messages.clear()


def check_no_overwriting(bench):
    """The role operate cannot overwrite files of the machine through the names of logs."""
    machine = bench.machine
    web = Web(bench, 'operate')
    bench.mode(machine.linuxcnc.MODE_MDI)
    programs = machine.folder / 'nc_files'
    (programs / 'part.ngc').write_text('M2\n')
    (programs / 'link.txt').symlink_to(machine.ini)
    (programs / 'M150').write_text('#!/bin/sh\n')
    (programs / 'M150').chmod(0o755)
    os.mkfifo(programs / 'pipe.txt')
    before = {path: path.read_bytes() for path in [machine.ini, programs / 'part.ngc', programs / 'M150']}
    for name in (machine.ini, 'part.ngc', 'link.txt', 'M150', 'pipe.txt', '.profile', '../configs/sim/mill_mm.ini', '/dev/null', '/proc/self/comm'):
        for word in ('LOGOPEN,', 'LOGAPPEND,', 'PROBEOPEN '):
            machine.messages.clear()
            web.mdi(f'({word}{name})')
            machine.until(lambda: machine.messages, 2)
            expect(any('operate' in text for text in machine.messages), f'({word}{name}) is rejected with a message', *machine.messages)
    expect(all(path.read_bytes() == text for path, text in before.items()), 'files of the machine are as they were')
    expect(not (programs / '.profile').exists(), 'no hidden file')


def check_modes(machine):
    """Files in shared folders are readable only by their user."""
    for path in pathlib.Path('/dev/shm').glob(f"*{machine.env['MILLWRIGHT_INSTANCE']}*"):
        mode = stat.S_IMODE(path.stat().st_mode)
        expect(mode & 0o077 == 0, f'{path} has mode {mode:o}')


def main():
    machine = Machine(sys.argv[1], sys.argv[2], 'rights', edit)
    bench = Bench(machine)
    try:
        machine.folder.chmod(0o755)
        (machine.folder / 'nc_files').mkdir()
        (machine.ini.parent / 'top.py').write_text('')
        machine.start()
        check_table(bench, pathlib.Path(sys.argv[2]))
        check_no_overwriting(bench)
        check_modes(machine)
    finally:
        bench.end()
        machine.clean()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
