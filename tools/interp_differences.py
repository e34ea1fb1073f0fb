# SPDX-License-Identifier: GPL-2.0-or-later
"""Intended differences from LinuxCNC's rs274: each is recognised separately and explained in docs/reference/compatibility.md.

Each function takes a Pair and removes only its own difference from the two lists of calls. If the lists are equal after all
functions, those that have changed something explain the differences.
"""
import math
import re

NUMBER = re.compile(r'-?\d+\.\d+')
MOVE = re.compile(r'(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED)\(')
AT_ONCE = re.compile(r'(MESSAGE\(|LOG|(EN|DIS)ABLE_(FEED_OVERRIDE|SPEED_OVERRIDE|ADAPTIVE_FEED|FEED_HOLD)\()')
LATHE_CYCLE = re.compile(r'\bg7[012](\.[12])?\s*q', re.I)


class Pair:
    """The calls of both, without counters and N."""

    def __init__(self, program, reference, ours):
        self.program, self.reference, self.ours = program, reference, ours

    def has(self, pattern):
        return re.search(pattern, self.program, re.I | re.M) is not None


def numbers(call):
    return [float(number) for number in NUMBER.findall(call)]


def isSameCall(a, b):
    """The last printed digit may differ by one, and the sign of 0 does not matter."""
    if a == b:
        return True
    zero = re.compile(r'-0(?![.\d])')
    a, b = zero.sub('0', a), zero.sub('0', b)
    if NUMBER.sub('#', a) != NUMBER.sub('#', b):
        return False
    for x, y in zip(NUMBER.findall(a), NUMBER.findall(b)):
        digits = len(x.split('.')[1])
        if digits != len(y.split('.')[1]) or abs(round(float(x) * 10**digits) - round(float(y) * 10**digits)) > 1:
            return False
    return True


def isSame(a, b):
    return len(a) == len(b) and all(map(isSameCall, a, b))


def speed_override_at_end(pair):
    """M2 and M30 enable the speed overrides that M49 or M51 P0 had disabled, as the manual states."""
    if 'PROGRAM_END()' not in pair.ours:
        return
    end = pair.ours.index('PROGRAM_END()')
    first = max(i for i in range(end) if pair.ours[i].startswith('SET_FEED_MODE('))
    pair.ours = [call for i, call in enumerate(pair.ours)
                 if not (first < i < end and call.startswith('ENABLE_SPEED_OVERRIDE('))]


def order_under_compensation(pair):
    """Under compensation LinuxCNC makes message and switch calls before the moves that it delays."""
    def sorted_blocks(calls):
        out, moves, others, isOn = [], [], [], False
        for call in calls:
            if 'cutter radius compensation on' in call:
                isOn = True
            if isOn and call == 'COMMENT("interpreter: cutter radius compensation off")':
                out, moves, others, isOn = out + others + moves, [], [], False
            if isOn and (AT_ONCE.match(call) or not re.match(r'[A-Z][A-Z0-9_.]*\(', call)):
                others.append(call)
            elif isOn:
                moves.append(call)
            else:
                out.append(call)
        return out + others + moves
    if any('cutter radius compensation on' in call for call in pair.reference):
        pair.reference, pair.ours = sorted_blocks(pair.reference), sorted_blocks(pair.ours)


def context_announced(pair):
    """M72 and the end of M73 make calls for feed, speeds and path mode, as in the conformance cases; LinuxCNC restores the feed
    with one decimal and the speeds without decimals."""
    if not pair.has(r'm7[23]'):
        return
    kinds = re.compile(r'(SET_FEED_RATE|SET_SPINDLE_SPEED\(\d+|SET_MOTION_CONTROL_MODE|SET_NAIVECAM_TOLERANCE)')

    def without_repeats(calls):
        last, out = {'SET_FEED_RATE': 'SET_FEED_RATE(0.0000)',
                     'SET_MOTION_CONTROL_MODE': 'SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, 0.000000)',
                     'SET_NAIVECAM_TOLERANCE': 'SET_NAIVECAM_TOLERANCE(0.0000)'}, []
        for call in calls:
            kind = kinds.match(call)
            if kind:
                name = kind.group(1)
                known = last.get(name, f'{name}, 0.0000)' if 'SPINDLE' in name else None)
                last[name] = call
                if known is not None and isSameCall(known, call):
                    continue
            if call.startswith('SET_FEED_MODE'):
                last.pop('SET_FEED_RATE', None)
            out.append(call)
        return out
    pair.reference, pair.ours = without_repeats(pair.reference), without_repeats(pair.ours)
    for i, (a, b) in enumerate(zip(pair.reference, pair.ours)):
        if a.startswith('SET_FEED_RATE(') and b.startswith('SET_FEED_RATE(') and \
                abs(numbers(a)[0] - numbers(b)[0]) < 0.0501 and abs(numbers(a)[0] * 10 - round(numbers(a)[0] * 10)) < 1e-6:
            pair.reference[i] = b
        speed = 'SET_SPINDLE_SPEED('
        if a.startswith(speed) and b.startswith(speed) and a.split(',')[0] == b.split(',')[0] and \
                numbers(a)[0] == round(numbers(b)[0]):
            pair.reference[i] = b


def threading_enables_override(pair):
    """After M49 or M50 P0 each pass of G76 switches the feed override on in LinuxCNC; here it remains off."""
    out = []
    for i, call in enumerate(pair.reference):
        isPass = call == 'ENABLE_FEED_OVERRIDE()' and i > 1 and pair.reference[i - 2] == 'STOP_SPEED_FEED_SYNCH()' and \
            pair.reference[i - 1].startswith('STRAIGHT_TRAVERSE(')
        if not isPass:
            out.append(call)
    mine = []
    for i, call in enumerate(pair.ours):
        isPass = call == 'ENABLE_FEED_OVERRIDE()' and i > 1 and pair.ours[i - 2] == 'STOP_SPEED_FEED_SYNCH()' and \
            pair.ours[i - 1].startswith('STRAIGHT_TRAVERSE(')
        if not isPass:
            mine.append(call)
    if pair.has('g76') and pair.has(r'm49|m50\s*p0'):
        pair.reference, pair.ours = out, mine


def lathe_pieces(pair):
    """G70 to G72: moves without length that LinuxCNC's G71.1 makes, and arcs that only one side divides into two pieces."""
    if not LATHE_CYCLE.search(pair.program):
        return

    def merged(calls):
        out = []
        for call in calls:
            if out and call.startswith('STRAIGHT_FEED(') and ends_at(out[-1]) is not None and \
                    close(ends_at(out[-1]), ends_at(call)):
                continue
            if out and call.startswith('ARC_FEED(') and out[-1].startswith('ARC_FEED(') and \
                    close(numbers(call)[2:5], numbers(out[-1])[2:5]) and call.split(', ')[4] == out[-1].split(', ')[4]:
                out[-1] = call
                continue
            out.append(call)
        return out
    pair.reference, pair.ours = merged(pair.reference), merged(pair.ours)


def way_out_of_finishing(pair):
    """Between the passes of G70 ours leaves the end of the profile at feed across it; LinuxCNC moves straight back."""
    if not re.search(r'\bg70\s*q[^\n]*p[2-9]', pair.program, re.I):
        return
    for i in range(len(pair.ours) - 1):
        isOut = i < len(pair.reference) and pair.ours[i].startswith('STRAIGHT_FEED(') and \
            pair.ours[i + 1].startswith('STRAIGHT_TRAVERSE(') and not isSameCall(pair.ours[i], pair.reference[i]) and \
            isSameCall(pair.ours[i + 1], pair.reference[i])
        if isOut:
            pair.reference.insert(i, pair.ours[i])


def narrow_layers(pair):
    """G71 and G72: LinuxCNC retracts from a layer of almost no width with unnecessary rapids."""
    if not LATHE_CYCLE.search(pair.program):
        return
    calls, out, i = pair.reference, [], 0
    while i < len(calls):
        run = calls[i - 1:i + 3] if i > 0 else []
        isAway = len(run) == 4 and all(one.startswith('STRAIGHT_TRAVERSE(') for one in run[1:3]) and \
            run[0].startswith('STRAIGHT_FEED(') and run[3].startswith('STRAIGHT_') and \
            all(abs(x - y) < 0.03 for x, y in zip(numbers(run[0]), numbers(run[3])))
        if isAway:
            out.append(run[3].replace('TRAVERSE', 'FEED'))
            i += 3
            continue
        out.append(calls[i])
        i += 1
    pair.reference = out


def close(a, b):
    return len(a) == len(b) and all(abs(x - y) < 1.5e-4 for x, y in zip(a, b))


def ends_at(call):
    """X and Z of a move in G18; None for other calls."""
    if call.startswith(('STRAIGHT_FEED(', 'STRAIGHT_TRAVERSE(')):
        return [numbers(call)[0], numbers(call)[2]]
    return [numbers(call)[1], numbers(call)[0]] if call.startswith('ARC_FEED(') else None


def name_of(one):
    return ' '.join(one.__doc__.split())


def peck_at_the_bottom(pair):
    """G73 and G83 whose last peck ends at the bottom: due to rounding LinuxCNC repeats the last peck."""
    if not pair.has(r'g[78]3'):
        return
    out = []
    for call in pair.reference:
        back = [i for i in (-2, -3) if len(out) >= -i and call.startswith('STRAIGHT_FEED(') and isSameCall(out[i], call)]
        if back and all(one.startswith('STRAIGHT_TRAVERSE(') for one in out[back[0] + 1:]):
            del out[back[0] + 1:]
            continue
        out.append(call)
    pair.reference = out


def long_numbers(pair):
    """In comments LinuxCNC prints ###### for numbers of 30 or more characters."""
    pair.ours = [re.sub(r'-?[\d.]{30,}', '######', call) if call.startswith('MESSAGE(') or '(' not in call else call
                 for call in pair.ours]


def small_numbers(pair):
    """In comments LinuxCNC prints numbers below 0.0001 as 0."""
    pair.ours = [re.sub(r'(?<![\d.])-?0\.0000\d+', lambda m: '0.' + '0' * (len(m[0].split('.')[1])), call)
                 if call.startswith('MESSAGE(') or '(' not in call else call for call in pair.ours]


def angles_of_home(pair):
    """G28 and G30: LinuxCNC subtracts only the lengths of the tool offset from the stored position, not its angles."""
    if not pair.has(r'g(28|30)\b'):
        return
    offset = [0.0, 0.0, 0.0]
    for i, (theirs, mine) in enumerate(zip(pair.reference, pair.ours)):
        if mine.startswith('USE_TOOL_LENGTH_OFFSET('):
            offset = numbers(mine)[3:6]
        if mine == theirs or not MOVE.match(mine) or not theirs.startswith(mine.split('(', 1)[0]):
            continue
        a, b = numbers(mine), numbers(theirs)
        if len(a) == len(b) and all(abs(x - y) < 2e-4 for x, y in zip(a[:-3], b[:-3])) and all(
                abs(x - y) < 2e-4 or abs(x - y + part) < 2e-4 for x, y, part in zip(a[-3:], b[-3:], offset)):
            pair.ours[i] = theirs


def orientation_of_back_boring(pair):
    """G87 with a counterclockwise spindle: LinuxCNC orients with a mode that M19 does not have."""
    if pair.has('g87'):
        pair.reference = [re.sub(r'^ORIENT_SPINDLE\((\d), 0\.0000, 3\)$', r'ORIENT_SPINDLE(\1, 0.0000, 2)', call)
                          for call in pair.reference]


def isAroundCorner(start, middle, end):
    """True if the points between start and end are corners of a polygon around the circle through both, whose first and last
    sides are tangents there."""
    (x1, y1), (x2, y2), (dx, dy) = start, end, (middle[0][0] - start[0], middle[0][1] - start[1])
    across = dx * (y2 - y1) - dy * (x2 - x1)
    chord = (x2 - x1)**2 + (y2 - y1)**2
    if abs(across) < 1e-12 or chord < 1e-8:
        return False
    # The centre lies on the normal to the first side at its start, and at the same distance from the end.
    factor = chord / (2 * across)
    centre = (x1 - dy * factor, y1 + dx * factor)
    radius = math.hypot(x1 - centre[0], y1 - centre[1])
    # Four decimals are printed; this is the error of a difference, propagated to the centre.
    slack = 3e-4 + radius * 1.5e-4 * (math.hypot(dx, dy) + math.sqrt(chord)) / abs(across)
    far = [math.hypot(x - centre[0], y - centre[1]) for x, y in middle]
    last = (end[0] - middle[-1][0], end[1] - middle[-1][1])
    leaving = last[0] * (x2 - centre[0]) + last[1] * (y2 - centre[1])
    return all(radius - slack <= d <= 1.3 * radius + slack for d in far) and abs(leaving) <= math.hypot(*last) * slack + 3e-4 * radius


def rapid_corners(pair):
    """G0 around a convex corner under compensation: LinuxCNC's rapid is a chord, ours follows the circle of the tool."""
    if not any('cutter radius compensation on' in call for call in pair.reference):
        return
    chords, at = [], None
    for call in pair.reference:
        end = end_of(call)
        if end and at and call.startswith('STRAIGHT_TRAVERSE('):
            chords.append((at, end))
        at = end or at
    out, at, i, mine = [], None, 0, pair.ours
    while i < len(mine):
        for more in range(1, 6):
            run = mine[i:i + more + 1]
            if at is None or len(run) <= more or not all(call.startswith('STRAIGHT_TRAVERSE(') for call in run):
                break
            points = [end_of(call) for call in run]
            isChord = any(close(at, a) and close(points[-1], b) for a, b in chords)
            if isChord and any(isAroundCorner((at[0], at[k]), [(one[0], one[k]) for one in points[:-1]],
                                              (points[-1][0], points[-1][k])) for k in (1, 2)):
                i += more
                break
        out.append(mine[i])
        at = end_of(mine[i]) or at
        i += 1
    pair.ours = out


def end_of(call):
    """X Y Z of a move; None for other calls. Arcs are in the plane XY or XZ, as printed."""
    return numbers(call)[:3] if call.startswith(('STRAIGHT_FEED(', 'STRAIGHT_TRAVERSE(')) else None


def tolerance_after_units(pair):
    """A canned cycle after G20 or G21: LinuxCNC restores the numbers of G64 in the previous unit; ours restores the lengths."""
    restored = ('SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS', 'SET_NAIVECAM_TOLERANCE(')
    for i, (theirs, mine) in enumerate(zip(pair.reference, pair.ours)):
        if not theirs.startswith(restored) or theirs == mine or NUMBER.sub('#', theirs) != NUMBER.sub('#', mine):
            continue
        a, b = numbers(theirs)[0], numbers(mine)[0]
        if abs(b - 25.4 * a) < 2e-3 or abs(a - 25.4 * b) < 2e-3:
            pair.ours[i] = theirs


def cycle_with_another_height(pair):
    """A line of a canned cycle that changes R: LinuxCNC moves to the new R beside the hole, also downwards or at an angle; ours
    stays at the clear height until it is over the hole."""
    if not pair.has(r'^\s*(n\d+\s*)?/?\s*[xyz][^\n]*r'):
        return

    def heights_left_out(calls):
        out, isOver = [], False
        for i, call in enumerate(calls):
            isTraverse = call.startswith('STRAIGHT_TRAVERSE(')
            follows = calls[i + 1] if i + 1 < len(calls) else ''
            begins = follows == 'SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)'
            isOver = call == 'SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)' or (isOver and isTraverse)
            if isTraverse and (begins or (isOver and follows.startswith('STRAIGHT_TRAVERSE('))):
                continue
            out.append(call)
        return out
    pair.reference, pair.ours = heights_left_out(pair.reference), heights_left_out(pair.ours)


def thread_passes(pair):
    """G76 whose last calculated depth differs from K only by rounding: LinuxCNC cuts at K again; Millwright counts the passes."""
    if not pair.has('g76'):
        return
    at = next((i for i, (a, b) in enumerate(zip(pair.reference, pair.ours)) if not isSameCall(a, b)), len(pair.ours))
    while at < len(pair.reference):
        for length in range(6, 12):
            first = at - length
            one, other = pair.reference[max(first, 0):at], pair.reference[at:at + length]
            isPass = any(call.startswith('START_SPEED_FEED_SYNC(') for call in one) and \
                sum(call == 'STOP_SPEED_FEED_SYNCH()' for call in one) == 1
            if first >= 0 and isPass and isSame(one, other):
                del pair.reference[at:at + length]
                break
        else:
            return
        found = next((i for i, (a, b) in enumerate(zip(pair.reference, pair.ours)) if not isSameCall(a, b)), None)
        if found is None or found <= at:
            return
        at = found


# Classes that compare the lists element by element come last; lathe_pieces may join moves that rapid_corners needs.
CLASSES = (speed_override_at_end, order_under_compensation, cycle_with_another_height, rapid_corners, context_announced,
           threading_enables_override, lathe_pieces, way_out_of_finishing, narrow_layers, peck_at_the_bottom, long_numbers,
           small_numbers, angles_of_home, orientation_of_back_boring, tolerance_after_units, rapid_corners, thread_passes)

# Blocks that only Millwright rejects, with its messages. The calls before must be equal.
STRICTER = {
    'in concave corner cannot be reached': 'a corner of nearly 180 degrees towards the tool',
    'Concave corner cannot be reached': 'a corner of nearly 180 degrees towards the tool',
    'M6 needs a tool': 'M6 with no T word before',
    'The feed is per revolution': 'G95 feed with spindle speed 0 in canned cycles',
    'The first G5 of a series': 'first G5 without I and J',
    'The tapers of G76 are longer': 'a G76 whose tapers are longer than the thread',
    'Start point too close to probe point': 'a probe that would not move',
    'G5.1 moves only the axes': 'lines after a G5.1',
    'g5.1 needs': 'lines after a G5.1',
    'G5.1 needs the control point': 'G5.1 with I0 J0',
    'g5 needs the word': 'lines after a G5 that lack P and Q',
    'is for while and do loops': 'break and continue of a repeat, when jumped over',
    'G64 must not be negative': 'G64 with a negative tolerance',
    'm67 needs the word Q': 'M67 and M68 without Q',
    'm68 needs the word Q': 'M67 and M68 without Q',
    'The degression R of G76 must': 'G76 with R below 1',
    'The wait mode L of M66': 'M66 with another wait mode than 0 to 4',
    'Cannot do g33 with cutter radius compensation on': 'G33 under compensation',
}

# As above, if the program contains a match of the expression.
STRICTER_WITH = {'Must use g0 or g1 with g53': (r'g5\.1', 'lines after a G5.1')}


def explain(pair, hasFailed):
    """The classes that make the two lists equal, or None. Calls of a block that failed on both sides have no effect."""
    used = []

    def isDone():
        return isSame(pair.reference[:len(pair.ours)] if hasFailed else pair.reference, pair.ours)
    for one in CLASSES:
        if isDone():
            break
        before = (list(pair.reference), list(pair.ours))
        one(pair)
        if before != (pair.reference, pair.ours):
            used.append(one)
    return used if isDone() else None


CHOSEN_SPINDLE = re.compile(r'(Chosen spindle \(\d\)|Spindle) not turning in G(33|33\.1|76)\b')


def isOtherSpindle(program, refusal):
    """After G96 or G97 $n LinuxCNC's G33 and G76 without $ use spindle n; here they use spindle 0, as the manual states."""
    return CHOSEN_SPINDLE.match(refusal) is not None and re.search(r'g9[67][^\n]*\$[1-9]', program, re.I) is not None
