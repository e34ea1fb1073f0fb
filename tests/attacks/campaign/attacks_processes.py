# SPDX-License-Identifier: GPL-2.0-or-later
"""Signals, Python clients that die, terminals, and shortage of memory, processor time and descriptors."""
import contextlib
import os
import pathlib
import resource
import signal
import subprocess
import sys
import termios
import time

from attack_types import attack

GROUPS = pathlib.Path('/sys/fs/cgroup')
STOPPED_TASK = r'task.* did not run|task.*watchdog'
STOPPED_MOTION = r'motion \(millwright-rt\) (did not run|has given no sign)|has given no sign'


def stop_for(scene, process, seconds):
    scene.begins()
    os.kill(process, signal.SIGSTOP)
    try:
        time.sleep(seconds)
    finally:
        os.kill(process, signal.SIGCONT)
        scene.ends()


@attack('signal.stop_task', causes=STOPPED_TASK, stopsTask=True, weight=2)
def stop_task(scene, rng):
    stop_for(scene, scene.processes['task'], rng.choice((rng.uniform(0.02, 0.4), rng.uniform(0.4, 1.2))))


@attack('signal.stop_motion', causes=STOPPED_MOTION, weight=2)
def stop_motion(scene, rng):
    stop_for(scene, scene.processes['realtime'], rng.choice((rng.uniform(0.02, 0.2), rng.uniform(0.2, 1.2))))


def server_attack(server):
    @attack(f'signal.stop_{server}', busy=(server,), weight=0.7)
    def stop(scene, rng):
        stop_for(scene, scene.processes[server], rng.uniform(0.1, 1.5))

    @attack(f'signal.kill_{server}', busy=(server,), kills=(server,), weight=0.7)
    def kill(scene, _rng):
        os.kill(scene.processes[server], signal.SIGKILL)
    return stop, kill


for _server in ('web', 'rsh', 'nml'):
    server_attack(_server)


@attack('signal.harmless')
def harmless(scene, rng):
    """Signals without an effect."""
    while scene.wait(0.02):
        name = rng.choice(list(scene.processes))
        with contextlib.suppress(ProcessLookupError):
            os.kill(scene.processes[name], rng.choice((signal.SIGCONT, signal.SIGWINCH, signal.SIGCHLD, signal.SIGURG, signal.SIGPIPE)))


def end_attack(name, number, process, causes):
    @attack(f'end.{name}', causes=causes, weight=0.25)
    def end(scene, _rng):
        os.kill(scene.processes[process], number)
    return end


for _name in ('TERM', 'HUP', 'INT', 'QUIT'):
    end_attack(_name.lower(), getattr(signal, f'SIG{_name}'), 'task', f'SIG{_name}')
end_attack('kill_task', signal.SIGKILL, 'task', None)
end_attack('kill_motion', signal.SIGKILL, 'realtime', r'millwright-rt|realtime|motion')


@attack('python.died', causes=None)
def python_died(scene, rng):
    """Clients that are killed or suspended during their work."""
    code = ('import linuxcnc, os, signal, sys, time\nc, s, e = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()\n'
            'many = [linuxcnc.command() for _ in range(int(sys.argv[1]))]\nprint("up", flush=True)\n'
            'while True:\n    c.debug(0); s.poll(); e.poll()\n    [m.debug(0) for m in many]\n')
    clients = []
    try:
        for _ in range(rng.randrange(1, 3)):
            clients.append(subprocess.Popen([sys.executable, '-c', code, str(rng.randrange(8))], env=scene.env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL))
        for client in clients:
            client.stdout.readline()
        scene.begins()
        scene.wait(rng.uniform(0, 0.3))
        for client in clients:
            client.send_signal(rng.choice((signal.SIGKILL, signal.SIGSTOP)))
        scene.wait(0.5)
    finally:
        for client in clients:
            client.kill()
            client.wait()


@attack('python.commands')
def python_commands(scene, rng):
    """Sends commands that a machine rejects while it is cutting, and messages, as fast as they are accepted."""
    code = ('import linuxcnc, random, sys, time\nrng = random.Random(int(sys.argv[1]))\nc = linuxcnc.command()\nend = time.monotonic() + float(sys.argv[2])\n'
            'odd = "#1=[" + "1+" * 100 + "1]"\n'
            'acts = [lambda: c.mdi("G0 X5"), lambda: c.mdi(odd), lambda: c.mdi("(LOGOPEN,/dev/ptmx)"), lambda: c.jog(linuxcnc.JOG_CONTINUOUS, 1, 0, 5.0),\n'
            '        lambda: c.jog(linuxcnc.JOG_INCREMENT, 1, 1, 5.0, 1.0), lambda: c.home(-1), lambda: c.program_open("/dev/zero"),\n'
            '        lambda: c.load_tool_table(), lambda: c.debug(0), lambda: c.display_msg("x" * 200), lambda: c.auto(linuxcnc.AUTO_RUN, 5),\n'
            '        lambda: c.mdi(";py,import os; os._exit(0)")]\n'
            'while time.monotonic() < end:\n    try:\n        rng.choice(acts)()\n    except linuxcnc.error:\n        pass\n    time.sleep(rng.choice((0, 0.01)))\n')
    seconds = max(0.1, scene.deadline - time.monotonic() - 0.2)
    subprocess.run([sys.executable, '-c', code, str(rng.randrange(1 << 30)), str(seconds)], env=scene.env, check=False, capture_output=True, timeout=seconds + 5)


@attack('terminal.stopped', isHere=True)
def terminal_stopped(scene, rng):
    """Ctrl-S, then Ctrl-Q."""
    termios.tcflow(scene.terminal.slave, termios.TCOOFF)
    try:
        scene.begins()
        scene.wait(rng.uniform(0.2, 1.5))
    finally:
        termios.tcflow(scene.terminal.slave, termios.TCOON)
        scene.ends()


@attack('terminal.unread', isHere=True)
def terminal_unread(scene, rng):
    scene.terminal.isRead = False
    scene.begins()
    scene.wait(rng.uniform(0.2, 1.5))
    scene.terminal.isRead = True
    scene.ends()


@attack('terminal.closed', isHere=True, isLast=True, weight=0.3)
def terminal_closed(scene, _rng):
    """The window is closed: the output is no longer read."""
    scene.terminal.close()


def hogs(scene, rng, code, words, group, limits):
    """Programs in a cgroup with limits run until the time of attacks is over."""
    folder = GROUPS / group / f'{scene.cgroup}-{os.getpid()}'
    started = []
    folder.mkdir()
    try:
        for name, value in limits.items():
            (folder / name).write_text(str(value))
        for _ in range(words):
            started.append(subprocess.Popen([sys.executable, '-c', code], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                            preexec_fn=lambda: (folder / 'cgroup.procs').write_text(str(os.getpid()))))
        scene.begins()
        scene.wait(rng.uniform(0.3, 1.5))
    finally:
        for process in started:
            process.kill()
            process.wait()
        scene.ends()
        with contextlib.suppress(OSError):
            time.sleep(0.02)
            folder.rmdir()


@attack('pressure.cpu', causes=r'did not run for .*other programs|too busy', needs=('cgroup',))
def cpu(scene, rng):
    hogs(scene, rng, 'while True: pass', rng.randrange(2, 6), 'cpu', {'cpu.cfs_quota_us': 150_000})


@attack('pressure.memory', kills=('web',), busy=('web',), needs=('cgroup',))
def memory(scene, rng):
    """The machine and a program that allocates all memory share a cgroup with 200 MB more than the machine uses."""
    group = GROUPS / 'memory' / scene.cgroup
    used = int((group / 'memory.usage_in_bytes').read_text())
    code = f'import time\nb = []\nwhile True:\n    b.append(bytearray({rng.choice((1, 8))} << 20)); time.sleep(0.001)'
    (group / 'memory.limit_in_bytes').write_text(str(used + (200 << 20)))
    hog = None
    try:
        scene.begins()
        hog = subprocess.Popen([sys.executable, '-c', code], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               preexec_fn=lambda: (group / 'cgroup.procs').write_text(str(os.getpid())))
        scene.wait(rng.uniform(0.3, 1))
    finally:
        if hog is not None:
            hog.kill()
            hog.wait()
        (group / 'memory.limit_in_bytes').write_text('-1')
        scene.ends()


@attack('pressure.descriptors')
def descriptors(scene, rng):
    """The task, or the server of screens, has no free descriptor."""
    process = scene.processes[rng.choice(('task', 'web'))]
    used = len(os.listdir(f'/proc/{process}/fd'))
    soft, hard = resource.prlimit(process, resource.RLIMIT_NOFILE)
    resource.prlimit(process, resource.RLIMIT_NOFILE, (used + rng.choice((0, 3, 40)), hard))
    try:
        scene.begins()
        scene.wait(rng.uniform(0.2, 1.2))
    finally:
        resource.prlimit(process, resource.RLIMIT_NOFILE, (soft, hard))
        scene.ends()
