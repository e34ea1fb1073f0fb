// SPDX-License-Identifier: GPL-2.0-or-later
// Moves for tests of the simulation, in the server's format.
import { Moves } from '../../src/lib/simulation/moves';
import { guessShape, type ToolShape } from '../../src/lib/simulation/shapes';
import { Simulation, type CheckpointLimits, type Setup } from '../../src/lib/simulation/simulation';
import type { Stock, Triple } from '../../src/lib/simulation/stock';

export interface Point {
  at: Triple;
  line: number;
  /** 0 rapid, 1 feed, 2 arc, 3 probe. */
  kind: number;
  tool?: number;
}

export function movesOf(points: readonly Point[], first_tool = 1): Moves {
  const moves = new Moves({ origin: [0, 0, 0], rotation_deg: 0, unit_mm: 1 }, first_tool);
  let tool = first_tool;
  points.forEach((point, i) => {
    if (point.tool !== undefined && point.tool !== tool) {
      tool = point.tool;
      moves.take({ kind: 'ranges', first: Uint32Array.of(i), feed: Float32Array.of(10), tool: Uint32Array.of(tool) });
    }
    const isFirst = i === 0;
    // Each chunk begins with the last point of the previous chunk.
    const all = isFirst ? [point] : [point, point];
    moves.take({
      kind: 'moves',
      count: all.length,
      places: Float32Array.from(all.flatMap((one) => one.at)),
      lines: Uint32Array.from(all.map((one) => one.line)),
      kinds: Uint8Array.from(all.map((one) => one.kind)),
      shades: new Uint8Array(all.length),
    });
  });
  return moves;
}

export const BOX: Stock = { kind: 'box', low: [0, 0, -20], high: [100, 80, 0] };

export function tool(shape: Partial<ToolShape> = {}): ToolShape {
  return { ...guessShape(6, ''), ...shape };
}

export function simulate(moves: Moves, setup: Partial<Setup> = {}, limits?: CheckpointLimits): Simulation {
  const made = new Simulation(moves, { stock: BOX, fixtures: [], floor_mm: -20, tools: new Map([[1, tool()]]), cell_mm: null, ...setup }, limits);
  while (!made.prepare(1e7, 1e5)) {
    // until the end
  }
  return made;
}
