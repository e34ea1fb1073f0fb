// SPDX-License-Identifier: GPL-2.0-or-later
// Time along a program: first estimated from feeds, then as calculated by the planner.
import type { TimedMoves } from '../path/times_worker';
import { JUMP, RAPID, type Moves } from './moves';

/** If the feed is not known. [mm/s] */
const SLOWEST_MM_S = 1;

export class Clock {
  /** Time at each point. [s] */
  private times: Float64Array;
  private planned: Float64Array | null = null;
  private reached = 0;
  isPlanned = false;

  constructor(
    private readonly moves: Moves,
    rapid_mm_s: number,
  ) {
    this.times = new Float64Array(Math.max(moves.count, 1));
    for (let i = 1; i < moves.count; ++i) {
      const speed = moves.kinds[i] === RAPID ? rapid_mm_s : (moves.feeds[i] as number) || SLOWEST_MM_S;
      this.times[i] = (this.times[i - 1] as number) + this.length(i) / Math.max(speed, SLOWEST_MM_S);
    }
  }

  private length(move: number): number {
    const { points, kinds } = this.moves;
    const at = move * 3;
    const [x, y, z] = [0, 1, 2].map((axis) => (points[at + axis] as number) - (points[at + axis - 3] as number)) as [number, number, number];
    return kinds[move] === JUMP ? 0 : Math.sqrt(x * x + y * y + z * z);
  }

  get total(): number {
    return this.times[this.times.length - 1] ?? 0;
  }

  /**
   * Times from the planner, in the order of the program. If a move of the planner has several points, its
   * time is divided by length.
   */
  take(timed: TimedMoves): void {
    this.planned ??= new Float64Array(this.times.length);
    const { planned } = this;
    for (let i = 0; i < timed.points.length; ++i) {
      const last = Math.min(this.moves.indexOf(timed.points[i] as number), planned.length - 1);
      const seconds = timed.seconds[i] as number;
      let whole = 0;
      for (let move = this.reached + 1; move <= last; ++move) {
        whole += this.length(move);
      }
      const begin = planned[this.reached] as number;
      let part = 0;
      for (let move = this.reached + 1; move <= last; ++move) {
        part += this.length(move);
        planned[move] = begin + (whole > 0 ? (part / whole) * seconds : 0);
      }
      this.reached = Math.max(this.reached, last);
      planned[this.reached] = begin + seconds;
    }
  }

  /** All times have been taken. */
  finish(): void {
    if (this.planned !== null) {
      this.planned.fill(this.planned[this.reached] as number, this.reached + 1);
      this.times = this.planned;
      this.planned = null;
      this.isPlanned = true;
    }
  }

  /** Time after `moves`; a fraction is a part of the next move. */
  at(moves: number): number {
    const move = Math.min(Math.max(Math.floor(moves), 0), this.times.length - 1);
    const [begin, end] = [this.times[move] as number, this.times[Math.min(move + 1, this.times.length - 1)] as number];
    return begin + (moves - move) * (end - begin);
  }

  /** Moves done at a time. */
  movesAt(seconds: number): number {
    const { times } = this;
    let [low, high] = [0, times.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if ((times[middle] as number) <= seconds) {
        low = middle;
      } else {
        high = middle - 1;
      }
    }
    const [begin, end] = [times[low] as number, times[Math.min(low + 1, times.length - 1)] as number];
    return end > begin ? low + Math.min(Math.max((seconds - begin) / (end - begin), 0), 1) : low;
  }
}
