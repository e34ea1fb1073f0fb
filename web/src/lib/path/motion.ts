// SPDX-License-Identifier: GPL-2.0-or-later
// The part of a long path that is drawn while something moves: as many pieces as keep a frame short on this
// computer. The pieces are in shuffled order, so that the first ones, however many, cover the whole path;
// nothing is sent to the graphics card again.
import type { Moves } from './chunks';

/** A frame of 30 Hz, with a margin for other work of the page. [ms] */
const LONG_MS = 28;
const SHORT_MS = 18;
const FEWEST = 1500;

/** The pairs of points in a different, fixed order. */
export function shuffled(pairs: Moves): Moves {
  const count = pairs.count / 2;
  const order = Uint32Array.from({ length: count }, (_, i) => i);
  let seed = 12345;
  for (let i = count - 1; i > 0; --i) {
    seed = (Math.imul(seed, 1103515245) + 12345) >>> 0;
    const other = seed % (i + 1);
    [order[i], order[other]] = [order[other] ?? 0, order[i] ?? 0];
  }
  const out: Moves = {
    kind: 'moves',
    count: pairs.count,
    places: new Float32Array(pairs.places.length),
    lines: new Uint32Array(pairs.lines.length),
    kinds: new Uint8Array(pairs.kinds.length),
    shades: new Uint8Array(pairs.shades.length),
  };
  order.forEach((from, to) => {
    out.places.set(pairs.places.subarray(from * 6, from * 6 + 6), to * 6);
    out.lines.set(pairs.lines.subarray(from * 2, from * 2 + 2), to * 2);
    out.kinds.set(pairs.kinds.subarray(from * 2, from * 2 + 2), to * 2);
    out.shades.set(pairs.shades.subarray(from * 2, from * 2 + 2), to * 2);
  });
  return out;
}

/** Several lists of pairs as one. */
export function joined(parts: readonly Moves[]): Moves {
  const count = parts.reduce((sum, one) => sum + one.count, 0);
  const out: Moves = { kind: 'moves', count, places: new Float32Array(count * 3), lines: new Uint32Array(count), kinds: new Uint8Array(count), shades: new Uint8Array(count) };
  let at = 0;
  for (const one of parts) {
    out.places.set(one.places, at * 3);
    out.lines.set(one.lines, at);
    out.kinds.set(one.kinds, at);
    out.shades.set(one.shades, at);
    at += one.count;
  }
  return out;
}

/** Number of pieces for the next frame. */
export class Pace {
  private share: number;

  constructor(
    private readonly most: number,
    first = most,
  ) {
    this.share = Math.min(first, most);
  }

  get pieces(): number {
    return Math.floor(this.share);
  }

  /** `ms`: duration of the previous frame, from its start to that of this one. */
  note(ms: number): void {
    if (ms > LONG_MS) {
      this.share *= Math.max(0.5, LONG_MS / ms);
    } else if (ms < SHORT_MS) {
      this.share *= 1.08;
    }
    this.share = Math.min(Math.max(this.share, Math.min(FEWEST, this.most)), this.most);
  }
}
