-- Programs that the shop offers to machines. A machine decides; nothing is written to a machine from here.
CREATE TABLE offered_program (
    request uuid PRIMARY KEY,  -- of the page: a repeated request has no effect
    name text NOT NULL,
    sha256 text NOT NULL,
    bytes integer NOT NULL,
    files text NOT NULL  -- JSON: [{"name": , "text": }], the program first
);

CREATE TABLE offer (
    id uuid PRIMARY KEY DEFAULT gen_random_uuid(),
    machine integer NOT NULL REFERENCES machine,
    request uuid NOT NULL REFERENCES offered_program,
    sender text NOT NULL,
    note text NOT NULL,
    parts integer NOT NULL,  -- 0: not set
    state text NOT NULL DEFAULT 'sent' CHECK (state IN ('sent', 'received', 'accepted', 'declined', 'withdrawn', 'rejected')),
    sent timestamptz NOT NULL DEFAULT clock_timestamp(),
    received timestamptz,
    ended timestamptz,  -- from the clock of the machine
    ended_by text NOT NULL DEFAULT '',
    reason text NOT NULL DEFAULT '',
    withdrawn timestamptz,  -- when the shop withdrew it; the state follows when the machine confirms
    withdrawn_by text NOT NULL DEFAULT '',
    UNIQUE (request, machine)
);
CREATE INDEX offer_open ON offer (machine, sent) WHERE state IN ('sent', 'received');
CREATE INDEX offer_sent ON offer (sent);

-- Offers a program to machines. Returns {"offers": [ids]} or {"error": text}.
CREATE FUNCTION add_offers(of_request uuid, machines integer[], of_sender text, of_note text, of_parts integer, of_name text, of_sha256 text,
    of_bytes integer, of_files text) RETURNS json LANGUAGE plpgsql AS $$
DECLARE
    unknown integer := (SELECT min(given) FROM unnest(machines) AS given WHERE NOT EXISTS (SELECT FROM machine WHERE id = given AND device <> ''));
BEGIN
    IF unknown IS NOT NULL THEN
        RETURN json_build_object('error', format('There is no machine %s.', unknown));
    END IF;
    INSERT INTO offered_program (request, name, sha256, bytes, files) VALUES (of_request, of_name, of_sha256, of_bytes, of_files) ON CONFLICT DO NOTHING;
    IF of_sha256 <> (SELECT sha256 FROM offered_program WHERE request = of_request) THEN
        RETURN json_build_object('error', 'This request has offered other files before.');
    END IF;
    INSERT INTO offer (machine, request, sender, note, parts) SELECT DISTINCT given, of_request, of_sender, of_note, of_parts FROM unnest(machines) AS given
        ON CONFLICT DO NOTHING;
    RETURN json_build_object('offers', (SELECT json_agg(id ORDER BY machine) FROM offer WHERE request = of_request));
END
$$;

CREATE FUNCTION withdraw_offer(of_id uuid, of_person text) RETURNS json LANGUAGE plpgsql AS $$
BEGIN
    UPDATE offer SET withdrawn = clock_timestamp(), withdrawn_by = of_person WHERE id = of_id AND state IN ('sent', 'received') AND withdrawn IS NULL;
    RETURN (SELECT CASE WHEN withdrawn IS NOT NULL THEN json_build_object('withdrawn', id) ELSE json_build_object('error', format('The offer is %s.', state)) END
        FROM offer WHERE id = of_id);
END
$$;

-- Stores the states that a machine reports, and returns the reply: states that are stored now, withdrawn offers, and one offer that it does not have.
CREATE FUNCTION take_report(of_grp text, of_node text, of_device text, changes json, open uuid[], has_room boolean) RETURNS json LANGUAGE plpgsql AS $$
DECLARE
    of_machine integer := (SELECT id FROM machine WHERE (grp, node, device) = (of_grp, of_node, of_device));
BEGIN
    UPDATE offer SET state = change.state, received = coalesce(received, clock_timestamp()), ended_by = change.by, reason = change.reason,
        ended = CASE WHEN change.state <> 'received' THEN to_timestamp(change.at / 1000.0) END
        FROM json_to_recordset(changes) AS change (id uuid, state text, at bigint, by text, reason text)
        WHERE offer.id = change.id AND machine = of_machine AND offer.state IN ('sent', 'received') AND offer.state <> change.state;
    RETURN json_strip_nulls(json_build_object(
        'noted', coalesce((SELECT json_agg(json_build_object('id', id, 'state', state)) FROM json_to_recordset(changes) AS change (id uuid, state text)), '[]'),
        'withdrawn', coalesce((SELECT json_agg(id) FROM (SELECT id FROM offer WHERE machine = of_machine AND state IN ('sent', 'received')
            AND offer.withdrawn IS NOT NULL ORDER BY sent LIMIT 100) AS gone), '[]'),
        'offer', (SELECT json_build_object('id', id, 'from', sender, 'note', note, 'parts', parts, 'sha256', sha256, 'files', files::json)
            FROM offer JOIN offered_program USING (request) WHERE has_room AND machine = of_machine AND state = 'sent' AND offer.withdrawn IS NULL
            AND id <> ALL (open) ORDER BY sent, id LIMIT 1)));
END
$$;

CREATE FUNCTION page_offers() RETURNS json LANGUAGE sql STABLE AS $$
    SELECT json_build_object('offers', coalesce(json_agg(one), '[]')) FROM (
        SELECT offer.id, grp || '/' || node || '/' || device AS machine, name, bytes, sha256, sender, note, parts, state, sent, received, ended, ended_by, reason,
            withdrawn, withdrawn_by FROM offer JOIN offered_program USING (request) JOIN machine ON machine.id = offer.machine
            ORDER BY sent DESC, offer.id LIMIT 300) AS one
$$;
