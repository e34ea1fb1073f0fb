// SPDX-License-Identifier: GPL-2.0-or-later
// Positions of holes: on a line, in a grid, on a circle, or as a list.
import { angle, choice, count, longest, position, size } from './fields';
import { distance, place, type Point } from './path2';
import { num, word, type Context, type Fault, type Faults, type Field, type Values } from './types';

export const MOST_HOLES = 1000;
const isOf = (...names: string[]) => (values: Values): boolean => names.includes(word(values, 'pattern'));

export function patternFields(): Field[] {
  return [
    choice('pattern', ['circle', 'line', 'grid', 'list'], 'circle'),
    position('x', 0, { isShown: isOf('circle', 'line', 'grid') }),
    position('y', 0, { isShown: isOf('circle', 'line', 'grid') }),
    size('circle_diameter', 50, 2, { isShown: isOf('circle') }),
    count('holes', 6, 1, MOST_HOLES, { isShown: isOf('circle', 'line') }),
    angle('start_angle', 0, -360, 360, { isShown: isOf('circle') }),
    size('spacing', 20, 0.75, { isShown: isOf('line') }),
    count('columns', 3, 1, 100, { isShown: isOf('grid') }),
    count('rows', 2, 1, 100, { isShown: isOf('grid'), limits: (values) => [{ high: Math.floor(MOST_HOLES / num(values, 'columns')), key: 'fault.many_holes', values: { high: MOST_HOLES } }] }),
    size('spacing_x', 20, 0.75, { isShown: isOf('grid') }),
    size('spacing_y', 20, 0.75, { isShown: isOf('grid') }),
    angle('angle', 0, -360, 360, { isShown: isOf('line', 'grid') }),
    { id: 'points', kind: 'points', preset: '0 0\n20 0\n20 20', reason: 'why.points', isShown: isOf('list'), check: pointsFault },
  ];
}

/** One hole per line: X and Y separated by a blank or semicolon. Null for other lines. */
export function readPoints(text: string): (Point | null)[] {
  return text
    .split(/\n|\|/)
    .map((line) => line.trim())
    .filter((line) => line !== '')
    .map((line) => {
      const parts = line.split(/[;\s]+/).map((part) => (/^[+-]?(\d+([.,]\d*)?|[.,]\d+)$/.test(part) ? Number(part.replace(',', '.')) : NaN));
      const [x = NaN, y = NaN] = parts;
      return parts.length === 2 && Number.isFinite(x) && Number.isFinite(y) ? { x, y } : null;
    });
}

function pointsFault(text: string, _: Values, context: Context): Fault | null {
  const points = readPoints(text);
  const wrong = points.findIndex((one) => one === null);
  if (wrong >= 0) {
    return { key: 'fault.point', values: { line: wrong + 1 } };
  }
  const far = points.findIndex((one) => one !== null && Math.max(Math.abs(one.x), Math.abs(one.y)) > longest(context.unit));
  if (far >= 0) {
    return { key: 'fault.point_far', values: { line: far + 1, high: longest(context.unit) } };
  }
  return points.length === 0 ? { key: 'fault.no_points' } : points.length > MOST_HOLES ? { key: 'fault.many_holes', values: { high: MOST_HOLES } } : null;
}

export function holesOf(values: Values): Point[] {
  const at = { x: num(values, 'x'), y: num(values, 'y'), turn: (num(values, 'angle') * Math.PI) / 180 };
  const list = (length: number, make: (i: number) => Point): Point[] => Array.from({ length }, (_, i) => make(i));
  switch (word(values, 'pattern')) {
    case 'circle': {
      const n = num(values, 'holes');
      const turn = (i: number): number => ((num(values, 'start_angle') + (360 * i) / n) * Math.PI) / 180;
      return list(n, (i) => ({ x: at.x + (num(values, 'circle_diameter') / 2) * Math.cos(turn(i)), y: at.y + (num(values, 'circle_diameter') / 2) * Math.sin(turn(i)) }));
    }
    case 'line':
      return list(num(values, 'holes'), (i) => place(at, { x: i * num(values, 'spacing'), y: 0 }));
    case 'grid': {
      const [columns, rows] = [num(values, 'columns'), num(values, 'rows')];
      // Back and forth, so that the distance between two holes is short.
      return list(columns * rows, (i) => {
        const row = Math.floor(i / columns);
        const column = row % 2 === 0 ? i % columns : columns - 1 - (i % columns);
        return place(at, { x: column * num(values, 'spacing_x'), y: row * num(values, 'spacing_y') });
      });
    }
    default:
      return readPoints(word(values, 'points')).filter((one) => one !== null);
  }
}

/** The field to be changed if two holes overlap. */
const SPACING: Record<string, string> = { circle: 'holes', line: 'spacing', grid: 'spacing_x', list: 'points' };

/** Returns a fault if holes of this diameter overlap; holes may touch. */
export function overlapFault(values: Values, diameter: number): Faults {
  const points = holesOf(values);
  const order = points.map((_, i) => i).sort((a, b) => (points[a] as Point).x - (points[b] as Point).x);
  for (let i = 0; i < order.length; i += 1) {
    const a = points[order[i] as number] as Point;
    for (let k = i + 1; k < order.length && (points[order[k] as number] as Point).x - a.x < diameter; k += 1) {
      const b = points[order[k] as number] as Point;
      if (distance(a, b) < diameter - 1e-6) {
        const pattern = word(values, 'pattern');
        const isAcross = pattern === 'grid' && num(values, 'spacing_x') >= diameter - 1e-6;
        return { [isAcross ? 'spacing_y' : (SPACING[pattern] ?? 'pattern')]: { key: 'fault.overlap', values: { diameter, distance: distance(a, b) } } };
      }
    }
  }
  return {};
}
