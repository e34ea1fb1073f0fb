// SPDX-License-Identifier: GPL-2.0-or-later
// The open program: its name in the folder of programs, when it must be read again, and its errors.
import { machine } from './machine.svelte';

/** `isPathUnderWay`: the page is reading the path and has not drawn all of it. */
export const program = $state<{ reads: number; errors: string[]; isPathUnderWay: boolean }>({ reads: 0, errors: [], isPathUnderWay: false });

/** A name relative to a folder. */
function nameIn(path: string, folder: string, end = ''): string | null {
  const prefix = `${folder}/`;
  const name = path.startsWith(prefix) && path.endsWith(end) ? path.slice(prefix.length, path.length - end.length) : '';
  return name === '' || name.includes('/') ? null : name;
}

/** For a program created by a filter: the original file. */
export function filteredName(): string | null {
  return nameIn(machine.status?.task.program ?? '', machine.facts?.filtered_folder ?? '', '.ngc');
}

/** Name in the folder of programs; null if none is open, or it is in another folder. */
export function openName(): string | null {
  return filteredName() ?? nameIn(machine.status?.task.program ?? '', machine.facts?.program_prefix ?? '');
}

/** True if a filter runs before the file is opened. */
export function hasFilter(name: string): boolean {
  return (machine.facts?.filter_extensions ?? []).some((one) => name.toLowerCase().endsWith(one));
}

export function isOutside(): boolean {
  return (machine.status?.task.program ?? '') !== '' && openName() === null;
}

/** Displayed name. */
export function shownName(): string {
  const path = machine.status?.task.program ?? '';
  return openName() ?? path.slice(path.lastIndexOf('/') + 1);
}

/** Called when the program was opened again, because its text may have changed. */
export function reloadPath(): void {
  program.reads += 1;
}
