#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests the MTConnect agent of `millwright publish` for a running mill: the form of every document (mtconnect_forms.py), values
equal to those of HAL, interrupted and continued streams, clients that do not read, and the end of the machine.

usage: publish_mtconnect.py MILLWRIGHT HALCMD ROOT
"""
import http.client
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as tree

import mtconnect_forms
from mill_by_hand import Findings, Mill
from publish_shop import wait_for

FOUND = Findings()
expect = FOUND.expect
SECTION = '\n[PUBLISH]\nDEVICE = Mill 1\nMTCONNECT_PORT = 0\nINTERVAL = 0.05\nMTCONNECT_BUFFER = 2000\n'


class Agent:
    def __init__(self, port):
        self.port, self.documents = port, 0

    def check(self, text, what):
        problems = mtconnect_forms.problems_of(text)
        expect(not problems, f'the document of {what} is right', *problems[:5], text[:2000])
        self.documents += 1
        return text

    def get(self, path, status=200, method='GET'):
        connection = http.client.HTTPConnection('127.0.0.1', self.port, timeout=20)
        connection.request(method, path)
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        expect(answer.status == status, f'{path} has the status {status}', answer.status)
        return self.check(text, path) if method == 'GET' else text

    def value(self, item):
        return self.values().get(item)

    def values(self, path='/current'):
        root = tree.fromstring(self.get(path))
        return {one.get('dataItemId'): (one.text or one.tag.split('}')[1]) for one in root.iter() if one.get('dataItemId')}

    def header(self, path='/current'):
        return {name: int(value) for name, value in re.findall(r'(\w+(?:Sequence|Id))="(\d+)"', self.get(path))}


class StreamOfParts:
    """A request with interval=, read in parts."""

    def __init__(self, agent, path):
        self.agent, self.path = agent, path
        self.connection = http.client.HTTPConnection('127.0.0.1', agent.port, timeout=20)
        self.connection.request('GET', path)
        self.answer = self.connection.getresponse()
        self.boundary = re.search(r'multipart/x-mixed-replace;\s*boundary=(\S+)', self.answer.getheader('Content-Type'))[1]

    def next(self):
        line = self.answer.readline().decode().strip()
        expect(line == '--' + self.boundary, 'a part begins with its boundary', line)
        fields = {}
        while line := self.answer.readline().decode().strip():
            name, value = line.split(':', 1)
            fields[name.lower()] = value.strip()
        text = self.answer.read(int(fields['content-length'])).decode()
        self.answer.read(2)
        return self.agent.check(text, f'the stream {self.path}')

    def cut(self):
        self.connection.close()


def sequences(text):
    return [int(one) for one in re.findall(r' sequence="(\d+)"', text)]


def jog(mill, pin, seconds):
    mill.set_pin(pin, '1')
    time.sleep(seconds)
    mill.set_pin(pin, '0')


def check_requests(agent):
    probe = agent.get('/probe')
    ids = re.findall(r'<DataItem [^>]*id="(\w+)"', probe)
    expect(set(agent.values()) == set(ids), 'current has each data item of the probe')
    for path in ('/', '/Mill%201', '/Mill%201/probe', '/Mill%201/current', '/Mill%201/sample', '/sample', '/assets', '/asset/tool-1',
                 '/sample?count=5', '/sample?count=-5', '/current?path=//Axes', '/sample?path=//DataItem%5B@type=%22POSITION%22%5D',
                 '/assets?count=2&type=CuttingTool', '/assets?removed=true'):
        agent.get(path)
    for path, status in (('/nothing', 404), ('/Mill%201/x', 404), ('/current?at=0', 404), ('/sample?from=9999999', 404), ('/sample?count=0', 404),
                         ('/current?path=//%5B', 400), ('/asset/none', 404), ('/sample?interval=x', 400), ('/current?at=1&interval=5', 400)):
        agent.get(path, status)
    agent.get('/probe', 405, 'POST')
    agent.get('/current', 405, 'PUT')
    expect(len(re.findall('<CuttingTool ', agent.get('/assets'))) == 6, 'each tool of the table is an asset')


def check_values(agent, mill):
    for pin in ('halui.estop.reset', 'halui.machine.on', 'halui.home-all'):
        jog(mill, pin, 0.3)
    wait_for(lambda: all(mill.pin(f'halui.joint.{i}.is-homed') == 'TRUE' for i in range(3)), 'the machine is homed')
    wait_for(lambda: agent.value('controller_emergency_stop') == 'ARMED', 'the emergency stop is reset')
    mill.set_pin('halui.mode.manual', '1')
    wait_for(lambda: mill.pin('halui.mode.is-manual') == 'TRUE', 'manual mode')
    jog(mill, 'halui.mode.teleop', 0.3)
    wait_for(lambda: mill.pin('halui.mode.is-teleop') == 'TRUE', 'axes are jogged')
    mill.set_pin('halui.axis.jog-speed', '600')
    jog(mill, 'halui.axis.x.plus', 0.5)
    wait_for(lambda: abs(float(agent.value('axis_x_position_actual')) - mill.position()) < 0.01 and mill.position() > 1, 'the position of HAL')


def check_streams(agent, mill):
    start = agent.header()['nextSequence']
    stream = StreamOfParts(agent, f'/sample?interval=50&heartbeat=300&from={start}')
    first = stream.next()
    expect('<ComponentStream' not in first, 'a sign of life without news')
    jog(mill, 'halui.axis.x.plus', 0.5)
    seen = []
    while len(seen) < 10:
        seen += sequences(stream.next())
    stream.cut()
    jog(mill, 'halui.axis.x.minus', 0.5)
    # A client that lost its connection continues after the last observation that it has received.
    again = StreamOfParts(agent, f'/sample?interval=50&heartbeat=300&count=1000&from={max(seen) + 1}')
    last = agent.header()['lastSequence']
    while max(seen) < last:
        seen += sequences(again.next())
    expect(sorted(seen) == list(range(start, max(seen) + 1)), 'no observation is missing or twice over a cut connection')
    again.cut()
    states = StreamOfParts(agent, '/current?interval=50')
    expect(len(sequences(states.next())) == len(sequences(states.next())) > 20, 'states again and again')
    states.cut()


def check_clients_that_do_not_read(agent, mill):
    """Such clients slow down neither the machine nor other clients."""
    idle = []
    for _ in range(8):
        client = socket.create_connection(('127.0.0.1', agent.port))
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        client.sendall(b'GET /current?interval=0 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n')
        idle.append(client)
    half = socket.create_connection(('127.0.0.1', agent.port))
    half.sendall(b'GET /probe HTTP/1.1\r\nHo')
    start = mill.position()
    jog(mill, 'halui.axis.x.plus', 0.5)
    expect(mill.position() - start > 1, 'the machine moves')
    longest = 0
    for _ in range(20):
        began = time.monotonic()
        agent.get('/current')
        longest = max(longest, time.monotonic() - began)
    print(f'longest answer beside 8 clients that do not read: {longest * 1000:.0f} ms')
    for client in (*idle, half):
        client.close()


def main():
    millwright, halcmd, root = sys.argv[1:]
    expect(mtconnect_forms.self_test(), 'the check of documents finds wrong ones')
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mill = Mill(millwright, halcmd, root, folder, 'mtconnect')
        mill.ini.write_text(mill.ini.read_text() + SECTION)
        publisher = subprocess.Popen([millwright, 'publish', str(mill.ini)], env=mill.env, stdout=subprocess.PIPE, text=True)
        agent = Agent(int(publisher.stdout.readline().rsplit(' ', 1)[1]))
        machine = None
        try:
            expect(agent.value('device_availability') == 'UNAVAILABLE', 'no machine')
            before = agent.header('/probe')['instanceId']
            machine = subprocess.Popen([millwright, 'start', '--no-display', str(mill.ini)], env=mill.env, stdout=subprocess.DEVNULL)
            wait_for(lambda: agent.value('device_availability') == 'AVAILABLE', 'the machine is there')
            expect(agent.header('/probe')['instanceId'] > before, 'a machine with other data items is another instance')
            check_requests(agent)
            check_values(agent, mill)
            check_streams(agent, mill)
            check_clients_that_do_not_read(agent, mill)
            machine.send_signal(signal.SIGTERM)
            machine.wait(30)
            wait_for(lambda: set(agent.values().values()) <= {'UNAVAILABLE', 'Unavailable'} | {
                one for one in agent.values().values() if one.startswith('tool-')}, 'nothing is known of a machine that has ended')
            print(f'{agent.documents} documents checked')
        finally:
            for process in (publisher, machine):
                if process and process.poll() is None:
                    process.terminate()
                    process.wait(30)
    sys.exit(FOUND.status())


if __name__ == '__main__':
    main()
