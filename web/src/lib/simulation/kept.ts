// SPDX-License-Identifier: GPL-2.0-or-later
// Input of the operator for the simulation: shapes of tools, and the stock of the last programs.
import type { ToolShape } from './shapes';
import type { Fixture, Stock } from './stock';

export interface KeptStock {
  file: string;
  stock: Stock;
  fixtures: Fixture[];
  floor_mm: number;
}

export interface KeptSimulation {
  colorBy: 'tool' | 'depth';
  /** By tool number: data that the tool table does not have. */
  tools: Record<string, Omit<ToolShape, 'diameter_mm'>>;
  /** Newest first. */
  stocks: KeptStock[];
}

export const MOST_STOCKS = 20;

export function withStock(kept: readonly KeptStock[], one: KeptStock): KeptStock[] {
  return [one, ...kept.filter((other) => other.file !== one.file)].slice(0, MOST_STOCKS);
}
