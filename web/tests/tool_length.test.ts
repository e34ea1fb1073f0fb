// SPDX-License-Identifier: GPL-2.0-or-later
import { expect, it } from 'vitest';
import type { MachineStatus } from '../src/lib/status';
import { mustApplyLength, toolLength } from '../src/lib/tool_length';
import type { Tool } from '../src/lib/tools.svelte';

const offset = (x: number, z: number): number[] => [x, 0, z, 0, 0, 0, 0, 0, 0];
const tool = (toolno: number, z: number, x = 0): Tool => ({ toolno, pocketno: toolno, offset: offset(x, z), diameter: 0, frontangle_deg: 0, backangle_deg: 0, orientation: 0, comment: '' });
const TABLE = [tool(0, 0), tool(1, 40), tool(3, 52.3), tool(4, 40, 5), tool(5, 0)];
const status = (inSpindle: number, z: number, code = 430, x = 0): MachineStatus =>
  ({ codes: { g: [540, code], m: [], settings: [] }, offsets: { tool: offset(x, z) }, tool: { in_spindle: inSpindle } }) as unknown as MachineStatus;

it('names the tool whose length is active, and the axes in which it is wrong', () => {
  expect(toolLength(status(3, 52.3), TABLE)).toEqual({ owner: { kind: 'tool', toolno: 3 }, inSpindle: 3, wrongAxes: [] });
  expect(toolLength(status(3, 40), TABLE)).toEqual({ owner: { kind: 'tool', toolno: 1 }, inSpindle: 3, wrongAxes: ['Z'] });
  expect(toolLength(status(3, 40, 430, 5), TABLE)).toEqual({ owner: { kind: 'tool', toolno: 4 }, inSpindle: 3, wrongAxes: ['X', 'Z'] });
  expect(toolLength(status(3, 0, 490), TABLE)).toEqual({ owner: { kind: 'none' }, inSpindle: 3, wrongAxes: ['Z'] });
  expect(toolLength(status(5, 0, 490), TABLE).wrongAxes).toEqual([]);
  expect(toolLength(status(3, 17, 431), TABLE)).toEqual({ owner: { kind: 'other' }, inSpindle: 3, wrongAxes: ['Z'] });
  expect(toolLength(status(0, 40), TABLE)).toEqual({ owner: { kind: 'tool', toolno: 1 }, inSpindle: 0, wrongAxes: ['Z'] });
});

it('reads a changer that has the loaded tool in entry 0 alone', () => {
  const table = [tool(7, 12), tool(1, 40)];
  expect(toolLength(status(7, 12), table)).toEqual({ owner: { kind: 'tool', toolno: 7 }, inSpindle: 7, wrongAxes: [] });
});

it('takes rounding of inches for the same length', () => {
  expect(toolLength(status(3, (52.3 / 25.4) * 25.4 + 1e-9), TABLE).wrongAxes).toEqual([]);
});

it('applies the length of a loaded tool where one was active and none was set by the change', () => {
  expect(mustApplyLength(status(1, 40), status(3, 40), TABLE)).toBe(true);
  expect(mustApplyLength(status(1, 17, 431), status(3, 17, 431), TABLE)).toBe(true);
  expect(mustApplyLength(status(1, 0, 490), status(3, 0, 490), TABLE)).toBe(false);
  expect(mustApplyLength(status(1, 40), status(3, 52.3), TABLE)).toBe(false);
  // a remap of M6 has measured the length
  expect(mustApplyLength(status(1, 40), status(3, 60, 431), TABLE)).toBe(false);
  expect(mustApplyLength(status(1, 40), status(3, 0, 490), TABLE)).toBe(false);
});
