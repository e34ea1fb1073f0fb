// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the lines, arcs, circles and polylines of a DXF file, and converts them to a short text that a
// program can contain.
import type { Point, Segment } from './path2';
import type { Unit } from './types';

/** A sequence of connected segments of one layer, as drawn. `bad` is the name of an entity that cannot be cut. */
export interface Entity {
  layer: string;
  start: Point;
  segments: Segment[];
  bad?: string;
}

export const MOST_ENTITIES = 2000;
type Pair = [number, string];

/** Entities that cannot be cut: notes, dimensions, points. */
const NOTES = new Set(['TEXT', 'MTEXT', 'DIMENSION', 'POINT', 'HATCH', 'LEADER', 'MULTILEADER', 'ATTDEF', 'ATTRIB', 'VIEWPORT', 'IMAGE', 'TOLERANCE', 'SEQEND', 'VERTEX', 'WIPEOUT']);

/** Null if the text is not a DXF file. */
function pairsOf(text: string): Pair[] | null {
  const lines = text.split(/\r\n|\r|\n/);
  const pairs: Pair[] = [];
  for (let i = 0; i + 1 < lines.length; i += 2) {
    const code = (lines[i] ?? '').trim();
    if (code === '' && i + 2 >= lines.length) {
      break;
    }
    if (!/^-?\d+$/.test(code)) {
      return null;
    }
    pairs.push([Number(code), (lines[i + 1] ?? '').trim()]);
  }
  return pairs;
}

const valueOf = (pairs: Pair[], code: number, preset = 0): number => {
  const text = pairs.find((one) => one[0] === code)?.[1];
  return text === undefined ? preset : Number(text);
};

/** Factor from units of the drawing to those of the program. */
function scaleOf(pairs: Pair[], unit: Unit): number {
  const at = pairs.findIndex((one) => one[0] === 9 && one[1] === '$INSUNITS');
  const code = at >= 0 ? Number(pairs[at + 1]?.[1] ?? 0) : 0;
  const millimetres = { 1: 25.4, 2: 304.8, 4: 1, 5: 10, 6: 1000 }[code];
  return millimetres === undefined ? 1 : unit === 'mm' ? millimetres : millimetres / 25.4;
}

interface Group {
  type: string;
  pairs: Pair[];
}
function groupsOf(pairs: Pair[]): Group[] {
  const groups: Group[] = [];
  let section = '';
  for (const [i, pair] of pairs.entries()) {
    if (pair[0] === 2 && pairs[i - 1]?.[1] === 'SECTION') {
      section = pair[1];
    }
    if (pair[0] === 0) {
      groups.push({ type: section === 'ENTITIES' && pair[1] !== 'SECTION' && pair[1] !== 'ENDSEC' ? pair[1] : '', pairs: [] });
      section = pair[1] === 'ENDSEC' ? '' : section;
    } else {
      groups.at(-1)?.pairs.push(pair);
    }
  }
  return groups.filter((one) => one.type !== '');
}

interface Vertex extends Point {
  bulge: number;
}

/** A segment of a polyline. The bulge is the tangent of a quarter of the arc's angle. */
function bulged(from: Point, to: Point, bulge: number): Segment {
  if (Math.abs(bulge) < 1e-9) {
    return { kind: 'line', to: { x: to.x, y: to.y } };
  }
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const lift = (1 - bulge * bulge) / (4 * bulge);
  return { kind: 'arc', to: { x: to.x, y: to.y }, centre: { x: (from.x + to.x) / 2 - lift * dy, y: (from.y + to.y) / 2 + lift * dx }, isCw: bulge < 0 };
}
function polyline(layer: string, vertices: Vertex[], isClosed: boolean): Entity {
  const all = isClosed ? [...vertices, vertices[0] as Vertex] : vertices;
  const segments = all.slice(1).map((to, i) => bulged(all[i] as Vertex, to, (all[i] as Vertex).bulge));
  return { layer, start: { x: all[0]?.x ?? NaN, y: all[0]?.y ?? NaN }, segments };
}
function arcEntity(layer: string, centre: Point, radius: number, from: number, to: number): Entity {
  const at = (turn: number): Point => ({ x: centre.x + radius * Math.cos((turn * Math.PI) / 180), y: centre.y + radius * Math.sin((turn * Math.PI) / 180) });
  return { layer, start: at(from), segments: [{ kind: 'arc', to: at(to), centre, isCw: false }] };
}
function circle(layer: string, centre: Point, radius: number): Entity {
  const at = (side: number): Point => ({ x: centre.x + side * radius, y: centre.y });
  return { layer, start: at(1), segments: [{ kind: 'arc', to: at(-1), centre, isCw: false }, { kind: 'arc', to: at(1), centre, isCw: false }] };
}

function verticesOf(pairs: Pair[], scale: number): Vertex[] {
  const out: Vertex[] = [];
  for (const [code, text] of pairs) {
    const last = out.at(-1);
    if (code === 10) {
      out.push({ x: Number(text) * scale, y: NaN, bulge: 0 });
    } else if (code === 20 && last !== undefined) {
      last.y = Number(text) * scale;
    } else if (code === 42 && last !== undefined) {
      last.bulge = Number(text);
    }
  }
  return out;
}

function entityOf(groups: Group[], i: number, scale: number): Entity | null {
  const { type, pairs } = groups[i] as Group;
  const layer = pairs.find((one) => one[0] === 8)?.[1] ?? '0';
  const bad: Entity = { layer, start: { x: 0, y: 0 }, segments: [], bad: type };
  if (NOTES.has(type) || valueOf(pairs, 67) === 1) {
    return null;
  }
  if (valueOf(pairs, 230, 1) < 0) {
    return { ...bad, bad: `${type} (mirrored)` };
  }
  const at = (x: number, y: number): Point => ({ x: valueOf(pairs, x, NaN) * scale, y: valueOf(pairs, y, NaN) * scale });
  const radius = valueOf(pairs, 40, NaN) * scale;
  switch (type) {
    case 'LINE':
      return { layer, start: at(10, 20), segments: [{ kind: 'line', to: at(11, 21) }] };
    case 'ARC':
      return arcEntity(layer, at(10, 20), radius, valueOf(pairs, 50, NaN), valueOf(pairs, 51, NaN));
    case 'CIRCLE':
      return circle(layer, at(10, 20), radius);
    case 'LWPOLYLINE':
      return polyline(layer, verticesOf(pairs, scale), (valueOf(pairs, 70) & 1) === 1);
    case 'POLYLINE': {
      if ((valueOf(pairs, 70) & 0x78) !== 0) {
        return bad; // a mesh, or a curve of vertices in space
      }
      const vertices: Vertex[] = [];
      for (let k = i + 1; groups[k]?.type === 'VERTEX'; k += 1) {
        vertices.push(...verticesOf((groups[k] as Group).pairs, scale).slice(0, 1));
      }
      return polyline(layer, vertices, (valueOf(pairs, 70) & 1) === 1);
    }
    default:
      return bad;
  }
}

/** Null if the text is not a DXF file. Entities without length are omitted. */
export function readDxf(text: string, unit: Unit): Entity[] | null {
  const pairs = pairsOf(text);
  if (pairs === null || !pairs.some((one) => one[0] === 2 && one[1] === 'ENTITIES')) {
    return null;
  }
  const scale = scaleOf(pairs, unit);
  const groups = groupsOf(pairs);
  const found = groups.map((_, i) => entityOf(groups, i, scale)).filter((one) => one !== null);
  return found.map((one) => (isNumeric(one) ? one : { layer: one.layer, start: { x: 0, y: 0 }, segments: [], bad: one.bad ?? 'number' })).filter((one) => one.bad !== undefined || one.segments.length > 0);
}

function isNumeric(one: Entity): boolean {
  return [one.start, ...one.segments.flatMap((segment) => (segment.kind === 'arc' ? [segment.to, segment.centre] : [segment.to]))].every((p) => Number.isFinite(p.x) && Number.isFinite(p.y));
}

const short = (value: number): string => String(Math.round(value * 1e6) / 1e6);

/**
 * One entity per line: its layer, a tab, its start, then the ends of its segments; for an arc also direction
 * and centre.
 */
export function packed(entities: Entity[]): string {
  return entities
    .map((one) => {
      if (one.bad !== undefined) {
        return `${one.layer}\t!${one.bad}`;
      }
      const words = one.segments.map((segment) => (segment.kind === 'line' ? `L ${short(segment.to.x)} ${short(segment.to.y)}` : `${segment.isCw ? 'R' : 'A'} ${[segment.to.x, segment.to.y, segment.centre.x, segment.centre.y].map(short).join(' ')}`));
      return `${one.layer}\t${short(one.start.x)} ${short(one.start.y)} ${words.join(' ')}`;
    })
    .join('\n');
}

/** The inverse; null if the text has another form. */
export function unpacked(text: string): Entity[] | null {
  const out: Entity[] = [];
  for (const line of text.split('\n').filter((one) => one !== '')) {
    const [layer = '', body] = line.split('\t');
    if (body === undefined) {
      return null;
    }
    if (body.startsWith('!')) {
      out.push({ layer, start: { x: 0, y: 0 }, segments: [], bad: body.slice(1) });
      continue;
    }
    const entity = unpackedOne(layer, body.split(' '));
    if (entity === null) {
      return null;
    }
    out.push(entity);
  }
  return out;
}

function unpackedOne(layer: string, words: string[]): Entity | null {
  const take = (at: number): Point => ({ x: Number(words[at]), y: Number(words[at + 1]) });
  const entity: Entity = { layer, start: take(0), segments: [] };
  for (let at = 2; at < words.length; ) {
    const kind = words[at];
    if (kind === 'L') {
      entity.segments.push({ kind: 'line', to: take(at + 1) });
      at += 3;
    } else if (kind === 'A' || kind === 'R') {
      entity.segments.push({ kind: 'arc', to: take(at + 1), centre: take(at + 3), isCw: kind === 'R' });
      at += 5;
    } else {
      return null;
    }
  }
  return isNumeric(entity) ? entity : null;
}

export function layersOf(entities: Entity[]): string[] {
  return [...new Set(entities.map((one) => one.layer))].sort();
}
