// SPDX-License-Identifier: GPL-2.0-or-later
// Messages between the page and the worker of the simulation.
import type { Picture } from './display';
import type { Finding } from './findings';
import type { Frame } from './moves';
import type { ToolShape } from './shapes';
import type { Box, Stock, Surroundings, Triple } from './stock';

/** `number` increases with each program; messages about an older one are dropped. */
export type Order =
  | { kind: 'open'; number: number; file: string; frame: Frame; first_tool: number; rapid_mm_s: number; times: { feed: number; rapid: number; max_velocity: number } }
  | { kind: 'prepare'; number: number; setup: Surroundings & { stock: Stock; tools: [number, ToolShape][] } }
  | { kind: 'show'; number: number; at: Position; most: number }
  | { kind: 'close'; number: number };

/**
 * A point of the program. `line`: its first move after the shown one, or its first move. `machine`: position
 * of a running machine.
 */
export type Position =
  | { moves: number }
  | { seconds: number }
  | { line: number }
  | { machine: { line: number; tip: Triple; isNew: boolean } };

export interface Facts {
  moves: number;
  lines: number;
  cuts: Box | null;
  tools: number[];
  /** The first line that moves A, B or C; null if there is none. */
  rotary_line: number | null;
  isCut: boolean;
  /** Errors of the interpreter. */
  errors: string[];
}

export interface Shown {
  moves: number;
  seconds: number;
  line: number;
  tip: Triple;
  tool: number;
  isRapid: boolean;
  picture: Picture;
  /** The requested line has no move. */
  isMissing: boolean;
}

export interface Prepared {
  findings: Finding[];
  dropped: number;
  unknown_tools: number[];
  makers: number[];
  cell_mm: number;
  removed_mm3: number;
  took_ms: number;
}

export type News =
  | { number: number; kind: 'reading'; points: number }
  | { number: number; kind: 'read'; facts: Facts }
  | { number: number; kind: 'preparing'; part: number }
  | { number: number; kind: 'prepared'; prepared: Prepared }
  | { number: number; kind: 'clock'; total_s: number; isPlanned: boolean }
  | { number: number; kind: 'shown'; shown: Shown }
  | { number: number; kind: 'failed'; reason: string };
