// SPDX-License-Identifier: GPL-2.0-or-later
// The open program: its name in the folder of programs, and when it is to be read again, its errors.
import { machine } from './machine.svelte';

/** `isPathUnderWay`: the page draws its path, which is not whole yet. */
export const program = $state<{ reads: number; errors: string[]; isPathUnderWay: boolean }>({ reads: 0, errors: [], isPathUnderWay: false });

/** A name in a folder, without what comes behind it. */
function nameIn(path: string, folder: string, end = ''): string | null {
  const prefix = `${folder}/`;
  const name = path.startsWith(prefix) && path.endsWith(end) ? path.slice(prefix.length, path.length - end.length) : '';
  return name === '' || name.includes('/') ? null : name;
}

/** Made by a filter: the file that it was made from. */
export function filteredName(): string | null {
  return nameIn(machine.status?.task.program ?? '', machine.facts?.filtered_folder ?? '', '.ngc');
}

/** In the folder of programs; nothing where none is open, or one from elsewhere. */
export function openName(): string | null {
  return filteredName() ?? nameIn(machine.status?.task.program ?? '', machine.facts?.program_prefix ?? '');
}

/** What is opened runs a filter first. */
export function hasFilter(name: string): boolean {
  return (machine.facts?.filter_extensions ?? []).some((one) => name.toLowerCase().endsWith(one));
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
