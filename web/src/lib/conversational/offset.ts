// SPDX-License-Identifier: GPL-2.0-or-later
// Path of a tool's centre beside a contour: each segment is shifted to its left, outer corners get arcs,
// inner corners intersections. The result is checked with all contours, so that the path is never nearer to a
// contour than the tool's radius.
import { along, distance, isClosed, lengthOf, refitted, samples, type Arc, type Path, type Point, type Segment } from './path2';
import type { Fault } from './types';

export type Offset = { path: Path } | { fault: Fault };

interface Piece {
  from: Point;
  segment: Segment;
  /** Corner of the contour, at the end of the segment. */
  corner: Point;
}

const faultAt = (key: Fault['key'], p: Point): { fault: Fault } => ({ fault: { key, values: { x: Math.round(p.x * 1e4) / 1e4, y: Math.round(p.y * 1e4) / 1e4 } } });

/** Direction of travel at the start or the end of a segment. */
function heading(from: Point, one: Segment, isEnd: boolean): Point {
  if (one.kind === 'line') {
    const length = distance(from, one.to);
    return { x: (one.to.x - from.x) / length, y: (one.to.y - from.y) / length };
  }
  const at = isEnd ? one.to : from;
  const radius = distance(at, one.centre);
  const sign = one.isCw ? -1 : 1;
  return { x: (-sign * (at.y - one.centre.y)) / radius, y: (sign * (at.x - one.centre.x)) / radius };
}

/** The segment shifted to the left; null if an inner arc has no radius left. */
function shifted(from: Point, one: Segment, by: number): Piece | null {
  const left = (isEnd: boolean, p: Point): Point => {
    const t = heading(from, one, isEnd);
    return { x: p.x - t.y * by, y: p.y + t.x * by };
  };
  if (one.kind === 'arc' && distance(one.centre, from) + (one.isCw ? by : -by) < 1e-7) {
    return null;
  }
  return { from: left(false, from), segment: { ...one, to: left(true, one.to) }, corner: one.to };
}

/**
 * The path at distance `by` to the left of `contour`. Gaps of at most `tolerance` between shifted segments
 * are closed without a corner.
 */
export function offsetLeft(contour: Path, by: number, tolerance = 1e-7): Offset {
  const isLoop = isClosed(contour);
  const pieces: Piece[] = [];
  let from = contour.start;
  for (const one of contour.segments) {
    const radius = one.kind === 'arc' ? distance(one.centre, from) : Infinity;
    if (one.kind === 'arc' && !one.isCw && radius < by - 1e-6) {
      return { fault: { key: 'fault.tight', values: { radius: Math.round(radius * 1e4) / 1e4, x: Math.round(one.centre.x * 1e4) / 1e4, y: Math.round(one.centre.y * 1e4) / 1e4 } } };
    }
    const piece = shifted(from, one, by);
    const last = pieces.at(-1);
    if (piece !== null) {
      pieces.push(piece);
    } else if (last !== undefined) {
      last.corner = one.to;
    }
    from = one.to;
  }
  return pieces.length === 0 ? faultAt('fault.no_room', contour.start) : connected(pieces, isLoop, tolerance);
}

function connected(pieces: Piece[], isLoop: boolean, tolerance: number): Offset {
  const out: { from: Point; segment: Segment }[] = pieces.map((one) => ({ from: one.from, segment: one.segment }));
  const arcs = new Map<number, Arc>();
  const joints = isLoop ? pieces.length : pieces.length - 1;
  for (let i = 0; i < joints; i += 1) {
    const [a, b] = [out[i] as Piece, out[(i + 1) % out.length] as Piece];
    const corner = (pieces[i] as Piece).corner;
    if (distance(a.segment.to, b.from) < tolerance) {
      const middle = { x: (a.segment.to.x + b.from.x) / 2, y: (a.segment.to.y + b.from.y) / 2 };
      a.segment = { ...a.segment, to: middle };
      b.from = middle;
      continue;
    }
    const [ta, tb] = [heading(a.from, a.segment, true), heading(b.from, b.segment, false)];
    const turn = ta.x * tb.y - ta.y * tb.x;
    const isBack = ta.x * tb.x + ta.y * tb.y < 0;
    if (turn < -1e-9 || (Math.abs(turn) <= 1e-9 && isBack)) {
      arcs.set(i, { kind: 'arc', to: b.from, centre: corner, isCw: true });
      continue;
    }
    const meeting = meet(a, b, corner);
    if (meeting === null) {
      return faultAt('fault.no_room', corner);
    }
    a.segment = { ...a.segment, to: meeting };
    b.from = meeting;
  }
  const turned = out.find((one, i) => isTurned(pieces[i] as Piece, one));
  if (turned !== undefined) {
    return faultAt('fault.no_room', turned.from);
  }
  const segments = out.flatMap((one, i): Segment[] => (arcs.has(i) ? [one.segment, arcs.get(i) as Arc] : [one.segment]));
  return { path: refitted({ start: (out[0] as Piece).from, segments }) };
}

/** True if the segment runs backwards after its ends were moved to the corners. */
function isTurned(before: Piece, after: { from: Point; segment: Segment }): boolean {
  if (after.segment.kind === 'line') {
    const t = heading(before.from, before.segment, false);
    return (after.segment.to.x - after.from.x) * t.x + (after.segment.to.y - after.from.y) * t.y < -1e-9;
  }
  return distance(after.from, after.segment.to) > 1e-9 && lengthOf(after.from, after.segment) > lengthOf(before.from, before.segment) + 1e-6;
}

/** The intersection of two shifted segments, or of their extensions, that is nearest to the corner. */
function meet(a: { from: Point; segment: Segment }, b: { from: Point; segment: Segment }, corner: Point): Point | null {
  const found =
    a.segment.kind === 'line'
      ? b.segment.kind === 'line'
        ? lineLine(a.from, a.segment.to, b.from, b.segment.to)
        : lineCircle(a.from, a.segment.to, b.segment.centre, distance(b.segment.centre, b.from))
      : b.segment.kind === 'line'
        ? lineCircle(b.from, b.segment.to, a.segment.centre, distance(a.segment.centre, a.from))
        : circleCircle(a.segment.centre, distance(a.segment.centre, a.from), b.segment.centre, distance(b.segment.centre, b.from));
  return found.sort((p, q) => distance(p, corner) - distance(q, corner))[0] ?? null;
}

function lineLine(a: Point, b: Point, c: Point, d: Point): Point[] {
  const [ux, uy, vx, vy] = [b.x - a.x, b.y - a.y, d.x - c.x, d.y - c.y];
  const cross = ux * vy - uy * vx;
  if (Math.abs(cross) < 1e-12) {
    return [];
  }
  const share = ((c.x - a.x) * vy - (c.y - a.y) * vx) / cross;
  return [{ x: a.x + ux * share, y: a.y + uy * share }];
}
function lineCircle(a: Point, b: Point, centre: Point, radius: number): Point[] {
  const length = distance(a, b);
  const [ux, uy] = [(b.x - a.x) / length, (b.y - a.y) / length];
  const foot = (centre.x - a.x) * ux + (centre.y - a.y) * uy;
  const [px, py] = [a.x + ux * foot, a.y + uy * foot];
  const square = radius * radius - (px - centre.x) ** 2 - (py - centre.y) ** 2;
  if (square < -1e-9) {
    return [];
  }
  const half = Math.sqrt(Math.max(0, square));
  return [-half, half].map((s) => ({ x: px + ux * s, y: py + uy * s }));
}
function circleCircle(a: Point, ra: number, b: Point, rb: number): Point[] {
  const d = distance(a, b);
  if (d < 1e-9) {
    return [];
  }
  const along1 = (ra * ra - rb * rb + d * d) / (2 * d);
  const square = ra * ra - along1 * along1;
  if (square < -1e-9) {
    return [];
  }
  const h = Math.sqrt(Math.max(0, square));
  const [ux, uy] = [(b.x - a.x) / d, (b.y - a.y) / d];
  return [-h, h].map((s) => ({ x: a.x + ux * along1 - uy * s, y: a.y + uy * along1 + ux * s }));
}

function distanceTo(p: Point, from: Point, one: Segment): number {
  const ends = Math.min(distance(p, from), distance(p, one.to));
  if (one.kind === 'line') {
    const length = distance(from, one.to);
    const share = length > 0 ? ((p.x - from.x) * (one.to.x - from.x) + (p.y - from.y) * (one.to.y - from.y)) / (length * length) : 0;
    return share > 0 && share < 1 ? distance(p, along(from, one, share)) : ends;
  }
  const radius = distance(one.centre, from);
  if (distance(p, one.centre) < 1e-9) {
    return radius;
  }
  const scale = radius / distance(p, one.centre);
  const on = { x: one.centre.x + (p.x - one.centre.x) * scale, y: one.centre.y + (p.y - one.centre.y) * scale };
  const total = lengthOf(from, one);
  const part = lengthOf(from, { ...one, to: on });
  return part <= total ? Math.min(ends, distance(p, on)) : ends;
}

/** A point of the path that is nearer than `least` to a contour; null if there is none. */
export function nearer(path: Path, contours: Path[], least: number, step: number): Point | null {
  for (const p of samples(path, step)) {
    for (const contour of contours) {
      let from = contour.start;
      for (const one of contour.segments) {
        if (distanceTo(p, from, one) < least) {
          return p;
        }
        from = one.to;
      }
    }
  }
  return null;
}
