// SPDX-License-Identifier: GPL-2.0-or-later
// A straight slot with round ends between the centres of its ends.
import { position, size } from '../fields';
import { checkPocket, clearPocket, pocketFields, type Pocket } from '../pocket';
import { num, type Faults, type Operation, type Values } from '../types';

export const slot: Operation = {
  id: 'slot',
  machine: 'mill',
  fields: [
    position('x', 0),
    position('y', 0),
    position('x_end', (_, context) => (context.unit === 'mm' ? 40 : 1.5)),
    position('y_end', 0),
    size('slot_width', 10, 0.375, { limits: (values) => [{ low: num(values, 'diameter'), key: 'fault.tool_wide', values: { low: num(values, 'diameter') } }] }),
    ...pocketFields(),
  ],
  check,
  write: (writer, values, context) => clearPocket(writer, values, pocketOf(values), context),
};

function pocketOf(values: Values): Pocket {
  const [dx, dy] = [num(values, 'x_end') - num(values, 'x'), num(values, 'y_end') - num(values, 'y')];
  const half = num(values, 'slot_width') / 2;
  const frame = { x: num(values, 'x') + dx / 2, y: num(values, 'y') + dy / 2, turn: Math.atan2(dy, dx) };
  return { frame, x: Math.hypot(dx, dy) / 2 + half, y: half, corner: half };
}

function check(values: Values): Faults {
  if (Math.hypot(num(values, 'x_end') - num(values, 'x'), num(values, 'y_end') - num(values, 'y')) < 1e-3 * num(values, 'slot_width')) {
    return { x_end: { key: 'fault.slot_ends' } };
  }
  return checkPocket(values, pocketOf(values));
}
