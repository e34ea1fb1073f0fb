// SPDX-License-Identifier: GPL-2.0-or-later
// Input values for the icons of operations: few and large details.
import { packed } from '../../lib/conversational/dxf';
import type { Values } from '../../lib/conversational/types';

const OUTLINE = packed([
  {
    layer: '0',
    start: { x: 0, y: 0 },
    segments: [
      { kind: 'line', to: { x: 40, y: 0 } },
      { kind: 'line', to: { x: 40, y: 15 } },
      { kind: 'arc', to: { x: 25, y: 30 }, centre: { x: 25, y: 15 }, isCw: false },
      { kind: 'line', to: { x: 0, y: 20 } },
      { kind: 'line', to: { x: 0, y: 0 } },
    ],
  },
]);

export const ICON_VALUES: Record<string, Values> = {
  face: { length: 60, width: 40, diameter: 24, step_over: 18 },
  rect_pocket: { length: 60, width: 40, corner_radius: 10, diameter: 14, step_over: 9, allowance: 0 },
  round_pocket: { pocket_diameter: 40, diameter: 14, step_over: 9, allowance: 0 },
  slot: { x_end: 40, y_end: 25, slot_width: 18, diameter: 12, step_over: 6, allowance: 0 },
  rect_boss: { length: 34, width: 22, stock_length: 60, stock_width: 44, diameter: 10, allowance: 0 },
  round_boss: { boss_diameter: 28, stock_length: 56, stock_width: 44, diameter: 10, allowance: 0 },
  drill: { pattern: 'circle', holes: 6, circle_diameter: 40, diameter: 10 },
  tap: { pattern: 'grid', columns: 3, rows: 2, spacing_x: 20, spacing_y: 20, diameter: 12 },
  bore: { pattern: 'line', holes: 2, spacing: 45, diameter: 30 },
  thread_mill: { major: 40, minor: 32, pitch: 5, diameter: 18 },
  turn: { stock_diameter: 40, part_diameter: 24, z_end: -34, cut: 4 },
  lathe_face: { stock_diameter: 40, z_start: 7, cut: 3 },
  lathe_bore: { hole_diameter: 14, bore_diameter: 28, z_end: -24 },
  groove: { stock_diameter: 40, groove_diameter: 22, groove_width: 12, tool_width: 5 },
  part_off: { stock_diameter: 40, tool_width: 6 },
  lathe_thread: { major: 36, minor: 28, pitch: 6, z_end: -36 },
  chamfer: { part_diameter: 40, chamfer: 9 },
  radius: { part_diameter: 40, radius: 10 },
  engrave: { text: 'Abc', text_height: 20 },
  contour: { drawing: OUTLINE, layer: '0', side: 'outside', diameter: 8, allowance: 0 },
};
