# SPDX-License-Identifier: GPL-2.0-or-later
"""Lathe cycles for the program generator: a profile as a subroutine, and G70 to G72 over it."""
import math

LEAST_TURN = math.radians(25)


def profile_points(random):
    """Points along the cut (u) and away from the axis (h), without collinear or nearly collinear neighbours."""
    points = [(0.0, random.uniform(3, 8))]
    heading = None
    for _ in range(60):
        u, h = points[-1]
        du, dh = random.choice((0.0, 1.0, 1.0, 1.0)) * random.uniform(0.8, 6), random.choice((0.0, 1.0, 1.0)) * random.uniform(-3, 5)
        if (du == 0.0 and abs(dh) < 1.2) or h + dh < 0.5:
            continue
        direction = math.atan2(dh, du)
        isFirst = heading is None
        if isFirst and du == 0.0:
            continue
        if not isFirst and not LEAST_TURN < abs(direction - heading) < math.radians(150):
            continue
        points.append((u + du, h + dh))
        heading = direction
        if len(points) > random.randint(3, 7):
            break
    return points


def lathe_cycle(random, label):
    """The lines of a subroutine and of a cycle with it. G18, G90 and a feed must be active."""
    is_facing = random.random() < 0.4
    sign = random.choice((-1, -1, 1))
    is_final = random.random() < 0.3
    code = random.choice(('G70',) if is_final else ('', '', '.1', '.2'))
    code = code if is_final else ('G72' if is_facing else 'G71') + code
    points = profile_points(random)
    while len(points) < 3 or points[-1][1] <= points[0][1] + 0.1:
        points = profile_points(random)
    if points[1][1] < points[0][1]:  # ours cuts the falling part after the first point in layers
        code = code.removesuffix('.2')
    along, across = ('X', 'Z') if is_facing else ('Z', 'X')
    lines = [f'o{label} sub', f'G0 {across}{points[0][1]:.3f} {along}0']
    has_arcs = random.random() < 0.3
    for (u0, h0), (u, h) in zip(points, points[1:]):
        where = f'{along}{sign * u:.3f} {across}{h:.3f}'
        chord, code_and_radius = math.hypot(u - u0, h - h0), ''
        if has_arcs and u > u0 and abs(h - h0) > 0.5:
            radius = chord * random.uniform(1.2, 4)
            code_and_radius = f'{random.choice(("G2", "G3"))} {where} R{radius:.3f}'
            # LinuxCNC does not see a lowest point inside an arc.
            if abs(math.atan2(h - h0, u - u0)) < math.asin(chord / (2 * radius)) + 0.01:
                code_and_radius = ''
        if code_and_radius:
            lines.append(code_and_radius)
        else:
            lines.append(f'G1 {where}')
    lines.append(f'o{label} endsub')
    highest = max(h for _, h in points)
    start = f'{across}{highest + random.uniform(2, 6):.3f} {along}{-sign * random.uniform(0.5, 3):.3f}'
    lines.append(f'G0 {start}')
    cycle = f'{code} Q{label}'
    # With D, LinuxCNC moves by rapid into the material where the profile falls from its first point.
    is_distance_safe = not has_arcs and points[1][1] >= points[0][1]
    if random.random() < 0.3:
        cycle += f' {start}'
    if is_final:
        if is_distance_safe and not is_facing:
            cycle += f' D{random.uniform(0.2, 0.4):.2f} E{random.choice((0, 0.2))} P{random.randint(1, 3)}'
    else:
        if is_distance_safe and random.random() < 0.6:
            cycle += f' D{random.uniform(0.1, 0.4):.2f}'
        cycle += f' I{random.uniform(0.7, 3):.2f}'
        if random.random() < 0.6:
            cycle += f' R{random.uniform(0, 1):.2f}'
    return lines + [cycle, random.choice(('G0 X40', 'G1 Z20'))]
