// SPDX-License-Identifier: GPL-2.0-or-later
// The start speed of a spindle for all its buttons.
import * as actions from './actions';
import { canEnergise, type Gate } from './gates';
import { machine, view } from './machine.svelte';
import { parseNumber } from './numbers';

const typed = $state<Record<number, string>>({});

/** The typed speed, or the speed of the INI file, or an empty text. */
export function speedText(index: number): string {
  const proposed = machine.facts?.spindles[index]?.default_speed ?? 0;
  return typed[index] ?? (proposed > 0 ? String(proposed) : '');
}

export function typeSpeed(index: number, text: string): void {
  typed[index] = text;
}

export function canStartSpindle(index: number): Gate {
  const speed = parseNumber(speedText(index));
  return canEnergise(view()) ?? (speed !== null && speed > 0 ? null : { key: 'gate.speed' });
}

/**
 * Changes the speed by [DISPLAY]SPINDLE_INCREMENT, within the limits of the INI file; a running spindle
 * follows at once.
 */
export function changeSpeed(index: number, sign: number): void {
  const spindle = machine.status?.spindles[index];
  const now = spindle?.is_on === true ? Math.abs(spindle.speed_cmd_rpm) : (parseNumber(speedText(index)) ?? 0);
  const own = machine.facts?.spindles[index];
  const most = own?.max_speed ?? 0;
  const wanted = Math.max(now + sign * (own?.increment ?? 100), own?.min_speed ?? 0, 0);
  const speed = most > 0 ? Math.min(wanted, most) : wanted;
  typed[index] = String(speed);
  if (spindle?.is_on === true && speed > 0) {
    void actions.startSpindle(index, Math.sign(spindle.direction || 1) * speed);
  }
}

export function startAtSpeed(index: number, sign: number): void {
  void actions.startSpindle(index, sign * (parseNumber(speedText(index)) ?? 0));
}
