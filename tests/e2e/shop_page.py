#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests the page of `millwright shop` and its sums. The test simulates a machine with another MQTT library: state, program,
alarm, jobs, OEE compared with values calculated by hand, one notification for each alarm, and rejected requests.

usage: shop_page.py COLLECTOR ROOT
"""
import datetime
import email
import http.server
import json
import pathlib
import re
import socketserver
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request

import paho.mqtt.client as mqtt

from mill_by_hand import Findings
from publish_shop import Broker, free_port, make_decoder, wait_for
from shop_world import Collector, Postgres, skip_without_database

FOUND = Findings()
expect = FOUND.expect
ALIASES = {name: 100 + i for i, name in enumerate(('State', 'Execution', 'Mode', 'Program/Path', 'Program/Line', 'Program/Ended', 'Alarms/Drives'))}
ALARM = 'Joint 1: <b>following error</b>.\r\nBcc: all@example.org'


class Machine:
    """An edge node with values that the test sets, at times that it sets."""

    def __init__(self, decoder, port):
        self.decoder, self.seq = decoder, 0
        self.client = mqtt.Client(client_id='played', clean_session=True)
        self.client.on_message = lambda *_: None
        self.client.connect('127.0.0.1', port)
        self.client.loop_start()

    def send(self, kind, at_ms, values, is_birth=False, sent_ms=None):
        payload = self.decoder.Payload(timestamp=sent_ms or at_ms, seq=self.seq)
        self.seq = (self.seq + 1) % 256
        for name, value in values.items():
            metric = payload.metrics.add(timestamp=at_ms)
            if is_birth:
                metric.name = name
                metric.datatype = 12 if isinstance(value, str) else 4
            if name in ALIASES:
                metric.alias = ALIASES[name]
            if isinstance(value, str):
                metric.string_value = value
            else:
                metric.long_value = value
        device = '' if kind in ('NBIRTH', 'NDEATH') else '/Lathe'
        self.client.publish(f'spBv1.0/plant/{kind}/cell{device}', payload.SerializeToString(), 0, False)

    def bear(self, at_ms, sent_ms=None):
        """Sends values with a time at that time or at another one."""
        self.seq = 0
        self.send('NBIRTH', at_ms, {'bdSeq': 3}, True, sent_ms)
        self.send('DBIRTH', at_ms, {'State': 'ON', 'Execution': 'READY', 'Mode': 'AUTO', 'Program/Path': '/nc/bolt.ngc', 'Program/Line': 7,
                                    'Program/Ended': 0, 'Alarms/Drives': ''}, True, sent_ms)

    def readings(self, sent_ms, *readings):
        """One message with (name, time, value) of each."""
        payload = self.decoder.Payload(timestamp=sent_ms, seq=self.seq)
        self.seq = (self.seq + 1) % 256
        for name, at_ms, value in readings:
            metric = payload.metrics.add(timestamp=at_ms, alias=ALIASES[name])
            if isinstance(value, str):
                metric.string_value = value
            else:
                metric.long_value = value
        self.client.publish('spBv1.0/plant/DDATA/cell/Lathe', payload.SerializeToString(), 0, False)

    def data(self, at_ms, **values):
        self.send('DDATA', at_ms, {name.replace('_', '/'): value for name, value in values.items()})


class Mailbox(socketserver.StreamRequestHandler):
    """The part of SMTP that one sender needs."""

    def handle(self):
        self.wfile.write(b'220 test\r\n')
        while line := self.rfile.readline():
            word = line[:4].upper().strip()
            if word == b'DATA':
                self.wfile.write(b'354 go\r\n')
                text = b''
                while (line := self.rfile.readline()) != b'.\r\n':
                    text += line
                self.server.mails.append(text.decode())
            self.wfile.write(b'221 bye\r\n' if word == b'QUIT' else b'250 ok\r\n')
            if word == b'QUIT':
                return


class Hook(http.server.BaseHTTPRequestHandler):
    """Stores the data that a webhook receives."""

    def do_POST(self):
        body = self.rfile.read(int(self.headers['Content-Length']))
        self.server.bodies.append(json.loads(body))
        self.send_response(200)
        self.end_headers()

    def log_message(self, *_):
        pass


def serve(server):
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


def get(port, path, method='GET'):
    request = urllib.request.Request(f'http://127.0.0.1:{port}{path}', method=method)
    try:
        with urllib.request.urlopen(request, timeout=20) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


def check_requests(port):
    for path, method, status in (('/', 'GET', 200), ('/machines/sums', 'GET', 200), ('/page.js', 'GET', 200), ('/page.css', 'GET', 200), ('/machines', 'POST', 405),
                                 ('/machines', 'DELETE', 405), ('/other', 'GET', 404), ('/machines/history?machine=1', 'GET', 400),
                                 ("/machines/history?machine=1;DROP&days=1", 'GET', 400), ('/machines/history?machine=1&days=0', 'GET', 400),
                                 ('/machines/history?machine=99999999999&days=1', 'GET', 400)):
        answer = get(port, path, method)
        expect(answer[0] == status, f'{method} {path} answers {status}', answer)


def check_page(port, database, now_ms):
    """A shift of one hour that began an hour ago: 600 s and 300 s active, 1 part of 2 rejected, ideal time 400 s per part."""
    machine = json.loads(get(port, '/machines')[1])['machines'][0]
    expect((machine['node'], machine['device'], machine['alive']) == ('cell', 'Lathe', True), 'the machine', machine)
    expect((machine['state'], machine['execution'], machine['program'], machine['line']) == ('ON', 'READY', '/nc/bolt.ngc', '7'), 'its state', machine)
    expect(machine['alarms'] == 'Joint 1: <b>following error</b>.\ufffd Bcc: all@example.org', 'its alarm', machine['alarms'])
    number = machine['id']
    begin = datetime.datetime.fromtimestamp((now_ms - 3600_000) / 1000, datetime.timezone.utc)
    span = f"'{begin.isoformat()}', '{(begin + datetime.timedelta(hours=1)).isoformat()}'"
    jobs = database.ask(f'SELECT extract(epoch FROM ends - begins)::int, extract(epoch FROM active)::int, result FROM jobs({number}, {span}) ORDER BY begins')
    expect(jobs == [['700', '600', 'ENDED'], ['300', '300', 'ENDED'], ['60', '60', 'ABORTED']], 'jobs', jobs)
    database.ask("INSERT INTO cycle_time VALUES ('bolt.ngc', '400 s')")
    database.ask(f'INSERT INTO rejected_part VALUES ({number}, to_timestamp({now_ms / 1000 - 1000}), 1)')
    sums = [float(text) for text in database.ask(f'SELECT * FROM oee({number}, {span})')[0]]
    expected = [960 / 3600, 800 / 900, 0.5, 960 / 3600 * 800 / 900 * 0.5, 2]
    expect(all(abs(one - other) < 1e-3 for one, other in zip(sums, expected)), 'OEE', sums, expected)
    history = json.loads(get(port, f'/machines/history?machine={number}&days=7')[1])
    expect([job['result'] for job in history['jobs']] == ['ABORTED', 'ENDED', 'ENDED'], 'history of jobs', history['jobs'])
    expect(len(history['alarms']) == 1 and history['alarms'][0]['source'] == 'Alarms/Drives', 'history of alarms', history['alarms'])


def check_notifications(mails, bodies):
    """The clock of the machine is one hour slow, which is also reported."""
    wait_for(lambda: len(mails) > 1 and len(bodies) > 1, 'the alarm is sent')
    time.sleep(3)
    bodies = sorted(bodies, key=lambda body: body['source'])
    expect([body['source'] for body in bodies] == ['Alarms/Drives', 'Clock'], 'notifications', bodies)
    mails = [text for text in mails if 'Alarms/Drives' in email.message_from_string(text).get_payload(decode=True).decode()]
    bodies = bodies[:1]
    expect(len(mails) == 1 and len(bodies) == 1, 'each alarm is sent once', len(mails), len(bodies))
    expect(bodies[0]['machine'] == 'plant/cell/Lathe' and bodies[0]['source'] == 'Alarms/Drives', 'the webhook', bodies)
    mail = email.message_from_string(mails[0])
    expect(mail['Bcc'] is None and mail['To'] == 'a@example.org', 'a text adds no header', mails)
    expect('following error' in mail.get_payload(decode=True).decode(), 'the text of the mail')


def play(machine, now_ms):
    """An hour of past values, from a publisher that could not reach the broker."""
    at = now_ms - 3600_000
    machine.bear(at)
    for second, values in ((100, {'Execution': 'ACTIVE'}), (400, {'Execution': 'FEED_HOLD'}), (500, {'Execution': 'ACTIVE'}),
                           (799, {'Program_Ended': 1}), (800, {'Execution': 'READY'}), (1000, {'Execution': 'ACTIVE'}), (1300, {'Execution': 'READY'}),
                           (1300, {'Program_Ended': 2}), (2000, {'Execution': 'ACTIVE'}), (2060, {'Execution': 'READY'}), (2061, {'Alarms_Drives': ALARM})):
        machine.data(at + 1000 * second, **values)
        if values == {'Alarms_Drives': ALARM}:  # twice, as after a lost connection
            machine.data(at + 1000 * second, **values)


def main():
    skip_without_database()
    program, root = sys.argv[1:3]
    mailbox = serve(socketserver.ThreadingTCPServer(('127.0.0.1', 0), Mailbox))
    hook = serve(http.server.ThreadingHTTPServer(('127.0.0.1', 0), Hook))
    mailbox.mails, hook.bodies = [], []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        decoder = make_decoder(root, folder)
        database = Postgres(folder).start()
        broker = Broker(folder, free_port()).start()
        lines = ('PORT = 0', f'MAIL_SERVER = smtp://127.0.0.1:{mailbox.server_address[1]}', 'MAIL_FROM = shop@example.org',
                 'MAIL_TO = a@example.org', f'WEBHOOK = http://127.0.0.1:{hook.server_address[1]}/hook')
        collector = Collector(program, folder, database, broker.port, *lines).start()
        try:
            wait_for(lambda: '"online":true' in broker_state(broker.port), 'the collector is online')
            port = int(re.search(r'Shop page: port (\d+)', collector.log.read_text()).group(1))
            now_ms = int(time.time() * 1000)
            play(Machine(decoder, broker.port), now_ms)
            wait_for(lambda: database.ask("SELECT count(*) FROM notification WHERE source LIKE 'Alarms/%'") == [['1']], 'the alarm is stored')
            check_requests(port)
            check_page(port, database, now_ms)
            check_notifications(mailbox.mails, hook.bodies)
            expect(collector.kill(15) == 0, 'the collector ends in order')
        except TimeoutError:
            print(collector.log.read_text(), database.log.read_text()[-3000:])
            raise
        finally:
            if collector.process.poll() is None:
                collector.kill()
            broker.kill()
            database.end()
    sys.exit(FOUND.status())


def broker_state(port):
    """The retained STATE of the collector."""
    found = []
    client = mqtt.Client(client_id='state', clean_session=True)
    client.on_message = lambda _client, _data, message: found.append(message.payload.decode())
    client.connect('127.0.0.1', port)
    client.subscribe('spBv1.0/STATE/shop')
    end = time.monotonic() + 0.5
    while not found and time.monotonic() < end:
        client.loop(0.1)
    client.disconnect()
    return found[0] if found else ''


if __name__ == '__main__':
    main()
