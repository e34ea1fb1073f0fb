# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the moves of one operation with the values of its form: no dangerous moves, and the described shape."""
import math

import numpy as np

import shapes
from stock import Judge, Stock

# The interpreter prints ends and centres with four decimals, which is coarse in inches.
SLACK = {'mm': 0.003, 'inch': 0.00025}
MOST_MOVES = 60000
HOLES = {'drill', 'tap', 'bore'}
POCKETS = {'rect_pocket', 'round_pocket', 'slot'}
BOSSES = {'rect_boss', 'round_boss'}


def hole_positions(v):
    points = []
    turn = lambda degrees, dx, dy: (v['x'] + dx * math.cos(math.radians(degrees)) - dy * math.sin(math.radians(degrees)), v['y'] + dx * math.sin(math.radians(degrees)) + dy * math.cos(math.radians(degrees)))
    if v['pattern'] == 'circle':
        for i in range(int(v['holes'])):
            points.append(turn(v['start_angle'] + 360 * i / v['holes'], v['circle_diameter'] / 2, 0))
    elif v['pattern'] == 'line':
        points = [turn(v['angle'], i * v['spacing'], 0) for i in range(int(v['holes']))]
    elif v['pattern'] == 'grid':
        points = [turn(v['angle'], i * v['spacing_x'], k * v['spacing_y']) for i in range(int(v['columns'])) for k in range(int(v['rows']))]
    else:
        points = [tuple(float(word.replace(',', '.')) for word in line.replace(';', ' ').split()) for line in v['points'].replace('|', '\n').split('\n') if line.strip()]
    return points


def removal(kind, v, pieces, unit):
    """(low, high, function of x and y that is negative where material must be removed)."""
    d = v['diameter']
    if kind == 'face':
        x = v['x'] if v['origin'] == 'corner' else v['x'] - v['length'] / 2
        y = v['y'] if v['origin'] == 'corner' else v['y'] - v['width'] / 2
        return (x, y), (x + v['length'], y + v['width']), lambda px, py: np.full(np.shape(px), -1e9)
    if kind == 'rect_pocket':
        half = (v['length'] / 2, v['width'] / 2)
        centre = (v['x'], v['y'])
        if v['origin'] == 'corner':
            c, s = math.cos(math.radians(v['angle'])), math.sin(math.radians(v['angle']))
            centre = (v['x'] + c * half[0] - s * half[1], v['y'] + s * half[0] + c * half[1])
        reach = math.hypot(*half) + d
        return tuple(q - reach for q in centre), tuple(q + reach for q in centre), lambda px, py: shapes.round_box(px, py, centre, half, v['corner_radius'], v['angle'])
    if kind == 'round_pocket':
        reach = v['pocket_diameter'] / 2 + d
        return (v['x'] - reach, v['y'] - reach), (v['x'] + reach, v['y'] + reach), lambda px, py: shapes.disc(px, py, (v['x'], v['y']), v['pocket_diameter'] / 2)
    if kind == 'slot':
        reach = v['slot_width'] / 2 + d
        a, b = (v['x'], v['y']), (v['x_end'], v['y_end'])
        low, high = tuple(min(p, q) - reach for p, q in zip(a, b)), tuple(max(p, q) + reach for p, q in zip(a, b))
        return low, high, lambda px, py: shapes.capsule(px, py, a, b, v['slot_width'] / 2)
    if kind in BOSSES:
        half = (v['stock_length'] / 2, v['stock_width'] / 2)
        centre = (v['x'], v['y'])
        low, high = tuple(q - h for q, h in zip(centre, half)), tuple(q + h for q, h in zip(centre, half))
        if kind == 'rect_boss':
            return low, high, lambda px, py: -shapes.round_box(px, py, centre, (v['length'] / 2, v['width'] / 2), v['corner_radius'])
        return low, high, lambda px, py: -shapes.disc(px, py, centre, v['boss_diameter'] / 2)
    if kind in HOLES:
        points = hole_positions(v)
        low, high = tuple(min(p[k] for p in points) - d for k in (0, 1)), tuple(max(p[k] for p in points) + d for k in (0, 1))
        return low, high, lambda px, py: np.min([shapes.disc(px, py, p, d / 2) for p in points], axis=0)
    raise ValueError(kind)


def bottom_of(kind, v):
    bottom = v['top'] - v['depth']
    if kind == 'drill' and v['depth_at'] == 'diameter':
        bottom -= v['diameter'] / 2 / math.tan(math.radians(v['tip_angle'] / 2))
    return bottom


def rules_of(kind, v, unit):
    step = v.get('step_down', v['depth'])
    slope = None
    if kind in POCKETS or kind == 'contour':
        slope = None if v['entry'] == 'plunge' else math.tan(math.radians(v['ramp_angle']))
    elif kind in BOSSES or kind == 'face':
        slope = math.tan(math.radians(0.5))
    if kind in HOLES:
        step = v['peck'] if kind == 'drill' and v['cycle'] != 'drill' else v['top'] - bottom_of(kind, v)
    return {'step': step, 'slope': slope, 'level': v['top'] + v['clearance'], 'slack': SLACK[unit]}


def states(kind, v, moves, faults):
    """Spindle, feed and coolant while the tool is below the clearance."""
    coolant = {'flood': 'flood', 'mist': 'mist', 'off': 'off'}[v['coolant']]
    want = -v['speed'] if kind == 'tap' and v['hand'] == 'left' else v['speed']
    for move in moves:
        if move.kind in ('feed', 'arc') and min(move.start[2], move.end[2]) < v['top'] - 1e-6:
            isBack = move.end[2] > move.start[2] and kind in HOLES
            if move.coolant != coolant:
                faults.append(f'coolant {move.coolant}, not {coolant}')
            if not isBack and kind != 'tap' and abs(move.spindle - want) > 0.06:
                faults.append(f'spindle {move.spindle}, not {want}')
            feeds = [v[name] for name in ('feed', 'feed_z') if name in v] or [v['pitch'] * v['speed']]
            if kind != 'tap' and not any(abs(move.feed - f) < 0.006 for f in feeds):
                faults.append(f'feed {move.feed}, not one of {feeds}')
            return


def turning(moves, bottom, slack):
    """Twice the area that the cuts at the bottom enclose, positive for counter-clockwise."""
    cuts = [move for move in moves if move.kind in ('feed', 'arc') and max(move.start[2], move.end[2]) < bottom + slack]
    ends = [p for move in cuts for p in (move.start, move.end)]
    x, y = ((min(p[k] for p in ends) + max(p[k] for p in ends)) / 2 for k in (0, 1)) if ends else (0.0, 0.0)
    area = 0.0
    for move in cuts:
        (ax, ay), (bx, by) = move.start[:2], move.end[:2]
        area += (ax - x) * (by - y) - (bx - x) * (ay - y)
        if move.kind == 'arc':
            radius = math.hypot(ax - move.centre[0], ay - move.centre[1])
            area += radius * radius * (move.turns - math.sin(move.turns))
    return area


def direction_faults(kind, v, moves, slack):
    """Climb milling: anticlockwise in pockets, clockwise around bosses."""
    isInside = kind in POCKETS or v.get('side') == 'inside'
    isOutside = kind in BOSSES or v.get('side') == 'outside'
    if not isInside and not isOutside:
        return []
    area = turning(moves, v['top'] - v['depth'], slack)
    isClimb = (area > 0) == isInside
    isNarrow = kind == 'slot' and v['slot_width'] - v['diameter'] < 20 * slack
    return [] if isNarrow or isClimb == (v['direction'] == 'climb') else [f'wrong cutting direction, area {area:.4f}']


def judge_operation(kind, v, moves, unit, pieces=None, pitches=None):
    """The detected faults as texts, and figures."""
    faults = []
    states(kind, v, moves, faults)
    faults += direction_faults(kind, v, moves, SLACK[unit])
    if kind == 'thread_mill':
        return faults + thread_faults(v, moves, unit), {}
    if len(moves) > MOST_MOVES:
        return faults, {'isTooLong': True}
    if kind == 'engrave':
        return faults + engrave_faults(v, moves, unit), {}
    if kind == 'contour':
        return judge_contour(v, moves, unit, pieces, faults)
    low, high, distance = removal(kind, v, pieces, unit)
    stock = Stock(low, high, v['top'], v['diameter'] / 2)
    if kind != 'face':
        stock.add_probes(distance, 3 * SLACK[unit])
    judge = Judge(stock, v['diameter'] / 2, rules_of(kind, v, unit))
    judge.follow(moves)
    faults += judge.faults
    if kind == 'tap' and v['tapping'] == 'rigid' and not all(abs(abs(k) - v['pitch']) < 1e-4 for k in (pitches or {}).values()):
        faults.append(f'pitch {pitches}')
    bottom = bottom_of(kind, v)
    faults += shape_faults(stock.x, stock.y, stock.height, distance, v['top'], bottom, SLACK[unit])
    faults += shape_faults(stock.probe_x, stock.probe_y, stock.probe_height, distance, v['top'], bottom, SLACK[unit])
    figures = {'deepest': judge.deepest, 'steepest': judge.steepest, 'cells': stock.height.size, 'probes': stock.probe_x.size, 'removed': float(np.mean(stock.height < v['top'] - SLACK[unit]))}
    return faults, figures


def shape_faults(x, y, height, distance, top, bottom, slack):
    away = distance(x, y) if x.size else np.zeros(0)
    return texts_of({'cut outside of the shape': (height < top - slack) & (away > slack), 'material left': (away < -slack) & (height > bottom + slack), 'below the depth': height < bottom - slack}, x, y, height, away)


def texts_of(wrongs, x, y, height, away):
    faults = []
    for name, wrong in wrongs.items():
        if np.any(wrong):
            at = np.argmax(wrong)
            faults.append(f'{name}: {int(np.sum(wrong))} points, at X{x.flat[at]:.4f} Y{y.flat[at]:.4f} Z{height.flat[at]:.4f}, {away.flat[at]:.5f} from the wall')
    return faults


def side_of(v, x, y, contours):
    """Distance from the nearest contour, and whether the point is on its tool side. For open contours, the nearest piece decides."""
    flat = [piece for one in contours for piece in one]
    away = shapes.curve_distance(x, y, flat)
    if v['side'] == 'on':
        return away, np.ones(np.shape(x), dtype=bool)
    if v['side'] in ('inside', 'outside'):
        isIn = np.zeros(np.shape(x), dtype=bool)
        for one in contours:
            isIn |= shapes.inside(x, y, shapes.polygon_of(one))
        return away, isIn if v['side'] == 'inside' else ~isIn
    best = np.full(np.shape(x), np.inf)
    side = np.zeros(np.shape(x), dtype=bool)
    for one in contours:
        for _, a, b in one:  # open contours of the campaign have only lines
            d = shapes.capsule(x, y, a, b, 0.0)
            left = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0
            isNearer = d < best - 1e-12
            best, side = np.where(isNearer, d, best), np.where(isNearer, left, side)
    return away, side if v['side'] == 'left' else ~side


def moved(contours, v):
    shift = lambda p: (p[0] + v['x'], p[1] + v['y'])
    return [[('line', shift(one[1]), shift(one[2])) if one[0] == 'line' else ('arc', shift(one[1]), *one[2:]) for one in contour] for contour in contours]


def judge_contour(v, moves, unit, contours, faults):
    slack, radius = SLACK[unit], v['diameter'] / 2
    contours = moved(contours, v)
    points = [p for one in contours for p in shapes.polygon_of(one)]
    reach = 2 * v['diameter'] + 2 * v.get('allowance', 0.0)
    stock = Stock((min(p[0] for p in points) - reach, min(p[1] for p in points) - reach), (max(p[0] for p in points) + reach, max(p[1] for p in points) + reach), v['top'], radius)

    def distance(x, y):
        away, isTool = side_of(v, x, y, contours)
        return away - radius if v['side'] == 'on' else np.where(isTool, -away, away)

    stock.add_probes(distance, 5 * slack)
    judge = Judge(stock, radius, rules_of('contour', v, unit))
    judge.follow(moves)
    faults += judge.faults
    faults += contour_faults(stock.x, stock.y, stock.height, v, contours, slack) + contour_faults(stock.probe_x, stock.probe_y, stock.probe_height, v, contours, slack)
    return faults, {'deepest': judge.deepest, 'steepest': judge.steepest, 'cells': stock.height.size, 'probes': stock.probe_x.size, 'removed': float(np.mean(stock.height < v['top'] - slack))}


def contour_faults(x, y, height, v, contours, slack):
    if x.size == 0:
        return []
    radius = v['diameter'] / 2
    away, isTool = side_of(v, x, y, contours)
    isEnded = v['side'] in ('left', 'right')
    # Arcs of the drawing are polygons where a side is determined.
    blur = 1e-4 * max((one[2] for c in contours for one in c if one[0] == 'arc'), default=0.0) + slack
    wide = radius if v['side'] == 'on' else 2 * radius + v['allowance']
    ends = end_distance(x, y, contours) if isEnded else np.full(np.shape(away), np.inf)
    isCut = height < v['top'] - slack
    gouged = isCut & ((away > wide + slack) | (~isTool & (away > blur) & (ends > radius + slack)))
    left = wanted(x, y, height, away, isTool, v, slack, contours) & (away > blur) & (ends > 1.5 * radius)
    if v['side'] == 'on':
        left = (away < radius - slack) & (height > v['top'] - v['depth'] + slack)
    return texts_of({'cut outside of the shape': gouged, 'material left': left, 'below the depth': height < v['top'] - v['depth'] - slack}, x, y, height, away)


def end_distance(x, y, contours):
    ends = [p for one in contours for p in (one[0][1], one[-1][2])]
    return np.min([np.hypot(x - p[0], y - p[1]) for p in ends], axis=0)


def wanted(x, y, height, away, isTool, v, slack, contours):
    """Points near the line with material that the tool can reach without cutting into a contour."""
    out = np.zeros(np.shape(away), dtype=bool)
    if v['side'] == 'on':
        return out
    radius = v['diameter'] / 2
    px, py = centres(radius, v, contours)
    if px.size:
        for at in np.flatnonzero(isTool & (away < 0.95 * radius) & (away > 4 * slack) & (height > v['top'] - v['depth'] + slack)):
            out.flat[at] = np.min(np.hypot(px - x.flat[at], py - y.flat[at])) < radius - slack
    return out


def centres(radius, v, contours):
    """Points beside the lines where the tool touches one and cuts into none."""
    points = []
    for one in (piece for contour in contours for piece in contour):
        if one[0] == 'line':
            (ax, ay), (bx, by) = one[1:]
            length = math.hypot(bx - ax, by - ay)
            nx, ny = (ay - by) / length * radius, (bx - ax) / length * radius
            count = max(2, math.ceil(length / radius * 4))
            points += [(ax + (bx - ax) * i / count + sign * nx, ay + (by - ay) * i / count + sign * ny) for i in range(count + 1) for sign in (-1, 1)]
        else:
            _, centre, reach, begin, end = one
            span = (end - begin) % 360.0 or 360.0
            count = max(8, math.ceil(math.radians(span) * (reach + radius) / radius * 4))
            turns = [math.radians(begin + span * i / count) for i in range(count + 1)]
            points += [(centre[0] + (reach + sign * radius) * math.cos(t), centre[1] + (reach + sign * radius) * math.sin(t)) for t in turns for sign in (-1, 1) if reach + sign * radius >= 0]
    px, py = np.array(points).T
    away, isTool = side_of(v, px, py, contours)
    isFree = isTool & (away >= radius - 1e-7)
    return px[isFree], py[isFree]


def engrave_faults(v, moves, unit):
    slack = SLACK[unit]
    h, faults = v['text_height'], []
    level = v['top'] + v['clearance']
    cut = []
    at = v['top']
    depths = set()
    for move in moves:
        low = min(move.start[2], move.end[2])
        if move.kind == 'rapid' and (low < level - slack and math.hypot(move.end[0] - move.start[0], move.end[1] - move.start[1]) > slack or move.end[2] < level - slack):
            faults.append('rapid move below the clearance')
        if move.kind == 'feed' and low < at - slack:
            depths.add(round(low, 4))
            cut += [move.start, move.end]
    if not cut:
        return faults + ['nothing is cut']
    depths = sorted(depths, reverse=True)
    steps = [a - b for a, b in zip([v['top'], *depths], depths)]
    if abs(depths[-1] - (v['top'] - v['depth'])) > slack or max(steps) > v['step_down'] + slack:
        faults.append(f'depths {depths[:5]}')
    c, s = math.cos(math.radians(v['angle'])), math.sin(math.radians(v['angle']))
    us = [c * (p[0] - v['x']) + s * (p[1] - v['y']) for p in cut]
    ws = [-s * (p[0] - v['x']) + c * (p[1] - v['y']) for p in cut]
    letters = len(v['text'])
    wide = max(us) - min(us)
    if min(ws) < -0.42 * h or max(ws) > 1.35 * h or wide > 1.3 * h * letters:
        faults.append(f'text from {min(us):.3f} {min(ws):.3f} to {max(us):.3f} {max(ws):.3f}, height {h}')
    isLeft = min(us) > -0.08 * h
    if v['align'] == 'left' and not isLeft or v['align'] == 'right' and max(us) > 0.09 * h or v['align'] == 'centre' and abs(max(us) + min(us)) > 0.2 * h + 0.9 * h * (v['text'] != v['text'].strip()):
        faults.append(f'alignment {v["align"]}: {min(us):.3f} to {max(us):.3f}')
    return faults


def thread_faults(v, moves, unit):
    """The helix around the axis: pitch, hand, depth and radius; rapid moves stay in the hole or away from the bolt."""
    slack, faults = SLACK[unit], []
    tool = v['diameter'] / 2
    isIn = v['thread_side'] == 'internal'
    bottom = v['top'] - v['depth']
    final = v['major'] / 2 - tool if isIn else v['minor'] / 2 + tool
    reached, low, high = None, math.inf, -math.inf
    passes = set()
    for move in moves:
        points = samples(move)
        for p in points:
            away = math.hypot(p[0] - v['x'], p[1] - v['y'])
            if p[2] < v['top'] - slack:
                if p[2] < bottom - slack:
                    faults.append(f'below the depth: {p}')
                if isIn and away > final + slack or not isIn and away < final - slack:
                    faults.append(f'outside of the thread: {p}')
                isInAir = away < v['minor'] / 2 - tool - slack if isIn else away > v['major'] / 2 + tool + slack
                if move.kind != 'arc' and not isInAir:
                    faults.append(f'{move.kind} in material: {p}')
                if move.kind == 'rapid':
                    faults.append(f'rapid move in the thread: {p}')
        isHelix = move.kind == 'arc' and abs(move.end[2] - move.start[2]) > slack
        if isHelix:
            lead = (move.end[2] - move.start[2]) / move.turns * 2 * math.pi  # of a turn anticlockwise
            want = v['pitch'] if v['hand'] == 'right' else -v['pitch']
            if abs(lead - want) > 0.002 * abs(want) + slack:
                faults.append(f'pitch {lead:.5f}, not {want}')
            isClimb = (move.turns > 0) == isIn
            if isClimb != (v['direction'] == 'climb'):
                faults.append('wrong cutting direction')
            radius = math.hypot(move.start[0] - v['x'], move.start[1] - v['y'])
            passes.add(round(radius, 3))
            if abs(radius - final) <= slack:
                low, high = min(low, move.start[2], move.end[2]), max(high, move.start[2], move.end[2])
                reached = radius
    if reached is None or low > bottom + slack or high < v['top'] - slack:
        faults.append(f'thread from {low} to {high} at radius {reached}, not {bottom} to {v["top"]} at {final:.4f}')
    if abs(len(passes) - v['passes']) > (1 if v['passes'] > 5 else 0):
        faults.append(f'{len(passes)} passes')
    return faults[:5]


def samples(move):
    if move.kind != 'arc':
        return [tuple(a + (b - a) * i / 8 for a, b in zip(move.start, move.end)) for i in range(9)]
    count = max(8, int(abs(move.turns) / 0.2))
    first = math.atan2(move.start[1] - move.centre[1], move.start[0] - move.centre[0])
    radius = math.hypot(move.start[0] - move.centre[0], move.start[1] - move.centre[1])
    return [(move.centre[0] + radius * math.cos(first + move.turns * i / count), move.centre[1] + radius * math.sin(first + move.turns * i / count), move.start[2] + (move.end[2] - move.start[2]) * i / count) for i in range(count + 1)]
