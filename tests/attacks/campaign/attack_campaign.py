#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs seeds of the attack campaign on several machines at once, and prints the totals. A machine serves seeds until one of them
ends it.

usage: attack_campaign.py --prefix BUILD_FOLDER [--first S --count N | --seed S] [--jobs N] [--log FILE] [--self-test]
"""
import argparse
import collections
import contextlib
import json
import os
import pathlib
import queue
import shutil
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.insert(0, str(HERE))
import plan as plans  # noqa: E402  pylint: disable=wrong-import-position
from self_test import FAULTS  # noqa: E402  pylint: disable=wrong-import-position

SEEDS_OF_A_MACHINE = 20
SESSION_S = 180
DISK_MB = 64
LATE = 'the computer was late'
# A separate mount namespace with a small disk in a file, for full and slow disks. It disappears when the
# session ends.
DISK = 'mount -o loop "$1/disk.img" "$1/m" && rm "$1/disk.img" && export MW_ATTACK_DEVICE=$(mountpoint -d "$1/m"); export TMPDIR="$1/m"; shift; exec "$@"'


class Campaign:
    def __init__(self, options):
        self.options = options
        self.lock = threading.Lock()
        self.counts, self.attacks = collections.Counter(), collections.Counter()
        self.isDiskPossible = os.geteuid() == 0 and subprocess.run(['unshare', '-m', 'true'], check=False, capture_output=True).returncode == 0
        self.slowest_abort_ms = 0
        self.blocks = queue.Queue()

    def tell(self, text):
        with self.lock:
            print(text, flush=True)
            if self.options.log:
                with open(self.options.log, 'a', encoding='utf-8', errors='surrogateescape') as log:  # messages may be invalid UTF-8
                    log.write(text + '\n')

    def session(self, seeds, *more):
        """Runs seeds on one machine: (answers of the seeds, failures at the end of the machine)."""
        place = pathlib.Path(tempfile.mkdtemp(prefix='mw_attack_'))
        (place / 'm').mkdir()
        words = [sys.executable, HERE / 'session.py', self.options.prefix / 'bin', ROOT, *more, *map(str, seeds)]
        env = dict(os.environ, TMPDIR=str(place))
        if self.isDiskPossible:
            subprocess.run(['sh', '-c', f'truncate -s {DISK_MB}M "$1" && mkfs.ext4 -q -m 0 "$1"', 'sh', place / 'disk.img'], check=True, capture_output=True)
            words = ['unshare', '-m', 'sh', '-c', DISK, 'sh', place, *words]
        try:
            with tempfile.TemporaryFile('w+') as errors:
                done = subprocess.run(words, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=errors, text=True, check=False, timeout=SESSION_S,
                                      # a shell that ends during the campaign sends SIGHUP to stopped
                                      # processes
                                      start_new_session=True)
                errors.seek(0)
                complaint, output = errors.read(), done.stdout
        except subprocess.TimeoutExpired as late:
            output, complaint = (late.stdout or b'').decode(), 'the session did not end'
        finally:
            shutil.rmtree(place, ignore_errors=True)
        answers = [json.loads(line) for line in output.splitlines()]
        if not answers or 'end' not in answers[-1]:
            seed = seeds[min(len(answers), len(seeds) - 1)]
            complaint = complaint if len(complaint) < 2000 else complaint[:1000] + ' ... ' + complaint[-1000:]
            return [*answers, {'seed': seed, 'what': self.words(seed), 'failures': [], 'notes': []}], [f'session: {complaint}']
        self.found = answers[-1]['found']
        return answers[:-1], answers[-1]['end']

    @staticmethod
    def words(seed):
        return ', '.join(name for name, _, _ in plans.make(seed).attacks)

    def worker(self):
        while True:
            try:
                seeds = self.blocks.get_nowait()
            except queue.Empty:
                return
            while seeds:
                answers, at_end = self.session(seeds)
                answers[-1]['failures'] += at_end
                for answer in answers:
                    self.judge(answer)
                seeds = seeds[len(answers):]

    def judge(self, answer):
        """Repeats a failure alone, at most twice, if the computer was late during the failure."""
        seed, failures = answer['seed'], answer['failures']
        for _ in range(2):
            if not failures or not all(LATE in text for text in failures):
                break
            self.tell(f'late {seed}: {failures[0]}')
            self.counts['repeated, as the computer was late'] += 1
            answers, at_end = self.session([seed])
            failures = (answers[0]['failures'] if answers else []) + at_end
        self.counts['runs'] += 1
        self.slowest_abort_ms = max(self.slowest_abort_ms, answer.get('abort_ms', 0))
        for name, _, _ in plans.make(seed).attacks:
            self.attacks[name] += 1
        if failures:
            self.counts['failed'] += 1
            self.counts[failures[0].split(':')[0]] += 1
            self.tell(f'FAIL {seed} [{answer["what"]}]: {" | ".join(failures)}\n     repeat: script/campaign attacks --seed {seed}')
        elif self.options.verbose:
            self.tell(f'ok {seed} [{answer["what"]}] {answer["notes"] or ""}')
        if self.counts['runs'] % 100 == 0:
            self.tell(f'{self.counts["runs"]} runs, {self.counts["failed"]} failed, {time.monotonic() - self.begin:.0f} s')

    def run(self):
        self.begin = time.monotonic()
        options = self.options
        seeds = [options.seed] if options.seed is not None else list(range(options.first, options.first + options.count))
        for i in range(0, len(seeds), SEEDS_OF_A_MACHINE):
            self.blocks.put(seeds[i:i + SEEDS_OF_A_MACHINE])
        workers = [threading.Thread(target=self.worker) for _ in range(options.jobs)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.tell(', '.join(f'{name}: {count}' for name, count in self.counts.items()) + f'; {time.monotonic() - self.begin:.0f} s')
        self.tell(f'slowest answer to an abort: {self.slowest_abort_ms} ms')
        self.tell('attacks: ' + ', '.join(f'{name} {count}' for name, count in sorted(self.attacks.items())))
        return 1 if self.counts['failed'] else 0

    def self_test(self):
        """Checks that each judge reports the fault that it must detect."""
        seed = next(seed for seed in range(1, 10_000) if [name for name, _, _ in plans.make(seed).attacks] == ['web.tokens'])
        self.found = {}
        answers, at_end = self.session([seed], '--self-test')
        silent = []
        for fault, expected in FAULTS.items():
            failures = self.found.get(fault, at_end)
            first = next((text for text in failures if text.startswith(expected)), None)
            self.tell(f'{"found" if first else "NOT FOUND"} {fault}: {first or failures}')
            if first is None:
                silent.append(fault)
        sound = self.found.get('sound', ['no record']) + [text for answer in answers for text in answer['failures']]
        if sound:
            self.tell(f'the sound run failed: {sound}')
        return 1 if silent or sound else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--prefix', type=pathlib.Path, default=ROOT / 'build/release', help='folder with bin and lib of the programs')
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--count', type=int, default=100)
    parser.add_argument('--seed', type=int, help='this one alone')
    parser.add_argument('--jobs', type=int, default=2, help='machines at a time')
    parser.add_argument('--log', help='append what is printed')
    parser.add_argument('--verbose', action='store_true', help='a line for each seed')
    parser.add_argument('--self-test', action='store_true', help='put faults into runs; each judge must report its own')
    options = parser.parse_args()
    campaign = Campaign(options)
    with contextlib.suppress(KeyboardInterrupt):
        sys.exit(campaign.self_test() if options.self_test else campaign.run())


if __name__ == '__main__':
    main()
