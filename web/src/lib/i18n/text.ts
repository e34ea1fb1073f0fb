// SPDX-License-Identifier: GPL-2.0-or-later
import type { Catalogue } from './en';

export type Values = Record<string, string | number>;

/** Replaces the placeholders of a text. A missing value remains visible as {name}. */
export function fill(text: string, values: Values = {}): string {
  return text.replace(/\{(\w+)\}/g, (place, name: string) => (name in values ? String(values[name]) : place));
}

export function placesOf(text: string): string[] {
  return [...text.matchAll(/\{(\w+)\}/g)].map((match) => match[1] ?? '').sort();
}

export type { Catalogue };
