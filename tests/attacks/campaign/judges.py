# SPDX-License-Identifier: GPL-2.0-or-later
"""Rules for every run, with any attacks. Each judge takes the record of a run and returns a list of violations."""
import dataclasses
import math
import re

ABORT_S = 0.1       # maximum time until an abort is answered
STOP_S = 0.6        # maximum time until a machine has stopped
END_S = 2.0         # maximum time from SIGTERM until every process has ended
SUSPENDED_SERVERS = ('signal.stop_web', 'signal.stop_rsh', 'signal.stop_nml')
SUSPENDED_END_S = 0.5  # maximum time until a suspended server has ended after it continues
OFF_PATH_MM = 0.02  # above the tolerance of G64 in the programs, 0.01
STILL_S = 0.25      # a standstill of this duration is a stop
SAME_MM = 1e-6


@dataclasses.dataclass
class Event:
    """An attack as it was carried out. `causes`: the text of the message when the attack stops the machine; None: it must not stop it."""
    name: str
    begin: float
    end: float
    causes: str | None

    @property
    def latest(self):
        """Latest time of the stop, without STOP_S; for a stopped process, the time at which it was stopped."""
        return self.begin if self.name.startswith('signal.stop_') else self.end


@dataclasses.dataclass
class Record:
    """A run. Times are those of the monotonic clock."""
    corners: list                # of the programmed path, closed
    begin: float                 # the axes start to move
    samples: list                # (time, x, y, z, enabled)
    events: list
    python: list                 # (time, text)
    web: list
    abort: dict | None           # of stopper.py
    lateness: list               # (time, lateness in seconds)
    isEnding: bool = False       # an attack ends the machine
    # the reports that clients receive about the end: 'python', 'web', 'terminal'
    gone: dict = dataclasses.field(default_factory=dict)
    end_s: float | None = None   # duration of the end, if an attack ended the machine
    isWebUp: bool = True         # False: the server was killed; a new one shows later messages only


def distance(point, a, b):
    """Distance of a point from a segment."""
    along = [q - p for p, q in zip(a, b)]
    length = sum(c * c for c in along)
    share = 0.0 if length == 0 else max(0.0, min(1.0, sum((x - p) * c for x, p, c in zip(point, a, along)) / length))
    return math.dist(point, [p + share * c for p, c in zip(a, along)])


def off_path(record):
    """No sampled point may be off the programmed path."""
    segments = list(zip(record.corners, record.corners[1:]))
    last = segments[0]
    for when, x, y, z, _ in record.samples:
        point = (x, y, z)
        if distance(point, *last) <= OFF_PATH_MM:
            continue
        nearest = min(segments, key=lambda segment: distance(point, *segment))
        off = distance(point, *nearest)
        if off > OFF_PATH_MM:
            return [f'path: {off:.3f} mm off the programmed path at X{x:.3f} Y{y:.3f} Z{z:.3f}, {when - record.begin:.2f} s after the begin']
        last = nearest
    return []


def standstills(record):
    """[(begin, end)] of at least STILL_S after the axes have moved; a gap of the samples counts as standstill."""
    found, still = [], None
    previous = None
    for sample in record.samples:
        if sample[0] < record.begin:
            continue
        if previous is not None and (sample[0] - previous[0] > STILL_S or math.dist(sample[1:4], previous[1:4]) < SAME_MM):
            still = still if still is not None else previous[0]
        else:
            if still is not None and previous[0] - still >= STILL_S:
                found.append((still, previous[0]))
            still = None
        previous = sample
    if still is not None and previous[0] - still >= STILL_S:
        found.append((still, previous[0]))
    return found


def limit_of(record):
    """The time until which the machine had no command to stop."""
    return record.abort['sent'] if record.abort else float('inf')


def unexplained(record, messages, where):
    causes = [event.causes for event in record.events if event.causes]
    if any(re.search(cause, text) for cause in causes for _, text in messages):
        return []
    return [f'message: the machine stopped; no message names the cause ({" or ".join(causes) or "no attack may stop it"}) {where}: {texts(messages)}']


def texts(messages):
    return '; '.join(dict.fromkeys(text[:120] for _, text in messages[-6:])) or 'none at all'


def early_stops(record):
    """[(begin, end)] of the standstills before the abort."""
    return [(begin, end) for begin, end in standstills(record) if begin + STILL_S < limit_of(record)]


def latest_of(event, record):
    """Like Event.latest, but a realtime process that is stopped at that time reacts only when it continues."""
    frozen = [other.end for other in record.events
              if other is not event and other.name == 'signal.stop_motion' and other.begin <= event.latest <= other.end]
    return max([event.latest, *frozen])


def stops(record):
    """The machine continues to cut, or stops within STOP_S and every screen shows a message that names the cause."""
    if record.isEnding:
        return ends(record)
    early = early_stops(record)
    if not early:
        return []
    rest = early[0][0]
    # The stop begins between these times: before STILL_S has passed, the axes may have paused in a corner of the path.
    seen = max(rest + STILL_S, min((sample[0] for sample in record.samples if sample[0] > rest), default=rest))
    failures = []
    begun = [event for event in record.events if event.begin <= seen and event.causes]
    since = min((max(0.0, rest - latest_of(event, record)) for event in begun), default=None)
    if since is None or since > STOP_S:
        names = ', '.join(f'{event.name} {event.begin - record.begin:.2f} to {event.end - record.begin:.2f} s' for event in record.events)
        failures.append(f'stop: the axes rest at {rest - record.begin:.2f} s, {"without" if since is None else f"{since:.2f} s after"} an attack that may stop them ({names})')
    causes = [event.causes for event in record.events if event.causes]
    # Counted from the first message of each attack: one of the attacks stops the axes, and messages of other
    # attacks may have appeared earlier.
    late = [rest - min(named) for cause in causes if (named := [when for when, text in record.python if re.search(cause, text)])]
    if late and min(late) > STOP_S:
        failures.append(f'stop: the axes rest {min(late):.2f} s after the message')
    return failures + unexplained(record, record.python, 'for Python') + (
        unexplained(record, record.web, 'on the web screen') if record.isWebUp else [])


def ends(record):
    """An attack has ended the machine: the axes stop in time, and clients are informed."""
    event = next(event for event in record.events if event.name.startswith('end.'))
    failures = []
    moving = [b[0] for a, b in zip(record.samples, record.samples[1:]) if math.dist(a[1:4], b[1:4]) >= SAME_MM]
    if moving and moving[-1] - event.begin > STOP_S:
        failures.append(f'stop: the axes move {moving[-1] - event.begin:.2f} s after {event.name}')
    # A server that is suspended cannot end before it continues.
    continues_s = max((one.end - event.begin for one in record.events if one.name in SUSPENDED_SERVERS), default=0.0)
    if record.end_s is None or record.end_s > max(END_S, continues_s + SUSPENDED_END_S):
        late = lateness_between(record, event.begin, event.begin + (record.end_s or 0))
        coincides = '; the computer was late' if record.end_s is not None and record.end_s - late <= END_S else ''
        failures.append(f'end: {event.name} ends the processes {"never" if record.end_s is None else f"in {record.end_s:.2f} s"}, '
                        f'an ordinary process waited {late:.2f} s meanwhile{coincides}')
    for where in ('python', 'web'):
        if not record.gone.get(where):
            failures.append(f'message: clients ({where}) do not learn that the machine has ended')
    isTerminalOpen = not any(one.name.startswith('terminal.') for one in record.events)
    if isTerminalOpen and event.causes and not re.search(event.causes, record.gone.get('terminal', '')):
        failures.append(f'message: the terminal does not name {event.name}: {record.gone.get("terminal", "")[-200:]!r}')
    return failures


def lateness_between(record, begin, end):
    """The sum of the times that an ordinary process waited for a processor."""
    return sum(min(late, when - begin) for when, late in record.lateness if when > begin and when - late < end)


def aborts(record):
    """An abort must be answered in time, and the axes must stop."""
    abort = record.abort
    if abort is None:
        return []
    took = abort['answered'] - abort['sent']
    if abort['result'] not in ('done', 'error'):
        return [f'abort: no answer to the abort by {abort["kind"]}: {abort["result"]} after {abort["answered"] - abort["begin"]:.2f} s']
    failures = []
    if took > ABORT_S:
        late = lateness_between(record, abort['sent'], abort['answered'])
        coincides = '; the computer was late' if took - late <= ABORT_S else ''
        failures.append(f'abort: answered by {abort["kind"]} in {took * 1000:.0f} ms, an ordinary process waited {late * 1000:.0f} ms meanwhile{coincides}')
    if abort['result'] == 'error' and not (record.python and (record.web or not record.isWebUp)):
        failures.append('abort: answered with an error, without a message')
    moving = [b[0] for a, b in zip(record.samples, record.samples[1:]) if math.dist(a[1:4], b[1:4]) >= SAME_MM]
    if moving and moving[-1] - abort['answered'] > STOP_S:
        failures.append(f'abort: the axes move {moving[-1] - abort["answered"]:.2f} s after the answer')
    return failures


def same_messages(record):
    """Every error shown on one screen must also appear on the other. Errors of the last 0.3 s may not have arrived yet; errors
    before the start belong to the previous run."""
    if record.isEnding or not record.isWebUp:
        return []
    last = max([when for when, _ in record.python + record.web], default=0) - 0.3
    python, web = {text for _, text in record.python}, {text for _, text in record.web}
    if any('were lost' in text for text in python | web):
        return []
    failures = []
    for where, seen, other in (('web screen', web, record.python), ('Python', python, record.web)):
        lacking = [text for when, text in other if text not in seen and record.begin <= when < last]
        if lacking:
            failures.append(f'message: the {where} lacks {lacking[0][:150]!r}')
    return failures


def of_run(record):
    return off_path(record) + stops(record) + aborts(record) + same_messages(record)
