// SPDX-License-Identifier: GPL-2.0-or-later
// Lengths in the operator's unit.
import { decimalSeparator } from './i18n/index.svelte';
import { machine } from './machine.svelte';
import { formatNumber } from './numbers';
import { prefs } from './prefs.svelte';
import { isDiameter } from './status';

const MM_PER_INCH = 25.4;

export function shownUnit(): 'mm' | 'inch' {
  return prefs.unit === 'machine' ? (machine.facts?.linear_unit ?? 'mm') : prefs.unit;
}

/** Factor from machine units to displayed lengths. */
export function shownFactor(): number {
  const unit = machine.facts?.linear_unit ?? 'mm';
  const shown = shownUnit();
  return unit === shown ? 1 : shown === 'mm' ? MM_PER_INCH : 1 / MM_PER_INCH;
}

export function lengthDecimals(): number {
  return shownUnit() === 'mm' ? 3 : 4;
}

export function showLength(value: number | null | undefined, decimals = lengthDecimals()): string {
  return formatNumber(value === null || value === undefined ? value : value * shownFactor(), decimals, decimalSeparator());
}

export function showNumber(value: number | null | undefined, decimals: number): string {
  return formatNumber(value, decimals, decimalSeparator());
}

export function showAngle(value: number | null | undefined): string {
  return formatNumber(value, 3, decimalSeparator());
}

const S_PER_MIN = 60;

/** Machine units per second as feeds per minute. */
export function showFeed(perSecond: number | null | undefined): string {
  const factor = shownFactor() * S_PER_MIN;
  return formatNumber(perSecond === null || perSecond === undefined ? perSecond : perSecond * factor, shownUnit() === 'mm' ? 0 : 1, decimalSeparator());
}

export function isLathe(): boolean {
  return machine.facts?.kind === 'lathe' || machine.facts?.kind === 'back_lathe';
}

/** Factor of positions along an axis: X of a lathe is shown as a diameter under G7. */
export function axisFactor(letter: string): number {
  return letter === 'X' && isLathe() && machine.status !== null && isDiameter(machine.status.codes) ? 2 : 1;
}

/** Axis label with a note about its values: for a lathe, whether X is a diameter or a radius. */
export function axisName(letter: string): string {
  return letter === 'X' && isLathe() ? (axisFactor(letter) === 2 ? 'X⌀' : 'X r') : letter;
}
