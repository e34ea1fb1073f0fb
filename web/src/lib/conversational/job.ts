// SPDX-License-Identifier: GPL-2.0-or-later
// A program of several operations: common settings, checks, and G-code.
import { en, type ConvKey } from './i18n/en';
import { nice, shortest } from './fields';
import { operationOf } from './registry';
import { num, word, type Context, type Fault, type Faults, type Field, type Operation, type TableTool, type Unit, type Values } from './types';
import { faultsOf, isShown } from './validate';
import { plain, Writer, type TracePoint } from './writer';

export const SYSTEMS = ['G54', 'G55', 'G56', 'G57', 'G58', 'G59', 'G59.1', 'G59.2', 'G59.3'];

export interface Step {
  type: string;
  values: Values;
}
export interface Job {
  version: 1;
  machine: 'mill' | 'lathe';
  name: string;
  unit: Unit;
  system: string;
  /** Z above all objects on the table, in the coordinate system [unit]. */
  safe: number;
  /** Lathe: diameter outside of which the tool path is free; `safe` is a Z in front of the part. */
  safeX?: number;
  /** Retract before a tool change and at the end: to Z 0 of the machine, or to the safe height. */
  retract: 'machine' | 'safe';
  end: 'M30' | 'M2';
  steps: Step[];
}

export function newJob(unit: Unit, machine: 'mill' | 'lathe' = 'mill'): Job {
  const common = { version: 1 as const, machine, name: '', unit, system: 'G54', end: 'M30' as const, steps: [] };
  return machine === 'mill' ? { ...common, safe: nice(unit, 25, 1), retract: 'machine' } : { ...common, safe: nice(unit, 50, 2), safeX: nice(unit, 80, 3), retract: 'safe' };
}

/** Data of the machine for the checks. */
export interface MachineFacts {
  tools: TableTool[] | null;
  maxFeed: number | null;
  maxSpeed: number | null;
}
export const NOTHING_KNOWN: MachineFacts = { tools: null, maxFeed: null, maxSpeed: null };

export function contextOf(job: Job, facts: MachineFacts): Context {
  return { unit: job.unit, safe: job.safe, safeX: job.safeX ?? 0, ...facts };
}

/** File names that are valid on every computer. */
const NAME = /^[\p{L}\p{N}][\p{L}\p{N} _.+-]*$/u;
const MOST_NAME = 60;

/** Faults of the fields that concern the whole program. */
export function jobFaults(job: Job): Faults {
  const faults: Faults = {};
  if (!NAME.test(job.name) || job.name.length > MOST_NAME) {
    faults['name'] = { key: job.name.trim() === '' ? 'fault.no_name' : job.name.length > MOST_NAME ? 'fault.long_name' : 'fault.name' };
  }
  if (!SYSTEMS.includes(job.system)) {
    faults['system'] = { key: 'fault.choice' };
  }
  const safe = safeFault(job);
  if (safe !== null) {
    faults['safe'] = safe;
  }
  if (job.machine === 'lathe' && !(Number.isFinite(job.safeX) && (job.safeX ?? 0) > 0 && (job.safeX ?? 0) <= nice(job.unit, 2000, 80))) {
    faults['safeX'] = { key: Number.isFinite(job.safeX) ? 'fault.above_zero' : 'fault.number' };
  }
  return faults;
}

function safeFault(job: Job): Fault | null {
  if (!Number.isFinite(job.safe)) {
    return { key: 'fault.number' };
  }
  const most = nice(job.unit, 2000, 80);
  if (Math.abs(job.safe) > most) {
    return { key: 'fault.at_most', values: { high: most } };
  }
  const tops = job.steps.map((one) => num(one.values, job.machine === 'mill' ? 'top' : 'z_start')).filter(Number.isFinite);
  const highest = Math.max(...tops);
  return tops.length > 0 && job.safe < highest + shortest(job.unit) ? { key: 'fault.safe_below', values: { top: highest } } : null;
}

/** Faults of each operation, in order. */
export function stepFaults(job: Job, facts: MachineFacts): Faults[] {
  const context = contextOf(job, facts);
  return job.steps.map((one, i): Faults => {
    const operation = operationOf(one.type);
    if (operation === null || operation.machine !== job.machine) {
      return { type: { key: 'fault.operation' } };
    }
    const faults = faultsOf(operation, one.values, context);
    const other = otherDiameter(job, i);
    return other === null || faults['diameter'] !== undefined ? faults : { ...faults, diameter: other };
  });
}

/** Checks that a tool has the same diameter in the whole program. */
function otherDiameter(job: Job, at: number): Fault | null {
  const tool = num(job.steps[at]?.values ?? {}, 'tool');
  const diameter = num(job.steps[at]?.values ?? {}, 'diameter');
  const other = job.steps.findIndex((one, i) => i < at && num(one.values, 'tool') === tool && Math.abs(num(one.values, 'diameter') - diameter) > 1e-6);
  return other < 0 ? null : { key: 'fault.tool_twice', values: { tool, number: other + 1, diameter: num(job.steps[other]?.values ?? {}, 'diameter') } };
}

export function isFaultless(job: Job, facts: MachineFacts): boolean {
  return job.steps.length > 0 && Object.keys(jobFaults(job)).length === 0 && stepFaults(job, facts).every((one) => Object.keys(one).length === 0);
}

const KINDS: Record<string, (unit: Unit) => string> = { length: (unit) => unit, feed: (unit) => `${unit}/min`, rev: (unit) => `${unit}/rev`, surface: (unit) => (unit === 'mm' ? 'm/min' : 'ft/min'), speed: () => 'rev/min', angle: () => 'deg', time: () => 's', count: () => '' };

/** The unit of a field. */
export function unitOf(field: Field, unit: Unit): string {
  return KINDS[field.kind]?.(unit) ?? '';
}

function text(key: string): string {
  return en[key as ConvKey] ?? key;
}

function shownValue(field: Field, values: Values, unit: Unit): string | null {
  if (field.kind === 'drawing' || field.kind === 'points') {
    return null;
  }
  if (field.kind === 'choice') {
    return text(`choice.${field.id}.${word(values, field.id)}`);
  }
  const value = values[field.id];
  return typeof value === 'number' ? `${plain(value, 5)} ${unitOf(field, unit)}`.trim() : String(value);
}

/** The parameters as comments, in English, because the program may be read at any machine. */
function parameters(writer: Writer, operation: Operation, values: Values): void {
  for (const field of operation.fields) {
    const shown = isShown(field, values) ? shownValue(field, values, writer.unit) : null;
    if (shown !== null) {
      writer.comment(`  ${text(`field.${field.id}`)}: ${shown}`);
    }
  }
}

const COOLANT: Record<string, string> = { flood: 'M8', mist: 'M7', off: 'M9' };

function toolText(values: Values, writer: Writer): string {
  const found = ['diameter', 'nose', 'tool_width'].find((id) => values[id] !== undefined) ?? '';
  return `${text(`field.${found}`).toLowerCase()} ${writer.number(num(values, found))}`;
}

function header(writer: Writer, job: Job): void {
  writer.comment(job.name);
  writer.comment(`Made by Millwright, conversational. Units: ${job.unit === 'mm' ? 'mm' : 'inch'}. Zero: ${job.system}. ${job.machine === 'mill' ? 'Safe height:' : `X is a diameter. Safe position: X${writer.number(job.safeX ?? 0)}`} Z${writer.number(job.safe)}`);
  const used = new Map(job.steps.map((one) => [num(one.values, 'tool'), toolText(one.values, writer)]));
  for (const [tool, shape] of used) {
    writer.comment(`Tool T${tool}: ${shape} ${job.unit}`);
  }
  writer.blank();
  writer.line(`${job.unit === 'mm' ? 'G21' : 'G20'} ${job.machine === 'mill' ? 'G17 G90 G94' : 'G18 G7 G90 G95'}`);
  writer.line('G40 G49 G80');
  // Corners remain within this distance of the path.
  writer.line(`G64 P${job.unit === 'mm' ? '0.01' : '0.0004'}`);
  writer.line(job.system);
}

function retract(writer: Writer, job: Job): void {
  writer.forget();
  if (job.retract === 'machine' && job.machine === 'mill') {
    writer.line('G53 G0 Z0');
  } else {
    if (job.machine === 'lathe') {
      writer.rapid({ x: job.safeX ?? 0 });
    }
    writer.rapid({ z: job.safe });
  }
}

function toolChange(writer: Writer, job: Job, values: Values, isFirst: boolean): void {
  const tool = num(values, 'tool');
  writer.line('M5 M9');
  // First cancels the length of the previous tool, because the height is in machine coordinates.
  if (!isFirst || (job.retract === 'machine' && job.machine === 'mill')) {
    retract(writer, job);
  }
  writer.line(`T${tool} M6`);
  writer.line(`G43 H${tool}`);
  retract(writer, job);
}

/** Moves between operations with rapids at the retract height, then straight down. */
function runStep(writer: Writer, job: Job, step: Step, context: Context, before: Step | undefined): void {
  const operation = operationOf(step.type);
  if (operation === null) {
    return;
  }
  const isChange = before === undefined || num(before.values, 'tool') !== num(step.values, 'tool');
  if (isChange) {
    toolChange(writer, job, step.values, before === undefined);
  } else if (word(before.values, 'coolant') !== word(step.values, 'coolant')) {
    writer.line('M9');
  }
  const isLeft = word(step.values, 'hand') === 'left' && step.type === 'tap';
  if (job.machine === 'lathe') {
    writer.line(word(step.values, 'speed_mode') === 'surface' ? `G96 D${plain(num(step.values, 'limit_speed'), 1)} S${plain(num(step.values, 'surface'), 2)} M3` : `G97 S${plain(num(step.values, 'speed'), 1)} M3`);
  } else {
    writer.line(`S${plain(num(step.values, 'speed'), 1)} ${isLeft ? 'M4' : 'M3'}`);
  }
  writer.line(COOLANT[word(step.values, 'coolant')] ?? 'M9');
  writer.forget();
  if (job.machine === 'lathe' && !isChange) {
    retract(writer, job);
  }
  operation.write(writer, step.values, context);
}

/** The path of one operation without faults, for its picture. */
export function traceOf(job: Job, step: Step, facts: MachineFacts): TracePoint[] {
  const writer = new Writer(job.unit, job.machine === 'lathe');
  operationOf(step.type)?.write(writer, step.values, contextOf(job, facts));
  return job.machine === 'mill' ? writer.trace : writer.trace.map((one) => ({ x: one.z, y: one.x / 2, z: 0, isRapid: one.isRapid }));
}

/** The G-code of a job without faults. */
export function programOf(job: Job, facts: MachineFacts): string {
  const writer = new Writer(job.unit, job.machine === 'lathe');
  const context = contextOf(job, facts);
  header(writer, job);
  for (const [i, step] of job.steps.entries()) {
    const operation = operationOf(step.type);
    writer.blank();
    writer.comment(`${i + 1}. ${text(`op.${step.type}`)}`);
    if (operation !== null) {
      parameters(writer, operation, step.values);
    }
    runStep(writer, job, step, context, job.steps[i - 1]);
  }
  writer.blank();
  writer.line('M5 M9');
  retract(writer, job);
  if (job.machine === 'lathe') {
    writer.line('G97 G94 G8');
  }
  writer.line(job.end);
  return `${writer.lines.join('\n')}\n`;
}
