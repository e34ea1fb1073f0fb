// SPDX-License-Identifier: GPL-2.0-or-later
// Faces a rectangle with straight cuts along X, which begin and end outside the material.
import { choice, depthFields, feedDown, lengthFault, levelCount, margin, nice, position, size, stepDown, stepOver, toolFields } from '../fields';
import { num, word, type Context, type Operation, type Values } from '../types';
import { levelsOf, type Writer } from '../writer';

export const face: Operation = {
  id: 'face',
  machine: 'mill',
  fields: [
    choice('origin', ['corner', 'centre'], 'corner', { reason: 'why.origin' }),
    position('x', 0),
    position('y', 0),
    size('length', 100, 4),
    size('width', 60, 2.5),
    ...depthFields(1, 0.04),
    ...toolFields(20, 0.75, 2000),
    feedDown(),
    stepDown(),
    stepOver(0.9),
    margin('floor_allowance', (values, context) => Math.min(nice(context.unit, 0.2, 0.01), num(values, 'depth') / 4, num(values, 'step_down')) || 0, { reason: 'why.floor_allowance', limits: (values) => [{ high: num(values, 'depth'), isOpen: true, key: 'fault.floor_allowance', values: { high: num(values, 'depth') } }, { high: num(values, 'step_down'), key: 'fault.allowance_cut', values: { high: num(values, 'step_down') } }] }),
    choice('face_direction', ['climb', 'both'], 'climb', { reason: 'why.face_direction' }),
  ],
  check: (values) => lengthFault((levelCount(values) * 5 * num(values, 'width')) / num(values, 'step_over'), 'step_over'),
  write,
};

/** Z of each level: equal steps, then the finishing cut. */
function levels(values: Values): number[] {
  const [top, depth, allowance] = [num(values, 'top'), num(values, 'depth'), num(values, 'floor_allowance')];
  const rough = levelsOf(top, depth - allowance, num(values, 'step_down'));
  return allowance > 0 ? [...rough, top - depth] : rough;
}

function write(writer: Writer, values: Values, context: Context): void {
  const isCorner = word(values, 'origin') === 'corner';
  const [length, width, diameter] = [num(values, 'length'), num(values, 'width'), num(values, 'diameter')];
  const left = isCorner ? num(values, 'x') : num(values, 'x') - length / 2;
  const low = isCorner ? num(values, 'y') : num(values, 'y') - width / 2;
  const [clearance, radius] = [num(values, 'clearance'), diameter / 2];
  const [from, to] = [left - radius - clearance, left + length + radius + clearance];
  // The last cut overlaps the edge slightly, so that no burr remains.
  const covered = width + 0.05 * diameter;
  const cuts = Math.max(1, Math.ceil(covered / num(values, 'step_over') - 1e-9));
  const step = covered / cuts;
  const above = num(values, 'top') + clearance;
  const isBoth = word(values, 'face_direction') === 'both';
  const all = levels(values);
  for (const [i, z] of all.entries()) {
    writer.comment(i === all.length - 1 && num(values, 'floor_allowance') > 0 ? 'Finishing cut' : `Level ${i + 1} of ${all.length}`);
    for (let k = 0; k < cuts; k += 1) {
      const y = low + width + radius - step * (k + 1);
      const isForward = !isBoth || k % 2 === 0;
      if (k === 0 || !isBoth) {
        writer.rapid({ z: i === 0 && k === 0 ? context.safe : above });
        writer.rapid({ x: from, y });
        writer.rapid({ z: above });
        writer.feed({ z }, num(values, 'feed_z'));
      } else {
        writer.feed({ y }, num(values, 'feed'));
      }
      writer.feed({ x: isForward ? to : from }, num(values, 'feed'));
    }
    writer.rapid({ z: above });
  }
  writer.rapid({ z: context.safe });
}
