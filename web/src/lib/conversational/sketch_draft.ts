// SPDX-License-Identifier: GPL-2.0-or-later
// Elements of a drawing, and functions to create one.
import type { Point } from './path2';
import { num, type Values } from './types';

export interface Outline {
  kind: 'stock' | 'part' | 'cut' | 'tool' | 'thin';
  points: Point[];
  isClosed: boolean;
}
/**
 * A dimension between two points, drawn `level` steps to the left of the direction from a to b (negative: to
 * the right). A dimension of zero length marks a point.
 */
export interface Dimension {
  field: string;
  a: Point;
  b: Point;
  level: number;
}
export interface Sketch {
  outlines: Outline[];
  dimensions: Dimension[];
}

export function circle(centre: Point, radius: number): Point[] {
  return Array.from({ length: 49 }, (_, i) => ({ x: centre.x + radius * Math.cos(i * (Math.PI / 24)), y: centre.y + radius * Math.sin(i * (Math.PI / 24)) }));
}

export class Draft {
  readonly sketch: Sketch = { outlines: [], dimensions: [] };
  outline(kind: Outline['kind'], points: Point[], isClosed = true): void {
    this.sketch.outlines.push({ kind, points, isClosed });
  }
  dimension(field: string, a: Point, b: Point, level = 1): void {
    this.sketch.dimensions.push({ field, a, b, level });
  }
  mark(fields: string[], at: Point): void {
    fields.forEach((field) => this.dimension(field, at, at, 0));
  }
  /** The tool at a point, with its diameter. */
  tool(values: Values, at: Point): void {
    const radius = num(values, 'diameter') / 2;
    this.outline('tool', circle(at, radius));
    this.dimension('diameter', { x: at.x - radius, y: at.y }, { x: at.x + radius, y: at.y }, 0.01);
  }
}
