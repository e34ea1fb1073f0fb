#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures the queries of the shop page with many machines and several days of jobs in the tables. Half of the machines run a
program.

usage: shop_queries.py [--machines N] [--jobs N] [--days N]
"""
import argparse
import pathlib
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'tests/e2e'))
from shop_sums import METRICS, judge, run_sql, steps  # noqa: E402
from shop_world import Postgres, skip_without_database  # noqa: E402

TIMES = 5


def timed(database, sql):
    begin = time.monotonic()
    run_sql(database, sql)
    return time.monotonic() - begin


def fill(database, words):
    """Each job: ACTIVE, feed hold, ACTIVE, Program/Ended, READY. The last job of every second machine has not ended."""
    period_s = 86400 * words.days / words.jobs
    names = ', '.join(f"('{name}')" for name in METRICS)
    days = ''.join(f"DO $$ BEGIN EXECUTE format('CREATE TABLE reading_%s PARTITION OF reading FOR VALUES FROM (%L) TO (%L)', {day}, "
                   f"current_date - {words.days + 1} + {day}, current_date - {words.days + 1} + {day + 1}); END $$;" for day in range(words.days + 3))
    run_sql(database, f"SET TIME ZONE 'UTC'; {days}"
            f"INSERT INTO machine (grp, node, device) SELECT 'plant', number::text, 'Mill' FROM generate_series(1, {words.machines}) AS number;"
            f"INSERT INTO metric (machine, name, unit) SELECT machine.id, name, '' FROM machine, (VALUES {names}) AS each (name);"
            "INSERT INTO cycle_time VALUES ('part3.ngc', '3 min'), ('part4.ngc', '4 min'); ")
    insert = f'''INSERT INTO TABLE_NAME (metric, at, text)
        SELECT metric.id, now() - interval '{words.days} days' + (job + machine % 7 / 7.0 - 0.3 + share) * {period_s} * interval '1 s', CASE name
            WHEN 'Mode' THEN 'AUTO' WHEN 'Program/Path' THEN '/nc/part' || (machine + job) % 5 || '.ngc' WHEN 'Program/Ended' THEN '1' ELSE state END
        FROM metric JOIN (VALUES ('Execution', 0.1, 'ACTIVE'), ('Execution', 0.3, 'FEED_HOLD'), ('Execution', 0.35, 'ACTIVE'), ('Execution', 0.8, 'READY'),
            ('Program/Ended', 0.79, ''), ('Program/Path', 0.05, ''), ('Mode', 0.04, '')) AS each (name, share, state) USING (name),
            generate_series(0, {words.jobs - 1}) AS job
        WHERE NOT (job = {words.jobs - 1} AND machine % 2 = 0 AND share > 0.4) AND (name <> 'Mode' OR job % 20 = 0)'''
    seconds = timed(database, insert.replace('TABLE_NAME', 'reading') + ';')
    print(f'values written in {seconds:.0f} s', flush=True)
    seconds = timed(database, f"INSERT INTO presence SELECT id, now() - interval '{words.days + 1} days', true FROM machine;" + insert.replace('TABLE_NAME', 'job_reading') + ';')
    print(f'runs written in {seconds:.0f} s', flush=True)
    run_sql(database, 'VACUUM ANALYZE;')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--machines', type=int, default=1000)
    parser.add_argument('--jobs', type=int, default=2000, help='of each machine')
    parser.add_argument('--days', type=int, default=7)
    words = parser.parse_args()
    skip_without_database()
    with tempfile.TemporaryDirectory() as name:
        database = Postgres(name).start()
        try:
            run_sql(database, '\n;'.join(steps(ROOT)) + judge(ROOT))
            fill(database, words)
            every_day = "UPDATE shift SET weekdays = '{1,2,3,4,5,6,7}';"
            run_sql(database, every_day)
            for what in ('page_machines()', 'page_sums()', f'page_history(1, {words.days})', 'page_history(1, 366)'):
                times = sorted(timed(database, f"SET jit = off; SET TIME ZONE 'UTC'; SELECT length({what}::text);") for _ in range(TIMES))
                print(f'{what}: {times[0]:.3f} to {times[-1]:.3f} s, median {times[TIMES // 2]:.3f} s', flush=True)
        finally:
            database.end()


if __name__ == '__main__':
    main()
