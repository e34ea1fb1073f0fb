// SPDX-License-Identifier: GPL-2.0-or-later
import { depthFields, directionField, entryFields, feedDown, finishing, lengthFault, levelCount, position, size, stepDown, stepOver, toolFields } from '../fields';
import { clearPocket, entryOf, type Pocket } from '../pocket';
import { num, word, type Faults, type Operation, type Values } from '../types';

export const roundPocket: Operation = {
  id: 'round_pocket',
  machine: 'mill',
  fields: [
    position('x', 0),
    position('y', 0),
    size('pocket_diameter', 40, 1.5, { limits: (values) => [{ low: num(values, 'diameter'), key: 'fault.tool_wide', values: { low: num(values, 'diameter') } }] }),
    ...depthFields(),
    ...toolFields(),
    feedDown(),
    stepDown(),
    stepOver(),
    finishing(),
    directionField(),
    ...entryFields(),
  ],
  check,
  write: (writer, values, context) => clearPocket(writer, values, pocketOf(values), context),
};

function pocketOf(values: Values): Pocket {
  const radius = num(values, 'pocket_diameter') / 2;
  return { frame: { x: num(values, 'x'), y: num(values, 'y'), turn: 0 }, x: radius, y: radius, corner: radius };
}

function check(values: Values): Faults {
  if (num(values, 'pocket_diameter') < num(values, 'diameter') + 2 * num(values, 'allowance') - 1e-9) {
    return { allowance: { key: 'fault.allowance_room', values: { high: (num(values, 'pocket_diameter') - num(values, 'diameter')) / 2 } } };
  }
  const entry = entryOf(pocketOf(values), num(values, 'diameter'), num(values, 'allowance'), word(values, 'entry') === 'plunge');
  return entry === null ? { entry: { key: 'fault.no_entry' } } : lengthFault((levelCount(values) * 9 * (num(values, 'pocket_diameter') / 2)) / num(values, 'step_over'), 'step_over');
}
