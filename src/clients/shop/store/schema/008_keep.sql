-- KEEP_DAYS leaves nothing behind.
-- When each table of readings was written. Tables of days: the last time; reading_before and reading_after: the first time since they were empty.
CREATE TABLE reading_day (
    name text PRIMARY KEY,
    day date NOT NULL,
    written date NOT NULL
);
INSERT INTO reading_day SELECT relname, to_date(right(relname, 8), 'YYYYMMDD'), least(to_date(right(relname, 8), 'YYYYMMDD'), (now() AT TIME ZONE 'UTC')::date)
    FROM pg_inherits JOIN pg_class ON pg_class.oid = inhrelid WHERE inhparent = 'reading'::regclass AND relname ~ '^reading_[0-9]{8}$';
INSERT INTO reading_day SELECT 'reading_before', '2019-12-31', (now() AT TIME ZONE 'UTC')::date WHERE EXISTS (SELECT FROM reading_before);
INSERT INTO reading_day SELECT 'reading_after', '2100-01-01', (now() AT TIME ZONE 'UTC')::date WHERE EXISTS (SELECT FROM reading_after);

-- ATTACH PARTITION waits for no reader; CREATE TABLE ... PARTITION OF does.
CREATE OR REPLACE FUNCTION add_day(day date) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
    today date := (now() AT TIME ZONE 'UTC')::date;
    table_name text := CASE WHEN add_day.day < '2020-01-01' THEN 'reading_before' WHEN add_day.day >= '2100-01-01' THEN 'reading_after'
        ELSE 'reading_' || to_char(add_day.day, 'YYYYMMDD') END;
BEGIN
    PERFORM pg_advisory_xact_lock(hashtext('millwright shop schema'));
    IF to_regclass(table_name) IS NULL THEN
        EXECUTE format('CREATE TABLE %I (LIKE reading)', table_name);
        EXECUTE format('ALTER TABLE reading ATTACH PARTITION %I FOR VALUES FROM (%L) TO (%L)', table_name, add_day.day || ' 00:00:00+00', add_day.day + 1 || ' 00:00:00+00');
    END IF;
    INSERT INTO reading_day VALUES (table_name, add_day.day, today) ON CONFLICT (name) DO UPDATE SET written = today
        WHERE reading_day.written < today AND reading_day.name NOT IN ('reading_before', 'reading_after');
END
$$;

CREATE FUNCTION keep_newest(table_name text) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE format('INSERT INTO kept_reading SELECT newest.* FROM metric CROSS JOIN LATERAL (SELECT * FROM %I WHERE metric = metric.id ORDER BY at DESC LIMIT 1) AS newest '
        'ON CONFLICT (metric) DO UPDATE SET at = EXCLUDED.at, number = EXCLUDED.number, whole = EXCLUDED.whole, text = EXCLUDED.text '
        'WHERE EXCLUDED.at > kept_reading.at', table_name);
END
$$;

-- The first reading of a machine that is kept, or a later bound: late values are in the sums for as long as they are there.
CREATE FUNCTION first_reading(of_machine integer, bound timestamptz) RETURNS timestamptz LANGUAGE sql STABLE AS $$
    SELECT least(bound, min(at)) FROM metric CROSS JOIN LATERAL (SELECT at FROM reading WHERE reading.metric = metric.id ORDER BY at LIMIT 1) AS first
    WHERE machine = of_machine AND name IN ('Execution', 'Mode', 'Program/Path', 'Program/Ended')
$$;
CREATE FUNCTION first_needed(of_machine integer, bound timestamptz) RETURNS timestamptz LANGUAGE sql STABLE AS $$
    SELECT least(first_reading(of_machine, bound), min(begins)) FROM run WHERE machine = of_machine
$$;

-- Removes tables of readings that were last written before a day, except the newest value of each metric: late values, and those of a wrong
-- clock, are kept as long as others. Tables that another session reads stay until the next time.
CREATE OR REPLACE FUNCTION drop_days(first_kept date) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
    old reading_day;
    kept timestamptz := (first_kept || ' 00:00:00+00')::timestamptz;
BEGIN
    PERFORM pg_advisory_xact_lock(hashtext('millwright shop schema')), set_config('lock_timeout', '500ms', true);
    FOR old IN SELECT * FROM reading_day WHERE written < first_kept ORDER BY day LOOP
        BEGIN
            PERFORM keep_newest(old.name);
            IF old.name IN ('reading_before', 'reading_after') THEN
                EXECUTE format('DELETE FROM %I', old.name);
            ELSE
                EXECUTE format('DROP TABLE %I', old.name);
            END IF;
            DELETE FROM reading_day WHERE name = old.name;
        EXCEPTION WHEN lock_not_available THEN
            EXIT;  -- the others would wait, too
        END;
    END LOOP;
    -- Runs that are kept are calculated from their readings, and from the newest ones before them.
    DELETE FROM run WHERE ends < first_reading(machine, kept);
    DELETE FROM job_reading USING (
        SELECT metric.id, (SELECT max(at) FROM job_reading WHERE job_reading.metric = metric.id AND at < first_needed(metric.machine, kept)) AS newest
        FROM metric WHERE name IN ('Execution', 'Mode', 'Program/Path', 'Program/Ended')
    ) AS bound WHERE job_reading.metric = bound.id AND job_reading.at < bound.newest;
    DELETE FROM presence USING (
        SELECT machine.id, (SELECT max(at) FROM presence WHERE presence.machine = machine.id AND at < first_needed(machine.id, kept)) AS newest FROM machine
    ) AS bound WHERE presence.machine = bound.id AND presence.at < bound.newest;
    DELETE FROM notification WHERE received < kept;
EXCEPTION WHEN lock_not_available THEN
    RETURN;
END
$$;
