#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Judges a trajectory without code of the planner: python3 tools/trajcheck.py GEOMETRY.json TRACE.csv

GEOMETRY: the programmed path, as `traj_programs` writes it: start, moves (lines; arcs by centre, normal and angle), the tolerance
P (0: exact path) and the limits of each coordinate. Lengths in mm, angles in degrees, seconds.
TRACE: a line `# period_s=0.001 ...`, then one row per servo cycle: X,Y,Z,A,B,C,U,V,W.

Reported: the maximum speed, acceleration and jerk of each coordinate divided by its limit, from differences of the samples; the
deviation, which is the Frechet distance between the executed and the programmed path (both followed from start to end, never
back; Alt and Godau 1995, "Computing the Frechet distance between two polygonal curves"), the larger of lengths (X Y Z U V W) and
degrees (A B C); the cycle time; whether the end is reached exactly.
Exit status: 0 within all limits, 1 outside a limit, 2 cannot be read.
"""
import argparse
import json
import math
import sys

import numpy as np

LINEAR, ANGULAR = [0, 1, 2, 6, 7, 8], [3, 4, 5]
EXACT_TOLERANCE = 1e-6  # tolerance for "exact path" [mm, degrees]
CHORD_ERROR_SHARE = 0.002  # the deviation of chords from arcs as a fraction of the tolerance
RELATIVE = 1e-6


def read_trace(path):
    """(period in seconds, rows)"""
    with open(path, encoding="ascii") as file:
        head = file.readline()
        words = dict(word.split("=", 1) for word in head.lstrip("#").split() if "=" in word)
        rows = np.loadtxt(file, delimiter=",", ndmin=2, comments="#")
    if not head.startswith("#") or "period_s" not in words:
        raise ValueError(f"{path}:1: the first line must be '# period_s=...'")
    if rows.shape[1] != 9:
        raise ValueError(f"{path}:2: {rows.shape[1]} columns instead of X,Y,Z,A,B,C,U,V,W")
    return float(words["period_s"]), rows


def read_geometry(path):
    with open(path, encoding="utf-8") as file:
        geometry = json.load(file)
    for name in ("start", "moves", "tolerance", "max_velocity", "max_acceleration"):
        if name not in geometry:
            raise ValueError(f"{path}: '{name}' is missing")
    return geometry


def arc_points(start, move, chord_error):
    """Points of an arc or helix after its start; radius and everything outside its plane change evenly."""
    end, centre, normal = (np.array(move[name], float) for name in ("end", "centre", "normal"))
    space = slice(0, 3) if np.any(normal[:3]) else slice(6, 9)
    axis = normal[space] / np.linalg.norm(normal[space])
    out = start[space] - centre[space]
    out -= axis * np.dot(axis, out)
    last = end[space] - centre[space]
    last -= axis * np.dot(axis, last)
    radius, last_radius = np.linalg.norm(out), np.linalg.norm(last)
    first_direction, side = out / radius, np.cross(axis, out / radius)
    angle = move["angle_rad"]
    step = 2 * math.acos(max(0.5, 1 - chord_error / max(radius, last_radius)))
    count = max(2, math.ceil(abs(angle) / step))
    part = np.arange(1, count + 1)[:, None] / count
    points = start + (end - start) * part
    along = (start[space] - centre[space]) @ axis + part * (((end - start)[space]) @ axis)
    reach = radius + (last_radius - radius) * part
    turned = np.cos(angle * part) * first_direction + np.sin(angle * part) * side
    points[:, space] = centre[space] + along * axis + reach * turned
    points[-1] = end
    return points


def programmed_path(geometry, chord_error):
    """Corners of the path, arcs as chords."""
    start = np.array(geometry["start"], float)
    parts, at = [start[None, :]], start
    for move in geometry["moves"]:
        end = np.array(move["end"], float)
        parts.append(arc_points(at, move, chord_error) if "centre" in move else end[None, :])
        at = end
    return without_repeats(np.concatenate(parts))


def without_repeats(points):
    keep = np.ones(len(points), bool)
    keep[1:] = np.any(points[1:] != points[:-1], axis=1)
    return points[keep]


class Chain:
    """A polyline over the coordinates that move, with the values for the intervals."""

    def __init__(self, points, used):
        self.groups = []
        for group in (LINEAR, ANGULAR):
            columns = [i for i in group if i in used]
            if columns:
                at = points[:, columns]
                step = np.diff(at, axis=0)
                self.groups.append((at.tolist(), step.tolist(), np.sum(step * step, axis=1).tolist()))
        self.count = len(points)

    def near(self, segment, groups_of_point, reach_squared):
        """The part [low, high] of a segment within reach of a point, or None."""
        low, high = 0.0, 1.0
        for (at, step, square), point in zip(self.groups, groups_of_point):
            across, along = 0.0, 0.0
            for a, d, p in zip(at[segment], step[segment], point):
                w = p - a
                across += w * w
                along += w * d
            length_squared = square[segment]
            if length_squared == 0.0:
                if across > reach_squared:
                    return None
                continue
            root = along * along - length_squared * (across - reach_squared)
            if root < 0.0:
                return None
            root = math.sqrt(root)
            low = max(low, (along - root) / length_squared)
            high = min(high, (along + root) / length_squared)
        return (low, high) if low <= high else None

    def point(self, i):
        return [at[i] for at, _, _ in self.groups]


def is_within(driven, path, reach):
    """True if the two polylines can be followed in order, at most `reach` apart: the free space of Alt and Godau."""
    square = reach * reach
    def apart(i, j):
        return max(sum((a - b) ** 2 for a, b in zip(p, q)) for p, q in zip(driven.point(i), path.point(j)))

    if apart(0, 0) > square or apart(driven.count - 1, path.count - 1) > square:
        return False
    # Reachable parts of the path's segments at the driven chain's point i, by segment.
    left = {}
    for j in range(path.count - 1):
        free = path.near(j, driven.point(0), square)
        if free is None or free[0] > 0.0:
            break
        left[j] = free
        if free[1] < 1.0:
            break
    for i in range(driven.count - 1):
        following, bottom = {}, None
        if not left:
            return False
        point = driven.point(i + 1)
        j = min(left)
        highest = max(left)
        while j < path.count - 1 and (j <= highest or bottom is not None):
            entry = left.get(j)
            if entry is not None or bottom is not None:
                free = path.near(j, point, square)
                if free is not None and bottom is None:
                    free = (max(free[0], entry[0]), free[1])
                if free is not None and free[0] <= free[1]:
                    following[j] = free
                above = driven.near(i, path.point(j + 1), square)
                if above is not None and entry is None:
                    above = (max(above[0], bottom[0]), above[1])
                bottom = above if above is not None and above[0] <= above[1] else None
            j += 1
        left = following
    last = left.get(path.count - 2)
    return last is not None and last[1] >= 1.0 - 1e-12


def deviation(samples, points, highest, resolution):
    """The Frechet distance to within `resolution`; None if it exceeds `highest`."""
    used = set(np.flatnonzero(np.any(samples != samples[0], axis=0) | np.any(points != points[0], axis=0) |
                              (samples[0] != points[0])).tolist())
    if not used:
        return 0.0
    driven, path = Chain(samples, used), Chain(points, used)
    if driven.count < 2 or path.count < 2:
        return None
    if not is_within(driven, path, highest):
        return None
    low, high = 0.0, highest
    while high - low > resolution:
        middle = 0.5 * (low + high)
        if is_within(driven, path, middle):
            high = middle
        else:
            low = middle
    return high


def worst_over_limits(rows, period, geometry, rounding, with_jerk):
    """{kind: (largest ratio, coordinate, sample)}; `rounding`: of a printed position, otherwise of the double."""
    largest = np.maximum.accumulate(np.abs(rows), axis=0) if rounding == 0.0 else None
    unit = np.spacing(largest) if rounding == 0.0 else np.full(rows.shape, rounding)
    out, difference = {}, rows
    kinds = [("velocity", 1), ("acceleration", 2)] + ([("jerk", 3)] if with_jerk else [])
    for kind, order in kinds:
        difference = np.diff(difference, axis=0)
        limit = np.array(geometry["max_" + kind], float)
        if len(difference) == 0:
            out[kind] = (0.0, 0, 0)
            continue
        allowed = 2.0 ** order * unit[order:] / period ** order
        ratio = (np.abs(difference) / period ** order - allowed) / limit
        place = np.unravel_index(np.argmax(ratio), ratio.shape)
        out[kind] = (max(0.0, float(ratio[place])), int(place[1]), int(place[0]) + order)
    return out


def cycle_time_s(rows, period):
    moving = np.flatnonzero(np.any(np.diff(rows, axis=0) != 0.0, axis=1))
    return float((moving[-1] - moving[0] + 1) * period) if len(moving) else 0.0


def judge(geometry, period, rows, rounding=0.0, with_jerk=False):
    """All figures of one trace, as a dictionary; "ok" if no limit is exceeded."""
    tolerance = max(float(geometry["tolerance"]), EXACT_TOLERANCE)
    # Between samples the path deviates by at most a T^2/8 from the chord; this does not count as a deviation.
    bend = math.sqrt(3) * max(geometry["max_acceleration"][:3]) * period ** 2 / 8 + rounding
    points = programmed_path(geometry, max(tolerance, 1e-4) * CHORD_ERROR_SHARE)
    slack = max(tolerance, 1e-4) * CHORD_ERROR_SHARE + bend
    highest = max(10 * tolerance, 0.1) + slack
    found = deviation(without_repeats(rows), points, highest, 0.01 * tolerance + 0.01 * slack)
    limits = worst_over_limits(rows, period, geometry, rounding, with_jerk)
    end = np.max(np.abs(rows[-1] - np.array(geometry["moves"][-1]["end"], float)))
    verdict = {
        "cycle_time_s": cycle_time_s(rows, period), "deviation": found, "deviation_slack": slack,
        "tolerance": tolerance, "isDeviationOk": found is not None and found <= tolerance + slack * 1.02 + 0.01 * tolerance,
        "isEndExact": bool(end <= rounding), "worst": limits,
        "isWithinLimits": all(ratio <= 1 + RELATIVE for ratio, _, _ in limits.values())}
    verdict["ok"] = verdict["isDeviationOk"] and verdict["isEndExact"] and verdict["isWithinLimits"]
    return verdict


def describe(verdict):
    found = verdict["deviation"]
    text = "more than 10 P and 0.1" if found is None else f"{found:.5f}"
    lines = [f"cycle time    {verdict['cycle_time_s']:.3f} s",
             f"deviation     {text} of {verdict['tolerance']:g} (in order, both ways; {verdict['deviation_slack']:.6f} of it"
             " may be bend between samples)",
             f"end           {'exact' if verdict['isEndExact'] else 'NOT reached exactly'}"]
    for kind, (ratio, axis, sample) in verdict["worst"].items():
        lines.append(f"{kind:13} {ratio:.6f} of the limit, {'XYZABCUVW'[axis]} at sample {sample}")
    lines.append("within" if verdict["ok"] else "BEYOND")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("geometry")
    parser.add_argument("trace")
    parser.add_argument("--jerk", action="store_true", help="jerk counts too")
    parser.add_argument("--rounding", type=float, default=0.0, help="of the trace's printed positions [mm, degrees]")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    try:
        geometry = read_geometry(options.geometry)
        period, rows = read_trace(options.trace)
    except (OSError, ValueError) as error:
        print(f"trajcheck: {error}", file=sys.stderr)
        return 2
    verdict = judge(geometry, period, rows, options.rounding, options.jerk)
    print(json.dumps(verdict) if options.json else describe(verdict))
    return 0 if verdict["ok"] else 1


if __name__ == "__main__":
    sys.exit(main())
