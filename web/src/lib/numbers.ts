// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers as people write them: one comma or point as decimal separator (A8). Also sums and fractions.

/** Blanks that persons and spreadsheets put between groups of three digits: plain, no-break, narrow and thin ones. */
const GROUPS = /^([+-]?\d{1,3})(?:[ \u00a0\u2007\u2009\u202f]\d{3})+(?=$|[.,])/;

/** The text without the blanks between groups of three digits before the decimal separator. */
function ungrouped(text: string): string {
  return text.replace(GROUPS, (digits) => digits.replace(/\s/g, ''));
}

/**
 * Null if the text is not a number, or has more than one separator. Blanks between groups of three digits are
 * ignored.
 */
function parsePlain(text: string): number | null {
  const trimmed = ungrouped(text.trim());
  if (!/^[+-]?(\d+([.,]\d*)?|[.,]\d+)$/.test(trimmed)) {
    return null;
  }
  const value = Number(trimmed.replace(',', '.'));
  return Number.isFinite(value) ? value : null;
}

/** Two numbers separated by a slash, of which the second is not zero, or one number. */
function parseTerm(text: string): number | null {
  const parts = text.split('/').map(parsePlain);
  const [first = null, second] = parts;
  if (parts.length === 1 || first === null) {
    return first;
  }
  const isFraction = parts.length === 2 && second !== undefined && second !== null && second !== 0;
  return isFraction ? first / second : null;
}

/** A sign before a term is part of the sum. The second number of a fraction has no sign. */
const TERMS = /([+-]?)([^+-]+)/g;

/** A whole number, a minus and a fraction, which is ambiguous: 3-1/8 may mean 3.125 or 2.875. */
export function isMixed(text: string): boolean {
  return /^\s*[+-]?\d+\s*-\s*\d+\s*\/\s*\d+\s*$/.test(text);
}

/**
 * A number, a fraction (1/2), or a sum or difference of them (10+2.5). Null for any other text: an operator
 * without two numbers, two operators in a row, brackets, products, and an ambiguous minus (isMixed).
 */
export function parseNumber(text: string): number | null {
  const trimmed = text.trim();
  if (isMixed(trimmed)) {
    return null;
  }
  const terms = [...trimmed.matchAll(TERMS)];
  if (terms.map((one) => one[0]).join('') !== trimmed) {
    return null;
  }
  let sum: number | null = null;
  for (const [, sign, term] of terms) {
    const value = parseTerm(term ?? '');
    if (value === null) {
      return null;
    }
    sum = (sum ?? 0) + (sign === '-' ? -value : value);
  }
  return sum !== null && Number.isFinite(sum) ? sum : null;
}

/** True for a fraction or a sum, whose value is shown beside it. */
export function isCalculated(text: string): boolean {
  return parseNumber(text) !== null && parsePlain(text) === null;
}

/** Only digits: a number of a tool or a pocket, from `least` to `most`. */
export function parseWhole(text: string, least: number, most: number): number | null {
  const digits = ungrouped(text.trim());
  const value = /^\d{1,9}$/.test(digits) ? Number(digits) : NaN;
  return value >= least && value <= most ? value : null;
}

/** Omits the minus sign of a zero. Returns a dash if there is no number. */
export function formatNumber(value: number | null | undefined, decimals: number, separator = '.'): string {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return '-';
  }
  const text = value.toFixed(decimals);
  const plain = /^-0(\.0*)?$/.test(text) ? text.slice(1) : text;
  return separator === '.' ? plain : plain.replace('.', separator);
}

export function formatDuration(seconds: number): string {
  const whole = Math.max(0, Math.round(seconds));
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const two = (n: number): string => String(n).padStart(2, '0');
  return h > 0 ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}`;
}

/** Whole percent; 100 only at the end. */
export function percentDone(total: number, left: number): number {
  const done = total > 0 ? (100 * (total - left)) / total : 0;
  return left > 0 ? Math.min(99, Math.max(0, Math.floor(done))) : 100;
}

export function formatBytes(bytes: number): string {
  const units = ['B', 'kB', 'MB', 'GB'];
  let value = bytes;
  let unit = 0;
  while (value >= 1000 && unit < units.length - 1) {
    value /= 1000;
    unit += 1;
  }
  return `${unit === 0 || value >= 100 ? value.toFixed(0) : value.toFixed(1)} ${units[unit]}`;
}
