#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""No value that the publisher has accepted is lost or duplicated while broker, publisher and host application are killed at
random times, and while the broker hangs. The publisher is publish-feeder, which counts; the key of a value is its metric and its
time.

usage: publish_kills.py FEEDER ROOT [KILLS [SEED]]
"""
import collections
import pathlib
import random
import subprocess
import sys
import tempfile
import time

from publish_shop import Broker, Host, free_port, make_decoder, wait_for


class Feeder:
    def __init__(self, program, store, port, accepted, node='feeder', *more):
        self.words, self.accepted, self.process = [program, str(store), str(port)], accepted, None
        self.node, self.more = node, [str(word) for word in more]

    def numbers(self):
        """The numbers that it has accepted; a last line that the kill has truncated does not count."""
        text = self.accepted.read_text() if self.accepted.exists() else ''
        return [int(line) for line in text[:text.rfind('\n') + 1].split()]

    def start(self):
        first = max(self.numbers(), default=0) + 1
        with open(self.accepted, 'a') as out:
            if self.accepted.stat().st_size:
                out.write('\n')
                out.flush()
            # A number that was accepted but not printed is sent again with another time: numbers leave a gap.
            self.process = subprocess.Popen([*self.words, str(first + 10), self.node, *self.more], stdout=out, stderr=subprocess.DEVNULL)

    def kill(self):
        self.process.kill()
        self.process.wait()


def main():
    program, root = sys.argv[1:3]
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 12
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else random.randrange(10**6)
    print(f'{kills} kills, seed {seed}', flush=True)
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        decoder = make_decoder(root, folder)
        broker = Broker(folder, free_port()).start()
        host = Host(decoder, broker.port, 'shop')
        feeder = Feeder(program, folder / 'store', broker.port, folder / 'accepted')
        feeder.start()
        stored, problems, counts = {}, [], collections.Counter()

        def collect():
            with host.lock:
                stored.update({key: value for key, value in host.stored.items() if key[1] == 'Count'})
                problems.extend(host.problems)
                host.problems.clear()
        try:
            for _ in range(kills):
                time.sleep(chance.uniform(0.05, 1.5))
                what = chance.choice(['broker', 'feeder', 'host', 'hang'])
                counts[what] += 1
                if what == 'broker':
                    broker.kill()
                    time.sleep(chance.uniform(0, 0.5))
                    broker.start()
                elif what == 'feeder':
                    feeder.kill()
                    feeder.start()
                elif what == 'host':
                    # As after a kill: the connection ends without a message, and data in its socket are lost.
                    host.client._sock_close()
                    collect()
                    host.client.loop_stop()
                    host = Host(decoder, broker.port, 'shop')
                else:
                    broker.hang()
                    time.sleep(chance.uniform(0.5, 4))
                    broker.go_on()
            wait_for(lambda: host.count('NBIRTH') > 0, 'the node is born after all')
            time.sleep(1)
            feeder.kill()
            feeder.start()
            last = feeder.numbers()
            goal = max(last)

            def is_complete():
                collect()
                return goal in stored.values()
            wait_for(is_complete, f'{goal} is stored', 60)
            time.sleep(3)
            collect()
        finally:
            feeder.kill()
            broker.kill()
            host.client.loop_stop()
        accepted = [number for number in feeder.numbers() if number <= goal]
        times = collections.Counter(value for value in stored.values() if value)
        lost = [number for number in accepted if times[number] == 0]
        doubled = [number for number in accepted if times[number] > 1]
        problems = [problem for problem in problems if 'two values' in problem or 'unknown alias' in problem]
        print(f'{dict(counts)}: {len(accepted)} values accepted, {len(lost)} lost, {len(doubled)} doubled, {len(problems)} problems')
        for what, found in (('lost', lost), ('doubled', doubled), ('problems', problems)):
            if found:
                print(what, found[:20])
        sys.exit(1 if lost or doubled or problems or not accepted else 0)


if __name__ == '__main__':
    main()
