// SPDX-License-Identifier: GPL-2.0-or-later
// Shapes of milling tools: the height of the cutting surface above the tip, by distance from the axis. All
// are convex, so the lowest point of a tool that moves along a line is unique. [mm]

export type ShapeName = 'flat' | 'ball' | 'bull' | 'vee' | 'drill';
export const SHAPE_NAMES: readonly ShapeName[] = ['flat', 'ball', 'bull', 'vee', 'drill'];

export interface ToolShape {
  shape: ShapeName;
  diameter_mm: number;
  /** Radius of a bull-nose mill. */
  corner_radius_mm: number;
  /** Included angle of a V tool or the point of a drill. */
  point_angle_deg: number;
  /** Diameter of the flat at the point of a V tool. */
  tip_diameter_mm: number;
  /** From the tip to the holder; null: unknown, and the holder is not checked. */
  stickout_mm: number | null;
  holder_diameter_mm: number;
}

export const ROUND = 0;
export const CONE = 1;
export const BULL = 2;
export const FLAT = 3;

/** Data for the calculation of the sweep. */
export interface Cutter {
  kind: typeof ROUND | typeof CONE | typeof BULL | typeof FLAT;
  radius: number;
  /** The surface is level up to this distance from the axis. */
  flat_radius: number;
  /** Radius of a corner. */
  corner: number;
  /** Rise per distance of a cone. */
  slope: number;
}

const HALF_TURN_DEG = 180;
const DRILL_ANGLE_DEG = 118;
const VEE_ANGLE_DEG = 90;

function slopeOf(included_deg: number): number {
  const half = (Math.min(Math.max(included_deg, 1), 179) / 2) * (Math.PI / HALF_TURN_DEG);
  return 1 / Math.tan(half);
}

export function cutterOf(tool: ToolShape): Cutter {
  const radius = tool.diameter_mm / 2;
  const plain: Cutter = { kind: FLAT, radius, flat_radius: radius, corner: 0, slope: 0 };
  switch (tool.shape) {
    case 'ball':
      return { ...plain, kind: ROUND, flat_radius: 0, corner: radius };
    case 'bull': {
      const corner = Math.min(Math.max(tool.corner_radius_mm, 0), radius);
      const isBall = corner >= radius;
      return corner === 0 ? plain : { ...plain, kind: isBall ? ROUND : BULL, flat_radius: radius - corner, corner };
    }
    case 'vee':
      return { ...plain, kind: CONE, flat_radius: Math.min(Math.max(tool.tip_diameter_mm / 2, 0), radius), slope: slopeOf(tool.point_angle_deg) };
    case 'drill':
      return { ...plain, kind: CONE, flat_radius: 0, slope: slopeOf(tool.point_angle_deg) };
    case 'flat':
      return plain;
  }
}

/** Height of the surface above the tip at a distance from the axis, up to the radius. */
export function heightAt(cutter: Cutter, distance: number): number {
  const beyond = distance - cutter.flat_radius;
  if (cutter.kind === FLAT || beyond <= 0) {
    return 0;
  }
  return cutter.kind === CONE ? cutter.slope * beyond : cutter.corner - Math.sqrt(Math.max(0, cutter.corner * cutter.corner - beyond * beyond));
}

/** Words of tool comments in the languages of the screen. */
const WORDS: readonly [RegExp, ShapeName][] = [
  [/bull|corner|radius|torus|torisch|t[oó]ric/i, 'bull'],
  [/ball|kugel|esf[eé]r|bola|sph/i, 'ball'],
  [/drill|bohrer|broca|spot|center|zentrier|\btap\b|gewinde/i, 'drill'],
  [/\bv\b|v-?bit|vee|engrav|gravier|grabad|chamfer|fase|chafl[aá]n/i, 'vee'],
];

/** Guesses the shape from the comment in the tool table. The operator can correct it. */
export function guessShape(diameter_mm: number, comment: string): ToolShape {
  const shape = WORDS.find(([words]) => words.test(comment))?.[1] ?? 'flat';
  const angle = Number(/(\d{2,3}(?:\.\d+)?)\s*(?:°|deg|grad)/i.exec(comment)?.[1] ?? NaN);
  const corner = Number(/\br\s?=?\s?(\d+(?:\.\d+)?)/i.exec(comment)?.[1] ?? NaN);
  return {
    shape,
    diameter_mm,
    corner_radius_mm: Number.isFinite(corner) ? Math.min(corner, diameter_mm / 2) : diameter_mm / 10,
    point_angle_deg: Number.isFinite(angle) ? angle : shape === 'vee' ? VEE_ANGLE_DEG : DRILL_ANGLE_DEG,
    tip_diameter_mm: 0,
    stickout_mm: null,
    holder_diameter_mm: 40,
  };
}
