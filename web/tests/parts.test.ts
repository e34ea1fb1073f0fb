// SPDX-License-Identifier: GPL-2.0-or-later
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { de } from '../src/lib/i18n/de';
import { en, type TextKey } from '../src/lib/i18n/en';
import { es } from '../src/lib/i18n/es';
import { Texts } from '../src/lib/i18n/said';
import { fill, placesOf } from '../src/lib/i18n/text';
import { macroOf } from '../src/lib/macros';
import { formatBytes, formatDuration, formatNumber, isCalculated, parseNumber, parseWhole, percentDone } from '../src/lib/numbers';
import { ChunkReader, readChunks, type Chunk, type Moves } from '../src/lib/path/chunks';
import { thin } from '../src/lib/path/thin';
import { mergeDelta, modalWords, workPosition } from '../src/lib/status';

describe('numbers (A8)', () => {
  it.each([
    ['1', 1], ['-1.5', -1.5], ['+2,25', 2.25], ['.5', 0.5], [',5', 0.5], ['3.', 3], ['  7 ', 7],
    ['1 000', 1000], ['-12 345,5', -12345.5], ['1\u00a0000', 1000], ['1\u202f000\u202f000.25', 1_000_000.25], ['\u00a07\u202f', 7],
  ])('reads %s', (text, value) => expect(parseNumber(text)).toBe(value));
  it.each(['', '1.2.3', '1,000.5', '1 00', '1 0000', '10 00', '1  000', '1 000 00', '1.5 000', 'x', '1e5', '-', '.', 'Infinity', '0x10', '1..'])('refuses %s', (text) => expect(parseNumber(text)).toBeNull());
  it.each([
    ['1/2', 0.5], ['-1/2', -0.5], ['10+2.5', 12.5], ['10 + 2,5', 12.5], ['3-1/8', null], ['-3 - 1/8', null], ['3+1/8', 3.125], ['3.5-1/8', 3.375], ['1-1', 0], ['1/2+1/4', 0.75], ['1 000+0.5', 1000.5], ['-10-5', -15], ['3/-2', null],
    ['1/0', null], ['1/2/3', null], ['/2', null], ['1/', null], ['1+', null], ['+', null], ['1++2', null], ['1+-2', null], ['--1', null], ['2*3', null], ['(1)', null], ['1 1/2', null], ['1+x', null], ['1e3+1', null], ['1.2.3+1', null],
  ] as [string, number | null][])('calculates %s', (text, value) => expect(parseNumber(text)).toBe(value));
  it('knows what was calculated', () => expect(['1/2', '1+1', '-5', '1 000', 'x', '1/0'].map(isCalculated)).toEqual([true, true, false, false, false, false]));
  it.each([['1', 1], [' 77 ', 77], ['99999', 99999], ['007', 7], ['1 000', 1000], ['\u00a012\u202f345', 12345]])('reads %s as the number of a tool', (text, value) => expect(parseWhole(text, 1, 99999)).toBe(value));
  it.each(['', '0', '100000', '-1', '+1', '1.0', '1,5', '1e3', 'x', '9999999999'])('rejects %s as a tool number', (text) => expect(parseWhole(text, 1, 99999)).toBeNull());
  it.each([[100, 100, 0], [100, 99.9, 0], [100, 50, 50], [100, 0.1, 99], [100, 0, 100], [0, 5, 0], [100, 120, 0]])('of %d with %d left is %d percent', (total, left, percent) => expect(percentDone(total, left)).toBe(percent));
  it('shows no minus before a zero, and a dash where there is no number', () => {
    expect(formatNumber(-0.0001, 3)).toBe('0.000');
    expect(formatNumber(-0.0006, 3)).toBe('-0.001');
    expect(formatNumber(1.5, 2, ',')).toBe('1,50');
    expect(formatNumber(null, 3)).toBe('-');
    expect(formatNumber(NaN, 3)).toBe('-');
  });
  it('shows times and sizes', () => {
    expect(formatDuration(3661)).toBe('1:01:01');
    expect(formatDuration(59.6)).toBe('1:00');
    expect(formatBytes(999)).toBe('999 B');
    expect(formatBytes(1_500_000)).toBe('1.5 MB');
  });
});

describe('macros of [MDI_COMMAND_LIST] (J1)', () => {
  it.each([
    ['G0 X0; G0 Y0, Home XY', 'Home XY', ['G0 X0', 'G0 Y0']],
    ['G0 Z25;X0 Y0;Z0, Goto\\nUser\\nZero', 'Goto User Zero', ['G0 Z25', 'X0 Y0', 'Z0']],
    ['M8', 'M8', ['M8']],
  ])('reads %s', (text, label, lines) => expect(macroOf(text)).toEqual({ label, lines }));
});

describe('what the machine says (A8)', () => {
  const cases = JSON.parse(readFileSync('../po/cases.json', 'utf8')) as Record<string, Record<string, string>>;
  it.each(Object.entries(cases))('is in the language %s as in programs', (language, texts) => {
    const catalogue = new Texts(JSON.parse(execFileSync('python3', ['../tools/texts.py', '--json', language], { encoding: 'utf8' })) as Record<string, string>);
    for (const [english, shown] of Object.entries(texts)) {
      expect(catalogue.shown(english)).toBe(shown);
    }
  });
  it('stays English without a catalogue', () => expect(new Texts({}).shown('a.ngc:1: error: the machine is not on')).toBe('a.ngc:1: error: the machine is not on'));
});

describe('catalogues (A8)', () => {
  it.each([['de', de], ['es', es]] as const)('%s has every text with the same places', (_name, catalogue) => {
    expect(Object.keys(catalogue).sort()).toEqual(Object.keys(en).sort());
    for (const key of Object.keys(en) as TextKey[]) {
      expect(placesOf(catalogue[key]), key).toEqual(placesOf(en[key]));
      expect(catalogue[key].trim(), key).not.toBe('');
    }
  });
  it('fills placeholders, and shows one without a value', () => {
    expect(fill('{a} of {b}', { a: 1 })).toBe('1 of {b}');
  });
});

describe('status', () => {
  it('takes what has changed, of arrays by index', () => {
    const whole = { a: { b: 1, c: [1, 2, 3] }, joints: [{ p: 1, q: 2 }, { p: 3, q: 4 }], t: 'x' };
    mergeDelta(whole, { a: { c: { 1: 9 } }, joints: { 1: { p: 7 } }, t: 'y' });
    expect(whole).toEqual({ a: { b: 1, c: [1, 9, 3] }, joints: [{ p: 1, q: 2 }, { p: 7, q: 4 }], t: 'y' });
  });
  it('takes a value that became none, and one again', () => {
    const whole: Record<string, unknown> = { v: 1 };
    mergeDelta(whole, { v: null });
    expect(whole['v']).toBeNull();
    mergeDelta(whole, { v: 2 });
    expect(whole['v']).toBe(2);
  });
  it('calculates work coordinates as the interpreter does: rotate(program + G92) + G5x + tool', () => {
    const zero = [0, 0, 0, 0, 0, 0, 0, 0, 0];
    const offsets = { g5x_index: 1, g5x: [10, 20, 5, ...zero.slice(3)], g92: [1, 2, 3, ...zero.slice(3)], tool: [0, 0, 7, ...zero.slice(3)], rotation_xy_deg: 90 };
    // program (4, 5, 6) + G92 = (5, 7, 9); rotated by 90 degrees (-7, 5, 9); + G5x + tool = (3, 25, 21)
    const work = workPosition([3, 25, 21, 0, 0, 0, 0, 0, 0], offsets);
    expect(work[0]).toBeCloseTo(4, 12);
    expect(work[1]).toBeCloseTo(5, 12);
    expect(work[2]).toBeCloseTo(6, 12);
  });
  it('writes codes as people do', () => {
    expect(modalWords({ g: [0, 800, -1, 911, 540], m: [0, -1, 5], settings: [] })).toEqual(['G80', 'G91.1', 'G54', 'M5']);
  });
});

function chunk(kind: number, body: Uint8Array): Uint8Array {
  const bytes = new Uint8Array(8 + body.length);
  new DataView(bytes.buffer).setUint32(0, kind, true);
  new DataView(bytes.buffer).setUint32(4, body.length, true);
  bytes.set(body, 8);
  return bytes;
}

function movesBody(points: [number, number, number, number, number][]): Uint8Array {
  const size = 4 + points.length * 17;
  const body = new Uint8Array(size + ((4 - (size % 4)) % 4));
  const words = new DataView(body.buffer);
  words.setUint32(0, points.length, true);
  points.forEach(([x, y, z, line, kind], i) => {
    [x, y, z].forEach((value, axis) => words.setFloat32(4 + i * 12 + axis * 4, value, true));
    words.setUint32(4 + points.length * 12 + i * 4, line, true);
    words.setUint8(4 + points.length * 16 + i, kind);
  });
  return body;
}

describe('path', () => {
  const stream = [
    chunk(1, movesBody([[0, 0, 0, 1, 0], [1, 2, 3, 2, 1], [4, 5, 6, 3, 2]])),
    chunk(4, new TextEncoder().encode('p.ngc:4:1: wrong   ')),
    chunk(2, new Uint8Array(new Float32Array([0, 0, 0, 4, 5, 6]).buffer)),
    chunk(3, new Uint8Array(new Uint32Array([4, 3]).buffer)),
  ];
  const whole = new Uint8Array(stream.reduce((size, one) => size + one.length, 0));
  stream.reduce((at, one) => (whole.set(one, at), at + one.length), 0);

  it.each([1, 3, 7, 64, 100_000])('is read the same in pieces of %i bytes', (size) => {
    const reader = new ChunkReader();
    const chunks: Chunk[] = [];
    for (let at = 0; at < whole.length; at += size) {
      chunks.push(...reader.take(whole.slice(at, at + size)));
    }
    expect(reader.isWhole).toBe(true);
    expect(chunks.map((one) => one.kind)).toEqual(['moves', 'error', 'bounds', 'end']);
    const moves = chunks[0];
    if (moves?.kind !== 'moves') {
      throw new Error('no moves');
    }
    expect([...moves.places]).toEqual([0, 0, 0, 1, 2, 3, 4, 5, 6]);
    expect([...moves.lines]).toEqual([1, 2, 3]);
    expect([...moves.kinds]).toEqual([0, 1, 2]);
    expect(chunks[1]).toEqual({ kind: 'error', text: 'p.ngc:4:1: wrong' });
    expect(chunks[3]).toEqual({ kind: 'end', line: 4, points: 3 });
  });

  const kindsOf = async (type: 'bytes' | undefined, bytes: Uint8Array, size: number): Promise<string[]> => {
    const start = (control: { enqueue(piece: Uint8Array): void; close(): void }): void => {
      for (let at = 0; at < bytes.length; at += size) {
        control.enqueue(bytes.slice(at, at + size));
      }
      control.close();
    };
    const source = (type === 'bytes' ? { type, start } : { start }) as UnderlyingDefaultSource<Uint8Array>;
    const kinds: string[] = [];
    for await (const one of readChunks(new ReadableStream<Uint8Array>(source))) {
      kinds.push(one.kind === 'moves' ? `${one.count} moves to ${[...one.places.slice(-3)].join()}` : one.kind);
    }
    return kinds;
  };

  it.each([
    ['bytes', 1], ['bytes', 7], ['bytes', 100_000], [undefined, 1], [undefined, 7], [undefined, 100_000],
  ] as ['bytes' | undefined, number][])('is read the same from a stream (%s) in pieces of %i bytes', async (type, size) => {
    expect(await kindsOf(type, whole, size)).toEqual(['3 moves to 4,5,6', 'error', 'bounds', 'end']);
  });

  it.each(['bytes', undefined] as const)('that ends in the middle of a chunk is reported (%s)', async (type) => {
    await expect(kindsOf(type, whole.slice(0, -3), 7)).rejects.toThrow(/in the middle/);
    await expect(kindsOf(type, whole.slice(0, -9), 7)).rejects.toThrow(/in the middle/);
    await expect(kindsOf(type, whole.slice(0, 5), 7)).rejects.toThrow(/in the middle/);
  });

  it('rejects data that are not a path', () => {
    expect(() => new ChunkReader().take(chunk(77, new Uint8Array(4)))).toThrow(/unknown kind 77/);
    expect(() => new ChunkReader().take(chunk(1, new Uint8Array(new Uint32Array([1000]).buffer)))).toThrow(/shorter/);
  });

  it('is thinned without losing its ends, or where it changes', () => {
    const count = 1000;
    const places = new Float32Array(count * 3).map((_, i) => (i % 3 === 0 ? i / 3 / 100 : 0));
    const kinds = new Uint8Array(count).map((_, i) => (i < 500 ? 0 : 1));
    const thinned = thin({ kind: 'moves', count, places, lines: new Uint32Array(count), kinds, shades: new Uint8Array(count) }, 1);
    expect(thinned.count).toBeLessThan(20);
    expect(thinned.places[0]).toBe(0);
    expect(thinned.places[(thinned.count - 1) * 3]).toBeCloseTo(9.99, 5);
    const same: Moves = { kind: 'moves', count, places, lines: new Uint32Array(count), kinds, shades: new Uint8Array(count) };
    expect(thin(same, 0.001)).toBe(same); // a copy would have the same size
    const change = [...thinned.kinds].indexOf(1);
    expect(thinned.places[(change - 1) * 3]).toBeCloseTo(4.99, 5);
  });
});
