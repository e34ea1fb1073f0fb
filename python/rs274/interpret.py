# SPDX-License-Identifier: GPL-2.0-or-later
"""Base classes for canon objects of gcode.parse.

    class MyCanon(StatMixin, ArcsToSegmentsMixin, Translated, PrintCanon): ...

Lengths are in inches and angles in degrees, as gcode.parse reports them.
"""
import math

import gcode

AXES = "xyzabcuvw"


class Translated:
    """Stores G5x, G92 and rotation, and passes straight moves in coordinates without these offsets to
    straight_traverse_translated(x .. w) and straight_feed_translated(x .. w)."""

    g92_offset_x = g92_offset_y = g92_offset_z = 0
    g92_offset_a = g92_offset_b = g92_offset_c = 0
    g92_offset_u = g92_offset_v = g92_offset_w = 0
    g5x_offset_x = g5x_offset_y = g5x_offset_z = 0
    g5x_offset_a = g5x_offset_b = g5x_offset_c = 0
    g5x_offset_u = g5x_offset_v = g5x_offset_w = 0
    g5x_index = 1
    rotation_xy = 0
    rotation_sin, rotation_cos = 0.0, 1.0

    def rotate_and_translate(self, x, y, z, a, b, c, u, v, w):
        """Converts program coordinates to coordinates without offsets: (x .. w)."""
        point = [value + getattr(self, "g92_offset_" + axis)
                 for axis, value in zip(AXES, (x, y, z, a, b, c, u, v, w))]
        if self.rotation_xy:
            point[0], point[1] = (point[0] * self.rotation_cos - point[1] * self.rotation_sin,
                                  point[0] * self.rotation_sin + point[1] * self.rotation_cos)
        return tuple(value + getattr(self, "g5x_offset_" + axis) for axis, value in zip(AXES, point))

    def straight_traverse(self, *args):
        self.straight_traverse_translated(*self.rotate_and_translate(*args))

    def straight_feed(self, *args):
        self.straight_feed_translated(*self.rotate_and_translate(*args))

    def set_g5x_offset(self, index, x, y, z, a, b, c, u=0, v=0, w=0):
        self.g5x_index = index
        for axis, value in zip(AXES, (x, y, z, a, b, c, u, v, w)):
            setattr(self, "g5x_offset_" + axis, value)

    def set_g92_offset(self, x, y, z, a, b, c, u=0, v=0, w=0):
        for axis, value in zip(AXES, (x, y, z, a, b, c, u, v, w)):
            setattr(self, "g92_offset_" + axis, value)

    def set_xy_rotation(self, theta):
        self.rotation_xy = theta
        self.rotation_sin = math.sin(math.radians(theta))
        self.rotation_cos = math.cos(math.radians(theta))


class ArcsToSegmentsMixin:
    """Passes arcs as chords to straight_arcsegments(list of end points with nine coordinates). Needs the offsets of Translated
    and the attribute lo: the end of the last move."""

    plane = 1
    arcdivision = 64

    def set_plane(self, plane):
        self.plane = plane

    def arc_feed(self, x1, y1, cx, cy, rot, z1, a, b, c, u, v, w):
        self.straight_arcsegments(gcode.arc_to_segments(self, x1, y1, cx, cy, rot, z1, a, b, c, u, v, w,
                                                        self.arcdivision))


class PrintCanon:
    """Prints the calls of a program, one per line."""

    def _print(self, name, args):
        print(name, " ".join("%.4g" % arg for arg in args))

    def set_g5x_offset(self, *args):
        print("set_g5x_offset", args)

    def set_g92_offset(self, *args):
        print("set_g92_offset", args)

    def set_xy_rotation(self, theta):
        print("set_xy_rotation", theta)

    def next_line(self, state):
        print("next_line", state.sequence_number)
        self.state = state

    def set_plane(self, plane):
        print("set plane", plane)

    def set_feed_rate(self, arg):
        print("set feed rate", arg)

    def comment(self, arg):
        print("#", arg)

    def message(self, arg):
        print("message", arg)

    def straight_traverse(self, *args):
        self._print("straight_traverse", args)

    def straight_feed(self, *args):
        self._print("straight_feed", args)

    def straight_probe(self, *args):
        self._print("straight_probe", args)

    def rigid_tap(self, *args):
        self._print("rigid_tap", args)

    def arc_feed(self, *args):
        self._print("arc_feed", args)

    def dwell(self, arg):
        if arg < .1:
            print("dwell %f ms" % (1000 * arg))
        else:
            print("dwell %f s" % arg)

    def tool_offset(self, *args):
        self._print("tool_offset", args)

    def change_tool(self, idx):
        print("change_tool", idx)

    def user_defined_function(self, number, p, q):
        print("user_defined_function M%d P%g Q%g" % (100 + number, p, q))


class StatMixin:
    """Answers queries of gcode.parse from a linuxcnc.stat object. `random`: the tool changer is random."""

    NO_TOOL = (-1,) + (0.0,) * 12 + (0,)

    def __init__(self, s, r):
        self.s = s
        self.tools = list(s.tool_table)
        self.random = r

    def change_tool(self, idx):
        if self.random:
            self.tools[0], self.tools[idx] = self.tools[idx], self.tools[0]
        elif idx == 0:
            self.tools[0] = self.NO_TOOL
        else:
            self.tools[0] = self.tools[idx]

    def get_tool(self, idx):
        return tuple(self.tools[idx]) if 0 <= idx < len(self.tools) else self.NO_TOOL

    def get_external_angular_units(self):
        return self.s.angular_units or 1.0

    def get_external_length_units(self):
        return self.s.linear_units or 1.0

    def get_axis_mask(self):
        return self.s.axis_mask

    def get_block_delete(self):
        return self.s.block_delete
