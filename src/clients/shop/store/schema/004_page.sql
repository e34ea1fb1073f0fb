-- What the shop page shows, as JSON.
-- The states of all machines.
CREATE FUNCTION page_machines() RETURNS json LANGUAGE sql STABLE AS $$
    WITH newest AS (
        SELECT metric.machine, metric.name, coalesce(last.text, last.whole::text, last.number::text) AS value
        FROM metric CROSS JOIN LATERAL (SELECT text, whole, number FROM reading WHERE reading.metric = metric.id ORDER BY at DESC LIMIT 1) AS last
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

-- When the program that runs will end, by the median time of its runs among the last ones: NULL where none ended.
CREATE FUNCTION expected_end(of_machine integer) RETURNS timestamptz LANGUAGE sql STABLE AS $$
    WITH last AS (SELECT at FROM reading WHERE metric = metric_id(of_machine, 'Execution') ORDER BY at DESC LIMIT 30),
    job AS (SELECT * FROM jobs(of_machine, (SELECT min(at) FROM last), now())),
    running AS (SELECT * FROM job WHERE result = 'RUNNING')
    SELECT running.begins + (SELECT percentile_cont(0.5) WITHIN GROUP (ORDER BY job.ends - job.begins)
        FROM job WHERE job.result = 'ENDED' AND job.program = running.program) FROM running
$$;

-- The sums of all machines in the shift of now, which take longer than the states.
CREATE FUNCTION page_sums() RETURNS json LANGUAGE sql STABLE AS $$
    WITH shift_now AS (SELECT * FROM shifts(now(), now() + interval '1 second') ORDER BY begins DESC LIMIT 1)
    SELECT json_build_object('shift', (SELECT name FROM shift_now), 'machines', coalesce((
        SELECT json_object_agg(machine.id, json_build_object('ends', expected_end(machine.id), 'availability', sums.availability,
            'performance', sums.performance, 'quality', sums.quality, 'oee', sums.oee, 'parts', sums.parts))
        FROM machine LEFT JOIN shift_now ON true
        LEFT JOIN LATERAL oee(machine.id, shift_now.begins, shift_now.ends) AS sums ON shift_now.name IS NOT NULL
        WHERE device <> ''), '{}'))
$$;

CREATE FUNCTION page_history(of_machine integer, days integer) RETURNS json LANGUAGE sql STABLE AS $$
    WITH span AS (SELECT greatest(now() - days * interval '1 day', (SELECT min(at) FROM presence WHERE machine = of_machine)) AS begins, now() AS ends)
    SELECT json_build_object(
        'jobs', coalesce((SELECT json_agg(job) FROM (SELECT job.program, job.begins, job.ends, extract(epoch FROM job.active) AS active_s, job.result
            FROM span, jobs(of_machine, span.begins, span.ends) AS job ORDER BY job.begins DESC LIMIT 200) AS job), '[]'),
        'alarms', coalesce((SELECT json_agg(alarm) FROM (SELECT alarm.* FROM span, alarms(of_machine, span.begins, span.ends) AS alarm
            ORDER BY alarm.at DESC LIMIT 200) AS alarm), '[]'),
        'shifts', coalesce((SELECT json_agg(one) FROM (SELECT shift.name, shift.begins, sums.* FROM span, shifts(span.begins, span.ends) AS shift,
            oee(of_machine, shift.begins, shift.ends) AS sums ORDER BY shift.begins DESC LIMIT 60) AS one), '[]'))
$$;
