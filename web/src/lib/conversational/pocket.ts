// SPDX-License-Identifier: GPL-2.0-or-later
// Clears pockets with the shape of a rectangle with round corners (which includes circle and slot): in rings
// from the middle outwards, level by level, with a finishing ring at each level.
import { depthFields, directionField, entryFields, feedDown, finishing, lengthFault, levelCount, slopeOf, stepDown, stepOver, toolFields } from './fields';
import { distance, place, placePath, ringPath, type Frame, type Path, type Point } from './path2';
import { num, word, type Context, type Faults, type Field, type Values } from './types';
import { levelsOf, type Writer } from './writer';

export interface Pocket {
  frame: Frame;
  /** Half the size, and the radius of the corners, of the finished pocket. */
  x: number;
  y: number;
  corner: number;
}

type Entry = { kind: 'plunge' } | { kind: 'helix'; radius: number } | { kind: 'line' };

/** Half size of the rectangle for the tool's centre while it clears. */
interface Region {
  x: number;
  y: number;
  corner: number;
}

const regionOf = (pocket: Pocket, inset: number): Region => ({ x: pocket.x - inset, y: pocket.y - inset, corner: Math.max(0, pocket.corner - inset) });

/** The pocket with its longer side along X. */
function lying(pocket: Pocket): Pocket {
  return pocket.x >= pocket.y ? pocket : { ...pocket, x: pocket.y, y: pocket.x, frame: { ...pocket.frame, turn: pocket.frame.turn + Math.PI / 2 } };
}

/** The possible entries of the tool into solid material; null if only a plunge is possible. */
function entryOf(pocket: Pocket, diameter: number, allowance: number, isPlunging: boolean): Entry | null {
  if (isPlunging) {
    return { kind: 'plunge' };
  }
  const { x, y } = regionOf(lying(pocket), diameter / 2 + allowance);
  if (x - y >= diameter) {
    return { kind: 'line' };
  }
  const radius = Math.min(0.45 * diameter, y);
  return radius >= 0.1 * diameter ? { kind: 'helix', radius } : x - y >= 0.25 * diameter ? { kind: 'line' } : null;
}

/** The fields of each pocket after those of its position and shape. */
export function pocketFields(): Field[] {
  return [...depthFields(), ...toolFields(), feedDown(), stepDown(), stepOver(), finishing(), directionField(), ...entryFields()];
}

/** Faults of several fields together: the tool with its allowance, its entry, and the length of the program. */
export function checkPocket(values: Values, pocket: Pocket): Faults {
  const width = 2 * Math.min(pocket.x, pocket.y);
  const diameter = num(values, 'diameter');
  const allowance = num(values, 'allowance');
  if (width < diameter + 2 * allowance - 1e-9) {
    return { allowance: { key: 'fault.allowance_room', values: { high: (width - diameter) / 2 } } };
  }
  const entry = entryOf(pocket, diameter, allowance, word(values, 'entry') === 'plunge');
  return entry === null ? { entry: { key: 'fault.no_entry' } } : lengthFault((levelCount(values) * 9 * (width / 2)) / num(values, 'step_over'), 'step_over');
}

interface Cut {
  pocket: Pocket;
  entry: Entry;
  values: Values;
  region: Region;
  isCw: boolean;
}

/** Writes the whole pocket. */
export function clearPocket(writer: Writer, values: Values, shape: Pocket, context: Context): void {
  const pocket = lying(shape);
  const diameter = num(values, 'diameter');
  const allowance = num(values, 'allowance');
  const cut: Cut = {
    pocket,
    values,
    entry: entryOf(pocket, diameter, allowance, word(values, 'entry') === 'plunge') ?? { kind: 'plunge' },
    region: regionOf(pocket, diameter / 2 + allowance),
    isCw: word(values, 'direction') === 'conventional',
  };
  const [top, clearance] = [num(values, 'top'), num(values, 'clearance')];
  writer.rapid(entryPoint(cut));
  writer.rapid({ z: top + clearance });
  const levels = levelsOf(top, num(values, 'depth'), num(values, 'step_down'));
  for (const [i, z] of levels.entries()) {
    writer.comment(`Level ${i + 1} of ${levels.length}`);
    writer.feed(entryPoint(cut), num(values, 'feed'));
    enter(writer, cut, z);
    clearLevel(writer, cut);
    if (allowance > 0) {
      finish(writer, cut);
    }
  }
  writer.rapid({ z: context.safe });
}

function entryPoint({ pocket, entry, region }: Cut): Point {
  const at = entry.kind === 'helix' ? { x: entry.radius, y: 0 } : entry.kind === 'line' ? { x: -(region.x - region.y), y: 0 } : { x: 0, y: 0 };
  return place(pocket.frame, at);
}

/** Moves down to `z` and clears the middle of the pocket, where the tool ends. */
function enter(writer: Writer, { pocket, entry, region, values, isCw }: Cut, z: number): void {
  const [feed, down] = [num(values, 'feed'), num(values, 'feed_z')];
  const half = region.x - region.y;
  const centre = place(pocket.frame, { x: 0, y: 0 });
  const middle = (x: number): Point => place(pocket.frame, { x, y: 0 });
  if (entry.kind === 'line') {
    writer.rampInto({ start: middle(-half), segments: [{ kind: 'line', to: middle(half) }] }, z, slopeOf(values), down, false);
    writer.feed(middle(half), feed);
  } else if (entry.kind === 'helix') {
    const start = middle(entry.radius);
    const turns = Math.max(1, Math.ceil((writer.z - z) / (2 * Math.PI * entry.radius * slopeOf(values)) - 1e-9));
    writer.arc({ ...start, z }, centre, isCw, down, turns);
    writer.arc(start, centre, isCw, feed);
    if (half > 0) {
      writer.feed(middle(half), feed);
      writer.feed(middle(-half), feed);
    }
  } else {
    writer.feed({ z }, down);
    if (half > 0) {
      writer.feed(middle(half), feed);
      writer.feed(middle(-half), feed);
    }
  }
  writer.feed(centre, feed);
}

function clearLevel(writer: Writer, { pocket, region, values, isCw }: Cut): void {
  const rings = region.y > 0 ? Math.ceil(region.y / num(values, 'step_over') - 1e-9) : 0;
  for (let k = 1; k <= rings; k += 1) {
    const inner = region.y * (1 - k / rings);
    const ring = ringPath({ x: region.x - inner, y: region.y - inner, radius: Math.max(0, region.corner - inner) }, isCw, 'bottom');
    const path = placePath(pocket.frame, ring);
    writer.feed(path.start, num(values, 'feed'));
    writer.follow(path, num(values, 'feed'));
  }
}

/** Once around the finished wall, with a tangential arc in and out. */
function finish(writer: Writer, { pocket, values, isCw }: Cut): void {
  const feed = num(values, 'feed');
  const radius = num(values, 'diameter') / 2;
  const wall = regionOf(pocket, radius);
  const ring = ringPath({ x: wall.x, y: wall.y, radius: wall.corner }, isCw, 'bottom');
  const lead = Math.min(radius, wall.y) / 2;
  const aside = isCw ? lead : -lead;
  const at = (x: number, y: number): Point => place(pocket.frame, { x, y });
  const [begin, centre, end] = [at(aside, lead - wall.y), at(0, lead - wall.y), at(-aside, lead - wall.y)];
  const path: Path = placePath(pocket.frame, ring);
  writer.feed(begin, feed);
  if (distance(begin, path.start) > 1e-4) {
    writer.arc(path.start, centre, isCw, feed);
  }
  writer.follow(path, feed);
  if (distance(end, path.start) > 1e-4) {
    writer.arc(end, centre, isCw, feed);
  }
}
