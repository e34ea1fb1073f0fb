// SPDX-License-Identifier: GPL-2.0-or-later
// Tests colours of a path, the position of a pose in the picture, and the tips of lathe tools (J1, J3).
import { expect, it } from 'vitest';
import type { Moves } from '../src/lib/path/chunks';
import { isPlain, placer } from '../src/lib/path/geometry';
import { byNumber, gradient, Ranges, shade } from '../src/lib/path/shades';
import { tipOutline } from '../src/lib/path/tool';

function points(count: number): Moves {
  return { kind: 'moves', count, places: new Float32Array(count * 3), lines: new Uint32Array(count), kinds: new Uint8Array(count).fill(1), shades: new Uint8Array(count) };
}

it('colours each point by the range it lies in, from chunk to chunk', () => {
  const ranges = new Ranges();
  for (const [first, value] of [[0, 100], [5, 300], [7, 300], [12, 200]] as const) {
    ranges.add(first, value);
  }
  expect(ranges.count).toBe(3); // 300 continues at 7
  expect(ranges.extent()).toEqual({ low: 100, high: 300 });
  const [one, two] = [points(9), points(9)];
  shade(one, 0, ranges, gradient(ranges.extent()));
  shade(two, 8, ranges, gradient(ranges.extent()));
  expect([...one.shades]).toEqual([0, 0, 0, 0, 0, 255, 255, 255, 255]);
  expect([...two.shades]).toEqual([255, 255, 255, 255, 128, 128, 128, 128, 128]);
});

it('keeps thousands of ranges, and finds each', () => {
  const ranges = new Ranges();
  for (let i = 0; i < 5000; ++i) {
    ranges.add(i * 3, i + 1);
  }
  for (const point of [0, 1, 2, 3, 299, 300, 14_999]) {
    expect(ranges.value(ranges.rangeOf(point))).toBe(Math.floor(point / 3) + 1);
  }
});

it('gives each tool a separate colour, in their order', () => {
  const ranges = new Ranges();
  ranges.add(0, 0);
  ranges.add(3, 12);
  ranges.add(6, 5);
  const numbers = ranges.distinct(256);
  expect(numbers).toEqual([0, 5, 12]);
  const some = points(8);
  shade(some, 0, ranges, byNumber(numbers));
  expect([...some.shades]).toEqual([0, 0, 0, 2, 2, 2, 1, 1]);
});

it('a single feed is a scale without length', () => {
  expect(gradient({ low: 10, high: 10 })(10)).toBe(255);
  expect(gradient(null)(0)).toBe(255);
});

it('places a pose as the server does: from the last letter to the first', () => {
  const pose = [10, 2, 3, 90];
  const near = (geometry: string, wanted: number[]): void => placer(geometry, 'XYZA')(pose).forEach((one, i) => expect(one).toBeCloseTo(wanted[i] ?? NaN, 9));
  near('XYZABCUVW', [10, 2, 3]);
  near('AXYZ', [10, -3, 2]);
  near('-AXYZ', [10, 3, -2]);
  near('XAYZ', [10, -3, 2]);
  near('ZAXY', [10, 0, 5]);
  near('-XYZ', [-10, 2, 3]);
  near('!AXYZ', [10, -3, 2]);
  expect(isPlain('XYZABCUVW', 'XYZA')).toBe(true);
  expect(isPlain('AXYZ', 'XYZA')).toBe(false);
  expect(isPlain('AXYZ', 'XYZ')).toBe(true);
  expect(isPlain('XYZUVW', 'XYZU')).toBe(false);
});

it('a lathe tool touches its controlled point from the side that its orientation says', () => {
  const sides: Record<number, [number, number]> = { 1: [1, -1], 2: [-1, -1], 3: [-1, 1], 4: [1, 1], 5: [1, 0], 6: [0, -1], 7: [-1, 0], 8: [0, 1] };
  for (const [orientation, [z, x]] of Object.entries(sides)) {
    const outline = tipOutline({ orientation: Number(orientation), diameter: 2, frontangle_deg: 0, backangle_deg: 0 }, 10);
    const extreme = (index: 0 | 1, sign: number): number => Math.max(...outline.map((point) => point[index] * sign));
    // On its cutting sides no part of the tool exceeds its point; the body extends away from them.
    if (z !== 0) {
      expect(extreme(0, z)).toBeCloseTo(0, 6);
      expect(extreme(0, -z)).toBeGreaterThan(5);
    }
    if (x !== 0) {
      expect(extreme(1, x)).toBeCloseTo(0, 6);
      expect(extreme(1, -x)).toBeGreaterThan(5);
    }
  }
});

it('angles of edges count from Z+ towards X+: tools as tables of lathes have them lie behind their points', () => {
  const some = [[95, 155, 1], [85, 25, 2], [275, 335, 3], [265, 205, 4], [210, 150, 5], [120, 60, 6], [-30, 30, 7], [240, 300, 8]] as const;
  for (const [frontangle_deg, backangle_deg, orientation] of some) {
    const tip = { orientation, diameter: 0.1, frontangle_deg, backangle_deg };
    const own = tipOutline(tip, 10);
    const without = tipOutline({ ...tip, frontangle_deg: 0, backangle_deg: 0 }, 10);
    const centre = (outline: typeof own): [number, number] => [outline.reduce((sum, one) => sum + one[0], 0), outline.reduce((sum, one) => sum + one[1], 0)];
    const [a, b] = [centre(own), centre(without)];
    const along = (a[0] * b[0] + a[1] * b[1]) / (Math.hypot(...a) * Math.hypot(...b));
    expect(along, `orientation ${orientation}`).toBeGreaterThan(0.95);
  }
});

it('a round tool is its nose, and edges have the angles of the tool table', () => {
  const round = tipOutline({ orientation: 9, diameter: 6, frontangle_deg: 0, backangle_deg: 0 }, 10);
  round.forEach(([z, x]) => expect(Math.hypot(z, x)).toBeCloseTo(3, 6));
  const edged = tipOutline({ orientation: 2, diameter: 0.8, frontangle_deg: 85, backangle_deg: 10 }, 10);
  const slopes = edged.map((one, i) => {
    const next = edged[(i + 1) % edged.length] ?? one;
    return { long: Math.hypot(next[0] - one[0], next[1] - one[1]), degrees: (Math.atan2(next[1] - one[1], next[0] - one[0]) * 180) / Math.PI };
  });
  const edges = slopes.filter((one) => Math.abs(one.long - 10) < 0.5).map((one) => (Math.round(one.degrees) + 180) % 180);
  expect(edges.sort((a, b) => a - b)).toEqual([10, 85]);
});
