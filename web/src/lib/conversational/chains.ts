// SPDX-License-Identifier: GPL-2.0-or-later
// Joins the entities of a layer to contours.
import type { Entity } from './dxf';
import { distance, endOf, isClosed, lengthOf, refitted, reversed, samples, type Path, type Point } from './path2';
import type { Fault } from './types';

export type Chained = { chains: Path[] } | { fault: Fault };

const pointValues = (p: Point): Record<string, number> => ({ x: Math.round(p.x * 1e4) / 1e4, y: Math.round(p.y * 1e4) / 1e4 });

/** Contours of entities whose ends are at most `tolerance` apart. */
export function chained(entities: Entity[], tolerance: number): Chained {
  const bad = entities.find((one) => one.bad !== undefined);
  if (bad !== undefined) {
    return { fault: { key: 'fault.dxf_entity', values: { entity: bad.bad ?? '' } } };
  }
  const pieces = entities.map((one) => clean({ start: one.start, segments: one.segments }, tolerance)).filter((one) => one.segments.length > 0);
  if (pieces.length === 0) {
    return { fault: { key: 'fault.dxf_empty' } };
  }
  const closed = pieces.filter((one) => isClosed(one, tolerance));
  const open = pieces.filter((one) => !isClosed(one, tolerance));
  const crowd = crowded(open, tolerance);
  if (crowd !== null) {
    return { fault: { key: 'fault.dxf_branch', values: pointValues(crowd) } };
  }
  const chains = [...closed.map(snapped), ...joined(open, tolerance)].map(refitted);
  const twice = doubled(chains, tolerance);
  return twice === null ? { chains } : { fault: { key: 'fault.dxf_twice', values: pointValues(twice) } };
}

/** The path without segments shorter than the tolerance. */
function clean(path: Path, tolerance: number): Path {
  let from = path.start;
  const segments = path.segments.filter((one) => {
    const isLong = one.kind === 'arc' ? lengthOf(from, one) > tolerance : distance(from, one.to) > tolerance / 10;
    from = isLong ? one.to : from;
    return isLong;
  });
  return { start: path.start, segments };
}

/** The end of a closed path is its start. */
function snapped(path: Path): Path {
  const segments = path.segments.map((one, i) => (i === path.segments.length - 1 ? { ...one, to: path.start } : one));
  return { start: path.start, segments };
}

/** A point at which more than two ends meet; null if there is none. */
function crowded(open: Path[], tolerance: number): Point | null {
  const ends = open.flatMap((one) => [one.start, endOf(one)]);
  return ends.find((p) => ends.filter((q) => distance(p, q) <= tolerance).length > 2) ?? null;
}

function joined(open: Path[], tolerance: number): Path[] {
  const left = [...open];
  const chains: Path[] = [];
  for (let first = left.shift(); first !== undefined; first = left.shift()) {
    let chain = first;
    for (let isGrowing = true; isGrowing && !isClosed(chain, tolerance); ) {
      isGrowing = false;
      for (const [i, one] of left.entries()) {
        const grown = attach(chain, one, tolerance);
        if (grown !== null) {
          chain = grown;
          left.splice(i, 1);
          isGrowing = true;
          break;
        }
      }
    }
    chains.push(isClosed(chain, tolerance) ? snapped(chain) : chain);
  }
  return chains;
}

function attach(chain: Path, one: Path, tolerance: number): Path | null {
  const isNear = (a: Point, b: Point): boolean => distance(a, b) <= tolerance;
  if (isNear(endOf(chain), one.start)) {
    return { start: chain.start, segments: [...chain.segments, ...one.segments] };
  }
  if (isNear(endOf(chain), endOf(one))) {
    return { start: chain.start, segments: [...chain.segments, ...reversed(one).segments] };
  }
  if (isNear(chain.start, endOf(one))) {
    return { start: one.start, segments: [...one.segments, ...chain.segments] };
  }
  return isNear(chain.start, one.start) ? { start: endOf(one), segments: [...reversed(one).segments, ...chain.segments] } : null;
}

/** A point of a contour that coincides with another contour. */
function doubled(chains: Path[], tolerance: number): Point | null {
  const seen: Point[][] = [];
  for (const chain of chains) {
    const points = samples(chain, Infinity);
    const same = seen.find((other) => other.length === points.length && points.every((p) => other.some((q) => distance(p, q) <= tolerance)));
    if (same !== undefined) {
      return chain.start;
    }
    seen.push(points);
  }
  return null;
}

/** Twice the area of a closed path, positive if it is drawn counterclockwise. */
export function signedArea(path: Path): number {
  const points = samples(path, Math.max(1e-6, pathStep(path)));
  return points.reduce((sum, p, i) => {
    const q = points[(i + 1) % points.length] as Point;
    return sum + p.x * q.y - q.x * p.y;
  }, 0);
}
function pathStep(path: Path): number {
  let from = path.start;
  const lengths = path.segments.map((one) => {
    const length = lengthOf(from, one);
    from = one.to;
    return length;
  });
  return Math.max(...lengths) / 32;
}

/** A closed path that starts in the middle of its longest segment. */
export function startedMidway(path: Path): Path {
  let from = path.start;
  let best = { at: 0, length: -1 };
  for (const [i, one] of path.segments.entries()) {
    const length = lengthOf(from, one);
    best = length > best.length ? { at: i, length } : best;
    from = one.to;
  }
  const before = path.segments.slice(0, best.at);
  const one = path.segments[best.at];
  if (one === undefined) {
    return path;
  }
  const begin = before.at(-1)?.to ?? path.start;
  const middle = samples({ start: begin, segments: [one] }, best.length / 2 + 1e-9)[1] as Point;
  return { start: middle, segments: [one, ...path.segments.slice(best.at + 1), ...before, { ...one, to: middle }] };
}
