#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs that a shop offers to a running mill: from the page to the screen and back, hostile requests, rights, and the proof that no message
on any topic starts, opens or changes the machine.

usage: shop_offers.py COLLECTOR MILLWRIGHT HALCMD ROOT
"""
import hashlib
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
import uuid

import paho.mqtt.client as mqtt

from mill_by_hand import Findings, Mill
from offer_world import Machine, Planner, ask, hash_of, page_port, program
from publish_shop import Broker, free_port, make_decoder, wait_for
from shop_world import Collector, Postgres, skip_without_database

FOUND = Findings()
expect = FOUND.expect
TOPICS = {'spBv1.0/plant/NCMD/cell', 'spBv1.0/STATE/shop', 'millwright/stored/shop/plant/cell', 'millwright/offer/shop/plant/cell/Mill'}


class World:
    def __init__(self, words, folder):
        collector, millwright, halcmd, root = words
        self.folder = folder
        self.database = Postgres(folder).start()
        self.broker = Broker(folder, free_port()).start()
        self.collector = Collector(collector, folder, self.database, self.broker.port, 'PORT = 0', 'SECRETS = secrets').start()
        self.planner = Planner(page_port(self.collector))
        self.mill = Mill(millwright, halcmd, root, folder, 'offers')
        self.machine = Machine(self.mill, self.broker.port)
        self.task = subprocess.Popen([millwright, 'start', '--no-display', str(self.mill.ini)], env=self.mill.env, stdout=subprocess.DEVNULL,
                                     stderr=subprocess.DEVNULL)
        wait_for(lambda: self.mill.pin('halui.estop.reset') == 'FALSE', 'the machine runs')
        for pin in ('halui.estop.reset', 'halui.machine.on', 'halui.home-all'):
            self.mill.set_pin(pin, '1')
            time.sleep(0.3)
            self.mill.set_pin(pin, '0')
        wait_for(lambda: all(self.mill.pin(f'halui.joint.{i}.is-homed') == 'TRUE' for i in range(3)), 'the machine is homed')
        self.machine.start_publisher()
        self.machine.start_screen()
        wait_for(self.targets, 'the shop knows the machine')
        self.number = self.targets()[0]['id']

    def targets(self):
        status, text = ask(f'{self.planner.address}/machines')
        return [one for one in json.loads(text)['machines'] if one['alive']] if status == 200 else []

    def offer(self, files, **more):
        """Offers to the mill, and waits until both sides show that it waits there; returns its id."""
        status, text = self.planner.offer(files, [self.number], **more)
        expect(status == 200, 'the offer is stored', text)
        number = json.loads(text)['offers'][0]
        self.wait(number, 'received')
        return number

    def wait(self, number, state):
        def is_there():
            both = [(side.offers() or {}).get(number, {}).get('state') for side in (self.planner, self.machine)]
            return both == [state, state]
        wait_for(is_there, f'both sides show {state}')

    def state_of_machine(self):
        """What an operator would notice."""
        _, metrics = ask(self.machine.address.replace('/api', '/metrics'))
        values = [line for line in metrics.splitlines() if re.match(r'millwright_(state|interpreter_state|programs_ended_total|commands_total) ', line)]
        pins = [self.mill.pin(name) for name in ('halui.machine.is-on', 'halui.mode.is-auto', 'halui.mode.is-mdi', 'halui.program.is-idle', 'halui.program.is-running',
                                                 'halui.tool.number', 'spindle.0.on', 'iocontrol.0.coolant-mist', 'joint.0.pos-cmd', 'joint.1.pos-cmd', 'joint.2.pos-cmd')]
        files = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in self.machine.programs.iterdir()}
        return values, pins, [one['program'] for one in self.targets()], files, self.mill.ini.read_text()

    def end(self):
        self.machine.end()
        self.task.send_signal(signal.SIGTERM)
        self.task.wait(30)
        self.collector.kill()
        self.broker.kill()
        self.database.end()


def check_acceptance(world):
    before = world.state_of_machine()
    files = program('bracket.ngc', 'o<pocket> call [2]\nM2\n', pocket='o<pocket> sub\no<pocket> endsub\n')
    number = world.offer(files, note='soft jaws', parts=20, sha256=hash_of(files))
    shown = world.machine.offers()[number]
    expect((shown['name'], shown['from'], shown['note'], shown['parts'], shown['files']) == ('bracket.ngc', 'Eva', 'soft jaws', 20, ['bracket.ngc', 'pocket.ngc']),
           'the operator sees the offer', shown)
    expect(world.state_of_machine() == before, 'an offer that waits changes nothing')
    text = json.loads(ask(f'{world.machine.address}/offers/{number}')[1])
    expect(text['files'] == files and text['sha256'] == hash_of(files), 'the operator can read the text', text)
    expect(world.machine.decide(number, 'accept')[0] == 200, 'the offer is accepted')
    world.wait(number, 'accepted')
    expect({path.name: path.read_text() for path in world.machine.programs.iterdir()} == {one['name']: one['text'] for one in files}, 'the files are programs')
    after = world.state_of_machine()
    expect(after[:3] == before[:3], 'an acceptance opens and starts nothing', before, after)
    row = world.planner.offers()[number]
    expect(row['ended_by'] == 'Jo (127.0.0.1)' and row['ended'] and row['received'], 'the page shows who and when', row)
    expect(world.machine.offers()[number]['job'] is True, 'parts make a job')
    expect(world.machine.decide(number, 'accept')[0] == 409 and world.machine.decide(number, 'decline')[0] == 409, 'a decision is final')


def check_question(world):
    number = world.offer(program('bracket.ngc', '(new)\nM2\n'))
    status, text = world.machine.decide(number, 'accept')
    expect(status == 409 and json.loads(text)['replaces'] == ['bracket.ngc'], 'another file is not replaced', text)
    expect(world.machine.text('bracket.ngc').startswith('o<pocket>'), 'the file is as before')
    expect(world.machine.decide(number, 'accept', replace=True)[0] == 200, 'it is replaced after the question')
    expect(world.machine.text('bracket.ngc') == '(new)\nM2\n' and world.machine.text('bracket.ngc~').startswith('o<pocket>'), 'the former version is kept')


def check_ends(world):
    declined, withdrawn = world.offer(program('a.ngc')), world.offer(program('b.ngc'))
    expect(world.machine.decide(declined, 'decline', reason='no stock')[0] == 200, 'an offer is declined')
    world.wait(declined, 'declined')
    expect(world.planner.offers()[declined]['reason'] == 'no stock', 'the page shows the reason')
    expect(world.planner.withdraw(withdrawn)[0] == 200, 'an offer is withdrawn')
    world.wait(withdrawn, 'withdrawn')
    expect(world.machine.decide(withdrawn, 'accept')[0] == 409, 'a withdrawn offer is not accepted')
    expect(world.planner.withdraw(declined)[0] == 409, 'a declined offer is not withdrawn')
    request = str(uuid.uuid4())
    first = world.planner.offer(program('c.ngc'), [world.number], request)
    again = world.planner.offer(program('c.ngc'), [world.number, world.number], request)
    expect(first == again, 'a repeated request makes no second offer', first, again)
    expect(world.planner.offer(program('c.ngc', 'G0\n'), [world.number], request)[0] == 409, 'a request has one content')


def check_hostile(world):
    good, machines = program('a.ngc'), [world.number]
    count = len(world.planner.offers())
    for what, files, targets, more, status, word in (
            ('folder', program('../a.ngc'), machines, {}, 400, 'plain file name'), ('absolute', program('/etc/cron.d/a.ngc'), machines, {}, 400, 'plain file name'),
            ('control', program('a\n.ngc'), machines, {}, 400, 'control characters'), ('type', program('a.sh'), machines, {}, 400, 'not a program'),
            ('hidden', program('.a.ngc'), machines, {}, 400, 'plain file name'), ('nul', program('a.ngc', 'G0\0'), machines, {}, 400, 'line 1 of a.ngc'),
            ('hash', good, machines, {'sha256': hash_of(program('b.ngc'))}, 400, 'SHA-256'), ('size', program('a.ngc', ' ' * 4194305), machines, {}, 400, 'maximum'),
            ('twice', program('a.ngc') + program('A.ngc'), machines, {}, 400, 'two files'), ('none', [], machines, {}, 400, '1 to 32 files'),
            ('unknown', good, [99999], {}, 409, 'no machine 99999'), ('no machine', good, [], {}, 400, 'machines'), ('text', good, ['1; DROP TABLE offer'], {}, 400, 'machines'),
            ('parts', good, machines, {'parts': -1}, 400, 'parts'), ('parts', good, machines, {'parts': 1e9}, 400, 'parts'), ('from', good, machines, {'from': ''}, 400, 'sender'),
            ('request', good, machines, {'request': '../x'}, 400, 'id'), ('files', {'a': 1}, machines, {}, 400, 'files')):
        answer = world.planner.offer(files, targets, **more)
        expect(answer[0] == status and word in answer[1] and answer[1].count('\n') == 1, f'{what} is one clear error', answer)
    for body in (b'', b'[]', b'\xff\xfe', b'{"files": "\xe9"}', b'{' * 1000):
        answer = ask(f'{world.planner.address}/offers', 'POST', body)
        expect(answer[0] == 400 and answer[1].count('\n') == 1, 'a body of another form is one error', body[:20], answer)
    expect(ask(f'{world.planner.address}/offers', 'POST', b' ' * 6_000_000)[0] in (0, 413), 'a large request is rejected')
    for path, method, status in (('/offers', 'DELETE', 405), ('/offers/x', 'POST', 404), ('/offers/withdraw', 'GET', 405)):
        expect(ask(world.planner.address + path, method)[0] == status, f'{method} {path}')
    expect(world.planner.withdraw('x')[0] == 400 and world.planner.withdraw(str(uuid.uuid4()))[0] == 404, 'withdrawals of other ids')
    expect(len(world.planner.offers()) == count, 'nothing was stored')


def check_rights(world):
    """Another user of this computer needs a token with the role operate."""
    if os.geteuid():
        return
    secrets = dict(line.split() for line in (world.folder / 'secrets/tokens').read_text().splitlines() if line and not line.startswith('#'))
    body = json.dumps({'request': str(uuid.uuid4()), 'machines': [world.number], 'from': 'X', 'note': '', 'parts': 0, 'files': program('x.ngc')})
    for role, status in ((None, '403'), ('view', '403'), ('operate', '200')):
        header = ['-H', f'Authorization: Bearer {secrets[role]}'] if role else []
        for words, expected in ((['-d', body, f'{world.planner.address}/offers'], status), ([f'{world.planner.address}/offers'], '200')):
            done = subprocess.run(['curl', '-s', '-o', '/dev/null', '-w', '%{http_code}', *header, *words], user='nobody', cwd='/', capture_output=True, text=True, check=False)
            expect(done.stdout == expected, f'{role} {words[0][:2]}', done.stdout)


def attack(world, decoder):
    """Messages on each topic that a client of this machine subscribes, and on others."""
    log = world.broker.log.read_text()
    subscribed = set()
    for client, topics in re.findall(r'Received SUBSCRIBE from (\S+)\n((?:\d+: \t.*\n)+)', log):
        if client.startswith('plant/cell'):
            subscribed |= set(re.findall(r'\t(\S+) \(QoS', topics))
    expect(subscribed == TOPICS, 'the machine subscribes these topics only', subscribed)
    commands = decoder.Payload(timestamp=int(time.time() * 1000))
    for name in ('Node Control/Reboot', 'Device Control/Start', 'Program/Path', 'Program/Run', 'State', 'Mode', 'Execution', 'Axes/X/Position'):
        commands.metrics.add(name=name, datatype=12, string_value='ON')
        commands.metrics.add(name=name, datatype=11, boolean_value=True)
    offer = {'id': str(uuid.uuid4()), 'from': 'X', 'note': '', 'parts': 1, 'files': program('evil.ngc', 'M3 S9000\nG0 Z-99\nM2\n')}
    offer['sha256'] = hash_of(offer['files'])
    chance, payloads = random.Random(7), [commands.SerializeToString()]
    for text in ({'message': 'SetState', 'state': 'ON'}, {'id': 1, 'command': {'message': 'RunProgram', 'line': 0}}, {'decision': 'accept', 'id': offer['id']},
                 {'noted': [], 'withdrawn': [], 'offer': offer}, {'noted': [{'id': offer['id'], 'state': 'accepted'}], 'withdrawn': []},
                 {'noted': [], 'withdrawn': [], 'offer': dict(offer, id=str(uuid.uuid4()), state='accepted', open=True, start=True)},
                 {'noted': [], 'withdrawn': [], 'offer': dict(offer, id=str(uuid.uuid4()), files=program('../evil.ngc'))}, {'online': True, 'timestamp': 1}):
        payloads.append(json.dumps(text).encode())
    payloads += [chance.randbytes(chance.randint(0, 200)) for _ in range(50)]
    client = mqtt.Client(client_id='attacker')
    client.connect('127.0.0.1', world.broker.port)
    client.loop_start()
    for topic in sorted(TOPICS | {'spBv1.0/plant/DCMD/cell/Mill', 'millwright/report/shop/plant/cell/Mill', 'millwright/command/cell', 'start'}):
        for payload in payloads:
            for retained in (False, True):
                client.publish(topic, payload, 1, retained).wait_for_publish(10)
        client.publish(topic, b'', 1, True).wait_for_publish(10)
    client.loop_stop()
    client.disconnect()
    return offer['id']


def check_tools(world):
    """Each version of the tool table arrives once; the role view cannot download it."""
    path = world.mill.ini.parent / re.search(r'(?m)^TOOL_TABLE *= *(\S+)', world.mill.ini.read_text()).group(1)
    versions = lambda: json.loads(ask(f'{world.planner.address}/copies')[1])['copies']
    wait_for(versions, 'the tool table arrives')
    time.sleep(6)
    found = versions()
    expect(len(found) == 1 and found[0]['sha256'] == hashlib.sha256(path.read_bytes()).hexdigest() and found[0]['name'] == path.name, 'one version', found)
    address = f'{world.planner.address}/copies/{found[0]["id"]}'
    expect(ask(address) == (200, path.read_text()), 'the version is downloaded')
    expect(ask(f'{world.planner.address}/copies/99999')[0] == 404 and ask(f'{world.planner.address}/copies/x')[0] == 404, 'other versions')
    expect(ask(address, 'POST', b'')[0] in (404, 405), 'a version is not changed')
    before = path.read_bytes()
    if not os.geteuid():
        done = subprocess.run(['curl', '-s', '-o', '/dev/null', '-w', '%{http_code}', address], user='nobody', cwd='/', capture_output=True, text=True, check=False)
        expect(done.stdout == '403', 'another user needs a token', done.stdout)
    path.write_bytes(before + b'T77 P77 D1 Z1 ;\xff\n')
    wait_for(lambda: len(versions()) == 2, 'the new version arrives', 90)
    newest = versions()[0]
    expect(newest['sha256'] == hashlib.sha256(before + b'T77 P77 D1 Z1 ;\xff\n').hexdigest(), 'the new version', newest)


def check_attack(world, decoder):
    before = world.state_of_machine()
    number = attack(world, decoder)
    time.sleep(3)
    expect(world.state_of_machine() == before, 'no message starts, opens or changes the machine', before, world.state_of_machine())
    expect('evil.ngc' not in os.listdir(world.machine.programs), 'no file is a program')
    expect(world.machine.publisher.poll() is None and world.task.poll() is None, 'publisher and machine run')
    expect(world.machine.offers().get(number, {}).get('state') in (None, 'received', 'withdrawn'), 'a forged offer waits like any other one')
    last = world.offer(program('last.ngc'))
    expect(last in world.machine.offers(), 'offers continue')


def main():
    skip_without_database()
    words = sys.argv[1:5]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)
        decoder = make_decoder(words[3], folder)
        world = World(words, folder)
        try:
            for check in (check_acceptance, check_question, check_ends, check_hostile, check_rights, check_tools):
                check(world)
            check_attack(world, decoder)
        except TimeoutError:
            print(world.collector.log.read_text(), world.machine.log.read_text(), world.machine.screen_log.read_text())
            raise
        finally:
            world.end()
    sys.exit(FOUND.status())


if __name__ == '__main__':
    main()
