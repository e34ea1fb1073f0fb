#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""No value that publishers have accepted is lost or duplicated in the database of `millwright shop` when messages are lost
between broker and collector: runs of 1 to 1,024 data messages of a node, most of them as long as the Sparkplug sequence (256) or
a multiple. A relay that parses MQTT packets drops them. It also reads the fields of each payload by their numbers in the public
schema: besides those of Sparkplug there are two extensions, which number the messages of each birth. Publishers are
publish-feeders, which count, with enough messages in transit for such a run.

usage: shop_gaps.py COLLECTOR FEEDER ROOT [GAPS [SEED]]
"""
import collections
import pathlib
import random
import socket
import sys
import tempfile
import threading
import time

from publish_kills import Feeder
from publish_shop import Broker, free_port, wait_for
from shop_kills import COUNTS
from shop_world import Collector, Postgres, skip_without_database

PUBLISH, WINDOW, PERIOD_MS = 3, 3000, 1
# Fields of a payload: those of Sparkplug that are used, and the two extensions.
TIMESTAMP, METRICS, SEQ, BIRTH, COUNT = 1, 2, 3, 1201, 1202
LENGTHS = (256, 256, 256, 512, 1024, 255, 257, 1)


class Relay(threading.Thread):
    """Forwards the packets of a broker to its clients, except the packets to be lost."""

    def __init__(self, broker_port):
        super().__init__(daemon=True)
        self.broker_port, self.lock, self.to_lose, self.lost = broker_port, threading.Lock(), {}, collections.Counter()
        self.positions, self.problems = {}, []
        self.listener = socket.create_server(('127.0.0.1', 0))
        self.port = self.listener.getsockname()[1]
        self.start()

    def run(self):
        while True:
            client, _ = self.listener.accept()
            try:
                broker = socket.create_connection(('127.0.0.1', self.broker_port))
            except OSError:
                client.close()
                continue
            for source, target, is_watched in ((client, broker, False), (broker, client, True)):
                threading.Thread(target=self.pump, args=(source, target, is_watched), daemon=True).start()

    def pump(self, source, target, is_watched):
        try:
            stream = source.makefile('rb')
            while packet := read_packet(stream):
                if is_watched:
                    self.check(packet)
                    if self.is_lost(packet):
                        continue
                target.sendall(packet)
        except (OSError, EOFError):
            pass
        for each in (source, target):
            try:
                each.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def check(self, packet):
        """The numbers of a node's messages, as the broker sends them."""
        topic, payload = split(packet)
        parts = topic.split('/')
        if parts[0] != 'spBv1.0' or parts[1] == 'STATE' or parts[2] not in ('NBIRTH', 'NDATA', 'DBIRTH', 'DDATA', 'DDEATH'):
            return
        fields = fields_of(payload)
        with self.lock:
            if set(fields) - {TIMESTAMP, METRICS, SEQ, BIRTH, COUNT}:
                self.problems.append(f'{topic} has the fields {sorted(fields)}')
                return
            if parts[2] == 'NBIRTH':
                self.positions[parts[3]] = (fields[TIMESTAMP], 0)
            elif parts[3] not in self.positions:
                return
            birth, count = self.positions[parts[3]]
            self.positions[parts[3]] = birth, count + 1
            found = tuple(fields.get(number) for number in (BIRTH, COUNT, SEQ))
            if found != (birth, count + 1, count % 256):
                self.problems.append(f'{topic}: birth, count and seq are {found}, not {(birth, count + 1, count % 256)}')

    def lose(self, node, count):
        with self.lock:
            self.to_lose[node] = count

    def is_done(self, node):
        with self.lock:
            return not self.to_lose.get(node)

    def is_lost(self, packet):
        parts = split(packet)[0].split('/')
        if len(parts) != 5 or parts[2] != 'DDATA':
            return False
        with self.lock:
            if not self.to_lose.get(parts[3]):
                return False
            self.to_lose[parts[3]] -= 1
            self.lost[parts[3]] += 1
            return True


def read_packet(stream):
    """The bytes of one packet: a byte, the length in groups of seven bits, the rest."""
    head = stream.read(1)
    length = shift = 0
    while head:
        byte = stream.read(1)
        if not byte:
            raise EOFError
        head += byte
        length |= (byte[0] & 127) << shift
        shift += 7
        if byte[0] < 128:
            break
    rest = stream.read(length)
    if len(rest) < length:
        raise EOFError
    return head + rest


def split(packet):
    """Topic and payload of PUBLISH with QoS 0; empty for others."""
    if packet[0] >> 4 != PUBLISH or packet[0] & 6:
        return '', b''
    start = next(i for i in range(1, 6) if packet[i] < 128) + 1
    end = start + 2 + int.from_bytes(packet[start:start + 2], 'big')
    return packet[start + 2:end].decode(), packet[end:]


def fields_of(payload):
    """{number: value} of a protobuf message; a repeated field has its last value."""
    found, at = {}, 0

    def number():
        nonlocal at
        value = shift = 0
        while True:
            byte = payload[at]
            at += 1
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value
    while at < len(payload):
        key = number()
        if key & 7 == 2:
            size = number()
            found[key >> 3] = payload[at:at + size]
            at += size
        else:
            assert key & 7 == 0, 'a payload has numbers and parts with a length'
            found[key >> 3] = number()
    return found


class World:
    def __init__(self, folder, collector, feeder):
        self.database = Postgres(folder).start()
        self.broker = Broker(folder, free_port()).start()
        self.relay = Relay(self.broker.port)
        self.collector = Collector(collector, folder, self.database, self.relay.port).start()
        self.feeders = {}
        for number in range(2):
            node = f'feeder-{number}'
            one = Feeder(feeder, folder / f'store-{number}', self.broker.port, folder / f'accepted-{number}', node, WINDOW, PERIOD_MS)
            self.feeders[node] = one
            one.start()

    def stored(self):
        """{node: {number: rows}}"""
        found = collections.defaultdict(collections.Counter)
        for node, number, rows in self.database.ask(COUNTS):
            found[node][int(number)] = int(rows)
        return found

    def lose_messages(self, gaps, chance):
        wait_for(lambda: self.database.psql('SELECT FROM reading LIMIT 1').returncode == 0, 'the tables are there')
        wait_for(lambda: all(self.stored()[node] for node in self.feeders), 'values are stored')
        for _ in range(gaps):
            time.sleep(chance.uniform(0.2, 1.5))
            node = chance.choice(list(self.feeders))
            self.relay.lose(node, chance.choice(LENGTHS))
            wait_for(lambda node=node: self.relay.is_done(node), 'messages are lost')
        time.sleep(0.5)

    def judge(self):
        """The number of accepted values, and the values that are lost or stored twice. Values without a receipt are sent again
        after a restart, so every value that is missing then had been confirmed."""
        for one in self.feeders.values():
            one.kill()
        accepted = {node: one.numbers() for node, one in self.feeders.items()}
        for one in self.feeders.values():
            one.start()
        end, lost = time.monotonic() + 30, True
        while lost and time.monotonic() < end:
            time.sleep(0.3)
            there = self.stored()
            lost = [(node, number) for node, numbers in accepted.items() for number in numbers if not there[node][number]]
        doubled = [(node, number) for node in accepted for number, rows in there[node].items() if number != 0 and rows > 1]
        return sum(map(len, accepted.values())), lost, doubled

    def end(self):
        for one in self.feeders.values():
            one.kill()
        self.collector.kill()
        self.broker.kill()
        self.database.end()


def main():
    skip_without_database()
    collector, feeder, _root = sys.argv[1:4]
    gaps = int(sys.argv[4]) if len(sys.argv) > 4 else 6
    seed = int(sys.argv[5]) if len(sys.argv) > 5 else random.randrange(10**6)
    print(f'{gaps} gaps, seed {seed}', flush=True)
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        world = World(pathlib.Path(name), collector, feeder)
        try:
            world.lose_messages(gaps, chance)
            accepted, lost, doubled = world.judge()
        except (TimeoutError, RuntimeError):
            print(world.collector.log.read_text()[-2000:], world.database.log.read_text()[-2000:])
            raise
        finally:
            world.end()
        relay = world.relay
        print(f'{dict(relay.lost)} messages lost on the way: {accepted} values accepted, {len(lost)} lost, {len(doubled)} doubled')
        for what, found in (('lost', lost), ('doubled', doubled), ('wrong', relay.problems)):
            if found:
                print(what, found[:20])
        sys.exit(1 if lost or doubled or relay.problems or not accepted else 0)


if __name__ == '__main__':
    main()
