// SPDX-License-Identifier: GPL-2.0-or-later
// Model of the tool: a cone on its point, the tip of a lathe tool, or the wire of a foam cutter.
import { BufferAttribute, BufferGeometry, ConeGeometry, DoubleSide, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, Shape, ShapeGeometry } from 'three';

export interface LatheTip {
  /** 1 to 9, as in the tool table. 0: not known. */
  orientation: number;
  /** Diameter of the nose. [machine units] */
  diameter: number;
  /** Angle of the edges, from Z+ towards X+. [degrees] */
  frontangle_deg: number;
  backangle_deg: number;
}

/** Offset from the centre of the nose to the controlled point, in radii along Z and X, by orientation. */
const SHIFTS: readonly (readonly [number, number])[] = [[0, 0], [1, -1], [-1, -1], [-1, 1], [1, 1], [1, 0], [0, -1], [-1, 0], [0, 1], [0, 0]];
/** Half angle of the body if its edges have no angles; it points away from the controlled point. */
const WIDE_DEG = 40;
const NOSE_POINTS = 24;

function cross(o: Point, a: Point, b: Point): number {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}
type Point = readonly [number, number];

/** The convex hull, counter-clockwise. */
function hull(points: Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list: Point[]): Point[] => {
    const out: Point[] = [];
    for (const one of list) {
      while (out.length >= 2 && cross(out[out.length - 2] as Point, out[out.length - 1] as Point, one) <= 0) {
        out.pop();
      }
      out.push(one);
    }
    return out.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

/**
 * Outline of a tip around its controlled point at 0, as points of Z and X; its edges have the length
 * `length`. [machine units]
 */
export function tipOutline(tip: LatheTip, length: number): Point[] {
  const radius = Math.max(tip.diameter / 2, length / 60);
  const [shiftZ, shiftX] = SHIFTS[tip.orientation] ?? [0, 0];
  const centre: Point = [-shiftZ * radius, -shiftX * radius];
  const points: Point[] = [];
  for (let i = 0; i < NOSE_POINTS; ++i) {
    const angle = (2 * Math.PI * i) / NOSE_POINTS;
    points.push([centre[0] + radius * Math.cos(angle), centre[1] + radius * Math.sin(angle)]);
  }
  const isRound = shiftZ === 0 && shiftX === 0;
  if (isRound) {
    return points;
  }
  const away = (Math.atan2(-shiftX, -shiftZ) * 180) / Math.PI;
  const hasEdges = tip.frontangle_deg !== 0 || tip.backangle_deg !== 0;
  for (const degrees of hasEdges ? [tip.frontangle_deg, tip.backangle_deg] : [away - WIDE_DEG, away + WIDE_DEG]) {
    const angle = (degrees * Math.PI) / 180;
    const [alongZ, alongX] = [Math.cos(angle), Math.sin(angle)];
    for (const side of [-1, 1]) {
      points.push([centre[0] + alongZ * length + side * radius * -alongX, centre[1] + alongX * length + side * radius * alongZ]);
    }
  }
  return hull(points);
}

/** A cone on its point. */
export function makeCone(): Mesh {
  const geometry = new ConeGeometry(4, 14, 20);
  geometry.rotateX(-Math.PI / 2);
  geometry.translate(0, 0, 7);
  return new Mesh(geometry, new MeshBasicMaterial({ transparent: true, opacity: 0.85, side: DoubleSide }));
}

/** The tip in the XZ plane, visible from both sides. */
export function tipGeometry(tip: LatheTip, length: number): BufferGeometry {
  const shape = new Shape();
  tipOutline(tip, length).forEach(([z, x], i) => (i === 0 ? shape.moveTo(x, z) : shape.lineTo(x, z)));
  const geometry = new ShapeGeometry(shape);
  geometry.rotateX(Math.PI / 2); // converts x, y of the shape to x, z
  return geometry;
}

/** The wire between the two ends of a foam cutter's tool. */
export function makeWire(): Line {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
  const wire = new Line(geometry, new LineBasicMaterial());
  wire.frustumCulled = false;
  wire.visible = false;
  return wire;
}
