// SPDX-License-Identifier: GPL-2.0-or-later
// Stores the values of the forms in the program: as comments after its end, with a checksum of the G-code. So
// a program that was changed by hand is detected.
import type { Job, Step } from './job';
import type { Unit } from './types';

const MARK = ';@millwright-form';
const DATA = ';@ ';
/** Characters of a line; interpreters read at least 255. */
const WIDTH = 100;

/** A 53-bit checksum of the text in hexadecimal digits. It detects changes but does not protect against forgery. */
export function checksum(text: string): string {
  let [a, b] = [0xdeadbeef, 0x41c6ce57];
  for (let i = 0; i < text.length; i += 1) {
    const code = text.charCodeAt(i);
    a = Math.imul(a ^ code, 2654435761);
    b = Math.imul(b ^ code, 1597334677);
  }
  a = Math.imul(a ^ (a >>> 16), 2246822507) ^ Math.imul(b ^ (b >>> 13), 3266489909);
  b = Math.imul(b ^ (b >>> 16), 2246822507) ^ Math.imul(a ^ (a >>> 13), 3266489909);
  return (4294967296 * (2097151 & b) + (a >>> 0)).toString(16).padStart(14, '0');
}

/** Line ends and trailing blanks are ignored, because editors change them. */
const normal = (text: string): string => text.replace(/\r\n?/g, '\n').replace(/[ \t]+$/gm, '').trimEnd();

const ascii = (text: string): string => text.replace(/[\u0080-\uffff]/g, (one) => `\\u${one.charCodeAt(0).toString(16).padStart(4, '0')}`);

/** The program with its forms. */
export function withForm(program: string, job: Job): string {
  const json = ascii(JSON.stringify(job));
  const lines = json.match(new RegExp(`.{1,${WIDTH}}`, 'g')) ?? [];
  // A blank at the end of a line could get lost.
  const data = lines.map((one) => `${DATA}${one}|`);
  return `${program}${MARK} 1 ${checksum(normal(program))} ${checksum(json)}\n${data.join('\n')}\n`;
}

export type Opened = { kind: 'none' } | { kind: 'broken' } | { kind: 'newer' } | { kind: 'edited'; job: Job } | { kind: 'same'; job: Job };

/** `none`: not a program of these forms. `broken`: the stored form values cannot be read. `edited`: the G-code was changed by hand. */
export function openForm(text: string): Opened {
  const lines = text.replace(/\r\n?/g, '\n').split('\n');
  const at = lines.findIndex((one) => one.startsWith(MARK));
  if (at < 0) {
    return { kind: 'none' };
  }
  const [version, ofProgram, ofForm] = (lines[at] ?? '').slice(MARK.length).trim().split(/\s+/);
  if (version !== '1') {
    return { kind: 'newer' };
  }
  const behind = lines.slice(at + 1).filter((one) => one.trim() !== '');
  const data = behind.filter((one) => one.startsWith(DATA)).map((one) => one.slice(DATA.length).trimEnd().replace(/\|$/, ''));
  const json = data.join('');
  const job = checksum(json) === ofForm ? parsed(json) : null;
  if (job === null) {
    return { kind: 'broken' };
  }
  const isSame = behind.length === data.length && checksum(normal(lines.slice(0, at).join('\n'))) === ofProgram;
  return { kind: isSame ? 'same' : 'edited', job };
}

function parsed(json: string): Job | null {
  try {
    const value = JSON.parse(json) as Partial<Job> | null;
    const isJob = value !== null && value.version === 1 && Array.isArray(value.steps) && value.steps.every(isStep) && typeof value.name === 'string' && typeof value.safe === 'number' && (value.machine !== 'lathe' || typeof value.safeX === 'number');
    const isKnown = isJob && isOneOf(value.unit, ['mm', 'inch'] satisfies Unit[]) && isOneOf(value.machine, ['mill', 'lathe']) && isOneOf(value.retract, ['machine', 'safe']) && isOneOf(value.end, ['M30', 'M2']) && typeof value.system === 'string';
    return isKnown ? (value as Job) : null;
  } catch {
    return null;
  }
}
const isOneOf = (value: unknown, names: string[]): boolean => typeof value === 'string' && names.includes(value);
function isStep(one: Partial<Step> | null): boolean {
  return one !== null && typeof one === 'object' && typeof one.type === 'string' && typeof one.values === 'object' && one.values !== null && Object.values(one.values).every((value) => typeof value === 'number' || typeof value === 'string');
}
