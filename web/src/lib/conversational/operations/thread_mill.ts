// SPDX-License-Identifier: GPL-2.0-or-later
// Mills a thread in a hole or on a boss with a single-row cutter: a helix with the pitch of the thread.
import { choice, count, depthFields, directionField, position, size, toolFields } from '../fields';
import { num, word, type Context, type Faults, type Operation, type Values } from '../types';
import type { Writer } from '../writer';

const isInternal = (values: Values): boolean => word(values, 'thread_side') === 'internal';
/** Depth of a 60 degree thread per unit of pitch: on a bolt, and in a nut. */
const SHARE = { external: 0.6134, internal: 0.5413 };

export const threadMill: Operation = {
  id: 'thread_mill',
  machine: 'mill',
  fields: [
    choice('thread_side', ['internal', 'external'], 'internal'),
    choice('hand', ['right', 'left'], 'right'),
    position('x', 0),
    position('y', 0),
    size('major', 20, 0.75),
    size('pitch', 1.5, 0.0625, { limits: (values) => [{ high: num(values, 'major') / 2, key: 'fault.pitch_major', values: { high: num(values, 'major') / 2 } }] }),
    size('minor', (values) => num(values, 'major') - 2 * num(values, 'pitch') * (isInternal(values) ? SHARE.internal : SHARE.external), 0.7, {
      reason: 'why.minor',
      limits: (values) => [
        { high: num(values, 'major'), isOpen: true, key: 'fault.minor_major', values: { high: num(values, 'major') } },
        { low: num(values, 'major') - 2.2 * num(values, 'pitch'), key: 'fault.minor_pitch', values: { low: num(values, 'major') - 2.2 * num(values, 'pitch') } },
      ],
    }),
    ...depthFields(12, 0.5),
    ...toolFields(10, 0.375, 2500),
    count('passes', 2, 1, 20, { reason: 'why.passes' }),
    directionField(),
  ],
  check(values): Faults {
    const gap = 0.02 * num(values, 'minor');
    if (isInternal(values) && num(values, 'diameter') > num(values, 'minor') - 2 * gap) {
      return { diameter: { key: 'fault.thread_tool', values: { high: num(values, 'minor') - 2 * gap } } };
    }
    return num(values, 'depth') < num(values, 'pitch') ? { depth: { key: 'fault.thread_depth', values: { low: num(values, 'pitch') } } } : {};
  },
  write,
};

interface Helix {
  /** Radius of the path of the tool's centre. */
  radius: number;
  from: number;
  to: number;
  isCw: boolean;
}

function write(writer: Writer, values: Values, context: Context): void {
  const [x, y, top, pitch] = [num(values, 'x'), num(values, 'y'), num(values, 'top'), num(values, 'pitch')];
  const [feed, clearance, tool] = [num(values, 'feed'), num(values, 'clearance'), num(values, 'diameter') / 2];
  const isIn = isInternal(values);
  const isCw = (word(values, 'direction') === 'climb') !== isIn;
  // A right-hand thread rises counterclockwise.
  const isUp = isCw === (word(values, 'hand') === 'left');
  const bottom = top - num(values, 'depth');
  const turns = Math.ceil((num(values, 'depth') + pitch / 2) / pitch - 1e-9);
  const above = bottom + turns * pitch;
  const away = isIn ? 0 : num(values, 'major') / 2 + tool + clearance;
  const start = { x: x + away, y };
  const passes = num(values, 'passes');
  writer.rapid({ z: context.safe });
  writer.rapid(start);
  writer.rapid({ z: top + clearance });
  for (let i = 1; i <= passes; i += 1) {
    const share = i / passes;
    const [minor, major] = [num(values, 'minor') / 2, num(values, 'major') / 2];
    const radius = isIn ? minor + (major - minor) * share - tool : major - (major - minor) * share + tool;
    const helix: Helix = { radius, isCw, from: isUp ? bottom : above, to: isUp ? above : bottom };
    writer.comment(`Pass ${i} of ${passes}`);
    writer.feed({ z: helix.from }, feed);
    const edge = { x: x + radius, y };
    const lead = { x: x + (away + radius) / 2, y };
    // Lead-in and lead-out are half circles, from the middle or from outside, tangential to the helix.
    const isLeadCw = isIn ? isCw : !isCw;
    writer.arc(edge, lead, isLeadCw, feed);
    writer.arc({ ...edge, z: helix.to }, { x, y }, isCw, feed, turns);
    writer.arc(start, lead, isLeadCw, feed);
    writer.feed({ z: top + clearance }, feed);
  }
  writer.rapid({ z: context.safe });
}
