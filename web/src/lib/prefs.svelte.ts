// SPDX-License-Identifier: GPL-2.0-or-later
// What this browser keeps of how its operator likes the screen. Nothing of the machine is among it.

export type Theme = 'auto' | 'dark' | 'light';
export type Language = 'en' | 'de' | 'es';
export type Unit = 'machine' | 'mm' | 'inch';

export interface Preferences {
  theme: Theme;
  language: Language;
  unit: Unit;
  positions: 'feedback' | 'commanded';
  mdiHistory: string[];
  increment: number | null;
  jogShare: number;
}

const KEY = 'millwright.preferences';

function firstLanguage(): Language {
  const asked = (typeof navigator === 'undefined' ? 'en' : navigator.language).slice(0, 2);
  return asked === 'de' || asked === 'es' ? asked : 'en';
}

const PRESETS: Preferences = {
  theme: 'auto',
  language: firstLanguage(),
  unit: 'machine',
  positions: 'feedback',
  mdiHistory: [],
  increment: null,
  jogShare: 0.25,
};

function read(): Preferences {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? '{}') as Partial<Preferences>;
    return { ...PRESETS, ...kept };
  } catch {
    return { ...PRESETS }; // no storage, or not ours: the presets
  }
}

export const prefs = $state<Preferences>(read());

export function keepPreferences(): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(prefs));
  } catch {
    // A browser without storage forgets them, and says so itself.
  }
}
