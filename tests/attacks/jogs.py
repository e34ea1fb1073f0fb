#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Clients that jog are killed, suspended or ended; with NML their connection is closed. The jog must end within 0.3 s, with a
message. The jog of a client that is alive but idle continues.

usage: jogs.py BIN_FOLDER ROOT
"""
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from mill_by_hand import Findings  # noqa: E402  pylint: disable=wrong-import-position
from nml_session import CHANNELS, Client as Nml  # noqa: E402  pylint: disable=wrong-import-position
from rig import Machine  # noqa: E402  pylint: disable=wrong-import-position

END_S = 0.3    # the limit in docs/integrator/security.md
SPEED = 4.0    # slow enough that no limit ends the jog in this test
FOUND = Findings()
expect = FOUND.expect
JOG = f"""import linuxcnc, sys, time
c = linuxcnc.command()
c.jog(linuxcnc.JOG_CONTINUOUS, 0, 0, {SPEED})
c.wait_complete()
print('jogs', flush=True)
time.sleep(float(sys.argv[1]))
"""


def isMoving(machine):
    machine.stat.poll()
    return abs(machine.stat.axis[0]['velocity']) > 1e-6


def to_start(machine):
    """Moves X to a position with clearance for every jog of this test."""
    machine.command.jog(machine.linuxcnc.JOG_STOP, 0, 0)
    machine.command.wait_complete()
    machine.until(lambda: not isMoving(machine), 2)
    machine.messages.clear()
    machine.command.mode(machine.linuxcnc.MODE_MDI)
    machine.command.wait_complete()
    machine.command.mdi('G53 G0 X5')
    machine.command.wait_complete(10)
    machine.command.mode(machine.linuxcnc.MODE_MANUAL)
    machine.command.wait_complete()
    machine.command.teleop_enable(1)
    machine.command.wait_complete()


def jogger(machine, seconds):
    process = subprocess.Popen([sys.executable, '-c', JOG, str(seconds)], env=machine.env, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == 'jogs\n'
    assert machine.until(lambda: isMoving(machine), 2), machine.messages
    return process


def ends(machine, what, message):
    begin = time.monotonic()
    isStopped = machine.until(lambda: not isMoving(machine), 3)
    took = time.monotonic() - begin
    machine.until(lambda: any(message in text for text in machine.messages), 0.5)
    expect(isStopped and took < END_S, f'{what}: the jog ends, after {took:.3f} s')
    expect(any(message in text for text in machine.messages), f'{what}: a message says why', *machine.messages)
    expect(machine.stat.task_state == machine.linuxcnc.STATE_ON, f'{what}: the machine stays on')


def local_clients(machine):
    for what, blow, message in (('killed', signal.SIGKILL, 'has ended'), ('suspended', signal.SIGSTOP, 'is suspended')):
        to_start(machine)
        process = jogger(machine, 60)
        process.send_signal(blow)
        ends(machine, f'a client that is {what}', message)
        process.kill()
        process.wait()
    to_start(machine)
    process = jogger(machine, 0.3)
    process.wait()
    ends(machine, 'a client that ends by itself', 'has ended')


def living_client(machine):
    to_start(machine)
    process = jogger(machine, 60)
    stayed = not machine.until(lambda: not isMoving(machine), 10)
    expect(stayed, 'a client that lives and sleeps for 10 s jogs on')
    machine.command.jog(machine.linuxcnc.JOG_STOP, 0, 0)
    machine.command.wait_complete()
    expect(machine.until(lambda: not isMoving(machine), 2), 'another client stops it')
    process.kill()
    process.wait()
    machine.until(lambda: False, 0.5)
    expect(not machine.messages, 'the end of a client whose jog was stopped is no news', *machine.messages)


def other_takes_over(machine):
    """The client that began a jog last owns it."""
    to_start(machine)
    process = jogger(machine, 60)
    machine.command.jog(machine.linuxcnc.JOG_CONTINUOUS, 0, 0, SPEED)
    machine.command.wait_complete()
    process.kill()
    process.wait()
    expect(not machine.until(lambda: not isMoving(machine), 1), 'a jog that a living client has taken over continues')
    machine.command.jog(machine.linuxcnc.JOG_STOP, 0, 0)
    machine.command.wait_complete()


def over_nml(machine):
    """A client like those of LinuxCNC sends the jog and does not renew a lease."""
    to_start(machine)
    with socket.socket() as free:
        free.bind(('127.0.0.1', 0))
        port = free.getsockname()[1]
    with (machine.folder / 'nml.txt').open('w') as out:
        server = subprocess.Popen([machine.programs / 'millwright', 'nml', machine.write('m.nml', CHANNELS.format(port=port, key=100))],
                                  env=machine.env, stdout=out, stderr=subprocess.STDOUT)
    try:
        end = time.monotonic() + 10
        while 'are up' not in (machine.folder / 'nml.txt').read_text() and time.monotonic() < end:
            time.sleep(0.05)
        client, other = Nml(port), Nml(port)
        client.send('EMC_JOG_CONT_TYPE', 124, is_joint=0, index=0, velocity=SPEED, lease_ms=0, is_renewal=0)
        assert machine.until(lambda: isMoving(machine), 2), machine.messages
        other.socket.close()
        expect(not machine.until(lambda: not isMoving(machine), 1), 'the end of another connection stops nothing')
        client.socket.close()
        begin = time.monotonic()
        isStopped = machine.until(lambda: not isMoving(machine), 3)
        took = time.monotonic() - begin
        expect(isStopped and took < END_S, f'a connection that is closed: the jog ends, after {took:.3f} s')
        to_start(machine)
        client = Nml(port)
        client.send('EMC_JOG_CONT_TYPE', 124, is_joint=0, index=0, velocity=SPEED, lease_ms=0, is_renewal=0)
        assert machine.until(lambda: isMoving(machine), 2), machine.messages
        server.kill()
        ends(machine, 'the NML server is killed', 'has ended')
    finally:
        server.kill()
        server.wait()


def main():
    machine = Machine(sys.argv[1], sys.argv[2], 'jogs')
    try:
        machine.start()
        local_clients(machine)
        living_client(machine)
        other_takes_over(machine)
        over_nml(machine)
    finally:
        machine.clean()
    return FOUND.status()


if __name__ == '__main__':
    os.environ['PYTHONUNBUFFERED'] = '1'
    sys.exit(main())
