# SPDX-License-Identifier: GPL-2.0-or-later
"""What a preview has to run before a program, so that it begins as the machine would."""

# Places in stat.gcodes of modes that stay in force from one program to the next: plane, distance, feed mode,
# coordinate system, retract, diameter, arc distance. Motion, compensation and tool offsets do not belong here.
_MODES = (3, 6, 7, 8, 10, 13, 14)
_METRIC_FROM = 0.5


def _word(code):
    """G90.1 from 901."""
    return "G%d" % (code // 10) if code % 10 == 0 else "G%d.%d" % (code // 10, code % 10)


def create_unitcode_and_initcode(stat, ini):
    """(unitcode, initcode) for gcode.parse: the units of the machine, then [RS274NGC]RS274NGC_STARTUP_CODE and the
    modes that are in force on the machine (`stat` as linuxcnc.stat gives them), a line each."""
    unitcode = "G21" if stat.linear_units > _METRIC_FROM else "G20"
    lines = []
    startup = ini.find("RS274NGC", "RS274NGC_STARTUP_CODE")
    if startup:
        lines.append(startup)
    gcodes = tuple(getattr(stat, "gcodes", ()) or ())
    modes = [_word(gcodes[place]) for place in _MODES if place < len(gcodes) and gcodes[place] > 0]
    if modes:
        lines.append(" ".join(modes))
    return unitcode, "\n".join(lines)
