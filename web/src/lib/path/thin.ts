// SPDX-License-Identifier: GPL-2.0-or-later
// A path with fewer points that looks the same from a distance, drawn while it is rotated.
import type { Moves } from './chunks';

/** No reduced copy is made if more than this fraction of the points remains. */
const WORTH_A_COPY = 0.5;

/**
 * Keeps the ends of moves of another type, and points farther than `distance` from the last one kept; returns
 * the moves unchanged if most of them would remain.
 */
export function thin(moves: Moves, distance: number): Moves {
  const { places, lines, kinds, shades, count } = moves;
  const kept: number[] = count > 0 ? [0] : [];
  const limit = distance * distance;
  let last = 0;
  for (let i = 1; i < count; ++i) {
    const dx = (places[i * 3] ?? 0) - (places[last * 3] ?? 0);
    const dy = (places[i * 3 + 1] ?? 0) - (places[last * 3 + 1] ?? 0);
    const dz = (places[i * 3 + 2] ?? 0) - (places[last * 3 + 2] ?? 0);
    const changes = i + 1 === count || kinds[i] !== kinds[i + 1];
    if (changes || dx * dx + dy * dy + dz * dz >= limit) {
      kept.push(i);
      last = i;
    }
  }
  if (kept.length > WORTH_A_COPY * count) {
    return moves;
  }
  const thinned: Moves = {
    kind: 'moves',
    count: kept.length,
    places: new Float32Array(kept.length * 3),
    lines: new Uint32Array(kept.length),
    kinds: new Uint8Array(kept.length),
    shades: new Uint8Array(kept.length),
  };
  kept.forEach((from, to) => {
    thinned.places.set(places.subarray(from * 3, from * 3 + 3), to * 3);
    thinned.lines[to] = lines[from] ?? 0;
    thinned.kinds[to] = kinds[from] ?? 0;
    thinned.shades[to] = shades[from] ?? 0;
  });
  return thinned;
}
