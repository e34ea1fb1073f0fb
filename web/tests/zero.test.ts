// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import type { Offsets } from '../src/lib/status';
import { canRestore, goLine, isIncremental, restoreLine, zeroLine, zeroSet } from '../src/lib/zero';

const at = (g5x: number[], g5x_index = 2): Offsets => ({ g5x_index, g5x: [...g5x, 0, 0, 0, 0, 0, 0], g92: [], tool: [], rotation_xy_deg: 0 });
const same = (value: number): number => value;

describe('a work zero', () => {
  it('is one line for the active coordinate system', () => {
    expect(zeroLine(['Z'])).toBe('G10 L20 P0 Z0');
    expect(zeroLine(['X', 'Y'])).toBe('G10 L20 P0 X0 Y0');
  });
  it('remembers what it replaced', () => {
    expect(zeroSet(['X'], at([1, 2, 3]), at([9, 2, 3]))).toMatchObject({ system: 2, letters: ['X'], before: [1, 2, 3, 0, 0, 0, 0, 0, 0] });
  });
  it('that changes nothing, or came with another coordinate system, is not undone', () => {
    expect(zeroSet(['X'], at([1, 2, 3]), at([1, 2, 3]))).toBeNull();
    expect(zeroSet(['X'], at([1, 2, 3]), at([9, 2, 3], 3))).toBeNull();
  });
  it('is restored with all axes: in a rotated system X changes Y, too', () => {
    const zero = zeroSet(['X'], at([1.123456789, -2, 0]), at([4, 5, 0]));
    if (zero === null) {
      throw new Error('no zero');
    }
    expect(restoreLine(zero, ['X', 'Y', 'Z'], same)).toBe('G10 L2 P2 X1.123456789 Y-2.000000000 Z0.000000000');
    expect(restoreLine(zero, ['X'], (value) => value / 25.4)).toBe('G10 L2 P2 X0.044230582');
  });
  it('is restored only while nothing else has changed the offsets', () => {
    const zero = zeroSet(['X'], at([1, 2, 3]), at([9, 2, 3]));
    if (zero === null) {
      throw new Error('no zero');
    }
    expect(canRestore(zero, at([9, 2, 3]))).toBe(true);
    expect(canRestore(zero, at([9, 2, 3.1]))).toBe(false);
    expect(canRestore(zero, at([9, 2, 3], 1))).toBe(false);
  });
});

describe('a move to zero', () => {
  it('is one rapid of its axes', () => expect(goLine(['X', 'Y'])).toBe('G0 X0 Y0'));
  it('would be none under G91', () => {
    expect(isIncremental({ g: [0, 800, 910], m: [], settings: [] })).toBe(true);
    expect(isIncremental({ g: [0, 800, 900, 911], m: [], settings: [] })).toBe(false);
  });
});
