// SPDX-License-Identifier: GPL-2.0-or-later
// The open program: its name in the folder of programs, and when it is to be read again, its errors.
import { machine } from './machine.svelte';

export const program = $state<{ reads: number; errors: string[] }>({ reads: 0, errors: [] });

/** In the folder of programs; nothing where none is open, or one from elsewhere. */
export function openName(): string | null {
  const path = machine.status?.task.program ?? '';
  const prefix = `${machine.facts?.program_prefix ?? ''}/`;
  const name = path.startsWith(prefix) ? path.slice(prefix.length) : '';
  return name === '' || name.includes('/') ? null : name;
}

export function isOutside(): boolean {
  return (machine.status?.task.program ?? '') !== '' && openName() === null;
}

/** What to call it. */
export function shownName(): string {
  const path = machine.status?.task.program ?? '';
  return openName() ?? path.slice(path.lastIndexOf('/') + 1);
}

/** It was opened anew: its text may be another one. */
export function reloadPath(): void {
  program.reads += 1;
}
