-- Values with the same time, and times of machines with a wrong clock.
-- Times of Sparkplug are milliseconds. A value with the time of another one that differs gets the next microsecond, so both are kept in the
-- order in which they came. A value that equals the newest one of its millisecond is the same value.
CREATE FUNCTION add_readings(metrics integer[], times timestamptz[], numbers double precision[], wholes bigint[], texts text[])
RETURNS SETOF reading LANGUAGE plpgsql AS $$
DECLARE
    one reading;
    last reading;
BEGIN
    FOR one IN
        SELECT given.metric, given.at, given.number, given.whole, given.text FROM (
            SELECT *, count(*) OVER (PARTITION BY each.metric, each.at) AS same
            FROM unnest(metrics, times, numbers, wholes, texts) WITH ORDINALITY AS each (metric, at, number, whole, text, place)
        ) AS given
        WHERE same > 1 OR NOT coalesce((SELECT (there.number, there.whole, there.text) IS NOT DISTINCT FROM (given.number, given.whole, given.text)
            FROM reading AS there WHERE there.metric = given.metric AND there.at >= given.at AND there.at < given.at + interval '1 ms'
            ORDER BY there.at DESC LIMIT 1), false)
        ORDER BY place
    LOOP
        SELECT * INTO last FROM reading WHERE metric = one.metric AND at >= one.at AND at < one.at + interval '1 ms' ORDER BY at DESC LIMIT 1;
        IF FOUND THEN
            CONTINUE WHEN (last.number, last.whole, last.text) IS NOT DISTINCT FROM (one.number, one.whole, one.text);
            one.at := last.at + interval '1 us';
        END IF;
        LOOP
            INSERT INTO reading VALUES (one.*) ON CONFLICT DO NOTHING;
            EXIT WHEN FOUND;
            one.at := one.at + interval '1 us';
        END LOOP;
        RETURN NEXT one;
    END LOOP;
END
$$;

-- Of a notification, the time of the value is of the clock of the machine; it is sent for a day after it came.
ALTER TABLE notification
    ADD COLUMN received timestamptz NOT NULL DEFAULT now(),
    ADD COLUMN late interval NOT NULL DEFAULT '0';  -- age of the value when the machine sent it
UPDATE notification SET received = at;

-- What the notification reports has changed since.
CREATE FUNCTION is_over(what notification) RETURNS boolean LANGUAGE sql STABLE AS $$
    SELECT coalesce(CASE WHEN what.source = 'Contact' THEN (SELECT alive FROM presence WHERE machine = what.machine ORDER BY at DESC LIMIT 1)
        ELSE (newest(metric_id(what.machine, what.source))).at > what.at END, false)
$$;
