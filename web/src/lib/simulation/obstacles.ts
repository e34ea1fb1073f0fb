// SPDX-License-Identifier: GPL-2.0-or-later
// Checks moves of a tool with boxes: fixtures, and the floor below the stock.
import { CONTACT_MM, type Segment } from './sweep';
import { heightAt, type Cutter } from './shapes';
import type { Box } from './stock';

const ROUNDS = 40;

/** Distance from a point of the move to a box, in the plane. */
function distanceTo(box: Box, x: number, y: number): number {
  const dx = Math.max(box.low[0] - x, 0, x - box.high[0]);
  const dy = Math.max(box.low[1] - y, 0, y - box.high[1]);
  return Math.hypot(dx, dy);
}

/**
 * Depth of a tool in a box from above, and its position along the move; null if it does not touch the box.
 * `lift`: distance from the tip to the checked part. The height of the tool over the box is convex along the
 * move, so its lowest point is searched.
 */
export function depthIn(box: Box, move: Segment, cutter: Cutter, lift: number): { depth: number; part: number } | null {
  const radius = cutter.radius;
  const outside =
    Math.max(move.x0, move.x1) + radius <= box.low[0] || Math.min(move.x0, move.x1) - radius >= box.high[0] ||
    Math.max(move.y0, move.y1) + radius <= box.low[1] || Math.min(move.y0, move.y1) - radius >= box.high[1];
  if (outside || Math.min(move.z0, move.z1) + lift >= box.high[2]) {
    return null;
  }
  const clearance = (part: number): number => {
    const distance = distanceTo(box, move.x0 + part * (move.x1 - move.x0), move.y0 + part * (move.y1 - move.y0)) + CONTACT_MM;
    // Outside the radius the tool is treated as a steep cone, so that the search has a slope.
    const STEEP = 1e4;
    const height = distance <= radius ? heightAt(cutter, distance) : heightAt(cutter, radius) + STEEP * (distance - radius);
    return move.z0 + part * (move.z1 - move.z0) + lift + height;
  };
  let [low, high] = [0, 1];
  const golden = (Math.sqrt(5) - 1) / 2;
  for (let i = 0; i < ROUNDS; ++i) {
    const [a, b] = [high - golden * (high - low), low + golden * (high - low)];
    if (clearance(a) <= clearance(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  const part = [0, 1, (low + high) / 2].reduce((best, one) => (clearance(one) < clearance(best) ? one : best));
  const depth = box.high[2] - clearance(part);
  return depth > CONTACT_MM ? { depth, part } : null;
}
