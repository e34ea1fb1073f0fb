# SPDX-License-Identifier: GPL-2.0-or-later
"""Tool paths over a relief: the minimum height of a tool over a height field, and the lines of passes.

Heights are an array [row, column] in units, row 0 at y = 0, at most 0 (the top of the stock). Pixels are points on a grid of
`pixel` units. Along a scan the tool is evaluated at every PARTS-th of a pixel. A contact between two of these points counts for
both, so that no straight move between them cuts into a point.
"""
import math

PARTS = 8


def tool_rise(kind, radius, distance):
    """Height of the tool's surface above its tip at a distance from its axis (at most its radius)."""
    if kind == 'ball':
        return radius - math.sqrt(max(radius * radius - distance * distance, 0.0))
    if kind == 'flat':
        return 0.0
    return distance * math.tan(math.radians(float(kind.removeprefix('vee'))))


def allowed(np, heights, row, pixel, kind, radius, reach_rows=0.0):
    """Minimum tip height at the points (column * PARTS + part) along a row. reach_rows: distance in pixels by which the tool may
    be beside the row."""
    rows, columns = heights.shape
    reach = radius / pixel
    lowest = np.full((PARTS, columns), -np.inf)
    whole = int(reach + 1 / PARTS) + 1
    for dy in range(-int(reach + reach_rows), int(reach + reach_rows) + 1):
        if not 0 <= row + dy < rows:
            continue
        line, across = heights[row + dy], max(abs(dy) - reach_rows, 0.0)
        for part in range(PARTS):
            for dx in range(-whole, whole + 2):
                distance = math.hypot(max(abs(dx - part / PARTS) - 1 / PARTS, 0.0), across)
                if distance > reach or abs(dx) >= columns:
                    continue
                rise = tool_rise(kind, radius, distance * pixel)
                if dx >= 0:
                    np.maximum(lowest[part, :columns - dx], line[dx:] - rise, out=lowest[part, :columns - dx])
                else:
                    np.maximum(lowest[part, -dx:], line[:dx] - rise, out=lowest[part, -dx:])
    # Parts behind the last pixel are outside the picture.
    return lowest.T.reshape(-1)[:(columns - 1) * PARTS + 1]


def straight(points, tolerance):
    """Points such that all others are within the tolerance of the straight lines between them. points: [(x, z)] with x rising or
    falling. The deviation is measured in z, so it is at least the distance."""
    kept, start = [points[0]], 0
    while start < len(points) - 1:
        # The range of slopes that keep all points so far within the tolerance; only a slope through a point is used.
        x0, z0 = points[start]
        low, high, best, at = -math.inf, math.inf, start + 1, start + 1
        while at < len(points):
            step = abs(points[at][0] - x0)
            slope = (points[at][1] - z0) / step if step else 0.0
            if low <= slope <= high:
                best = at
            low, high = max(low, slope - tolerance / step), min(high, slope + tolerance / step)
            if low > high:
                break
            at += 1
        kept.append(points[best])
        start = best
    return kept


def runs_up(points, down):
    """Divides a scan into runs that only climb (with `down` only descend), each starting at its low (high) end."""
    runs, start = [], 0
    while start < len(points) - 1:
        end, sign = start + 1, 0
        while end < len(points):
            step = points[end][1] - points[end - 1][1]
            if step and sign and (step > 0) != (sign > 0):
                break
            sign = sign or step
            end += 1
        run = points[start:end]
        runs.append(run[::-1] if (sign < 0) != down else run)
        start = end - 1
    return runs or [points]


def pieces(points, wanted):
    """The parts of a scan in which wanted is true."""
    found, start = [], None
    for n in range(len(points) + 1):
        inside = n < len(points) and wanted[n]
        if inside and start is None:
            start = n
        if not inside and start is not None:
            if n - start > 1:
                found.append(points[start:n])
            start = None
    return found


def widen(np, wanted, places):
    """True also for this number of neighbours on each side."""
    if not wanted.any() or places <= 0:
        return wanted
    sums = np.concatenate(([0], np.cumsum(wanted)))
    index = np.arange(len(wanted))
    return sums[np.minimum(index + places + 1, len(wanted))] > sums[np.maximum(index - places, 0)]


def scan_rows(count, step):
    """Every step-th row, and the last one."""
    rows = list(range(0, count, step))
    return rows if rows[-1] == count - 1 else [*rows, count - 1]


class Relief:
    """Passes over a field of heights."""

    def __init__(self, np, heights, settings, origin, progress):
        """origin: pixels of the field to the left of and below zero. progress(part): called with the completed fraction."""
        self.np, self.heights, self.set, self.origin, self.progress = np, heights, settings, origin, progress
        self.tops = {}

    def passes(self):
        """[(axis, rows)] of the pattern; axis 0: rows."""
        return {'rows': [0], 'columns': [1], 'rows-columns': [0, 1], 'columns-rows': [1, 0]}[self.set.pattern]

    def field(self, axis):
        return self.heights if axis == 0 else self.heights.T

    def tips(self, axis):
        """{row: lowest tips} of the direction; calculated once."""
        if axis not in self.tops:
            field = self.np.ascontiguousarray(self.field(axis))
            rows = scan_rows(field.shape[0], self.set.step_over)
            self.tops[axis] = {}
            for n, row in enumerate(rows):
                self.tops[axis][row] = allowed(self.np, field, row, self.set.pixel_size, self.set.tool, self.set.tool_diameter / 2)
                self.progress((len(self.tops) - 1 + n / len(rows)) / len(self.passes()))
        return self.tops[axis]

    def steep(self, axis, row):
        """True where the field is steeper than the contact angle across the scan, within the tool's reach."""
        np, field = self.np, self.field(axis)
        limit = math.tan(math.radians(self.set.contact_angle)) * self.set.pixel_size
        around = field[max(row - self.set.step_over, 0):row + self.set.step_over + 1]
        if len(around) < 2:
            return np.zeros(field.shape[1], bool)
        return (np.abs(np.diff(around, axis=0)) > limit).any(axis=0)

    def bounded(self, axis, order, row, count):
        """Points of a scan that are milled, after lace bounding."""
        np, bounds = self.np, self.set.lace
        if len(self.passes()) < 2 or bounds == 'none' or (order == 0 and bounds != 'full'):
            return np.ones(count, bool)
        line = self.field(axis)[row]
        limit = math.tan(math.radians(self.set.contact_angle)) * self.set.pixel_size
        if order == 0:
            # Omits areas that are steep across the scan; the second direction mills them.
            wanted = ~self.steep(axis, row)
        else:
            band = self.field(axis)[max(row - self.set.step_over, 0):row + self.set.step_over + 1]
            climbs = (np.abs(np.diff(band, axis=1)) > limit).any(axis=0)
            wanted = np.zeros(len(line), bool)
            wanted[:-1] |= climbs
            wanted[1:] |= climbs
        places = np.repeat(wanted, PARTS)[:count]
        # The two directions overlap by the reach of the tool and one row.
        margin = math.ceil(self.set.tool_diameter / 2 / self.set.pixel_size) + self.set.step_over
        return widen(np, places, margin * PARTS)

    def cuts(self, order, axis, floor, raised):
        """[(row, [(position in units, z)])] of a pass in the order of milling. floor: lower limit; raised: distance above the
        surface."""
        direction, back = self.set.direction, False
        for row, tips in self.tips(axis).items():
            z = self.np.maximum(tips + raised, floor)
            points = [((n / PARTS - self.origin) * self.set.pixel_size, float(value)) for n, value in enumerate(z)]
            for piece in pieces(points, self.bounded(axis, order, row, len(points))):
                if direction in ('up', 'down'):
                    for run in runs_up(piece, direction == 'down'):
                        yield row, straight(run, self.set.tolerance / 2)
                else:
                    line = straight(piece, self.set.tolerance / 2)
                    yield row, line[::-1] if direction == 'negative' or back else line
            back = direction == 'alternating' and not back

    def over(self, axis, first, last, place):
        """Height at which the tool may move from one row to another, at a position along them."""
        field = self.field(axis)
        low, high = min(first, last), max(first, last)
        column = min(max(round(place / self.set.pixel_size + self.origin), 0), field.shape[1] - 1)
        reach = math.ceil(self.set.tool_diameter / 2 / self.set.pixel_size) + 1
        return float(field[max(low - reach, 0):high + reach + 1, max(column - reach, 0):column + reach + 1].max())
