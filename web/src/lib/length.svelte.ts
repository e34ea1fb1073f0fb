// SPDX-License-Identifier: GPL-2.0-or-later
// The active tool length of this machine as text.
import { t } from './i18n/index.svelte';
import { machine } from './machine.svelte';
import { toolLength, type ToolLength } from './tool_length';
import { tools } from './tools.svelte';

/** null while the status or the tool table has not been read. */
export function activeLength(): ToolLength | null {
  return machine.status === null || tools.version === -1 ? null : toolLength(machine.status, tools.list);
}

/** "Length: T1". */
export function lengthText(length: ToolLength): string {
  const { owner } = length;
  return owner.kind === 'tool' ? t('length.tool', { tool: owner.toolno }) : t(owner.kind === 'none' ? 'length.none' : 'length.other');
}

/** "T3 is in the spindle, the length of T1 is active." */
export function lengthFacts(length: ToolLength): string {
  const { owner, inSpindle } = length;
  const spindle = inSpindle === 0 ? t('length.spindle_empty') : t('length.spindle', { tool: inSpindle });
  const active = owner.kind === 'tool' ? t('length.active', { tool: owner.toolno }) : t(owner.kind === 'none' ? 'length.active_none' : 'length.active_other');
  return `${spindle} ${active}`;
}

/** The action that activates the length of the tool in the spindle. */
export function lengthCode(length: ToolLength): string {
  return length.inSpindle === 0 ? 'G49' : 'G43';
}

/**
 * A note to be shown before a zero is set along `letters`; null if it is set with the length of the tool in
 * the spindle.
 */
export function wrongLength(letters: readonly string[]): ToolLength | null {
  const length = activeLength();
  return length !== null && length.wrongAxes.some((letter) => letters.includes(letter)) ? length : null;
}
