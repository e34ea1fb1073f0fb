// SPDX-License-Identifier: GPL-2.0-or-later
// Drawings of forms to scale, from the values: outlines seen from above, and dimensions with their fields.
import { bossRings } from './boss';
import { contoursOf, cutsOf } from './operations/contour';
import { engravedStrokes } from './operations/engrave';
import { holesOf } from './patterns';
import { along, distance, lengthOf, place, placePath, ringPath, type Frame, type Path, type Point } from './path2';
import { LATHE_SKETCHES } from './lathe_sketch';
import { circle, Draft, type Sketch } from './sketch_draft';
import { num, word, type Context, type Operation, type Values } from './types';
import { filled } from './validate';

const ARC_STEP = Math.PI / 24;

function pointsOf(path: Path): Point[] {
  const out = [path.start];
  let from = path.start;
  for (const one of path.segments) {
    const count = one.kind === 'line' ? 1 : Math.max(2, Math.ceil(lengthOf(from, one) / distance(one.centre, one.to) / ARC_STEP));
    for (let i = 1; i <= count; i += 1) {
      out.push(along(from, one, i / count));
    }
    from = one.to;
  }
  return out;
}
function box(frame: Frame, x: number, y: number, corner: number): Point[] {
  return pointsOf(placePath(frame, ringPath({ x, y, radius: corner }, false, 'bottom')));
}

function faceSketch(d: Draft, v: Values): void {
  const [length, width, step] = [num(v, 'length'), num(v, 'width'), num(v, 'step_over')];
  const low = word(v, 'origin') === 'corner' ? { x: num(v, 'x'), y: num(v, 'y') } : { x: num(v, 'x') - length / 2, y: num(v, 'y') - width / 2 };
  const at = (x: number, y: number): Point => ({ x: low.x + x, y: low.y + y });
  d.outline('cut', [at(0, 0), at(length, 0), at(length, width), at(0, width)]);
  const first = width + num(v, 'diameter') / 2 - step;
  d.tool(v, at(0, first));
  d.outline('thin', [at(0, first), at(length, first)], false);
  d.outline('thin', [at(0, first - step), at(length, first - step)], false);
  d.dimension('step_over', at(length, first - step), at(length, first), -1);
  d.dimension('length', at(0, 0), at(length, 0), -1);
  d.dimension('width', at(0, 0), at(0, width), 1.3);
  d.mark(['x', 'y', 'origin'], { x: num(v, 'x'), y: num(v, 'y') });
}

function pocketSketch(d: Draft, v: Values, frame: Frame, x: number, y: number, corner: number): void {
  const inset = num(v, 'diameter') / 2 + num(v, 'allowance');
  d.outline('cut', box(frame, x, y, corner));
  if (num(v, 'allowance') > 0 && x > inset && y > inset) {
    d.outline('thin', box(frame, x - num(v, 'allowance'), y - num(v, 'allowance'), Math.max(0, corner - num(v, 'allowance'))));
    d.dimension('allowance', place(frame, { x: x - num(v, 'allowance'), y: 0 }), place(frame, { x, y: 0 }), 0.5);
  }
  const at = place(frame, { x: x - inset, y: inset - y });
  d.tool(v, at);
  const next = { x: at.x - num(v, 'step_over'), y: at.y };
  d.outline('thin', circle(next, num(v, 'diameter') / 2));
  d.dimension('step_over', next, at, 0.6);
}

function rectPocketSketch(d: Draft, v: Values): void {
  const turn = (num(v, 'angle') * Math.PI) / 180;
  const [x, y, corner] = [num(v, 'length') / 2, num(v, 'width') / 2, num(v, 'corner_radius')];
  const given = { x: num(v, 'x'), y: num(v, 'y'), turn };
  const frame = word(v, 'origin') === 'corner' ? { ...place(given, { x, y }), turn } : given;
  const at = (px: number, py: number): Point => place(frame, { x: px, y: py });
  pocketSketch(d, v, frame, x, y, Math.min(corner, x, y));
  d.dimension('length', at(-x, -y), at(x, -y), -1);
  d.dimension('width', at(-x, -y), at(-x, y), 1);
  d.dimension('corner_radius', at(x - corner, y - corner), at(x - corner * (1 - Math.SQRT1_2), y - corner * (1 - Math.SQRT1_2)), 0.01);
  d.dimension('angle', at(0, 0), at(x, 0), 0.01);
  d.mark(['x', 'y', 'origin'], given);
}

function roundPocketSketch(d: Draft, v: Values): void {
  const radius = num(v, 'pocket_diameter') / 2;
  const frame = { x: num(v, 'x'), y: num(v, 'y'), turn: 0 };
  pocketSketch(d, v, frame, radius, radius, radius);
  d.dimension('pocket_diameter', { x: frame.x - radius, y: frame.y - radius }, { x: frame.x + radius, y: frame.y - radius }, -1);
  d.mark(['x', 'y'], frame);
}

function slotSketch(d: Draft, v: Values): void {
  const [a, b] = [{ x: num(v, 'x'), y: num(v, 'y') }, { x: num(v, 'x_end'), y: num(v, 'y_end') }];
  const half = num(v, 'slot_width') / 2;
  const frame = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, turn: Math.atan2(b.y - a.y, b.x - a.x) };
  pocketSketch(d, v, frame, distance(a, b) / 2 + half, half, half);
  d.dimension('slot_width', place(frame, { x: 0, y: -half }), place(frame, { x: 0, y: half }), 0.01);
  d.mark(['x', 'y'], a);
  d.mark(['x_end', 'y_end'], b);
}

function bossSketch(d: Draft, v: Values, x: number, y: number, corner: number): void {
  const frame = { x: num(v, 'x'), y: num(v, 'y'), turn: 0 };
  const stock = { x: num(v, 'stock_length') / 2, y: num(v, 'stock_width') / 2 };
  const at = (px: number, py: number): Point => place(frame, { x: px, y: py });
  const [sx, sy] = [Math.max(stock.x, x), Math.max(stock.y, y)];
  d.outline('cut', [at(-sx, -sy), at(sx, -sy), at(sx, sy), at(-sx, sy)]);
  d.outline('part', box(frame, x, y, Math.min(corner, x, y)));
  const rings = bossRings({ frame, x, y, corner: Math.min(corner, x, y), stock: { x: sx, y: sy } }, num(v, 'diameter'), num(v, 'step_over'), num(v, 'allowance'));
  const last = rings.at(-1);
  const radius = num(v, 'diameter') / 2;
  d.tool(v, at(-(x + radius + num(v, 'allowance')), 0));
  if (last !== undefined) {
    d.outline('thin', pointsOf(placePath(frame, ringPath(last, true, 'left'))));
  }
  d.dimension('step_over', at(-(x + radius + num(v, 'allowance') + num(v, 'step_over')), 0), at(-(x + radius + num(v, 'allowance')), 0), 0.8);
  d.dimension('allowance', at(-(x + num(v, 'allowance')), 0), at(-x, 0), -0.8);
  d.dimension('stock_length', at(-sx, -sy), at(sx, -sy), -1);
  d.dimension('stock_width', at(-sx, -sy), at(-sx, sy), 1);
  if (v['length'] === undefined) {
    d.dimension('boss_diameter', at(-x, y), at(x, y), 0.6);
  } else {
    d.dimension('length', at(-x, y), at(x, y), 0.6);
    d.dimension('width', at(x, -y), at(x, y), -0.6);
    d.dimension('corner_radius', at(x - corner, y - corner), at(x - corner * (1 - Math.SQRT1_2), y - corner * (1 - Math.SQRT1_2)), 0.01);
  }
  d.mark(['x', 'y'], frame);
}

function holesSketch(d: Draft, v: Values): void {
  const points = holesOf(v);
  const at = { x: num(v, 'x'), y: num(v, 'y') };
  points.forEach((p) => d.outline('cut', circle(p, num(v, 'diameter') / 2)));
  const [first, second] = points;
  if (first === undefined) {
    return;
  }
  const radius = num(v, 'diameter') / 2;
  d.dimension('diameter', { x: first.x - radius, y: first.y }, { x: first.x + radius, y: first.y }, 0.4);
  const pattern = word(v, 'pattern');
  if (pattern === 'circle') {
    const big = num(v, 'circle_diameter') / 2;
    d.outline('thin', circle(at, big));
    d.dimension('circle_diameter', { x: at.x - big, y: at.y - big - radius }, { x: at.x + big, y: at.y - big - radius }, -1);
    d.dimension('start_angle', at, first, 0.01);
    points.forEach((p) => d.mark(['holes'], p));
    d.mark(['x', 'y'], at);
  } else if (pattern === 'list') {
    points.forEach((p) => d.mark(['points'], p));
  } else {
    if (second !== undefined) {
      d.dimension(pattern === 'line' || num(v, 'columns') > 1 ? (pattern === 'line' ? 'spacing' : 'spacing_x') : 'spacing_y', first, second, -1);
    }
    const above = points[2 * num(v, 'columns') - 1];
    if (pattern === 'grid' && num(v, 'columns') > 1 && above !== undefined) {
      d.dimension('spacing_y', first, above, 1);
    }
    points.forEach((p) => d.mark(['holes', 'columns', 'rows'], p));
    d.dimension('angle', first, points[pattern === 'grid' ? Math.max(0, num(v, 'columns') - 1) : points.length - 1] ?? first, 0.01);
    d.mark(['x', 'y'], at);
  }
}

function threadSketch(d: Draft, v: Values): void {
  const at = { x: num(v, 'x'), y: num(v, 'y') };
  const [major, minor, tool] = [num(v, 'major') / 2, num(v, 'minor') / 2, num(v, 'diameter') / 2];
  const isIn = word(v, 'thread_side') === 'internal';
  d.outline(isIn ? 'cut' : 'part', circle(at, isIn ? major : minor));
  d.outline('thin', circle(at, isIn ? minor : major));
  d.tool(v, { x: at.x + (isIn ? major - tool : minor + tool), y: at.y });
  d.dimension('major', { x: at.x - major, y: at.y - major }, { x: at.x + major, y: at.y - major }, -1);
  d.dimension('minor', { x: at.x - minor, y: at.y + major }, { x: at.x + minor, y: at.y + major }, 0.8);
  d.mark(['x', 'y'], at);
}

function engraveSketch(d: Draft, v: Values): void {
  const at = { x: num(v, 'x'), y: num(v, 'y') };
  engravedStrokes(v).forEach((stroke) => d.outline('tool', stroke, false));
  const frame = { ...at, turn: (num(v, 'angle') * Math.PI) / 180 };
  const left = engravedStrokes({ ...v, angle: 0 }).flat().reduce((low, p) => Math.min(low, p.x), Infinity) - at.x;
  if (Number.isFinite(left)) {
    d.dimension('text_height', place(frame, { x: left, y: 0 }), place(frame, { x: left, y: num(v, 'text_height') }), 1);
  }
  d.mark(['x', 'y', 'align'], at);
}

function contourSketch(d: Draft, v: Values, context: Context): void {
  const contours = contoursOf(v, context);
  if (!Array.isArray(contours)) {
    return;
  }
  contours.forEach((one) => d.outline('part', pointsOf(one), false));
  const cuts = cutsOf(v, context);
  if (Array.isArray(cuts)) {
    cuts.forEach((one) => d.outline('thin', pointsOf(one.finish ?? one.rough), false));
    d.tool(v, (cuts[0]?.finish ?? cuts[0]?.rough)?.start ?? { x: 0, y: 0 });
  }
  d.mark(['x', 'y'], { x: num(v, 'x'), y: num(v, 'y') });
}

const SKETCHES: Record<string, (d: Draft, v: Values, context: Context) => void> = {
  face: faceSketch,
  rect_pocket: rectPocketSketch,
  round_pocket: roundPocketSketch,
  slot: slotSketch,
  rect_boss: (d, v) => bossSketch(d, v, num(v, 'length') / 2, num(v, 'width') / 2, num(v, 'corner_radius')),
  round_boss: (d, v) => bossSketch(d, v, num(v, 'boss_diameter') / 2, num(v, 'boss_diameter') / 2, num(v, 'boss_diameter') / 2),
  drill: holesSketch,
  tap: holesSketch,
  bore: holesSketch,
  thread_mill: threadSketch,
  engrave: engraveSketch,
  contour: contourSketch,
  ...LATHE_SKETCHES,
};

/** Invalid numbers and sizes of zero or less are replaced by their defaults for the drawing. */
function drawable(operation: Operation, values: Values, context: Context): Values {
  const usable = Object.fromEntries(
    operation.fields
      .filter((field) => {
        const value = values[field.id];
        const isAny = field.id === 'x' || field.id === 'y' || field.id === 'x_end' || field.id === 'y_end' || field.kind === 'angle' || field.id === 'top' || field.id.startsWith('z_') || field.id === 'end_diameter' || field.id === 'nose' || field.id.endsWith('allowance') || field.id === 'corner_radius';
        return typeof value === 'number' ? Number.isFinite(value) && Math.abs(value) < 1e5 && (isAny || value > 0) && (field.kind !== 'count' || value <= 1000) : value !== undefined;
      })
      .map((field) => [field.id, values[field.id] as number | string]),
  );
  return filled(operation, usable, context);
}

export function sketchOf(operation: Operation, values: Values, context: Context): Sketch {
  const draft = new Draft();
  const usable = drawable(operation, values, context);
  for (const field of ['allowance', 'corner_radius']) {
    if (num(usable, field) < 0) {
      usable[field] = 0;
    }
  }
  if (num(usable, 'columns') * num(usable, 'rows') > 1000) {
    usable['rows'] = 1;
  }
  SKETCHES[operation.id]?.(draft, usable, context);
  return draft.sketch;
}

export type { Dimension, Outline, Sketch } from './sketch_draft';
