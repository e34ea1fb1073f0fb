#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the sums of `millwright shop` from its table of runs with the functions of the first schema steps, which calculate
them from all values: random states, modes, programs and presences, many at the same time, stored in random order and in batches
of random size; jobs, OEE and expected end over random intervals.

usage: shop_sums.py ROOT [MACHINES [SEED]]
"""
import pathlib
import random
import re
import subprocess
import sys
import tempfile

from mill_by_hand import Findings
from shop_world import Postgres, skip_without_database

FOUND = Findings()
SPAN_S, INTERVALS = 120, 12
METRICS = {'Execution': ('ACTIVE', 'ACTIVE', 'FEED_HOLD', 'READY', 'READY', 'STOPPED', None), 'Mode': ('AUTO', 'AUTO', 'AUTO', 'MANUAL', None),
           'Program/Path': ('/nc/a.ngc', '/nc/b.ngc', '/other/a.ngc', '', None), 'Program/Ended': ('1',)}
JUDGED = 'execution|jobs|oee|expected_end'


def steps(root):
    return [path.read_text() for path in sorted(pathlib.Path(root, 'src/clients/shop/store/schema').glob('*.sql'))]


def judge(root):
    """Installs the functions of steps 2 and 4 under other names."""
    folder = pathlib.Path(root, 'src/clients/shop/store/schema')
    text = (folder / '002_sums.sql').read_text() + (folder / '004_page.sql').read_text()
    found = re.findall(rf'CREATE FUNCTION (?:{JUDGED})\(.*?\n\$\$;', text, re.S)
    return re.sub(rf'\b({JUDGED})\(', r'judge_\1(', '\n'.join(found))


def run_sql(database, sql):
    """Rows as texts; each statement is a transaction."""
    done = subprocess.run([str(database.bin / 'psql'), '-X', '-q', '-A', '-t', '-v', 'ON_ERROR_STOP=1', database.connection], input=sql,
                          capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return [line.split('|') for line in done.stdout.splitlines()]


def text_of(value):
    return 'NULL' if value is None else f"'{value}'"


def time_of(second):
    return f"now_then() + interval '{second} s'"


def random_events(chance, machine):
    """(table, values without brackets) of one machine; times are multiples of half a second."""
    keys = set()
    for _ in range(chance.randrange(5, 90)):
        table = chance.choice(['presence', *METRICS, 'Execution', 'Execution', 'Program/Ended'])
        keys.add((table, chance.randrange(0, 2 * SPAN_S) / 2))
    for table, at in keys:
        if table == 'presence':
            yield table, f"{machine}, {time_of(at)}, {chance.random() < 0.7}"
        else:
            yield 'job_reading', f"(SELECT id FROM metric WHERE machine = {machine} AND name = '{table}'), {time_of(at)}, {text_of(chance.choice(METRICS[table]))}"


def fill(database, chance, machines):
    """In batches: values as the collector stores them, in any order."""
    sql = ["CREATE TABLE origin AS SELECT date_trunc('second', now()) - interval '100 s' AS at;"
           'CREATE FUNCTION now_then() RETURNS timestamptz LANGUAGE sql STABLE AS $$ SELECT at FROM origin $$;'
           'CREATE TABLE reading_now PARTITION OF reading DEFAULT;'
           f"INSERT INTO machine (grp, node, device) SELECT 'plant', number::text, 'Mill' FROM generate_series(1, {machines}) AS number;"]
    names = ', '.join(f"('{name}')" for name in METRICS)
    sql.append(f"INSERT INTO metric (machine, name, unit) SELECT machine.id, name, '' FROM machine, (VALUES {names}) AS each (name);")
    for machine in range(1, machines + 1):
        events = list(random_events(chance, machine))
        # In order, as a connected machine sends them, or not.
        if chance.random() < 0.7:
            chance.shuffle(events)
        while events:
            size = chance.choice((1, 2, 5, 30))
            batch, events = events[:size], events[size:]
            for table in ('job_reading', 'presence'):
                rows = ', '.join(f'({row})' for name, row in batch if name == table)
                if rows:
                    sql.append(f'INSERT INTO {table} VALUES {rows};')
    sql.append('INSERT INTO reading (metric, at, text) SELECT metric, at, text FROM job_reading;'
               "INSERT INTO cycle_time VALUES ('a.ngc', '3 s');"
               f"INSERT INTO rejected_part SELECT id, {time_of(50)}, 1 FROM machine WHERE id % 3 = 0;")
    run_sql(database, '\n'.join(sql))


def compare(database, chance, what, columns):
    """Intervals of all machines for which the two functions differ."""
    pairs = []
    for _ in range(INTERVALS):
        first, last = sorted(chance.sample(range(-4, 2 * SPAN_S + 8), 2))
        pairs.append(f"({time_of(first / 2)}, {time_of(last / 2)})")
    return run_sql(database, f'''WITH span (a, b) AS (VALUES {', '.join(pairs)}), two AS (
        SELECT machine.id, a, b, (SELECT array_agg(one::text ORDER BY one::text) FROM (SELECT {columns} FROM {what}(machine.id, a, b)) AS one) AS mine,
            (SELECT array_agg(one::text ORDER BY one::text) FROM (SELECT {columns} FROM judge_{what}(machine.id, a, b)) AS one) AS judged
        FROM machine, span WHERE a < now())
        SELECT * FROM two WHERE mine IS DISTINCT FROM judged;''')


def check_migration(database, root, count):
    """A new table of runs from the stored values contains the same runs."""
    before = run_sql(database, 'SELECT * FROM run ORDER BY machine, begins;')
    run_sql(database, 'DELETE FROM run; SELECT renew_runs(id, \'-infinity\', \'infinity\') FROM machine;')
    after = run_sql(database, 'SELECT * FROM run ORDER BY machine, begins;')
    FOUND.expect(before == after and len(before) > count, 'runs that are calculated at once', len(before), len(after))


def main():
    skip_without_database()
    root = sys.argv[1]
    machines = int(sys.argv[2]) if len(sys.argv) > 2 else 60
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(10**6)
    print(f'{machines} machines, seed {seed}', flush=True)
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        database = Postgres(name).start()
        try:
            run_sql(database, '\n;'.join(steps(root)) + judge(root))
            fill(database, chance, machines)
            for what, columns in (('jobs', '*'), ('execution', '*'),
                                  ('oee', 'availability::numeric(12, 6), performance::numeric(12, 6), quality, oee::numeric(12, 6), parts')):
                wrong = compare(database, chance, what, columns)
                FOUND.expect(not wrong, f'{what} as calculated from all values', len(wrong), *wrong[:3])
            ends = run_sql(database, 'SELECT id, expected_end(id), judge_expected_end(id) FROM machine;')
            FOUND.expect(all(mine == judged for _, mine, judged in ends), 'expected ends', ends)
            if machines >= 20:
                FOUND.expect(any(mine for _, mine, _judged in ends), 'a machine with an expected end', ends)
            check_migration(database, root, machines)
        finally:
            database.end()
    sys.exit(FOUND.status())


if __name__ == '__main__':
    main()
