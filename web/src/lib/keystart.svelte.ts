// SPDX-License-Identifier: GPL-2.0-or-later
// A key that would move the machine by its program first asks for confirmation, so that an object that falls
// on the keyboard starts nothing.
import * as actions from './actions';
import { canResume, canRun, canStep, type Gate, type View } from './gates';
import type { TextKey } from './i18n/en';
import { machine } from './machine.svelte';

export type Start = 'run' | 'resume' | 'step';

export const STARTS: Record<Start, { gate: (view: View) => Gate; name: TextKey; act: () => unknown }> = {
  run: { gate: canRun, name: 'cycle.run', act: actions.run },
  resume: { gate: canResume, name: 'cycle.resume', act: actions.resume },
  step: { gate: canStep, name: 'cycle.step', act: actions.step },
};

/**
 * `isStepping`: the operator has confirmed a step of this program, and nothing has been run or resumed by
 * keys since.
 */
export const keyStart = $state<{ asked: Start | null; isStepping: boolean }>({ asked: null, isStepping: false });

/** Called when a key was pressed and its gate is open. */
export function startByKey(start: Start): void {
  const isUnderWay = machine.status !== null && machine.status.task.interp_state !== 'IDLE';
  if (start === 'step' && keyStart.isStepping && isUnderWay) {
    actions.step();
  } else {
    keyStart.asked = start;
  }
}

export function confirmStart(): void {
  const start = keyStart.asked;
  keyStart.asked = null;
  if (start !== null) {
    keyStart.isStepping = start === 'step';
    STARTS[start].act();
  }
}

/** Called when the program has ended. The open question is then invalid, and the next program needs a new confirmation. */
export function forgetStart(): void {
  keyStart.asked = null;
  keyStart.isStepping = false;
}
