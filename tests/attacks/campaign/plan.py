# SPDX-License-Identifier: GPL-2.0-or-later
"""The plan of a seed: a program, one to four attacks and their times, an abort by one of four clients."""
import dataclasses
import random

import attacks_files  # noqa: F401  pylint: disable=unused-import  # enter their attacks into the table
import attacks_network  # noqa: F401  pylint: disable=unused-import
import attacks_processes  # noqa: F401  pylint: disable=unused-import
import attacks_programs  # noqa: F401  pylint: disable=unused-import
from attack_types import TABLE

COUNTS = (1,) * 9 + (2,) * 6 + (3,) * 3 + (4,) * 2
WAIT = 'M66 P0 L0\n'  # the next lines are read when the axes have arrived
LATEST_ATTACK_S = 0.5
ATTACKS_END_S = 1.0  # after the start of the movement


@dataclasses.dataclass(frozen=True)
class Plan:
    seed: int
    corners: tuple     # of the closed path
    blend: str         # G61, or G64 with its tolerance
    feed: int          # mm/min
    attacks: tuple     # (name, seconds after the start, separate seed)
    abort: tuple       # (client, seconds after the begin)
    offset: float      # written to G59 and to the diameter of T5

    def program(self, lines):
        """`lines`: the lines of the attacks in the program, after the first edge."""
        # The dwell: the spindle is at speed before the axes move.
        text = f'G21 G90 G17 {self.blend} F{self.feed}\nG10 L2 P6 X{self.offset}\nG10 L1 P5 R{self.offset}\nM3 S500\nM8\nG4 P0.3\n'
        moves = ['G1 X%.3f Y%.3f Z%.3f\n' % corner for corner in self.corners]
        return f'{text}G0{moves[0][2:]}{moves[1]}{WAIT if lines else ""}{lines}o1 repeat [300]\n{"".join(moves[2:] + moves[:2])}o1 endrepeat\nM2\n'


def make(seed):
    rng = random.Random(f'attacks {seed}')
    corners = tuple((round(rng.uniform(0, 20), 3), round(rng.uniform(0, 20), 3), round(rng.uniform(-10, 0), 3)) for _ in range(rng.randrange(3, 7)))
    names, weights = list(TABLE), [one.weight for one in TABLE.values()]
    chosen = []
    count = rng.choice(COUNTS)
    while len(chosen) < count:
        name = rng.choices(names, weights)[0]
        one = TABLE[name]
        if any(name == other.name or (one.isEnd and other.isEnd) or (one.isProgram and other.isProgram) or
               (one.isHere and other.isHere) for other in chosen):
            continue
        chosen.append(one)
    attacks = tuple((one.name, round(rng.uniform(0, LATEST_ATTACK_S), 3), rng.randrange(1 << 40)) for one in chosen)
    busy = {server for one in chosen for server in one.busy}
    client = rng.choice([client for client in ('python', 'web', 'rsh', 'nml') if client not in busy])
    return Plan(seed, corners, rng.choice(('G61', 'G64 P0.01')), rng.choice((300, 900, 1800)), attacks, (client, round(rng.uniform(0.15, 0.9), 3)),
                round(rng.uniform(0.1, 9), 3))
