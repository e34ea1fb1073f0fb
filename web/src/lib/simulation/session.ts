// SPDX-License-Identifier: GPL-2.0-or-later
// One program in the worker: its moves, their simulation, and its picture. It yields to other messages every
// few milliseconds.
import type { Chunk } from '../path/chunks';
import { Clock } from './clock';
import { Display } from './display';
import { Follower } from './follow';
import { JUMP, Moves, PROBE, RAPID, type Frame } from './moves';
import type { Facts, Position, Prepared, Shown } from './protocol';
import { Simulation, type Setup } from './simulation';

/** Number of cells and moves between two checks for other messages. */
const CELLS_PER_SLICE = 3_000_000;
const MOVES_PER_SLICE = 20_000;
const MOST_ERRORS = 50;

export class Session {
  readonly moves: Moves;
  readonly errors: string[] = [];
  clock: Clock | null = null;
  private rotary_line: number | null = null;
  private simulation: Simulation | null = null;
  private display: Display | null = null;
  private follower: Follower | null = null;
  private last = 0;
  private preparations = 0;
  private isPrepared = false;

  constructor(
    frame: Frame,
    first_tool: number,
    private readonly rapid_mm_s: number,
  ) {
    this.moves = new Moves(frame, first_tool);
  }

  take(chunk: Chunk): void {
    if (chunk.kind === 'moves' || chunk.kind === 'ranges' || chunk.kind === 'offsets') {
      this.moves.take(chunk);
    } else if (chunk.kind === 'rotary') {
      this.rotary_line = chunk.line;
    } else if (chunk.kind === 'error' && this.errors.length < MOST_ERRORS) {
      this.errors.push(chunk.text);
    }
  }

  /** Called when the path has been read. */
  finish(): Facts {
    const { moves } = this;
    this.clock = new Clock(moves, this.rapid_mm_s);
    this.follower = new Follower(moves);
    const used = new Set(moves.tools.filter((one, i) => this.hasMoves(one.first, moves.tools[i + 1]?.first ?? moves.count)).map((one) => one.tool));
    return {
      moves: Math.max(0, moves.count - 1),
      lines: moves.lines[Math.max(0, moves.count - 1)] ?? 0,
      cuts: moves.cuts(),
      tools: [...used],
      rotary_line: this.rotary_line,
      isCut: moves.isCut,
      errors: this.errors,
    };
  }

  /** Tools that only move in the air need no diameter. */
  private hasMoves(first: number, end: number): boolean {
    for (let i = Math.max(first, 1); i < end; ++i) {
      if (![RAPID, JUMP, PROBE].includes(this.moves.kinds[i] ?? RAPID)) {
        return true;
      }
    }
    return false;
  }

  /** Returns null if another preparation has begun, or if it was cancelled. */
  async prepare(setup: Setup, pause: () => Promise<void>, report: (part: number) => void): Promise<Prepared | null> {
    const mine = ++this.preparations;
    this.isPrepared = false;
    const begin = performance.now();
    const simulation = new Simulation(this.moves, setup);
    const whole = simulation.field.volume();
    while (!simulation.prepare(CELLS_PER_SLICE, MOVES_PER_SLICE)) {
      report(simulation.prepared / Math.max(simulation.moveCount, 1));
      await pause();
      if (mine !== this.preparations) {
        return null;
      }
    }
    this.simulation = simulation;
    this.display = new Display(simulation.field);
    this.isPrepared = true;
    const { findings, field } = simulation;
    return {
      findings: findings.list(),
      dropped: findings.dropped,
      unknown_tools: simulation.unknown_tools,
      makers: simulation.makers(),
      cell_mm: Math.max(field.cell_x, field.cell_y),
      removed_mm3: whole - field.volume(),
      took_ms: performance.now() - begin,
    };
  }

  cancel(): void {
    this.preparations += 1;
  }

  /** Has no effect until the program is prepared. */
  show(at: Position, most: number): Shown | null {
    const { simulation, display, clock, moves } = this;
    if (simulation === null || display === null || clock === null || !this.isPrepared) {
      return null;
    }
    const wanted = this.find(at);
    simulation.goTo(wanted ?? this.last);
    this.last = simulation.shown;
    const current = Math.min(Math.ceil(this.last), simulation.moveCount);
    return {
      moves: this.last,
      seconds: clock.at(this.last),
      line: moves.lines[current] ?? 0,
      tip: simulation.tip(this.last),
      tool: moves.toolAt(current),
      isRapid: moves.kinds[current] === RAPID,
      picture: display.picture(most),
      isMissing: wanted === null,
    };
  }

  private find(at: Position): number | null {
    if ('moves' in at) {
      return at.moves;
    }
    if ('seconds' in at) {
      return this.clock?.movesAt(at.seconds) ?? 0;
    }
    if ('machine' in at) {
      if (at.machine.isNew) {
        this.follower?.restart();
      }
      return this.follower?.follow(at.machine.line, at.machine.tip) ?? 0;
    }
    const { lines, count } = this.moves;
    const all = lines.subarray(0, count);
    // The end of the line's first move, where its cut is visible.
    const found = all.indexOf(at.line, 1);
    if (found < 0) {
      return null;
    }
    let end = found;
    while (end + 1 < count && lines[end + 1] === at.line) {
      end += 1;
    }
    return end;
  }
}
