// SPDX-License-Identifier: GPL-2.0-or-later
// Findings of the simulation: one entry for each line of the program.

/** In order of severity. */
export const FINDING_KINDS = ['fixture', 'holder', 'rapid', 'floor'] as const;
export type FindingKind = (typeof FINDING_KINDS)[number];

export interface Finding {
  line: number;
  kinds: FindingKind[];
  /** Number of the move, and the fraction along it. */
  move: number;
  part: number;
  tool: number;
  /** Of the deepest contact. Work coordinates. [mm] */
  depth: number;
  place: [number, number, number];
  /** Name of the fixture that is hit. */
  fixture: string;
}

export const MOST_FINDINGS = 1000;

export class Findings {
  private readonly by_line = new Map<number, Finding>();
  /** Number of lines that did not fit into the list. */
  dropped = 0;

  add(kind: FindingKind, found: Omit<Finding, 'kinds'>): void {
    const known = this.by_line.get(found.line);
    if (known === undefined) {
      if (this.by_line.size >= MOST_FINDINGS) {
        this.dropped += 1;
        return;
      }
      this.by_line.set(found.line, { ...found, kinds: [kind] });
      return;
    }
    if (!known.kinds.includes(kind)) {
      known.kinds.push(kind);
      known.kinds.sort((a, b) => FINDING_KINDS.indexOf(a) - FINDING_KINDS.indexOf(b));
    }
    known.depth = Math.max(known.depth, found.depth);
    known.fixture ||= found.fixture;
  }

  /** The findings in the order of the program. */
  list(): Finding[] {
    return [...this.by_line.values()].sort((a, b) => a.move - b.move || a.part - b.part);
  }
}
