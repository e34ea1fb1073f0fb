# SPDX-License-Identifier: GPL-2.0-or-later
"""Signed distances from the shapes that a form describes: negative inside the material to be removed."""
import math

import numpy as np

ARC_PIECES = 240


def turned(x, y, centre, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    dx, dy = x - centre[0], y - centre[1]
    return c * dx + s * dy, -s * dx + c * dy


def round_box(x, y, centre, half, corner, degrees=0.0):
    u, v = turned(x, y, centre, degrees)
    dx, dy = np.abs(u) - (half[0] - corner), np.abs(v) - (half[1] - corner)
    return np.hypot(np.maximum(dx, 0), np.maximum(dy, 0)) + np.minimum(np.maximum(dx, dy), 0) - corner


def disc(x, y, centre, radius):
    return np.hypot(x - centre[0], y - centre[1]) - radius


def capsule(x, y, a, b, radius):
    dx, dy = b[0] - a[0], b[1] - a[1]
    share = np.clip(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy), 0, 1)
    return np.hypot(x - a[0] - share * dx, y - a[1] - share * dy) - radius


def curve_distance(x, y, pieces):
    """Shape of lines (a, b) and arcs (centre, radius, from, to anticlockwise, in degrees)."""
    least = np.full(np.shape(x), np.inf)
    for one in pieces:
        if one[0] == 'line':
            least = np.minimum(least, capsule(x, y, one[1], one[2], 0.0))
        else:
            _, centre, radius, begin, end = one
            angle = np.mod(np.degrees(np.arctan2(y - centre[1], x - centre[0])) - begin, 360.0)
            span = (end - begin) % 360.0 or 360.0
            ends = [np.hypot(x - centre[0] - radius * math.cos(math.radians(t)), y - centre[1] - radius * math.sin(math.radians(t))) for t in (begin, end)]
            least = np.minimum(least, np.where(angle <= span, np.abs(np.hypot(x - centre[0], y - centre[1]) - radius), np.minimum(*ends)))
    return least


def polygon_of(pieces):
    """Points along connected pieces; an arc is divided from its start point."""
    points = []
    for one in pieces:
        if one[0] == 'line':
            points += [one[1], one[2]]
            continue
        _, centre, radius, begin, end = one
        span = (end - begin) % 360.0 or 360.0
        arc = [(centre[0] + radius * math.cos(math.radians(begin + span * i / ARC_PIECES)), centre[1] + radius * math.sin(math.radians(begin + span * i / ARC_PIECES))) for i in range(ARC_PIECES + 1)]
        if points and math.dist(points[-1], arc[-1]) < math.dist(points[-1], arc[0]):
            arc.reverse()
        points += arc
    return points


def inside(x, y, points):
    """Even-odd rule."""
    isIn = np.zeros(np.shape(x), dtype=bool)
    for (x1, y1), (x2, y2) in zip(points, points[1:] + points[:1]):
        if y1 != y2:
            isIn ^= ((y1 > y) != (y2 > y)) & (x < (x2 - x1) * (y - y1) / (y2 - y1) + x1)
    return isIn
