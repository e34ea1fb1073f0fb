// SPDX-License-Identifier: GPL-2.0-or-later
// Messages that this browser has dismissed: a server sends the last ones again to a page that is loaded again.

export interface Dismissable {
  kind: string;
  text: string;
  /** When it came. [ms] */
  at: number;
  /** By which task counts its messages; 0: of a note, which has none. */
  number: number;
}

type Kept = Dismissable & { session: string };

const KEY = 'millwright.dismissed';
const MOST_KEPT = 200;
/** The time of a message is its age when it was sent: a page that loads slowly reads it late. A machine that is started again counts from 1. */
const NUMBERED_MS = 10_000;
const NOTE_MS = 2000;

export class Dismissed {
  private kept: Kept[];

  constructor(private readonly storage: Pick<Storage, 'getItem' | 'setItem'> | null) {
    this.kept = this.read();
  }

  private read(): Kept[] {
    try {
      const kept = JSON.parse(this.storage?.getItem(KEY) ?? '[]') as unknown;
      return Array.isArray(kept) ? (kept as Kept[]) : [];
    } catch {
      return []; // no storage, or not ours
    }
  }

  /** `session`: of the server. */
  add(session: string, messages: readonly Dismissable[]): void {
    const added = messages.map(({ kind, text, at, number }) => ({ session, kind, text, at, number }));
    this.kept = [...this.kept, ...added].slice(-MOST_KEPT);
    try {
      this.storage?.setItem(KEY, JSON.stringify(this.kept));
    } catch {
      // A browser without storage shows them again.
    }
  }

  has(session: string, one: Dismissable): boolean {
    const tolerance = one.number > 0 ? NUMBERED_MS : NOTE_MS;
    return this.kept.some((kept) => kept.session === session && kept.number === one.number && kept.kind === one.kind && kept.text === one.text && Math.abs(kept.at - one.at) < tolerance);
  }
}
