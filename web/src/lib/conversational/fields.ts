// SPDX-License-Identifier: GPL-2.0-or-later
// Fields that many operations share, with their defaults and ranges.
import type { ConvKey } from './i18n/en';
import { num, word, type ChoiceField, type Context, type Faults, type Field, type Limit, type NumberField, type NumberKind, type Unit, type Values } from './types';

/** A round value for each unit. */
export const nice = (unit: Unit, mm: number, inch: number): number => (unit === 'mm' ? mm : inch);

/** Maximum of the lengths of a part or position. */
export const longest = (unit: Unit): number => nice(unit, 10000, 400);
export const shortest = (unit: Unit): number => nice(unit, 0.001, 0.00005);

type Preset = number | ((values: Values, context: Context) => number);
type Limits = (values: Values, context: Context) => Limit[];
interface More {
  reason?: ConvKey;
  limits?: Limits;
  isShown?: (values: Values) => boolean;
}

export function field(id: string, kind: NumberKind, preset: Preset, base: Limits, more: More): NumberField {
  const own = more.limits;
  return {
    id,
    kind,
    preset: typeof preset === 'number' ? () => preset : preset,
    limits: own === undefined ? base : (values, context) => [...base(values, context), ...own(values, context)],
    ...(more.reason === undefined ? {} : { reason: more.reason }),
    ...(more.isShown === undefined ? {} : { isShown: more.isShown }),
  };
}

export const within = (low: number, high: number): Limit[] => [
  { low, key: 'fault.at_least', values: { low } },
  { high, key: 'fault.at_most', values: { high } },
];

/** A coordinate: any sign. */
export function position(id: string, preset: Preset, more: More = {}): NumberField {
  return field(id, 'length', preset, (_, context) => within(-longest(context.unit), longest(context.unit)), more);
}
/** A length above zero. */
export function size(id: string, mm: number | ((values: Values, context: Context) => number), inch: number, more: More = {}): NumberField {
  const preset = typeof mm === 'number' ? (_: Values, context: Context): number => nice(context.unit, mm, inch) : mm;
  const base: Limits = (_, context) => [
    { low: 0, isOpen: true, key: 'fault.above_zero' },
    { low: shortest(context.unit), key: 'fault.at_least', values: { low: shortest(context.unit) } },
    { high: longest(context.unit), key: 'fault.at_most', values: { high: longest(context.unit) } },
  ];
  return field(id, 'length', preset, base, more);
}
/** A field for a length of zero or more. */
export function margin(id: string, preset: Preset, more: More = {}): NumberField {
  return field(id, 'length', preset, (_, context) => [{ low: 0, key: 'fault.not_negative' }, { high: longest(context.unit), key: 'fault.at_most', values: { high: longest(context.unit) } }], more);
}
export function angle(id: string, preset: number, low = -360, high = 360, more: More = {}): NumberField {
  return field(id, 'angle', preset, () => within(low, high), more);
}
export function count(id: string, preset: number, low: number, high: number, more: More = {}): NumberField {
  return field(id, 'count', preset, () => within(low, high), more);
}
export function seconds(id: string, preset: number, more: More = {}): NumberField {
  return field(id, 'time', preset, () => [{ low: 0, key: 'fault.not_negative' }, { high: 600, key: 'fault.at_most', values: { high: 600 } }], more);
}
export function feedRate(id: string, mm: number, inch: number, more: More = {}): NumberField {
  const base: Limits = (_, context) => [
    { low: 0, isOpen: true, key: 'fault.above_zero' },
    { low: nice(context.unit, 1, 0.05), key: 'fault.at_least', values: { low: nice(context.unit, 1, 0.05) } },
    { high: context.maxFeed ?? nice(context.unit, 100_000, 4000), key: context.maxFeed === null ? 'fault.at_most' : 'fault.max_feed', values: { high: context.maxFeed ?? nice(context.unit, 100_000, 4000) } },
  ];
  return field(id, 'feed', (_, context) => Math.min(nice(context.unit, mm, inch), context.maxFeed ?? Infinity), base, more);
}
export function choice(id: string, options: string[], preset = options[0] ?? '', more: { reason?: ConvKey; isShown?: (values: Values) => boolean } = {}): ChoiceField {
  return { id, kind: 'choice', options, preset, ...more };
}

/** The first fields of each form: number and diameter of the tool, spindle and feeds. */
export function toolFields(mm = 6, inch = 0.25, speed = 3000): Field[] {
  const inTable: Limits = (values, context) => (context.tools !== null && !context.tools.some((one) => one.number === num(values, 'tool')) ? [{ high: -1, key: 'fault.no_tool', values: { tool: num(values, 'tool') } }] : []);
  return [
    count('tool', 1, 1, 99999, { reason: 'why.tool', limits: inTable }),
    size('diameter', (values, context) => diameterOf(values, context) ?? nice(context.unit, mm, inch), inch, { reason: 'why.diameter' }),
    speedField('speed', speed),
    feedRate('feed', 300, 12, { reason: 'why.feed' }),
    choice('coolant', ['flood', 'mist', 'off'], 'flood'),
  ];
}
export function speedField(id: string, preset: number): NumberField {
  return field(id, 'speed', (_, context) => Math.min(preset, context.maxSpeed ?? Infinity), (_, context) => [
    { low: 0, isOpen: true, key: 'fault.above_zero' },
    { low: 1, key: 'fault.at_least', values: { low: 1 } },
    { high: context.maxSpeed ?? 100_000, key: context.maxSpeed === null ? 'fault.at_most' : 'fault.max_speed', values: { high: context.maxSpeed ?? 100_000 } },
  ], {});
}
export function diameterOf(values: Values, context: Context): number | null {
  const known = context.tools?.find((one) => one.number === num(values, 'tool'))?.diameter ?? 0;
  return known > 0 ? known : null;
}

/** The surface, the depth, and the height of rapid moves near the part. */
export function depthFields(mm = 5, inch = 0.2): Field[] {
  return [
    position('top', 0, { reason: 'why.top', limits: (_, context) => [{ high: context.safe, isOpen: true, key: 'fault.top_safe', values: { safe: context.safe } }] }),
    size('depth', mm, inch),
    size('clearance', (values, context) => Math.min(nice(context.unit, 2, 0.1), Math.max(shortest(context.unit), context.safe - num(values, 'top'))) || nice(context.unit, 2, 0.1), 0.1, {
      reason: 'why.clearance',
      limits: (values, context) => [{ high: context.safe - num(values, 'top'), key: 'fault.clearance_safe', values: { safe: context.safe } }],
    }),
  ];
}

/** Depth of cut and feed downwards of a milling cutter. */
export function stepDown(): NumberField {
  return size('step_down', (values, context) => Math.max(shortest(context.unit), Math.min(num(values, 'diameter') / 2, num(values, 'depth'))) || nice(context.unit, 3, 0.125), 0.1, {
    reason: 'why.step_down',
    limits: (values) => [{ high: num(values, 'depth'), key: 'fault.step_depth', values: { high: num(values, 'depth') } }, { low: num(values, 'depth') / 1000, key: 'fault.too_many_steps' }],
  });
}
/** With a larger fraction of the diameter, material remains in the corners between two paths. */
export const MOST_STEP = 0.7;
export function stepOver(most = MOST_STEP): NumberField {
  return size('step_over', (values, context) => 0.4 * num(values, 'diameter') || nice(context.unit, 2, 0.1), 0.1, {
    reason: 'why.step_over',
    limits: (values) => [
      { high: num(values, 'diameter'), key: 'fault.step_tool', values: { high: num(values, 'diameter') } },
      { high: most * num(values, 'diameter'), key: 'fault.step_share', values: { high: most * num(values, 'diameter'), percent: Math.round(most * 100) } },
      { low: num(values, 'diameter') / 100, key: 'fault.step_small', values: { low: num(values, 'diameter') / 100 } },
    ],
  });
}
export function feedDown(): NumberField {
  return feedRate('feed_z', 100, 4, { reason: 'why.feed_z' });
}
export function finishing(): NumberField {
  return margin('allowance', (_, context) => nice(context.unit, 0.2, 0.01), { reason: 'why.allowance', limits: (values) => [{ high: num(values, 'diameter') / 4, key: 'fault.allowance', values: { high: num(values, 'diameter') / 4 } }] });
}
export const directionField = (): ChoiceField => choice('direction', ['climb', 'conventional'], 'climb', { reason: 'why.direction' });
/** The entry of the cutter into the material. */
export function entryFields(): Field[] {
  return [
    choice('entry', ['ramp', 'plunge'], 'ramp', { reason: 'why.entry' }),
    angle('ramp_angle', 3, 0.5, 30, { reason: 'why.ramp_angle', isShown: (values) => word(values, 'entry') !== 'plunge' }),
  ];
}
/** A longer program is slow to read and to show, and is usually caused by a typing error. */
export const MOST_LINES = 100_000;
/** The fault of an operation with about this many lines, reported at the field that can reduce them. */
export function lengthFault(lines: number, field: string): Faults {
  return lines > MOST_LINES ? { [field]: { key: 'fault.long_program', values: { high: MOST_LINES } } } : {};
}
export const levelCount = (values: Values): number => Math.ceil(num(values, 'depth') / num(values, 'step_down'));

export const slopeOf = (values: Values): number => Math.tan((num(values, 'ramp_angle') * Math.PI) / 180);
