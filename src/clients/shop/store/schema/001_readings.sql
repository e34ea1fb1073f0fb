-- Machines, their metrics, and values by time.
CREATE TABLE machine (
    id integer GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    grp text NOT NULL,
    node text NOT NULL,
    device text NOT NULL,  -- empty: the node itself
    UNIQUE (grp, node, device)
);

CREATE TABLE metric (
    id integer GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    machine integer NOT NULL REFERENCES machine,
    name text NOT NULL,
    unit text NOT NULL,
    UNIQUE (machine, name)
);

-- At most one of the three columns has the value; none: the machine did not know it.
CREATE TABLE reading (
    metric integer NOT NULL,
    at timestamptz NOT NULL,
    number double precision,  -- booleans are 0 and 1
    whole bigint,
    text text,
    PRIMARY KEY (metric, at)
) PARTITION BY RANGE (at);
-- Machines with a wrong clock. The collector creates a partition for each day between these.
CREATE TABLE reading_before PARTITION OF reading FOR VALUES FROM (MINVALUE) TO ('2020-01-01 00:00:00+00');
CREATE TABLE reading_after PARTITION OF reading FOR VALUES FROM ('2100-01-01 00:00:00+00') TO (MAXVALUE);

-- When a machine was born and has gone.
CREATE TABLE presence (
    machine integer NOT NULL REFERENCES machine,
    at timestamptz NOT NULL,
    alive boolean NOT NULL,
    PRIMARY KEY (machine, at)
);

CREATE FUNCTION newest(of_metric integer, before timestamptz DEFAULT 'infinity')
RETURNS reading LANGUAGE sql STABLE AS $$
    SELECT * FROM reading WHERE metric = of_metric AND at < before ORDER BY at DESC LIMIT 1
$$;
