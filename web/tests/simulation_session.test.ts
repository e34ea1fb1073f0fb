// SPDX-License-Identifier: GPL-2.0-or-later
// Tests a program in the worker of the simulation: its time, its lines, the picture, and messages that arrive
// while it is prepared.
import { describe, expect, it } from 'vitest';
import { Clock } from '../src/lib/simulation/clock';
import { Display, reduced } from '../src/lib/simulation/display';
import { Field, TILE } from '../src/lib/simulation/field';
import { Findings, MOST_FINDINGS } from '../src/lib/simulation/findings';
import { Follower } from '../src/lib/simulation/follow';
import { MOST_STOCKS, withStock } from '../src/lib/simulation/kept';
import { Session } from '../src/lib/simulation/session';
import type { Setup } from '../src/lib/simulation/simulation';
import { BOX, movesOf, tool, type Point } from './simulation/made';

const SQUARE: Point[] = [
  { at: [0, 0, 5], line: 1, kind: 0 },
  { at: [10, 0, 5], line: 2, kind: 0 },
  { at: [10, 0, -1], line: 3, kind: 1 },
  { at: [30, 0, -1], line: 4, kind: 1 },
  { at: [30, 20, -1], line: 4, kind: 1 },
  { at: [10, 0, -1], line: 5, kind: 1 },
];

describe('time', () => {
  it('is estimated by lengths, and goes back to moves', () => {
    const clock = new Clock(movesOf(SQUARE), 10);
    expect(clock.at(1)).toBeCloseTo(1, 9); // 10 mm of rapid at 10 mm/s
    expect(clock.at(2)).toBeCloseTo(7, 9); // 6 mm without a feed, at 1 mm/s
    for (const moves of [0, 0.5, 1, 2.25, 4.9, 5]) {
      expect(clock.movesAt(clock.at(moves))).toBeCloseTo(moves, 9);
    }
    expect(clock.movesAt(-1)).toBe(0);
    expect(clock.movesAt(1e9)).toBe(5);
  });
  it('is the planner\'s, shared by length where it has joined lines, with dwells', () => {
    const clock = new Clock(movesOf(SQUARE), 10);
    const timed = (points: number[], seconds: number[]): Parameters<Clock['take']>[0] => ({ points: Uint32Array.from(points), lines: new Uint32Array(points.length), seconds: Float32Array.from(seconds), velocities: new Float32Array(points.length) });
    clock.take(timed([1, 2], [2, 3]));
    expect(clock.isPlanned).toBe(false);
    clock.take(timed([4, 4, 5], [8, 0.5, 1]));
    clock.finish();
    expect(clock.isPlanned).toBe(true);
    expect([1, 2, 3, 4, 5].map((moves) => clock.at(moves))).toEqual([2, 5, 9, 13.5, 14.5]);
    expect(clock.total).toBe(14.5);
  });
});

describe('a running machine', () => {
  it('is found in its line by the position, through loops, and never goes back', () => {
    const looped = [...SQUARE, ...SQUARE.slice(2)];
    const follower = new Follower(movesOf(looped));
    expect(follower.follow(0, [5, 0, 5])).toBe(0);
    expect(follower.follow(2, [4, 0, 5])).toBeCloseTo(0.4, 6);
    expect(follower.follow(4, [20, 0, -1])).toBeCloseTo(2.5, 6);
    expect(follower.follow(4, [30, 5, -1])).toBeCloseTo(3.25, 6);
    expect(follower.follow(4, [29, 0, -1])).toBeCloseTo(3.25, 6);
    expect(follower.follow(5, [20, 10, -1])).toBeCloseTo(4.5, 6);
    expect(follower.follow(3, [10, 0, -1])).toBeGreaterThanOrEqual(5);
    expect(follower.follow(4, [15, 0, -1])).toBeCloseTo(6.25, 6);
    expect(follower.follow(99, [0, 0, 0])).toBeCloseTo(6.25, 6);
    follower.restart();
    expect(follower.follow(2, [1, 0, 5])).toBeCloseTo(0.1, 6);
  });
});

describe('the picture', () => {
  it('has the lowest of its cells, at the edges too, and follows changes', () => {
    const field = new Field({ kind: 'box', low: [0, 0, -10], high: [100, 70, 0] }, 0.5);
    const display = new Display(field);
    const whole = display.picture(64);
    expect([whole.nx, whole.ny, whole.cell_x]).toEqual([50, 35, 2]);
    expect(whole.heights.every((height) => height === 0)).toBe(true);
    const last = field.nx * field.ny - 1;
    for (const [cell, height] of [[0, -3], [last, -4], [TILE + 5, -5]] as const) {
      field.heights[cell] = height;
      field.makers[cell] = 2;
      field.mark(Math.floor(cell / field.nx), cell % field.nx, cell % field.nx);
    }
    for (const most of [64, 256]) {
      const { heights, makers, nx } = display.picture(most);
      expect([heights[0], heights[heights.length - 1], Math.min(...heights)]).toEqual([-3, -4, -5]);
      expect(makers.filter((maker) => maker === 2).length).toBe(3);
      expect(nx).toBe(most === 64 ? 50 : 200);
    }
    const small = reduced(display.picture(64), 10);
    expect([small.nx, small.ny, small.cell_x, small.heights[0], small.heights[3], small.heights[small.heights.length - 1]]).toEqual([10, 7, 10, -3, -5, -4]);
  });
});

describe('findings', () => {
  const one = (line: number): Parameters<Findings['add']>[1] => ({ line, move: line, part: 0, tool: 1, depth: line, place: [0, 0, 0], fixture: '' });
  it('have one entry for a line, with all its collisions from the worst on, in the order of the program', () => {
    const findings = new Findings();
    findings.add('rapid', one(9));
    findings.add('rapid', one(4));
    findings.add('fixture', { ...one(4), depth: 7, fixture: 'vice' });
    findings.add('rapid', one(4));
    expect(findings.list().map((found) => [found.line, found.kinds, found.depth, found.fixture])).toEqual([[4, ['fixture', 'rapid'], 7, 'vice'], [9, ['rapid'], 9, '']]);
  });
  it('are counted when they are too many for the list', () => {
    const findings = new Findings();
    for (let line = 1; line <= MOST_FINDINGS + 3; ++line) {
      findings.add('floor', one(line));
    }
    expect([findings.list().length, findings.dropped]).toEqual([MOST_FINDINGS, 3]);
  });
});

describe('a session', () => {
  const SETUP: Setup = { stock: BOX, fixtures: [], floor_mm: -20, tools: new Map([[1, tool()]]), cell_mm: 0.5 };
  const pause = (): Promise<void> => new Promise((done) => setImmediate(done));
  function session(points: readonly Point[]): Session {
    const made = new Session({ origin: [0, 0, 0], rotation_deg: 0, unit_mm: 1 }, 1, 50);
    made.take({ kind: 'moves', count: points.length, places: Float32Array.from(points.flatMap((point) => point.at)), lines: Uint32Array.from(points.map((point) => point.line)), kinds: Uint8Array.from(points.map((point) => point.kind)), shades: new Uint8Array(points.length) });
    return made;
  }
  it('knows cuts, tools, rotary moves and errors', () => {
    const made = session(SQUARE);
    made.take({ kind: 'rotary', line: 7 });
    made.take({ kind: 'error', text: 'a.ngc:3: wrong' });
    expect(made.finish()).toEqual({ moves: 5, lines: 5, cuts: { low: [10, 0, -1], high: [30, 20, -1] }, tools: [1], rotary_line: 7, isCut: false, errors: ['a.ngc:3: wrong'] });
  });
  it('shows moves, times, lines and nothing before it is prepared', async () => {
    const made = session(SQUARE);
    made.finish();
    expect(made.show({ moves: 1 }, 64)).toBeNull();
    await made.prepare(SETUP, pause, () => undefined);
    expect(made.show({ moves: 2.5 }, 64)).toMatchObject({ moves: 2.5, line: 4, tip: [20, 0, -1], tool: 1, isRapid: false, isMissing: false });
    expect(made.show({ line: 4 }, 64)).toMatchObject({ moves: 4, line: 4, tip: [30, 20, -1] });
    expect(made.show({ line: 77 }, 64)).toMatchObject({ moves: 4, isMissing: true });
    expect(made.show({ seconds: 0 }, 64)).toMatchObject({ moves: 0 });
    expect(made.show({ machine: { line: 3, tip: [10, 0, 2], isNew: true } }, 64)).toMatchObject({ moves: 1.5, line: 3 });
  });
  it('abandons a preparation that another one replaces', async () => {
    const many: Point[] = Array.from({ length: 60_000 }, (_, i) => ({ at: [i % 100, i % 80, -1], line: i, kind: 1 }));
    const made = session(many);
    made.finish();
    let reports = 0;
    const first = made.prepare(SETUP, pause, () => (reports += 1));
    const second = made.prepare(SETUP, pause, () => undefined);
    expect(await first).toBeNull();
    expect(reports).toBeLessThan(3);
    expect((await second)?.cell_mm).toBe(0.5);
    const third = made.prepare(SETUP, pause, () => undefined);
    made.cancel();
    expect(await third).toBeNull();
  });
});

describe('what is kept', () => {
  it('is the stock of the last programs, the newest first', () => {
    let kept: Parameters<typeof withStock>[0] = [];
    for (let i = 0; i < MOST_STOCKS + 5; ++i) {
      kept = withStock(kept, { file: `${i % 22}.ngc`, stock: BOX, fixtures: [], floor_mm: i });
    }
    expect([kept.length, kept[0]?.file, kept[0]?.floor_mm]).toEqual([MOST_STOCKS, '2.ngc', 24]);
    expect(new Set(kept.map((one) => one.file)).size).toBe(MOST_STOCKS);
  });
});
