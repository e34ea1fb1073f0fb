// SPDX-License-Identifier: GPL-2.0-or-later
// Drilling, tapping and boring of a pattern of holes, by the canned cycles.
import { angle, choice, depthFields, feedRate, nice, seconds, size, toolFields } from '../fields';
import type { Point } from '../path2';
import { holesOf, overlapFault, patternFields } from '../patterns';
import { num, word, type Context, type Field, type Operation, type Values } from '../types';
import type { Writer } from '../writer';

const isCycle = (...names: string[]) => (values: Values): boolean => names.includes(word(values, 'cycle'));
const between = (): Field => choice('between', ['safe', 'clearance'], 'safe', { reason: 'why.between' });

/** Positions with a cycle: the first line has the cycle, the following lines only the position. */
function cycle(writer: Writer, values: Values, context: Context, first: string): void {
  const points = holesOf(values);
  writer.rapid({ z: context.safe });
  writer.rapid(points[0] as Point);
  const isSafe = word(values, 'between') === 'safe';
  const above = num(values, 'top') + num(values, 'clearance');
  if (!isSafe) {
    writer.rapid({ z: above });
  }
  const at = (p: Point): string => `X${writer.number(p.x)} Y${writer.number(p.y)}`;
  for (const [i, p] of points.entries()) {
    writer.line(i === 0 ? `${isSafe ? 'G98' : 'G99'} ${first.replace('{at}', at(p)).replace('{r}', `R${writer.number(above)}`)}` : at(p));
  }
  writer.line('G80');
  writer.forget();
  writer.rapid({ z: context.safe });
}

/** Z of the end of the tool. */
function bottomOf(values: Values): number {
  const tip = word(values, 'depth_at') === 'diameter' ? num(values, 'diameter') / 2 / Math.tan((num(values, 'tip_angle') * Math.PI) / 360) : 0;
  return num(values, 'top') - num(values, 'depth') - tip;
}

export const drill: Operation = {
  id: 'drill',
  machine: 'mill',
  fields: [
    ...patternFields(),
    ...depthFields(15, 0.5),
    choice('depth_at', ['tip', 'diameter'], 'tip', { reason: 'why.depth_at' }),
    angle('tip_angle', 118, 60, 179, { reason: 'why.tip_angle', isShown: (values) => word(values, 'depth_at') === 'diameter' }),
    choice('cycle', ['drill', 'peck', 'chip_break'], 'peck', { reason: 'why.cycle' }),
    size('peck', (values, context) => Math.min(num(values, 'diameter'), num(values, 'depth')) || nice(context.unit, 3, 0.125), 0.125, {
      reason: 'why.peck',
      isShown: isCycle('peck', 'chip_break'),
      limits: (values) => [{ high: num(values, 'depth'), key: 'fault.peck_depth', values: { high: num(values, 'depth') } }, { low: num(values, 'depth') / 1000, key: 'fault.too_many_steps' }],
    }),
    seconds('dwell', 0, { isShown: isCycle('drill') }),
    ...toolFields(6, 0.25, 1500),
    between(),
  ],
  check: (values) => overlapFault(values, num(values, 'diameter')),
  write(writer, values, context) {
    const kind = word(values, 'cycle');
    const dwell = num(values, 'dwell');
    const code = kind === 'peck' ? 'G83' : kind === 'chip_break' ? 'G73' : dwell > 0 ? 'G82' : 'G81';
    const further = kind === 'drill' ? (dwell > 0 ? ` P${writer.number(dwell)}` : '') : ` Q${writer.number(num(values, 'peck'))}`;
    cycle(writer, values, context, `${code} {at} Z${writer.number(bottomOf(values))} {r}${further} ${writer.feedWord(num(values, 'feed'))}`);
  },
};

/** The feed from pitch and speed; the field is the pitch. */
export const pitchLimits = (values: Values, context: Context) => (context.maxFeed === null ? [] : [{ high: context.maxFeed / num(values, 'speed'), key: 'fault.pitch_feed' as const, values: { feed: num(values, 'pitch') * num(values, 'speed'), high: context.maxFeed } }]);

export const tap: Operation = {
  id: 'tap',
  machine: 'mill',
  fields: [
    ...patternFields(),
    ...depthFields(12, 0.5),
    choice('tapping', ['rigid', 'floating'], 'rigid', { reason: 'why.tapping' }),
    choice('hand', ['right', 'left'], 'right'),
    size('pitch', 1, 0.05, { reason: 'why.pitch', limits: (values, context) => [...pitchLimits(values, context), { high: num(values, 'diameter') / 2, key: 'fault.pitch_tool', values: { high: num(values, 'diameter') / 2 } }] }),
    ...toolFields(6, 0.25, 300).filter((one) => one.id !== 'feed'),
  ],
  check: (values) => overlapFault(values, num(values, 'diameter')),
  write(writer, values, context) {
    const bottom = writer.number(num(values, 'top') - num(values, 'depth'));
    if (word(values, 'tapping') === 'floating') {
      const code = word(values, 'hand') === 'left' ? 'G74' : 'G84';
      cycle(writer, { ...values, between: 'safe' }, context, `${code} {at} Z${bottom} {r} ${writer.feedWord(num(values, 'pitch') * num(values, 'speed'))}`);
      return;
    }
    for (const p of holesOf(values)) {
      writer.rapid({ z: context.safe });
      writer.rapid(p);
      writer.rapid({ z: num(values, 'top') + num(values, 'clearance') });
      writer.line(`G33.1 Z${bottom} K${writer.number(num(values, 'pitch'))}`);
      writer.forget();
    }
    writer.rapid({ z: context.safe });
  },
};

export const bore: Operation = {
  id: 'bore',
  machine: 'mill',
  fields: [
    ...patternFields(),
    ...depthFields(15, 0.5),
    choice('boring', ['feed_out', 'dwell', 'stop'], 'feed_out', { reason: 'why.boring' }),
    seconds('dwell', 0.5, { isShown: (values) => word(values, 'boring') !== 'feed_out' }),
    ...toolFields(20, 0.75, 800).filter((one) => one.id !== 'feed'),
    feedRate('feed', 60, 2.5),
    between(),
  ],
  check: (values) => overlapFault(values, num(values, 'diameter')),
  write(writer, values, context) {
    const kind = word(values, 'boring');
    const code = kind === 'feed_out' ? 'G85' : kind === 'dwell' ? 'G89' : 'G86';
    const dwell = kind === 'feed_out' ? '' : ` P${writer.number(num(values, 'dwell'))}`;
    cycle(writer, values, context, `${code} {at} Z${writer.number(num(values, 'top') - num(values, 'depth'))} {r}${dwell} ${writer.feedWord(num(values, 'feed'))}`);
  },
};
