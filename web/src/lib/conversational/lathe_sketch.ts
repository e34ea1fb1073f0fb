// SPDX-License-Identifier: GPL-2.0-or-later
// Drawings of lathe forms: half of the section, Z to the right and the radius upwards.
import type { Point } from './path2';
import { Draft } from './sketch_draft';
import { num, word, type Values } from './types';

const p = (z: number, radius: number): Point => ({ x: z, y: radius });
const rect = (z1: number, r1: number, z2: number, r2: number): Point[] => [p(z1, r1), p(z2, r1), p(z2, r2), p(z1, r2)];

function axis(d: Draft, from: number, to: number): void {
  d.outline('thin', [p(from, 0), p(to, 0)], false);
}
/** A diameter is drawn from the axis. */
function diameter(d: Draft, field: string, z: number, value: number, level: number): void {
  d.dimension(field, p(z, 0), p(z, value / 2), level);
}

function turnSketch(d: Draft, v: Values): void {
  const [start, end, stock, part] = [num(v, 'z_start'), num(v, 'z_end'), num(v, 'stock_diameter'), num(v, 'part_diameter')];
  const back = end - 0.3 * Math.max(1e-3, start - end);
  d.outline('part', [p(back, 0), p(start, 0), p(start, part / 2), p(end, part / 2), p(end, stock / 2), p(back, stock / 2)]);
  d.outline('cut', rect(end, part / 2, start, stock / 2));
  axis(d, back, start);
  diameter(d, 'part_diameter', start, part, -1);
  diameter(d, 'stock_diameter', back, stock, 1);
  d.dimension('z_end', p(end, stock / 2), p(start, stock / 2), 1);
  d.dimension('cut', p((start + end) / 2, stock / 2 - num(v, 'cut')), p((start + end) / 2, stock / 2), 0.01);
  d.mark(['z_start'], p(start, 0));
}

function boreSketch(d: Draft, v: Values): void {
  const [start, end, hole, bore] = [num(v, 'z_start'), num(v, 'z_end'), num(v, 'hole_diameter'), num(v, 'bore_diameter')];
  const back = end - 0.3 * Math.max(1e-3, start - end);
  d.outline('part', [p(back, hole / 2), p(end, hole / 2), p(end, bore / 2), p(start, bore / 2), p(start, bore * 0.7), p(back, bore * 0.7)]);
  d.outline('cut', rect(end, hole / 2, start, bore / 2));
  axis(d, back, start);
  diameter(d, 'bore_diameter', start, bore, -1);
  diameter(d, 'hole_diameter', back, hole, 1);
  d.dimension('z_end', p(end, bore * 0.7), p(start, bore * 0.7), 1);
  d.mark(['z_start'], p(start, 0));
}

function faceSketch(d: Draft, v: Values): void {
  const [start, end, stock, inner] = [num(v, 'z_start'), num(v, 'z_end'), num(v, 'stock_diameter') / 2, num(v, 'end_diameter') / 2];
  d.outline('part', rect(end - stock, 0, end, stock));
  d.outline('cut', rect(end, inner, start, stock));
  axis(d, end - stock, start);
  diameter(d, 'stock_diameter', end - stock, 2 * stock, 1);
  diameter(d, 'end_diameter', start, 2 * inner, -1);
  d.dimension('cut', p(start - num(v, 'cut'), stock), p(start, stock), 1);
  d.mark(['z_start'], p(start, stock));
  d.mark(['z_end'], p(end, stock));
}

function plungeSketch(d: Draft, v: Values, bottom: number, width: number): void {
  const [edge, stock] = [num(v, 'z_edge'), num(v, 'stock_diameter') / 2];
  const [back, front] = [edge - width - 0.6 * stock, edge + 0.6 * stock];
  d.outline('part', rect(back, 0, front, stock));
  d.outline('cut', rect(edge - width, Math.max(0, bottom), edge, stock));
  d.outline('tool', rect(edge - num(v, 'tool_width'), Math.max(0, bottom), edge, stock * 1.25), true);
  axis(d, back, front);
  d.dimension('groove_width', p(edge - width, stock), p(edge, stock), 1);
  d.dimension('tool_width', p(edge - num(v, 'tool_width'), stock * 1.25), p(edge, stock * 1.25), 0.5);
  diameter(d, v['groove_diameter'] === undefined ? 'end_diameter' : 'groove_diameter', edge - width, 2 * Math.max(0, bottom), 0.01);
  diameter(d, 'stock_diameter', back, 2 * stock, 1);
  d.mark(['z_edge'], p(edge, stock));
  d.mark(['tool_edge'], p(word(v, 'tool_edge') === 'left' ? edge - num(v, 'tool_width') : edge, Math.max(0, bottom)));
}

function threadSketch(d: Draft, v: Values): void {
  const [start, end, pitch] = [num(v, 'z_start'), num(v, 'z_end'), num(v, 'pitch')];
  const isOut = word(v, 'thread_side') === 'external';
  const [major, minor] = [num(v, 'major') / 2, num(v, 'minor') / 2];
  const teeth = Math.min(60, Math.max(1, Math.round((start - end) / pitch)));
  const step = (start - end) / teeth;
  const flank = Array.from({ length: teeth }, (_, i) => [p(end + i * step, isOut ? major : minor), p(end + (i + 0.5) * step, isOut ? minor : major)]).flat();
  d.outline('part', [...flank, p(start, isOut ? major : minor), p(start, isOut ? 0 : 1.3 * major), p(end, isOut ? 0 : 1.3 * major)]);
  axis(d, end, start);
  diameter(d, 'major', end, 2 * major, 1);
  diameter(d, 'minor', start, 2 * minor, -1);
  d.dimension('z_end', p(end, isOut ? major : 1.3 * major), p(start, isOut ? major : 1.3 * major), 1);
  d.dimension('pitch', p(start - step, minor), p(start, minor), -0.6);
  d.mark(['z_start'], p(start, 0));
}

function cornerSketch(d: Draft, v: Values, id: 'chamfer' | 'radius'): void {
  const [start, edge, size] = [num(v, 'z_start'), num(v, 'part_diameter') / 2, num(v, id)];
  const back = start - Math.max(3 * size, edge);
  const corner = Array.from({ length: 13 }, (_, i) => (id === 'chamfer' ? p(start - (size * i) / 12, edge - size + (size * i) / 12) : p(start - size + size * Math.cos((i * Math.PI) / 24), edge - size + size * Math.sin((i * Math.PI) / 24))));
  d.outline('cut', [...corner, p(start, edge)]);
  d.outline('part', [p(back, 0), p(start, 0), ...corner, p(back, edge)]);
  axis(d, back, start);
  d.dimension(id, p(start - size, edge), p(start, edge), 1);
  diameter(d, 'part_diameter', back, 2 * edge, 1);
  d.mark(['z_start'], p(start, 0));
}

export const LATHE_SKETCHES: Record<string, (d: Draft, v: Values) => void> = {
  turn: turnSketch,
  lathe_bore: boreSketch,
  lathe_face: faceSketch,
  groove: (d, v) => plungeSketch(d, v, num(v, 'groove_diameter') / 2, num(v, 'groove_width')),
  part_off: (d, v) => plungeSketch(d, v, num(v, 'end_diameter') / 2, num(v, 'tool_width')),
  lathe_thread: threadSketch,
  chamfer: (d, v) => cornerSketch(d, v, 'chamfer'),
  radius: (d, v) => cornerSketch(d, v, 'radius'),
};
