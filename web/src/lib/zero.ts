// SPDX-License-Identifier: GPL-2.0-or-later
// Work zeros: the lines that set and restore them, and the conditions for restoring.
import { AXIS_LETTERS, axisIndex, type Codes, type Offsets } from './status';

/** A zero that was set, and the zero that it replaced. */
export interface ZeroSet {
  /** Number of the coordinate system, 1 is G54. */
  system: number;
  letters: string[];
  /** Offsets of the coordinate system, in machine units. */
  before: number[];
  after: number[];
}

/** Tolerance for conversions between inches and millimetres. */
const TOLERANCE = 1e-6;
/** Digits of a restored offset: more than the machine resolves, and no exponent. */
const DIGITS = 9;

function isSame(a: readonly number[], b: readonly number[]): boolean {
  return [...AXIS_LETTERS].every((_, i) => Math.abs((a[i] ?? 0) - (b[i] ?? 0)) < TOLERANCE);
}

/** The current position becomes zero of the active coordinate system. */
export function zeroLine(letters: readonly string[]): string {
  return `G10 L20 P0 ${letters.map((letter) => `${letter}0`).join(' ')}`;
}

/** The change made by the zero; null if nothing changed. */
export function zeroSet(letters: readonly string[], before: Offsets, after: Offsets): ZeroSet | null {
  const isOther = before.g5x_index !== after.g5x_index || isSame(before.g5x, after.g5x);
  return isOther ? null : { system: before.g5x_index, letters: [...letters], before: [...before.g5x], after: [...after.g5x] };
}

/** True if the active coordinate system has not changed since. */
export function canRestore(zero: ZeroSet, offsets: Offsets): boolean {
  return offsets.g5x_index === zero.system && isSame(offsets.g5x, zero.after);
}

/** Restores the offsets of all axes of the machine, because in a rotated system a zero of X also changes Y. */
export function restoreLine(zero: ZeroSet, letters: readonly string[], inUnits: (value: number, letter: string) => number): string {
  return `G10 L2 P${zero.system} ${letters.map((letter) => `${letter}${inUnits(zero.before[axisIndex(letter)] ?? 0, letter).toFixed(DIGITS)}`).join(' ')}`;
}

const G91 = 910;

/** G91: an MDI line moves by a distance, not to a position. */
export function isIncremental(codes: Codes): boolean {
  return codes.g.includes(G91);
}

/** A rapid to zero of these axes, simultaneously. */
export function goLine(letters: readonly string[]): string {
  return `G0 ${letters.map((letter) => `${letter}0`).join(' ')}`;
}
