// SPDX-License-Identifier: GPL-2.0-or-later
// Points along an arc or helix with the accuracy of the server's, for programs that are not from the server.
import type { Triple } from '../../src/lib/simulation/stock';

/** Maximum distance of chords from their arc. [mm] */
export const DEVIATION_MM = 0.005;
const LEAST_PER_TURN = 12;

export interface Arc {
  from: Triple;
  to: Triple;
  centre: Triple;
  /** Axis of the arc: 0 X, 1 Y, 2 Z. */
  about: 0 | 1 | 2;
  /** Signed, counter-clockwise seen from the positive end of the axis. */
  angle_rad: number;
}

/** Points after the start, up to the end. */
export function pointsOf(arc: Arc): Triple[] {
  const { from, to, centre, about, angle_rad } = arc;
  const [first, second] = [((about + 1) % 3) as 0 | 1 | 2, ((about + 2) % 3) as 0 | 1 | 2];
  const begin = Math.atan2(from[second] - centre[second], from[first] - centre[first]);
  const radius = Math.hypot(from[second] - centre[second], from[first] - centre[first]);
  const last = Math.hypot(to[second] - centre[second], to[first] - centre[first]);
  const flat = Math.max(-1, 1 - DEVIATION_MM / Math.max(radius, last, DEVIATION_MM));
  const per_turn = Math.max(LEAST_PER_TURN, Math.PI / Math.acos(flat));
  const count = Math.max(1, Math.ceil((Math.abs(angle_rad) / (2 * Math.PI)) * per_turn));
  const points: Triple[] = [];
  for (let i = 1; i < count; ++i) {
    const part = i / count;
    const [angle, reach] = [begin + angle_rad * part, radius + (last - radius) * part];
    const point: Triple = [0, 0, 0];
    point[first] = centre[first] + reach * Math.cos(angle);
    point[second] = centre[second] + reach * Math.sin(angle);
    point[about] = from[about] + (to[about] - from[about]) * part;
    points.push(point);
  }
  points.push([...to]);
  return points;
}
