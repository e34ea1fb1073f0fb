// SPDX-License-Identifier: GPL-2.0-or-later
// Checks the values of a form: one fault for each field, the first one found.
import { type Context, type Fault, type Faults, type Field, type NumberField, type Operation, type Unit, type Values } from './types';

/** Below the last digit of typed lengths. */
const TOLERANCE = 1e-9;

export function isShown(field: Field, values: Values): boolean {
  return field.isShown?.(values) ?? true;
}

function numberFault(field: NumberField, values: Values, context: Context): Fault | null {
  const value = values[field.id];
  if (typeof value !== 'number' || !Number.isFinite(value)) {
    return { key: 'fault.number' };
  }
  if (field.kind === 'count' && !Number.isInteger(value)) {
    return { key: 'fault.whole' };
  }
  for (const one of field.limits(values, context)) {
    const isLow = one.low !== undefined && (value < one.low - TOLERANCE || (one.isOpen === true && value <= one.low));
    const isHigh = one.high !== undefined && (value > one.high + TOLERANCE || (one.isOpen === true && value >= one.high));
    if (isLow || isHigh) {
      return { key: one.key, ...(one.values === undefined ? {} : { values: rounded(one.values) }) };
    }
  }
  return null;
}

/** Rounds the values of a message to the digits of the field. */
function rounded(values: Record<string, string | number>): Record<string, string | number> {
  return Object.fromEntries(Object.entries(values).map(([key, value]) => [key, typeof value === 'number' ? Math.round(value * 1e5) / 1e5 : value]));
}

function fieldFault(field: Field, values: Values, context: Context): Fault | null {
  if (field.kind === 'choice') {
    return field.options.includes(String(values[field.id])) ? null : { key: 'fault.choice' };
  }
  if ('check' in field) {
    const value = values[field.id];
    return typeof value === 'string' ? field.check(value, values, context) : { key: 'fault.text' };
  }
  return numberFault(field, values, context);
}

/** Faults of a value that are independent of other fields. A field that depends on this value is then not checked. */
const ALONE = new Set<string>(['fault.number', 'fault.whole', 'fault.above_zero', 'fault.not_negative', 'fault.at_least', 'fault.at_most', 'fault.top_safe', 'fault.part_stock', 'fault.bore_hole', 'fault.z_order', 'fault.hole_gap']);

function eachFault(operation: Operation, values: Values, context: Context): Faults {
  const faults: Faults = {};
  for (const field of operation.fields) {
    const fault = isShown(field, values) ? fieldFault(field, values, context) : null;
    if (fault !== null) {
      faults[field.id] = fault;
    }
  }
  return faults;
}

/** The faults of a form by field; empty if the operation can be written. */
export function faultsOf(operation: Operation, values: Values, context: Context): Faults {
  const first = eachFault(operation, values, context);
  const alone = Object.fromEntries(Object.entries(first).filter(([, fault]) => ALONE.has(fault.key)));
  const unknown = { ...values, ...Object.fromEntries(Object.keys(alone).map((id) => [id, NaN])) };
  const faults = Object.keys(alone).length === 0 ? first : { ...eachFault(operation, unknown, context), ...alone };
  const further = Object.keys(faults).length === 0 ? operation.check?.(values, context) : undefined;
  for (const [id, fault] of Object.entries(further ?? {})) {
    faults[id] = { key: fault.key, ...(fault.values === undefined ? {} : { values: rounded(fault.values) }) };
  }
  return faults;
}

/** The values of a new form; those in `typed` are kept. Defaults may depend on earlier fields. */
export function filled(operation: Operation, typed: Values, context: Context): Values {
  const values: Values = {};
  for (const field of operation.fields) {
    const own = typed[field.id];
    values[field.id] = own !== undefined ? own : typeof field.preset === 'function' ? roundPreset(field.preset({ ...values }, context), context.unit) : field.preset;
  }
  return values;
}

function roundPreset(value: number, unit: Unit): number {
  const digits = unit === 'mm' ? 1e3 : 1e4;
  return Math.round(value * digits) / digits;
}
