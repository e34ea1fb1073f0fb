// SPDX-License-Identifier: GPL-2.0-or-later
// Paths in a plane from straight lines and arcs, and their position in a form.

export interface Point {
  x: number;
  y: number;
}
export interface Line {
  kind: 'line';
  to: Point;
}
export interface Arc {
  kind: 'arc';
  to: Point;
  centre: Point;
  isCw: boolean;
}
export type Segment = Line | Arc;
export interface Path {
  start: Point;
  segments: Segment[];
}

/** Below the length of any move of a program. */
export const TINY = 1e-6;

export const distance = (a: Point, b: Point): number => Math.hypot(a.x - b.x, a.y - b.y);
export const endOf = (path: Path): Point => path.segments.at(-1)?.to ?? path.start;
export const isClosed = (path: Path, tolerance = 1e-6): boolean => path.segments.length > 0 && distance(path.start, endOf(path)) <= tolerance;

/** A position and a rotation of the drawing of an operation [rad]. */
export interface Frame {
  x: number;
  y: number;
  turn: number;
}

export function place(frame: Frame, p: Point): Point {
  const [c, s] = [Math.cos(frame.turn), Math.sin(frame.turn)];
  return { x: frame.x + c * p.x - s * p.y, y: frame.y + s * p.x + c * p.y };
}

export function placePath(frame: Frame, path: Path): Path {
  return {
    start: place(frame, path.start),
    segments: path.segments.map((one) => (one.kind === 'line' ? { kind: 'line', to: place(frame, one.to) } : { ...one, to: place(frame, one.to), centre: place(frame, one.centre) })),
  };
}

/** The angle of an arc, always positive; a full circle if its ends coincide [rad]. */
export function sweepOf(from: Point, arc: Arc): number {
  if (distance(from, arc.to) < TINY) {
    return 2 * Math.PI;
  }
  const a = Math.atan2(from.y - arc.centre.y, from.x - arc.centre.x);
  const b = Math.atan2(arc.to.y - arc.centre.y, arc.to.x - arc.centre.x);
  const turned = arc.isCw ? a - b : b - a;
  const sweep = ((turned % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI);
  return sweep;
}

export function lengthOf(from: Point, one: Segment): number {
  return one.kind === 'line' ? distance(from, one.to) : sweepOf(from, one) * distance(one.centre, one.to);
}

export function pathLength(path: Path): number {
  let [from, sum] = [path.start, 0];
  for (const one of path.segments) {
    sum += lengthOf(from, one);
    from = one.to;
  }
  return sum;
}

/** The point at a fraction of a segment. */
export function along(from: Point, one: Segment, share: number): Point {
  if (one.kind === 'line') {
    return { x: from.x + (one.to.x - from.x) * share, y: from.y + (one.to.y - from.y) * share };
  }
  const radius = distance(one.centre, from);
  const angle = Math.atan2(from.y - one.centre.y, from.x - one.centre.x) + (one.isCw ? -1 : 1) * sweepOf(from, one) * share;
  return { x: one.centre.x + radius * Math.cos(angle), y: one.centre.y + radius * Math.sin(angle) };
}

export function reversed(path: Path): Path {
  const points = [path.start, ...path.segments.map((one) => one.to)];
  const segments = path.segments.map((one, i): Segment => {
    const to = points[i] as Point;
    return one.kind === 'line' ? { kind: 'line', to } : { ...one, to, isCw: !one.isCw };
  });
  return { start: endOf(path), segments: segments.reverse() };
}

/** If the ends of an arc were moved slightly, moves its centre so that both ends have the same radius. */
export function refitted(path: Path): Path {
  let from = path.start;
  const segments = path.segments.map((one): Segment => {
    const begin = from;
    from = one.to;
    const [dx, dy] = [one.to.x - begin.x, one.to.y - begin.y];
    const square = dx * dx + dy * dy;
    if (one.kind === 'line' || square < TINY * TINY) {
      return one;
    }
    const middle = { x: begin.x + dx / 2, y: begin.y + dy / 2 };
    const off = (dx * (one.centre.x - middle.x) + dy * (one.centre.y - middle.y)) / square;
    return { ...one, centre: { x: one.centre.x - off * dx, y: one.centre.y - off * dy } };
  });
  return { start: path.start, segments };
}

/** Splits at `length`: the first part, and the rest. */
export function splitPath(path: Path, length: number): [Path, Path] {
  const first: Path = { start: path.start, segments: [] };
  let [from, left] = [path.start, length];
  for (const [i, one] of path.segments.entries()) {
    const own = lengthOf(from, one);
    if (own > left + TINY) {
      const cut = along(from, one, left / own);
      if (left > TINY) {
        first.segments.push({ ...one, to: cut });
      }
      return [first, { start: left > TINY ? cut : from, segments: path.segments.slice(i) }];
    }
    first.segments.push(one);
    left -= own;
    from = one.to;
  }
  return [first, { start: from, segments: [] }];
}

/** Points along the path at a spacing of at most `step`. */
export function samples(path: Path, step: number): Point[] {
  const points = [path.start];
  let from = path.start;
  for (const one of path.segments) {
    const count = Math.max(1, Math.ceil(lengthOf(from, one) / step));
    for (let i = 1; i <= count; i += 1) {
      points.push(along(from, one, i / count));
    }
    from = one.to;
  }
  return points;
}

export interface Ring {
  /** Half the size, and the radius of the corners. */
  x: number;
  y: number;
  radius: number;
  /** Maximum distance of points from the axes. */
  clip?: Point;
}

/**
 * A rectangle with round corners around the origin. It starts in the middle of its lower side (`bottom`) or
 * of its left side.
 */
export function ringPath(ring: Ring, isCw: boolean, from: 'bottom' | 'left'): Path {
  const quarter = quarterOf(ring);
  // Counterclockwise from the middle of the right side; each quarter mirrors the previous one.
  const mirror = (signX: number, signY: number): Point[] => quarter.points.map((p) => ({ x: signX * p.x, y: signY * p.y }));
  const quarters = [mirror(1, 1), mirror(-1, 1).reverse(), mirror(-1, -1), mirror(1, -1).reverse()];
  const centres = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([sx, sy]) => ({ x: (sx ?? 0) * quarter.centre.x, y: (sy ?? 0) * quarter.centre.y }));
  const order = from === 'bottom' ? [3, 0, 1, 2] : [2, 3, 0, 1];
  const first = from === 'bottom' ? { x: 0, y: -quarter.top } : { x: -quarter.side, y: 0 };
  const path: Path = { start: first, segments: [] };
  let at = first;
  const add = (one: Segment): void => {
    if (distance(at, one.to) > TINY) {
      path.segments.push(one);
      at = one.to;
    }
  };
  for (const k of order) {
    const [begin, end] = quarters[k] as [Point, Point | undefined];
    add({ kind: 'line', to: begin });
    if (end !== undefined) {
      add({ kind: 'arc', to: end, centre: centres[k] as Point, isCw: false });
    }
  }
  add({ kind: 'line', to: first });
  return isCw ? reversed(path) : path;
}

/** The corner in the first quarter: one point, or the ends of its arc. */
function quarterOf(ring: Ring): { points: Point[]; centre: Point; side: number; top: number } {
  const radius = Math.min(ring.radius, ring.x, ring.y);
  const centre = { x: ring.x - radius, y: ring.y - radius };
  const [side, top] = [Math.min(ring.x, ring.clip?.x ?? ring.x), Math.min(ring.y, ring.clip?.y ?? ring.y)];
  const begin = side >= ring.x ? 0 : side > centre.x ? Math.acos((side - centre.x) / radius) : Math.PI / 2;
  const end = top >= ring.y ? Math.PI / 2 : top > centre.y ? Math.asin((top - centre.y) / radius) : 0;
  if (radius < TINY || end - begin < 1e-9) {
    return { points: [{ x: side, y: top }], centre, side, top };
  }
  const at = (angle: number): Point => ({ x: centre.x + radius * Math.cos(angle), y: centre.y + radius * Math.sin(angle) });
  return { points: [at(begin), at(end)], centre, side, top };
}
