# SPDX-License-Identifier: GPL-2.0-or-later
"""The definition of an attack, and the table of all attacks. An attack is a function of a scene and a random number generator."""
import dataclasses
import json
import os
import pathlib
import signal
import subprocess
import time

TABLE = {}


@dataclasses.dataclass(frozen=True)
class Attack:
    """`causes`: text of the message if the attack stops the machine, None: it must not stop it. `busy`: servers that cannot
    answer during the attack. `isHere`: runs in the process of the session. `needs`: 'mount', 'cgroup', 'user' (another user)."""
    name: str
    run: object
    causes: str | None = None
    busy: tuple = ()
    kills: tuple = ()
    isHere: bool = False
    isLast: bool = False     # the machine serves no further seeds
    stopsTask: bool = False  # aborts cannot be answered during the attack
    needs: tuple = ()
    weight: float = 1.0

    @property
    def isEnd(self):
        return self.name.startswith('end.')

    @property
    def isProgram(self):
        return self.name.startswith('program.')


def attack(name, **facts):
    """Enters a function into the table."""
    def enter(function):
        TABLE[name] = Attack(name, function, **facts)
        return function
    return enter


@dataclasses.dataclass
class Scene:
    """The addresses of servers, the processes and the files that attacks can reach."""
    ports: dict              # web, rsh, nml
    processes: dict          # task, realtime, web, rsh, nml: process numbers
    programs: pathlib.Path   # folder of the programs of millwright
    folder: pathlib.Path     # of the machine
    ini: pathlib.Path
    nc: pathlib.Path         # program folder
    env: dict
    deadline: float = 0.0    # all attacks end before this time
    cgroup: str = ''
    device: str = ''         # block device of the folder, MAJOR:MINOR
    terminal: object = None
    begin: float = 0.0
    end: float = 0.0

    def begins(self):
        """The attack takes effect from now on."""
        self.begin = time.monotonic()

    def ends(self):
        self.end = time.monotonic()

    def wait(self, seconds):
        """False when the time for attacks has ended."""
        time.sleep(max(0.0, min(seconds, self.deadline - time.monotonic())))
        return time.monotonic() < self.deadline


def carry_out(one, scene, rng):
    """Runs an attack and returns [begin, end, note]."""
    note = ''
    scene.begin, scene.end = time.monotonic(), 0.0
    try:
        one.run(scene, rng)
    except (OSError, ValueError, KeyError, subprocess.SubprocessError) as error:
        note = f'{type(error).__name__}: {error}'
    return [scene.begin, scene.end or time.monotonic(), note]


class Child:
    """An attack that starts at a given time in a separate process."""

    def __init__(self, one, scene, rng, at):
        self.one = one
        reader, writer = os.pipe()
        self.reader, self.pid = reader, os.fork()
        if self.pid == 0:
            status = 1
            try:
                os.setpgid(0, 0)
                os.dup2(writer, 3)
                os.closerange(4, 4096)
                time.sleep(max(0.0, at - time.monotonic()))
                answer = carry_out(one, scene, rng)
                os.write(3, json.dumps(answer).encode())
                status = 0
            finally:
                os._exit(status)
        os.close(writer)

    def result(self, deadline):
        """Returns [begin, end, note], and ends the processes that the attack has left."""
        isDone = False
        while not isDone and time.monotonic() < deadline:
            isDone = os.waitpid(self.pid, os.WNOHANG)[0] != 0
            time.sleep(0.005)
        try:
            os.killpg(self.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        if not isDone:
            os.waitpid(self.pid, 0)
        with open(self.reader, encoding='utf-8') as answer:
            text = answer.read()
        return json.loads(text) if text else None
