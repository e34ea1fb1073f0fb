// SPDX-License-Identifier: GPL-2.0-or-later
import { fill, type Values } from '../../i18n/text';
import { prefs } from '../../prefs.svelte';
import { de } from './de';
import { en, type ConvCatalogue, type ConvKey } from './en';
import { es } from './es';

const CATALOGUES: Record<string, ConvCatalogue> = { en, de, es };

/** A text of the forms in the operator's language. */
export function tc(key: ConvKey, values?: Values): string {
  return fill((CATALOGUES[prefs.language] ?? en)[key], values);
}

/** A text with a computed key; the key itself if there is no text (M30). */
export function named(key: string, otherwise = key): string {
  return key in en ? tc(key as ConvKey) : otherwise;
}

export type { ConvKey };
