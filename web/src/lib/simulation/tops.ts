// SPDX-License-Identifier: GPL-2.0-or-later
// The highest cell of each block of a field. Heights only decrease while a program is prepared, so an
// outdated value is too high and never hides a contact.
import type { Field } from './field';

/** Cells along the side of a block. */
export const BLOCK = 16;

export class Tops {
  readonly wide: number;
  readonly high: number;
  private readonly values: Float32Array;

  constructor(private readonly field: Field) {
    this.wide = Math.ceil(field.nx / BLOCK);
    this.high = Math.ceil(field.ny / BLOCK);
    this.values = new Float32Array(this.wide * this.high).fill(field.top);
  }

  /** True if a block may be above a height. */
  isAbove(block: number, height: number): boolean {
    return (this.values[block] as number) > height && this.measure(block) > height;
  }

  private measure(block: number): number {
    const { field } = this;
    const [i0, j0] = [(block % this.wide) * BLOCK, Math.floor(block / this.wide) * BLOCK];
    const [i1, j1] = [Math.min(i0 + BLOCK, field.nx), Math.min(j0 + BLOCK, field.ny)];
    let top = -Infinity;
    for (let j = j0; j < j1; ++j) {
      for (let at = j * field.nx + i0; at < j * field.nx + i1; ++at) {
        top = Math.max(top, field.heights[at] as number);
      }
    }
    this.values[block] = top;
    return top;
  }
}
