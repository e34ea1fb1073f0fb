#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes a program: a wavy 3D surface cut in a raster of short lines. usage: make_surface.py > surface.ngc"""
import math

ROWS, COLUMNS, STEP_X, STEP_Y = 120, 440, 0.2, 0.5


def height(x, y):
    return 3 * math.sin(x / 9) * math.cos(y / 7) + 1.5 * math.exp(-((x - 44) ** 2 + (y - 30) ** 2) / 200) - 4.5


def main():
    print('; SPDX-License-Identifier: GPL-2.0-or-later')
    print(f'; A 3D surface, {ROWS} rows of {COLUMNS} lines of {STEP_X} mm (tools/make_surface.py); mill_mm.')
    print('G21 G17 G90 G64 P0.01\nT5 M6\nG43 H5\nS16000 M3\nG54 G0 X0 Y0\nG0 Z5\nG1 Z0 F600\nF6000')
    for row in range(ROWS):
        y = row * STEP_Y
        columns = range(COLUMNS + 1) if row % 2 == 0 else range(COLUMNS, -1, -1)
        for column in columns:
            x = column * STEP_X
            end_of_row = f'Y{y:g}' if column == columns[0] else ''
            print(f'G1X{x:.4g}{end_of_row}Z{height(x, y):.4f}')
    print('G0 Z20\nM5\nM2')


if __name__ == '__main__':
    main()
