// SPDX-License-Identifier: GPL-2.0-or-later
// States of a field along the program. A checkpoint stores only the tiles that have changed since the
// previous one. If memory is short, every second checkpoint is removed.
import { TILE, type Field } from './field';

interface Version {
  checkpoint: number;
  heights: Float32Array;
  makers: Uint8Array;
}

const BYTES_PER_CELL = 5;

export class Checkpoints {
  /** Number of moves done at each checkpoint; increasing. The first is 0. */
  private moves: number[] = [];
  private readonly versions: Version[][];
  /** Version of each tile in the field, or -1 if it has changed since. */
  private bytes = 0;
  /** Number of moves between two checkpoints; doubled when memory is short. */
  stride = 1;

  constructor(
    private readonly field: Field,
    private readonly most_bytes: number,
  ) {
    this.versions = Array.from({ length: field.changed.length }, () => []);
  }

  get count(): number {
    return this.moves.length;
  }

  get last(): number {
    return this.moves[this.moves.length - 1] ?? -1;
  }

  /** Stores the field after this number of moves. */
  add(moves: number): void {
    const checkpoint = this.moves.length;
    this.moves.push(moves);
    const { changed } = this.field;
    for (let tile = 0; tile < changed.length; ++tile) {
      if (changed[tile] === 1) {
        const version = this.copy(tile, checkpoint);
        (this.versions[tile] as Version[]).push(version);
        this.bytes += version.heights.length * BYTES_PER_CELL;
      }
    }
    changed.fill(0);
    while (this.bytes > this.most_bytes && this.moves.length > 2) {
      this.thin();
    }
  }

  /** The last checkpoint at or before a number of moves. */
  before(moves: number): number {
    let [low, high] = [0, this.moves.length];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if ((this.moves[middle] as number) <= moves) {
        low = middle;
      } else {
        high = middle;
      }
    }
    return low;
  }

  movesOf(checkpoint: number): number {
    return this.moves[checkpoint] ?? 0;
  }

  /** Restores the field at a checkpoint. `shown`: the current checkpoint. Tiles that are the same in both are not copied. */
  restore(checkpoint: number, shown: number): void {
    const { field } = this;
    for (let tile = 0; tile < this.versions.length; ++tile) {
      const wanted = this.versionAt(tile, checkpoint);
      if (field.changed[tile] === 1 || wanted !== this.versionAt(tile, shown)) {
        this.put(tile, wanted as Version);
        field.unseen[tile] = 1;
        field.changed[tile] = 0;
      }
    }
  }

  private versionAt(tile: number, checkpoint: number): Version | undefined {
    const versions = this.versions[tile] as Version[];
    let [low, high] = [0, versions.length];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if ((versions[middle] as Version).checkpoint <= checkpoint) {
        low = middle;
      } else {
        high = middle;
      }
    }
    return versions[low];
  }

  private rows(tile: number): { column: number; row: number; wide: number; high: number } {
    const { nx, ny, tiles_x } = this.field;
    const [column, row] = [(tile % tiles_x) * TILE, Math.floor(tile / tiles_x) * TILE];
    return { column, row, wide: Math.min(TILE, nx - column), high: Math.min(TILE, ny - row) };
  }

  private copy(tile: number, checkpoint: number): Version {
    const { column, row, wide, high } = this.rows(tile);
    const { heights, makers, nx } = this.field;
    const version = { checkpoint, heights: new Float32Array(wide * high), makers: new Uint8Array(wide * high) };
    for (let j = 0; j < high; ++j) {
      const from = (row + j) * nx + column;
      version.heights.set(heights.subarray(from, from + wide), j * wide);
      version.makers.set(makers.subarray(from, from + wide), j * wide);
    }
    return version;
  }

  private put(tile: number, version: Version): void {
    const { column, row, wide, high } = this.rows(tile);
    const { heights, makers, nx } = this.field;
    for (let j = 0; j < high; ++j) {
      const to = (row + j) * nx + column;
      heights.set(version.heights.subarray(j * wide, (j + 1) * wide), to);
      makers.set(version.makers.subarray(j * wide, (j + 1) * wide), to);
    }
  }

  /** Removes every second checkpoint, but not the first and the last. */
  private thin(): void {
    const { length } = this.moves;
    const kept = this.moves.map((_, i) => i).filter((i) => i % 2 === 0 || i === length - 1);
    for (const versions of this.versions) {
      const left: Version[] = [];
      let at = 0;
      kept.forEach((old, fresh) => {
        let latest: Version | null = null;
        for (; at < versions.length && (versions[at] as Version).checkpoint <= old; ++at) {
          if (latest !== null) {
            this.bytes -= latest.heights.length * BYTES_PER_CELL;
          }
          latest = versions[at] as Version;
        }
        if (latest !== null) {
          left.push(latest);
          latest.checkpoint = fresh;
        }
      });
      versions.splice(0, versions.length, ...left);
    }
    this.moves = kept.map((i) => this.moves[i] as number);
    this.stride *= 2;
  }
}
