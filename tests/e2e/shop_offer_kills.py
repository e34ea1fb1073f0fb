#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""No offer is lost or doubled while broker, database, collector, publisher and screen are killed or hang at random times. A planner offers and
withdraws programs, an operator accepts and declines them. The judge compares three records: what the planner was told, the rows of the
database, and the files of the machine.

usage: shop_offer_kills.py COLLECTOR MILLWRIGHT HALCMD ROOT [KILLS [SEED]]
"""
import collections
import json
import pathlib
import random
import signal
import sys
import tempfile
import time
import uuid

from mill_by_hand import Mill
from offer_world import Machine, Planner, add_machine, hash_of, page_port, program
from publish_shop import Broker, free_port, wait_for
from shop_world import Collector, Postgres, skip_without_database

FINAL = ('accepted', 'declined', 'withdrawn')
NODES = ('cell-1', 'cell-2')


class World:
    def __init__(self, words, folder, chance):
        collector, millwright, halcmd, root = words
        self.chance, self.folder = chance, folder
        self.database = Postgres(folder).start()
        self.broker = Broker(folder, free_port()).start()
        self.page = free_port()
        self.collector = Collector(collector, folder, self.database, self.broker.port, f'PORT = {self.page}').start()
        page_port(self.collector)
        wait_for(lambda: self.database.psql("SELECT 'offer'::regclass").returncode == 0, 'the tables exist')
        self.planner, self.machines, self.numbers = Planner(self.page), {}, {}
        for node in NODES:
            place = folder / node
            place.mkdir()
            machine = Machine(Mill(millwright, halcmd, root, place, f'offers-{node}'), self.broker.port, node)
            machine.start_publisher()
            machine.start_screen()
            self.machines[node], self.numbers[node] = machine, add_machine(self.database, node)
        self.asked = {}      # (request, node): files; every request of the planner is repeated until it is answered
        self.programs = 0    # each has its own names of files
        self.unanswered = {}  # request: files, nodes
        self.decided = {}    # (node, id): decision that the screen has confirmed

    def plan(self):
        """The planner offers a program; a request without an answer is repeated with its number."""
        if not self.unanswered or self.chance.random() < 0.5:
            self.programs += 1
            number = self.programs
            files = program(f'part{number}.ngc', f'(part {number})\nM2\n', **{f'sub{number}': 'M99\n' * self.chance.randint(1, 20000)})
            self.unanswered[str(uuid.uuid4())] = files, self.chance.sample(NODES, self.chance.randint(1, len(NODES)))
        for request, (files, nodes) in list(self.unanswered.items()):
            status, _ = self.planner.offer(files, [self.numbers[node] for node in nodes], request, parts=2, sha256=hash_of(files))
            if status == 200:
                del self.unanswered[request]
                for node in nodes:
                    self.asked[request, node] = files

    def withdraw(self):
        offers = self.planner.offers() or {}
        if offers:
            self.planner.withdraw(self.chance.choice(list(offers)))

    def operate(self):
        machine = self.machines[self.chance.choice(NODES)]
        if machine.screen.poll() is not None:
            return
        waiting = [one for one in (machine.offers() or {}).values() if one['state'] == 'received']
        if waiting:
            one = self.chance.choice(waiting)
            decision = self.chance.choice(['accept', 'decline'])
            if machine.decide(one['id'], decision)[0] == 200:
                self.decided[machine.node, one['id']] = decision

    def disturb(self):
        part = self.chance.choice(['broker', 'database', 'collector', 'publisher', 'screen'])
        if part in ('publisher', 'screen'):
            machine = self.machines[self.chance.choice(NODES)]
            process = machine.publisher if part == 'publisher' else machine.screen
            machine.stop(process)
            time.sleep(self.chance.uniform(0, 0.5))
            machine.start_publisher() if part == 'publisher' else machine.start_screen()
            return f'{part} killed'
        target = {'broker': self.broker, 'database': self.database, 'collector': self.collector}[part]
        if part != 'database' and self.chance.random() < 0.3:
            target.hang()
            time.sleep(self.chance.uniform(0.1, 2))
            target.go_on()
            return f'{part} hung'
        target.kill()
        time.sleep(self.chance.uniform(0, 1))
        target.start()
        return f'{part} killed'

    def rows(self):
        return self.database.ask("SELECT request, node, offer.id, state, sha256, coalesce(ended_by, ''), withdrawn IS NOT NULL FROM offer JOIN machine "
                                 'ON machine.id = offer.machine JOIN offered_program USING (request)')

    def index(self, node):
        """The index of the machine, read without its program: {id: entry}."""
        path = self.machines[node].store / 'offers/index'
        entries = json.loads(path.read_text())['offers'] if path.exists() else []
        found = {one['id']: one for one in entries}
        assert len(found) == len(entries), 'an offer is twice in the index'
        return found

    def end(self):
        for machine in self.machines.values():
            machine.end()
        self.collector.kill()
        self.broker.kill()
        self.database.end()


def judge(world):
    """Deviations as texts."""
    wrong, rows = [], world.rows()
    counts = collections.Counter((request, node) for request, node, *_ in rows)
    for key, files in world.asked.items():
        if counts[key] != 1:
            wrong.append(f'{counts[key]} offers for one request {key}')
    if set(counts) != set(world.asked):
        wrong.append('unknown offers, or lost ones')
    indexes = {node: world.index(node) for node in NODES}
    for request, node, number, state, sha256, _by, is_withdrawn in rows:
        files, entry = world.asked.get((request, node), []), indexes[node].pop(number, None)
        name, decision = files[0]['name'] if files else '', world.decided.get((node, number))
        if sha256 != hash_of(files):
            wrong.append(f'{name}: another hash')
        if entry is None or entry['state'] != state:
            wrong.append(f'{name} at {node}: {state} in the shop, {entry and entry["state"]} at the machine')
        if decision and state != {'accept': 'accepted', 'decline': 'declined'}[decision]:
            wrong.append(f'{name} at {node}: the operator said {decision}, the state is {state}')
        if is_withdrawn == 't' and state not in FINAL:
            wrong.append(f'{name} at {node}: withdrawn and {state}')
        if state not in (*FINAL, 'received'):
            wrong.append(f'{name} at {node} is {state}')
        for one in files:
            text, is_expected = world.machines[node].text(one['name']), state == 'accepted'
            # A screen that was killed between the files and the state has written files of an offer that still waits, or was then declined.
            if is_expected and text != one['text'] or text not in (None, one['text']):
                wrong.append(f'{one["name"]} at {node}: {state}, and its file is wrong')
    wrong += [f'{node} has offers that the shop does not know' for node in NODES if indexes[node]]
    return wrong


def main():
    skip_without_database()
    words = sys.argv[1:5]
    kills = int(sys.argv[5]) if len(sys.argv) > 5 else 6
    seed = int(sys.argv[6]) if len(sys.argv) > 6 else random.randrange(10**6)
    print(f'{kills} kills, seed {seed}', flush=True)
    chance, counts = random.Random(seed), collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)
        world = World(words, folder, chance)
        try:
            for _ in range(kills):
                for act in chance.choices([world.plan, world.withdraw, world.operate], [2, 1, 4], k=chance.randint(1, 6)):
                    act()
                    time.sleep(chance.uniform(0, 1))
                counts[world.disturb()] += 1
            wait_for(lambda: world.plan() or not world.unanswered, 'the planner is answered', 90)
            end = time.monotonic() + 90
            while judge(world) and time.monotonic() < end:
                time.sleep(0.5)
            wrong = judge(world)
        finally:
            logs = world.collector.log.read_text()[-1500:] + ''.join(one.log.read_text()[-1500:] for one in world.machines.values())
            world.end()
    states = collections.Counter(world.decided.values())
    print(f'{dict(counts)}: {len(world.asked)} offers, {dict(states)} by the operator, {len(wrong)} deviations')
    print(*wrong[:20], *([logs] if wrong else []), sep='\n')
    sys.exit(1 if wrong or not world.asked else 0)


if __name__ == '__main__':
    main()
