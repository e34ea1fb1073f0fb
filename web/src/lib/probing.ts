// SPDX-License-Identifier: GPL-2.0-or-later
// Calls of nc_files/probing, with the operator's input.

export type ProbeKind = 'edge' | 'corner' | 'bore' | 'boss' | 'tool';
export type ProbeField = 'travel' | 'tip' | 'fast' | 'slow' | 'step' | 'width' | 'clearance' | 'depth' | 'setter';

/** Input fields of each cycle; lengths before feeds. */
export const PROBE_FIELDS: Record<ProbeKind, ProbeField[]> = {
  edge: ['travel', 'tip', 'fast', 'slow'],
  corner: ['step', 'travel', 'tip', 'fast', 'slow'],
  bore: ['travel', 'tip', 'fast', 'slow'],
  boss: ['width', 'clearance', 'depth', 'tip', 'fast', 'slow'],
  tool: ['setter', 'travel', 'fast', 'slow'],
};

const PRESETS_MM: Record<ProbeField, number> = { travel: 15, tip: 4, fast: 300, slow: 60, step: 10, width: 30, clearance: 6, depth: 8, setter: 0 };
const PRESETS_INCH: Record<ProbeField, number> = { travel: 0.6, tip: 0.16, fast: 12, slow: 2.4, step: 0.4, width: 1.2, clearance: 0.25, depth: 0.3, setter: 0 };

export function presetOf(field: ProbeField, isInches: boolean): number {
  return (isInches ? PRESETS_INCH : PRESETS_MM)[field];
}

/** Position of the faces seen from the probe: signs of X, Y and Z. */
export interface Side {
  x: number;
  y: number;
  z: number;
}

export interface Probe {
  kind: ProbeKind;
  side: Side;
  isInside: boolean;
  /** 1 to 9: coordinate system whose zero is set; 0: none. */
  system: number;
  values: Record<ProbeField, number>;
}

/** The MDI line. */
export function callOf(probe: Probe): string {
  const { side, values, system } = probe;
  const given = (...numbers: number[]): string => numbers.map((one) => `[${one}]`).join(' ');
  const feeds = [values.fast, values.slow];
  switch (probe.kind) {
    case 'edge':
      return `o<probe_edge> call ${given(side.x !== 0 ? side.x : side.y !== 0 ? 2 * side.y : -3, values.travel, values.tip, ...feeds, system)}`;
    case 'corner':
      return `o<probe_corner> call ${given(side.x, side.y, probe.isInside ? 1 : 0, probe.isInside ? 0 : values.step, values.travel, values.tip, ...feeds, system)}`;
    case 'bore':
      return `o<probe_bore> call ${given(values.travel, values.tip, ...feeds, system)}`;
    case 'boss':
      return `o<probe_boss> call ${given(values.width, values.clearance, values.depth, values.tip, ...feeds, system)}`;
    case 'tool':
      return `o<probe_tool_length> call ${given(0, values.setter, values.travel, ...feeds)}`;
  }
}

/** Axes along which the cycle sets a zero. A tool length is measured without an active length (G49). */
export function axesOf(kind: ProbeKind, side: Side): string[] {
  if (kind === 'tool') {
    return [];
  }
  return kind === 'edge' ? (['x', 'y', 'z'] as const).filter((axis) => side[axis] !== 0).map((axis) => axis.toUpperCase()) : ['X', 'Y'];
}

/** Buttons around the probe, at the position of the face or corner. Y up, as in the view from above. */
export const EDGE_SIDES: (Side & { at: string; sign: string })[] = [
  { x: 0, y: 1, z: 0, at: '1 / 2', sign: 'Y+' },
  { x: -1, y: 0, z: 0, at: '2 / 1', sign: 'X-' },
  { x: 0, y: 0, z: -1, at: '2 / 2', sign: 'Z-' },
  { x: 1, y: 0, z: 0, at: '2 / 3', sign: 'X+' },
  { x: 0, y: -1, z: 0, at: '3 / 2', sign: 'Y-' },
];
export const CORNER_SIDES: (Side & { at: string; sign: string })[] = [
  { x: -1, y: 1, z: 0, at: '1 / 1', sign: 'X- Y+' },
  { x: 1, y: 1, z: 0, at: '1 / 3', sign: 'X+ Y+' },
  { x: -1, y: -1, z: 0, at: '3 / 1', sign: 'X- Y-' },
  { x: 1, y: -1, z: 0, at: '3 / 3', sign: 'X+ Y-' },
];
