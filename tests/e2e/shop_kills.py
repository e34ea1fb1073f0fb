#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""No value that publishers have accepted is lost or duplicated in the database of `millwright shop` while broker, database,
collector and publishers are killed or hang at random times. Publishers are publish-feeders, which count; each prints a number
after it has accepted it.

usage: shop_kills.py COLLECTOR FEEDER ROOT [KILLS [SEED [PUBLISHERS]]]
"""
import collections
import pathlib
import random
import signal
import sys
import tempfile
import time

from publish_kills import Feeder
from publish_shop import Broker, free_port, wait_for
from shop_world import Collector, Postgres, skip_without_database

COUNTS = '''SELECT machine.node, coalesce(reading.whole, -1), count(*) FROM reading JOIN metric ON metric.id = reading.metric
    JOIN machine ON machine.id = metric.machine WHERE metric.name = 'Count' GROUP BY 1, 2'''


class World:
    def __init__(self, words, folder, publishers):
        collector, feeder = words
        self.database = Postgres(folder).start()
        self.broker = Broker(folder, free_port()).start()
        self.collector = Collector(collector, folder, self.database, self.broker.port).start()
        self.feeders = {}
        for number in range(publishers):
            node = f'feeder-{number}'
            one = Feeder(feeder, folder / f'store-{number}', self.broker.port, folder / f'accepted-{number}', node)
            self.feeders[node] = one
            one.start()

    def disturb(self, chance):
        """Kills a part, or stops it for a time; returns a description."""
        part = chance.choice(['broker', 'database', 'collector', 'publisher'])
        kind = chance.choice(['kill', 'hang'])
        if part == 'publisher':
            one = chance.choice(list(self.feeders.values()))
            one.kill()
            time.sleep(chance.uniform(0, 0.5))
            one.start()
            return 'publisher killed'
        target = {'broker': self.broker, 'database': self.database, 'collector': self.collector}[part]
        if kind == 'hang':
            self.hang(target, chance.uniform(0.1, 3), chance.random() < 0.5)
            return f'{part} hung'
        target.kill()
        time.sleep(chance.uniform(0, 1))
        target.start()
        return f'{part} killed'

    def hang(self, target, seconds, is_killed):
        """A hanging part may be killed before it continues."""
        if target is self.database:
            family = target.family()
            target.signal(signal.SIGSTOP, family)
            time.sleep(seconds)
            if is_killed:
                target.kill()
                target.start()
            else:
                target.signal(signal.SIGCONT, family)
            return
        target.hang()
        time.sleep(seconds)
        if is_killed:
            target.process.kill()
            target.process.wait()
            target.start()
        else:
            target.go_on()

    def stored(self):
        """{node: {number: rows}}"""
        found = collections.defaultdict(collections.Counter)
        for node, number, rows in self.database.ask(COUNTS):
            found[node][int(number)] = int(rows)
        return found

    def end(self):
        for one in self.feeders.values():
            one.kill()
        self.collector.kill()
        self.broker.kill()
        self.database.end()


def judge(world, accepted):
    """Numbers that are lost, and numbers that are stored twice. Births have the number 0."""
    stored, lost, doubled = world.stored(), [], []
    for node, numbers in accepted.items():
        lost += [(node, number) for number in numbers if stored[node][number] == 0]
        doubled += [(node, number) for number, rows in stored[node].items() if number != 0 and rows > 1]
    return lost, doubled


def main():
    skip_without_database()
    collector, feeder, _root = sys.argv[1:4]
    kills = int(sys.argv[4]) if len(sys.argv) > 4 else 3
    seed = int(sys.argv[5]) if len(sys.argv) > 5 else random.randrange(10**6)
    publishers = int(sys.argv[6]) if len(sys.argv) > 6 else 3
    print(f'{kills} kills, seed {seed}, {publishers} publishers', flush=True)
    chance, counts = random.Random(seed), collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        world = World((collector, feeder), folder, publishers)
        try:
            for _ in range(kills):
                time.sleep(chance.uniform(0.05, 1))
                counts[world.disturb(chance)] += 1
            time.sleep(0.5)
            goals = {node: max(one.numbers(), default=0) for node, one in world.feeders.items()}

            def is_complete():
                stored = world.stored()
                return all(goal and stored[node][goal] for node, goal in goals.items())
            wait_for(is_complete, f'{goals} are stored', 60)
            accepted = {node: [number for number in one.numbers() if number <= goals[node]] for node, one in world.feeders.items()}
            # The history is complete later than the current values.
            end = time.monotonic() + 30
            while judge(world, accepted)[0] and time.monotonic() < end:
                time.sleep(0.2)
            lost, doubled = judge(world, accepted)
        except (TimeoutError, RuntimeError):
            print(world.collector.log.read_text()[-2000:], world.database.log.read_text()[-2000:])
            raise
        finally:
            world.end()
        total = sum(map(len, accepted.values()))
        print(f'{dict(counts)}: {total} values accepted, {len(lost)} lost, {len(doubled)} doubled')
        for what, found in (('lost', lost), ('doubled', doubled)):
            if found:
                print(what, found[:20])
                print((folder / 'collector.log').read_text()[-2000:])
        sys.exit(1 if lost or doubled or not total else 0)


if __name__ == '__main__':
    main()
