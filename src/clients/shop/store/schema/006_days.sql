-- Days are added and removed without a wait for other sessions: an open query or a backup would make machines wait.
-- The newest value of each metric when its day was removed: it may still be the current one.
CREATE TABLE kept_reading (
    metric integer PRIMARY KEY REFERENCES metric,
    at timestamptz NOT NULL,
    number double precision,
    whole bigint,
    text text
);

-- ATTACH PARTITION waits for no reader; CREATE TABLE ... PARTITION OF does.
CREATE FUNCTION add_day(day date) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
    name text := 'reading_' || to_char(day, 'YYYYMMDD');
BEGIN
    PERFORM pg_advisory_xact_lock(hashtext('millwright shop schema'));
    IF to_regclass(name) IS NULL THEN
        EXECUTE format('CREATE TABLE %I (LIKE reading)', name);
        EXECUTE format('ALTER TABLE reading ATTACH PARTITION %I FOR VALUES FROM (%L) TO (%L)', name, day || ' 00:00:00+00', day + 1 || ' 00:00:00+00');
    END IF;
END
$$;

-- Removes the values of the days before one, except the newest value of each metric. Days that another session reads stay until the next time.
CREATE FUNCTION drop_days(first_kept date) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
    old_day text;
    kept timestamptz := (first_kept || ' 00:00:00+00')::timestamptz;
BEGIN
    PERFORM pg_advisory_xact_lock(hashtext('millwright shop schema')), set_config('lock_timeout', '500ms', true);
    FOR old_day IN SELECT relname FROM pg_inherits JOIN pg_class ON pg_class.oid = inhrelid
        WHERE inhparent = 'reading'::regclass AND relname ~ '^reading_[0-9]{8}$' AND relname < 'reading_' || to_char(first_kept, 'YYYYMMDD') ORDER BY relname
    LOOP
        EXECUTE format('INSERT INTO kept_reading SELECT newest.* FROM metric CROSS JOIN LATERAL (SELECT * FROM %I WHERE metric = metric.id ORDER BY at DESC LIMIT 1) AS newest '
            'ON CONFLICT (metric) DO UPDATE SET at = EXCLUDED.at, number = EXCLUDED.number, whole = EXCLUDED.whole, text = EXCLUDED.text '
            'WHERE EXCLUDED.at > kept_reading.at', old_day);
        EXECUTE format('DROP TABLE %I', old_day);
    END LOOP;
    DELETE FROM run WHERE ends < kept;
    -- Runs that are kept are calculated from their readings, and from the newest ones before them.
    DELETE FROM job_reading USING (
        SELECT metric.id, (SELECT max(at) FROM job_reading WHERE job_reading.metric = metric.id
            AND at < least(kept, (SELECT min(begins) FROM run WHERE run.machine = metric.machine))) AS newest FROM metric
        WHERE name IN ('Execution', 'Mode', 'Program/Path', 'Program/Ended')
    ) AS bound WHERE job_reading.metric = bound.id AND job_reading.at < bound.newest;
EXCEPTION WHEN lock_not_available THEN
    RETURN;
END
$$;

CREATE OR REPLACE FUNCTION newest(of_metric integer, before timestamptz DEFAULT 'infinity')
RETURNS reading LANGUAGE sql STABLE AS $$
    SELECT * FROM (
        (SELECT * FROM reading WHERE metric = of_metric AND at < before ORDER BY at DESC LIMIT 1)
        UNION ALL SELECT * FROM kept_reading WHERE metric = of_metric AND at < before
    ) AS each ORDER BY at DESC LIMIT 1
$$;

CREATE OR REPLACE FUNCTION page_machines() RETURNS json LANGUAGE sql STABLE AS $$
    WITH newest AS (
        SELECT metric.machine, metric.name, coalesce(last.text, last.whole::text, last.number::text) AS value
        FROM metric CROSS JOIN LATERAL (
            (SELECT text, whole, number, at FROM reading WHERE reading.metric = metric.id ORDER BY at DESC LIMIT 1)
            UNION ALL SELECT text, whole, number, at FROM kept_reading WHERE kept_reading.metric = metric.id
            ORDER BY at DESC LIMIT 1
        ) AS last
        WHERE metric.name IN ('State', 'Execution', 'Program/Path', 'Program/Line') OR metric.name LIKE 'Alarms/%'
    ),
    each AS (
        SELECT machine.id, grp, node, device,
            coalesce((SELECT alive FROM presence WHERE presence.machine = machine.id ORDER BY at DESC LIMIT 1), false) AS alive,
            max(value) FILTER (WHERE name = 'State') AS state, max(value) FILTER (WHERE name = 'Execution') AS execution,
            max(value) FILTER (WHERE name = 'Program/Path') AS program, max(value) FILTER (WHERE name = 'Program/Line') AS line,
            string_agg(value, ' ' ORDER BY name) FILTER (WHERE name LIKE 'Alarms/%' AND value <> '') AS alarms
        FROM machine LEFT JOIN newest ON newest.machine = machine.id WHERE device <> '' GROUP BY machine.id
    )
    SELECT json_build_object('at', now(), 'machines', coalesce((
        SELECT json_agg(json_build_object('id', id, 'group', grp, 'node', node, 'device', device, 'alive', alive, 'state', state,
            'execution', execution, 'program', program, 'line', line, 'alarms', alarms) ORDER BY grp, node, device) FROM each), '[]'))
$$;
