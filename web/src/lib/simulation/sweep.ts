// SPDX-License-Identifier: GPL-2.0-or-later
// Removes the material that a tool sweeps along a straight move. For each cell the lowest point of the tool
// over the whole move is calculated in closed form (for a bull nose by bisection), so the length of a move
// does not affect the result.
import type { Field } from './field';
import { CONE, FLAT, ROUND, type Cutter } from './shapes';
import { BLOCK, type Tops } from './tops';

export interface Segment {
  x0: number;
  y0: number;
  z0: number;
  x1: number;
  y1: number;
  z1: number;
}

/** The deepest contact of a move with the stock. */
export interface Contact {
  depth: number;
  x: number;
  y: number;
  z: number;
  /** Fraction of the move, 0 to 1. */
  part: number;
}

/** Contacts below this depth are ignored, because arcs are chords and numbers have 24 bits. [mm] */
export const CONTACT_MM = 0.02;
/** The height is level at the lowest point, so an error of the position causes a much smaller error of the height. */
const BISECTIONS = 14;

/** One move over a field. The object is used for all moves, so that moves do not allocate memory. */
export class Sweep {
  readonly contact: Contact = { depth: 0, x: 0, y: 0, z: 0, part: 0 };
  /** Number of cells examined since the start, a measure of the cost. */
  cells = 0;
  private length = 0;
  private dx = 0;
  private dy = 0;
  private rise = 0;
  private begin = 0;
  private end = 0;
  private move: Segment = { x0: 0, y0: 0, z0: 0, x1: 0, y1: 0, z1: 0 };
  private cutter: Cutter = { kind: FLAT, radius: 0, flat_radius: 0, corner: 0, slope: 0 };

  constructor(private readonly field: Field) {}

  /** `isContinued`: the same tool has already cut at the start of the move. `maker` 0: no material is removed. `watches`: finds the
   * deepest contact; contacts below CONTACT_MM are ignored. */
  run(move: Segment, cutter: Cutter, maker: number, isContinued: boolean, watches: boolean): void {
    const { field, contact } = this;
    contact.depth = 0;
    if (Math.min(move.z0, move.z1) >= field.top) {
      return;
    }
    this.prepare(move, cutter);
    const { radius } = cutter;
    const low = Math.min(move.y0, move.y1) - radius;
    const high = Math.max(move.y0, move.y1) + radius;
    const first = Math.max(0, Math.ceil((low - field.y0) / field.cell_y - 0.5));
    const last = Math.min(field.ny - 1, Math.floor((high - field.y0) / field.cell_y - 0.5));
    const isLevel = cutter.kind === FLAT && move.z0 === move.z1 && !watches && maker > 0;
    const isSkipped = isContinued && !watches && this.length > 0;
    for (let row = first; row <= last; ++row) {
      const y = field.y0 + (row + 0.5) * field.cell_y;
      this.span(y);
      if (isSkipped && this.rise >= 0) {
        this.cutBehind(y);
      }
      const from = Math.max(0, Math.ceil((this.begin - field.x0) / field.cell_x - 0.5));
      const to = Math.min(field.nx - 1, Math.floor((this.end - field.x0) / field.cell_x - 0.5));
      if (from > to) {
        continue;
      }
      this.cells += to - from + 1;
      if (isLevel) {
        this.level(row, from, to, move.z0, maker);
      } else {
        this.row(row, from, to, maker, isSkipped, watches);
      }
    }
  }

  /**
   * Checks whether a flat cylinder, such as a holder, touches the stock. It stops at the first block of cells
   * with a contact, because a holder is much larger than a tool and each move would examine all cells below
   * it.
   */
  look(move: Segment, cutter: Cutter, tops: Tops): void {
    const { field, contact } = this;
    contact.depth = 0;
    const lowest = Math.min(move.z0, move.z1);
    if (lowest >= field.top) {
      return;
    }
    this.prepare(move, cutter);
    const { radius } = cutter;
    const block = (value: number, low: number, cell: number, count: number): number => Math.min(Math.max(Math.floor((value - low) / cell / BLOCK), 0), count - 1);
    const [i0, i1] = [block(Math.min(move.x0, move.x1) - radius, field.x0, field.cell_x, tops.wide), block(Math.max(move.x0, move.x1) + radius, field.x0, field.cell_x, tops.wide)];
    const [j0, j1] = [block(Math.min(move.y0, move.y1) - radius, field.y0, field.cell_y, tops.high), block(Math.max(move.y0, move.y1) + radius, field.y0, field.cell_y, tops.high)];
    for (let j = j0; j <= j1; ++j) {
      for (let i = i0; i <= i1; ++i) {
        if (tops.isAbove(j * tops.wide + i, lowest + CONTACT_MM)) {
          this.lookInBlock(i * BLOCK, j * BLOCK);
          if (contact.depth > CONTACT_MM) {
            return;
          }
        }
      }
    }
  }

  private lookInBlock(column: number, first: number): void {
    const { field } = this;
    for (let row = first; row < Math.min(first + BLOCK, field.ny); ++row) {
      this.span(field.y0 + (row + 0.5) * field.cell_y);
      const from = Math.max(column, Math.ceil((this.begin - field.x0) / field.cell_x - 0.5));
      const to = Math.min(column + BLOCK - 1, field.nx - 1, Math.floor((this.end - field.x0) / field.cell_x - 0.5));
      if (from <= to) {
        this.cells += to - from + 1;
        this.row(row, from, to, 0, false, true);
      }
    }
  }

  private prepare(move: Segment, cutter: Cutter): void {
    this.move = move;
    this.cutter = cutter;
    const [x, y] = [move.x1 - move.x0, move.y1 - move.y0];
    this.length = Math.sqrt(x * x + y * y);
    const isVertical = this.length < 1e-7;
    this.length = isVertical ? 0 : this.length;
    this.dx = isVertical ? 1 : x / this.length;
    this.dy = isVertical ? 0 : y / this.length;
    this.rise = isVertical ? 0 : (move.z1 - move.z0) / this.length;
  }

  /** Range in a row of all points within the radius of the move: `begin` to `end`. */
  private span(y: number): void {
    const { move, dx, dy } = this;
    const { radius } = this.cutter;
    let [begin, end] = [Infinity, -Infinity];
    for (let side = 0; side < 2; ++side) {
      const off = y - (side === 0 ? move.y0 : move.y1);
      const half = radius * radius - off * off;
      if (half >= 0) {
        const x = side === 0 ? move.x0 : move.x1;
        const root = Math.sqrt(half);
        begin = Math.min(begin, x - root);
        end = Math.max(end, x + root);
      }
    }
    if (this.length > 0) {
      // The long sides of the rectangle between the two circles.
      for (let side = -1; side <= 1; side += 2) {
        const ya = move.y0 + side * radius * dx;
        const yb = move.y1 + side * radius * dx;
        if ((y - ya) * (y - yb) <= 0 && ya !== yb) {
          const x = move.x0 - side * radius * dy + ((y - ya) / (yb - ya)) * (move.x1 - move.x0);
          begin = Math.min(begin, x);
          end = Math.max(end, x);
        }
      }
    }
    this.begin = begin;
    this.end = end;
  }

  /** Omits cells behind the start of a move that does not descend, because the tool has cut them at its position. */
  private cutBehind(y: number): void {
    const { move, dx, dy } = this;
    const off = (y - move.y0) * dy;
    if (this.length === 0) {
      return;
    }
    if (Math.abs(dx) < 1e-9) {
      if (off < 0) {
        this.end = this.begin - 1;
      }
      return;
    }
    const at = move.x0 - off / dx;
    if (dx > 0) {
      this.begin = Math.max(this.begin, at);
    } else {
      this.end = Math.min(this.end, at);
    }
  }

  /** A flat tool at one height. */
  private level(row: number, from: number, to: number, z: number, maker: number): void {
    const { heights, makers, bottom, nx } = this.field;
    const base = row * nx;
    const height = Math.fround(Math.max(z, bottom));
    let isChanged = false;
    for (let at = base + from; at <= base + to; ++at) {
      if ((heights[at] as number) > height) {
        heights[at] = height;
        makers[at] = maker;
        isChanged = true;
      }
    }
    if (isChanged) {
      this.field.mark(row, from, to);
    }
  }

  private row(row: number, from: number, to: number, maker: number, isSkipped: boolean, watches: boolean): void {
    const { field, move, dx, dy, length, rise } = this;
    const { heights, makers, bottom, nx, cell_x } = field;
    const { radius } = this.cutter;
    const base = row * nx;
    const y = field.y0 + (row + 0.5) * field.cell_y - move.y0;
    const across0 = y * dx;
    const along0 = y * dy;
    const deep = move.z0 < move.z1 ? move.z0 : move.z1;
    let [low, high] = [to + 1, from - 1];
    for (let i = from; i <= to; ++i) {
      const height = heights[base + i] as number;
      if (height <= bottom || height <= deep) {
        continue;
      }
      const x = field.x0 + (i + 0.5) * cell_x - move.x0;
      const along = x * dx + along0;
      const across = across0 - x * dy;
      const square = across * across;
      const width = Math.sqrt(Math.max(0, radius * radius - square));
      const lower = Math.max(-along, -width);
      const upper = Math.min(length - along, width);
      const best = Math.min(Math.max(this.lowest(square, width), lower), upper);
      const gone = along + best;
      if (isSkipped && gone <= 0) {
        continue;
      }
      const distance = Math.sqrt(square + best * best);
      const z = (length > 0 ? move.z0 + rise * gone : deep) + this.surface(distance);
      if (z < height) {
        if (watches && distance < radius - CONTACT_MM) {
          const depth = height - z - this.surface(distance + CONTACT_MM) + this.surface(distance);
          if (depth > CONTACT_MM && depth > this.contact.depth) {
            this.note(depth, x + move.x0, y + move.y0, height, length > 0 ? gone / length : 1);
          }
        }
        if (maker > 0) {
          heights[base + i] = z < bottom ? bottom : z;
          makers[base + i] = maker;
          low = i < low ? i : low;
          high = i;
        }
      }
    }
    if (low <= high) {
      field.mark(row, low, high);
    }
  }

  private note(depth: number, x: number, y: number, z: number, part: number): void {
    const { contact } = this;
    contact.depth = depth;
    contact.x = x;
    contact.y = y;
    contact.z = z;
    contact.part = Math.min(Math.max(part, 0), 1);
  }

  private surface(distance: number): number {
    const { kind, flat_radius, slope, corner } = this.cutter;
    const beyond = distance - flat_radius;
    if (kind === FLAT || beyond <= 0) {
      return 0;
    }
    return kind === CONE ? slope * beyond : corner - Math.sqrt(Math.max(0, corner * corner - beyond * beyond));
  }

  /** Position along the move (relative to the foot of the cell) at which the tool cuts this cell lowest, without the ends of the move. */
  private lowest(square: number, width: number): number {
    const { rise, cutter } = this;
    if (rise === 0) {
      return 0;
    }
    const climb = Math.abs(rise);
    const way = rise > 0 ? -1 : 1;
    if (cutter.kind === FLAT) {
      return way * width;
    }
    if (cutter.kind === ROUND) {
      return (way * climb * width) / Math.sqrt(1 + climb * climb);
    }
    const flat = Math.sqrt(Math.max(0, cutter.flat_radius * cutter.flat_radius - square));
    if (cutter.kind === CONE) {
      const steep = cutter.slope * cutter.slope - climb * climb;
      const edge = steep > 0 ? (climb * Math.sqrt(square)) / Math.sqrt(steep) : width;
      return way * Math.max(flat, edge);
    }
    return way * this.lowestOfBull(square, flat, width, climb);
  }

  private lowestOfBull(square: number, flat: number, width: number, climb: number): number {
    const { flat_radius, corner } = this.cutter;
    let [low, high] = [flat, width];
    for (let i = 0; i < BISECTIONS; ++i) {
      const at = (low + high) / 2;
      const distance = Math.sqrt(square + at * at);
      const beyond = Math.min(Math.max(distance - flat_radius, 0), corner);
      const rest = Math.sqrt(corner * corner - beyond * beyond);
      if (beyond * at < climb * rest * distance) {
        low = at;
      } else {
        high = at;
      }
    }
    return (low + high) / 2;
  }
}
