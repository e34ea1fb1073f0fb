// SPDX-License-Identifier: GPL-2.0-or-later
// Cuts the contours of one layer of a DXF drawing: on the line, or beside it by the tool's radius.
import { chained, signedArea, startedMidway } from '../chains';
import { layersOf, unpacked, type Entity } from '../dxf';
import { choice, depthFields, directionField, entryFields, feedDown, finishing, lengthFault, levelCount, longest, nice, position, slopeOf, stepDown, toolFields } from '../fields';
import { nearer, offsetLeft } from '../offset';
import { isClosed, placePath, reversed, type Path } from '../path2';
import { num, word, type Context, type Fault, type Operation, type Values } from '../types';
import { levelsOf, type Writer } from '../writer';

const isBeside = (values: Values): boolean => word(values, 'side') !== 'on';

export const contour: Operation = {
  id: 'contour',
  machine: 'mill',
  fields: [
    { id: 'drawing', kind: 'drawing', preset: '', check: drawingFault },
    { id: 'layer', kind: 'layer', preset: '', reason: 'why.layer', check: layerFault },
    choice('side', ['outside', 'inside', 'left', 'right', 'on'], 'outside', { reason: 'why.side' }),
    position('x', 0, { reason: 'why.shift' }),
    position('y', 0, { reason: 'why.shift' }),
    ...depthFields(),
    ...toolFields(),
    feedDown(),
    stepDown(),
    { ...finishing(), isShown: isBeside },
    { ...directionField(), isShown: isBeside },
    ...entryFields(),
  ],
  check: (values, context) => {
    const made = cutsOf(values, context);
    return Array.isArray(made) ? lengthFault(levelCount(values) * 3 * made.reduce((sum, one) => sum + one.rough.segments.length + 2, 0), 'step_down') : { [made.key === 'fault.side_open' || made.key === 'fault.side_closed' ? 'side' : made.key.startsWith('fault.dxf') ? 'layer' : 'diameter']: made };
  },
  write,
};

function drawingFault(text: string, _: Values, context: Context): Fault | null {
  const entities = unpacked(text);
  if (text === '' || entities === null || entities.length === 0) {
    return { key: 'fault.no_drawing' };
  }
  const isFar = entities.some((one) => [one.start, ...one.segments.map((segment) => segment.to)].some((p) => Math.max(Math.abs(p.x), Math.abs(p.y)) > longest(context.unit)));
  return isFar ? { key: 'fault.drawing_far', values: { high: longest(context.unit) } } : null;
}
function layerFault(text: string, values: Values): Fault | null {
  return layersOf(unpacked(word(values, 'drawing')) ?? []).includes(text) ? null : { key: 'fault.no_layer' };
}

export const chainTolerance = (context: Context): number => nice(context.unit, 0.01, 0.0005);

/** The contours of the layer at the position of the form. */
export function contoursOf(values: Values, context: Context): Path[] | Fault {
  const layer: Entity[] = (unpacked(word(values, 'drawing')) ?? []).filter((one) => one.layer === word(values, 'layer'));
  const found = chained(layer, chainTolerance(context));
  return 'fault' in found ? found.fault : found.chains.map((one) => placePath({ x: num(values, 'x'), y: num(values, 'y'), turn: 0 }, one));
}

interface Cuts {
  rough: Path;
  /** Null: the first path is also the last one. */
  finish: Path | null;
  isLoop: boolean;
}

/** The tool is to the left of the returned path. */
function oriented(path: Path, side: string): Path {
  const isLeftInside = side === 'inside' || side === 'outside' ? signedArea(path) > 0 === (side === 'inside') : side !== 'right';
  return isLeftInside ? path : reversed(path);
}

function sideFault(contours: Path[], side: string): Fault | null {
  const isLoopNeeded = side === 'inside' || side === 'outside';
  const wrong = contours.find((one) => side !== 'on' && isClosed(one) !== isLoopNeeded);
  if (wrong === undefined) {
    return null;
  }
  return { key: isLoopNeeded ? 'fault.side_open' : 'fault.side_closed', values: { x: wrong.start.x, y: wrong.start.y } };
}

export function cutsOf(values: Values, context: Context): Cuts[] | Fault {
  const contours = contoursOf(values, context);
  if (!Array.isArray(contours)) {
    return contours;
  }
  const side = word(values, 'side');
  const wrong = sideFault(contours, side);
  if (wrong !== null) {
    return wrong;
  }
  const [radius, allowance] = [num(values, 'diameter') / 2, num(values, 'allowance')];
  const isBack = word(values, 'direction') === 'conventional';
  const out: Cuts[] = [];
  for (const one of contours) {
    const isLoop = isClosed(one);
    const started = isLoop ? startedMidway(one) : one;
    if (side === 'on') {
      out.push({ rough: started, finish: null, isLoop });
      continue;
    }
    const paths: Path[] = [];
    for (const by of allowance > 0 ? [radius + allowance, radius] : [radius]) {
      const made = offsetLeft(oriented(started, side), by, chainTolerance(context) / 2);
      if ('fault' in made) {
        return made.fault;
      }
      const near = nearer(made.path, contours, by - chainTolerance(context) / 2, radius / 4);
      if (near !== null) {
        return { key: 'fault.gouge', values: { x: near.x, y: near.y } };
      }
      paths.push(isBack ? reversed(made.path) : made.path);
    }
    out.push({ rough: paths[0] as Path, finish: paths[1] ?? null, isLoop });
  }
  return out;
}

function write(writer: Writer, values: Values, context: Context): void {
  const cuts = cutsOf(values, context);
  if (!Array.isArray(cuts)) {
    return;
  }
  for (const [i, one] of cuts.entries()) {
    writer.comment(`Contour ${i + 1} of ${cuts.length}`);
    cut(writer, values, context, one);
  }
}

function cut(writer: Writer, values: Values, context: Context, { rough, finish, isLoop }: Cuts): void {
  const [feed, down, top] = [num(values, 'feed'), num(values, 'feed_z'), num(values, 'top')];
  const above = top + num(values, 'clearance');
  writer.rapid({ z: context.safe });
  writer.rapid(rough.start);
  writer.rapid({ z: above });
  let before = above;
  const back = (z: number): void => {
    writer.rapid({ z: above });
    writer.rapid(rough.start);
    writer.feed({ z }, down);
  };
  for (const z of levelsOf(top, num(values, 'depth'), num(values, 'step_down'))) {
    if (!isLoop && before !== above) {
      back(before);
    }
    if (word(values, 'entry') === 'plunge') {
      writer.feed({ z }, down);
    } else {
      writer.rampInto(rough, z, slopeOf(values), down, isLoop);
    }
    writer.follow(rough, feed);
    if (finish !== null) {
      if (!isLoop) {
        back(z);
      }
      writer.feed(finish.start, feed);
      writer.follow(finish, feed);
      if (isLoop) {
        writer.feed(rough.start, feed);
      }
    }
    before = z;
  }
  writer.rapid({ z: context.safe });
}
