// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the forms of conversational programming: their checks, their programs, and the data stored in a
// program (J1).
import { describe, expect, it } from 'vitest';
import { chained } from '../../src/lib/conversational/chains';
import { packed, readDxf, unpacked } from '../../src/lib/conversational/dxf';
import { strokesOfText, unknownLetter } from '../../src/lib/conversational/font';
import { de } from '../../src/lib/conversational/i18n/de';
import { en, type ConvKey } from '../../src/lib/conversational/i18n/en';
import { es } from '../../src/lib/conversational/i18n/es';
import { isFaultless, jobFaults, newJob, NOTHING_KNOWN, programOf, stepFaults, type Job, type MachineFacts } from '../../src/lib/conversational/job';
import { offsetLeft } from '../../src/lib/conversational/offset';
import { pathLength, ringPath, splitPath } from '../../src/lib/conversational/path2';
import { holesOf, readPoints } from '../../src/lib/conversational/patterns';
import { operationOf, OPERATIONS } from '../../src/lib/conversational/registry';
import { sketchOf } from '../../src/lib/conversational/sketch';
import { openForm, withForm } from '../../src/lib/conversational/store';
import { converted, jobOf, textsOf } from '../../src/lib/conversational/texts';
import type { Context, Field, Values } from '../../src/lib/conversational/types';
import { faultsOf, filled } from '../../src/lib/conversational/validate';
import { commentOf, levelsOf, plain, Writer } from '../../src/lib/conversational/writer';
import { placesOf } from '../../src/lib/i18n/text';

const CONTEXT: Context = { unit: 'mm', safe: 25, safeX: 80, tools: null, maxFeed: 6000, maxSpeed: 12000 };
const FACTS: MachineFacts = { tools: null, maxFeed: 6000, maxSpeed: 12000 };
const SQUARE = packed([{ layer: '0', start: { x: 0, y: 0 }, segments: [[40, 0], [40, 30], [0, 30], [0, 0]].map(([x = 0, y = 0]) => ({ kind: 'line' as const, to: { x, y } })) }]);

function valuesOf(type: string, typed: Values = {}, context = CONTEXT): Values {
  const operation = operationOf(type);
  const drawing: Values = type === 'contour' ? { drawing: SQUARE, layer: '0' } : {};
  return operation === null ? {} : filled(operation, { ...drawing, ...typed }, context);
}
function faults(type: string, typed: Values = {}, context = CONTEXT): Record<string, string> {
  const operation = operationOf(type);
  return operation === null ? {} : Object.fromEntries(Object.entries(faultsOf(operation, valuesOf(type, typed, context), context)).map(([id, fault]) => [id, fault.key]));
}
function jobWith(...steps: [string, Values][]): Job {
  return { ...newJob('mm', operationOf(steps[0]?.[0] ?? '')?.machine ?? 'mill'), name: 'Plate', steps: steps.map(([type, typed]) => ({ type, values: valuesOf(type, typed) })) };
}

describe('texts', () => {
  const keys = Object.keys(en) as ConvKey[];
  it.each([['de', de], ['es', es]])('%s has all texts with the same places', (_, catalogue) => {
    expect(Object.keys(catalogue).sort()).toEqual([...keys].sort());
    for (const key of keys) {
      expect(placesOf(catalogue[key]), key).toEqual(placesOf(en[key]));
    }
  });
  it('names each operation, field and choice', () => {
    const wanted = OPERATIONS.flatMap((one) => [`op.${one.id}`, ...one.fields.flatMap((field: Field) => [`field.${field.id}`, ...(field.kind === 'choice' ? field.options.map((option) => `choice.${field.id}.${option}`) : [])])]);
    expect([...new Set(wanted)].filter((key) => !(key in en))).toEqual([]);
  });
});

describe('defaults', () => {
  it.each(OPERATIONS.map((one) => one.id))('of %s are accepted in both units and draw a picture', (type) => {
    expect(faults(type)).toEqual({});
    if (type !== 'contour') {
      expect(faults(type, {}, { ...CONTEXT, unit: 'inch', safe: 1, safeX: 3, maxFeed: 240 })).toEqual({});
    }
    const operation = operationOf(type);
    expect(operation === null ? [] : sketchOf(operation, valuesOf(type), CONTEXT).outlines).not.toEqual([]);
  });
  it('follow the tool of the table', () => {
    const context = { ...CONTEXT, tools: [{ number: 4, diameter: 12 }] };
    const values = valuesOf('rect_pocket', { tool: 4 }, context);
    expect([values['diameter'], values['step_down'], values['step_over']]).toEqual([12, 5, 4.8]);
    expect(faults('rect_pocket', { tool: 5 }, context)).toMatchObject({ tool: 'fault.no_tool' });
  });
});

describe('impossible values are rejected at their field', () => {
  it.each<[string, Values, Record<string, string>]>([
    ['slot', { slot_width: 5, diameter: 6 }, { slot_width: 'fault.tool_wide' }],
    ['rect_pocket', { width: 5.9, diameter: 6, corner_radius: 2.9 }, { width: 'fault.tool_wide', corner_radius: 'fault.corner_tool' }],
    ['rect_pocket', { depth: 0 }, { depth: 'fault.above_zero' }],
    ['rect_pocket', { depth: NaN }, { depth: 'fault.number' }],
    ['rect_pocket', { step_over: 6.5, diameter: 6 }, { step_over: 'fault.step_tool' }],
    ['rect_pocket', { step_over: 5, diameter: 6 }, { step_over: 'fault.step_share' }],
    ['rect_pocket', { top: 25 }, { top: 'fault.top_safe' }],
    ['rect_pocket', { clearance: 26 }, { clearance: 'fault.clearance_safe' }],
    ['round_pocket', { pocket_diameter: 6.4, diameter: 6, allowance: 0 }, { entry: 'fault.no_entry' }],
    ['rect_boss', { length: 50, stock_length: 49 }, { stock_length: 'fault.boss_stock' }],
    ['tap', { pitch: 2, speed: 4000 }, { pitch: 'fault.pitch_feed' }],
    ['drill', { pattern: 'line', spacing: 5, diameter: 6 }, { spacing: 'fault.overlap' }],
    ['drill', { pattern: 'grid', spacing_y: 5, diameter: 6 }, { spacing_y: 'fault.overlap' }],
    ['drill', { pattern: 'list', points: '1 2\n3' }, { points: 'fault.point' }],
    ['drill', { holes: 2.5 }, { holes: 'fault.whole' }],
    ['thread_mill', { diameter: 18.5 }, { diameter: 'fault.thread_tool' }],
    ['engrave', { text: 'A☃' }, { text: 'fault.letter' }],
    ['contour', { side: 'left' }, { side: 'fault.side_closed' }],
    ['contour', { side: 'inside', diameter: 31 }, { diameter: 'fault.no_room' }],
    ['turn', { part_diameter: 40, cut: 1 }, { part_diameter: 'fault.part_stock' }],
    ['groove', { groove_width: 2 }, { groove_width: 'fault.tool_wide_groove' }],
    ['lathe_thread', { speed: 5000 }, { pitch: 'fault.pitch_feed' }],
    ['chamfer', { chamfer: 20 }, { chamfer: 'fault.corner_part' }],
    ['contour', { layer: 'x' }, { layer: 'fault.no_layer' }],
  ])('%s %o', (type, typed, wanted) => expect(faults(type, typed)).toEqual(wanted));

  it('of the program itself', () => {
    const job = jobWith(['face', { top: 3 }]);
    expect(jobFaults({ ...job, safe: 2 })['safe']?.key).toBe('fault.safe_below');
    expect(jobFaults({ ...job, name: '../x' })['name']?.key).toBe('fault.name');
    expect(isFaultless({ ...job, steps: [] }, FACTS)).toBe(false);
  });
  it('one tool has one diameter', () => {
    const job = jobWith(['face', { tool: 2, diameter: 20 }], ['slot', { tool: 2, diameter: 6 }]);
    expect(stepFaults(job, FACTS).map((one) => one['diameter']?.key)).toEqual([undefined, 'fault.tool_twice']);
  });
});

describe('programs', () => {
  it('name units, plane, system, tool, length, spindle and coolant, and end with all off', () => {
    const lines = programOf(jobWith(['rect_pocket', { tool: 3 }]), FACTS).split('\n');
    expect(lines).toEqual(expect.arrayContaining(['(Plate)', 'G21 G17 G90 G94', 'G40 G49 G80', 'G54', 'T3 M6', 'G43 H3', 'S3000 M3', 'M8', '(  Depth: 5 mm)']));
    expect(lines.filter((line) => line !== '').slice(-3)).toEqual(['M5 M9', 'G53 G0 Z0', 'M30']);
    expect(lines.indexOf('G53 G0 Z0')).toBeLessThan(lines.indexOf('T3 M6'));
  });
  it('of a lathe use diameters, feed per revolution and the safe position', () => {
    const lines = programOf(jobWith(['lathe_thread', { tool: 3, thread_side: 'internal', major: 30 }], ['part_off', { tool: 2, speed_mode: 'surface' }]), FACTS).split('\n');
    expect(lines).toEqual(expect.arrayContaining(['G21 G18 G7 G90 G95', 'G97 S400 M3', 'G96 D2000 S120 M3', 'G0 X80', 'G0 Z50']));
    // Leaves the bore along Z before X moves.
    const at = lines.findIndex((line) => line.startsWith('G76'));
    expect(lines.slice(at + 1, at + 3)).toEqual(['G7', 'G0 Z4.5']);
    expect(lines.slice(-3, -1)).toEqual(['G97 G94 G8', 'M30']);
  });
  it('change a tool only where another one follows', () => {
    const text = programOf(jobWith(['rect_pocket', { tool: 3 }], ['slot', { tool: 3, coolant: 'mist' }], ['drill', { tool: 4 }]), FACTS);
    expect(text.match(/M6/g)).toHaveLength(2);
    expect(text).toMatch(/M9\nS3000 M3\nM7\n/);
  });
  it('turn the spindle backwards for a left-hand tap', () => expect(programOf(jobWith(['tap', { hand: 'left' }]), FACTS)).toContain('S300 M4'));
  it('have equal depth steps, none deeper than set', () => {
    expect(levelsOf(0, 5, 2)).toEqual([-5 / 3, -10 / 3, -5]);
    expect(levelsOf(1, 4, 2)).toEqual([-1, -3]);
  });
  it('write no bracket or command into a comment', () => expect([commentOf('MSG, hi'), commentOf('a (b) c\nd'), commentOf('debug,x')]).toEqual(['(MSG  hi)', '(a [b] c d)', '(debug x)']));
  it('write numbers without needless digits or exponents', () => expect([plain(-0.00001, 4), plain(2.5, 4), plain(1e-7, 4), plain(100, 4), plain(1 / 3, 4)]).toEqual(['0', '2.5', '0', '100', '0.3333']));
  it('write no arc that rounding makes a whole circle', () => {
    const writer = new Writer('mm');
    writer.rapid({ x: 10, y: 0, z: 0 });
    writer.arc({ x: 10, y: 0.00001 }, { x: 0, y: 0 }, false, 100);
    expect(writer.lines).toHaveLength(1);
  });
  it('write an arc as a line where its radius is lost in rounding', () => {
    const writer = new Writer('mm');
    writer.rapid({ x: 10, y: 0, z: 0 });
    writer.arc({ x: 10.0001, y: 0.0001 }, { x: 10, y: 0.0001 }, false, 100);
    expect(writer.lines[1]).toBe('G1 X10.0001 Y0.0001 F100');
  });
});

describe('a program contains its form', () => {
  const job = jobWith(['engrave', { text: 'Größe (ñ) ;@ 5"' }], ['contour', {}]);
  const text = withForm(programOf(job, NOTHING_KNOWN), job);
  it('in short lines of ASCII comments, and gives it back', () => {
    const form = text.slice(text.indexOf('\n;@') + 1);
    expect(form.split('\n').every((line) => line.length <= 120 && /^(;@[\x20-\x7e]*)?$/.test(line))).toBe(true);
    expect(openForm(text)).toEqual({ kind: 'same', job });
    expect(openForm(text.replaceAll('\n', '\r\n')).kind).toBe('same');
  });
  it('and knows of changes by hand', () => {
    expect(openForm(text.replace('S10000', 'S9000')).kind).toBe('edited');
    expect(openForm(`${text}G0 X0\n`).kind).toBe('edited');
    expect(openForm(text.replace(/^;@ ./m, ';@ x')).kind).toBe('broken');
    expect(openForm(text.replace('@millwright-form 1', '@millwright-form 2')).kind).toBe('newer');
    expect(openForm('G0 X0\n').kind).toBe('none');
  });
  it('as texts of an operator, with the same program again', () => expect(programOf(jobOf(textsOf(job, ','), FACTS), FACTS)).toBe(programOf(job, FACTS)));
  it('keeps sizes when the unit changes', () => {
    const inch = converted(textsOf(jobWith(['slot', { slot_width: 12.7 }])), 'inch');
    expect(inch.steps[0]?.texts).toMatchObject({ slot_width: '0.5', speed: '3000' });
    expect(inch.safe).toBe('0.98425');
  });
});

describe('geometry', () => {
  it('has holes where the pattern puts them', () => {
    const near = (type: string, typed: Values): string[] => holesOf(valuesOf(type, typed)).map((p) => `${p.x.toFixed(3)} ${p.y.toFixed(3)}`);
    expect(near('drill', { pattern: 'circle', holes: 4, circle_diameter: 20, start_angle: 90 })).toEqual(['0.000 10.000', '-10.000 0.000', '-0.000 -10.000', '10.000 -0.000']);
    expect(near('drill', { pattern: 'grid', columns: 2, rows: 2, spacing_x: 3, spacing_y: 4 })).toEqual(['0.000 0.000', '3.000 0.000', '3.000 4.000', '0.000 4.000']);
    expect(readPoints('1,5 2\n-3; 4.25\n\n')).toEqual([{ x: 1.5, y: 2 }, { x: -3, y: 4.25 }]);
  });
  it('cuts a path in two without loss', () => {
    const path = ringPath({ x: 20, y: 10, radius: 4 }, false, 'bottom');
    const [first, rest] = splitPath(path, 33);
    expect(pathLength(first)).toBeCloseTo(33, 9);
    expect(pathLength(first) + pathLength(rest)).toBeCloseTo(pathLength(path), 9);
    expect(pathLength(path)).toBeCloseTo(2 * (32 + 12) + 8 * Math.PI, 9);
  });
  it('shifts a contour beside itself: arcs at outer corners', () => {
    const square = ringPath({ x: 10, y: 10, radius: 0 }, true, 'bottom');
    const made = offsetLeft(square, 3);
    expect('path' in made && pathLength(made.path)).toBeCloseTo(80 + 6 * Math.PI, 9);
  });
  it('has strokes for all letters of three languages', () => {
    expect(unknownLetter('ABCXYZ abcxyz 0123456789 äöüÄÖÜß ñÑáéíóúÁÉÍÓÚ ¿¡ .,:;-+/()')).toBeNull();
    expect(unknownLetter('a\u0308')).toBeNull(); // as two characters
    expect(unknownLetter('日')).toBe('日');
    expect(Math.max(...strokesOfText('H', 7).strokes.flat().map((p) => p.y))).toBeCloseTo(7, 9);
  });
});

describe('DXF', () => {
  const file = (...entities: string[]): string => `0\nSECTION\n2\nENTITIES\n${entities.join('')}0\nENDSEC\n0\nEOF\n`;
  const line = (x1: number, y1: number, x2: number, y2: number): string => `0\nLINE\n8\ncut\n10\n${x1}\n20\n${y1}\n11\n${x2}\n21\n${y2}\n`;
  const chain = (text: string) => chained(readDxf(text, 'mm') ?? [], 0.01);
  it('joins lines and arcs in any order and direction', () => {
    const found = chain(file(line(10, 0, 10, 5), line(0, 0, 10, 0), '0\nARC\n8\ncut\n10\n5\n20\n5\n40\n5\n50\n0\n51\n180\n', line(0, 0, 0, 5)));
    expect('chains' in found && found.chains.map((one) => pathLength(one))).toEqual([expect.closeTo(20 + 5 * Math.PI, 6)]);
  });
  it('closes small gaps, and keeps arcs whose ends are as far from the centre', () => {
    const found = chain(file(line(10, 0.004, 10, 5), line(0, 0, 10, 0), '0\nARC\n8\ncut\n10\n5.003\n20\n5\n40\n5\n50\n0\n51\n180\n', line(0, 0.003, 0, 5)));
    const path = 'chains' in found ? found.chains[0] : undefined;
    const at = path?.segments.findIndex((one) => one.kind === 'arc') ?? -1;
    const arc = path?.segments[at];
    const from = at > 0 ? path?.segments[at - 1]?.to : path?.start;
    expect(arc?.kind === 'arc' && from !== undefined && Math.hypot(from.x - arc.centre.x, from.y - arc.centre.y) - Math.hypot(arc.to.x - arc.centre.x, arc.to.y - arc.centre.y)).toBeCloseTo(0, 12);
  });
  it('reads bulges of both directions', () => {
    const made = readDxf(file('0\nLWPOLYLINE\n8\ncut\n70\n0\n10\n0\n20\n0\n42\n1\n10\n10\n20\n0\n42\n-1\n10\n20\n20\n0\n'), 'mm') ?? [];
    expect(made[0]?.segments.map((one) => one.kind === 'arc' && one.isCw)).toEqual([false, true]);
    expect(unpacked(packed(made))).toEqual(made);
  });
  it.each([
    ['fault.dxf_branch', file(line(0, 0, 5, 0), line(5, 0, 9, 0), line(5, 0, 5, 5))],
    ['fault.dxf_entity', file(line(0, 0, 5, 0), '0\nSPLINE\n8\ncut\n')],
    ['fault.dxf_empty', file('0\nLINE\n8\ncut\n10\n1\n20\n1\n11\n1\n21\n1\n')],
    ['fault.dxf_twice', file('0\nCIRCLE\n8\ncut\n10\n0\n20\n0\n40\n5\n', '0\nCIRCLE\n8\ncut\n10\n0\n20\n0\n40\n5\n')],
  ])('reports %s', (key, text) => {
    const found = chain(text);
    expect('fault' in found ? found.fault.key : null).toBe(key);
  });
  it('reads the unit of the drawing, and no other files', () => {
    const inches = `0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n1\n0\nENDSEC\n${file(line(0, 0, 1, 0))}`;
    expect(readDxf(inches, 'mm')?.[0]?.segments[0]?.to.x).toBeCloseTo(25.4, 9);
    expect(readDxf('AutoCAD Binary DXF\r\n', 'mm')).toBeNull();
    expect(readDxf('', 'mm')).toBeNull();
  });
});
