-- What the shop page shows, as JSON.
CREATE FUNCTION state_of(of_machine integer, of_name text) RETURNS text LANGUAGE sql STABLE AS $$
    SELECT coalesce(r.text, r.whole::text, r.number::text) FROM newest(metric_id(of_machine, of_name)) AS r
$$;

-- Median time of the last ten ended runs of a program in the last week.
CREATE FUNCTION usual_time(of_machine integer, of_program text) RETURNS interval LANGUAGE sql STABLE AS $$
    SELECT percentile_cont(0.5) WITHIN GROUP (ORDER BY time) FROM (
        SELECT ends - begins AS time FROM jobs(of_machine, now() - interval '7 days', now())
        WHERE program = of_program AND result = 'ENDED' ORDER BY begins DESC LIMIT 10
    ) AS last
$$;

CREATE FUNCTION page_machines() RETURNS json LANGUAGE sql STABLE AS $$
    WITH shift_now AS (SELECT * FROM shifts(now(), now() + interval '1 second') ORDER BY begins DESC LIMIT 1),
    each AS (
        SELECT machine.id, grp, node, device,
            coalesce((SELECT alive FROM presence WHERE presence.machine = machine.id ORDER BY at DESC LIMIT 1), false) AS alive,
            state_of(machine.id, 'State') AS state, state_of(machine.id, 'Execution') AS execution,
            state_of(machine.id, 'Program/Path') AS program, state_of(machine.id, 'Program/Line') AS line,
            (SELECT string_agg(text, ' ') FROM (SELECT (newest(metric.id)).text FROM metric
                WHERE metric.machine = machine.id AND metric.name LIKE 'Alarms/%' ORDER BY metric.name) AS alarm WHERE text <> '') AS alarms
        FROM machine WHERE device <> ''
    )
    SELECT json_build_object('at', now(), 'shift', (SELECT name FROM shift_now), 'machines', coalesce((
        SELECT json_agg(json_build_object('id', each.id, 'group', grp, 'node', node, 'device', device, 'alive', alive, 'state', state,
            'execution', execution, 'program', each.program, 'line', line, 'alarms', alarms, 'job', running.begins,
            'left_s', extract(epoch FROM running.begins + usual_time(each.id, running.program) - now()),
            'availability', sums.availability, 'performance', sums.performance, 'quality', sums.quality, 'oee', sums.oee, 'parts', sums.parts)
            ORDER BY grp, node, device)
        FROM each
        LEFT JOIN LATERAL (SELECT * FROM jobs(each.id, now() - interval '1 day', now()) WHERE each.alive AND each.execution NOT IN ('READY', 'STOPPED')
            ORDER BY begins DESC LIMIT 1) AS running ON running.result = 'RUNNING'
        LEFT JOIN shift_now ON true
        LEFT JOIN LATERAL oee(each.id, shift_now.begins, shift_now.ends) AS sums ON shift_now.name IS NOT NULL
    ), '[]'))
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
