// SPDX-License-Identifier: GPL-2.0-or-later
import { expect, it } from 'vitest';
import type { Moves } from '../src/lib/path/chunks';
import { sparse } from '../src/lib/path/sparse';

/** Several times around a square of 100 by 100, `turns` times. */
function square(turns: number): Moves {
  const points: number[][] = [];
  for (let i = 0; i < turns; ++i) {
    for (let step = 0; step < 400; ++step) {
      const [side, at] = [Math.floor(step / 100), step % 100];
      points.push([[at, 0], [100, at], [100 - at, 100], [0, 100 - at]][side] as number[]);
    }
  }
  return {
    kind: 'moves',
    count: points.length,
    places: new Float32Array(points.flatMap(([x, y]) => [x ?? 0, y ?? 0, 0])),
    lines: new Uint32Array(points.length),
    kinds: new Uint8Array(points.length).fill(1),
    shades: new Uint8Array(points.length),
  };
}

it('draws a place once, however often the path passes it, and leaves no side out', () => {
  const once = sparse(square(1), 2, new Set());
  const often = sparse(square(50), 2, new Set());
  expect(often.count).toBeLessThanOrEqual(once.count + 4);
  const sides = new Set<string>();
  for (let i = 0; i < often.count; ++i) {
    const [x, y] = [often.places[i * 3] ?? 0, often.places[i * 3 + 1] ?? 0];
    sides.add(x === 0 ? 'left' : x === 100 ? 'right' : y === 0 ? 'front' : 'back');
  }
  expect([...sides].sort()).toEqual(['back', 'front', 'left', 'right']);
});

it('continues from chunk to chunk', () => {
  const seen = new Set<number>();
  sparse(square(1), 2, seen);
  expect(sparse(square(1), 2, seen).count).toBe(0);
});
