// SPDX-License-Identifier: GPL-2.0-or-later
// A font of single strokes for engraving. Capitals are 6 units high, small letters 4. A stroke is a list of
// points;
// @x,y,rx,ry,from,to is an arc of an ellipse around x,y between two angles in degrees. A semicolon begins a
// new stroke.
import type { Point } from './path2';

const CAPITALS = 6;
const GAP = 1.4;
const BLANK = 2.6;
const ARC_STEP_DEG = 12;

const BOWL_O = '4,2 4,4 @2,4,2,2,0,180 0,2 @2,2,2,2,180,360';
const P = '0,0 0,6 2.5,6 @2.5,4.5,1.5,1.5,90,-90 0,3';

const GLYPHS: Record<string, string> = {
  A: '0,0 2,6 4,0;0.67,2 3.33,2', B: '2.5,3 @2.5,4.5,1.5,1.5,-90,90 0,6 0,0 2.5,0 @2.5,1.5,1.5,1.5,-90,90 0,3', C: '@2,4,2,2,20,180 0,2 @2,2,2,2,180,340',
  D: '0,0 0,6 2,6 @2,4,2,2,90,0 4,2 @2,2,2,2,0,-90 0,0', E: '4,0 0,0 0,6 4,6;0,3 3,3', F: '0,0 0,6 4,6;0,3 3,3', G: '@2,4,2,2,20,180 0,2 @2,2,2,2,180,360 4,3 2.5,3',
  H: '0,0 0,6;4,6 4,0;0,3 4,3', I: '0,0 0,6', J: '3,6 3,1.5 @1.5,1.5,1.5,1.5,0,-180', K: '0,0 0,6;4,6 0,2;1.33,3.33 4,0', L: '0,6 0,0 4,0', M: '0,0 0,6 2.5,2 5,6 5,0',
  N: '0,0 0,6 4,0 4,6', O: BOWL_O, P, Q: `${BOWL_O};2.5,1.5 4,0`, R: `${P};2,3 4,0`, S: '@2,4.5,2,1.5,30,270 @2,1.5,2,1.5,90,-150', T: '2,0 2,6;0,6 4,6',
  U: '0,6 0,2 @2,2,2,2,180,360 4,6', V: '0,6 2,0 4,6', W: '0,6 1.5,0 3,5 4.5,0 6,6', X: '0,0 4,6;0,6 4,0', Y: '0,6 2,3 4,6;2,3 2,0', Z: '0,6 4,6 0,0 4,0',
  a: '3,4 3,0;@1.5,2,1.5,2,0,360', b: '0,6 0,0;@1.5,2,1.5,2,180,540', c: '@1.5,2,1.5,2,40,320', d: '3,6 3,0;@1.5,2,1.5,2,0,360', e: '0,2 3,2 @1.5,2,1.5,2,0,320',
  f: '@2,5,1,1,90,180 1,0;0,4 2,4', g: '3,4 3,-0.5 @1.5,-0.5,1.5,1.5,0,-150;@1.5,2,1.5,2,0,360', h: '0,6 0,0;0,2.5 @1.5,2.5,1.5,1.5,180,0 3,0', i: '0,0 0,4;0,5.4 0,5.7',
  j: '1,4 1,-1 @0,-1,1,1,0,-90;1,5.4 1,5.7', k: '0,0 0,6;3,4 0,1.5;1,2.33 3,0', l: '0,6 0,0', m: '0,4 0,0;0,2.75 @1.25,2.75,1.25,1.25,180,0 2.5,0;2.5,2.75 @3.75,2.75,1.25,1.25,180,0 5,0',
  n: '0,4 0,0;0,2.5 @1.5,2.5,1.5,1.5,180,0 3,0', o: '@1.5,2,1.5,2,0,360', p: '0,4 0,-2;@1.5,2,1.5,2,180,540', q: '3,4 3,-2;@1.5,2,1.5,2,0,360', r: '0,4 0,0;0,2.5 @1.5,2.5,1.5,1.5,180,70',
  s: '@1.5,3,1.4,1,30,270 @1.5,1,1.4,1,90,-150', t: '1,6 1,1 @2,1,1,1,180,270;0,4 2,4', u: '0,4 0,1.5 @1.5,1.5,1.5,1.5,180,360;3,4 3,0', v: '0,4 1.5,0 3,4', w: '0,4 1.1,0 2.25,3.2 3.4,0 4.5,4',
  x: '0,0 3,4;0,4 3,0', y: '0,4 1.5,0;3,4 0.75,-2', z: '0,4 3,4 0,0 3,0',
  0: BOWL_O, 1: '0,4.5 1.5,6 1.5,0', 2: '@2,4.2,2,1.8,170,-30 0,0 4,0', 3: '@2,4.5,1.8,1.5,150,-90 @2,1.5,2,1.5,90,-150', 4: '3,0 3,6 0,2 4,2', 5: '3.7,6 0.5,6 0.45,3.4 @1.9,2,2.1,2,128,-140',
  6: '@4,2,4,4,110,180 @2,2,2,2,180,540', 7: '0,6 4,6 1.5,0', 8: '@2,4.5,1.6,1.5,-90,270 @2,1.5,2,1.5,90,450', 9: '@0,4,4,4,-70,0 @2,4,2,2,0,360',
  '.': '0,0.3 0,0', ',': '0.4,0.4 0,-0.8', ':': '0,0.3 0,0;0,3.3 0,3', ';': '0.4,0.4 0,-0.8;0.4,3.3 0.4,3', '-': '0,3 2.5,3', '+': '0,3 3,3;1.5,1.5 1.5,4.5', '=': '0,2.2 3,2.2;0,3.8 3,3.8',
  '/': '0,0 3,6', '\\': '0,6 3,0', '(': '@2,3,2,4,130,230', ')': '@-1.3,3,2,4,50,-50', '[': '1,6.5 0,6.5 0,-0.5 1,-0.5', ']': '0,6.5 1,6.5 1,-0.5 0,-0.5', '!': '0,6 0,2;0,0.3 0,0',
  '?': '@1.5,4.5,1.5,1.5,170,-60 1.5,2.4 1.5,1.8;1.5,0.3 1.5,0', '"': '0,6 0,4.5;1,6 1,4.5', "'": '0,6 0,4.5', '%': '0,0 4,6;@0.9,5.1,0.9,0.9,0,360;@3.1,0.9,0.9,0.9,0,360', '#': '1,0 1.6,6;2.8,0 3.4,6;0,2 4,2;0.4,4 4.4,4',
  '&': '4,0 0.9,4 @1.8,4.8,1.2,1.2,220,-40 @1.5,1.5,1.5,1.5,110,300 4,2.6', '*': '1.5,1.5 1.5,4.5;0.2,2.25 2.8,3.75;0.2,3.75 2.8,2.25', _: '0,-0.6 4,-0.6', '<': '3,5 0,3 3,1', '>': '0,5 3,3 0,1',
  '@': '@2.5,3,1.2,1.2,30,330 3.7,2.4 @4.2,2.6,0.6,0.8,200,360 @2.4,3,2.4,2.8,0,300', '°': '@0.8,5.2,0.8,0.8,0,360', 'Ø': `${BOWL_O};0,0 4,6`, 'ø': '@1.5,2,1.5,2,0,360;0,0 3,4', '±': '0,3.5 3,3.5;1.5,2 1.5,5;0,1 3,1',
  '×': '0,1.5 3,4.5;0,4.5 3,1.5', 'µ': '0,4 0,-2;0,1.5 @1.5,1.5,1.5,1.5,180,360;3,4 3,0', '€': '@3,4,2,2,30,180 1,2 @3,2,2,2,180,330;0,3.6 3.4,3.6;0,2.4 3.4,2.4', 'ß': '0,0 0,4.6 @1.3,4.6,1.3,1.4,180,-90 @1.3,1.6,1.7,1.6,90,-110',
  '¿': '@1.5,1.5,1.5,1.5,-10,-240 1.5,3.6 1.5,4.2;1.5,5.7 1.5,6', '¡': '0,0 0,4;0,5.7 0,6', 'ẞ': '0,0 0,4.6 @1.5,4.6,1.5,1.4,180,45 2,3.4 @1.9,1.7,2,1.7,90,-120',
};
/** Letters with an accent: the letter, and the accent relative to its middle. */
const MARKS: Record<string, string> = { diaeresis: '-0.8,0.3 -0.8,0.6;0.8,0.3 0.8,0.6', acute: '-0.3,0 0.6,1', tilde: '-1.2,0.3 -0.6,0.8 0.6,0.3 1.2,0.8', dotless: '' };
const MARKED: Record<string, [string, string]> = {
  ä: ['a', 'diaeresis'], ö: ['o', 'diaeresis'], ü: ['u', 'diaeresis'], Ä: ['A', 'diaeresis'], Ö: ['O', 'diaeresis'], Ü: ['U', 'diaeresis'], ñ: ['n', 'tilde'], Ñ: ['N', 'tilde'],
  á: ['a', 'acute'], é: ['e', 'acute'], í: ['ı', 'acute'], ó: ['o', 'acute'], ú: ['u', 'acute'], Á: ['A', 'acute'], É: ['E', 'acute'], Í: ['I', 'acute'], Ó: ['O', 'acute'], Ú: ['U', 'acute'],
};
GLYPHS['ı'] = '0,0 0,4';

type Stroke = Point[];

function strokesOf(text: string): Stroke[] {
  return text.split(';').map((one) => one.split(' ').flatMap((token) => (token.startsWith('@') ? arc(token.slice(1)) : [pointOf(token)])));
}
function pointOf(token: string): Point {
  const [x = 0, y = 0] = token.split(',').map(Number);
  return { x, y };
}
function arc(token: string): Point[] {
  const [x = 0, y = 0, rx = 0, ry = 0, from = 0, to = 0] = token.split(',').map(Number);
  const count = Math.max(2, Math.ceil(Math.abs(to - from) / ARC_STEP_DEG));
  return Array.from({ length: count + 1 }, (_, i) => {
    const turn = ((from + ((to - from) * i) / count) * Math.PI) / 180;
    return { x: x + rx * Math.cos(turn), y: y + ry * Math.sin(turn) };
  });
}
const widthOf = (strokes: Stroke[]): number => Math.max(0, ...strokes.flat().map((p) => p.x));

function glyph(letter: string): Stroke[] | null {
  const plain = GLYPHS[letter];
  if (plain !== undefined) {
    return strokesOf(plain);
  }
  const [base, mark] = MARKED[letter] ?? [];
  if (base === undefined || mark === undefined) {
    return null;
  }
  const strokes = strokesOf(GLYPHS[base] ?? '');
  const [middle, above] = [widthOf(strokes) / 2, /\p{Lu}/u.test(letter) ? CAPITALS + 0.6 : 4.7];
  const placed = strokesOf(MARKS[mark] ?? '').map((stroke) => stroke.map((p) => ({ x: p.x + middle, y: p.y + above })));
  return [...strokes, ...placed];
}

/** The first character that the font does not have; null if the text can be engraved. */
export function unknownLetter(text: string): string | null {
  return [...text.normalize('NFC')].find((one) => one !== ' ' && glyph(one) === null) ?? null;
}

/** Strokes of a text with this height of capitals; the origin is the left end of its base line. */
export function strokesOfText(text: string, height: number): { strokes: Stroke[]; width: number } {
  const scale = height / CAPITALS;
  const out: Stroke[] = [];
  let at = 0;
  let width = 0;
  for (const letter of text.normalize('NFC')) {
    if (letter === ' ') {
      at += BLANK;
      continue;
    }
    const strokes = glyph(letter) ?? [];
    out.push(...strokes.map((stroke) => stroke.map((p) => ({ x: (p.x + at) * scale, y: p.y * scale }))));
    width = at + widthOf(strokes);
    at = width + GAP;
  }
  return { strokes: out, width: width * scale };
}
