// SPDX-License-Identifier: GPL-2.0-or-later
// Colours of a path by feed, tool or planned speed: one byte for each point, from ranges that begin at a
// point.
import type { Moves } from './chunks';

export type ColorBy = 'kind' | 'feed' | 'tool' | 'speed';
export const COLOR_BY: readonly ColorBy[] = ['kind', 'feed', 'tool', 'speed'];

const RAPID = 0;
const PROBE = 3;
const MOST_SHADE = 255;

/** Values along a path. Each value applies from a point to the next; the points increase. The list grows while the path is read. */
export class Ranges {
  private firsts = new Uint32Array(64);
  private values = new Float32Array(64);
  count = 0;

  add(first: number, value: number): void {
    const isSame = this.count > 0 && this.values[this.count - 1] === Math.fround(value);
    if (isSame) {
      return;
    }
    if (this.count === this.firsts.length) {
      const [firsts, values] = [new Uint32Array(this.count * 2), new Float32Array(this.count * 2)];
      firsts.set(this.firsts);
      values.set(this.values);
      [this.firsts, this.values] = [firsts, values];
    }
    this.firsts[this.count] = first;
    this.values[this.count] = value;
    this.count += 1;
  }

  clear(): void {
    [this.firsts, this.values, this.count] = [new Uint32Array(64), new Float32Array(64), 0];
  }

  /** The number of the range that contains a point; -1: before the first. */
  rangeOf(point: number): number {
    let [low, high] = [0, this.count];
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.firsts[middle] ?? 0) <= point) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low - 1;
  }

  first(range: number): number {
    return range < this.count ? (this.firsts[range] ?? 0) : Infinity;
  }

  value(range: number): number {
    return range < 0 ? 0 : (this.values[range] ?? 0);
  }

  /** Minimum and maximum of all values except 0 ("none"). */
  extent(): { low: number; high: number } | null {
    let [low, high] = [Infinity, 0];
    for (let i = 0; i < this.count; ++i) {
      const value = this.values[i] ?? 0;
      if (value > 0) {
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
    return high > 0 ? { low, high } : null;
  }

  distinct(most: number): number[] {
    const found = new Set<number>();
    for (let i = 0; i < this.count && found.size < most; ++i) {
      found.add(this.values[i] ?? 0);
    }
    return [...found].sort((a, b) => a - b);
  }
}

/** Shade of a value: 0 to 255. */
export type Shading = (value: number) => number;

/** Returns a shading from slow to fast. */
export function gradient(extent: { low: number; high: number } | null): Shading {
  const [low, high] = [extent?.low ?? 0, extent?.high ?? 0];
  const span = high - low;
  return (value) => (span > 0 ? Math.round((Math.min(Math.max(value - low, 0), span) / span) * MOST_SHADE) : MOST_SHADE);
}

/** One shade for each tool, in their order. */
export function byNumber(numbers: readonly number[]): Shading {
  const places = new Map(numbers.map((one, i) => [one, i]));
  return (value) => (places.get(value) ?? 0) & MOST_SHADE;
}

/** Shades of points, beginning with number `first`. */
export function shade(moves: Moves, first: number, ranges: Ranges, shading: Shading): void {
  const { shades, count } = moves;
  let range = ranges.rangeOf(first);
  let next = ranges.first(range + 1);
  let now = shading(ranges.value(range));
  for (let i = 0; i < count; ++i) {
    while (first + i >= next) {
      range += 1;
      next = ranges.first(range + 1);
      now = shading(ranges.value(range));
    }
    shades[i] = now;
  }
}

/** Moves without a feed have a fixed colour. */
export function hasOwnColor(kind: number): boolean {
  return kind === RAPID || kind === PROBE;
}
