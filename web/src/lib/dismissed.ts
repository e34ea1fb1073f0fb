// SPDX-License-Identifier: GPL-2.0-or-later
// Messages dismissed in this browser. A server sends the last messages again to a reloaded page.

export interface Dismissable {
  kind: string;
  text: string;
  /** Time of arrival. [ms] */
  at: number;
  /** Task's number of the message; 0 for a note, which has no number. */
  number: number;
  /** Identifies the start of the machine that numbers the messages; for a note, the start of the server. */
  run: string;
}

const KEY = 'millwright.dismissed';
const MOST_KEPT = 200;
/** A note has an age instead of a time. A page that loads slowly receives it late, so its calculated time varies by up to this value. */
const NOTE_MS = 2000;

export class Dismissed {
  private kept: Dismissable[];

  constructor(private readonly storage: Pick<Storage, 'getItem' | 'setItem'> | null) {
    this.kept = this.read();
  }

  private read(): Dismissable[] {
    try {
      const kept = JSON.parse(this.storage?.getItem(KEY) ?? '[]') as unknown;
      return Array.isArray(kept) ? (kept as Dismissable[]) : [];
    } catch {
      return []; // no storage, or no access
    }
  }

  add(messages: readonly Dismissable[]): void {
    const added = messages.map(({ kind, text, at, number, run }) => ({ kind, text, at, number, run }));
    this.kept = [...this.kept, ...added].slice(-MOST_KEPT);
    try {
      this.storage?.setItem(KEY, JSON.stringify(this.kept));
    } catch {
      // Without browser storage, dismissed messages are shown again.
    }
  }

  has(one: Dismissable): boolean {
    return this.kept.some(
      (kept) => kept.run === one.run && kept.number === one.number && (one.number > 0 || (kept.kind === one.kind && kept.text === one.text && Math.abs(kept.at - one.at) < NOTE_MS)),
    );
  }
}
