# SPDX-License-Identifier: GPL-2.0-or-later
"""Codes that a preview must run before a program, so that it starts in the state of the machine."""

# Positions in stat.gcodes of modes that stay active from one program to the next: plane, compensation (only off),
# distance, feed mode, coordinate system, tool length, retract, diameter, arc distance. Motion does not belong here.
_MODES = (3, 4, 6, 7, 8, 9, 10, 13, 14)
# Codes that need words, or that begin a cycle or a block.
_LEFT_OUT = {410, 411, 420, 421, 431, 432}
_METRIC_FROM = 0.5
_LETTERS = 'XYZABCUVW'
_INCREMENTAL = 910


def _word(code):
    """G90.1 from 901."""
    return "G%d" % (code // 10) if code % 10 == 0 else "G%d.%d" % (code // 10, code % 10)


def _place(stat):
    """The block that ends at the machine position; None if it is not known."""
    position = getattr(stat, "position", ())
    mask = getattr(stat, "axis_mask", 0)
    words = ["%s%.6f" % (letter, position[i]) for i, letter in enumerate(_LETTERS)
             if mask >> i & 1 and i < len(position)]
    return "G90 G53 G0 " + " ".join(words) if words else ""


def create_unitcode_and_initcode(stat, ini):
    """(unitcode, initcode) for gcode.parse: the machine units, then one block for each mode that is active on the machine
    (including those of [RS274NGC]RS274NGC_STARTUP_CODE), and the move to its position. `stat` is the current linuxcnc.stat.
    Before the machine has reported its modes, those of the start-up code are used."""
    if hasattr(stat, "poll"):
        stat.poll()
    unitcode = "G21" if stat.linear_units > _METRIC_FROM else "G20"
    gcodes = tuple(getattr(stat, "gcodes", ()) or ())
    codes = [gcodes[place] for place in _MODES if place < len(gcodes)]
    modes = [_word(code) for code in codes if code > 0 and code not in _LEFT_OUT]
    startup = ini.find("RS274NGC", "RS274NGC_STARTUP_CODE")
    lines = [" ".join(modes)] if modes else [startup] if startup else []
    place = _place(stat) if modes else ""
    if place:
        lines.append(place)
        if _INCREMENTAL in codes:
            lines.append("G91")
    return unitcode, "\n".join(lines)
