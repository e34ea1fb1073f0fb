// SPDX-License-Identifier: GPL-2.0-or-later
// The stock before the cut, with its fixtures and the floor. Work coordinates. [mm]

export type Triple = [number, number, number];

export interface Box {
  low: Triple;
  high: Triple;
}

export interface Stock {
  kind: 'box' | 'cylinder' | 'mesh';
  /** Extents of the stock. The axis of a cylinder is parallel to Z in the middle, its diameter is the smaller side. */
  low: Triple;
  high: Triple;
  /** Triangles of a mesh, nine numbers each, relative to the lower corner. Seen from above, without undercuts. */
  triangles?: Float32Array;
}

export interface Fixture extends Box {
  name: string;
}

export interface Surroundings {
  fixtures: Fixture[];
  /** Height of the table, or of the lowest point that a tool may reach. */
  floor_mm: number;
}

/**
 * Stock around the moves that cut with a tool of this radius, with an allowance at the sides and below, so
 * that a pocket has walls and a floor. Its top is Z0 if the program cuts below Z0, otherwise the end of the
 * highest cut.
 */
export function stockAround(cuts: Box, radius_mm: number, allowance_mm: number): Stock {
  const [low, high]: [Triple, Triple] = [[...cuts.low], [...cuts.high]];
  for (const axis of [0, 1]) {
    low[axis] = (low[axis] ?? 0) - radius_mm - allowance_mm;
    high[axis] = (high[axis] ?? 0) + radius_mm + allowance_mm;
  }
  // Approaches, and retracts from bores at feed, are above the stock.
  high[2] = low[2] < 0 ? 0 : high[2];
  low[2] -= allowance_mm;
  const LEAST_MM = 1;
  for (const axis of [0, 1, 2]) {
    if ((high[axis] ?? 0) - (low[axis] ?? 0) < LEAST_MM) {
      low[axis] = (high[axis] ?? 0) - LEAST_MM;
    }
  }
  return { kind: 'box', low, high };
}

export function isSound(stock: Stock): boolean {
  const values = [...stock.low, ...stock.high];
  return values.every((one) => Number.isFinite(one) && Math.abs(one) < 1e5) && stock.low.every((low, axis) => (stock.high[axis] ?? 0) - low > 1e-3);
}
