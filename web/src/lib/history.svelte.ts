// SPDX-License-Identifier: GPL-2.0-or-later
// The last minute of speeds and following errors, for the plots. Memory is constant.

export const SAMPLES = 1200;

export interface History {
  /** Seconds of the machine's clock. */
  times: number[];
  velocity: number[];
  ferrors: number[][];
}

const kept: History = { times: [], velocity: [], ferrors: [] };
/** Increases with each sample, so that plots are updated. */
export const history = $state({ count: 0 });

export function recorded(): History {
  return kept;
}

export function record(timeS: number, velocity: number, ferrors: number[]): void {
  const last = kept.times.at(-1);
  if (last !== undefined && timeS < last) {
    forget(); // another machine has another clock
  }
  if (timeS === last) {
    return;
  }
  kept.times.push(timeS);
  kept.velocity.push(velocity);
  ferrors.forEach((value, joint) => (kept.ferrors[joint] ??= []).push(value));
  if (kept.times.length > SAMPLES) {
    kept.times.shift();
    kept.velocity.shift();
    kept.ferrors.forEach((one) => one.shift());
  }
  history.count += 1;
}

export function forget(): void {
  kept.times.length = 0;
  kept.velocity.length = 0;
  kept.ferrors.length = 0;
}
