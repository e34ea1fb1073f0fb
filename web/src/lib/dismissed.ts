// SPDX-License-Identifier: GPL-2.0-or-later
// Messages that this browser has dismissed: a server sends the last ones again to a page that is loaded again.

export interface Dismissable {
  kind: string;
  text: string;
  /** When it came. [ms] */
  at: number;
  /** By which task counts its messages; 0: of a note, which has none. */
  number: number;
  /** Of the start of the machine that counts them; of a note, of the server. */
  run: string;
}

const KEY = 'millwright.dismissed';
const MOST_KEPT = 200;
/** The time of a note is its age when it was sent: a page that loads slowly reads it late. */
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
      return []; // no storage, or not ours
    }
  }

  add(messages: readonly Dismissable[]): void {
    const added = messages.map(({ kind, text, at, number, run }) => ({ kind, text, at, number, run }));
    this.kept = [...this.kept, ...added].slice(-MOST_KEPT);
    try {
      this.storage?.setItem(KEY, JSON.stringify(this.kept));
    } catch {
      // A browser without storage shows them again.
    }
  }

  has(one: Dismissable): boolean {
    return this.kept.some(
      (kept) => kept.run === one.run && kept.number === one.number && (one.number > 0 || (kept.kind === one.kind && kept.text === one.text && Math.abs(kept.at - one.at) < NOTE_MS)),
    );
  }
}
