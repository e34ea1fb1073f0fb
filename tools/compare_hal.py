#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs random HAL files on LinuxCNC and on ours and compares every output of every component in every period.

Streamers feed the components and samplers record them. Linked components run once for each order of their functions. LinuxCNC's
halrun runs as an ordinary user in separate namespaces, ours as a separate instance. Intended differences are listed in
tools/hal_differences.py, each with its row in docs/reference/compatibility.md. Exit status 1: other differences.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import pwd
import shutil
import subprocess
import sys
import tempfile

import hal_differences
from hal_components import COMPONENTS, LETTERS
from hal_files import HalFile, ROWS

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCE = '/usr/bin/halrun'
TIMEOUT_S = 60
UNBOUNDED = 1e9  # if values in a loop of linked components become this large, only rounding would be compared
ISOLATED = ['unshare', '--ipc', '--net', '--pid', '--mount', '--fork', '--kill-child', '--mount-proc', 'bash', '-c']
DIRECTIONS = ('IN', 'OUT', 'I/O', 'RO', 'RW')


class Exports:
    """The exports of a component on LinuxCNC, for each way to load it: {pin: (type, direction)}, functions in full."""

    def __init__(self, by_load):
        self.by_load = by_load

    def of_load(self, load):
        return self.by_load[load]

    def outputs(self):
        return max((([pin for pin, what in found.items() if what[-1] in ('OUT', 'I/O')])
                    for found in self.by_load.values()), key=len)


class Side:
    """One of the two systems."""

    def __init__(self, halrun, folder, is_reference):
        self.halrun, self.folder, self.is_reference = halrun, folder, is_reference
        folder.mkdir(parents=True, exist_ok=True)
        folder.chmod(0o777)

    def run(self, name, text, inputs=None):
        """(output, folder of the run)"""
        work = self.folder / name
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir()
        work.chmod(0o777)
        for file, content in {'run.hal': text, **(inputs or {})}.items():
            (work / file).write_text(content)
        command = [self.halrun, '-s', '-f', 'run.hal']
        environment = {**os.environ, 'HOME': str(work), 'MILLWRIGHT_INSTANCE': f'compare-hal-{os.getpid()}-{name}'}
        if self.is_reference and os.geteuid() == 0:
            command = [*ISOLATED, f'mount -t tmpfs -o mode=1777 none /dev/shm; exec runuser -u {ordinary_user()} -- '
                       f'env -i PATH=/usr/bin:/bin HOME={work} LANG=C.UTF-8 ' + ' '.join(command)]
        done = subprocess.run(['timeout', '-s', 'KILL', str(TIMEOUT_S), *command], cwd=work, env=environment, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return done.stdout, work

    def columns(self, name, hal_file):
        """[one list of values for each recorded output], or the output of the program if rows are missing."""
        log, work = self.run(name, hal_file.text, hal_file.inputs())
        tables = []
        for file in hal_file.outputs():
            lines = (work / file).read_text().splitlines() if (work / file).exists() else []
            rows = [line.split() for line in lines if line != 'overrun']
            if len(rows) != ROWS:
                return log or f'{file} has {len(rows)} of {ROWS} rows'
            tables += [list(column) for column in zip(*rows)]
        shutil.rmtree(work)
        return tables


def ordinary_user():
    return 'cnc' if any(entry.pw_name == 'cnc' for entry in pwd.getpwall()) else 'nobody'


def discover(reference):
    """{component: Exports} of the components that LinuxCNC has."""
    found = {name: {} for name in COMPONENTS}
    for number in range(max(len(spec.loads or ['']) for spec in COMPONENTS.values())):
        for name, spec in COMPONENTS.items():
            loads = spec.loads or [name]
            if number < len(loads):
                found[name][loads[number]] = exports_of(reference, name, loads[number])
    return {name: Exports(loads) for name, loads in found.items() if all(loads.values())}


def exports_of(reference, name, load):
    text = load if COMPONENTS[name].single else COMPONENTS[name].load_text(load, 1)
    out, work = reference.run('exports', f'loadrt {text}\nshow pin\nshow param\nshow funct\n')
    shutil.rmtree(work)
    prefix, found = COMPONENTS[name].prefix_of(name, 0), {}
    for words in map(str.split, out.splitlines()):
        if len(words) == 5 and words[2] in DIRECTIONS and words[4].startswith(prefix):
            if not words[4].endswith(('.time', '.tmax', '.tmax-increased')) and words[1] in LETTERS:
                found[words[4][len(prefix):]] = (words[1], words[2])
        elif len(words) == 6 and words[3] in ('YES', 'NO'):
            found[words[5]] = ('function',)
    return found


def is_same(kind, a, b):
    if a == b:
        return True
    if kind != 'float':
        return False
    a, b = float(a), float(b)
    if not (math.isfinite(a) and math.isfinite(b)):
        return a != a and b != b
    if min(abs(a), abs(b)) > UNBOUNDED:
        return True
    return abs(a - b) <= 2e-6 + 1e-6 * max(abs(a), abs(b))


def is_shifted(theirs, ours, rows, most):
    """Whether each different value occurs on the other side at most `most` periods earlier or later."""
    def near(values, row):
        return values[max(0, row - most):row + most + 1]
    return all(ours[row] in near(theirs, row) or theirs[row] in near(ours, row) for row in rows)


class Comparison:
    """The result of one file."""

    def __init__(self, hal_file, theirs, ours):
        self.hal_file = hal_file
        self.unexplained, self.explained = [], []
        self.values = 0
        if isinstance(theirs, str) or isinstance(ours, str):
            self.unexplained.append('did not run; LinuxCNC: ' + shown(theirs) + '; ours: ' + shown(ours))
            return
        self.theirs, self.ours = theirs, ours
        for at, (kind, instance, pin) in enumerate(hal_file.samples):
            self.values += ROWS
            self.compare_pin(kind, instance, pin, theirs[at], ours[at])

    def differs_along(self, instance, pin, rows):
        """Whether `pin` of this instance differs within 2 periods of each of these rows."""
        at = next((at for at, (_, other, name) in enumerate(self.hal_file.samples) if (other, name) == (instance, pin)), None)
        return at is not None and all(any(a != b for a, b in list(zip(self.theirs[at], self.ours[at]))[max(0, row - 2):row + 3])
                                      for row in rows)

    def compare_pin(self, kind, instance, pin, theirs, ours):
        wrong = [row for row in range(ROWS) if not is_same(kind, theirs[row], ours[row])]
        if not wrong:
            return
        difference = instance.may_differ(pin)
        if difference:
            self.explained.append(difference)
            return
        covering = [d for d in hal_differences.of_component(instance.name, instance.load) if d.covers(pin)]
        late = next((d for d in covering if d.shift and is_shifted(theirs, ours, wrong, d.shift)), None)
        if late:
            self.explained.append(late)
            return
        near = next((d for d in covering if d.by and all(abs(int(theirs[row]) - int(ours[row])) <= d.by for row in wrong)
                     or d.along and self.differs_along(instance, d.along, wrong)), None)
        if near:
            self.explained.append(near)
            return
        early = max(covering, key=lambda d: d.first, default=None)
        if early and wrong[-1] < early.first:
            self.explained.append(early)
            return
        first = wrong[0]
        self.unexplained.append(f'{instance.prefix}{pin} ({instance.load}): {len(wrong)} of {ROWS} periods, first '
                                f'{first}: LinuxCNC {theirs[first]}, ours {ours[first]}')


def shown(result):
    lines = [] if not isinstance(result, str) else [line for line in result.splitlines()
                                                    if line.strip() and not line.startswith('Note:')]
    return ' / '.join(lines[:3]) if isinstance(result, str) else 'ran'


def run_file(hal_file, reference, ours, cache):
    name = f'seed-{hal_file.seed}'
    key = hashlib.sha256(json.dumps([hal_file.text, hal_file.inputs()]).encode()).hexdigest()
    kept = cache / (key + '.json') if cache else None
    if kept and kept.exists():
        theirs = json.loads(kept.read_text())
    else:
        theirs = reference.columns(name, hal_file)
        if kept and not isinstance(theirs, str):
            kept.write_text(json.dumps(theirs))
    return Comparison(hal_file, theirs, ours.columns(name, hal_file))


def load_exports(reference, cache):
    kept = cache / 'exports.json' if cache else None
    specs = {name: spec.loads or [name] for name, spec in COMPONENTS.items()}
    if kept and kept.exists():
        stored = json.loads(kept.read_text())
        if stored['loads'] == specs:
            return {name: Exports(loads) for name, loads in stored['found'].items()}
    found = discover(reference)
    if kept:
        kept.write_text(json.dumps({'loads': specs, 'found': {name: e.by_load for name, e in found.items()}}))
    return found


def report(outcomes, exports, seeds):
    explained, used, failed = collections.Counter(), collections.Counter(), 0
    for outcome in outcomes:
        used.update(outcome.hal_file.components())
        explained.update({d.row for d in outcome.explained})
        if outcome.unexplained:
            failed += 1
            print(f'seed {outcome.hal_file.seed}:')
            for line in outcome.unexplained[:6]:
                print('  ' + line)
    for row, count in explained.most_common():
        print(f'{count:6d} files  intended: {row}')
    missing = sorted(set(exports) - set(used))
    if missing:
        print('not in any file: ' + ' '.join(missing))
    print(f'{len(outcomes)} files, seeds {seeds.start} to {seeds.stop - 1}, {len(used)} components, '
          f'{sum(o.values for o in outcomes)} values: {failed} files differ')
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('component', nargs='*', help='only these')
    parser.add_argument('--files', type=int, default=200)
    parser.add_argument('--first', type=int, default=0, help='first seed')
    parser.add_argument('--build', default='build/release', help='our build folder')
    parser.add_argument('--jobs', type=int, default=2, help='files that run at the same time')
    parser.add_argument('--cache', help="folder that keeps LinuxCNC's results for the next run")
    parser.add_argument('--show', action='store_true', help='print the files and do not run them')
    options = parser.parse_args()
    if shutil.which(REFERENCE) is None:
        sys.exit(f'{REFERENCE} is missing: install linuxcnc-uspace to compare with it')
    without = hal_differences.rows_without_page((ROOT / 'docs/reference/compatibility.md').read_text())
    if without:
        sys.exit('docs/reference/compatibility.md has no row for: ' + '; '.join(without))
    folder = pathlib.Path(tempfile.mkdtemp(prefix='compare-hal-'))
    folder.chmod(0o755)
    cache = pathlib.Path(options.cache) if options.cache else None
    if cache:
        cache.mkdir(parents=True, exist_ok=True)
    reference = Side(REFERENCE, folder / 'theirs', True)
    ours = Side(str((ROOT / options.build / 'bin/halrun').resolve()), folder / 'ours', False)
    exports = load_exports(reference, cache)
    seeds = range(options.first, options.first + options.files)
    files = [HalFile(seed, exports, options.component) for seed in seeds]
    if options.show:
        print('\n'.join(f'# seed {file.seed}\n{file.text}' for file in files))
        return
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        outcomes = list(pool.map(lambda file: run_file(file, reference, ours, cache), files))
    shutil.rmtree(folder)
    sys.exit(1 if report(outcomes, exports, seeds) else 0)


if __name__ == '__main__':
    main()
