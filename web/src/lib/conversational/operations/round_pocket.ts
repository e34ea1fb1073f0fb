// SPDX-License-Identifier: GPL-2.0-or-later
import { position, size } from '../fields';
import { checkPocket, clearPocket, pocketFields, type Pocket } from '../pocket';
import { num, type Operation, type Values } from '../types';

export const roundPocket: Operation = {
  id: 'round_pocket',
  machine: 'mill',
  fields: [
    position('x', 0),
    position('y', 0),
    size('pocket_diameter', 40, 1.5, { limits: (values) => [{ low: num(values, 'diameter'), key: 'fault.tool_wide', values: { low: num(values, 'diameter') } }] }),
    ...pocketFields(),
  ],
  check: (values) => checkPocket(values, pocketOf(values)),
  write: (writer, values, context) => clearPocket(writer, values, pocketOf(values), context),
};

function pocketOf(values: Values): Pocket {
  const radius = num(values, 'pocket_diameter') / 2;
  return { frame: { x: num(values, 'x'), y: num(values, 'y'), turn: 0 }, x: radius, y: radius, corner: radius };
}
