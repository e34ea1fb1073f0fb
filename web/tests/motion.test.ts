// SPDX-License-Identifier: GPL-2.0-or-later
import { expect, it } from 'vitest';
import type { Moves } from '../src/lib/path/chunks';
import { joined, Pace, shuffled } from '../src/lib/path/motion';

function line(count: number): Moves {
  return {
    kind: 'moves',
    count: count * 2,
    places: Float32Array.from({ length: count * 6 }, (_, i) => Math.floor(i / 6) + (i % 6 >= 3 ? 0.5 : 0)),
    lines: Uint32Array.from({ length: count * 2 }, (_, i) => i >> 1),
    kinds: new Uint8Array(count * 2).fill(1),
    shades: Uint8Array.from({ length: count * 2 }, (_, i) => (i >> 1) & 255),
  };
}

it('keeps each pair together, and loses and doubles none', () => {
  const out = shuffled(joined([line(600), line(400)]));
  expect(out.count).toBe(2000);
  const seen = Array.from({ length: 1000 }, (_, i) => {
    expect(out.lines[i * 2]).toBe(out.lines[i * 2 + 1]);
    expect(out.shades[i * 2]).toBe((out.lines[i * 2] ?? 0) & 255);
    expect((out.places[i * 6 + 3] ?? 0) - (out.places[i * 6] ?? 0)).toBe(0.5);
    return out.lines[i * 2] ?? -1;
  });
  const expected = [...Array.from({ length: 600 }, (_, i) => i), ...Array.from({ length: 400 }, (_, i) => i)];
  expect(seen.sort((a, b) => a - b)).toEqual(expected.sort((a, b) => a - b));
});

it('spreads the first of them over the whole path', () => {
  const out = shuffled(line(10_000));
  const tenths = new Set(Array.from({ length: 300 }, (_, i) => Math.floor((out.lines[i * 2] ?? 0) / 1000)));
  expect(tenths.size).toBe(10);
});

it('draws less where frames are long, more where they are short, and never too little', () => {
  const pace = new Pace(40_000);
  for (let i = 0; i < 20; ++i) {
    pace.note(70);
  }
  expect(pace.pieces).toBe(1500);
  for (let i = 0; i < 100; ++i) {
    pace.note(10);
  }
  expect(pace.pieces).toBe(40_000);
  pace.note(22);
  expect(pace.pieces).toBe(40_000);
  expect(new Pace(100).pieces).toBe(100);
});
