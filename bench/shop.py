#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures the load of a shop: machines that publish by Sparkplug, mosquitto, `millwright shop` and PostgreSQL on this computer.
Prints the values stored per second, the processor time of each part, and two times: from the time of a value to its receipt at
the publisher (all messages), and to the first query that returns it (one machine, on another connection). The machines run
programs and have alarms: triggers calculate runs, and each alarm is sent to a webhook. Counts rows, runs and alarms at the end.
Exit status 1: one is missing or duplicated.

usage: shop.py [--machines N] [--values N] [--seconds N] [--job SECONDS]
"""
import argparse
import http.server
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / 'build/release'
sys.path.insert(0, str(ROOT / 'tests/e2e'))
from publish_shop import Broker, free_port, wait_for  # noqa: E402
from shop_page import Hook, serve  # noqa: E402
from shop_world import Collector, Postgres, skip_without_database  # noqa: E402

TICKS = os.sysconf('SC_CLK_TCK')
NEWEST = '''SELECT extract(epoch FROM max(reading.at)) FROM reading JOIN metric ON metric.id = metric JOIN machine ON machine.id = machine
    WHERE node = 'm00000' AND reading.at > now() - interval '10 s';'''


def processor_s(pid):
    """Processor time of a process and of its children that have ended."""
    fields = pathlib.Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()
    return sum(int(field) for field in fields[11:15]) / TICKS


class Probe(threading.Thread):
    """Queries the newest time of one machine repeatedly. Each new time gives the delay from value to query."""

    def __init__(self, database):
        super().__init__(daemon=True)
        self.psql = subprocess.Popen([str(database.bin / 'psql'), '-X', '-q', '-A', '-t', database.connection], stdin=subprocess.PIPE,
                                     stdout=subprocess.PIPE, text=True, bufsize=1)
        self.times, self.is_ended = [], False

    def run(self):
        last = None
        while not self.is_ended:
            self.psql.stdin.write(NEWEST + '\n')
            self.psql.stdin.flush()
            newest = self.psql.stdout.readline().strip()
            if newest and newest != last:
                self.times.append(time.time() - float(newest))
                last = newest
            time.sleep(0.02)
        self.psql.stdin.close()
        self.psql.wait()


def share(numbers, part):
    return sorted(numbers)[int(part * (len(numbers) - 1))] if numbers else float('nan')


def measure(words, folder):
    database = Postgres(folder).start('-c', 'fsync=on')
    broker = Broker(folder, free_port())
    # Does not log each message.
    broker.process = subprocess.Popen(['/usr/sbin/mosquitto', '-c', str(broker.config)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    hook = serve(http.server.ThreadingHTTPServer(('127.0.0.1', 0), Hook))
    hook.bodies = []
    collector = Collector(str(BUILD / 'bin/millwright-shop'), folder, database, broker.port, f'WEBHOOK = http://127.0.0.1:{hook.server_address[1]}/').start()
    try:
        wait_for(lambda: database.psql('SELECT count(*) FROM schema_step').stdout.strip() not in ('', '0'), 'the tables are there')
        probe = Probe(database)
        load = subprocess.Popen([str(BUILD / 'test/shop-load'), str(broker.port), str(words.machines), str(words.values), str(words.seconds), str(words.job)],
                                stdout=subprocess.PIPE, text=True)
        begin = time.monotonic()
        time.sleep(5)  # births are over
        probe.start()
        parts = {'collector': [collector.process.pid], 'broker': [broker.process.pid], 'database': database.family()}

        def used():
            return {name: sum(map(processor_s, pids)) for name, pids in parts.items()}
        before, at = used(), time.monotonic()
        time.sleep(max(1, words.seconds - (at - begin) - 2))
        after, end = used(), time.monotonic()
        probe.is_ended = True
        sent = json.loads(load.communicate()[0])
        stored = int(database.ask('SELECT count(*) FROM reading')[0][0])
        runs = database.ask('SELECT count(*), count(ended_at) FROM run')[0]
        wait_for(lambda: len(hook.bodies) >= sent['alarms'], 'all alarms are sent', 60)
        size = int(database.ask("SELECT sum(pg_total_relation_size(inhrelid)) FROM pg_inherits WHERE inhparent = 'reading'::regclass")[0][0])
    finally:
        collector.kill()
        broker.kill()
        database.end()
    rate = words.machines * words.values
    ids = {body['id'] for body in hook.bodies}
    print(f'{sent["programs"]} programs, {runs[0]} runs in the table, {runs[1]} ended; {sent["alarms"]} alarms, {len(hook.bodies)} sent to the webhook')
    print(f'{words.machines} machines, {words.values} values/s each, {words.seconds} s: {sent["values"]} values sent, {stored} stored, '
          f'{sent["rebirths"]} rebirths, {size / stored:.0f} bytes a value with its index')
    cores = {name: (after[name] - before[name]) / (end - at) for name in parts}
    for name, load_of in cores.items():
        print(f'{name:10} {load_of:6.3f} cores, {rate / load_of:9.0f} values/s per core')
    print(f'value to query: p50 {1000 * share(probe.times, 0.5):.0f} ms, p99 {1000 * share(probe.times, 0.99):.0f} ms, {len(probe.times)} samples')
    print(f'value to receipt: p50 {sent["receipt_p50_ms"]} ms, p99 {sent["receipt_p99_ms"]} ms, max {sent["receipt_max_ms"]} ms, {sent["messages"]} messages')
    return 0 if stored == sent['values'] and not sent['open'] and len(ids) == len(hook.bodies) == sent['alarms'] and int(runs[0]) == sent['programs'] else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--machines', type=int, default=1000)
    parser.add_argument('--values', type=int, default=10, help='a second of each machine, a multiple of 10')
    parser.add_argument('--seconds', type=int, default=60)
    parser.add_argument('--job', type=int, default=60, help='time from one program of a machine to the next, even; 0: no programs and alarms')
    skip_without_database()
    with tempfile.TemporaryDirectory() as name:
        sys.exit(measure(parser.parse_args(), pathlib.Path(name)))


if __name__ == '__main__':
    main()
