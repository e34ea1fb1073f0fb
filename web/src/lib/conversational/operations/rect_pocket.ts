// SPDX-License-Identifier: GPL-2.0-or-later
import { angle, choice, margin, position, size } from '../fields';
import { checkPocket, clearPocket, pocketFields, type Pocket } from '../pocket';
import { place } from '../path2';
import { num, word, type Operation, type Values } from '../types';

export const rectPocket: Operation = {
  id: 'rect_pocket',
  machine: 'mill',
  fields: [
    choice('origin', ['centre', 'corner'], 'centre', { reason: 'why.origin' }),
    position('x', 0),
    position('y', 0),
    size('length', 60, 2.5, { limits: (values) => [{ low: num(values, 'diameter'), key: 'fault.tool_wide', values: { low: num(values, 'diameter') } }] }),
    size('width', 40, 1.5, { limits: (values) => [{ low: num(values, 'diameter'), key: 'fault.tool_wide', values: { low: num(values, 'diameter') } }] }),
    margin('corner_radius', (_, context) => (context.unit === 'mm' ? 5 : 0.2), {
      reason: 'why.corner_radius',
      limits: (values) => [
        { low: num(values, 'diameter') / 2, key: 'fault.corner_tool', values: { low: num(values, 'diameter') / 2 } },
        { high: Math.min(num(values, 'length'), num(values, 'width')) / 2, key: 'fault.corner_half', values: { high: Math.min(num(values, 'length'), num(values, 'width')) / 2 } },
      ],
    }),
    angle('angle', 0),
    ...pocketFields(),
  ],
  check: (values) => checkPocket(values, pocketOf(values)),
  write: (writer, values, context) => clearPocket(writer, values, pocketOf(values), context),
};

function pocketOf(values: Values): Pocket {
  const turn = (num(values, 'angle') * Math.PI) / 180;
  const [x, y] = [num(values, 'length') / 2, num(values, 'width') / 2];
  const given = { x: num(values, 'x'), y: num(values, 'y'), turn };
  const centre = word(values, 'origin') === 'corner' ? place(given, { x, y }) : given;
  return { frame: { x: centre.x, y: centre.y, turn }, x, y, corner: num(values, 'corner_radius') };
}
