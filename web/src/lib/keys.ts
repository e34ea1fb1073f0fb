// SPDX-License-Identifier: GPL-2.0-or-later
// Keys as in AXIS. Escape and F1 always; the others except in text fields.

export interface KeyActions {
  emergencyStop(): void;
  stop(): void;
  switchOn(): void;
  run(): void;
  hold(): void;
  resume(): void;
  step(): void;
  jog(axis: string, sign: number, isRapid: boolean): void;
  letGo(axis: string): void;
  areJogKeysOn(): boolean;
}

/** The axis and sign of a key. */
const JOG_KEYS: Record<string, [string, number]> = {
  ArrowRight: ['X', 1],
  ArrowLeft: ['X', -1],
  ArrowUp: ['Y', 1],
  ArrowDown: ['Y', -1],
  PageUp: ['Z', 1],
  PageDown: ['Z', -1],
  ']': ['A', 1],
  '[': ['A', -1],
};

/** True if keys have another meaning in the focused element. */
export function takesKeys(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) {
    return false;
  }
  if (target instanceof HTMLInputElement) {
    return target.type !== 'checkbox' && target.type !== 'radio' && target.type !== 'button';
  }
  return target.isContentEditable || ['TEXTAREA', 'SELECT'].includes(target.tagName) || target.closest('.keys-inside') !== null;
}

function onDown(event: KeyboardEvent, actions: KeyActions): boolean {
  if (event.key === 'Escape') {
    actions.stop();
    return false; // dialogs close, too
  }
  if (event.key === 'F1') {
    actions.emergencyStop();
    return true;
  }
  if (event.ctrlKey || event.altKey || event.metaKey || takesKeys(event.target)) {
    return false;
  }
  if (document.querySelector('[role="dialog"]') !== null) {
    return false; // while a dialog is open, keys start nothing else
  }
  const jog = JOG_KEYS[event.key];
  if (jog !== undefined && actions.areJogKeysOn()) {
    if (!event.repeat) {
      actions.jog(jog[0], jog[1], event.shiftKey);
    }
    return true;
  }
  const simple: Record<string, () => void> = {
    F2: () => actions.switchOn(),
    r: () => actions.run(),
    p: () => actions.hold(),
    s: () => actions.resume(),
    t: () => actions.step(),
  };
  const act = event.repeat ? undefined : simple[event.key];
  act?.();
  return act !== undefined;
}

export function listenToKeys(target: Window, actions: KeyActions): () => void {
  const down = (event: KeyboardEvent): void => {
    if (onDown(event, actions)) {
      event.preventDefault();
    }
  };
  const up = (event: KeyboardEvent): void => {
    const jog = JOG_KEYS[event.key] ?? JOG_KEYS[{ '{': '[', '}': ']' }[event.key] ?? ''];
    if (jog !== undefined) {
      actions.letGo(jog[0]);
    }
  };
  target.addEventListener('keydown', down, { capture: true });
  target.addEventListener('keyup', up, { capture: true });
  return () => {
    target.removeEventListener('keydown', down, { capture: true });
    target.removeEventListener('keyup', up, { capture: true });
  };
}
