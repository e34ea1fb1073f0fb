// SPDX-License-Identifier: GPL-2.0-or-later
// The stock as a field of heights: one height for each cell, exact at the middle of the cell. Tiles record
// changes.
import type { Stock } from './stock';

/** Cells along the side of a tile; a power of two. */
export const TILE = 64;
export const MOST_CELLS = 4_000_000;
const MOST_TILES = 1 << 16;

/** Number for a surface that no tool has cut. */
export const UNCUT = 0;

export class Field {
  readonly nx: number;
  readonly ny: number;
  readonly tiles_x: number;
  readonly tiles_y: number;
  readonly heights: Float32Array;
  /** 1 and up: tools in the order in which the program uses them. */
  readonly makers: Uint8Array;
  readonly bottom: number;
  readonly top: number;
  readonly x0: number;
  readonly y0: number;
  /** Sizes of a cell; a whole number of cells fills the stock. */
  readonly cell_x: number;
  readonly cell_y: number;
  /** Changed since the last checkpoint, and since the last picture. */
  readonly changed: Uint8Array;
  readonly unseen: Uint8Array;

  constructor(
    readonly stock: Stock,
    /** Requested size of a cell. */
    readonly cell: number,
  ) {
    [this.x0, this.y0] = stock.low;
    this.nx = Math.max(1, Math.ceil((stock.high[0] - stock.low[0]) / cell - 1e-9));
    this.ny = Math.max(1, Math.ceil((stock.high[1] - stock.low[1]) / cell - 1e-9));
    this.cell_x = (stock.high[0] - stock.low[0]) / this.nx;
    this.cell_y = (stock.high[1] - stock.low[1]) / this.ny;
    this.bottom = Math.fround(stock.low[2]);
    this.top = Math.fround(stock.high[2]);
    this.tiles_x = Math.ceil(this.nx / TILE);
    this.tiles_y = Math.ceil(this.ny / TILE);
    if (this.tiles_x * this.tiles_y > MOST_TILES) {
      throw new Error('The field of the simulation has too many cells.');
    }
    this.heights = new Float32Array(this.nx * this.ny);
    this.makers = new Uint8Array(this.nx * this.ny);
    this.changed = new Uint8Array(this.tiles_x * this.tiles_y);
    this.unseen = new Uint8Array(this.tiles_x * this.tiles_y);
    this.fill();
  }

  private fill(): void {
    this.makers.fill(UNCUT);
    this.heights.fill(this.top);
    this.changed.fill(1);
    this.unseen.fill(1);
    if (this.stock.kind === 'box') {
      return;
    }
    if (this.stock.kind === 'mesh') {
      this.fillMesh(this.stock.triangles ?? new Float32Array());
      return;
    }
    for (let j = 0; j < this.ny; ++j) {
      for (let i = 0; i < this.nx; ++i) {
        if (!this.isInCylinder(i, j)) {
          this.heights[j * this.nx + i] = this.bottom;
        }
      }
    }
  }

  /** Fills in the upper side of all triangles. */
  private fillMesh(triangles: Float32Array): void {
    this.heights.fill(this.bottom);
    for (let at = 0; at + 9 <= triangles.length; at += 9) {
      const [ax, ay, az, bx, by, bz, cx, cy, cz] = triangles.subarray(at, at + 9) as unknown as [number, number, number, number, number, number, number, number, number];
      const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
      if (Math.abs(area) < 1e-12) {
        continue; // it is vertical
      }
      const first = Math.max(0, Math.ceil(Math.min(ay, by, cy) / this.cell_y - 0.5));
      const last = Math.min(this.ny - 1, Math.floor(Math.max(ay, by, cy) / this.cell_y - 0.5));
      const from = Math.max(0, Math.ceil(Math.min(ax, bx, cx) / this.cell_x - 0.5));
      const to = Math.min(this.nx - 1, Math.floor(Math.max(ax, bx, cx) / this.cell_x - 0.5));
      for (let j = first; j <= last; ++j) {
        const y = (j + 0.5) * this.cell_y;
        for (let i = from; i <= to; ++i) {
          const x = (i + 0.5) * this.cell_x;
          const b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area;
          const c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area;
          if (b >= -1e-9 && c >= -1e-9 && b + c <= 1 + 1e-9) {
            const height = this.bottom + az + b * (bz - az) + c * (cz - az);
            const cell = j * this.nx + i;
            this.heights[cell] = Math.max(this.heights[cell] as number, height);
          }
        }
      }
    }
  }

  private isInCylinder(i: number, j: number): boolean {
    const { low, high } = this.stock;
    const [x, y] = [this.x0 + (i + 0.5) * this.cell_x, this.y0 + (j + 0.5) * this.cell_y];
    const radius = Math.min(high[0] - low[0], high[1] - low[1]) / 2;
    return Math.hypot(x - (low[0] + high[0]) / 2, y - (low[1] + high[1]) / 2) <= radius;
  }

  /** Records a change of cells in a row. */
  mark(row: number, first: number, last: number): void {
    const base = (row >> 6) * this.tiles_x;
    for (let tile = first >> 6; tile <= last >> 6; ++tile) {
      this.changed[base + tile] = 1;
      this.unseen[base + tile] = 1;
    }
  }

  /** Volume of the remaining stock. [mm³] */
  volume(): number {
    let sum = 0;
    for (const height of this.heights) {
      sum += height - this.bottom;
    }
    return sum * this.cell_x * this.cell_y;
  }
}
