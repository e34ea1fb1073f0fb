// SPDX-License-Identifier: GPL-2.0-or-later
// Engraves a line of text with a pointed cutter.
import { angle, choice, depthFields, feedDown, lengthFault, levelCount, position, size, toolFields } from '../fields';
import { strokesOfText, unknownLetter } from '../font';
import { place, type Point } from '../path2';
import { num, word, type Context, type Fault, type Operation, type Values } from '../types';
import { levelsOf, type Writer } from '../writer';

const MOST_LETTERS = 200;

export const engrave: Operation = {
  id: 'engrave',
  machine: 'mill',
  fields: [
    { id: 'text', kind: 'text', preset: 'ABC 123', check: textFault },
    position('x', 0),
    position('y', 0),
    size('text_height', 10, 0.4, { reason: 'why.text_height', limits: (values) => [{ low: num(values, 'diameter'), key: 'fault.text_tool', values: { low: num(values, 'diameter') } }] }),
    choice('align', ['left', 'centre', 'right'], 'left'),
    angle('angle', 0),
    ...depthFields(0.2, 0.008),
    ...toolFields(0.2, 0.008, 10000),
    feedDown(),
    size('step_down', (values) => num(values, 'depth'), 0.008, { reason: 'why.engrave_step', limits: (values) => [{ high: num(values, 'depth'), key: 'fault.step_depth', values: { high: num(values, 'depth') } }, { low: num(values, 'depth') / 100, key: 'fault.too_many_steps' }] }),
  ],
  check: (values) => lengthFault(levelCount(values) * (strokesOfText(word(values, 'text'), 1).strokes.flat().length + 3), 'step_down'),
  write,
};

function textFault(text: string): Fault | null {
  const unknown = unknownLetter(text);
  if (unknown !== null) {
    return { key: 'fault.letter', values: { letter: unknown } };
  }
  return text.trim() === '' ? { key: 'fault.no_text' } : text.length > MOST_LETTERS ? { key: 'fault.long_text', values: { high: MOST_LETTERS } } : null;
}

/** The tool path: each stroke is one cut. */
export function engravedStrokes(values: Values): Point[][] {
  const { strokes, width } = strokesOfText(word(values, 'text'), num(values, 'text_height'));
  const before = { left: 0, centre: width / 2, right: width }[word(values, 'align')] ?? 0;
  const frame = { x: num(values, 'x'), y: num(values, 'y'), turn: (num(values, 'angle') * Math.PI) / 180 };
  return strokes.map((stroke) => stroke.map((p) => place(frame, { x: p.x - before, y: p.y })));
}

function write(writer: Writer, values: Values, context: Context): void {
  const [top, feed] = [num(values, 'top'), num(values, 'feed')];
  const above = top + num(values, 'clearance');
  const strokes = engravedStrokes(values);
  const levels = levelsOf(top, num(values, 'depth'), num(values, 'step_down'));
  writer.rapid({ z: context.safe });
  for (const [i, z] of levels.entries()) {
    writer.comment(`Level ${i + 1} of ${levels.length}`);
    for (const [first, ...others] of strokes) {
      writer.rapid(first as Point);
      writer.rapid({ z: above });
      writer.feed({ z }, num(values, 'feed_z'));
      others.forEach((p) => writer.feed(p, feed));
      writer.rapid({ z: above });
    }
  }
  writer.rapid({ z: context.safe });
}
