// SPDX-License-Identifier: GPL-2.0-or-later
// Lengths of the simulation, which are millimetres, in the operator's unit.
import { decimalSeparator } from '../i18n/index.svelte';
import { formatNumber, parseNumber } from '../numbers';
import { lengthDecimals, shownUnit } from '../show.svelte';

const MM_PER_INCH = 25.4;

function factor(): number {
  return shownUnit() === 'mm' ? 1 : MM_PER_INCH;
}

export function showMm(value: number, decimals = lengthDecimals()): string {
  return formatNumber(value / factor(), decimals, decimalSeparator());
}

/** For a field: without trailing zeros. */
export function enterMm(value: number): string {
  return showMm(value).replace(/([.,]\d*?)0+$/, '$1').replace(/[.,]$/, '').replace('−', '-').trim();
}

/** Null if it is not a number. */
export function readMm(text: string): number | null {
  const value = parseNumber(text);
  return value === null ? null : value * factor();
}
