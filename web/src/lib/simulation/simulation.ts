// SPDX-License-Identifier: GPL-2.0-or-later
// Material removal of a whole program: prepared once with its findings, then shown at any move.
import { Checkpoints } from './checkpoints';
import { Field } from './field';
import { Findings, type FindingKind } from './findings';
import { JUMP, PROBE, RAPID, type Moves } from './moves';
import { depthIn } from './obstacles';
import { chooseCell } from './resolution';
import { cutterOf, FLAT, type Cutter, type ToolShape } from './shapes';
import type { Stock, Surroundings } from './stock';
import { CONTACT_MM, Sweep, type Segment } from './sweep';
import { Tops } from './tops';

export interface Setup extends Surroundings {
  stock: Stock;
  tools: ReadonlyMap<number, ToolShape>;
  /** Null: selected from the sizes of the stock and the tools and the length of the program. */
  cell_mm: number | null;
}

const MOST_MAKERS = 255;
/** Memory for all checkpoints, and the number of cells and moves between two of them. */
export interface CheckpointLimits {
  bytes: number;
  cells: number;
  moves: number;
}
const CHECKPOINTS: CheckpointLimits = { bytes: 96e6, cells: 400_000, moves: 5_000 };

interface Mill {
  cutter: Cutter;
  holder: Cutter | null;
  stickout: number;
  maker: number;
}

export class Simulation {
  readonly field: Field;
  readonly findings = new Findings();
  /** Tools of the program without a diameter; their moves remove nothing. */
  readonly unknown_tools: number[] = [];
  /** Number of prepared moves. */
  prepared = 0;
  /** Moves in the field: whole moves, and a fraction of the next. */
  shown = 0;
  private readonly sweep: Sweep;
  private readonly checkpoints: Checkpoints;
  private readonly tops: Tops;
  private readonly mills = new Map<number, Mill>();
  private range = 0;
  private base = 0;
  private cells_at_checkpoint = 0;
  private readonly segment: Segment = { x0: 0, y0: 0, z0: 0, x1: 0, y1: 0, z1: 0 };

  constructor(
    readonly moves: Moves,
    private readonly setup: Setup,
    private readonly limits = CHECKPOINTS,
  ) {
    const cutters = new Map<number, Cutter>();
    for (const tool of new Set(moves.tools.map((one) => one.tool))) {
      const shape = setup.tools.get(tool);
      if (shape === undefined || !(shape.diameter_mm > 0)) {
        this.unknown_tools.push(tool);
      } else {
        cutters.set(tool, cutterOf(shape));
        this.addMill(tool, shape);
      }
    }
    this.field = new Field(setup.stock, setup.cell_mm ?? chooseCell(moves, cutters, setup.stock));
    this.sweep = new Sweep(this.field);
    this.tops = new Tops(this.field);
    this.checkpoints = new Checkpoints(this.field, this.limits.bytes);
    this.checkpoints.add(0);
  }

  private addMill(tool: number, shape: ToolShape): void {
    const radius = shape.holder_diameter_mm / 2;
    const hasHolder = shape.stickout_mm !== null && radius > 0;
    this.mills.set(tool, {
      cutter: cutterOf(shape),
      holder: hasHolder ? { kind: FLAT, radius, flat_radius: radius, corner: 0, slope: 0 } : null,
      stickout: shape.stickout_mm ?? 0,
      maker: Math.min(this.mills.size + 1, MOST_MAKERS),
    });
  }

  /** Tools in the order of the numbers in the field, from 1. */
  makers(): number[] {
    return [...this.mills.keys()];
  }

  get moveCount(): number {
    return Math.max(0, this.moves.count - 1);
  }

  get checkpointCount(): number {
    return this.checkpoints.count;
  }

  /** Number of cells examined since the start. */
  get work(): number {
    return this.sweep.cells;
  }

  /** Prepares further moves, at most this many cells and moves. True at the end of the program. */
  prepare(most_cells: number, most_moves: number): boolean {
    const { sweep, checkpoints } = this;
    const stop = sweep.cells + most_cells;
    const last = Math.min(this.moveCount, this.prepared + most_moves);
    while (this.prepared < last && sweep.cells < stop) {
      this.prepared += 1;
      this.prepareMove(this.prepared);
      const { cells, moves } = this.limits;
      const isDue = sweep.cells - this.cells_at_checkpoint >= cells * checkpoints.stride || this.prepared - checkpoints.last >= moves * checkpoints.stride;
      if (isDue) {
        checkpoints.add(this.prepared);
        this.cells_at_checkpoint = sweep.cells;
      }
    }
    this.shown = this.prepared;
    if (this.prepared === this.moveCount) {
      checkpoints.add(this.prepared);
      this.base = checkpoints.count - 1;
      return true;
    }
    return false;
  }

  /** Shows the field after `wanted` moves, including a fraction of the next move. Call it only when all moves are prepared. */
  goTo(wanted: number): void {
    const target = Math.min(Math.max(wanted, 0), this.moveCount);
    const checkpoint = this.checkpoints.before(Math.floor(target));
    const from = this.checkpoints.movesOf(checkpoint);
    if (target < this.shown || this.shown < from) {
      this.checkpoints.restore(checkpoint, this.base);
      this.base = checkpoint;
      this.shown = from;
    }
    for (let move = Math.floor(this.shown) + 1; move <= Math.ceil(target); ++move) {
      this.cut(move, move > target ? target - (move - 1) : 1);
    }
    this.shown = target;
  }

  /** The tool tip after `moves`. Work coordinates. [mm] */
  tip(moves: number): [number, number, number] {
    const move = Math.min(Math.ceil(moves), this.moveCount);
    if (move <= 0) {
      return [0, 1, 2].map((axis) => this.moves.points[axis] ?? 0) as [number, number, number];
    }
    const part = Math.min(moves - (move - 1), 1);
    this.take(move, part);
    return [this.segment.x1, this.segment.y1, this.segment.z1];
  }

  private take(move: number, part: number): void {
    const { points } = this.moves;
    const { segment } = this;
    const at = move * 3;
    segment.x0 = points[at - 3] as number;
    segment.y0 = points[at - 2] as number;
    segment.z0 = points[at - 1] as number;
    segment.x1 = points[at] as number;
    segment.y1 = points[at + 1] as number;
    segment.z1 = points[at + 2] as number;
    if (part < 1) {
      segment.x1 = segment.x0 + part * (segment.x1 - segment.x0);
      segment.y1 = segment.y0 + part * (segment.y1 - segment.y0);
      segment.z1 = segment.z0 + part * (segment.z1 - segment.z0);
    }
  }

  /** The tool of a move; null if it has no diameter. */
  private millOf(move: number): Mill | undefined {
    const { tools } = this.moves;
    if ((tools[this.range]?.first ?? 0) > move) {
      this.range = 0;
    }
    while (this.range + 1 < tools.length && (tools[this.range + 1]?.first ?? Infinity) <= move) {
      this.range += 1;
    }
    return this.mills.get(tools[this.range]?.tool ?? 0);
  }

  private cut(move: number, part: number): void {
    const mill = this.millOf(move);
    const kind = this.moves.kinds[move];
    if (mill !== undefined && kind !== JUMP && kind !== PROBE) {
      this.take(move, part);
      this.sweep.run(this.segment, mill.cutter, mill.maker, this.isContinued(move), false);
    }
  }

  /** True if the tool was at the start of the move and has already cut there. */
  private isContinued(move: number): boolean {
    const before = this.moves.kinds[move - 1];
    return move > 1 && before !== JUMP && before !== PROBE && (this.moves.tools[this.range]?.first ?? 0) < move;
  }

  private prepareMove(move: number): void {
    const mill = this.millOf(move);
    const kind = this.moves.kinds[move];
    if (mill === undefined || kind === JUMP || kind === PROBE) {
      return;
    }
    const { sweep, segment, setup } = this;
    this.take(move, 1);
    const isRapid = kind === RAPID;
    sweep.run(segment, mill.cutter, mill.maker, this.isContinued(move), isRapid);
    if (isRapid && sweep.contact.depth > CONTACT_MM) {
      const { x, y, z, depth, part } = sweep.contact;
      this.find('rapid', move, part, depth, [x, y, z], '');
    }
    const lowest = Math.min(segment.z0, segment.z1);
    if (lowest < setup.floor_mm - CONTACT_MM) {
      const part = segment.z1 <= segment.z0 ? 1 : 0;
      this.find('floor', move, part, setup.floor_mm - lowest, this.along(part), '');
    }
    for (const fixture of setup.fixtures) {
      this.checkFixture(fixture, move, mill);
    }
    if (mill.holder !== null) {
      this.checkHolder(move, mill.holder, mill.stickout);
    }
  }

  private checkFixture(fixture: Surroundings['fixtures'][number], move: number, mill: Mill): void {
    const byTool = depthIn(fixture, this.segment, mill.cutter, 0);
    const byHolder = mill.holder === null ? null : depthIn(fixture, this.segment, mill.holder, mill.stickout);
    const worst = byTool ?? byHolder;
    if (worst !== null) {
      this.find('fixture', move, worst.part, worst.depth, this.along(worst.part), fixture.name);
    }
  }

  private checkHolder(move: number, holder: Cutter, stickout: number): void {
    const { segment, sweep } = this;
    const lifted = { ...segment, z0: segment.z0 + stickout, z1: segment.z1 + stickout };
    sweep.look(lifted, holder, this.tops);
    const { x, y, z, depth, part } = sweep.contact;
    if (depth > CONTACT_MM) {
      this.find('holder', move, part, depth, [x, y, z], '');
    }
  }

  private along(part: number): [number, number, number] {
    const { x0, y0, z0, x1, y1, z1 } = this.segment;
    return [x0 + part * (x1 - x0), y0 + part * (y1 - y0), z0 + part * (z1 - z0)];
  }

  private find(kind: FindingKind, move: number, part: number, depth: number, place: [number, number, number], fixture: string): void {
    this.findings.add(kind, { line: this.moves.lines[move] ?? 0, move: move - 1, part, tool: this.moves.tools[this.range]?.tool ?? 0, depth, place, fixture });
  }
}
