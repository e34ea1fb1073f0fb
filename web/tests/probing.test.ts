// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the commands of the view Probing: words in the order of nc_files/probing.
import { readFileSync } from 'node:fs';
import { expect, it } from 'vitest';
import { callOf, CORNER_SIDES, EDGE_SIDES, type Probe } from '../src/lib/probing';

const VALUES = { travel: 15, tip: 4, fast: 300, slow: 60, step: 10, width: 30, clearance: 6, depth: 8, setter: -20.5 };
const probe = (more: Partial<Probe>): Probe => ({ kind: 'edge', side: { x: 1, y: 0, z: 0 }, isInside: false, system: 2, values: VALUES, ...more });

it('calls each program with its words in order', () => {
  expect(EDGE_SIDES.map((side) => callOf(probe({ side })))).toEqual(
    ['2', '-1', '-3', '1', '-2'].map((direction) => `o<probe_edge> call [${direction}] [15] [4] [300] [60] [2]`),
  );
  expect(CORNER_SIDES.map((side) => callOf(probe({ kind: 'corner', side })))).toEqual(
    ['[-1] [1]', '[1] [1]', '[-1] [-1]', '[1] [-1]'].map((sides) => `o<probe_corner> call ${sides} [0] [10] [15] [4] [300] [60] [2]`),
  );
  expect(callOf(probe({ kind: 'corner', isInside: true, side: { x: 1, y: -1, z: 0 } }))).toBe('o<probe_corner> call [1] [-1] [1] [0] [15] [4] [300] [60] [2]');
  expect(callOf(probe({ kind: 'bore' }))).toBe('o<probe_bore> call [15] [4] [300] [60] [2]');
  expect(callOf(probe({ kind: 'boss' }))).toBe('o<probe_boss> call [30] [6] [8] [4] [300] [60] [2]');
  expect(callOf(probe({ kind: 'tool' }))).toBe('o<probe_tool_length> call [0] [-20.5] [15] [300] [60]');
});

it('gives as many words as each program names in its first lines', () => {
  const calls = [callOf(probe({})), callOf(probe({ kind: 'corner' })), callOf(probe({ kind: 'bore' })), callOf(probe({ kind: 'boss' })), callOf(probe({ kind: 'tool' }))];
  for (const call of calls) {
    const name = /<(\w+)>/.exec(call)?.[1] ?? '';
    const text = readFileSync(new URL(`../../nc_files/probing/${name}.ngc`, import.meta.url), 'utf8');
    const head = text.slice(0, text.indexOf('O<')).match(/\[[^\]]+\]/g) ?? [];
    expect(call.match(/\[[^\]]+\]/g)?.length, name).toBe(head.length);
  }
});
