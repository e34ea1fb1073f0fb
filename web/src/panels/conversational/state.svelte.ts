// SPDX-License-Identifier: GPL-2.0-or-later
// The program of the forms. It belongs to the page: the values are kept when another view is shown, and after a reload.
import { tc } from '../../lib/conversational/i18n/index.svelte';
import { contextOf, newJob, type MachineFacts } from '../../lib/conversational/job';
import { operationOf } from '../../lib/conversational/registry';
import { checksum } from '../../lib/conversational/store';
import { jobOf, textOf, textsOf, valuesOf, type JobTexts } from '../../lib/conversational/texts';
import type { Job } from '../../lib/conversational/job';
import { decimalSeparator } from '../../lib/i18n/index.svelte';
import { machine } from '../../lib/machine.svelte';
import { tools } from '../../lib/tools.svelte';

const KEY = 'mw-conversational';
const MM_PER_INCH = 25.4;

export interface FormState {
  job: JobTexts;
  /** Index in the list; -1: the program itself. */
  selected: number;
  /** The file from which the values were read or to which they were written; null: none yet. */
  file: string | null;
  /** Checksum of its text at that time. A file changed since is replaced only after confirmation. */
  sum: string;
  isChanged: boolean;
  nextId: number;
}

/** The forms that fit the machine; null if there are none. */
export function machineKind(): 'mill' | 'lathe' | null {
  const kind = machine.facts?.kind ?? 'mill';
  return kind === 'mill' ? 'mill' : kind === 'foam' ? null : 'lathe';
}

function freshState(unit: 'mm' | 'inch'): FormState {
  return { job: { ...textsOf(newJob(unit, machineKind() ?? 'mill'), decimalSeparator()), name: tc('panel.default_name') }, selected: -1, file: null, sum: '', isChanged: false, nextId: 1 };
}

function kept(): FormState | null {
  try {
    const value = JSON.parse(localStorage.getItem(KEY) ?? 'null') as FormState | null;
    const isGood = value !== null && value.job.version === 1 && typeof value.job.name === 'string' && typeof value.job.safe === 'string' && Array.isArray(value.job.steps) && value.job.steps.every((one) => operationOf(one.type) !== null && typeof one.texts === 'object');
    return isGood && value.job.machine === machineKind() ? value : null;
  } catch {
    return null; // from an older page, or access denied
  }
}

export const form = $state<FormState>(kept() ?? freshState(machine.facts?.linear_unit ?? 'mm'));

export function keep(): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(form));
  } catch {
    // Storage is full or access is denied: the values are kept until the page is reloaded.
  }
}

export function machineFacts(): MachineFacts {
  const own = machine.facts?.linear_unit ?? 'mm';
  const factor = own === form.job.unit ? 1 : own === 'inch' ? MM_PER_INCH : 1 / MM_PER_INCH;
  const speed = machine.status?.settings.max_velocity ?? 0;
  const spindle = machine.facts?.spindles[0]?.max_speed ?? 0;
  return {
    tools: tools.version < 0 ? null : tools.list.map((one) => ({ number: one.toolno, diameter: Math.round(one.diameter * factor * 1e5) / 1e5 })),
    maxFeed: speed > 0 ? Math.round(speed * factor * 60 * 1e3) / 1e3 : null,
    maxSpeed: spindle > 0 ? spindle : null,
  };
}

export function startOver(): void {
  Object.assign(form, freshState(form.job.unit));
}

/** `file` and its `text`; null: the values are saved as a new file. */
export function openJob(job: Job, from: { file: string; text: string } | null): void {
  const texts = textsOf(job, decimalSeparator());
  Object.assign(form, { job: texts, selected: texts.steps.length > 0 ? 0 : -1, file: from?.file ?? null, sum: from === null ? '' : checksum(from.text), isChanged: from === null, nextId: texts.steps.length });
}

/** Words of tool comments for proposing the tool of an operation. */
const TOOL_WORDS: Record<string, RegExp> = { turn: /rough|turn|schrupp|dreh|desbast|cilindr/i, lathe_face: /rough|turn|fac|schrupp|dreh|desbast|refren/i, chamfer: /finish|turn|schlicht|dreh|acabad|cilindr/i, radius: /finish|turn|schlicht|dreh|acabad|cilindr/i, lathe_bore: /bor(e|ing)|innen|mandrin/i, groove: /groov|stech|ranur/i, part_off: /part|abstech|tronz/i, lathe_thread: /thread|gewinde|rosc/i, drill: /drill|bohrer|broca/i, tap: /\btap\b|gewindebohrer|macho/i, bore: /bor(e|ing)|ausdreh|mandrin/i, thread_mill: /thread|gewindefr|rosca/i, engrave: /engrav|gravier|graba/i };
const MILL = /mill|fräs|fresa/i;
const NO_FLAT = /ball|kugel|bola|esf[eé]r|thread|gewinde|rosca/i;
const CUTTERS = new Set(['face', 'rect_pocket', 'round_pocket', 'slot', 'rect_boss', 'round_boss', 'contour']);

/**
 * The tool of a previous operation with the same type of tool, or one whose comment names that type; empty if
 * none is known.
 */
function proposedTool(type: string): string {
  const isSame = (other: string): boolean => other === type || (CUTTERS.has(type) && CUTTERS.has(other));
  const before = form.job.steps.findLast((one) => isSame(one.type));
  if (before !== undefined) {
    return shownText(form.job.steps.indexOf(before), 'tool');
  }
  const fits = (comment: string): boolean => (CUTTERS.has(type) ? MILL.test(comment) && !NO_FLAT.test(comment) : (TOOL_WORDS[type]?.test(comment) ?? false));
  const found = tools.version < 0 ? undefined : tools.list.find((one) => one.toolno > 0 && fits(one.comment));
  return found === undefined ? '' : String(found.toolno);
}

export function addStep(type: string): void {
  const top = form.job.steps.at(-1)?.texts['top'];
  form.job.steps.push({ id: form.nextId, type, texts: { tool: proposedTool(type), ...(top === undefined ? {} : { top }) } });
  form.nextId += 1;
  form.selected = form.job.steps.length - 1;
  form.isChanged = true;
}

export function copyStep(at: number): void {
  const one = form.job.steps[at];
  if (one !== undefined) {
    form.job.steps.splice(at + 1, 0, { id: form.nextId, type: one.type, texts: { ...one.texts } });
    form.nextId += 1;
    form.selected = at + 1;
    form.isChanged = true;
  }
}

export function deleteStep(at: number): void {
  form.job.steps.splice(at, 1);
  form.selected = Math.min(at, form.job.steps.length - 1);
  form.isChanged = true;
}

export function moveStep(at: number, by: -1 | 1): void {
  const [one, other] = [form.job.steps[at], form.job.steps[at + by]];
  if (one !== undefined && other !== undefined) {
    form.job.steps[at] = other;
    form.job.steps[at + by] = one;
    form.selected = at + by;
    form.isChanged = true;
  }
}

export function setText(at: number, id: string, text: string): void {
  const step = form.job.steps[at];
  if (step === undefined) {
    return;
  }
  step.texts[id] = text;
  if (id === 'tool') {
    delete step.texts['diameter']; // that of the table
  }
  form.isChanged = true;
}

/** Content of a field: the typed value, or its default. */
export function shownText(at: number, id: string): string {
  const step = form.job.steps[at];
  const typed = step?.texts[id];
  if (step === undefined || typed !== undefined) {
    return typed ?? '';
  }
  return textOf(valuesOf(step, contextOf(currentJob(), machineFacts()))[id], decimalSeparator());
}

export function currentJob(): Job {
  return jobOf(form.job, machineFacts());
}
