// SPDX-License-Identifier: GPL-2.0-or-later
// Sets work zeros and restores the former ones. One command at a time; a second touch waits for the first.
import { inProgramUnits, mdi } from './actions';
import { canTouchOff, type Gate } from './gates';
import { machine, untilStatus, view } from './machine.svelte';
import { isDiameter, type Offsets } from './status';
import { canRestore, goLine, isIncremental, restoreLine, zeroLine, zeroSet, type ZeroSet } from './zero';

/** Time for which Undo is offered after the last zero. */
const OFFERED_MS = 60_000;
/** The status with the new offsets arrives after the outcome of the command. */
const STATUS_MS = 1000;

/** `done`: newest last. */
export const zeros = $state<{ done: ZeroSet[]; isBusy: boolean }>({ done: [], isBusy: false });

let timer: ReturnType<typeof setTimeout> | undefined;

function offerUndo(): void {
  clearTimeout(timer);
  timer = setTimeout(() => (zeros.done = []), OFFERED_MS);
}

function offsetsNow(): Offsets | null {
  return machine.status === null ? null : (JSON.parse(JSON.stringify(machine.status.offsets)) as Offsets);
}

/** The zero that Undo restores. */
export function lastZero(): ZeroSet | null {
  const last = zeros.done[zeros.done.length - 1];
  const offsets = machine.status?.offsets;
  return last !== undefined && offsets !== undefined && canRestore(last, offsets) ? last : null;
}

/** True if the shown position is the current one, because zero is set at it or a move starts from it. */
export function canZero(): Gate {
  const old = machine.silentSeconds ?? machine.staleSeconds;
  if (old !== null) {
    return { key: 'app.stale', values: { seconds: old } };
  }
  const isMoving = machine.status?.trajectory.in_position === false;
  return canTouchOff(view()) ?? (zeros.isBusy ? { key: 'gate.busy' } : isMoving ? { key: 'gate.moving' } : null);
}

/** A move to zero also needs G90, and homed joints even if programs do not need them. */
export function canGoToZero(): Gate {
  const status = machine.status;
  const gate = canZero();
  if (gate !== null || status === null) {
    return gate;
  }
  return !status.trajectory.all_homed ? { key: 'gate.homed' } : isIncremental(status.codes) ? { key: 'gate.incremental' } : null;
}

async function alone(act: () => Promise<void>): Promise<void> {
  if (zeros.isBusy) {
    return;
  }
  zeros.isBusy = true;
  try {
    await act();
  } finally {
    zeros.isBusy = false;
  }
}

/** Returns whether the zero was set. */
export async function setZero(letters: readonly string[]): Promise<boolean> {
  let isDone = false;
  await alone(async () => {
    const before = offsetsNow();
    if (before === null || (await mdi(zeroLine(letters))).progress !== 'DONE') {
      return;
    }
    isDone = true;
    await untilStatus((status) => zeroSet(letters, before, status.offsets) !== null, STATUS_MS);
    const after = offsetsNow();
    const zero = after === null ? null : zeroSet(letters, before, after);
    if (zero !== null) {
      zeros.done = [...zeros.done.filter((_, i) => i > zeros.done.length - UNDOS), zero];
      offerUndo();
    }
  });
  return isDone;
}

/** Number of zeros that can be restored. */
const UNDOS = 20;

export function undoZero(): Promise<void> {
  return alone(async () => {
    const zero = lastZero();
    if (zero === null) {
      return;
    }
    const letters = [...(machine.facts?.axes ?? '')];
    const isX2 = machine.status !== null && isDiameter(machine.status.codes);
    const inUnits = (value: number, letter: string): number => (letter === 'X' && isX2 ? 2 : 1) * inProgramUnits(value, letter);
    if ((await mdi(restoreLine(zero, letters, inUnits))).progress !== 'DONE') {
      return;
    }
    await untilStatus((status) => !canRestore(zero, status.offsets), STATUS_MS);
    zeros.done = zeros.done.slice(0, -1);
    offerUndo();
  });
}

/** Moves the machine; only after the operator has confirmed it. */
export function goToZero(letters: readonly string[]): Promise<void> {
  return alone(async () => {
    await mdi(goLine(letters));
  });
}
