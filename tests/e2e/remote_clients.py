#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Python and Tcl clients of a machine on another computer (F9): they have an INI and an NML file whose process xemc is REMOTE,
and another instance name, so that they cannot use shared memory of the machine. Tests status, commands and their end, messages,
the tool table, a jog whose client is killed, a server that ends, a wrong port, and a program that is not an NML server.

usage: remote_clients.py MILLWRIGHT HALCMD ROOT PYTHON_FOLDER TCL_FOLDER
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

from mill_by_hand import STEP_S
from nml_session import FOUND, Bench

expect = FOUND.expect
BUFFERS = """B emcCommand SHMEM localhost 8192 0 0 1 16 {key}1 TCP={port} xdr queue confirm_write serial
B emcError SHMEM localhost 8192 0 0 3 16 {key}3 TCP={port} xdr queue
B emcStatus SHMEM localhost 20480 0 0 2 16 {key}2 TCP={port} xdr
"""
TOOLS = 'B emcTools SHMEM localhost 200000 0 0 4 16 {key}4 TCP={port} xdr\n'
MACHINE = """P emc emcCommand LOCAL localhost RW 0 1.0 0 0
P emc emcStatus LOCAL localhost W 0 1.0 0 0
P emc emcError LOCAL localhost W 0 1.0 0 0
P emc emcTools LOCAL localhost W 0 1.0 0 0
P emcsvr default LOCAL localhost RW 1 1.0 1 2
"""
CLIENT = """P xemc emcCommand REMOTE localhost W 0 10.0 0 10
P xemc emcStatus REMOTE localhost R 0 10.0 0 10
P xemc emcError REMOTE localhost R 0 10.0 0 10
"""
BEGIN = """import sys, time, linuxcnc
linuxcnc.nmlfile = sys.argv[1]
s, c, e = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
def must(condition, what):
    if not condition:
        s.poll()
        sys.exit(f'{what}: {s.state} {s.task_state} {s.task_mode} {s.position} {s.echo_serial_number} {c.serial} {e.poll()}')
def refused(act):
    try:
        act()
    except linuxcnc.error as error:
        return str(error)
    return ''
"""
OPERATE = BEGIN + """
for act in (lambda: c.state(linuxcnc.STATE_ESTOP_RESET), lambda: c.state(linuxcnc.STATE_ON), lambda: c.mode(linuxcnc.MODE_MANUAL)):
    act()
    must(c.wait_complete() == linuxcnc.RCS_DONE, 'switched on')
s.poll()
must(s.task_state == linuxcnc.STATE_ON and s.echo_serial_number == c.serial, 'the status shows the last command')
c.home(-1)
end = time.monotonic() + 30
while 0 in s.homed[:s.joints] and time.monotonic() < end:
    time.sleep(0.02)
    s.poll()
c.mode(linuxcnc.MODE_MDI)
must(c.wait_complete() == linuxcnc.RCS_DONE, 'MDI')
c.mdi('G21 G53 G0 X7.5')
must(c.wait_complete(30) == linuxcnc.RCS_DONE, 'moved')
s.poll()
must(abs(s.position[0] - 7.5) < 1e-6, 'at its target')
c.mdi('G1 X')
must(c.wait_complete() == linuxcnc.RCS_ERROR, 'a wrong line is an error')
end, line = time.monotonic() + 10, None
while line is None and time.monotonic() < end:
    line = e.poll()
    time.sleep(0.02)
must(line is not None and line[0] == linuxcnc.OPERATOR_ERROR, 'and its message comes')
must('another computer' in refused(lambda: s.ini_filename), 'the INI file is out of reach')
if len(sys.argv) > 2:
    must(any(tool.id == 1 for tool in s.tool_table), 'the tool table is there')
else:
    must('emcTools' in refused(lambda: s.tool_table), 'no tool table without its buffer')
print('operated')
"""
FIRST = BEGIN + "print(refused(s.poll))"
LOSE = BEGIN + """
s.poll()
print('polled', flush=True)
end, said = time.monotonic() + 20, ''
while not said and time.monotonic() < end:
    said = refused(s.poll)
    time.sleep(0.02)
print(said)
print(refused(lambda: c.mode(linuxcnc.MODE_MANUAL)))
"""
JOG = BEGIN + """
c.mode(linuxcnc.MODE_MANUAL)
c.wait_complete()
c.teleop_enable(0)
c.wait_complete()
c.jog(linuxcnc.JOG_CONTINUOUS, 1, 0, 2.0)
time.sleep(1.5)
print('jogs', flush=True)
time.sleep(60)
"""
TCL = """set auto_path [linsert $auto_path 0 [lindex $argv 1]]
package require Linuxcnc
emc_init -ini [lindex $argv 0]
emc_set_wait done
puts [emc_mode manual]
emc_mode mdi
puts [emc_mode]
emc_mdi G53 G0 X3
puts [emc_abs_cmd_pos X]
puts [emc_ini JOINTS KINS]
"""


class Computers(Bench):
    """The machine, and the computer of its clients."""

    def __init__(self, millwright, halcmd, root, python, tcl, folder):
        super().__init__(millwright, halcmd, root, folder)
        self.tcl = tcl
        self.there = dict(self.env, MILLWRIGHT_INSTANCE=f'there-{os.getpid()}', PYTHONPATH=python)
        for name in ('NMLFILE', 'INI_FILE_NAME'):
            self.there.pop(name, None)

    def channels(self, name, port, tools='', key=730):
        self.write('machine.nml', (BUFFERS + TOOLS).format(key=key, port=self.port) + MACHINE)
        line = 'P xemc emcTools REMOTE localhost R 0 10.0 0 10\n' if tools else ''
        self.write(name, (BUFFERS + tools).format(key=key, port=port) + CLIENT + line)
        return str(self.folder / name)

    def python(self, script, *words):
        return subprocess.run([sys.executable, '-c', script, *words], env=self.there, capture_output=True, text=True, check=False,
                              timeout=4 * STEP_S, stdin=subprocess.DEVNULL)

    def start_python(self, script, *words):
        return subprocess.Popen([sys.executable, '-c', script, *words], env=self.there, stdout=subprocess.PIPE, text=True)


def operate(bench):
    plain, tools = bench.channels('client.nml', bench.port), bench.channels('tools.nml', bench.port, TOOLS)
    done = bench.python("import linuxcnc\nlinuxcnc.stat().poll()")
    expect(done.returncode != 0, 'without an NML file there is no machine', done.stdout, done.stderr)
    for words in ((plain,), (tools, 'tools')):
        done = bench.python(OPERATE, *words)
        expect(done.returncode == 0 and done.stdout == 'operated\n', 'Python operates it', done.stdout, done.stderr)
    expect(bench.position() == 7.5, 'the machine is where Python sent it', bench.position())
    tclsh = shutil.which('tclsh')
    if tclsh is not None and bench.tcl:
        bench.write('operate.tcl', TCL)
        bench.write('client.ini', '[EMC]\nNML_FILE = client.nml\n[KINS]\nJOINTS = 3\n')
        done = subprocess.run([tclsh, bench.folder / 'operate.tcl', bench.folder / 'client.ini',
                               bench.tcl], env=bench.there, capture_output=True,
                              text=True, check=False, timeout=4 * STEP_S, stdin=subprocess.DEVNULL)
        lines = done.stdout.split()
        expect(lines == ['mdi', '3.0', '3'] and bench.position() == 3, 'Tcl operates it', done.stdout, done.stderr)
    return plain


def killed_jog(bench, path):
    """A network failure during a jog stops the jog."""
    with bench.start_python(JOG, path) as jogger:
        expect(jogger.stdout.readline() == 'jogs\n', 'it jogs, longer than one lease')
        before = bench.position()
        time.sleep(0.3)
        expect(bench.position() > before, 'and moves', before)
        os.kill(jogger.pid, signal.SIGKILL)
    deadline = time.monotonic() + STEP_S
    last = None
    while bench.position() != last and time.monotonic() < deadline:
        last = bench.position()
        time.sleep(0.7)
    expect(bench.position() == last, 'the jog ends with its client')


def lost_server(bench, path, server):
    with bench.start_python(LOSE, path) as client:
        expect(client.stdout.readline() == 'polled\n', 'it polls')
        server.terminate()
        server.wait(STEP_S)
        began = time.monotonic()
        said = client.stdout.readline()
        expect('is lost' in said and f'localhost:{bench.port}' in said, 'the lost connection is an error', said)
        again = client.stdout.readline()
        expect('refused' in again and f'localhost:{bench.port}' in again, 'a command is an error', again)
        expect(time.monotonic() - began < STEP_S, 'and nothing hangs')


def wrong_servers(bench):
    with socket.socket() as other:
        other.bind(('127.0.0.1', 0))
        other.listen()

        def greet():
            accepted = []
            while True:
                accepted.append(other.accept()[0])
                accepted[-1].sendall(b'SSH-2.0-OpenSSH_9.2 and more than a head of this protocol\r\n')

        threading.Thread(target=greet, daemon=True).start()
        done = bench.python(FIRST, bench.channels('ssh.nml', other.getsockname()[1]))
        expect("no message of Millwright's NML" in done.stdout, 'another program at the port is an error', done.stdout, done.stderr)
    done = bench.python(FIRST, str(bench.folder / 'absent.nml'))
    expect('absent.nml' in done.stdout, 'a file that is not there is an error', done.stdout, done.stderr)
    done = bench.python(BEGIN + 'print(refused(lambda: c.mode(1)), refused(e.poll), sep="|")', str(bench.folder / 'absent.nml'))
    expect(['absent.nml' in part for part in done.stdout.split('|')] == [True, True], 'for commands and messages, too', done.stdout, done.stderr)
    path = pathlib.Path(bench.channels('mixed.nml', bench.port))
    path.write_text(path.read_text().replace('xemc emcCommand REMOTE', 'xemc emcCommand LOCAL'))
    done = bench.python(FIRST, str(path))
    expect('LOCAL and REMOTE' in done.stdout, 'command and status of two machines are an error', done.stdout, done.stderr)


def main():
    with tempfile.TemporaryDirectory(prefix='mw_remote_') as folder:
        words = sys.argv[1:] + [''] * (6 - len(sys.argv))
        bench = Computers(*words, pathlib.Path(folder))
        try:
            bench.start_machine()
            path = bench.channels('client.nml', bench.port)
            server = bench.begin('are up', 'nml', str(bench.folder / 'machine.nml'))
            operate(bench)
            killed_jog(bench, path)
            wrong_servers(bench)
            lost_server(bench, path, server)
        finally:
            bench.end_all()
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
