// SPDX-License-Identifier: GPL-2.0-or-later
import { prefs } from '../prefs.svelte';
import { de } from './de';
import { en, type Catalogue, type TextKey } from './en';
import { es } from './es';
import { fill, type Values } from './text';

const CATALOGUES: Record<string, Catalogue> = { en, de, es };

/** A text in the operator's language. */
export function t(key: TextKey, values?: Values): string {
  return fill((CATALOGUES[prefs.language] ?? en)[key], values);
}

/** The decimal separator. */
export function decimalSeparator(): string {
  return prefs.language === 'en' ? '.' : ',';
}

export type { TextKey, Values };
