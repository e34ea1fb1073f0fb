// SPDX-License-Identifier: GPL-2.0-or-later
// The running program, or the last one: its time, and the number of parts counted by this page.
import { machine } from './machine.svelte';
import { RunWatch, type RunEnd } from './run_end';

export const run = $state<{ elapsed_s: number | null; end: RunEnd | null; parts: number }>({ elapsed_s: null, end: null, parts: 0 });

const KEY = 'millwright.parts';
const watch = new RunWatch();

interface Counted {
  session: string;
  program: string;
  parts: number;
}

function counted(program: string): number {
  try {
    const kept = JSON.parse(sessionStorage.getItem(KEY) ?? '{}') as Partial<Counted>;
    return kept.session === machine.session && kept.program === program ? (kept.parts ?? 0) : 0;
  } catch {
    return 0; // a browser without storage
  }
}

/**
 * Counts a finished run of this program since the start of the screen's server. A reload of the page keeps
 * the count.
 */
function count(program: string): void {
  run.parts = counted(program) + 1;
  try {
    sessionStorage.setItem(KEY, JSON.stringify({ session: machine.session, program, parts: run.parts } satisfies Counted));
  } catch {
    // without storage, the count is lost on reload
  }
}

/** Call it with each status. */
export function followRun(): void {
  const hasEnded = watch.take(machine.status);
  if (hasEnded && watch.end?.kind === 'finished') {
    count(watch.end.program);
  }
  run.elapsed_s = watch.elapsed_s;
  run.end = watch.end;
}

/** Called with the outcome of a start that this page has sent. */
export function followOutcome(progress: string): void {
  if (watch.outcome(progress) && watch.end !== null) {
    count(watch.end.program);
  }
  run.end = watch.end;
}
