#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the output of the drawing functions of the Python module linuxcnc to OpenGL, here and in an installed LinuxCNC.

usage: compare_drawing.py [--modules DIR]

Each draws into the feedback buffer of a Mesa context without a window; the received lines are compared. Rotations are omitted:
docs/reference/compatibility.md describes the differences.
"""
import argparse
import ctypes
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FEEDBACK_3D_COLOR, RENDER, FEEDBACK, SELECT = 0x0602, 0x1C00, 0x1C01, 0x1C02
LINE_TOKEN, LINE_RESET_TOKEN = 0x0702, 0x0707
SIDE = 1000.0


def make_context():
    """An OpenGL context of EGL without a display; returns the library of OpenGL."""
    egl = ctypes.CDLL("libEGL.so.1", mode=ctypes.RTLD_GLOBAL)
    gl = ctypes.CDLL("libGL.so.1", mode=ctypes.RTLD_GLOBAL)
    for name in ("eglGetPlatformDisplay", "eglCreateContext", "eglCreatePbufferSurface"):
        getattr(egl, name).restype = ctypes.c_void_p
    surfaceless = 0x31DD
    display = ctypes.c_void_p(egl.eglGetPlatformDisplay(surfaceless, None, None))
    if not egl.eglInitialize(display, None, None) or not egl.eglBindAPI(0x30A2):
        sys.exit("error: EGL of Mesa is needed (Debian's libegl1, libgl1-mesa-dri)")
    config, count = ctypes.c_void_p(), ctypes.c_int()
    egl.eglChooseConfig(display, (ctypes.c_int * 5)(0x3040, 8, 0x3033, 1, 0x3038), ctypes.byref(config), 1,
                        ctypes.byref(count))
    context = ctypes.c_void_p(egl.eglCreateContext(display, config, None, None))
    surface = ctypes.c_void_p(
        egl.eglCreatePbufferSurface(display, config, (ctypes.c_int * 5)(0x3057, 64, 0x3056, 64, 0x3038)))
    if not egl.eglMakeCurrent(display, surface, surface, context):
        sys.exit("error: no OpenGL context can be made")
    gl.glOrtho.argtypes = [ctypes.c_double] * 6
    gl.glViewport(0, 0, int(2 * SIDE), int(2 * SIDE))
    gl.glOrtho(-SIDE, SIDE, -SIDE, SIDE, -SIDE, SIDE)
    return gl


def lines_of(gl, draw):
    """{line as text}: received lines, in any order and number."""
    buffer = (ctypes.c_float * 200000)()
    gl.glFeedbackBuffer(len(buffer), FEEDBACK_3D_COLOR, buffer)
    gl.glColor4f(*[ctypes.c_float(1)] * 4)
    gl.glRenderMode(FEEDBACK)
    draw()
    count, at, lines = gl.glRenderMode(RENDER), 0, set()
    while at < count:
        if int(buffer[at]) not in (LINE_TOKEN, LINE_RESET_TOKEN):
            raise ValueError("not a line: %g" % buffer[at])
        ends = []
        for first in (at + 1, at + 8):
            x, y, z = buffer[first] - SIDE, buffer[first + 1] - SIDE, SIDE - 2 * SIDE * buffer[first + 2]
            ends.append("%.2f %.2f %.2f" % (x + 0.0, y + 0.0, z + 0.0) +
                        " %.2f %.2f %.2f %.2f" % tuple(buffer[first + 3:first + 7]))
        lines.add(" - ".join(sorted(ends)).replace("-0.00", "0.00"))
        at += 15
    return sorted(lines)


def names_of(gl, draw):
    """The names under which something was drawn."""
    buffer = (ctypes.c_uint * 20000)()
    gl.glSelectBuffer(len(buffer), buffer)
    gl.glRenderMode(SELECT)
    gl.glInitNames()
    gl.glPushName(0)
    draw()
    count, at, names = gl.glRenderMode(RENDER), 0, []
    for _ in range(count):
        names.append(list(buffer[at + 3:at + 3 + buffer[at]]))
        at += 3 + buffer[at]
    return names


def pose(*values):
    return tuple(map(float, values)) + (0.0,) * (9 - len(values))


def cases(gl, lc):
    import math
    path = [pose(40 * math.cos(i / 7), 40 * math.sin(i / 7), i / 3, 0, 0, 0, i / 9, -i / 5, 2) for i in range(200)]
    moves = [(i // 3, path[i], path[i + 1], 1.0, (0, 0, 0)) for i in range(199) if i % 50 != 7]
    dwells = [(i, (0.1, 0.2, 0.3), 10.0 * i, 20.0, -5.0, i % 3) for i in range(9)]

    def line9():
        gl.glBegin(1)
        lc.line9("XYZ-U", path[3], path[4])
        gl.glEnd()

    for geometry in ("XYZ", "-X Y-Z", "ZYX", "XYZUVW", "UV"):
        yield "draw_lines " + geometry, lines_of(gl, lambda g=geometry: lc.draw_lines(g, moves))
    yield "draw_lines, none", lines_of(gl, lambda: lc.draw_lines("XYZ", []))
    yield "draw_lines, names", names_of(gl, lambda: lc.draw_lines("XYZ", moves, 1))
    for lathe in (0, 1):
        yield "draw_dwells %d" % lathe, lines_of(gl, lambda w=lathe: lc.draw_dwells("XYZ", dwells, 0.5, 0, w))
    yield "draw_dwells, names", names_of(gl, lambda: lc.draw_dwells("XYZ", dwells, 0.5, 1, 0))
    yield "line9", lines_of(gl, line9)


def main():
    if sys.argv[1:] == ["--inside"]:
        import linuxcnc
        print(json.dumps(list(cases(make_context(), linuxcnc))))
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--modules", default=str(ROOT / "build/release/lib/python"))
    options = parser.parse_args()
    found = []
    for modules in (options.modules, ""):
        env = dict(os.environ, PYTHONPATH=modules)
        done = subprocess.run([sys.executable, __file__, "--inside"], env=env, stdout=subprocess.PIPE, check=True)
        found.append(json.loads(done.stdout))
    different = 0
    for (name, ours), (_, theirs) in zip(*found):
        isSame = ours == theirs
        different += not isSame
        print("%-22s %4d %s" % (name, len(ours), "the same" if isSame else "DIFFERENT, %d there" % len(theirs)))
    sys.exit(1 if different else 0)


if __name__ == "__main__":
    main()
