// SPDX-License-Identifier: GPL-2.0-or-later
// Tests material removal: volumes that are known exactly, findings by line, and any move of the program at
// any time.
import { describe, expect, it } from 'vitest';
import { MOST_CELLS } from '../src/lib/simulation/field';
import { Moves } from '../src/lib/simulation/moves';
import { cutterOf, guessShape, heightAt, type ShapeName } from '../src/lib/simulation/shapes';
import { stockAround, type Stock } from '../src/lib/simulation/stock';
import { readStl } from '../src/lib/simulation/stl';
import { BOX, movesOf, simulate, tool, type Point } from './simulation/made';
import { pointsOf } from './simulation/arcs';

const STOCK_MM3 = 100 * 80 * 20;
const SAFE: Point = { at: [50, 40, 10], line: 1, kind: 0 };

function removed(points: Point[], shape: Partial<Parameters<typeof tool>[0]> = {}, cell_mm: number | null = null): number {
  return STOCK_MM3 - simulate(movesOf(points), { tools: new Map([[1, tool(shape)]]), cell_mm }).field.volume();
}

describe('the removed volume', () => {
  const plunge = (z: number): Point[] => [SAFE, { at: [50, 40, z], line: 2, kind: 1 }];
  const slot: Point[] = [{ at: [20, 40, 10], line: 1, kind: 0 }, { at: [20, 40, -4], line: 2, kind: 1 }, { at: [80, 40, -4], line: 3, kind: 1 }];
  it('is that of a hole', () => {
    expect(removed(plunge(-5))).toBeCloseTo(Math.PI * 9 * 5, -0.5);
    // A ball: a half sphere below a cylinder.
    expect(removed(plunge(-5), { shape: 'ball' }) / (Math.PI * 9 * 2 + (2 / 3) * Math.PI * 27)).toBeCloseTo(1, 2);
    // A cone of 90 degrees below a cylinder.
    expect(removed(plunge(-5), { shape: 'vee', point_angle_deg: 90 }) / (Math.PI * 9 * 2 + Math.PI * 9)).toBeCloseTo(1, 2);
  });
  it('is that of a slot', () => {
    // The walls are exact to half a cell on each side.
    const { cell } = simulate(movesOf(slot)).field;
    expect(Math.abs(removed(slot) / ((60 * 6 + Math.PI * 9) * 4) - 1)).toBeLessThan(cell / 6);
    expect(removed(slot, { shape: 'ball' }) / (60 * (6 + (Math.PI * 9) / 2) + Math.PI * 9 + (2 / 3) * Math.PI * 27)).toBeCloseTo(1, 2);
  });
  it('is that of a ramp, which a flat tool cuts with its lower edge', () => {
    const ramp: Point[] = [{ at: [20, 40, 10], line: 1, kind: 0 }, { at: [20, 40, 0], line: 2, kind: 1 }, { at: [80, 40, -6], line: 3, kind: 1 }];
    // Each row of the tool cuts a chord behind the axis; the integral over the width is known.
    const slices = 2000;
    let volume = 0;
    for (let i = 0; i < slices; ++i) {
      const y = -3 + (6 * (i + 0.5)) / slices;
      const half = Math.sqrt(9 - y * y);
      // Depth 0 at x=20-half … rises with 0.1 per mm from x = 20 + half on; the last chord is level at 6.
      volume += (6 / slices) * (0.5 * 60 * 6 + 2 * half * 6);
    }
    expect(Math.abs(removed(ramp) / volume - 1)).toBeLessThan(0.01);
  });
  it('does not depend on how a move is divided, for all shapes', () => {
    for (const shape of ['flat', 'ball', 'bull', 'vee', 'drill'] satisfies ShapeName[]) {
      const [a, b] = [[20, 30, -2], [70, 50, -9]] as const;
      const whole: Point[] = [{ at: [20, 30, 10], line: 1, kind: 0 }, { at: [...a], line: 2, kind: 1 }, { at: [...b], line: 3, kind: 1 }];
      const parts: Point[] = whole.slice(0, 2);
      for (let i = 1; i <= 40; ++i) {
        parts.push({ at: [0, 1, 2].map((axis) => (a[axis] ?? 0) + (((b[axis] ?? 0) - (a[axis] ?? 0)) * i) / 40) as [number, number, number], line: 3, kind: 1 });
      }
      const form = { shape, corner_radius_mm: 1, tip_diameter_mm: shape === 'vee' ? 1 : 0 };
      expect(removed(parts, form, 0.2) / removed(whole, form, 0.2)).toBeCloseTo(1, 5);
    }
  });
  it('is the lowest of many positions of the tool, for all shapes and slopes', () => {
    for (const shape of ['flat', 'ball', 'bull', 'vee', 'drill'] satisfies ShapeName[]) {
      const form = tool({ shape, corner_radius_mm: 1.2, tip_diameter_mm: shape === 'vee' ? 0.8 : 0 });
      const cutter = cutterOf(form);
      for (const [a, b] of [[[20, 30, -2], [26, 33, -9]], [[40, 40, -12], [38, 50, -1]], [[30, 30, -3], [30.5, 30, -15]]] as const) {
        const { field } = simulate(movesOf([{ at: [...a], line: 1, kind: 0 }, { at: [...b], line: 2, kind: 1 }]), { tools: new Map([[1, form]]), cell_mm: 0.5 });
        for (let cell = 0; cell < field.heights.length; cell += 37) {
          const [x, y] = [((cell % field.nx) + 0.5) * 0.5, (Math.floor(cell / field.nx) + 0.5) * 0.5];
          let low = 0;
          const STEPS = 300;
          for (let i = 0; i <= STEPS; ++i) {
            const at = i / STEPS;
            const distance = Math.hypot(x - a[0] - at * (b[0] - a[0]), y - a[1] - at * (b[1] - a[1]));
            low = distance <= 3 ? Math.min(low, a[2] + at * (b[2] - a[2]) + heightAt(cutter, distance)) : low;
          }
          const step = Math.abs(b[2] - a[2]) / STEPS + 0.05;
          expect(field.heights[cell]).toBeLessThan(low + 1e-5);
          expect(field.heights[cell]).toBeGreaterThan(low - step);
        }
      }
    }
  });
  it('follows arcs and helices', () => {
    const arc = pointsOf({ from: [60, 40, -3], to: [60, 40, -3], centre: [50, 40, -3], about: 2, angle_rad: 2 * Math.PI });
    const ring: Point[] = [{ at: [60, 40, 10], line: 1, kind: 0 }, { at: [60, 40, -3], line: 2, kind: 1 }, ...arc.map((at) => ({ at, line: 3, kind: 2 }))];
    expect(removed(ring) / (Math.PI * (13 ** 2 - 7 ** 2) * 3)).toBeCloseTo(1, 2);
  });
  it('is that of a cylinder, and nothing is removed in the air or by a probe', () => {
    const stock = { ...BOX, kind: 'cylinder' as const };
    expect(simulate(movesOf([SAFE, { at: [50, 40, 5], line: 2, kind: 1 }]), { stock }).field.volume() / (Math.PI * 1600 * 20)).toBeCloseTo(1, 2);
    expect(removed([SAFE, { at: [50, 40, -5], line: 2, kind: 3 }])).toBeCloseTo(0, 3);
  });
});

describe('findings', () => {
  it('are a rapid in the stock, once for a line, with its place', () => {
    const found = simulate(movesOf([SAFE, { at: [50, 40, -2], line: 2, kind: 1 }, { at: [20, 40, -2], line: 3, kind: 0 }, { at: [20, 60, -2], line: 3, kind: 0 }, { at: [20, 60, 5], line: 4, kind: 0 }])).findings.list();
    expect(found.map((one) => [one.line, one.kinds])).toEqual([[3, ['rapid']]]);
    expect(found[0]?.depth).toBeCloseTo(2, 1);
    expect(found[0]?.place[2]).toBeCloseTo(0, 3);
    expect(found[0]?.tool).toBe(1);
  });
  it('are not a rapid out of a hole, along a wall or over a floor that is cut', () => {
    const pocket: Point[] = [SAFE, { at: [50, 40, -4], line: 2, kind: 1 }, { at: [70, 40, -4], line: 3, kind: 1 }, { at: [50, 40, -4], line: 4, kind: 0 }, { at: [50, 40, 5], line: 5, kind: 0 }];
    for (const shape of ['flat', 'ball', 'bull', 'vee', 'drill'] satisfies ShapeName[]) {
      expect(simulate(movesOf(pocket), { tools: new Map([[1, tool({ shape })]]) }).findings.list()).toEqual([]);
    }
  });
  it('are a tool below the floor, with and without the stock', () => {
    const found = simulate(movesOf([SAFE, { at: [50, 40, -20.5], line: 2, kind: 1 }, { at: [150, 40, -20.5], line: 3, kind: 1 }]), {}).findings.list();
    expect(found.map((one) => [one.line, one.kinds])).toEqual([[2, ['floor']], [3, ['floor']]]);
    expect(found[0]?.depth).toBeCloseTo(0.5, 3);
  });
  it('are a holder in the stock, where the tool is too short', () => {
    const deep: Point[] = [SAFE, { at: [50, 40, -15], line: 2, kind: 1 }];
    const long = tool({ stickout_mm: 16 });
    expect(simulate(movesOf(deep), { tools: new Map([[1, long]]) }).findings.list()).toEqual([]);
    const found = simulate(movesOf(deep), { tools: new Map([[1, { ...long, stickout_mm: 12 }]]) }).findings.list();
    expect(found.map((one) => [one.line, one.kinds])).toEqual([[2, ['holder']]]);
    expect(found[0]?.depth).toBeCloseTo(3, 1);
    expect(simulate(movesOf(deep), { tools: new Map([[1, tool()]]) }).findings.list()).toEqual([]);
  });
  it('of a holder over a deep pocket cost little, and a later wall is still found', () => {
    // A pocket of 80 by 60 that is 18 deep, by a tool whose holder is 12 above its tip and goes below the top.
    const points: Point[] = [{ at: [50, 40, 10], line: 1, kind: 0 }];
    for (const [z, line] of [[-9, 2], [-18, 3]] as const) {
      points.push({ at: [10, 10, z], line, kind: 1 });
      for (let y = 10; y <= 70; y += 1) {
        points.push({ at: [y % 2 === 0 ? 90 : 10, y, z], line, kind: 1 }, { at: [y % 2 === 0 ? 90 : 10, y + 1, z], line, kind: 1 });
      }
    }
    const inside: Point[] = Array.from({ length: 5000 }, (_, i) => ({ at: [40 + 10 * Math.sin(i / 50), 40 + 10 * Math.cos(i / 50), -18], line: 4, kind: 1 }) as Point);
    // The holder moves away from the wall it has hit in line 6.
    const all = [...points, { at: [40, 50, -18], line: 6, kind: 1 } as Point, ...inside, { at: [88, 40, -18], line: 5, kind: 1 } as Point];
    const form = tool({ stickout_mm: 12, holder_diameter_mm: 30 });
    const made = simulate(movesOf(all), { tools: new Map([[1, form]]), cell_mm: 0.25 });
    expect(made.findings.list().map((one) => [one.line, one.kinds])).toEqual([[3, ['holder']], [6, ['holder']], [5, ['holder']]]);
    const alone = simulate(movesOf(all), { tools: new Map([[1, { ...form, stickout_mm: null }]]), cell_mm: 0.25 });
    expect(made.work).toBeLessThan(1.2 * alone.work);
  });
  it('are a clamp that the tool or the holder hits, also in a rapid', () => {
    const fixtures = [{ name: 'clamp', low: [0, 35, 0] as [number, number, number], high: [10, 45, 12] as [number, number, number] }];
    const hit = simulate(movesOf([SAFE, { at: [-30, 40, 10], line: 2, kind: 0 }, { at: [-30, 40, 13], line: 3, kind: 0 }, { at: [50, 40, 13], line: 4, kind: 0 }]), { fixtures }).findings.list();
    expect(hit.map((one) => [one.line, one.kinds, one.fixture])).toEqual([[2, ['fixture'], 'clamp']]);
    expect(hit[0]?.depth).toBeCloseTo(2, 3);
    // Closer than the tool radius, and farther.
    const beside = (x: number): number => simulate(movesOf([{ at: [x, 60, 5], line: 1, kind: 0 }, { at: [x, 20, 5], line: 2, kind: 0 }]), { fixtures }).findings.list().length;
    expect([beside(12.9), beside(13.1)]).toEqual([1, 0]);
  });
});

describe('any move of the program', () => {
  function wild(count: number): Point[] {
    let seed = 7;
    const random = (): number => {
      seed = (seed * 1103515245 + 12345) % 2 ** 31;
      return seed / 2 ** 31;
    };
    return Array.from({ length: count }, (_, i) => ({ at: [random() * 100, random() * 80, 3 - random() * 12], line: i + 1, kind: random() < 0.2 ? 0 : 1, tool: i < count / 2 ? 1 : 2 }) as Point);
  }
  const tools = new Map([[1, tool()], [2, tool({ shape: 'ball', diameter_mm: 10 })]]);
  it('shows the same as a program that ends there, in any order and with little memory', () => {
    const all = wild(60);
    for (const bytes of [160e6, 8e5]) {
      const whole = simulate(movesOf(all), { tools, cell_mm: 0.6 }, { bytes, cells: 5000, moves: 4 });
      // With little memory some checkpoints are omitted.
      expect(whole.checkpointCount).toBeGreaterThan(3);
      expect(whole.checkpointCount > 14).toBe(bytes === 160e6);
      for (const moves of [59, 30, 10, 29.5, 31, 0, 58.25]) {
        whole.goTo(moves);
        const part = movesOf(all.slice(0, Math.ceil(moves) + 1));
        const alone = simulate(part, { tools, cell_mm: 0.6 });
        alone.goTo(moves);
        expect(Buffer.compare(new Uint8Array(whole.field.heights.buffer), new Uint8Array(alone.field.heights.buffer))).toBe(0);
        expect(Buffer.compare(whole.field.makers, alone.field.makers)).toBe(0);
      }
    }
  });
  it('has the tip of the tool between two points', () => {
    const made = simulate(movesOf([SAFE, { at: [60, 40, 10], line: 2, kind: 1 }]));
    expect(made.tip(0)).toEqual([50, 40, 10]);
    expect(made.tip(0.25)).toEqual([52.5, 40, 10]);
    expect(made.tip(7)).toEqual([60, 40, 10]);
  });
});

describe('the moves of the server', () => {
  it('are tips in work coordinates, from where the tool offset begins', () => {
    const moves = new Moves({ origin: [10, 20, 30], rotation_deg: 90, unit_mm: 25.4 }, 3);
    moves.take({ kind: 'offsets', first: Uint32Array.of(2), xyz: Float32Array.of(0, 0, 2) });
    moves.take({ kind: 'ranges', first: Uint32Array.of(0, 2), feed: Float32Array.of(1, 2), tool: Uint32Array.of(0, 5) });
    moves.take({ kind: 'moves', count: 3, places: Float32Array.of(10, 20, 30, 10, 21, 30, 10, 22, 33), lines: Uint32Array.of(1, 2, 3), kinds: Uint8Array.of(0, 0, 1), shades: new Uint8Array(3) });
    // The jump precedes the first move with the offset.
    expect(moves.count).toBe(4);
    const rounded = [...moves.points.subarray(0, 12)].map((one) => Math.round(one * 1000) / 1000 + 0);
    expect(rounded).toEqual([0, 0, 0, 25.4, 0, 0, 25.4, 0, -50.8, 50.8, 0, 25.4]);
    expect([...moves.kinds.subarray(0, 4)]).toEqual([0, 0, 4, 1]);
    expect([0, 1, 2, 3].map((i) => moves.toolAt(i))).toEqual([3, 3, 5, 5]);
    expect([0, 1, 2].map((i) => moves.indexOf(i))).toEqual([0, 1, 3]);
    expect(moves.cuts()?.low[0]).toBeCloseTo(25.4, 4);
  });
  it('choose cells that memory and time allow', () => {
    const large = { kind: 'box' as const, low: [0, 0, -50] as [number, number, number], high: [3000, 1500, 0] as [number, number, number] };
    const { field } = simulate(movesOf([SAFE, { at: [50, 40, -2], line: 2, kind: 1 }]), { stock: large });
    expect(field.nx * field.ny).toBeLessThanOrEqual(MOST_CELLS);
    expect(field.nx * field.ny).toBeGreaterThan(MOST_CELLS / 2);
  });
  it('list the tools that have no diameter', () => {
    const made = simulate(movesOf([SAFE, { at: [50, 40, -2], line: 2, kind: 1, tool: 9 }]));
    expect(made.unknown_tools).toEqual([9]);
    expect(made.field.volume()).toBeCloseTo(STOCK_MM3, -1);
  });
  it('have a stock around their cuts', () => {
    expect(stockAround({ low: [10, 5, -8], high: [60, 45, 17] }, 3, 2)).toEqual({ kind: 'box', low: [5, 0, -10], high: [65, 50, 0] });
    expect(stockAround({ low: [10, 5, 4], high: [60, 45, 17] }, 3, 2)).toEqual({ kind: 'box', low: [5, 0, 2], high: [65, 50, 17] });
  });
});

describe('a stock from an STL file', () => {
  /** A pyramid with a square base of 10 and a height of 6, with its lower corner at 5, 5, -6. */
  const CORNERS = [[5, 5, -6], [15, 5, -6], [15, 15, -6], [5, 15, -6], [10, 10, 0]] as const;
  const FACES = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]] as const;
  const points = FACES.flatMap((face) => face.map((corner) => CORNERS[corner]));
  const ascii = `solid p\n${points.map((point, i) => `${i % 3 === 0 ? 'facet normal 0 0 1\n outer loop\n' : ''}vertex ${point.join(' ')}\n${i % 3 === 2 ? 'endloop\nendfacet\n' : ''}`).join('')}endsolid p\n`;
  const binary = new DataView(new ArrayBuffer(84 + FACES.length * 50));
  binary.setUint32(80, FACES.length, true);
  points.forEach((point, i) => point.forEach((value, axis) => binary.setFloat32(84 + Math.floor(i / 3) * 50 + 12 + (i % 3) * 12 + axis * 4, value, true)));
  it('has its volume, from text and from bytes, and is cut', () => {
    for (const bytes of [new TextEncoder().encode(ascii).buffer as ArrayBuffer, binary.buffer as ArrayBuffer]) {
      const stock = readStl(bytes, 1);
      expect([stock?.low, stock?.high]).toEqual([[5, 5, -6], [15, 15, 0]]);
      const whole = simulate(movesOf([SAFE]), { stock: stock as Stock, cell_mm: 0.05 }).field;
      expect(whole.volume() / 200).toBeCloseTo(1, 2);
      const cut = simulate(movesOf([{ at: [0, 10, -3], line: 1, kind: 0 }, { at: [20, 10, -3], line: 2, kind: 1 }]), { stock: stock as Stock, cell_mm: 0.05, tools: new Map([[1, tool({ diameter_mm: 40 })]]) }).field;
      // The part above half the height is an eighth of the volume.
      expect(cut.volume() / 175).toBeCloseTo(1, 2);
    }
  });
  it('is rejected when it is none', () => {
    expect(readStl(new TextEncoder().encode('solid empty\nendsolid').buffer as ArrayBuffer, 1)).toBeNull();
    expect(readStl(new ArrayBuffer(3), 1)).toBeNull();
    expect(readStl(binary.buffer.slice(0, 150) as ArrayBuffer, 1)).toBeNull();
    const flat = new TextEncoder().encode('vertex 0 0 0 vertex 1 0 0 vertex 0 1 0').buffer as ArrayBuffer;
    expect(readStl(flat, 1)).toBeNull();
    const endless = new TextEncoder().encode('vertex 0 0 0 vertex 1 0 x vertex 0 1 0').buffer as ArrayBuffer;
    expect(readStl(endless, 1)).toBeNull();
  });
});

describe('shapes', () => {
  it('are guessed from the comment', () => {
    const shapes = ['6mm end mill', 'Kugelfräser 6', 'broca 5 HSS', 'V-bit 60 deg', 'bull nose R1'].map((text) => guessShape(6, text));
    expect(shapes.map((one) => one.shape)).toEqual(['flat', 'ball', 'drill', 'vee', 'bull']);
    expect(shapes[3]?.point_angle_deg).toBe(60);
    expect(shapes[4]?.corner_radius_mm).toBe(1);
  });
});
