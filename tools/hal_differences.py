# SPDX-License-Identifier: GPL-2.0-or-later
"""Differences from LinuxCNC's components that are intended, for compare_hal.py.

Each entry names the pins that may differ and the row of docs/compatibility.md that explains it. `avoid` has inputs or
parameters with which the difference does not occur: most files use them, and then the entry does not count.
"""
import dataclasses
import re


@dataclasses.dataclass(frozen=True)
class Difference:
    component: str  # regular expression over the module's name
    pins: str       # regular expression over the outputs, without the prefix
    row: str        # beginning of the row in docs/compatibility.md, without '| '
    avoid: dict = dataclasses.field(default_factory=dict, hash=False, compare=False)

    def covers(self, pin):
        return re.fullmatch(self.pins, pin) is not None


DIFFERENCES = []


def rows_without_page(page):
    """The rows that docs/compatibility.md does not have."""
    return sorted({d.row for d in DIFFERENCES if not re.search(r'^\| ' + re.escape(d.row), page, re.M)})


def of_component(name):
    return [d for d in DIFFERENCES if re.fullmatch(d.component, name)]
