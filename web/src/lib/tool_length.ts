// SPDX-License-Identifier: GPL-2.0-or-later
// The tool whose length is active, and whether it is the tool in the spindle.
import { AXIS_LETTERS, type MachineStatus } from './status';
import type { Tool } from './tools.svelte';

/** G49, a tool of the table, or values that match no tool (set by G43.1, G43.2 or a later change of the table). */
export type LengthOwner = { kind: 'none' } | { kind: 'tool'; toolno: number } | { kind: 'other' };

export interface ToolLength {
  owner: LengthOwner;
  /** 0: the spindle is empty. */
  inSpindle: number;
  /** Letters of the axes in which the active length is not that of the tool in the spindle. */
  wrongAxes: string[];
}

type Known = Pick<MachineStatus, 'codes' | 'offsets' | 'tool'>;

const G49 = 490;
/** Rounding of conversions between inches and millimetres. */
const TOLERANCE = 1e-6;

function isSame(a: readonly number[], b: readonly number[]): boolean {
  return [...AXIS_LETTERS].every((_, i) => Math.abs((a[i] ?? 0) - (b[i] ?? 0)) < TOLERANCE);
}

/** `tools` as in the status: entry 0 is the spindle, on most machines a copy of the loaded tool's entry. */
export function toolLength(status: Known, tools: readonly Tool[]): ToolLength {
  const active = status.offsets.tool;
  const inSpindle = Math.max(status.tool.in_spindle, 0);
  const table = [...tools.slice(1), ...tools.slice(0, 1)].filter((one) => one.toolno > 0);
  const loaded = table.find((one) => one.toolno === inSpindle);
  const own = loaded?.offset ?? [];
  const wrongAxes = [...AXIS_LETTERS].filter((_, i) => Math.abs((active[i] ?? 0) - (own[i] ?? 0)) >= TOLERANCE);
  const match = [...(loaded === undefined ? [] : [loaded]), ...table].find((one) => isSame(active, one.offset));
  const owner: LengthOwner = status.codes.g.includes(G49) ? { kind: 'none' } : match === undefined ? { kind: 'other' } : { kind: 'tool', toolno: match.toolno };
  return { owner, inSpindle, wrongAxes };
}

/**
 * After a load: true if the previous tool length is still active and the change (a remap of M6) has not set
 * another one.
 */
export function mustApplyLength(before: Known, after: Known, tools: readonly Tool[]): boolean {
  const hadLength = !before.codes.g.includes(G49);
  const isUntouched = !after.codes.g.includes(G49) && isSame(before.offsets.tool, after.offsets.tool);
  return hadLength && isUntouched && toolLength(after, tools).wrongAxes.length > 0;
}
