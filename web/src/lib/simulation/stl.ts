// SPDX-License-Identifier: GPL-2.0-or-later
// Stock from an STL file, binary or text.
import type { Stock, Triple } from './stock';

export const MOST_TRIANGLES = 500_000;
const HEAD_BYTES = 84;
const TRIANGLE_BYTES = 50;
const NORMAL_BYTES = 12;

function readBinary(bytes: ArrayBuffer): Float32Array | null {
  if (bytes.byteLength < HEAD_BYTES) {
    return null;
  }
  const words = new DataView(bytes);
  const count = words.getUint32(80, true);
  if (count === 0 || count > MOST_TRIANGLES || bytes.byteLength < HEAD_BYTES + count * TRIANGLE_BYTES) {
    return null;
  }
  const numbers = new Float32Array(count * 9);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 9; ++k) {
      numbers[i * 9 + k] = words.getFloat32(HEAD_BYTES + i * TRIANGLE_BYTES + NORMAL_BYTES + k * 4, true);
    }
  }
  return numbers;
}

function readText(bytes: ArrayBuffer): Float32Array | null {
  const text = new TextDecoder().decode(bytes);
  const numbers: number[] = [];
  for (const match of text.matchAll(/\bvertex\s+(\S+)\s+(\S+)\s+(\S+)/gi)) {
    numbers.push(Number(match[1]), Number(match[2]), Number(match[3]));
    if (numbers.length > MOST_TRIANGLES * 9) {
      return null;
    }
  }
  return numbers.length > 0 && numbers.length % 9 === 0 ? Float32Array.from(numbers) : null;
}

/** Reads a mesh in work coordinates; `unit_mm`: length of the file's unit in mm. Null if it is not an STL file, has too many triangles,
 * or no volume. */
export function readStl(bytes: ArrayBuffer, unit_mm: number): Stock | null {
  // A text file begins with `solid`. Some binary files also do, so the length is compared with the number of triangles.
  const words = new DataView(bytes);
  const isBinary = bytes.byteLength >= HEAD_BYTES && bytes.byteLength === HEAD_BYTES + words.getUint32(80, true) * TRIANGLE_BYTES;
  const triangles = isBinary ? readBinary(bytes) : (readText(bytes) ?? readBinary(bytes));
  if (triangles === null || !triangles.every(Number.isFinite)) {
    return null;
  }
  const [low, high]: [Triple, Triple] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let i = 0; i < triangles.length; ++i) {
    const value = (triangles[i] as number) * unit_mm;
    triangles[i] = value;
    low[i % 3] = Math.min(low[i % 3] as number, value);
    high[i % 3] = Math.max(high[i % 3] as number, value);
  }
  for (let i = 0; i < triangles.length; ++i) {
    triangles[i] = (triangles[i] as number) - (low[i % 3] as number);
  }
  return low.every((one, axis) => (high[axis] as number) - one > 1e-3) ? { kind: 'mesh', low, high, triangles } : null;
}
