// SPDX-License-Identifier: GPL-2.0-or-later
// The reason why a command is disabled. It is shown at the touched button long enough to be read.
import type { Gate } from './gates';

const SHOWN_MS = 8000;

export const why = $state<{ gate: Gate; what: string; number: number }>({ gate: null, what: '', number: 0 });

let timer: ReturnType<typeof setTimeout> | undefined;

export function explain(gate: Gate, what: string): void {
  why.gate = gate;
  why.what = what;
  why.number += 1;
  clearTimeout(timer);
  timer = setTimeout(() => {
    why.gate = null;
  }, SHOWN_MS);
}

export function forgetWhy(): void {
  clearTimeout(timer);
  why.gate = null;
}

/** Calls `act` if the gate is open, otherwise shows the reason. */
export function through(gate: Gate, what: string, act: () => unknown): void {
  if (gate === null) {
    forgetWhy();
    void act();
  } else {
    explain(gate, what);
  }
}
