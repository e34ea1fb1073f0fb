-- Runs of programs, kept in the transaction of the values that they come from: sums read a row for each run, not its values.
-- The readings of four metrics again, without partitions.
CREATE TABLE job_reading (
    metric integer NOT NULL REFERENCES metric,
    at timestamptz NOT NULL,
    text text,
    PRIMARY KEY (metric, at)
);

-- From one idle state of a machine to the next.
CREATE TABLE run (
    machine integer NOT NULL REFERENCES machine,
    begins timestamptz NOT NULL,
    ends timestamptz NOT NULL,  -- infinity: it has not ended
    active interval NOT NULL,  -- time in ACTIVE; without the last state of a run that has not ended
    program text,
    file text,  -- of the program, without folders
    is_auto boolean NOT NULL,  -- began in mode AUTO: it is a job
    ended_at timestamptz,  -- when the program ended in order
    PRIMARY KEY (machine, begins)
);

CREATE FUNCTION is_idle(state text) RETURNS boolean LANGUAGE sql IMMUTABLE AS $$
    SELECT coalesce(state, 'UNAVAILABLE') IN ('READY', 'STOPPED', 'UNAVAILABLE')
$$;

CREATE FUNCTION is_auto(mode text) RETURNS boolean LANGUAGE sql IMMUTABLE AS $$
    SELECT upper(coalesce(mode, 'AUTO')) LIKE 'AUTO%'
$$;

-- Calculates runs again, where readings or presences between two times are new. The second time is that of the next reading
-- that was there: what comes after it has not changed.
CREATE FUNCTION renew_runs(of_machine integer, from_time timestamptz, until_time timestamptz) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
    execution_id integer := metric_id(of_machine, 'Execution');
    mode_id integer := metric_id(of_machine, 'Mode');
    path_id integer := metric_id(of_machine, 'Program/Path');
    ended_id integer := metric_id(of_machine, 'Program/Ended');
    a timestamptz;
    b timestamptz;
BEGIN
    -- Runs as a whole: Program/Ended may come one second late. Between the runs the machine is idle.
    SELECT least(from_time, min(begins)), greatest(until_time, max(ends)) INTO a, b FROM run
    WHERE machine = of_machine AND begins <= until_time AND ends >= from_time - interval '1 second' AND begins >= coalesce(
        (SELECT begins FROM run WHERE machine = of_machine AND begins < from_time - interval '1 second' ORDER BY begins DESC LIMIT 1), '-infinity');
    DELETE FROM run WHERE machine = of_machine AND begins BETWEEN a AND b;
    INSERT INTO run (machine, begins, ends, active, program, file, is_auto, ended_at)
    WITH event AS (
        SELECT at, 2 AS rank, text AS state FROM job_reading WHERE metric = execution_id AND at BETWEEN a AND b
        UNION ALL
        SELECT at, 1, CASE WHEN alive THEN (SELECT text FROM job_reading WHERE metric = execution_id AND at < presence.at ORDER BY at DESC LIMIT 1) END FROM presence WHERE machine = of_machine AND at BETWEEN a AND b
    ),
    part AS (SELECT state, at AS begins, lead(at, 1, 'infinity') OVER (ORDER BY at, rank) AS ends FROM event),
    numbered AS (SELECT *, count(*) FILTER (WHERE is_idle(state)) OVER (ORDER BY begins) AS number FROM part WHERE ends > begins),
    whole AS (
        SELECT min(begins) AS begins, max(ends) AS ends,
            coalesce(sum(CASE WHEN ends < 'infinity' THEN ends - begins END) FILTER (WHERE state = 'ACTIVE'), '0') AS active
        FROM numbered WHERE NOT is_idle(state) GROUP BY number
    )
    SELECT of_machine, begins, ends, active, path.text, regexp_replace(path.text, '^.*/', ''), is_auto((SELECT text FROM job_reading WHERE metric = mode_id AND at < begins + interval '1 second' ORDER BY at DESC LIMIT 1)),
        (SELECT max(at) FROM job_reading WHERE metric = ended_id AND at > begins AND at <= ends + interval '1 second')
    FROM whole CROSS JOIN LATERAL (SELECT (SELECT text FROM job_reading WHERE metric = path_id AND at < whole.ends ORDER BY at DESC LIMIT 1) AS text) AS path;
END
$$;

-- One transaction at a time renews the runs of a machine; the next one sees what it has written.
CREATE FUNCTION take_job_readings() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM FROM machine WHERE id IN (SELECT machine FROM fresh JOIN metric ON metric.id = fresh.metric) ORDER BY id FOR NO KEY UPDATE;
    PERFORM renew_runs(machine, min(first), max(CASE WHEN name = 'Program/Ended' THEN last ELSE coalesce(
        (SELECT at FROM job_reading WHERE job_reading.metric = span.metric AND at > last ORDER BY at LIMIT 1), 'infinity') END))
    FROM (SELECT metric, min(at) AS first, max(at) AS last FROM fresh GROUP BY metric) AS span JOIN metric ON metric.id = span.metric
    GROUP BY machine;
    RETURN NULL;
END
$$;
CREATE TRIGGER take_job_readings AFTER INSERT ON job_reading REFERENCING NEW TABLE AS fresh
    FOR EACH STATEMENT EXECUTE FUNCTION take_job_readings();

CREATE FUNCTION take_presences() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM FROM machine WHERE id IN (SELECT machine FROM fresh) ORDER BY id FOR NO KEY UPDATE;
    PERFORM renew_runs(machine, first, coalesce(
        (SELECT at FROM job_reading WHERE metric = metric_id(span.machine, 'Execution') AND at > last ORDER BY at LIMIT 1), 'infinity'))
    FROM (SELECT machine, min(at) AS first, max(at) AS last FROM fresh GROUP BY machine) AS span;
    RETURN NULL;
END
$$;
CREATE TRIGGER take_presences AFTER INSERT ON presence REFERENCING NEW TABLE AS fresh
    FOR EACH STATEMENT EXECUTE FUNCTION take_presences();

-- What is stored already.
INSERT INTO job_reading (metric, at, text)
    SELECT metric, at, text FROM reading WHERE metric IN (SELECT id FROM metric WHERE name IN ('Execution', 'Mode', 'Program/Path', 'Program/Ended'));

-- The functions of step 2 with the same results.
CREATE OR REPLACE FUNCTION execution(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (state text, begins timestamptz, ends timestamptz) LANGUAGE sql STABLE AS $$
    WITH run AS (SELECT (SELECT metric.id FROM metric WHERE machine = of_machine AND name = 'Execution') AS id),
    events AS (
        SELECT from_time AS at, 0 AS rank, CASE
            WHEN NOT coalesce((SELECT alive FROM presence WHERE machine = of_machine AND at <= from_time ORDER BY at DESC LIMIT 1), false)
            THEN 'UNAVAILABLE' ELSE (SELECT text FROM job_reading WHERE metric = (SELECT id FROM run) AND at < from_time ORDER BY at DESC LIMIT 1) END AS state
        UNION ALL
        SELECT at, 2, text FROM job_reading, run WHERE metric = run.id AND at >= from_time AND at < until_time
        UNION ALL
        SELECT at, 1, CASE WHEN alive THEN (SELECT text FROM job_reading WHERE metric = (SELECT id FROM run) AND at < presence.at ORDER BY at DESC LIMIT 1) ELSE 'UNAVAILABLE' END
        FROM presence WHERE machine = of_machine AND at > from_time AND at < until_time
    )
    SELECT coalesce(state, 'UNAVAILABLE'), at, lead(at, 1, until_time) OVER (ORDER BY at, rank)
    FROM events
$$;

-- The parts within an interval of the runs that reach beyond it: two at most.
CREATE FUNCTION cut_runs(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (program text, begins timestamptz, ends timestamptz, active interval, is_auto boolean, is_done boolean) LANGUAGE sql STABLE AS $$
    SELECT (SELECT text FROM job_reading WHERE metric = (SELECT id FROM metric WHERE machine = of_machine AND name = 'Program/Path')
            AND at < cut.ends ORDER BY at DESC LIMIT 1),
        cut.begins, cut.ends, cut.active,
        is_auto((SELECT text FROM job_reading WHERE metric = (SELECT id FROM metric WHERE machine = of_machine AND name = 'Mode')
            AND at < cut.begins + interval '1 second' ORDER BY at DESC LIMIT 1)),
        run.ends < until_time AND coalesce(run.ended_at > cut.begins, false)
    FROM (
        (SELECT * FROM run WHERE machine = of_machine AND run.begins < from_time ORDER BY run.begins DESC LIMIT 1)
        UNION
        (SELECT * FROM run WHERE machine = of_machine AND run.begins < until_time ORDER BY run.begins DESC LIMIT 1)
    ) AS run CROSS JOIN LATERAL (
        SELECT min(part.begins) AS begins, max(part.ends) AS ends, coalesce(sum(part.ends - part.begins) FILTER (WHERE part.state = 'ACTIVE'), '0') AS active
        FROM execution(of_machine, greatest(run.begins, from_time), least(run.ends, until_time)) AS part
        WHERE part.ends > part.begins AND NOT is_idle(part.state)
    ) AS cut
    WHERE run.ends > from_time AND (run.begins < from_time OR run.ends >= until_time) AND cut.begins IS NOT NULL
$$;

CREATE OR REPLACE FUNCTION jobs(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (program text, begins timestamptz, ends timestamptz, active interval, result text) LANGUAGE sql STABLE AS $$
    SELECT program, begins, ends, active, CASE WHEN ended_at IS NULL THEN 'ABORTED' ELSE 'ENDED' END
    FROM run WHERE machine = of_machine AND begins >= from_time AND begins < until_time AND ends < until_time AND is_auto
    UNION ALL
    SELECT program, begins, ends, active, CASE WHEN ends >= until_time THEN 'RUNNING' WHEN is_done THEN 'ENDED' ELSE 'ABORTED' END
    FROM cut_runs(of_machine, from_time, until_time) WHERE is_auto
$$;

CREATE OR REPLACE FUNCTION oee(of_machine integer, from_time timestamptz, until_time timestamptz)
RETURNS TABLE (availability double precision, performance double precision, quality double precision, oee double precision, parts bigint)
LANGUAGE sql STABLE AS $$
    WITH part AS (
        SELECT active, file, is_auto AND ended_at IS NOT NULL AS is_done
        FROM run WHERE machine = of_machine AND begins >= from_time AND begins < least(until_time, now()) AND ends < least(until_time, now())
        UNION ALL
        SELECT active, regexp_replace(program, '^.*/', ''), is_auto AND is_done FROM cut_runs(of_machine, from_time, least(until_time, now()))
    ),
    done AS (
        SELECT coalesce(extract(epoch FROM sum(part.active)), 0) AS all_s, count(*) FILTER (WHERE is_done) AS parts,
            extract(epoch FROM sum(cycle_time.ideal) FILTER (WHERE is_done)) AS ideal_s,
            extract(epoch FROM sum(part.active) FILTER (WHERE is_done AND cycle_time.ideal IS NOT NULL)) AS active_s
        FROM part LEFT JOIN cycle_time ON cycle_time.program = part.file
    ),
    factor AS (
        SELECT done.all_s / nullif(greatest(extract(epoch FROM least(until_time, now()) - from_time), 0), 0) AS availability,
            done.ideal_s / nullif(done.active_s, 0) AS performance,
            CASE WHEN done.parts = 0 THEN NULL ELSE greatest(0, 1 - bad.parts::double precision / done.parts) END AS quality, done.parts
        FROM done, (SELECT coalesce(sum(parts), 0) AS parts FROM rejected_part WHERE machine = of_machine AND at >= from_time AND at < until_time) AS bad
    )
    SELECT availability, performance, quality, availability * performance * quality, parts FROM factor
$$;

-- No row for a machine whose last run has ended.
CREATE FUNCTION expected_ends(of_machine integer) RETURNS TABLE (expected timestamptz) LANGUAGE sql STABLE AS $$
    SELECT job.expected FROM (
        SELECT min(at) AS begins FROM (
            SELECT at FROM job_reading WHERE metric = (SELECT id FROM metric WHERE machine = of_machine AND name = 'Execution')
                AND (SELECT ends >= now() FROM run WHERE machine = of_machine AND begins < now() ORDER BY begins DESC LIMIT 1)
            ORDER BY at DESC LIMIT 30
        ) AS newest
    ) AS last CROSS JOIN LATERAL (
        WITH each AS (SELECT * FROM jobs(of_machine, last.begins, now()))
        SELECT running.begins + (SELECT percentile_cont(0.5) WITHIN GROUP (ORDER BY each.ends - each.begins)
            FROM each WHERE each.result = 'ENDED' AND each.program = running.program) AS expected
        FROM each AS running WHERE running.result = 'RUNNING'
    ) AS job
$$;

CREATE OR REPLACE FUNCTION expected_end(of_machine integer) RETURNS timestamptz LANGUAGE sql STABLE AS $$
    SELECT expected FROM expected_ends(of_machine)
$$;

CREATE OR REPLACE FUNCTION page_sums() RETURNS json LANGUAGE sql STABLE AS $$
    WITH shift_now AS (SELECT * FROM shifts(now(), now() + interval '1 second') ORDER BY begins DESC LIMIT 1)
    SELECT json_build_object('shift', (SELECT name FROM shift_now), 'machines', coalesce((
        SELECT json_object_agg(machine.id, json_build_object('ends', expected_ends.expected, 'availability', sums.availability,
            'performance', sums.performance, 'quality', sums.quality, 'oee', sums.oee, 'parts', sums.parts))
        FROM machine LEFT JOIN shift_now ON true LEFT JOIN LATERAL expected_ends(machine.id) ON true
        LEFT JOIN LATERAL oee(machine.id, shift_now.begins, shift_now.ends) AS sums ON shift_now.name IS NOT NULL
        WHERE device <> ''), '{}'))
$$;
