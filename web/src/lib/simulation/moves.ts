// SPDX-License-Identifier: GPL-2.0-or-later
// The moves of a program as points of the tool tip in work coordinates. [mm]
import type { Chunk } from '../path/chunks';
import type { Box } from './stock';

export const RAPID = 0;
export const PROBE = 3;
/** A step between two points at which the tool offset changes: the tip has another position, but nothing has moved. */
export const JUMP = 4;

/** A longer program is simulated up to this point. */
export const MOST_POINTS = 2_000_000;

/** Work coordinates: origin and rotation in machine coordinates. */
export interface Frame {
  /** [machine units] */
  origin: readonly number[];
  rotation_deg: number;
  /** Millimetres of a machine unit. */
  unit_mm: number;
}

export interface ToolRange {
  /** First point that the tool reaches. */
  first: number;
  tool: number;
}

type Chunks = Extract<Chunk, { kind: 'moves' | 'ranges' | 'offsets' }>;

/** Grows while the path is read. */
export class Moves {
  points = new Float32Array(3 * 1024);
  lines = new Uint32Array(1024);
  kinds = new Uint8Array(1024);
  /** Speed of the cuts. [mm/s] */
  feeds = new Float32Array(1024);
  count = 0;
  readonly tools: ToolRange[] = [];
  /** The program is longer than the stored part. */
  isCut = false;
  /** Server point numbers before each jump. */
  private readonly jumps: number[] = [];
  private served = 0;
  private offsets: { first: number; xyz: [number, number, number] }[] = [];
  private offset: [number, number, number] = [0, 0, 0];
  private last: [number, number, number] = [0, 0, 0];
  private ranges: { first: number; feed: number; tool: number }[] = [];
  private feed = 0;
  private readonly cos: number;
  private readonly sin: number;

  constructor(
    private readonly frame: Frame,
    private readonly first_tool: number,
  ) {
    const angle = (frame.rotation_deg * Math.PI) / 180;
    [this.cos, this.sin] = [Math.cos(angle), Math.sin(angle)];
    this.tools.push({ first: 0, tool: first_tool });
  }

  take(chunk: Chunks): void {
    if (chunk.kind === 'ranges') {
      chunk.first.forEach((first, i) => this.ranges.push({ first, feed: chunk.feed[i] ?? 0, tool: chunk.tool[i] ?? 0 }));
    } else if (chunk.kind === 'offsets') {
      chunk.first.forEach((first, i) => this.offsets.push({ first, xyz: [chunk.xyz[i * 3] ?? 0, chunk.xyz[i * 3 + 1] ?? 0, chunk.xyz[i * 3 + 2] ?? 0] }));
    } else {
      for (let i = this.served > 0 ? 1 : 0; i < chunk.count && !this.isCut; ++i) {
        this.takePoint([chunk.places[i * 3] as number, chunk.places[i * 3 + 1] as number, chunk.places[i * 3 + 2] as number], chunk.lines[i] as number, chunk.kinds[i] as number);
      }
    }
  }

  private takePoint(machine: [number, number, number], line: number, kind: number): void {
    while (this.ranges[0] !== undefined && this.ranges[0].first <= this.served) {
      const { feed, tool } = this.ranges.shift() as { feed: number; tool: number };
      this.feed = feed * this.frame.unit_mm;
      this.setTool(tool === 0 ? this.first_tool : tool);
    }
    let hasNewOffset = false;
    while (this.offsets[0] !== undefined && this.offsets[0].first <= this.served) {
      this.offset = (this.offsets.shift() as { xyz: [number, number, number] }).xyz;
      hasNewOffset = true;
    }
    if (hasNewOffset && this.served > 0) {
      this.jumps.push(this.served);
      this.push(this.last, line, JUMP);
    }
    this.push(machine, line, kind);
    this.last = machine;
    this.served += 1;
  }

  private setTool(tool: number): void {
    const { tools } = this;
    const last = tools[tools.length - 1] as ToolRange;
    if (last.tool === tool) {
      return;
    }
    if (last.first === this.count) {
      last.tool = tool;
    } else {
      tools.push({ first: this.count, tool });
    }
  }

  private push(machine: [number, number, number], line: number, kind: number): void {
    if (this.count === MOST_POINTS) {
      this.isCut = true;
      return;
    }
    if (this.count === this.lines.length) {
      this.grow();
    }
    const { origin, unit_mm } = this.frame;
    const x = machine[0] - this.offset[0] - (origin[0] ?? 0);
    const y = machine[1] - this.offset[1] - (origin[1] ?? 0);
    const at = this.count * 3;
    this.points[at] = (x * this.cos + y * this.sin) * unit_mm;
    this.points[at + 1] = (y * this.cos - x * this.sin) * unit_mm;
    this.points[at + 2] = (machine[2] - this.offset[2] - (origin[2] ?? 0)) * unit_mm;
    this.lines[this.count] = line;
    this.kinds[this.count] = kind;
    this.feeds[this.count] = this.feed;
    this.count += 1;
  }

  private grow(): void {
    const size = Math.min(MOST_POINTS, this.lines.length * 2);
    const grown = <T extends Float32Array | Uint32Array | Uint8Array>(old: T, fresh: T): T => {
      fresh.set(old);
      return fresh;
    };
    this.points = grown(this.points, new Float32Array(size * 3));
    this.lines = grown(this.lines, new Uint32Array(size));
    this.kinds = grown(this.kinds, new Uint8Array(size));
    this.feeds = grown(this.feeds, new Float32Array(size));
  }

  /** Index of a point with the server's number. */
  indexOf(served: number): number {
    let [low, high] = [0, this.jumps.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.jumps[middle] as number) <= served) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return served + low;
  }

  /** The tool that reaches a point. */
  toolAt(index: number): number {
    let [low, high] = [0, this.tools.length];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if ((this.tools[middle] as ToolRange).first <= index) {
        low = middle;
      } else {
        high = middle;
      }
    }
    return this.tools[low]?.tool ?? 0;
  }

  /** Extents of all cutting moves; null: there are none. */
  cuts(): Box | null {
    const box: Box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
    for (let i = 1; i < this.count; ++i) {
      const kind = this.kinds[i];
      if (kind === RAPID || kind === JUMP || kind === PROBE) {
        continue;
      }
      for (let axis = 0; axis < 3; ++axis) {
        const [a, b] = [this.points[i * 3 - 3 + axis] as number, this.points[i * 3 + axis] as number];
        box.low[axis] = Math.min(box.low[axis] as number, a, b);
        // The top is the end of cuts, not the start of a feed in the air.
        box.high[axis] = Math.max(box.high[axis] as number, axis === 2 ? Math.min(a, b) : Math.max(a, b));
      }
    }
    return box.low[0] === Infinity ? null : box;
  }
}
