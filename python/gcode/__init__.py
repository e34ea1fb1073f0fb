# SPDX-License-Identifier: GPL-2.0-or-later
"""What a G-code program would do, for previews.

    import gcode
    result, line = gcode.parse("part.ngc", canon, "G21", "G54")
    if result > gcode.MIN_ERROR:
        print("line %d: %s" % (line, gcode.strerror(result)))

`canon` is an object with methods that are called in program order. Lengths are in inches whatever the program says,
in program coordinates: before G92, the rotation, the G5x and the tool offset, each of which has a call of its own.
Angles are in degrees.

    next_line(linecode)                           before the first call of each line; codes in force before it
    straight_traverse(x, y, z, a, b, c, u, v, w)  straight_feed, straight_probe: the same
    arc_feed(first_end, second_end, first_centre, second_centre, rotation, axis_end, a, b, c, u, v, w)
    rigid_tap(x, y, z)    dwell(seconds)    set_feed_rate(inches per minute)    change_tool(index in the tool table)
    set_plane(1 XY, 2 YZ, 3 XZ, 4 UV, 5 VW, 6 UW)    set_g5x_offset(index, x .. w)    set_g92_offset(x .. w)
    set_xy_rotation(degrees)    tool_offset(x .. w)    comment(text)    message(text)
    user_defined_function(M code - 100, p, q)

and, where there are such attributes, it is asked: get_tool(index) -> (number, nine offsets, diameter, front angle,
back angle, orientation), number -1 for none, in machine units; get_external_length_units() (1 for millimetres),
get_axis_mask(), get_block_delete(), check_abort() (true ends parse with KeyboardInterrupt) and parameter_file, which
is read and never written. With `use_move_batches` true and a method move_batch, straight moves come as lists of
tuples (0 traverse or 1 feed, line, x, y, z, a, b, c, u, v, w). The environment's INI_FILE_NAME gives subroutine
paths, remaps and #<_ini[]>.
"""
from ._core import MAX_ERROR, MIN_ERROR, arc_to_segments, calc_extents, linecode, strerror
from . import _core


def parse(file, canon, unitcode="", initcode="", interpname=""):
    """parse(file, canon, unitcode="", initcode="", interpname="") -> (result, line)

    Runs `unitcode` and `initcode`, then the file. `line` is the last line, or the line of the error. Exceptions of the canon's
    methods are passed on. RuntimeError: the file or a file that it needs cannot be read.
    """
    return _core.parse(file, canon, unitcode, initcode, interpname)


__all__ = ["MAX_ERROR", "MIN_ERROR", "arc_to_segments", "calc_extents", "linecode", "parse", "strerror"]
