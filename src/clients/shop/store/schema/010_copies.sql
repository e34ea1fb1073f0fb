-- Versions of files that machines send. They are never sent back.
CREATE TABLE machine_copy (
    id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    machine integer NOT NULL REFERENCES machine,
    kind text NOT NULL,
    at timestamptz NOT NULL,  -- when the file was written, from the clock of the machine
    sha256 text NOT NULL,
    name text NOT NULL,
    bytes bytea NOT NULL,
    received timestamptz NOT NULL DEFAULT clock_timestamp(),
    UNIQUE (machine, kind, at, sha256)
);

-- Stores a version once, and keeps the newest 100 of each kind.
CREATE FUNCTION add_copy(of_grp text, of_node text, of_device text, of_kind text, at_ms bigint, of_sha256 text, of_name text, of_bytes bytea)
RETURNS void LANGUAGE plpgsql AS $$
DECLARE
    of_machine integer := (SELECT id FROM machine WHERE (grp, node, device) = (of_grp, of_node, of_device));
BEGIN
    IF of_machine IS NULL THEN
        RETURN;
    END IF;
    INSERT INTO machine_copy (machine, kind, at, sha256, name, bytes) VALUES (of_machine, of_kind, to_timestamp(at_ms / 1000.0), of_sha256, of_name, of_bytes)
        ON CONFLICT DO NOTHING;
    DELETE FROM machine_copy WHERE id IN (SELECT id FROM machine_copy WHERE machine = of_machine AND kind = of_kind ORDER BY id DESC OFFSET 100);
END
$$;

-- Kinds whose current version is not stored, of a machine that is known.
CREATE FUNCTION wanted_copies(of_grp text, of_node text, of_device text, copies json) RETURNS json LANGUAGE sql STABLE AS $$
    SELECT coalesce(json_agg(copy.kind), '[]') FROM json_to_recordset(copies) AS copy (kind text, sha256 text, at bigint)
        JOIN machine ON (grp, node, device) = (of_grp, of_node, of_device)
        WHERE NOT EXISTS (SELECT FROM machine_copy WHERE machine_copy.machine = machine.id AND machine_copy.kind = copy.kind
            AND machine_copy.at = to_timestamp(copy.at / 1000.0) AND machine_copy.sha256 = copy.sha256)
$$;

CREATE FUNCTION page_copies() RETURNS json LANGUAGE sql STABLE AS $$
    SELECT json_build_object('copies', coalesce(json_agg(one), '[]')) FROM (
        SELECT machine_copy.id, grp || '/' || node || '/' || device AS machine, kind, name, at, received, sha256, length(bytes) AS bytes
            FROM machine_copy JOIN machine ON machine.id = machine_copy.machine ORDER BY machine_copy.id DESC LIMIT 300) AS one
$$;
