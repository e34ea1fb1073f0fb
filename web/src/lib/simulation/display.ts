// SPDX-License-Identifier: GPL-2.0-or-later
// The field with fewer cells for drawing. Each cell has the lowest of its cells, so that narrow grooves
// remain visible. Only changed tiles are calculated again.
import { TILE, type Field } from './field';

export interface Picture {
  nx: number;
  ny: number;
  /** Size of a cell of the picture. [mm] */
  cell_x: number;
  cell_y: number;
  heights: Float32Array;
  makers: Uint8Array;
}

/** With at most `most` cells along a side. */
export function reduced(picture: Picture, most: number): Picture {
  const { nx, ny } = picture;
  const factor = Math.max(1, Math.ceil(Math.max(nx, ny) / most));
  const [wide, high] = [Math.ceil(nx / factor), Math.ceil(ny / factor)];
  const small: Picture = { nx: wide, ny: high, cell_x: picture.cell_x * factor, cell_y: picture.cell_y * factor, heights: new Float32Array(wide * high).fill(Infinity), makers: new Uint8Array(wide * high) };
  for (let j = 0; j < ny; ++j) {
    for (let i = 0; i < nx; ++i) {
      const to = Math.floor(j / factor) * wide + Math.floor(i / factor);
      const height = picture.heights[j * nx + i] as number;
      if (height < (small.heights[to] as number)) {
        small.heights[to] = height;
        small.makers[to] = picture.makers[j * nx + i] as number;
      }
    }
  }
  return small;
}

interface Level {
  /** Cells of the field along a side of a cell of the picture. */
  factor: number;
  nx: number;
  ny: number;
  heights: Float32Array;
  makers: Uint8Array;
  stale: Uint8Array;
}

export class Display {
  private readonly levels = new Map<number, Level>();

  constructor(private readonly field: Field) {}

  /** With at most `most` cells along a side. */
  picture(most: number): Picture {
    const { field } = this;
    const level = this.level(most);
    for (const one of this.levels.values()) {
      field.unseen.forEach((isUnseen, tile) => {
        if (isUnseen === 1) {
          one.stale[tile] = 1;
        }
      });
    }
    field.unseen.fill(0);
    level.stale.forEach((isStale, tile) => {
      if (isStale === 1) {
        this.reduce(level, tile);
      }
    });
    level.stale.fill(0);
    const { nx, ny, factor } = level;
    return { nx, ny, cell_x: factor * field.cell_x, cell_y: factor * field.cell_y, heights: level.heights.slice(), makers: level.makers.slice() };
  }

  private level(most: number): Level {
    const { field } = this;
    let factor = 1;
    while (factor < TILE && Math.max(field.nx, field.ny) / factor > most) {
      factor *= 2;
    }
    let level = this.levels.get(factor);
    if (level === undefined) {
      const [nx, ny] = [Math.ceil(field.nx / factor), Math.ceil(field.ny / factor)];
      level = { factor, nx, ny, heights: new Float32Array(nx * ny), makers: new Uint8Array(nx * ny), stale: new Uint8Array(field.unseen.length).fill(1) };
      this.levels.set(factor, level);
    }
    return level;
  }

  private reduce(level: Level, tile: number): void {
    const { field } = this;
    const { factor } = level;
    const [first_x, first_y] = [(tile % field.tiles_x) * TILE, Math.floor(tile / field.tiles_x) * TILE];
    const [last_x, last_y] = [Math.min(first_x + TILE, field.nx), Math.min(first_y + TILE, field.ny)];
    for (let y = first_y; y < last_y; y += factor) {
      for (let x = first_x; x < last_x; x += factor) {
        let [lowest, at] = [Infinity, 0];
        for (let j = y; j < Math.min(y + factor, last_y); ++j) {
          const row = j * field.nx;
          for (let i = x; i < Math.min(x + factor, last_x); ++i) {
            const height = field.heights[row + i] as number;
            if (height < lowest) {
              lowest = height;
              at = row + i;
            }
          }
        }
        const to = (y / factor) * level.nx + x / factor;
        level.heights[to] = lowest;
        level.makers[to] = field.makers[at] as number;
      }
    }
  }
}
