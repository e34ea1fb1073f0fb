// SPDX-License-Identifier: GPL-2.0-or-later
// Clears the material around a boss: rings from the outside of the stock inwards, level by level.
import { place, placePath, ringPath, type Frame, type Point, type Ring } from './path2';
import { num, word, type Context, type Values } from './types';
import { levelsOf, type Writer } from './writer';

export interface Boss {
  frame: Frame;
  /** Half the size, and the radius of the corners. */
  x: number;
  y: number;
  corner: number;
  /** Half the size of the stock. */
  stock: Point;
}

/** Paths of the tool centre at equal distances from the boss, the outermost first. No path is far outside the stock. */
export function bossRings(boss: Boss, diameter: number, stepOver: number, inset: number): Ring[] {
  const radius = diameter / 2;
  const first = radius + inset;
  const corner = Math.hypot(Math.max(0, boss.stock.x - (boss.x - boss.corner)), Math.max(0, boss.stock.y - (boss.y - boss.corner))) - boss.corner;
  const reach = corner - 0.95 * radius;
  const steps = Math.max(0, Math.ceil((reach - first) / stepOver - 1e-9));
  const over = Math.max(0.1 * radius, stepOver - radius) + 0.05 * radius;
  const clip = { x: Math.max(boss.stock.x + over, boss.x + first), y: Math.max(boss.stock.y + over, boss.y + first) };
  return Array.from({ length: steps + 1 }, (_, i) => {
    const offset = first + ((steps - i) / Math.max(1, steps)) * Math.max(0, reach - first);
    return { x: boss.x + offset, y: boss.y + offset, radius: boss.corner + offset, clip };
  });
}

export function clearBoss(writer: Writer, values: Values, boss: Boss, context: Context): void {
  const [feed, top, clearance] = [num(values, 'feed'), num(values, 'top'), num(values, 'clearance')];
  const [diameter, allowance] = [num(values, 'diameter'), num(values, 'allowance')];
  const isCw = word(values, 'direction') === 'climb';
  const rings = bossRings(boss, diameter, num(values, 'step_over'), allowance);
  const paths = rings.map((ring) => placePath(boss.frame, ringPath(ring, isCw, 'left')));
  const outside = place(boss.frame, { x: -Math.max(boss.stock.x + diameter / 2 + clearance, boss.x + diameter / 2 + allowance + clearance), y: 0 });
  writer.rapid(outside);
  writer.rapid({ z: top + clearance });
  const levels = levelsOf(top, num(values, 'depth'), num(values, 'step_down'));
  for (const [i, z] of levels.entries()) {
    writer.comment(`Level ${i + 1} of ${levels.length}`);
    writer.feed(outside, feed);
    writer.feed({ z }, num(values, 'feed_z'));
    for (const path of paths) {
      writer.feed(path.start, feed);
      writer.follow(path, feed);
    }
    if (allowance > 0) {
      finish(writer, values, boss, isCw);
    }
  }
  writer.feed(outside, feed);
  writer.rapid({ z: context.safe });
}

/** Once around the finished boss, with a tangential arc in and out. */
function finish(writer: Writer, values: Values, boss: Boss, isCw: boolean): void {
  const [feed, radius] = [num(values, 'feed'), num(values, 'diameter') / 2];
  const ring = ringPath({ x: boss.x + radius, y: boss.y + radius, radius: boss.corner + radius }, isCw, 'left');
  const path = placePath(boss.frame, ring);
  const lead = radius / 2;
  const aside = isCw ? -lead : lead;
  const x = -(boss.x + radius) - lead;
  const at = (y: number): Point => place(boss.frame, { x, y });
  writer.feed(at(aside), feed);
  writer.arc(path.start, at(0), !isCw, feed);
  writer.follow(path, feed);
  writer.arc(at(-aside), at(0), !isCw, feed);
}
