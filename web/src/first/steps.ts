// SPDX-License-Identifier: GPL-2.0-or-later
// Answers of `millwright select --browser`: docs/reference/api.md, First steps.

export interface Choice {
  ini: string;
  name: string;
  machine: string;
  kind: string;
  axes: string;
  unit: string;
  notes: string;
  has_picture: boolean;
  /** The machine can be commissioned. */
  has_steps: boolean;
  /** Its board is simulated, so the steps are practice. */
  is_simulated: boolean;
}
export interface Group {
  title: string;
  folder: string;
  is_copied: boolean;
  choices: Choice[];
}
export interface Found {
  groups: Group[];
  last: string;
  proposed_folder: string;
}
export interface Question {
  key: string;
  text: string;
  form: 'choice' | 'number' | 'whole' | 'text';
  preset: string;
  /** Reason why the preset is a good initial value. */
  reason: string;
  unit: string;
  choices?: string[];
  min?: number;
  max?: number;
}
export interface Fault {
  key: string;
  text: string;
}
export interface Asked {
  questions: Question[];
  faults: Fault[];
  files: { name: string; text: string }[];
}
export type Answers = Record<string, string>;

export class Steps {
  constructor(private readonly key: string) {}

  private async ask<T>(what: string, body?: object): Promise<T> {
    const answer = await fetch(this.address(what), body === undefined ? {} : { method: 'POST', body: JSON.stringify(body) });
    const told = (await answer.json()) as T & { error?: string };
    if (!answer.ok) {
      throw new Error(told.error ?? `${what}: ${answer.status}`);
    }
    return told;
  }
  private address(what: string, more = ''): string {
    return `/api/first_steps${what}?key=${encodeURIComponent(this.key)}${more}`;
  }
  find = (): Promise<Found> => this.ask('');
  questions = (answers: Answers): Promise<Asked> => this.ask('/questions', { answers });
  make = (folder: string, answers: Answers): Promise<{ ini?: string; faults?: Fault[] }> => this.ask('/machine', { folder, answers });
  tryOut = (ini: string): Promise<{ is_good: boolean; output: string }> => this.ask('/trial', { ini });
  start = (ini: string): Promise<{ ini: string; port: number }> => this.ask('/start', { ini });
  /** Builds the first message of a session, which opens the commissioning of a machine. */
  beginning = (ini: string): { key: string; ini: string } => ({ key: this.key, ini });
  picture = (ini: string): string => this.address('/picture', `&ini=${encodeURIComponent(ini)}`);
}

/** Configurations whose displayed texts contain every word. */
export function search(groups: Group[], text: string): Group[] {
  const words = text.toLowerCase().split(/\s+/).filter((word) => word !== '');
  return groups
    .map((group) => ({
      ...group,
      choices: group.choices.filter((one) => {
        const shown = [one.name, one.machine, one.kind, one.axes, one.unit, one.notes, group.title].join(' ').toLowerCase();
        return words.every((word) => shown.includes(word));
      }),
    }))
    .filter((group) => group.choices.length > 0);
}

export interface Section {
  title: string;
  questions: Question[];
}

/**
 * Groups the questions by the part of their key before the point: first those of the machine, then each axis
 * and motor.
 */
export function sections(questions: Question[]): Section[] {
  const found = new Map<string, Question[]>();
  for (const question of questions) {
    const part = /^(\w+)\./.exec(question.key)?.[1] ?? '';
    const isOfMachine = part === '' || part === 'spindle' || part === 'foam';
    const isWiring = ['step', 'pin', 'switch', 'board', 'probe'].includes(part) || ['latency', 'board', 'pendant'].includes(question.key) ||
      (part === 'spindle' && question.key !== 'spindle.max');
    const title = isWiring ? 'wiring' : isOfMachine ? 'machine' : part.toUpperCase();
    found.set(title, [...(found.get(title) ?? []), question]);
  }
  return [...found].map(([title, list]) => ({ title, questions: list }));
}

/** A folder name for a machine name. */
export function folderName(name: string): string {
  return name.toLowerCase().normalize('NFD').replace(/[^a-z0-9]+/g, '_').replace(/^_+|_+$/g, '') || 'machine';
}
