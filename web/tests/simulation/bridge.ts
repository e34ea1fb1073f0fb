// SPDX-License-Identifier: GPL-2.0-or-later
// The simulation for tests/simulation/simulation_campaign.py: a job as a line of JSON in, its result as a
// line out. Moves are the canonical calls of rs274.
import { createInterface } from 'node:readline';
import type { Fixture, Stock, Triple } from '../../src/lib/simulation/stock';
import type { ToolShape } from '../../src/lib/simulation/shapes';
import { pointsOf } from './arcs';
import { movesOf, simulate, type Point } from './made';

interface Job {
  canon: string;
  stock: Stock;
  tools: Record<string, ToolShape>;
  fixtures: Fixture[];
  floor_mm: number;
}

const CALL = /^\s*\d+\s+N(\S+)\s+(\w+)\((.*)\)/;
const ABOUT: Record<string, 0 | 1 | 2> = { XY: 2, YZ: 0, XZ: 1 };

/** Signed angle of ARC_FEED, whose rotation counts started revolutions. */
function angleOf(from: [number, number], to: [number, number], rotation: number): number {
  const sign = Math.sign(rotation);
  let turn = sign * (Math.atan2(to[1], to[0]) - Math.atan2(from[1], from[0]));
  turn -= 2 * Math.PI * Math.floor(turn / (2 * Math.PI));
  return sign * ((turn < 1e-7 ? 2 * Math.PI : turn) + 2 * Math.PI * (Math.abs(rotation) - 1));
}

function read(canon: string): Point[] {
  const points: Point[] = [];
  let [at, about, tool, selected]: [Triple, 0 | 1 | 2, number, number] = [[0, 0, 0], 2, 0, 0];
  const add = (to: Triple, line: number, kind: number): void => {
    points.push({ at: to, line, kind, tool });
    at = to;
  };
  add([0, 0, 0], 0, 0);
  for (const text of canon.split('\n')) {
    const [, mark, call, inside] = CALL.exec(text) ?? [];
    const line = Number(mark) || 0;
    const values = (inside ?? '').split(',').map(Number);
    const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0] = values;
    if (call === 'SELECT_PLANE') {
      about = ABOUT[/_(\w\w)$/.exec(inside ?? '')?.[1] ?? 'XY'] ?? 2;
    } else if (call === 'SELECT_TOOL') {
      selected = a;
    } else if (call === 'CHANGE_TOOL') {
      tool = selected;
    } else if (call === 'STRAIGHT_TRAVERSE' || call === 'STRAIGHT_FEED') {
      add([a, b, c], line, call === 'STRAIGHT_FEED' ? 1 : 0);
    } else if (call === 'ARC_FEED') {
      const [first, second] = [((about + 1) % 3) as 0 | 1 | 2, ((about + 2) % 3) as 0 | 1 | 2];
      const [to, centre]: [Triple, Triple] = [[0, 0, 0], [0, 0, 0]];
      [to[first], to[second], to[about]] = [a, b, f];
      [centre[first], centre[second]] = [c, d];
      const from: Triple = [...at];
      const angle_rad = angleOf([from[first] - c, from[second] - d], [a - c, b - d], e);
      pointsOf({ from, to, centre, about, angle_rad }).forEach((point) => add(point, line, 2));
    }
  }
  return points;
}

for await (const text of createInterface({ input: process.stdin })) {
  const job = JSON.parse(text) as Job;
  const tools = new Map(Object.entries(job.tools).map(([number, tool]) => [Number(number), tool]));
  const made = simulate(movesOf(read(job.canon), 0), { stock: job.stock, tools, fixtures: job.fixtures, floor_mm: job.floor_mm });
  const whole = made.field.volume();
  made.goTo(0);
  const removed_mm3 = made.field.volume() - whole;
  process.stdout.write(`${JSON.stringify({ removed_mm3, findings: made.findings.list(), cell_mm: made.field.cell })}\n`);
}
