// SPDX-License-Identifier: GPL-2.0-or-later
// A job as typed by the operator. Only typed values are stored, so that defaults follow the values on which
// they depend.
import { parseNumber } from '../numbers';
import type { Job, MachineFacts, Step } from './job';
import { contextOf } from './job';
import { operationOf } from './registry';
import type { Context, Field, Operation, Unit, Values } from './types';
import { filled } from './validate';
import { plain } from './writer';

export interface StepTexts {
  /** Unique within this page; constant when the step moves. */
  id: number;
  type: string;
  texts: Record<string, string>;
}
export interface JobTexts extends Omit<Job, 'safe' | 'safeX' | 'steps'> {
  safe: string;
  safeX?: string;
  steps: StepTexts[];
}

const isNumeric = (field: Field): boolean => 'limits' in field;

/** Null for an operation of another version. */
function typedValues(operation: Operation, texts: Record<string, string>): Values {
  const values: Values = {};
  for (const field of operation.fields) {
    const text = texts[field.id];
    if (text !== undefined) {
      values[field.id] = isNumeric(field) ? (parseNumber(text) ?? NaN) : text;
    }
  }
  return values;
}

export function valuesOf(step: StepTexts, context: Context): Values {
  const operation = operationOf(step.type);
  return operation === null ? {} : filled(operation, typedValues(operation, step.texts), context);
}

export function jobOf(texts: JobTexts, facts: MachineFacts): Job {
  const job: Job = { ...texts, name: texts.name.trim(), safe: parseNumber(texts.safe) ?? NaN, safeX: parseNumber(texts.safeX ?? '') ?? NaN, steps: [] };
  if (texts.machine === 'mill') {
    delete job.safeX;
  }
  const context = contextOf(job, facts);
  job.steps = texts.steps.map((one): Step => ({ type: one.type, values: valuesOf(one, context) }));
  return job;
}

export function textOf(value: number | string | undefined, separator = '.'): string {
  if (typeof value === 'number') {
    return Number.isFinite(value) ? plain(value, 5).replace('.', separator) : '';
  }
  return value ?? '';
}

/** Converts a stored job to the form; each value counts as typed. */
export function textsOf(job: Job, separator = '.'): JobTexts {
  const steps = job.steps.map((one, id) => ({ id, type: one.type, texts: Object.fromEntries(Object.entries(one.values).map(([key, value]) => [key, textOf(value, separator)])) }));
  const { safeX, ...others } = job;
  return { ...others, safe: textOf(job.safe, separator), ...(safeX === undefined ? {} : { safeX: textOf(safeX, separator) }), steps };
}

/** Lengths and feeds keep their size when the unit changes. */
export function converted(texts: JobTexts, unit: Unit, separator = '.'): JobTexts {
  if (unit === texts.unit) {
    return texts;
  }
  const factor = unit === 'mm' ? 25.4 : 1 / 25.4;
  const change = (text: string): string => {
    const value = parseNumber(text);
    return value === null ? text : plain(value * factor, unit === 'mm' ? 4 : 5).replace('.', separator);
  };
  const steps = texts.steps.map((step) => {
    const fields = operationOf(step.type)?.fields ?? [];
    const isLength = (id: string): boolean => fields.some((field) => field.id === id && (field.kind === 'length' || field.kind === 'feed' || field.kind === 'rev'));
    return { ...step, texts: Object.fromEntries(Object.entries(step.texts).map(([id, text]) => [id, isLength(id) ? change(text) : text])) };
  });
  return { ...texts, unit, safe: change(texts.safe), ...(texts.safeX === undefined ? {} : { safeX: change(texts.safeX) }), steps };
}

const GROUPS: Record<string, string> = {
  top: 'depth', depth: 'depth', clearance: 'depth', step_down: 'depth', depth_at: 'depth', tip_angle: 'depth', peck: 'depth',
  tool: 'tool', diameter: 'tool', speed: 'tool', feed: 'tool', feed_z: 'tool', coolant: 'tool',
  nose: 'tool', tool_width: 'tool', tool_edge: 'tool', speed_mode: 'tool', surface: 'tool', limit_speed: 'tool', feed_rev: 'tool', cut: 'cut', first_cut: 'cut', springs: 'cut', back_off: 'depth',
  step_over: 'cut', allowance: 'cut', floor_allowance: 'cut', direction: 'cut', face_direction: 'cut', entry: 'cut', ramp_angle: 'cut', cycle: 'cut', dwell: 'cut', between: 'cut', tapping: 'cut', boring: 'cut', passes: 'cut',
};
export const GROUP_ORDER = ['shape', 'depth', 'tool', 'cut'] as const;
export type Group = (typeof GROUP_ORDER)[number];

/** Group of a field in a form. */
export function groupOf(field: Field): Group {
  return (GROUPS[field.id] ?? 'shape') as Group;
}
