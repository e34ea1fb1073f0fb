// SPDX-License-Identifier: GPL-2.0-or-later
// The size of the cells: as small as memory and time permit, so that a program of any length is prepared in a
// few seconds.
import { MOST_CELLS } from './field';
import { JUMP, type Moves } from './moves';
import { BULL, FLAT, type Cutter } from './shapes';
import type { Stock } from './stock';

/** Number of cells examined by all moves together, for a round tool. */
export const MOST_WORK = 100_000_000;
/** Relative cost of a cell for a flat tool at one height, and for a bull nose that rises or falls. */
const LEVEL_COST = 0.4;
const BULL_COST = 2.5;
const LEAST_CELL_MM = 0.005;

/** Area that the moves sweep inside the stock, weighted by the cost of its cells. [mm²] */
export function sweptArea(moves: Moves, cutters: ReadonlyMap<number, Cutter>, stock: Stock): number {
  let area = 0;
  const { points, kinds } = moves;
  for (let range = 0; range < moves.tools.length; ++range) {
    const cutter = cutters.get(moves.tools[range]?.tool ?? 0);
    const radius = cutter?.radius ?? 0;
    const [level, sloped] = [cutter?.kind === FLAT ? LEVEL_COST : 1, cutter?.kind === BULL ? BULL_COST : 1];
    const last = moves.tools[range + 1]?.first ?? moves.count;
    for (let i = Math.max(1, moves.tools[range]?.first ?? 0); i < last; ++i) {
      const at = i * 3;
      const z = Math.min(points[at - 1] as number, points[at + 2] as number);
      if (kinds[i] === JUMP || z >= stock.high[2]) {
        continue;
      }
      const [wide, high] = [within(points[at - 3] as number, points[at] as number, stock, 0, radius), within(points[at - 2] as number, points[at + 1] as number, stock, 1, radius)];
      const side = Math.hypot(wide, high);
      const all = (wide + 2 * radius) * (high + 2 * radius);
      area += wide < 0 || high < 0 ? 0 : (points[at - 1] === points[at + 2] ? level : sloped) * Math.min(all, 2 * radius * side + 2 * radius * radius);
    }
  }
  return area;
}

/** Length of a move along an axis inside the stock; negative if it is outside. */
function within(a: number, b: number, stock: Stock, axis: 0 | 1, radius: number): number {
  const low = Math.max(Math.min(a, b), stock.low[axis] - radius);
  const high = Math.min(Math.max(a, b), stock.high[axis] + radius);
  return high - low;
}

export function chooseCell(moves: Moves, cutters: ReadonlyMap<number, Cutter>, stock: Stock): number {
  const area = (stock.high[0] - stock.low[0]) * (stock.high[1] - stock.low[1]);
  // Rounding up rows and columns may add a few cells.
  const forMemory = Math.sqrt(area / (MOST_CELLS * 0.98));
  return Math.max(LEAST_CELL_MM, forMemory, Math.sqrt(sweptArea(moves, cutters, stock) / MOST_WORK));
}
