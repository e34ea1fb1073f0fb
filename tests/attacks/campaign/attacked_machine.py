# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine with its servers, observers and files for the attack campaign."""
import json
import os
import pathlib
import pty
import re
import secrets
import select
import signal
import socket
import subprocess
import sys
import tempfile
import termios
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent.parent / 'e2e')]
from attack_types import Scene  # noqa: E402  pylint: disable=wrong-import-position
from nml_session import CHANNELS  # noqa: E402  pylint: disable=wrong-import-position
from rig import Machine  # noqa: E402  pylint: disable=wrong-import-position

MEMORY = pathlib.Path('/sys/fs/cgroup/memory')
SERVERS = ('web', 'rsh', 'nml')
ANSWER_S = 20
SAMPLER = """loadrt sampler cfg=fffb depth=16000
net observed-x joint.0.pos-cmd sampler.0.pin.0
net observed-y joint.1.pos-cmd sampler.0.pin.1
net observed-z joint.2.pos-cmd sampler.0.pin.2
net observed-enable motion.motion-enabled sampler.0.pin.3
addf sampler.0 servo-thread
"""


def edit(text):
    """The machine homes at once; its programs have a separate folder."""
    text = text.replace('HALFILE = spindle_sim.hal\n', 'HALFILE = spindle_sim.hal\nHALFILE = sampler.hal\n')
    text = text.replace('HOME_SEARCH_VEL = 50', 'HOME_SEARCH_VEL = 0').replace('HOME_LATCH_VEL = 5', 'HOME_LATCH_VEL = 0')
    text = text.replace('SUBROUTINE_PATH = ../../nc_files/lib', 'SUBROUTINE_PATH = ../../nc')
    return re.sub(r'^PROGRAM_PREFIX *=.*$', 'PROGRAM_PREFIX = ../../nc', text, flags=re.MULTILINE)


# Below the range from which the kernel takes the ports of clients. A client that connects to a port of that
# range before the server listens may be connected with itself, and the server then finds its port in use.
PORTS = range(20000, 32000)
PORT_LOCKS = []  # locked until this process ends


def free_port():
    """A port that neither another process nor another session of the campaign uses."""
    while True:
        port = secrets.choice(PORTS)
        lock = socket.socket(socket.AF_UNIX)
        try:
            lock.bind(f'\0millwright-attack-port-{port}')
            with socket.socket() as free:
                free.bind(('127.0.0.1', port))
        except OSError:
            lock.close()
            continue
        PORT_LOCKS.append(lock)
        return port


def processes_of(instance, part):
    """{number: name} of the processes that have inherited the instance and have this value of MW_ATTACK_PART."""
    found = {}
    words = {f'MILLWRIGHT_INSTANCE={instance}'.encode(), f'MW_ATTACK_PART={part}'.encode()}
    for folder in pathlib.Path('/proc').glob('[0-9]*'):
        try:
            if words <= set((folder / 'environ').read_bytes().split(b'\0')) and ') Z ' not in (folder / 'stat').read_text():
                found[int(folder.name)] = (folder / 'comm').read_text().strip()
        except OSError:
            pass
    return found


class Terminal:
    """The terminal of `millwright start` and the thread that reads this terminal."""

    def __init__(self):
        self.master, self.slave = pty.openpty()
        settings = termios.tcgetattr(self.slave)
        settings[3] &= ~termios.TOSTOP
        termios.tcsetattr(self.slave, termios.TCSANOW, settings)
        self.text, self.isRead, self.isOpen = b'', True, True
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        while self.isOpen:
            if not self.isRead:
                time.sleep(0.01)
            elif select.select([self.master], [], [], 0.05)[0]:
                try:
                    self.text = (self.text + os.read(self.master, 65536))[-500_000:]
                except OSError:
                    return

    def close(self):
        if self.isOpen:
            self.isOpen = False
            self.reader.join()
            os.close(self.master)
            os.close(self.slave)


class Helper:
    """A process that answers each request (one line) with one line of JSON."""

    def __init__(self, script, env, *words):
        self.process = subprocess.Popen([sys.executable, HERE / script, *map(str, words)], env=dict(env, MW_ATTACK_PART='observer'), stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        self.answer()

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f'{self.process.args[1].name} has ended with status {self.process.wait()}')
        return json.loads(line)

    def ask(self, request):
        self.process.stdin.write(request + '\n')
        self.process.stdin.flush()
        return self.answer()

    def end(self):
        try:
            self.process.communicate('quit\n', timeout=2)
        except (subprocess.TimeoutExpired, BrokenPipeError, ValueError):
            self.process.kill()
            self.process.wait()


class AttackedMachine(Machine):
    """`name`: name of the instance, with the number of this process."""

    def __init__(self, programs, root, name, device):
        self.device = device
        super().__init__(programs, root, name, edit)
        self.nc = self.folder / 'nc'
        self.temporary = self.folder / 'tmp'
        self.nc.mkdir()
        self.temporary.mkdir()
        self.env.update(TMPDIR=str(self.temporary), XDG_CONFIG_HOME=str(self.folder / 'config'), MW_ATTACK_PART='machine')
        self.instance = self.env['MILLWRIGHT_INSTANCE']
        self.ports = {server: free_port() for server in SERVERS}
        (self.ini.parent / 'sampler.hal').write_text(SAMPLER)
        self.write('m.nml', CHANNELS.format(port=self.ports['nml'], key=100))
        os.mkfifo(self.nc / 'pipe.ngc')
        (self.nc / 'loop.ngc').symlink_to('loop.ngc')
        (self.nc / 'large.ngc').write_text('(a large program)\n' * 100_000 + 'M2\n')
        (self.nc / 'slow.ngc').write_text('G21 G90 F1000\no1 repeat [100000]\nG1 X1 Y0.3\nG1 X0 Y0\no1 endrepeat\nM2\n')
        (self.nc / 'slip.ngc').write_text('G21 G90 F100\nG1 X1000000000000000\nM2\n')
        self.servers, self.terminal = {}, Terminal()
        self.cgroup = f'mw-{self.instance}'
        self.hasGroup = os.access(MEMORY, os.W_OK) and (MEMORY / 'memory.limit_in_bytes').exists() and os.geteuid() == 0
        if self.hasGroup:
            (MEMORY / self.cgroup).mkdir(exist_ok=True)  # left by a killed session with this process id
            (MEMORY / self.cgroup / 'memory.limit_in_bytes').write_text('-1')

    def enter_group(self):
        if self.hasGroup:
            (MEMORY / self.cgroup / 'cgroup.procs').write_text(str(os.getpid()))

    def begin(self):
        """Returns when the machine is on and homed, and its servers and observers are ready."""
        os.environ.pop('MW_ATTACK_PART', None)
        self.start(stdout=self.terminal.slave, stderr=self.terminal.slave, preexec_fn=self.enter_group)
        for server in SERVERS:
            self.begin_server(server)
        self.observer = Helper('observer.py', self.env, self.ports['web'])
        self.stopper = Helper('stopper.py', self.env, *self.ports.values())
        self.files = {path: path.read_bytes() for path in (self.ini, self.ini.parent / 'sampler.hal', self.nc / 'slow.ngc', self.nc / 'slip.ngc',
                                                           self.nc / 'large.ngc')}

    def output_of(self, server):
        return (self.folder / f'{server}.txt').read_text(errors='replace')

    def begin_server(self, server):
        words = {'web': [self.programs / 'millwright', 'ui', self.ini, '--port', self.ports['web']],
                 'rsh': [self.programs / 'linuxcncrsh', '--port', self.ports['rsh'], '--ipv4'],
                 'nml': [self.programs / 'millwright', 'nml', self.folder / 'm.nml']}[server]
        with (self.folder / f'{server}.txt').open('w') as out:
            self.servers[server] = subprocess.Popen(list(map(str, words)), env=self.env, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT,
                                                    preexec_fn=self.enter_group)
        end = time.monotonic() + ANSWER_S
        while time.monotonic() < end and self.servers[server].poll() is None:
            try:
                socket.create_connection(('127.0.0.1', self.ports[server]), 1).close()
                return
            except OSError:
                time.sleep(0.02)
        raise RuntimeError(f'{server} is not ready: ' + self.output_of(server))

    def scene(self):
        numbers = processes_of(self.instance, 'machine')
        realtime = next((number for number, name in numbers.items() if name == 'millwright-rt'), 0)
        processes = {'task': self.process.pid, 'realtime': realtime, **{server: process.pid for server, process in self.servers.items()}}
        return Scene(self.ports, processes, self.programs, self.folder, self.ini, self.nc, self.env, cgroup=self.cgroup if self.hasGroup else '',
                     device=self.device, terminal=self.terminal)

    def end_all(self, isSignalled=True):
        """Sends SIGTERM to start and to the server of screens. Returns the time until each process of the machine has ended, None if it has not."""
        self.observer.end()
        self.stopper.end()
        begin = time.monotonic()
        for process in (self.process, self.servers['web']):
            if isSignalled and process.poll() is None:
                process.send_signal(signal.SIGCONT)
                process.terminate()
        return self.wait_end(begin)

    def wait_end(self, begin, parts=None):
        """Seconds from `begin` until all processes with these numbers have ended."""
        while time.monotonic() - begin < 5:
            # A process loses its environment before it has an exit status. A process of this program has ended when it has a status.
            own = [process.poll() for process in (self.process, *self.servers.values())]
            left = processes_of(self.instance, 'machine')
            if not (left or None in own if parts is None else set(parts) & set(left)):
                return time.monotonic() - begin
            time.sleep(0.01)
        return None

    def kill_all(self):
        """At the end of a campaign that failed, ends all processes and removes their shared memory."""
        for part in ('machine', 'observer'):
            for number in processes_of(self.instance, part):
                try:
                    os.kill(number, signal.SIGKILL)
                except ProcessLookupError:
                    pass
        for process in (self.process, *self.servers.values()):
            if process is not None:
                process.wait()
        if self.hasGroup:
            for _ in range(50):
                try:
                    (MEMORY / self.cgroup).rmdir()
                    break
                except OSError:
                    time.sleep(0.02)
        for path in pathlib.Path('/dev/shm').glob(f'*{self.instance}*'):
            path.unlink(missing_ok=True)
        self.terminal.close()


def temporary_names(instance):
    """Names that contain the instance, in the folders that all programs share and in the kernel's list of sockets."""
    found = [str(path) for folder in ('/dev/shm', '/tmp', f'/tmp/millwright-{os.geteuid()}', '/run', f'/run/user/{os.geteuid()}')
             if os.path.isdir(folder) for path in pathlib.Path(folder).iterdir() if instance in path.name]
    sockets = [line.split()[-1] for line in pathlib.Path('/proc/net/unix').read_text().splitlines() if instance in line]
    return found + sockets


def folder_of_machines():
    """The folder in which tempfile creates the folders of machines."""
    return tempfile.gettempdir()
