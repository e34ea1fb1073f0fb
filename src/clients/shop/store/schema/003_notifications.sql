-- What people are told. Written with the values in one transaction, so that none is lost or doubled.
CREATE TABLE notification (
    id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    machine integer NOT NULL REFERENCES machine,
    at timestamptz NOT NULL,
    source text NOT NULL,
    message text NOT NULL,
    UNIQUE (machine, at, source)
);

-- To whom it was sent.
CREATE TABLE sent (
    notification bigint NOT NULL REFERENCES notification ON DELETE CASCADE,
    target text NOT NULL,
    at timestamptz NOT NULL DEFAULT now(),
    PRIMARY KEY (notification, target)
);
