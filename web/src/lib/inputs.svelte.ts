// SPDX-License-Identifier: GPL-2.0-or-later
// The inputs of motion that have a source in HAL (GET /api/inputs). For inputs without a source the status
// shows a preset, not a measurement.
import { machine } from './machine.svelte';

export interface Inputs {
  probe: boolean;
  spindles: { speed_in: boolean; at_speed: boolean }[];
}

/** null: unknown, because no machine is running or its HAL cannot be read. */
export const inputs = $state<{ known: Inputs | null }>({ known: null });

const READ_AGAIN_MS = 5000;

export async function readInputs(): Promise<void> {
  try {
    const answer = await fetch('/api/inputs');
    inputs.known = answer.ok ? ((await answer.json()) as Inputs) : null;
  } catch {
    inputs.known = null; // no connection; the screen shows this
  }
}

/** Call it in an effect: reads the inputs periodically while a machine is running, because HAL may be linked later. */
export function followInputs(): (() => void) | undefined {
  if (!machine.isMachineUp) {
    inputs.known = null;
    return undefined;
  }
  void readInputs();
  const timer = setInterval(() => void readInputs(), READ_AGAIN_MS);
  return () => clearInterval(timer);
}
