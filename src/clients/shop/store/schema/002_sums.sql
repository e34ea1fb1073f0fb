-- Shifts, and what machines did in them.
CREATE TABLE shift (
    name text PRIMARY KEY,
    begins time NOT NULL,
    lasts interval NOT NULL CHECK (lasts > '0' AND lasts <= '24 hours'),
    weekdays integer[] NOT NULL DEFAULT '{1,2,3,4,5}'  -- ISO: 1 is Monday, of the day on which the shift begins
);
INSERT INTO shift (name, begins, lasts) VALUES
    ('early', '06:00', '8 hours'), ('late', '14:00', '8 hours'), ('night', '22:00', '8 hours');

-- Filled in by the shop: the time of a good cycle, and parts that were rejected.
CREATE TABLE cycle_time (
    program text PRIMARY KEY,  -- name of the file, without folders
    ideal interval NOT NULL CHECK (ideal > '0')
);
CREATE TABLE rejected_part (
    machine integer NOT NULL REFERENCES machine,
    at timestamptz NOT NULL,
    parts integer NOT NULL CHECK (parts > 0),
    reason text NOT NULL DEFAULT '',
    PRIMARY KEY (machine, at)
);

CREATE FUNCTION metric_id(of_machine integer, of_name text) RETURNS integer LANGUAGE sql STABLE AS $$
    SELECT id FROM metric WHERE machine = of_machine AND name = of_name
$$;

-- What a machine did: one row for each interval with one value of Execution; UNAVAILABLE while it was not there.
CREATE FUNCTION execution(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (state text, begins timestamptz, ends timestamptz) LANGUAGE sql STABLE AS $$
    WITH run AS (SELECT metric_id(of_machine, 'Execution') AS id),
    events AS (
        SELECT from_time AS at, 0 AS rank, CASE
            WHEN NOT coalesce((SELECT alive FROM presence WHERE machine = of_machine AND at <= from_time ORDER BY at DESC LIMIT 1), false)
            THEN 'UNAVAILABLE' ELSE (newest((SELECT id FROM run), from_time)).text END AS state
        UNION ALL
        SELECT at, 2, text FROM reading, run WHERE metric = run.id AND at >= from_time AND at < until_time
        UNION ALL
        SELECT at, 1, CASE WHEN alive THEN (newest((SELECT id FROM run), at)).text ELSE 'UNAVAILABLE' END
        FROM presence WHERE machine = of_machine AND at > from_time AND at < until_time
    )
    SELECT coalesce(state, 'UNAVAILABLE'), at, lead(at, 1, until_time) OVER (ORDER BY at, rank)
    FROM events
$$;

-- Programs that ran: from the first interval in which the machine worked in mode AUTO to the end of the last.
CREATE FUNCTION jobs(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (program text, begins timestamptz, ends timestamptz, active interval, result text) LANGUAGE sql STABLE AS $$
    WITH part AS (
        SELECT state, begins, ends, state IN ('READY', 'STOPPED', 'UNAVAILABLE') AS is_idle
        FROM execution(of_machine, from_time, until_time) WHERE ends > begins
    ),
    numbered AS (SELECT *, count(*) FILTER (WHERE is_idle) OVER (ORDER BY begins) AS run FROM part),
    run AS (
        SELECT min(begins) AS begins, max(ends) AS ends,
            coalesce(sum(ends - begins) FILTER (WHERE state = 'ACTIVE'), '0') AS active
        FROM numbered WHERE NOT is_idle GROUP BY run
    )
    SELECT (newest(metric_id(of_machine, 'Program/Path'), run.ends)).text, run.begins, run.ends, run.active,
        CASE WHEN run.ends >= until_time THEN 'RUNNING'
            WHEN EXISTS (SELECT FROM reading WHERE metric = metric_id(of_machine, 'Program/Ended')
                AND at > run.begins AND at <= run.ends + interval '1 second') THEN 'ENDED'
            ELSE 'ABORTED' END
    FROM run WHERE upper(coalesce((newest(metric_id(of_machine, 'Mode'), run.begins + interval '1 second')).text, 'AUTO')) LIKE 'AUTO%'
$$;

CREATE FUNCTION alarms(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (at timestamptz, source text, message text) LANGUAGE sql STABLE AS $$
    SELECT reading.at, metric.name, reading.text FROM reading JOIN metric ON metric.id = reading.metric
    WHERE metric.machine = of_machine AND (metric.name LIKE 'Alarms/%' OR metric.name = 'Messages/Text')
        AND reading.at >= from_time AND reading.at < until_time AND reading.text <> ''
$$;

-- Shifts that overlap an interval, in the time zone of the session.
CREATE FUNCTION shifts(from_time timestamptz, until_time timestamptz)
RETURNS TABLE (name text, begins timestamptz, ends timestamptz) LANGUAGE sql STABLE AS $$
    SELECT name, begin_at, begin_at + lasts FROM (
        SELECT shift.name, shift.lasts, (day::date + shift.begins)::timestamptz AS begin_at, day
        FROM shift, generate_series((from_time - interval '1 day')::date::timestamp, until_time::date::timestamp, interval '1 day') AS day
        WHERE extract(isodow FROM day)::integer = ANY (shift.weekdays)
    ) AS each WHERE begin_at < until_time AND begin_at + lasts > from_time
$$;

-- Availability: time of ACTIVE by the time of the shift so far. Performance: ideal time of the programs that ended by
-- that active time; NULL where no program has a cycle_time. Quality: accepted by produced parts, one part a program.
-- OEE: the product; NULL while performance is not known.
CREATE FUNCTION oee(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (availability double precision, performance double precision, quality double precision, oee double precision, parts bigint)
LANGUAGE sql STABLE AS $$
    WITH whole AS (SELECT extract(epoch FROM least(until_time, now()) - from_time) AS s),
    active AS (
        SELECT coalesce(extract(epoch FROM sum(ends - begins)), 0) AS s
        FROM execution(of_machine, from_time, least(until_time, now())) WHERE state = 'ACTIVE'
    ),
    done AS (
        SELECT count(*) AS parts, extract(epoch FROM sum(cycle_time.ideal)) AS ideal_s,
            extract(epoch FROM sum(job.active) FILTER (WHERE cycle_time.ideal IS NOT NULL)) AS active_s
        FROM jobs(of_machine, from_time, least(until_time, now())) AS job
            LEFT JOIN cycle_time ON cycle_time.program = regexp_replace(job.program, '^.*/', '')
        WHERE job.result = 'ENDED'
    ),
    bad AS (
        SELECT coalesce(sum(parts), 0) AS parts FROM rejected_part
        WHERE machine = of_machine AND at >= from_time AND at < until_time
    ),
    factor AS (
        SELECT active.s / nullif(whole.s, 0) AS availability, done.ideal_s / nullif(done.active_s, 0) AS performance,
            CASE WHEN done.parts = 0 THEN NULL ELSE greatest(0, 1 - bad.parts::double precision / done.parts) END AS quality, done.parts
        FROM whole, active, done, bad
    )
    SELECT availability, performance, quality, availability * performance * quality, parts FROM factor
$$;
