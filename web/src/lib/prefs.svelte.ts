// SPDX-License-Identifier: GPL-2.0-or-later
// Preferences of the operator: stored in this browser, and at the machine if the INI file names files for
// them.

import type { ColorBy } from './path/shades';
import type { KeptSimulation } from './simulation/kept';

export type Theme = 'auto' | 'dark' | 'light';
export type Language = 'en' | 'de' | 'es';
export type Unit = 'machine' | 'mm' | 'inch';

export interface Preferences {
  /** The quantity that determines the colour of the path. */
  colorBy: ColorBy;
  theme: Theme;
  language: Language;
  unit: Unit;
  positions: 'feedback' | 'commanded';
  mdiHistory: string[];
  increment: number | null;
  /** Fraction of the maximum jog speed; null: as in the INI file. */
  jogShare: number | null;
  simulation: KeptSimulation;
}

const KEY = 'millwright.preferences';

function firstLanguage(): Language {
  const asked = (typeof navigator === 'undefined' ? 'en' : navigator.language).slice(0, 2);
  return asked === 'de' || asked === 'es' ? asked : 'en';
}

const PRESETS: Preferences = {
  colorBy: 'kind',
  theme: 'auto',
  language: firstLanguage(),
  unit: 'machine',
  positions: 'feedback',
  mdiHistory: [],
  increment: null,
  jogShare: null,
  simulation: { colorBy: 'tool', tools: {}, stocks: [] },
};

function read(): Preferences {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? '{}') as Partial<Preferences>;
    return { ...PRESETS, ...kept };
  } catch {
    return { ...PRESETS }; // no storage, or access denied: use the defaults
  }
}

export const prefs = $state<Preferences>(read());

/** Data that the machine stores for all its screens. */
const atMachine = { preferences: false, mdiHistory: false };

async function put(path: string, value: object): Promise<void> {
  await fetch(path, { method: 'PUT', body: JSON.stringify(value) });
}

/**
 * Reads the data stored at the machine: [DISPLAY]PREFERENCE_FILE_PATH and MDI_HISTORY_FILE. A file of another
 * screen is not changed, and this browser then keeps its own data.
 */
export async function readKept(hasPreferences: boolean, hasHistory: boolean): Promise<void> {
  if (hasPreferences) {
    const answer = await fetch('/api/preferences');
    atMachine.preferences = answer.ok;
    if (answer.ok) {
      const { mdiHistory, ...kept } = { ...prefs, ...((await answer.json()) as Partial<Preferences>) };
      Object.assign(prefs, kept);
    }
  }
  if (hasHistory) {
    const answer = await fetch('/api/mdi_history');
    atMachine.mdiHistory = answer.ok;
    if (answer.ok) {
      prefs.mdiHistory = [...new Set(((await answer.json()) as { lines: string[] }).lines.reverse())];
    }
  }
}

export function keepMdiHistory(): void {
  keepPreferences();
  if (atMachine.mdiHistory) {
    void put('/api/mdi_history', { lines: [...prefs.mdiHistory].reverse() });
  }
}

export function keepPreferences(): void {
  if (atMachine.preferences) {
    const { mdiHistory, ...kept } = prefs;
    void put('/api/preferences', kept);
  }
  try {
    localStorage.setItem(KEY, JSON.stringify(prefs));
  } catch {
    // Without browser storage, the preferences are lost when the page is closed.
  }
}
