#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests times in `millwright shop`: two values of one metric with the same time, late values, and a machine with a wrong clock.
The test simulates a machine with another MQTT library; rows and notifications are compared with expected values written by hand.

usage: shop_times.py COLLECTOR ROOT
"""
import email
import email.header
import email.policy
import http.server
import json
import pathlib
import random
import re
import socketserver
import sys
import tempfile
import time

from mill_by_hand import Findings
from publish_shop import Broker, free_port, make_decoder, wait_for
from shop_page import Hook, Machine, Mailbox, broker_state, get, serve
from shop_world import Collector, Postgres, skip_without_database

FOUND = Findings()
expect = FOUND.expect
MINUTE_MS, HOUR_MS, DAY_MS = 60_000, 3_600_000, 86_400_000
# Letters of two and four bytes, longer than one encoded word.
LATE_ALARM = 'Kühlmitteldruck zu niedrig 🛢 – Füllstand prüfen, dann Störung quittieren und Programm fortsetzen: ä'
WRONG_MS = 2 * HOUR_MS  # the time by which the clock is ahead


def rows(database, metric, since_ms):
    """(milliseconds since, microseconds, value) of a metric."""
    return [(int(ms) - since_ms, int(us), value) for ms, us, value in database.ask(
        f"SELECT floor(extract(epoch FROM at) * 1000), extract(microseconds FROM at)::int % 1000, coalesce(text, whole::text) FROM reading "
        f"JOIN metric ON metric.id = metric WHERE name = '{metric}' AND at >= to_timestamp({since_ms / 1000}) ORDER BY at")]


def check_same_time(database, machine, now_ms):
    """In one message, in several messages, and with the same value again."""
    at = now_ms - 50_000
    machine.readings(at, ('Program/Line', at, 1), ('Program/Line', at, 2), ('Program/Line', at, 1))
    machine.readings(at, ('Program/Line', at + 1, 3))
    machine.readings(at, ('Program/Line', at + 1, 4))
    machine.readings(at, ('Program/Line', at + 1, 4), ('Program/Line', at + 2, 5), ('Program/Line', at + 2, 5))
    machine.readings(at, ('Execution', at, 'ACTIVE'), ('Execution', at, 'STOPPED'), ('Execution', at, 'ACTIVE'))
    machine.readings(at + 900, ('Execution', at + 900, 'READY'), ('Program/Line', at + 900, 9))
    wait_for(lambda: rows(database, 'Program/Line', at)[-1:] == [(900, 0, '9')], 'the last line is stored')
    found = rows(database, 'Program/Line', at)
    expect(found == [(0, 0, '1'), (0, 1, '2'), (0, 2, '1'), (1, 0, '3'), (1, 1, '4'), (2, 0, '5'), (900, 0, '9')], 'each value with one time is stored, in order', found)
    found = rows(database, 'Execution', at)
    expect(found == [(0, 0, 'ACTIVE'), (0, 1, 'STOPPED'), (0, 2, 'ACTIVE'), (900, 0, 'READY')], 'the same for events', found)
    again = database.ask(f"SELECT count(*) FROM job_reading JOIN metric ON metric.id = metric WHERE name = 'Execution' AND at >= to_timestamp({at / 1000})")
    expect(again == [['4']], 'and for the values that runs come from', again)


def check_random(database, machine, now_ms):
    """Few times and few values, in messages of random length: a value is stored when it differs from the newest one of its millisecond."""
    seed = random.randrange(10**6)
    chance, at, expected = random.Random(seed), now_ms - 40_000, {}
    for _ in range(300):
        readings = [('Program/Line', at + chance.randrange(40), chance.randrange(3)) for _ in range(chance.randrange(1, 8))]
        machine.readings(now_ms, *readings)
        for _, ms, value in readings:
            stored = expected.setdefault(ms - at, [])
            if stored[-1:] != [str(value)]:
                stored.append(str(value))
        if chance.random() < 0.1:
            time.sleep(0.15)  # another batch
    machine.readings(now_ms, ('Program/Line', at + 1000, 77))
    wait_for(lambda: rows(database, 'Program/Line', at)[-1:] == [(1000, 0, '77')], 'the last line is stored')
    found = rows(database, 'Program/Line', at)[:-1]
    expect(found == [(ms, us, value) for ms in sorted(expected) for us, value in enumerate(expected[ms])], f'random values with few times, seed {seed}', len(found), found[:20])


def check_late(database, machine, now_ms):
    """A job of ten days ago that arrives now: 600 s, of which 60 s in feed hold."""
    at = now_ms - 10 * DAY_MS
    before = database.ask("SELECT count(*) FROM jobs((SELECT id FROM machine WHERE device = 'Lathe'), '-infinity', now())")
    machine.readings(now_ms, ('Execution', at, 'ACTIVE'), ('Execution', at + 100_000, 'FEED_HOLD'), ('Execution', at + 600_000, 'READY'))
    # Sent later than the rest of its job, with a time within it.
    machine.readings(now_ms, ('Execution', at + 160_000, 'ACTIVE'), ('Program/Ended', at + 599_000, 1))
    span = f"(SELECT id FROM machine WHERE device = 'Lathe'), to_timestamp({(at - HOUR_MS) / 1000}), to_timestamp({(at + HOUR_MS) / 1000})"
    wait_for(lambda: database.ask(f'SELECT result FROM jobs({span})') == [['ENDED']], 'a late job')
    job = database.ask(f'SELECT extract(epoch FROM ends - begins)::int, extract(epoch FROM active)::int FROM jobs({span})')
    expect(job == [['600', '540']], 'its times', job)
    parts = database.ask(f'SELECT round(availability * 7200), parts FROM oee({span})')
    expect(parts == [['540', '1']], 'late values are in the sums', parts)
    expect(database.ask("SELECT count(*) FROM jobs((SELECT id FROM machine WHERE device = 'Lathe'), '-infinity', now())")[0][0] == str(int(before[0][0]) + 1), 'one job more')


def check_late_alarm(machine, mails, bodies, now_ms):
    """An alarm of two days ago that has ended, one that has not ended, and a current one."""
    machine.readings(now_ms, ('Alarms/Drives', now_ms - 2 * DAY_MS, LATE_ALARM), ('Alarms/Drives', now_ms - 2 * DAY_MS + 1000, ''))
    machine.readings(now_ms, ('Alarms/Drives', now_ms - 3 * HOUR_MS, 'Old alarm.'))
    wait_for(lambda: len(bodies) == 2 and len(mails) == 2, 'late alarms are sent')
    machine.readings(now_ms, ('Alarms/Drives', now_ms - 1000, 'New alarm.'))
    wait_for(lambda: len(bodies) == 3 and len(mails) == 3, 'an alarm of now is sent')
    found = [(body['message'], body['late_s'], body['over']) for body in bodies]
    expect(found == [(LATE_ALARM, 2 * 86400, True), ('Old alarm.', 3 * 3600, False), ('New alarm.', 1, False)], 'how late alarms are', found)
    expect(all(len(line.encode()) <= 76 for mail in mails for line in mail.split('\r\n')), 'lines of mails are short', mails)
    words = re.findall(r'=\?UTF-8\?B\?[^?]*\?=', mails[0])
    for word in words:
        try:
            email.header.decode_header(word)[0][0].decode('utf-8')
        except UnicodeDecodeError as error:
            expect(False, 'a word of the subject has whole characters', word, error)
    mail = [email.message_from_string(text, policy=email.policy.default) for text in mails]
    subjects = [one['Subject'] for one in mail]
    expect(subjects == [f'plant/cell/Lathe: Late: {LATE_ALARM}', 'plant/cell/Lathe: Late: Old alarm.', 'plant/cell/Lathe: New alarm.'], 'subjects', subjects)
    texts = [one.get_content() for one in mail]
    expect('48 h 0 min after' in texts[0] and 'The condition has ended.' in texts[0] and 'No later value was received.' in texts[1] and 'Late' not in texts[2], 'texts', texts)
    expect(all(one['Date'].datetime and one['Message-ID'] for one in mail) and len({one['Message-ID'] for one in mail}) == 3, 'dates and numbers', mails)
    expect(all(one.defects == [] for one in mail), 'mails without defects', [one.defects for one in mail])


def check_wrong_clock(database, machine, port, bodies, now_ms):
    """A clock that is fast: its alarm is not late, the shop detects its end, and a notification is sent."""
    ahead = now_ms + WRONG_MS
    machine.bear(ahead)
    wait_for(lambda: any(body['source'] == 'Clock' for body in bodies), 'a wrong clock is reported')
    clock = next(body for body in bodies if body['source'] == 'Clock')
    expect(abs(int(re.search(r'is (\d+) s ahead', clock['message']).group(1)) - WRONG_MS // 1000) <= 2, 'how wrong it is', clock)
    machine.readings(ahead + 1000, ('Alarms/Drives', ahead + 1000, 'Alarm by a wrong clock.'))
    wait_for(lambda: any(body['message'] == 'Alarm by a wrong clock.' for body in bodies), 'an alarm by a wrong clock is sent')
    expect(bodies[-1]['late_s'] == 0, 'it is not late', bodies[-1])
    machine.send('NDEATH', ahead, {'bdSeq': 3}, True)
    wait_for(lambda: not json.loads(get(port, '/machines')[1])['machines'][0]['alive'], 'a machine with a wrong clock has no contact')
    # The clock is correct again.
    machine.bear(int(time.time() * 1000))
    wait_for(lambda: json.loads(get(port, '/machines')[1])['machines'][0]['alive'], 'it is there again')
    machine.bear(int(time.time() * 1000) - WRONG_MS)
    time.sleep(1)
    expect(sum(body['source'] == 'Clock' for body in bodies) == 1, 'a wrong clock is reported once a day', bodies)


def check_restart(database, machine, port):
    """A machine with a birth in the millisecond of its death, as after a change of its metrics."""
    at = int(time.time() * 1000) + WRONG_MS + MINUTE_MS
    machine.send('DDEATH', at, {})
    machine.send('DBIRTH', at, {'State': 'ESTOP', 'Execution': 'READY'}, True)
    wait_for(lambda: json.loads(get(port, '/machines')[1])['machines'][0]['state'] == 'ESTOP', 'the birth is stored')
    time.sleep(1.5)
    found = json.loads(get(port, '/machines')[1])['machines'][0]
    expect(found['alive'], 'a machine that is born in the millisecond of its death is there', database.ask('SELECT * FROM presence ORDER BY at DESC LIMIT 4'))


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
            machine, now_ms = Machine(decoder, broker.port), int(time.time() * 1000)
            machine.bear(now_ms - 5 * HOUR_MS, now_ms - MINUTE_MS)
            for check in (lambda: check_same_time(database, machine, now_ms), lambda: check_random(database, machine, now_ms),
                          lambda: check_late(database, machine, now_ms),
                          lambda: check_late_alarm(machine, mailbox.mails, hook.bodies, now_ms),
                          lambda: check_wrong_clock(database, machine, port, hook.bodies, int(time.time() * 1000)),
                          lambda: check_restart(database, machine, port)):
                try:
                    check()
                except (TimeoutError, KeyError) as error:
                    expect(False, repr(error))
            print(collector.log.read_text() if FOUND.status() else '')
        finally:
            collector.kill()
            broker.kill()
            database.end()
    sys.exit(FOUND.status())


if __name__ == '__main__':
    main()
