// SPDX-License-Identifier: GPL-2.0-or-later
// Time of each move of a program, calculated by the planner, and the progress of the machine in it.

export interface SlowSpot {
  file: string;
  is_in_program: boolean;
  line: number;
  lost_s: number;
  reason: string;
}

export interface TimeSum {
  total_s: number;
  cutting_s: number;
  rapid_s: number;
  dwell_s: number;
  is_complete: boolean;
  slowest: SlowSpot[];
}

/** Number of moves between two sums of time. */
const BLOCK = 1024;

/** All moves in order; grows while the times are read. */
export class Times {
  private lines = new Uint32Array(BLOCK);
  private seconds = new Float32Array(BLOCK);
  /** Time before each block of moves. */
  private sums: number[] = [0];
  private rest = 0;
  count = 0;

  add(line: number, seconds: number): void {
    if (this.count === this.lines.length) {
      const [lines, all] = [new Uint32Array(this.count * 2), new Float32Array(this.count * 2)];
      lines.set(this.lines);
      all.set(this.seconds);
      [this.lines, this.seconds] = [lines, all];
    }
    this.lines[this.count] = line;
    this.seconds[this.count] = seconds;
    this.count += 1;
    this.rest += seconds;
    if (this.count % BLOCK === 0) {
      this.sums.push((this.sums[this.sums.length - 1] ?? 0) + this.rest);
      this.rest = 0;
    }
  }

  get total(): number {
    return (this.sums[this.sums.length - 1] ?? 0) + this.rest;
  }

  line(move: number): number {
    return this.lines[move] ?? 0;
  }

  duration(move: number): number {
    return this.seconds[move] ?? 0;
  }

  /** Time before a move. */
  before(move: number): number {
    const block = Math.floor(move / BLOCK);
    let sum = this.sums[block] ?? 0;
    for (let i = block * BLOCK; i < move; ++i) {
      sum += this.seconds[i] ?? 0;
    }
    return sum;
  }

  /** The next move of a line, starting at move `from`; -1 if there is none. */
  next(line: number, from: number): number {
    const found = this.lines.subarray(0, this.count).indexOf(line, from);
    return found;
  }
}

/** Follows a program by the lines that the machine reports, through loops and calls. */
export class Follower {
  private move = 0;
  private within = 0;
  private hasBegun = false;

  constructor(private readonly times: Times) {}

  /** `line`: line of the current move; `seconds`: motion time since the last call. Returns the remaining time. */
  follow(line: number, seconds: number): number {
    const { times } = this;
    if (line > 0 && (!this.hasBegun || times.line(this.move) !== line)) {
      const next = times.next(line, this.hasBegun ? this.move + 1 : 0);
      if (next >= 0) {
        this.move = next;
        this.within = 0;
        this.hasBegun = true;
      }
    }
    if (this.hasBegun) {
      this.within += seconds;
      // Consecutive moves of one line have the same line number, so their durations determine the current move.
      while (this.within > times.duration(this.move) && times.line(this.move + 1) === line && this.move + 1 < times.count) {
        this.within -= times.duration(this.move);
        this.move += 1;
      }
    }
    return this.left;
  }

  get left(): number {
    const { times } = this;
    const done = Math.min(this.within, times.duration(this.move));
    return Math.max(0, times.total - times.before(this.move) - done);
  }
}
