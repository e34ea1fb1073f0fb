# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine that is attacked while it cuts: a copy of configs/sim/mill_mm.ini in realtime as a separate instance, with a client
of Python's linuxcnc."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ABORT_S = 0.1   # maximum time until an abort is answered
END_S = 2.0     # maximum time from SIGTERM until every process has ended
UP_S = 20


class Machine:
    """`programs`: the folder of millwright. One machine per process, because linuxcnc looks for its instance when it is imported."""

    def __init__(self, programs, root, name, edit=lambda text: text):
        self.programs = pathlib.Path(programs).resolve()
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix=f'mw_{name}_'))
        shutil.copytree(pathlib.Path(root) / 'configs', self.folder / 'configs', ignore=shutil.ignore_patterns('*.var', '*.journal*'))
        self.ini = self.folder / 'configs/sim/mill_mm.ini'
        self.ini.write_text(edit(self.ini.read_text()))
        self.env = dict(os.environ, MILLWRIGHT_INSTANCE=f'{name}-{os.getpid()}', HOME=str(self.folder), LANG='C.UTF-8',
                        PATH=f"{self.programs}:{os.environ['PATH']}", PYTHONPATH=str(self.programs.parent / 'lib/python'))
        os.environ.update(self.env)
        sys.path.insert(0, str(self.programs.parent / 'lib/python'))
        self.process = self.linuxcnc = None
        self.messages = []

    def start(self, *words, stdout=None, stderr=subprocess.STDOUT, **more):
        """Starts the machine, switches it on and homes it."""
        with (self.folder / 'out.txt').open('w') as out:
            self.process = subprocess.Popen([self.programs / 'millwright', 'start', self.ini, '--no-display', *words], env=self.env,
                                            stdin=subprocess.DEVNULL, stdout=out if stdout is None else stdout, stderr=stderr, **more)
        import linuxcnc  # pylint: disable=import-outside-toplevel
        self.linuxcnc = linuxcnc
        end = time.monotonic() + UP_S
        while True:
            try:
                self.stat, self.command, self.errors = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
                self.stat.poll()
                break
            except linuxcnc.error:
                assert self.process.poll() is None and time.monotonic() < end, self.text()
                time.sleep(0.05)
        self.command.state(linuxcnc.STATE_ESTOP_RESET)
        self.command.wait_complete()
        self.command.state(linuxcnc.STATE_ON)
        self.command.wait_complete()
        self.command.mode(linuxcnc.MODE_MANUAL)
        self.command.home(-1)
        assert self.until(lambda: all(self.stat.homed[:3]), 30), 'it is homed'

    def text(self):
        return (self.folder / 'out.txt').read_text(errors='replace')

    def until(self, condition, seconds):
        """Polls the status until `condition` holds, and collects the messages."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.stat.poll()
            self.collect()
            if condition():
                return True
            time.sleep(0.01)
        return False

    def collect(self):
        while message := self.errors.poll():
            self.messages.append(message[1])

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def open(self, path):
        self.command.mode(self.linuxcnc.MODE_AUTO)
        self.command.wait_complete()
        self.command.program_open(str(path))
        return self.command.wait_complete(10)

    def cut(self, text='G21 G90 G61 F600\nM3 S500\nM8\no1 repeat [2000]\n(MSG, next part)\nG1 X20\nG1 X0\no1 endrepeat\nM2\n'):
        """Starts to cut and waits until the axes move."""
        assert self.open(self.write('cut.ngc', text)) == self.linuxcnc.RCS_DONE, self.messages
        self.command.auto(self.linuxcnc.AUTO_RUN, 1)
        assert self.until(lambda: self.stat.current_vel > 0, 30), (self.messages, self.stat.interp_state)

    def run(self, text):
        """Runs a program to its end, or to the error that ends it; False if neither happens within 10 s."""
        self.messages.clear()
        assert self.open(self.write('run.ngc', text)) == self.linuxcnc.RCS_DONE, self.messages
        self.command.auto(self.linuxcnc.AUTO_RUN, 1)
        self.command.wait_complete(10)
        return self.until(lambda: self.stat.interp_state == self.linuxcnc.INTERP_IDLE, 10)

    def cuts_on(self, seconds):
        """Whether the machine moves and stays on for this time."""
        end = time.monotonic() + seconds
        moved = False
        while time.monotonic() < end:
            self.stat.poll()
            self.collect()
            moved = moved or self.stat.current_vel > 0
            if self.stat.task_state != self.linuxcnc.STATE_ON:
                return False
            time.sleep(0.02)
        return moved

    def abort_s(self, seconds=5):
        """Time until the status shows that an abort has been carried out. Then waits until the axes have stopped."""
        begin = time.monotonic()
        self.command.abort()
        took = time.monotonic() - begin
        return took if self.command.wait_complete(seconds) == self.linuxcnc.RCS_DONE else float('inf')

    def end_s(self):
        """Time from SIGTERM to the end of the machine; a machine that does not end in time is killed."""
        begin = time.monotonic()
        self.process.terminate()
        try:
            self.process.wait(END_S + 3)
            return time.monotonic() - begin
        except subprocess.TimeoutExpired:
            self.process.send_signal(signal.SIGKILL)
            self.process.wait()
            return float('inf')

    def clean(self):
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
            self.process.wait()
        for path in pathlib.Path('/dev/shm').glob(f"*{self.env['MILLWRIGHT_INSTANCE']}*"):
            path.unlink(missing_ok=True)  # left by a machine that was killed
        shutil.rmtree(self.folder, ignore_errors=True)


def with_python(text):
    """The text of an INI file whose programs may run Python."""
    return text + '\n[PYTHON]\nTOPLEVEL = toplevel.py\nPATH_PREPEND = .\n'


def prepare_python(machine):
    (machine.ini.parent / 'toplevel.py').write_text('')


def run_attacks(script, attacks, prepare=lambda machine: None, edit=lambda text: text):
    """The main program of an attack file. Runs each attack with a separate machine and process, because linuxcnc can be imported
    only once per process. `attacks`: functions of a machine and its findings, by name. Exits with the status."""
    from mill_by_hand import Findings  # pylint: disable=import-outside-toplevel
    if len(sys.argv) <= 3:
        sys.exit(max(subprocess.run([sys.executable, script, *sys.argv[1:3], name], check=False).returncode for name in attacks))
    found = Findings()
    name = sys.argv[3]
    machine = Machine(sys.argv[1], sys.argv[2], f'{pathlib.Path(script).stem}-{name}', edit)
    try:
        prepare(machine)
        machine.start()
        attacks[name](machine, found)
    finally:
        machine.clean()
    sys.exit(found.status())
