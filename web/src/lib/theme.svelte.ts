// SPDX-License-Identifier: GPL-2.0-or-later
import { prefs } from './prefs.svelte';

export const theme = $state({ isDark: true });

/** Follows the operator's selection, or that of the system. Call it in an effect. */
export function applyTheme(): () => void {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const look = (): void => {
    theme.isDark = prefs.theme === 'dark' || (prefs.theme === 'auto' && dark.matches);
    document.documentElement.dataset['theme'] = theme.isDark ? 'dark' : 'light';
  };
  look();
  dark.addEventListener('change', look);
  return () => dark.removeEventListener('change', look);
}
