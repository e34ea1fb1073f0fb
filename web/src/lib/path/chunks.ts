// SPDX-License-Identifier: GPL-2.0-or-later
// The streams of /api/path and /api/times: chunks of moves, bounds, errors, times and the end, as in
// docs/reference/api.md.
import type { TimeSum } from './times';
import type { TimedMoves } from './times_worker';

export interface Moves {
  kind: 'moves';
  count: number;
  /** x, y, z of each point. */
  places: Float32Array;
  lines: Uint32Array;
  /** 0 rapid, 1 feed, 2 arc, 3 probe; type of the move that ends at the point. */
  kinds: Uint8Array;
  /** Colour of each point, see shades.ts. */
  shades: Uint8Array;
}

export type Chunk =
  | Moves
  | (Omit<Moves, 'kind'> & { kind: 'wires' })
  | { kind: 'ranges'; first: Uint32Array; feed: Float32Array; tool: Uint32Array }
  | { kind: 'times'; moves: TimedMoves }
  | { kind: 'time_sum'; sum: TimeSum }
  | { kind: 'bounds'; low: [number, number, number]; high: [number, number, number] }
  | { kind: 'offsets'; first: Uint32Array; xyz: Float32Array }
  | { kind: 'rotary'; line: number }
  | { kind: 'end'; line: number; points: number }
  | { kind: 'error'; text: string };

const HEAD_BYTES = 8;

/** Its arrays refer to the bytes of the chunk, so a long path is not copied again. */
function readMoves(words: DataView): Moves {
  const count = words.getUint32(0, true);
  const places = 4;
  const lines = places + count * 12;
  const kinds = lines + count * 4;
  if (kinds + count > words.byteLength) {
    throw new Error('a chunk of the path is shorter than it says');
  }
  const [buffer, at] = [words.buffer as ArrayBuffer, words.byteOffset];
  return {
    kind: 'moves',
    count,
    places: new Float32Array(buffer, at + places, count * 3),
    lines: new Uint32Array(buffer, at + lines, count),
    kinds: new Uint8Array(buffer, at + kinds, count),
    shades: new Uint8Array(count),
  };
}

const RANGE_BYTES = 12;

function readRanges(words: DataView): Chunk {
  const count = words.getUint32(0, true);
  if (4 + count * RANGE_BYTES > words.byteLength) {
    throw new Error('a chunk of the path is shorter than it says');
  }
  const ranges = { kind: 'ranges' as const, first: new Uint32Array(count), feed: new Float32Array(count), tool: new Uint32Array(count) };
  for (let i = 0; i < count; ++i) {
    const at = 4 + i * RANGE_BYTES;
    ranges.first[i] = words.getUint32(at, true);
    ranges.feed[i] = words.getFloat32(at + 4, true);
    ranges.tool[i] = words.getUint32(at + 8, true);
  }
  return ranges;
}

const OFFSET_BYTES = 16;

function readOffsets(words: DataView): Chunk {
  const count = words.getUint32(0, true);
  if (4 + count * OFFSET_BYTES > words.byteLength) {
    throw new Error('a chunk of tool offsets is shorter than its count');
  }
  const offsets = { kind: 'offsets' as const, first: new Uint32Array(count), xyz: new Float32Array(count * 3) };
  for (let i = 0; i < count; ++i) {
    const at = 4 + i * OFFSET_BYTES;
    offsets.first[i] = words.getUint32(at, true);
    for (let axis = 0; axis < 3; ++axis) {
      offsets.xyz[i * 3 + axis] = words.getFloat32(at + 4 + axis * 4, true);
    }
  }
  return offsets;
}

const MOVE_BYTES = 16;

function readTimes(words: DataView): TimedMoves {
  const count = words.getUint32(0, true);
  if (4 + count * MOVE_BYTES > words.byteLength) {
    throw new Error('a chunk of times is shorter than it says');
  }
  const moves = { points: new Uint32Array(count), lines: new Uint32Array(count), seconds: new Float32Array(count), velocities: new Float32Array(count) };
  for (let i = 0; i < count; ++i) {
    const at = 4 + i * MOVE_BYTES;
    moves.points[i] = words.getUint32(at, true);
    moves.lines[i] = words.getUint32(at + 4, true);
    moves.seconds[i] = words.getFloat32(at + 8, true);
    moves.velocities[i] = words.getFloat32(at + 12, true);
  }
  return moves;
}

function readChunk(kind: number, words: DataView): Chunk {
  const three = (at: number): [number, number, number] => [
    words.getFloat32(at, true),
    words.getFloat32(at + 4, true),
    words.getFloat32(at + 8, true),
  ];
  switch (kind) {
    case 1:
      return readMoves(words);
    case 2:
      return { kind: 'bounds', low: three(0), high: three(12) };
    case 3:
      return { kind: 'end', line: words.getUint32(0, true), points: words.getUint32(4, true) };
    case 4:
      return { kind: 'error', text: new TextDecoder().decode(words).trimEnd() };
    case 5:
      return readRanges(words);
    case 6:
      return { ...readMoves(words), kind: 'wires' };
    case 7:
      return { kind: 'times', moves: readTimes(words) };
    case 8:
      return { kind: 'time_sum', sum: JSON.parse(new TextDecoder().decode(words)) as TimeSum };
    case 9:
      return readOffsets(words);
    case 10:
      return { kind: 'rotary', line: words.getUint32(0, true) };
    default:
      throw new Error(`the path has a chunk of the unknown kind ${kind}`);
  }
}

/** Receives bytes, and returns complete chunks. */
export class ChunkReader {
  private pieces: Uint8Array[] = [];
  private bytes = 0;

  take(piece: Uint8Array): Chunk[] {
    this.pieces.push(piece);
    this.bytes += piece.length;
    const chunks: Chunk[] = [];
    for (;;) {
      const size = this.sizeOfNext();
      if (size === null || this.bytes < size) {
        return chunks;
      }
      const whole = this.cut(size);
      const kind = new DataView(whole).getUint32(0, true);
      chunks.push(readChunk(kind, new DataView(whole, HEAD_BYTES)));
    }
  }

  /** False while a chunk is incomplete. */
  get isWhole(): boolean {
    return this.bytes === 0;
  }

  private sizeOfNext(): number | null {
    if (this.bytes < HEAD_BYTES) {
      return null;
    }
    const first = this.pieces[0];
    if (first === undefined || first.length < HEAD_BYTES) {
      this.join();
    }
    const head = this.pieces[0] as Uint8Array;
    return HEAD_BYTES + new DataView(head.buffer, head.byteOffset).getUint32(4, true);
  }

  private join(): void {
    const whole = new Uint8Array(this.bytes);
    let at = 0;
    for (const piece of this.pieces) {
      whole.set(piece, at);
      at += piece.length;
    }
    this.pieces = [whole];
  }

  private cut(size: number): ArrayBuffer {
    const whole = new Uint8Array(size);
    let at = 0;
    while (at < size) {
      const piece = this.pieces[0] as Uint8Array;
      const taken = piece.subarray(0, size - at);
      whole.set(taken, at);
      at += taken.length;
      if (taken.length < piece.length) {
        this.pieces[0] = piece.subarray(taken.length);
      } else {
        this.pieces.shift();
      }
    }
    this.bytes -= size;
    return whole.buffer;
  }
}

/** Fills the buffer of the reader; returns null if the stream ends before that. */
async function fill(reader: ReadableStreamBYOBReader, size: number): Promise<ArrayBuffer | null> {
  let buffer = new ArrayBuffer(size);
  let at = 0;
  while (at < size) {
    const { done, value } = await reader.read(new Uint8Array(buffer, at, size - at));
    if (done || value === undefined) {
      if (at > 0) {
        throw new Error('the stream has ended in the middle of a chunk');
      }
      return null;
    }
    buffer = value.buffer;
    at += value.length;
  }
  return buffer;
}

/** Reads into preallocated buffers, so that reading leaves no garbage. */
async function* readInto(reader: ReadableStreamBYOBReader): AsyncGenerator<Chunk> {
  for (;;) {
    const head = await fill(reader, HEAD_BYTES);
    if (head === null) {
      return;
    }
    const told = new DataView(head);
    const size = told.getUint32(4, true);
    const words = await fill(reader, size);
    if (words === null && size > 0) {
      throw new Error('the stream has ended in the middle of a chunk');
    }
    yield readChunk(told.getUint32(0, true), new DataView(words ?? new ArrayBuffer(0)));
  }
}

async function* readPieces(reader: ReadableStreamDefaultReader<Uint8Array>): AsyncGenerator<Chunk> {
  const chunks = new ChunkReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) {
      break;
    }
    yield* chunks.take(value);
  }
  if (!chunks.isWhole) {
    throw new Error('the stream has ended in the middle of a chunk');
  }
}

function bytesReader(body: ReadableStream<Uint8Array>): ReadableStreamBYOBReader | null {
  try {
    return body.getReader({ mode: 'byob' });
  } catch {
    return null; // its byte streams do not accept buffers
  }
}

/** All chunks of a stream, as they arrive. */
export function readChunks(body: ReadableStream<Uint8Array>): AsyncGenerator<Chunk> {
  const reader = bytesReader(body);
  return reader === null ? readPieces(body.getReader()) : readInto(reader);
}
