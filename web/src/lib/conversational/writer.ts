// SPDX-License-Identifier: GPL-2.0-or-later
// Lines of G-code: numbers with the digits of the unit, without unchanged words, with comments that end
// correctly.
import { along, lengthOf, pathLength, reversed, splitPath, sweepOf, TINY, type Path, type Point, type Segment } from './path2';
import type { Unit } from './types';

export interface Position {
  x?: number;
  y?: number;
  z?: number;
}

/** Decimal digits of coordinates. Neighbouring points of a program differ by at least one last digit. */
export function digitsOf(unit: Unit): number {
  return unit === 'mm' ? 4 : 5;
}

export function plain(value: number, digits: number): string {
  const text = value.toFixed(digits).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '');
  return text === '-0' ? '0' : text;
}

/**
 * A comment cannot contain brackets, and some first words are commands (MSG, LOG). Letters of other alphabets
 * are kept.
 */
export function commentOf(text: string): string {
  return `(${text.replace(/[(]/g, '[').replace(/[)]/g, ']').replace(/[\r\n]+/g, ' ').replace(/^\s*(msg|debug|print|log\w*|probe\w*|py|abort)\s*,/i, '$1 ')})`;
}

/** A point of the path, for pictures. */
export interface TracePoint {
  x: number;
  y: number;
  z: number;
  isRapid: boolean;
}
const MOST_TRACE = 20_000;
const TRACE_STEP = Math.PI / 12;
/** In units of the last decimal digit. */
const LEAST_RADIUS = 20;

export class Writer {
  readonly lines: string[] = [];
  /** The tool path for pictures, without the moves of canned cycles. */
  readonly trace: TracePoint[] = [];
  readonly digits: number;
  private readonly at: { x: string; y: string; z: string; f: string } = { x: '', y: '', z: '', f: '' };
  private readonly here: { x: number; y: number; z: number } = { x: NaN, y: NaN, z: NaN };

  private readonly feedDigits: number;

  /** `isPerRevolution`: feeds are small numbers. */
  constructor(readonly unit: Unit, isPerRevolution = false) {
    this.digits = digitsOf(unit);
    this.feedDigits = isPerRevolution ? digitsOf(unit) : unit === 'mm' ? 2 : 3;
  }

  comment(text: string): void {
    this.lines.push(commentOf(text));
  }
  line(text: string): void {
    this.lines.push(text);
  }
  blank(): void {
    this.lines.push('');
  }
  /** The position is unknown after a canned cycle or a tool change, so all words are written. */
  forget(): void {
    Object.assign(this.at, { x: '', y: '', z: '', f: '' });
  }

  number(value: number): string {
    return plain(value, this.digits);
  }
  feedWord(rate: number): string {
    return `F${plain(rate, this.feedDigits)}`;
  }
  get x(): number {
    return this.here.x;
  }
  get y(): number {
    return this.here.y;
  }
  get z(): number {
    return this.here.z;
  }

  rapid(to: Position): void {
    const words = this.words(to);
    if (words.length > 0) {
      this.lines.push(['G0', ...words].join(' '));
      this.mark(true);
    }
  }
  feed(to: Position, rate: number): void {
    const words = this.words(to);
    if (words.length > 0) {
      this.lines.push(['G1', ...words, ...this.rate(rate)].join(' '));
      this.mark(false);
    }
  }
  /** An arc around `centre` from the current position; with `turns` also full circles. */
  arc(to: Point & { z?: number }, centre: Point, isCw: boolean, rate: number, turns = 1): void {
    const [fromX, fromY] = [Number(this.at.x), Number(this.at.y)];
    const isSame = this.number(to.x) === this.at.x && this.number(to.y) === this.at.y;
    const isCircle = Math.hypot(to.x - this.here.x, to.y - this.here.y) < TINY;
    if (isSame && !isCircle) {
      return; // the arc is shorter than the last digit and would be read as a full circle
    }
    if (Math.hypot(to.x - centre.x, to.y - centre.y) < LEAST_RADIUS * 10 ** -this.digits) {
      this.feed(to, rate); // after rounding, the arc would have different radii at its ends
      return;
    }
    const words = [isCw ? 'G2' : 'G3', `X${this.number(to.x)}`, `Y${this.number(to.y)}`];
    if (to.z !== undefined && this.number(to.z) !== this.at.z) {
      words.push(`Z${this.number(to.z)}`);
    }
    words.push(`I${this.number(centre.x - fromX)}`, `J${this.number(centre.y - fromY)}`);
    if (turns > 1) {
      words.push(`P${turns}`);
    }
    this.markArc(to, centre, isCw);
    this.words(to);
    this.lines.push([...words, ...this.rate(rate)].join(' '));
    this.mark(false);
  }
  private mark(isRapid: boolean): void {
    if (this.trace.length < MOST_TRACE) {
      this.trace.push({ ...this.here, isRapid });
    }
  }
  /** Points between the ends of an arc; full circles before the last one are omitted. */
  private markArc(to: Point & { z?: number }, centre: Point, isCw: boolean): void {
    const [from, end] = [{ ...this.here }, to.z ?? this.here.z];
    const arc: Segment = { kind: 'arc', to, centre, isCw };
    const count = Math.ceil(sweepOf(from, arc) / TRACE_STEP);
    for (let i = 1; i < count && this.trace.length < MOST_TRACE; i += 1) {
      this.trace.push({ ...along(from, arc, i / count), z: from.z + ((end - from.z) * i) / count, isRapid: false });
    }
  }

  /** An arc by its radius in the XZ plane, where X is a diameter. */
  arcByRadius(to: { x: number; z: number }, radius: number, isCw: boolean, rate: number): void {
    const words = this.words(to);
    if (words.length > 0) {
      this.lines.push([isCw ? 'G2' : 'G3', `X${this.number(to.x)}`, `Z${this.number(to.z)}`, `R${this.number(radius)}`, ...this.rate(rate)].join(' '));
      this.mark(false);
    }
  }

  /** Cuts along the path, whose start is the current position. */
  follow(path: Path, rate: number): void {
    for (const one of path.segments) {
      if (one.kind === 'line') {
        this.feed(one.to, rate);
      } else {
        this.arc(one.to, one.centre, one.isCw, rate);
      }
    }
  }
  /** Follows the path while Z changes linearly to `z`. */
  ramp(path: Path, z: number, rate: number): void {
    const total = pathLength(path);
    const from = this.here.z;
    let [at, done] = [path.start, 0];
    for (const one of path.segments) {
      done += lengthOf(at, one);
      const level = from + ((z - from) * done) / total;
      if (one.kind === 'line') {
        this.feed({ ...one.to, z: level }, rate);
      } else {
        this.arc({ ...one.to, z: level }, one.centre, one.isCw, rate);
      }
      at = one.to;
    }
  }
  /**
   * Follows a part of the path down to `z` with at most `slope`; back and forth if the path is too short. It
   * ends at the start of the path, whose ramp has been cut away.
   */
  rampInto(path: Path, z: number, slope: number, rate: number, isLoop: boolean): void {
    const needed = (this.here.z - z) / slope;
    const total = pathLength(path);
    if (isLoop) {
      const turns = Math.max(1, Math.ceil(needed / total - 1e-9));
      const from = this.here.z;
      for (let i = 1; i <= turns; i += 1) {
        this.ramp(path, from + ((z - from) * i) / turns, rate);
      }
      return;
    }
    const passes = Math.max(1, Math.ceil(needed / total - 1e-9));
    const from = this.here.z;
    const part = passes === 1 ? splitPath(path, Math.min(total, needed))[0] : path;
    const back = reversed(part);
    for (let i = 1; i <= passes; i += 1) {
      this.ramp(i % 2 === 1 ? part : back, from + ((z - from) * i) / passes, rate);
    }
    if (passes % 2 === 1) {
      this.follow(back, rate);
    } else {
      this.follow(part, rate);
      this.follow(back, rate);
    }
  }

  private rate(rate: number): string[] {
    const text = this.feedWord(rate);
    if (text === this.at.f) {
      return [];
    }
    this.at.f = text;
    return [text];
  }
  private words(to: Position): string[] {
    const out: string[] = [];
    for (const axis of ['x', 'y', 'z'] as const) {
      const value = to[axis];
      if (value === undefined) {
        continue;
      }
      this.here[axis] = value;
      const text = this.number(value);
      if (text !== this.at[axis]) {
        this.at[axis] = text;
        out.push(`${axis.toUpperCase()}${text}`);
      }
    }
    return out;
  }
}

/** Z of each level: equal steps from `top` down by `depth`, at most `step` each. */
export function levelsOf(top: number, depth: number, step: number): number[] {
  const count = Math.max(1, Math.ceil(depth / step - 1e-9));
  return Array.from({ length: count }, (_, i) => top - (depth * (i + 1)) / count);
}
