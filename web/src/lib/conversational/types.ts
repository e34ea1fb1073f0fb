// SPDX-License-Identifier: GPL-2.0-or-later
// Operations of conversational programming, declared as data: a form, its checks and the writer of its G-code.
import type { ConvKey } from './i18n/en';
import type { Writer } from './writer';

export type Unit = 'mm' | 'inch';
/** Values of a form, by field. A number that was not typed correctly is NaN. */
export type Values = Record<string, number | string>;

export interface TableTool {
  number: number;
  /** In the unit of the program; 0: unknown. */
  diameter: number;
}

/** Data from outside the form of one operation. */
export interface Context {
  unit: Unit;
  /** Z of moves between operations [unit]. */
  safe: number;
  /** Lathe: diameter of moves between operations [unit]. */
  safeX: number;
  /** Null: the tool table is not known. */
  tools: TableTool[] | null;
  /** Maximum feed of the machine [unit/min] and maximum spindle speed [rev/min]; null: not known. */
  maxFeed: number | null;
  maxSpeed: number | null;
}

/** Reason why a value is rejected: a text and its parameters. */
export interface Fault {
  key: ConvKey;
  values?: Record<string, string | number>;
}
/** By field. */
export type Faults = Record<string, Fault>;

/** A bound of a number. `isOpen`: the bound itself is rejected. */
export interface Limit {
  low?: number;
  high?: number;
  isOpen?: boolean;
  key: ConvKey;
  values?: Record<string, string | number>;
}

/** `rev`: length per revolution. `surface`: m/min or ft/min. */
export type NumberKind = 'length' | 'feed' | 'rev' | 'surface' | 'speed' | 'angle' | 'count' | 'time';

interface FieldBase {
  id: string;
  /** If false, the field is not shown, not checked and not used. */
  isShown?: (values: Values) => boolean;
}
export interface NumberField extends FieldBase {
  kind: NumberKind;
  preset: (values: Values, context: Context) => number;
  /** Reason for the default. */
  reason?: ConvKey;
  limits: (values: Values, context: Context) => Limit[];
}
export interface ChoiceField extends FieldBase {
  kind: 'choice';
  options: string[];
  preset: string;
  reason?: ConvKey;
}
export interface TextField extends FieldBase {
  kind: 'text' | 'points' | 'drawing' | 'layer';
  preset: string;
  reason?: ConvKey;
  check: (text: string, values: Values, context: Context) => Fault | null;
}
export type Field = NumberField | ChoiceField | TextField;

export interface Operation {
  id: string;
  machine: 'mill' | 'lathe';
  fields: Field[];
  /** Faults that concern several fields, reported at one of them. Called only if each field alone is correct. */
  check?: (values: Values, context: Context) => Faults;
  /** Writes the moves. The values have no fault, the tool is above the safe height, and the spindle runs. */
  write: (writer: Writer, values: Values, context: Context) => void;
}

export function num(values: Values, id: string): number {
  const value = values[id];
  return typeof value === 'number' ? value : NaN;
}

export function word(values: Values, id: string): string {
  const value = values[id];
  return typeof value === 'string' ? value : '';
}
