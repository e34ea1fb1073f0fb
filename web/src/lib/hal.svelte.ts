// SPDX-License-Identifier: GPL-2.0-or-later
// HAL by docs/reference/api.md: objects, watched values, the oscilloscope.
import type { HalValue } from './link';

export interface HalName {
  name: string;
  kind: 'pin' | 'signal' | 'param';
  type: string;
  /** IN, OUT, I/O, RO, RW; empty for a signal. */
  dir: string;
  /** For a pin its signal, for a signal its pins. */
  link: string;
  value: HalValue;
  /** HAL accepts a value from a person. */
  canSet: boolean;
}

interface Told {
  pins: { name: string; type: string; dir: string; signal: string; value: HalValue }[];
  signals: { name: string; type: string; writers: number; pins: { name: string }[]; value: HalValue }[];
  params: { name: string; type: string; dir: string; value: HalValue }[];
}

export type Trigger = 'NONE' | 'RISING' | 'FALLING' | 'EITHER' | 'ABOVE' | 'BELOW';
export const TRIGGERS: Trigger[] = ['NONE', 'RISING', 'FALLING', 'EITHER', 'ABOVE', 'BELOW'];
export type ScopeState = 'CLOSED' | 'IDLE' | 'FILLING' | 'WAITING' | 'TRIGGERED' | 'DONE' | 'REFUSED';

export interface ScopeOrder {
  names: string[];
  samples: number;
  every: number;
  trigger: Trigger;
  trigger_name: string;
  level: number;
  pretrigger: number;
}

export interface ScopeRecord {
  names: string[];
  types: string[];
  times_s: number[];
  columns: (number | null)[][];
  moved: string[];
}

/** Names that this screen watches. They stay watched while another view is shown. */
export const watchList = $state<{ names: string[] }>({ names: [] });

async function ask<T>(method: string, path: string, body?: object): Promise<T> {
  const answer = await fetch(path, { method, ...(body === undefined ? {} : { body: JSON.stringify(body) }) });
  const told = (await answer.json()) as T & { error?: string };
  if (!answer.ok) {
    throw new Error(told.error ?? `${method} ${path}: ${answer.status}`);
  }
  return told;
}

export async function listHal(): Promise<HalName[]> {
  const told = await ask<Told>('GET', '/api/hal');
  const all: HalName[] = [
    ...told.pins.map((one) => ({ ...one, kind: 'pin' as const, link: one.signal, canSet: one.dir !== 'OUT' && one.signal === '' })),
    ...told.signals.map((one) => ({ ...one, kind: 'signal' as const, dir: '', link: one.pins.map((pin) => pin.name).join(' '), canSet: one.writers === 0 })),
    ...told.params.map((one) => ({ ...one, kind: 'param' as const, link: '', canSet: one.dir === 'RW' })),
  ];
  return all.sort((a, b) => a.name.localeCompare(b.name, 'en', { numeric: true }));
}

/** True if all words of `text` are in the name, its link or its type. */
export function matches(one: HalName, text: string): boolean {
  const whole = `${one.name} ${one.link} ${one.kind} ${one.type}`.toLowerCase();
  return text.toLowerCase().split(/\s+/).every((word) => whole.includes(word));
}

/** With `pulseMs` the server restores the old value after that time, so the value does not stay set if the page fails. */
export const setHal = (name: string, value: string, pulseMs = 0): Promise<unknown> =>
  ask('PUT', `/api/hal/${encodeURIComponent(name)}`, pulseMs > 0 ? { value, pulse_ms: pulseMs } : { value });

export const beginScope = (order: ScopeOrder): Promise<{ state: ScopeState }> => ask('POST', '/api/scope', order);
export const scopeState = (): Promise<{ state: ScopeState }> => ask('GET', '/api/scope');
export const endScope = (): Promise<{ state: ScopeState }> => ask('DELETE', '/api/scope');
export const forceScope = (): Promise<{ state: ScopeState }> => ask('POST', '/api/scope/force');
export const scopeRecord = (): Promise<ScopeRecord> => ask('GET', '/api/scope/record');

/** As comma-separated values: a header, then one line for each sample. */
export function csvOf(record: ScopeRecord): string {
  const lines = [['time_s', ...record.names].join(',')];
  record.times_s.forEach((time, i) => lines.push([time, ...record.columns.map((column) => column[i] ?? '')].join(',')));
  return `${lines.join('\n')}\n`;
}
