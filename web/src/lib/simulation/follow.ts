// SPDX-License-Identifier: GPL-2.0-or-later
// Position of a running machine in the moves of its program, from the reported line and the tool position.
import type { Moves } from './moves';
import type { Triple } from './stock';

/** Maximum number of moves of one line that are searched: an arc or a cycle. */
const MOST_SEARCHED = 20_000;

export class Follower {
  private done = 0;

  constructor(private readonly moves: Moves) {}

  /** Called when the program has been started again. */
  restart(): void {
    this.done = 0;
  }

  /** Moves done, with a fraction of the current one; never decreases. */
  follow(line: number, tip: Triple): number {
    const { moves } = this;
    const current = Math.floor(this.done) + 1;
    let first = current;
    if (line > 0 && moves.lines[current] !== line) {
      first = moves.lines.subarray(0, moves.count).indexOf(line, current);
    }
    if (first < 1 || line <= 0) {
      return this.done;
    }
    let [best, nearest] = [Math.max(this.done, first - 1), Infinity];
    const last = Math.min(moves.count - 1, first + MOST_SEARCHED);
    for (let move = first; move <= last && moves.lines[move] === line; ++move) {
      const { part, distance } = this.nearest(move, tip);
      const at = move - 1 + part;
      if (distance < nearest - 1e-6 && at >= this.done) {
        [best, nearest] = [at, distance];
      }
    }
    this.done = best;
    return best;
  }

  private nearest(move: number, tip: Triple): { part: number; distance: number } {
    const { points } = this.moves;
    const at = move * 3;
    let [along, square] = [0, 0];
    for (let axis = 0; axis < 3; ++axis) {
      const [begin, end] = [points[at - 3 + axis] as number, points[at + axis] as number];
      along += ((tip[axis] as number) - begin) * (end - begin);
      square += (end - begin) ** 2;
    }
    const part = square > 0 ? Math.min(Math.max(along / square, 0), 1) : 1;
    let distance = 0;
    for (let axis = 0; axis < 3; ++axis) {
      const [begin, end] = [points[at - 3 + axis] as number, points[at + axis] as number];
      distance += ((tip[axis] as number) - begin - part * (end - begin)) ** 2;
    }
    return { part, distance: Math.sqrt(distance) };
  }
}
