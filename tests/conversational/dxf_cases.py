# SPDX-License-Identifier: GPL-2.0-or-later
"""Random contours as pieces (lines and arcs) and as the text of a DXF file."""
import math

UNITS = {'mm': 4, 'inch': 1}
# Noise is added in the unit of the drawing.
UNIT_NOISE = [1.0]


def make(r, layer, scale, diameter, unit):
    """(contours, text, sides that fit)."""
    UNIT_NOISE[0] = scale
    isOpen = r.random() < 0.3
    count = r.choice([1, 1, 2])
    contours, entities = [], []
    for i in range(count):
        centre = (i * 30 * diameter, r.uniform(-50, 50) * scale)
        pieces, made = (open_line if isOpen else r.choice([circle, rounded, star, rounded_lines]))(r, layer, centre, diameter)
        contours.append(pieces)
        entities += made
    entities += [entity('LINE', 'notes', {10: 0, 20: 0, 11: 5, 21: 5}), entity('TEXT', layer, {10: 0, 20: 0, 40: 3, 1: 'note'})]
    r.shuffle(entities)
    units = f'  0\nSECTION\n  2\nHEADER\n  9\n$INSUNITS\n 70\n{UNITS[unit]}\n  0\nENDSEC\n'
    text = f'{units}  0\nSECTION\n  2\nENTITIES\n{"".join(entities)}  0\nENDSEC\n  0\nEOF\n'
    return contours, text.replace('\n', r.choice(['\n', '\r\n'])), ['left', 'right', 'on'] if isOpen else ['inside', 'outside', 'outside', 'on']


def entity(kind, layer, values):
    body = ''.join(f'{code:3d}\n{value if isinstance(value, str) else repr(round(float(value), 9)) if code not in (70, 90) else int(value)}\n' for code, value in values.items())
    return f'  0\n{kind}\n  8\n{layer}\n{body}'


def circle(r, layer, centre, d):
    radius = d * r.uniform(0.8, 6)
    return [('arc', centre, radius, 0.0, 360.0)], [entity('CIRCLE', layer, {10: centre[0], 20: centre[1], 40: radius})]


def vertices_text(vertices, isClosed):
    return ''.join(f' 10\n{x:.9f}\n 20\n{y:.9f}\n' + (f' 42\n{bulge:.12f}\n' if bulge else '') for x, y, bulge in vertices)


def corners(r, centre, d):
    half = (d * r.uniform(1.5, 8), d * r.uniform(1.5, 8))
    radius = r.uniform(0.2, 0.95) * min(half)
    a, b = half[0] - radius, half[1] - radius
    turn = r.choice([0.0, r.uniform(0, 2 * math.pi)])
    c, s = math.cos(turn), math.sin(turn)
    at = lambda x, y: (centre[0] + c * x - s * y, centre[1] + s * x + c * y)
    ends = [(at(half[0], -b), at(half[0], b)), (at(a, half[1]), at(-a, half[1])), (at(-half[0], b), at(-half[0], -b)), (at(-a, -half[1]), at(a, -half[1]))]
    middles = [at(a, b), at(-a, b), at(-a, -b), at(a, -b)]
    pieces = []
    for i in range(4):
        pieces.append(('line', *ends[i]))
        begin = math.degrees(turn) + 90 * i
        pieces.append(('arc', middles[i], radius, begin, begin + 90))
    return ends, pieces, radius


def rounded(r, layer, centre, d):
    """Writes one polyline with bulges, in either direction and of either type."""
    ends, pieces, _ = corners(r, centre, d)
    bulge = math.tan(math.radians(90 / 4))
    vertices = [v for a, b in ends for v in ((*a, 0.0), (*b, bulge))]
    if r.random() < 0.5:
        back = list(reversed(vertices))
        vertices = [(x, y, -back[(i + 1) % len(back)][2]) for i, (x, y, _) in enumerate(back)]
    if r.random() < 0.5:
        return pieces, [f'  0\nLWPOLYLINE\n  8\n{layer}\n 90\n8\n 70\n1\n{vertices_text(vertices, True)}']
    body = ''.join(f'  0\nVERTEX\n  8\n{layer}\n 10\n{x:.9f}\n 20\n{y:.9f}\n 42\n{bulge:.12f}\n' for x, y, bulge in vertices)
    return pieces, [f'  0\nPOLYLINE\n  8\n{layer}\n 66\n1\n 10\n0.0\n 20\n0.0\n 70\n1\n{body}  0\nSEQEND\n  8\n{layer}\n']


def rounded_lines(r, layer, centre, d):
    """Writes separate lines and arcs with small gaps between their ends, as drawing programs do."""
    _, pieces, _ = corners(r, centre, d)
    noise = r.choice([0.0, 5e-5, 4e-4]) * UNIT_NOISE[0]
    near = lambda value: value + r.uniform(-noise, noise)
    out = []
    for one in pieces:
        if one[0] == 'line':
            a, b = one[1:] if r.random() < 0.5 else one[:0:-1]
            out.append(entity('LINE', layer, {10: near(a[0]), 20: near(a[1]), 11: near(b[0]), 21: near(b[1])}))
        else:
            out.append(entity('ARC', layer, {10: near(one[1][0]), 20: near(one[1][1]), 40: near(one[2]), 50: one[3] % 360, 51: one[4] % 360}))
    return pieces, out


def star(r, layer, centre, d):
    """A polygon that every ray from its middle crosses once: with outer and inner corners."""
    count = r.randint(3, 9)
    first = r.uniform(0, 2 * math.pi)
    reach = d * r.uniform(2.5, 9)
    rough = r.choice([0.0, 0.25, 0.5])
    points = []
    for i in range(count):
        turn, away = first + 2 * math.pi * i / count, reach * r.uniform(1 - rough, 1)
        points.append((centre[0] + away * math.cos(turn), centre[1] + away * math.sin(turn)))
    pieces = [('line', a, b) for a, b in zip(points, points[1:] + points[:1])]
    if r.random() < 0.5:
        return pieces, [entity('LINE', layer, {10: a[0], 20: a[1], 11: b[0], 21: b[1]}) for _, a, b in pieces]
    return pieces, [f'  0\nLWPOLYLINE\n  8\n{layer}\n 90\n{count}\n 70\n1\n{vertices_text([(*p, 0.0) for p in points], True)}']


def open_line(r, layer, centre, d):
    at, heading = centre, r.uniform(0, 2 * math.pi)
    points = [at]
    for _ in range(r.randint(1, 5)):
        length = d * r.uniform(2.5, 6)
        at = (at[0] + length * math.cos(heading), at[1] + length * math.sin(heading))
        points.append(at)
        heading += r.uniform(-1.2, 1.2)
    pieces = [('line', a, b) for a, b in zip(points, points[1:])]
    return pieces, [f'  0\nLWPOLYLINE\n  8\n{layer}\n 90\n{len(points)}\n 70\n0\n{vertices_text([(*p, 0.0) for p in points], False)}']
