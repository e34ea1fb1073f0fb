// SPDX-License-Identifier: GPL-2.0-or-later
// A rectangular or round boss in the middle of its stock.
import { clearBoss, type Boss } from '../boss';
import { depthFields, directionField, feedDown, finishing, lengthFault, levelCount, margin, position, size, stepDown, stepOver, toolFields } from '../fields';
import { num, type Faults, type Field, type Operation, type Values } from '../types';

const common = (): Field[] => [...depthFields(), ...toolFields(10, 0.375), feedDown(), stepDown(), stepOver(), finishing(), directionField()];
const fits = (id: string) => (values: Values) => [{ low: num(values, id), key: 'fault.boss_stock' as const, values: { low: num(values, id) } }];

export const rectBoss: Operation = {
  id: 'rect_boss',
  machine: 'mill',
  fields: [
    position('x', 0),
    position('y', 0),
    size('length', 40, 1.5),
    size('width', 30, 1.25),
    margin('corner_radius', 0, {
      limits: (values) => [{ high: Math.min(num(values, 'length'), num(values, 'width')) / 2, key: 'fault.corner_half', values: { high: Math.min(num(values, 'length'), num(values, 'width')) / 2 } }],
    }),
    size('stock_length', (values, context) => num(values, 'length') + (context.unit === 'mm' ? 20 : 0.75), 2.25, { reason: 'why.stock', limits: fits('length') }),
    size('stock_width', (values, context) => num(values, 'width') + (context.unit === 'mm' ? 20 : 0.75), 2, { reason: 'why.stock', limits: fits('width') }),
    ...common(),
  ],
  check: (values) => check(values, rectOf(values)),
  write: (writer, values, context) => clearBoss(writer, values, rectOf(values), context),
};

export const roundBoss: Operation = {
  id: 'round_boss',
  machine: 'mill',
  fields: [
    position('x', 0),
    position('y', 0),
    size('boss_diameter', 30, 1.25),
    size('stock_length', (values, context) => num(values, 'boss_diameter') + (context.unit === 'mm' ? 20 : 0.75), 2, { reason: 'why.stock', limits: fits('boss_diameter') }),
    size('stock_width', (values, context) => num(values, 'boss_diameter') + (context.unit === 'mm' ? 20 : 0.75), 2, { reason: 'why.stock', limits: fits('boss_diameter') }),
    ...common(),
  ],
  check: (values) => check(values, roundOf(values)),
  write: (writer, values, context) => clearBoss(writer, values, roundOf(values), context),
};

function rectOf(values: Values): Boss {
  return {
    frame: { x: num(values, 'x'), y: num(values, 'y'), turn: 0 },
    x: num(values, 'length') / 2,
    y: num(values, 'width') / 2,
    corner: num(values, 'corner_radius'),
    stock: { x: num(values, 'stock_length') / 2, y: num(values, 'stock_width') / 2 },
  };
}
function roundOf(values: Values): Boss {
  const radius = num(values, 'boss_diameter') / 2;
  return { frame: { x: num(values, 'x'), y: num(values, 'y'), turn: 0 }, x: radius, y: radius, corner: radius, stock: { x: num(values, 'stock_length') / 2, y: num(values, 'stock_width') / 2 } };
}

/** Checks that there is material to cut, and that the program does not become too long. */
function check(values: Values, boss: Boss): Faults {
  const isSame = boss.corner < 1e-6 && Math.abs(boss.stock.x - boss.x) < 1e-6 && Math.abs(boss.stock.y - boss.y) < 1e-6;
  const rings = Math.hypot(boss.stock.x, boss.stock.y) / num(values, 'step_over');
  return isSame ? { stock_length: { key: 'fault.nothing' } } : lengthFault(levelCount(values) * 9 * rings, 'step_over');
}
