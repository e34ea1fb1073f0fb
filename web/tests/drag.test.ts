// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import { DELIBERATE_MS, Drag, onScale } from '../src/lib/drag';

const SCALE = { min: 0, max: 200, step: 1, free: 20, width: 200 };
const drag = (value = 100): Drag => new Drag({ x: 500, y: 300 }, value, SCALE);

describe('a drag of an override', () => {
  it('is none while the page is scrolled', () => {
    const one = drag();
    expect(one.move({ x: 504, y: 320 }, 10)).toBeNull();
    expect(one.move({ x: 580, y: 400 }, 50)).toBeNull(); // drifts to the side later
    expect(one.move({ x: 680, y: 400 }, 900)).toBeNull();
  });
  it('is none for a touch that trembles', () => expect(drag().move({ x: 505, y: 303 }, 10)).toBeNull());
  it('changes 20 at most before it is deliberate, and then what it says', () => {
    const one = drag();
    expect(one.move({ x: 518, y: 300 }, 0)).toBe(110);
    expect(one.move({ x: 590, y: 302 }, 100)).toBe(120);
    expect(one.move({ x: 590, y: 302 }, DELIBERATE_MS)).toBe(182);
    const other = drag();
    expect(other.move({ x: 400, y: 300 }, 0)).toBe(80);
    expect(other.move({ x: 400, y: 300 }, DELIBERATE_MS)).toBe(8);
  });
  it('ends at the ends of the scale', () => {
    const one = drag(190);
    expect(one.move({ x: 530, y: 300 }, 0)).toBe(200);
    expect(one.move({ x: 0, y: 300 }, DELIBERATE_MS)).toBe(0);
  });
  it('stays on steps', () => expect(onScale(0.123, { min: 0.01, max: 1, step: 0.01 })).toBeCloseTo(0.12, 9));
});
