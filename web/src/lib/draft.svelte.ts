// SPDX-License-Identifier: GPL-2.0-or-later
// Unsaved changes of the editor. They belong to the page and are kept when another view is shown.
import { openProgram } from './actions';
import { uploadProgram } from './files';
import { machine } from './machine.svelte';
import { openName, reloadPath } from './program.svelte';

export interface Draft {
  /** Name in the folder of programs. */
  name: string;
  text: string;
}

export const draft = $state<{ now: Draft | null }>({ now: null });

/** Stores `text` from the editor for the program; `saved` is the content of its file. */
export function keepDraft(name: string, text: string, saved: string): void {
  if (text !== saved) {
    draft.now = { name, text };
  } else if (draft.now?.name === name) {
    draft.now = null;
  }
  machine.unsaved = draft.now?.name ?? null;
}

export function discardDraft(): void {
  draft.now = null;
  machine.unsaved = null;
}

/** The unsaved text of this program, null if there is none. */
export function draftOf(name: string): string | null {
  return draft.now?.name === name ? draft.now.text : null;
}

/**
 * Writes the draft to its file; throws an error of the server. Task runs the text that it has opened, so the
 * draft of the open program is saved when task has opened the new text.
 */
export async function saveDraft(): Promise<void> {
  const written = draft.now;
  if (written === null) {
    return;
  }
  await uploadProgram(written.name, new Blob([written.text]), () => undefined);
  if (written.name === openName()) {
    const outcome = await openProgram(`${machine.facts?.program_prefix}/${written.name}`);
    if (outcome.progress !== 'DONE') {
      return;
    }
  }
  forgetWritten(written);
  reloadPath();
}

/** Text typed during the write becomes a new draft. */
function forgetWritten(written: Draft): void {
  if (draft.now?.name === written.name && draft.now.text === written.text) {
    discardDraft();
  }
}

/** Asks before the page is closed or reloaded with unsaved changes. */
export function askBeforeLeaving(target: Window): () => void {
  const ask = (event: BeforeUnloadEvent): void => {
    if (draft.now !== null) {
      event.preventDefault();
    }
  };
  target.addEventListener('beforeunload', ask);
  return () => target.removeEventListener('beforeunload', ask);
}
