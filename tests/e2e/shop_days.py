#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests KEEP_DAYS of `millwright shop`: values of older days are removed, other values are kept, and the page shows values that
have not changed since. A session that reads the tables, like a backup, does not delay machines.

usage: shop_days.py COLLECTOR ROOT
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from mill_by_hand import Findings
from publish_shop import Broker, free_port, make_decoder, wait_for
from shop_page import Machine, broker_state, get
from shop_world import Collector, Postgres, skip_without_database

FOUND = Findings()
expect = FOUND.expect
DAY_MS, DAYS, KEEP = 86_400_000, 6, 3
WRONG_MS = 1000  # in 1970
# Longer than the collector waits for the database.
READ_S = 8
COUNTS = "SELECT date_trunc('day', at AT TIME ZONE 'UTC')::date, count(*) FROM reading GROUP BY 1 ORDER BY 1"


def play(machine, noon_ms):
    """A job each day at noon. State and program are only sent in the birth, before the first job."""
    machine.bear(WRONG_MS)
    machine.bear(noon_ms - (DAYS + 1) * DAY_MS)
    machine.bear(noon_ms - DAYS * DAY_MS - 1000)
    for day in range(DAYS, 0, -1):
        at = noon_ms - day * DAY_MS
        machine.data(at, Execution='ACTIVE')
        machine.data(at + 60_000, Program_Ended=day)
        machine.data(at + 60_001, Execution='READY')


def check_kept(database, before, port, today):
    """The values that exist after a start with KEEP_DAYS."""
    first = database.ask(f"SELECT '{today}'::date - {KEEP}")[0][0]
    expected = [row for row in before if row[0] >= first]
    expect(len(before) == DAYS + 2 and 0 < len(expected) < len(before), 'values of some days are too old', before)
    wait_for(lambda: database.ask(COUNTS) != before, 'old days are removed')
    expect(database.ask(COUNTS) == expected, 'values of the other days stay', database.ask(COUNTS), expected)
    shown = json.loads(get(port, '/machines')[1])['machines'][0]
    expect((shown['state'], shown['program'], shown['line'], shown['execution']) == ('ON', '/nc/bolt.ngc', '7', 'READY'), 'values that have not changed since', shown)
    jobs = database.ask("SELECT begins::date, result, program FROM jobs((SELECT id FROM machine WHERE device = 'Lathe'), '-infinity', now()) ORDER BY begins")
    expect(jobs == [[row[0], 'ENDED', '/nc/bolt.ngc'] for row in expected], 'jobs of the days that are kept', jobs)
    left = database.ask('SELECT count(*) FROM run')[0][0], database.ask(f"SELECT count(*) FROM job_reading WHERE at < '{first}'")[0][0]
    expect(left == (str(len(expected)), '4'), 'runs, and the newest of older values for them', left)
    left = database.ask("SELECT relname FROM pg_class WHERE relname ~ '^reading_[0-9]{8}$' ORDER BY 1"), database.ask("SELECT name FROM reading_day ORDER BY 1")
    days = [day for day, in database.ask(f"SELECT 'reading_' || to_char('{first}'::date + n, 'YYYYMMDD') FROM generate_series(0, {KEEP + 2}) AS n")]
    expect(left[0] == left[1] and [row[0] for row in left[0]] == days, 'tables of days', left, days)
    old = database.ask(f"SELECT (SELECT count(*) FROM notification WHERE received < '{first}'), (SELECT count(*) FROM sent), (SELECT count(*) FROM notification), "
                       f"(SELECT count(*) FROM presence JOIN machine ON machine.id = machine WHERE device = 'Lathe' AND at < '{first}'), "
                       "(SELECT count(*) FROM reading_before), (SELECT whole FROM kept_reading JOIN metric ON metric.id = metric WHERE name = 'Program/Line')")
    expect(old == [['0', '2', '2', '1', '0', '7']], 'notifications, presences and values of a wrong clock', old)


def check_late_days(database):
    """All tables were written today, so they are kept. Then each is set back to its day, including the table of the wrong clock."""
    before = database.ask(COUNTS)
    database.ask(f"SELECT drop_days((now() AT TIME ZONE 'UTC')::date - {KEEP})")
    expect(database.ask(COUNTS) == before, 'values that came late stay', database.ask(COUNTS), before)
    database.ask("UPDATE reading_day SET written = least(written, day)")
    database.ask(f"INSERT INTO notification (machine, at, source, message, received) SELECT id, at, 'Contact', 'x', at FROM machine, "
                 f"(VALUES (now()), (now() - interval '{KEEP + 2} days')) AS each (at) WHERE device = 'Lathe'")
    database.ask("INSERT INTO sent (notification, target) SELECT id, 'mail' FROM notification")


def check_reader(database, machine, noon_ms):
    """A value of a day that has no partition, while another session has read all days and has not ended its transaction."""
    reader = subprocess.Popen([str(database.bin / 'psql'), '-X', '-q', '-A', '-t', database.connection], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    reader.stdin.write('BEGIN; SELECT count(*) FROM reading;\n')
    reader.stdin.flush()
    reader.stdout.readline()
    begin = time.monotonic()
    machine.data(noon_ms - 400 * DAY_MS, Execution='STOPPED')
    # The table that another session locks must not be read here.
    wait_for(lambda: database.ask("SELECT count(*) FROM job_reading WHERE text = 'STOPPED'") == [['1']], 'a value is stored while another session reads')
    expect(time.monotonic() - begin < READ_S, 'the value waits for no reader', time.monotonic() - begin)
    reader.stdin.close()
    reader.wait()


def main():
    skip_without_database()
    program, root = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        decoder = make_decoder(root, folder)
        database = Postgres(folder).start('-c', 'timezone=UTC')
        broker = Broker(folder, free_port()).start()
        collector = Collector(program, folder, database, broker.port, 'PORT = 0').start()
        try:
            wait_for(lambda: '"online":true' in broker_state(broker.port), 'the collector is online')
            today = time.strftime('%Y-%m-%d', time.gmtime())
            noon_ms = int(time.time()) // 86400 * DAY_MS + DAY_MS // 2
            machine = Machine(decoder, broker.port)
            play(machine, noon_ms)
            wait_for(lambda: database.ask("SELECT count(*) FROM run WHERE ended_at IS NOT NULL") == [[str(DAYS)]], 'all jobs are stored')
            check_reader(database, machine, noon_ms)
            database.ask("DELETE FROM reading WHERE text = 'STOPPED'; DELETE FROM job_reading WHERE text = 'STOPPED'")
            check_late_days(database)
            before = database.ask(COUNTS)
            expect(collector.kill(15) == 0, 'the collector ends in order')
            collector.log.write_text('')
            collector = Collector(program, folder, database, broker.port, 'PORT = 0', f'KEEP_DAYS = {KEEP}').start()
            wait_for(lambda: 'Shop page: port' in collector.log.read_text(), 'the page is there')
            check_kept(database, before, int(re.search(r'Shop page: port (\d+)', collector.log.read_text()).group(1)), today)
        except TimeoutError:
            print(collector.log.read_text(), database.log.read_text()[-3000:])
            raise
        finally:
            if collector.process.poll() is None:
                collector.kill()
            broker.kill()
            database.end()
    sys.exit(FOUND.status())


if __name__ == '__main__':
    main()
