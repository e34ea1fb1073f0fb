# SPDX-License-Identifier: GPL-2.0-or-later
"""Canon calls for scripts, in program order. They do not change the interpreter's own position.
If later blocks depend on the moves, use self.execute() or synchronise after them."""
import enum as _enum

from _millwright_canon import *  # noqa: F401,F403


class _Number(_enum.IntEnum):
    def __str__(self):
        return self.name

    def __repr__(self):
        return f'emccanon.{type(self).__name__}.{self.name}'


CANON_AXIS = _Number('CANON_AXIS', [f'CANON_AXIS_{letter}' for letter in 'XYZABCUVW'])
CANON_DIRECTION = _Number('CANON_DIRECTION', 'CANON_STOPPED CANON_CLOCKWISE CANON_COUNTERCLOCKWISE')
CANON_FEED_REFERENCE = _Number('CANON_FEED_REFERENCE', 'CANON_WORKPIECE CANON_XYZ')
CANON_FEED_SPEED_MODE = _Number('CANON_FEED_SPEED_MODE', 'CANON_SYNCHED CANON_INDEPENDENT')
CANON_MOTION_MODE = _Number('CANON_MOTION_MODE', 'CANON_EXACT_STOP CANON_EXACT_PATH CANON_CONTINUOUS')
CANON_PLANE = _Number('CANON_PLANE', [f'CANON_PLANE_{axes}' for axes in ('XY', 'YZ', 'XZ', 'UV', 'VW', 'UW')])
CANON_SIDE = _Number('CANON_SIDE', 'CANON_SIDE_RIGHT CANON_SIDE_LEFT CANON_SIDE_OFF')
CANON_UNITS = _Number('CANON_UNITS', 'CANON_UNITS_INCHES CANON_UNITS_MM CANON_UNITS_CM')

for _group in (CANON_AXIS, CANON_DIRECTION, CANON_FEED_REFERENCE, CANON_FEED_SPEED_MODE, CANON_MOTION_MODE,
               CANON_PLANE, CANON_SIDE, CANON_UNITS):
    globals().update(_group.__members__)
