// SPDX-License-Identifier: GPL-2.0-or-later
// Moves as arrays of three.js, and back; the arrays are shared.
import { BufferAttribute, BufferGeometry, Line, LineSegments, type Material } from 'three';
import type { Moves } from './chunks';

/** Lines from each point to the next. */
export function makeLine(moves: Moves, material: Material): Line {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(moves.places, 3));
  geometry.setAttribute('kind', new BufferAttribute(moves.kinds, 1));
  geometry.setAttribute('shade', new BufferAttribute(moves.shades, 1));
  geometry.setAttribute('line', new BufferAttribute(moves.lines, 1));
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return new Line(geometry, material);
}

/** A separate line for each pair of points. */
export function makeSegments(moves: Moves, material: Material): LineSegments {
  return new LineSegments(makeLine(moves, material).geometry, material);
}

export function movesOf(line: Line): Moves {
  const { position, kind, shade: shades, line: lines } = line.geometry.attributes;
  return {
    kind: 'moves',
    count: position?.count ?? 0,
    places: position?.array as Float32Array,
    lines: lines?.array as Uint32Array,
    kinds: kind?.array as Uint8Array,
    shades: shades?.array as Uint8Array,
  };
}
