// SPDX-License-Identifier: GPL-2.0-or-later
// The picture of a long path during motion: its course, drawn once in cells of a given size. The time of a
// software renderer depends on the length of all lines in pixels, so a path that covers an area many times is
// drawn there only once.
import type { Moves } from './chunks';

const SPAN = 1 << 16;

/** Returns pairs of points, one for each cell that contains a piece of the path. `seen` contains the cells of all chunks. */
export function sparse(moves: Moves, cell: number, seen: Set<number>): Moves {
  const { places, lines, kinds, shades, count } = moves;
  const kept: number[] = [];
  const index = (value: number): number => Math.round(value / cell) & (SPAN - 1);
  for (let i = 1; i < count; ++i) {
    const [a, b] = [(i - 1) * 3, i * 3];
    const x = index(((places[a] ?? 0) + (places[b] ?? 0)) / 2);
    const y = index(((places[a + 1] ?? 0) + (places[b + 1] ?? 0)) / 2);
    const z = index(((places[a + 2] ?? 0) + (places[b + 2] ?? 0)) / 2);
    const key = (x * SPAN + y) * 32 + (z & 31);
    if (!seen.has(key)) {
      seen.add(key);
      kept.push(i);
    }
  }
  const thinned: Moves = {
    kind: 'moves',
    count: kept.length * 2,
    places: new Float32Array(kept.length * 6),
    lines: new Uint32Array(kept.length * 2),
    kinds: new Uint8Array(kept.length * 2),
    shades: new Uint8Array(kept.length * 2),
  };
  kept.forEach((from, to) => {
    thinned.places.set(places.subarray(from * 3 - 3, from * 3 + 3), to * 6);
    thinned.lines.fill(lines[from] ?? 0, to * 2, to * 2 + 2);
    thinned.kinds.fill(kinds[from] ?? 0, to * 2, to * 2 + 2);
    thinned.shades.fill(shades[from] ?? 0, to * 2, to * 2 + 2);
  });
  return thinned;
}
